"""Paper 4, figure 11: wrinkling function in Case 2 with little variation of thickness, M = 0.9, delta = 2.

There is no wrinkling at any pressure, not even without load.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, wrinkled_tube

TUBE = wrinkled_tube(M=0.9, delta=2, load="gas", Af=1)
PRESSURES = (0, 0.05, 0.1, 0.2)


def taut(solutions: Solutions) -> Finding:
    """Smallest gw at each pressure."""
    return decide.positive(
        "gw_min - 1", solutions.numbers(TUBE, [At("p", float(p)) for p in PRESSURES], "gw_min") - 1
    )


CASE = Case(
    title="Case 2 without wrinkling",
    source="Patil, Nordmark & Eriksson (2015), figure 11",
    panels=(
        Panel(
            "11",
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.95, 1.6),
            title=r"$M = 0.9$, $\delta = 2$, $A_f = A_o$",
            curves=tuple(
                Curve(TUBE, rf"$p = {p}$", reference=f"fig11_p_{p}", at=At("p", float(p), profile=()))
                for p in PRESSURES
            ),
        ),
    ),
    checks=(
        Claim(
            "taut",
            "with M = 0.9 in Case 2 the membrane is taut everywhere at every pressure",
            tuple((TUBE, At("p", float(p))) for p in PRESSURES),
            taut,
        ),
    ),
    asked={"r": 5e-9, "z": 5e-9, "lam1": 5e-9, "lam2": 5e-9, "gw": 5e-9, "tension": 5e-9},
    quick=True,
)
