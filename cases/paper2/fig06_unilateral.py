"""Paper 2, figure 6(b) again: adhesive deflation with a spring that pushes but does not pull.

The paper remarks that inflation and deflation curves closely match. With the spring of its equation (9),
which pulls a receding membrane outwards, they do not; with a spring that only pushes they do, down to zero
pressure. The mesh follows the place where the spring lets go of the patch, so that no kink is inside an
element.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
STICK = {s: tube(contact="adhesive", alpha=s[0], delta1=s[1]) for s in SETS}
PUSHING = {s: STICK[s].at(phase="deflation", spring="unilateral") for s in SETS}
LEVELS = (1.6, 2.0, 2.5)


CLOSELY = decide.Stated(
    1e-3, "closely match", "no number is printed; a line of figure 6 is several times as wide"
)


def match(solutions: Solutions) -> Finding:
    """u_max of deflation and inflation at the same pressures."""
    apart = []
    for s in SETS:
        up, down = (solutions.numbers(c[s], [At("p", p) for p in LEVELS], "u_max") for c in (STICK, PUSHING))
        apart.append(abs(down / up - 1))
    return decide.at_most("largest relative difference at p = 1.6, 2, 2.5", decide.join(apart), CLOSELY)


CASE = Case(
    title="Adhesive deflation with a unilateral spring",
    source="Patil, Nordmark & Eriksson (2014), figure 6(b) and its remarks",
    panels=(
        Panel(
            "b",
            x=Axis("p", 0, 3),
            y=Axis("u_max", 0, 0.6),
            title="deflation, the spring only pushes",
            curves=tuple(
                Curve(
                    PUSHING[s],
                    rf"$\alpha = {s[0]}$, $\delta_1 = {s[1]}$",
                    reference=f"fig06b_deflation_unilateral_alpha_{s[0]}_delta1_{s[1]}",
                )
                for s in SETS
            )
            + tuple(
                Curve(
                    PUSHING[a, 1],
                    rf"$\alpha = {a}$, $\delta_1 = 1$, nearly slack",
                    reference=f"fig06b_deflation_unilateral_low_alpha_{a}_delta1_1",
                )
                for a in (0, 0.1)
            ),
        ),
    ),
    checks=(
        Claim(
            "curves_match",
            "inflation and deflation curves closely match if the spring does not pull",
            tuple((c[s], At("p", p)) for c in (STICK, PUSHING) for s in SETS for p in LEVELS),
            match,
        ),
    ),
    asked={
        "u_max": 5e-8,
        "lam1_mid": 5e-9,
        "t1_mid": 5e-8,
        "line_force": 1e-5,
        "line_force_membrane": 1e-5,
        "traction_max": 3e-5,
        "spring_max": 5e-7,
    },
)
