"""Paper 5, figure 7: three lowest eigenvalues of the gas-filled cylinder over the pressure, n = 1, 5, 15, 20.

For n = 1 and 5 none is negative. For n = 15 and 20 the first one is negative over a range that starts at a
small pressure; it becomes positive again inside the printed range for n = 15, and just outside it for n = 20.
"""

from weakforms.cases import Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, wrinkled_tube

WAVES = (1, 5, 15, 20)
TUBE = wrinkled_tube(M=1.5, delta=3, Af=0.4362, load="gas", n=WAVES)
LAST = 0.38


SMALL = decide.Stated(0.02, "a small pressure", "no number is printed; a twentieth of the axis of figure 7")
JUST_OUTSIDE = decide.Stated(1.15, "just outside", "no number is printed; a seventh of the printed range")


def changes(solutions: Solutions, n: int) -> list[tuple[decide.Number, float]]:
    """Pressures and directions of the changes before the limit point of the pressure."""
    turn = solutions.points(TUBE, "limit_point")[0].values["V"]
    return [
        (decide.of_point(p, "p"), p.values["direction"])
        for p in solutions.points(TUBE, "stability_change")
        if p.values["n"] == n and p.values["V"] < turn
    ]


def never(solutions: Solutions) -> Finding:
    """Smallest eigenvalue on the branch for n = 1 and 5, also past its limit load."""
    return decide.all_of(
        decide.all_of(
            decide.positive(f"n = {n}", solutions.along(TUBE, f"Lambda_n{n}_1")),
            decide.same("changes", len(changes(solutions, n)), 0),
        )
        for n in WAVES[:2]
    )


def over_a_range(solutions: Solutions) -> Finding:
    """Pressures at which the first eigenvalue of n = 15 and 20 becomes negative and positive."""
    found = []
    for n in WAVES[2:]:
        here = changes(solutions, n)
        found.append(decide.same(f"n = {n}: directions", [d for _, d in here], [1.0, -1.0]))
        found.append(decide.at_most("starts at p", here[0][0], SMALL))
    return decide.all_of(found)


def positive_again(solutions: Solutions) -> Finding:
    """Up to p = 0.38 for n = 15, just beyond for n = 20."""
    ends = {n: changes(solutions, n)[-1][0] for n in WAVES[2:]}
    return decide.all_of(
        decide.less("ends of n = 15 and 20, around the printed 0.38", ends[15], LAST, ends[20]),
        decide.at_most("end of n = 20 over it", ends[20] / LAST, JUST_OUTSIDE),
    )


CASE = Case(
    title="Eigenvalues of the gas-filled cylinder",
    source="Patil, Nordmark & Eriksson (2016), figure 7",
    panels=tuple(
        Panel(
            f"{letter}, n = {n}",
            x=Axis("p", 0, 0.4),
            y=Axis("Lambda", -0.5 if n > 10 else 0, 4, label=r"$\Lambda$"),
            title=f"$n = {n}$",
            curves=tuple(
                Curve(
                    TUBE,
                    rf"$\Lambda_{k}$",
                    reference=f"modes_gas_n_{n}",
                    y=f"Lambda_{k}",
                    asked={f"Lambda_{k}": 5e-8},
                    columns={f"Lambda_{k}": f"Lambda_n{n}_{k}"},
                )
                for k in (1, 2, 3)
            ),
        )
        for letter, n in zip("abcd", WAVES, strict=True)
    ),
    checks=(
        Claim("never", "for n = 1 and 5 no eigenvalue is negative", ((TUBE, None),), never),
        Claim(
            "over_a_range",
            "for n = 15 and 20 the first eigenvalue is negative over a range of pressures",
            ((TUBE, None),),
            over_a_range,
        ),
        Claim(
            "positive_again",
            "at higher pressures the eigenvalue becomes positive",
            ((TUBE, None),),
            positive_again,
            differs="for n = 20 the eigenvalue becomes positive beyond the printed range, p <= 0.38",
        ),
    ),
)
