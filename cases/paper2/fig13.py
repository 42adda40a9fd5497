"""Paper 2, figure 13: axial line force at the edge of the patch in deflation.

The definition in equation (22) includes the jump of the spring's term. With a bilateral spring the force
rises monotonically as p falls, for all four tubes; the paper's remark that it starts to fall at low pressure
for an unstretched tube is true for a unilateral spring.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, reference, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
BONDED = {
    s: tube(contact="adhesive", phase="deflation", spring="bilateral", alpha=s[0], delta1=s[1]) for s in SETS
}
PUSHING = {s: BONDED[s].at(spring="unilateral") for s in SETS}


def falling(s: tuple[float, float]) -> list[At]:
    """States at the pressures of a curve's table, from the highest one down."""
    table = reference(2, f"fig06b_deflation_bilateral_alpha_{s[0]}_delta1_{s[1]}")
    return [At("p", float(p)) for p in sorted(table.columns["p"], reverse=True)]


FALLS = decide.Stated(0.03, "falls", "no number is printed; three times the limit for not falling")
DOES_NOT = decide.Stated(
    0.01, "not for the pre-stretched one", "no number is printed; a line of figure 13 is as wide"
)


def starts_at_zero(solutions: Solutions) -> Finding:
    """f_l(3) is zero within its uncertainty; its value at p = 0 is not."""
    return decide.all_of(
        decide.zero(f"f_l of {s}", solutions.number(BONDED[s], At("p", 3.0), "line_force"), 2e-5)
        for s in SETS
    )


def rises_bilateral(solutions: Solutions) -> Finding:
    """With a bilateral spring f_l rises down to p = 0."""
    return decide.all_of(
        decide.rises(f"f_l of {s}", solutions.numbers(BONDED[s], falling(s), "line_force")) for s in SETS
    )


def falls_unilateral(solutions: Solutions) -> Finding:
    """With a unilateral spring f_l has a maximum below 1; only unstretched tubes fall markedly after it."""
    found = []
    for s in SETS:
        force = solutions.along(PUSHING[s], "line_force")
        peak = force[int(force.value.argmax())]
        fall = 1 - force[-1] / peak
        found.append(decide.less(f"largest f_l of {s}", peak, 1))
        found.append(
            decide.at_least("falls by", fall, FALLS)
            if s[1] == 1
            else decide.at_most("falls by", fall, DOES_NOT)
        )
    return decide.all_of(found)


def panel(name: str, title: str, curves: dict, table: str) -> Panel:
    """Panel for one kind of spring."""
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
        panel("unilateral", "spring that only pushes", PUSHING, "unilateral"),
    ),
    checks=(
        Claim(
            "starts_at_zero",
            "the line force is zero at the start of deflation",
            tuple((BONDED[s], At("p", 3.0)) for s in SETS),
            starts_at_zero,
        ),
        Claim(
            "rises_bilateral",
            "with the spring of equation (9) the line force rises monotonically as p falls",
            tuple((BONDED[s], at) for s in SETS for at in falling(s)),
            rises_bilateral,
            differs="the text remarks that the line force of the unstretched tube starts to fall at low "
            "pressure; with the spring of the paper's equation (9) it rises down to p = 0, and it falls only "
            "with a spring that pushes but does not pull",
        ),
        Claim(
            "falls_unilateral",
            "with a spring that only pushes the line force stays below 1 and falls at low pressure for the "
            "unstretched tube, not for the pre-stretched one",
            tuple((PUSHING[s], None) for s in SETS),
            falls_unilateral,
        ),
    ),
    asked={"line_force": 1e-5},
)
