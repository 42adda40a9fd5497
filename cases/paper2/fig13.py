"""Paper 2, figure 13: axial line force at the edge of the patch in deflation.

The definition of equation (22) holds the jump of the spring's term. With a bilateral spring the force rises
monotonically as p falls, for all four tubes; the paper's remark that it starts to fall at low pressure for an
unstretched tube holds for a unilateral spring.
"""

import numpy as np

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
BONDED = {
    s: tube(contact="adhesive", phase="deflation", spring="bilateral", alpha=s[0], delta1=s[1]) for s in SETS
}
PUSHING = {s: BONDED[s].at(spring="unilateral") for s in SETS}


def starts_at_zero(solutions: Solutions) -> Finding:
    """f_l(3) within its uncertainty of zero."""
    rows = [solutions.quantity(BONDED[s], At("p", 3.0), "line_force") for s in SETS]
    return all(q.value <= 2 * q.uncertainty for q in rows), ", ".join(f"{q.value:.1e}" for q in rows)


def rises_bilateral(solutions: Solutions) -> Finding:
    """With a bilateral spring f_l rises all the way to p = 0."""
    rows = [np.diff(solutions.branch(BONDED[s]).columns["line_force"]).min() for s in SETS]
    return min(rows) > 0, "smallest step: " + ", ".join(f"{r:.1e}" for r in rows)


def falls_unilateral(solutions: Solutions) -> Finding:
    """With a unilateral spring f_l has a maximum below 1; only unstretched tubes fall markedly after it."""
    falls = {}
    for s in SETS:
        force = solutions.branch(PUSHING[s]).columns["line_force"]
        falls[s] = (force.max(), 1 - force[-1] / force.max())
    good = all(peak < 1 for peak, _ in falls.values())
    good &= all(falls[a, 1][1] > 0.03 for a in (0, 0.1)) and all(falls[a, 2][1] < 0.01 for a in (0, 0.1))
    return good, "; ".join(
        f"{s}: maximum {peak:.4f}, falls by {fall:.1%}" for s, (peak, fall) in falls.items()
    )


def panel(name: str, title: str, curves: dict, table: str) -> Panel:
    """One reading of the spring."""
    return Panel(
        name,
        x=Axis("p", 0, 3),
        y=Axis("line_force", 0, 1, label=r"$f_l$"),
        title=title,
        curves=tuple(
            Curve(
                curves[s],
                rf"$\alpha = {s[0]}$, $\delta_1 = {s[1]}$",
                reference=f"fig06b_deflation_{table}_alpha_{s[0]}_delta1_{s[1]}",
            )
            for s in SETS
        ),
    )


CASE = Case(
    title="Line force at the edge of the patch",
    source="Patil, Nordmark & Eriksson (2014), figure 13",
    panels=(
        panel("bilateral", "spring of equation (9)", BONDED, "bilateral"),
        panel("unilateral", "spring that pushes only", PUSHING, "unilateral"),
    ),
    checks=(
        Claim(
            "starts_at_zero",
            "the line force is zero where deflation begins",
            tuple((BONDED[s], At("p", 3.0)) for s in SETS),
            starts_at_zero,
        ),
        Claim(
            "rises_bilateral",
            "with the spring of equation (9) the line force rises monotonically as p falls",
            tuple((BONDED[s], None) for s in SETS),
            rises_bilateral,
            differs="the text remarks that the line force of the unstretched tube begins to fall at low "
            "pressure; with the spring of the paper's equation (9) it rises all the way, and it falls "
            "only with a spring that pushes but does not pull",
        ),
        Claim(
            "falls_unilateral",
            "with a spring that pushes only the line force stays below 1 and falls at low pressure for the "
            "unstretched tube, not for the pre-stretched one",
            tuple((PUSHING[s], None) for s in SETS),
            falls_unilateral,
        ),
    ),
    asked={"line_force": 1e-3},
)
