"""Paper 2, figure 12 for the other tubes of figure 6: tractions in the patch.

The paper draws one tube; what it says of tractions is said of all. Reference tables of this study were
computed on finer grids than those of the figure.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

SETS = ((0, 1), (0, 2), (0.1, 2))
STICK = {s: tube(contact="adhesive", alpha=s[0], delta1=s[1]) for s in SETS}
BONDED = {s: STICK[s].at(phase="deflation", spring="bilateral") for s in SETS}
KINDS = (
    ("a", "inflation", STICK, (1.5, 2, 2.5, 3)),
    ("b", "deflation", BONDED, (2.5, 2, 1.5, 1, 0)),
)
PARTS = [(letter, phase, of, pressures, s) for letter, phase, of, pressures in KINDS for s in SETS]

SAME_ORDER = decide.Stated(2.5, "of the same order", "as for figure 12")


def same_order(solutions: Solutions) -> Finding:
    """Max |f_t| over max |f_k| at p = 3, and the inverse."""
    found = []
    for s in SETS:
        traction, spring = (
            solutions.number(STICK[s], At("p", 3.0), name) for name in ("traction_max", "spring_max")
        )
        found += [
            decide.at_most(f"f_t over f_k of {s}", traction / spring, SAME_ORDER),
            decide.at_most(f"f_k over f_t of {s}", spring / traction, SAME_ORDER),
        ]
    return decide.all_of(found)


def grows(solutions: Solutions) -> Finding:
    """|f_t| at the front rises with p in inflation."""
    states = [At("p", float(p)) for p in KINDS[0][3]]
    return decide.all_of(
        decide.rises(f"|f_t| of {s}", solutions.numbers(STICK[s], states, "traction_front")) for s in SETS
    )


CASE = Case(
    title="Tractions in the stuck patch of other tubes",
    source="Patil, Nordmark & Eriksson (2014), figure 12, for the other tubes of figure 6",
    panels=tuple(
        Panel(
            f"{letter}, {column}, {s[0]}, {s[1]}",
            x=Axis("Z", 0, 3),
            y=Axis(column, -3.5, 3.5, label=rf"${column}$"),
            title=rf"adhesive {phase}, $\alpha = {s[0]}$, $\delta_1 = {s[1]}$",
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(
                    of[s],
                    rf"$p = {p}$",
                    reference=f"fig12{letter}_alpha_{s[0]}_delta1_{s[1]}_p_{p}",
                    at=At("p", float(p)),
                    y=column,
                )
                for p in pressures
            ),
        )
        for letter, phase, of, pressures, s in PARTS
        for column in ("f_t", "f_k")
    ),
    checks=(
        Claim(
            "grows",
            "|f_t| at the front increases with p in inflation, for all tubes",
            tuple((STICK[s], At("p", float(p))) for s in SETS for p in KINDS[0][3]),
            grows,
        ),
        Claim(
            "same_order",
            "f_t and f_k are of the same order, for all tubes",
            tuple((STICK[s], At("p", 3.0)) for s in SETS),
            same_order,
        ),
    ),
    asked={"f_t": 5e-5, "f_k": 1e-6},
)
