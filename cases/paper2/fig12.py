"""Paper 2, figure 12: tractions in the patch, alpha = 0.1, delta1 = 1: f_t axial, f_k of the spring.

(a) adhesive inflation, (b) adhesive deflation with a bilateral spring. f_t is negative on the upper half
(towards the mid-plane); the paper plots its magnitude.
"""

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, tube

STICK = tube(contact="adhesive", alpha=0.1, delta1=1)
BONDED = STICK.at(phase="deflation", spring="bilateral")
UP, DOWN = (1.5, 2, 2.5, 3), (2.5, 2, 1.5, 1, 0)


def grows(solutions: Solutions) -> Finding:
    """|f_t| at the front rises with p in inflation."""
    values = [solutions.value(STICK, At("p", float(p)), "traction_front") for p in UP]
    return values == sorted(values), ", ".join(f"{v:.4f}" for v in values)


def turns_up(solutions: Solutions) -> Finding:
    """|f_t| at the front in deflation: where it is smallest."""
    columns = solutions.branch(BONDED).columns
    i = int(columns["traction_front"].argmin())
    p, values = columns["p"], columns["traction_front"]
    return 0.1 < p[i] < 0.6 and values[-1] > values[i], (
        f"from {values[0]:.4f} at p = 3 to {values[i]:.4f} at p = {p[i]:.2f}, then {values[-1]:.4f} at p = 0"
    )


def same_order(solutions: Solutions) -> Finding:
    """Max |f_t| over max |f_k| at p = 3."""
    state = At("p", 3.0)
    ratio = solutions.value(STICK, state, "traction_max") / solutions.value(STICK, state, "spring_max")
    return 0.4 < ratio < 1.6, f"ratio {ratio:.3f}"


def pushes_then_pulls(solutions: Solutions) -> Finding:
    """f_k at the centre in deflation."""
    centre = {p: solutions.profile(BONDED, At("p", float(p), profile=())).columns["f_k"][0] for p in DOWN}
    return centre[2.5] < 0 < centre[0], ", ".join(f"p = {p}: {v:.4f}" for p, v in centre.items())


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
            differs="the text has the adhesive traction decrease with the pressure in deflation; below about "
            "p = 0.3 it turns up again",
        ),
        Claim("same_order", "f_t and f_k are of the same order", ((STICK, At("p", 3.0)),), same_order),
        Claim(
            "pushes_then_pulls",
            "f_k changes sign at the centre during deflation with a bilateral spring",
            tuple((BONDED, At("p", float(p), profile=())) for p in DOWN),
            pushes_then_pulls,
        ),
    ),
    asked={"f_t": 1e-3, "f_k": 1e-3},
)
