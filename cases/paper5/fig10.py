"""Paper 5, figure 10: three lowest eigenvalues of the liquid-filled hemisphere over the level, n = 10 and 50.

For n = 10 none is negative. For n = 50 the first is negative at low levels and positive at higher ones. The
eigenvalue is not monotonic in n: parts of the hemisphere are taut.
"""

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    hemisphere,
    reference,
)

WAVES = (10, 50)
BOWL = hemisphere(n=WAVES, low_end=-1.14)
TABLE = reference(5, "stability_changes_hemisphere").columns
MANY = hemisphere(n=(0, 1, *sorted({int(n) for n in TABLE["n"]})), low_end=-1.18).on(step=0.15)


def stable(solutions: Solutions, name: str) -> decide.Number:
    """A column up to the highest level."""
    return solutions.along(BOWL, name)[solutions.branch(BOWL).columns["n_negative"] == 0]


def none_negative(solutions: Solutions) -> Finding:
    """Smallest eigenvalue for n = 10 on the branch."""
    found = [p for p in solutions.points(BOWL, "stability_change") if p.values["n"] == WAVES[0]]
    return decide.all_of(
        decide.positive("eigenvalue", stable(solutions, "Lambda_n10_1")),
        decide.same("changes", len(found), 0),
    )


def negative_when_low(solutions: Solutions) -> Finding:
    """The one change for n = 50: from negative to positive as the level rises."""
    found = [p for p in solutions.points(BOWL, "stability_change") if p.values["n"] == WAVES[1]]
    values = stable(solutions, "Lambda_n50_1")
    below, above = decide.sides(stable(solutions, "zw"), decide.of_point(found[0], "zw"))
    return decide.all_of(
        decide.same("directions of changes", [p.values["direction"] for p in found], [-1.0]),
        decide.negative("below", values[below]),
        decide.positive("above", values[above]),
    )


def not_monotonic(solutions: Solutions) -> Finding:
    """States at which the lowest eigenvalue increases from n = 10 to n = 50, or decreases."""
    ten, fifty = (stable(solutions, f"Lambda_n{n}_1") for n in WAVES)
    rises, falls = decide.sides(ten - fifty, 0)
    return decide.less(
        "numbers of states with neither, with increase and with decrease", 0, min(rises.sum(), falls.sum())
    )


def limit_is_without_waves(solutions: Solutions) -> Finding:
    """Level at which n = 0 becomes unstable, and the highest level; n = 1 stays stable up to it."""
    change = next(p for p in solutions.points(MANY, "stability_change") if p.values["n"] == 0)
    return decide.all_of(
        decide.agree("zw", decide.of_point(change, "zw"), solutions.point(MANY, "limit_point", "zw"), 1e-8),
        decide.positive("eigenvalue for n = 1", solutions.along(MANY, "Lambda_n1_1")),
    )


CASE = Case(
    title="Eigenvalues of the hemisphere",
    source="Patil, Nordmark & Eriksson (2016), figure 10",
    panels=tuple(
        Panel(
            f"{letter}, n = {n}",
            x=Axis("zw", -1.2, -0.4),
            y=Axis("Lambda", *limits, label=r"$\Lambda$"),
            title=f"$n = {n}$",
            curves=tuple(
                Curve(
                    BOWL,
                    rf"$\Lambda_{k}$",
                    reference=f"modes_hemisphere_n_{n}",
                    y=f"Lambda_{k}",
                    asked={f"Lambda_{k}": 4e-7},
                    columns={f"Lambda_{k}": f"Lambda_n{n}_{k}"},
                )
                for k in (1, 2, 3)
            ),
        )
        for letter, n, limits in zip("ab", WAVES, ((0, 20), (-25, 50)), strict=True)
    ),
    checks=(
        *(
            Points(
                "stability_change",
                reference="stability_changes_hemisphere",
                base=MANY,
                parameters=(),
                where={"n": float(n), "direction": float(direction)},
                asked={"zw": 1e-6},
            )
            for n, direction in zip(TABLE["n"], TABLE["direction"], strict=True)
        ),
        Claim("none_negative", "for n = 10 no eigenvalue is negative", ((BOWL, None),), none_negative),
        Claim(
            "negative_when_low",
            "for n = 50 the first eigenvalue is negative at low levels and positive at higher ones",
            ((BOWL, None),),
            negative_when_low,
        ),
        Claim(
            "not_monotonic",
            "the lowest eigenvalue does not decrease with n everywhere, unlike in a wrinkled cylinder",
            ((BOWL, None),),
            not_monotonic,
        ),
        Claim(
            "limit_is_without_waves",
            "at the highest level stability is lost to an axisymmetric mode",
            ((MANY, None),),
            limit_is_without_waves,
        ),
    ),
)
