"""Paper 4, figure 3: wrinkling function along the fluid-filled membrane, delta = 3, Case 1, Af = (Af)_c.

This is figure 2 with more pre-stretch. At zw = 7.44 there are only two zones; the four of the text belong to
delta = 2.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, wrinkled_tube

LEVELS = (0, 3, 4.5, 6, 7.44, 10, 12, 16)
TUBES = {M: wrinkled_tube(M=M, delta=3) for M in (0.5, 1.5)}


def fronts(solutions: Solutions, M: float, level: float) -> list[decide.Number]:
    """Fronts from the lower end."""
    quantities = solutions.state(TUBES[M], At("zw", float(level))).quantities
    return [decide.number(q) for name, q in quantities.items() if name.startswith("Z_front")]


def two_zones(solutions: Solutions) -> Finding:
    """M = 1.5, delta = 3, zw = 7.44: wrinkled below, taut above."""
    gw = solutions.column(TUBES[1.5], At("zw", 7.44, profile=()), "gw")
    return decide.all_of(
        decide.same("fronts", len(fronts(solutions, 1.5, 7.44)), 1),
        decide.less("gw at both ends", gw[0], 1, gw[-1]),
    )


def front_rises(solutions: Solutions) -> Finding:
    """M = 0.5: one front, which moves up with the level."""
    found = [fronts(solutions, 0.5, level) for level in LEVELS[1:]]
    return decide.all_of(
        decide.same("fronts", [len(row) for row in found], [1] * len(found)),
        decide.rises("Z", [row[0] for row in found]),
    )


CASE = Case(
    title="Wrinkling function under fluid, delta = 3",
    source="Patil, Nordmark & Eriksson (2015), figure 3",
    panels=tuple(
        Panel(
            name,
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.6, 1.7),
            title=rf"$M = {M}$, $\delta = 3$",
            curves=tuple(
                Curve(
                    TUBES[M],
                    rf"$z_w = {v}$",
                    reference=f"fig03_M_{M}_zw_{v}",
                    at=At("zw", float(v), profile=()),
                )
                for v in LEVELS
            ),
        )
        for name, M in (("a", 0.5), ("b", 1.5))
    ),
    checks=(
        Claim(
            "two_zones",
            "M = 1.5, delta = 3, zw = 7.44: two zones only",
            ((TUBES[1.5], At("zw", 7.44, profile=())),),
            two_zones,
        ),
        Claim(
            "front_rises",
            "for M = 0.5 there is one front, which rises with the level",
            tuple((TUBES[0.5], At("zw", float(v), profile=())) for v in LEVELS),
            front_rises,
        ),
    ),
    asked={"r": 1e-8, "z": 5e-9, "lam1": 5e-9, "lam2": 1e-8, "gw": 5e-9, "tension": 5e-9},
)
