"""Paper 5, figure 10: three lowest eigenvalues of the liquid-filled hemisphere over the level, n = 10 and 50.

For n = 10 none is negative. For n = 50 the first is negative at low levels and positive at higher ones. The
eigenvalue is not monotonic in n: parts of the hemisphere are taut.
"""

from weakforms import Axis, Case, Claim, Curve, Finding, Panel, Points, Solutions, hemisphere, reference

WAVES = (10, 50)
BOWL = hemisphere(n=WAVES, low_end=-1.14)
TABLE = reference(5, "stability_changes_hemisphere").columns
MANY = hemisphere(n=(0, 1, *sorted({int(n) for n in TABLE["n"]})), low_end=-1.18).on(step=0.15)


def stable(solutions: Solutions, name: str) -> tuple[list[float], list[float]]:
    """Levels and a column up to the highest level."""
    columns = solutions.branch(BOWL).columns
    rows = columns["n_negative"] == 0
    return columns["zw"][rows].tolist(), columns[name][rows].tolist()


def none_negative(solutions: Solutions) -> Finding:
    """Least eigenvalue for n = 10 on the branch."""
    least = min(stable(solutions, "Lambda_n10_1")[1])
    found = [p for p in solutions.points(BOWL, "stability_change") if p.values["n"] == WAVES[0]]
    return least > 0 and not found, f"{least:.6f}"


def negative_when_low(solutions: Solutions) -> Finding:
    """The one change for n = 50: from negative to positive as the level rises."""
    found = [p for p in solutions.points(BOWL, "stability_change") if p.values["n"] == WAVES[1]]
    levels, values = stable(solutions, "Lambda_n50_1")
    good = len(found) == 1 and found[0].values["direction"] == -1
    signs = [(v < 0) == (zw < found[0].values["zw"]) for zw, v in zip(levels, values, strict=True)]
    return good and all(signs), f"zw = {found[0].values['zw']:.9f}"


def not_monotonic(solutions: Solutions) -> Finding:
    """States at which the lowest eigenvalue rises from n = 10 to n = 50."""
    ten, fifty = (stable(solutions, f"Lambda_n{n}_1")[1] for n in WAVES)
    rises = [b > a for a, b in zip(ten, fifty, strict=True)]
    return any(rises) and not all(rises), f"{sum(rises)} of {len(rises)}"


def limit_is_without_waves(solutions: Solutions) -> Finding:
    """Level at which n = 0 turns unstable and the highest level; n = 1 stays stable up to it."""
    (limit,) = solutions.points(MANY, "limit_point")
    change = next(p for p in solutions.points(MANY, "stability_change") if p.values["n"] == 0)
    one = solutions.branch(MANY).columns["Lambda_n1_1"].min()
    found, bound = change.values["zw"], 2 * limit.uncertainty["zw"]
    good = abs(found - limit.values["zw"]) <= bound and one > 0
    return bool(good), f"{found:.10f}, {limit.values['zw']:.10f}; least eigenvalue for n = 1: {one:.6f}"


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
                    asked={f"Lambda_{k}": 1e-6},
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
            "the lowest eigenvalue does not fall with n everywhere, as it does in a wrinkled cylinder",
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
