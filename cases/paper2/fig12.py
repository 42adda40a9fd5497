"""Paper 2, figure 12: tractions in the patch, alpha = 0.1, delta1 = 1: f_t axial, f_k of the spring.

(a) adhesive inflation, (b) adhesive deflation with a bilateral spring. f_t is negative on the upper half
(towards the mid-plane); the paper plots its magnitude.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

STICK = tube(contact="adhesive", alpha=0.1, delta1=1)
BONDED = STICK.at(phase="deflation", spring="bilateral")
UP, DOWN = (1.5, 2, 2.5, 3), (2.5, 2, 1.5, 1, 0)


ABOUT = decide.Stated(
    0.3, "about p = 0.3", "the claim's own position; the tolerance is its distance from p = 0"
)
SAME_ORDER = decide.Stated(2.5, "of the same order", "no number is printed; well below a factor of ten")


def grows(solutions: Solutions) -> Finding:
    """|f_t| at the front rises with p in inflation."""
    return decide.rises("|f_t|", solutions.numbers(STICK, [At("p", float(p)) for p in UP], "traction_front"))


def at_the_edge(solutions: Solutions) -> Finding:
    """|f_t| over its largest value: near the centre, and that value's place."""
    found = []
    for spec, p in ((STICK, 3.0), *((BONDED, float(p)) for p in DOWN)):
        at = At("p", p, profile=(0.5,))
        traction, z = solutions.column(spec, at, "f_t"), solutions.profile(spec, at).columns["Z"]
        inside = z < solutions.value(spec, at, "Z_front")
        size = abs(traction[inside])
        found += [
            decide.at_most(f"p = {p}: at Z = 0.5", size[z[inside] == 0.5] / size.largest(), NEARLY_ZERO),
            decide.positive("that at the edge minus the others", size[-1] - size[:-1]),
        ]
    return decide.all_of(found)


NEARLY_ZERO = decide.Stated(0.01, "nearly zero", "no number is printed; a line of figure 12 is as wide")


def turns_up(solutions: Solutions) -> Finding:
    """|f_t| at the front in deflation: the pressure at its minimum."""
    p, values = (solutions.along(BONDED, name) for name in ("p", "traction_front"))
    i = int(values.value.argmin())
    return decide.all_of(
        decide.at_most("pressure at the minimum minus 0.3", abs(p[i] - 0.3), ABOUT),
        decide.less("|f_t|", values[i], values[-1], values[0]),
    )


def same_order(solutions: Solutions) -> Finding:
    """Max |f_t| over max |f_k| at p = 3."""
    traction, spring = (
        solutions.number(STICK, At("p", 3.0), name) for name in ("traction_max", "spring_max")
    )
    return decide.all_of(
        decide.at_most("f_t over f_k", traction / spring, SAME_ORDER),
        decide.at_most("f_k over f_t", spring / traction, SAME_ORDER),
    )


def pushes_then_pulls(solutions: Solutions) -> Finding:
    """f_k at the centre in deflation."""
    first, last = (solutions.column(BONDED, At("p", p, profile=()), "f_k")[0] for p in (2.5, 0.0))
    return decide.less("f_k at p = 2.5 and 0, on both sides of zero", first, 0, last)


CASE = Case(
    title="Tractions in the stuck patch",
    source="Patil, Nordmark & Eriksson (2014), figure 12",
    panels=tuple(
        Panel(
            f"{letter}, {column}",
            x=Axis("Z", 0, 3),
            y=Axis(column, -2.5, 2.5, label=rf"${column}$"),
            title=title,
            curves=tuple(
                Curve(of, rf"$p = {p}$", reference=f"fig12{letter}_p_{p}", at=At("p", float(p)), y=column)
                for p in pressures
            ),
        )
        for letter, title, of, pressures in (
            ("a", "adhesive inflation", STICK, UP),
            ("b", "adhesive deflation", BONDED, DOWN),
        )
        for column in ("f_t", "f_k")
    ),
    checks=(
        Claim(
            "grows",
            "|f_t| at the front increases with p in inflation",
            tuple((STICK, At("p", float(p))) for p in UP),
            grows,
        ),
        Claim(
            "turns_up",
            "in deflation |f_t| at the front decreases with p to about p = 0.3, then turns up slightly",
            ((BONDED, None),),
            turns_up,
            differs="according to the text the adhesive traction decreases with the pressure in deflation; "
            "below about p = 0.3 it increases again",
        ),
        Claim(
            "at_the_edge",
            "f_t is nearly zero in the central zone and largest at the edge of the patch",
            (
                (STICK, At("p", 3.0, profile=(0.5,))),
                *((BONDED, At("p", float(p), profile=(0.5,))) for p in DOWN),
            ),
            at_the_edge,
        ),
        Claim("same_order", "f_t and f_k are of the same order", ((STICK, At("p", 3.0)),), same_order),
        Claim(
            "pushes_then_pulls",
            "f_k changes sign at the centre during deflation with a bilateral spring",
            tuple((BONDED, At("p", float(p), profile=())) for p in DOWN),
            pushes_then_pulls,
        ),
    ),
    asked={"f_t": 1e-4, "f_k": 1e-6},
)
