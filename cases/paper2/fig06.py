"""Paper 2, figure 6: mid-plane displacement against pressure in constrained inflation and deflation.

Panel (a) frictionless, panel (b) adhesive inflation and deflation from p = 3. In deflation the patch is
bonded; by the paper's equation (9) the spring then pulls as well as it pushes ("bilateral").
"""

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Points, Solutions, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
SLIP = {s: tube(contact="frictionless", alpha=s[0], delta1=s[1]) for s in SETS}
STICK = {s: tube(contact="adhesive", alpha=s[0], delta1=s[1]) for s in SETS}
BONDED = {s: STICK[s].at(phase="deflation", spring="bilateral") for s in SETS}
PUSHING = {s: STICK[s].at(phase="deflation", spring="unilateral") for s in SETS}
PRESSURE, DISPLACEMENT = Axis("p", 0, 3), Axis("u_max", 0, 0.6)


def label(which: tuple[float, float], what: str = "") -> str:
    """Legend entry."""
    return rf"$\alpha = {which[0]}$, $\delta_1 = {which[1]}${what}"


def ordered(solutions: Solutions) -> Finding:
    """u_max rises with delta1 and falls with alpha at p = 1.5, 2, 3, for both contact laws."""
    good, worst = True, []
    for curves in (SLIP, STICK):
        for p in (1.5, 2.0, 3.0):
            u = {s: solutions.value(curves[s], At("p", p), "u_max") for s in SETS}
            good &= all(u[a, 2] > u[a, 1] for a in (0, 0.1)) and all(u[0, d] > u[0.1, d] for d in (1, 2))
            worst.append(min(u[0, 2] - u[0, 1], u[0.1, 2] - u[0.1, 1], u[0, 1] - u[0.1, 1]))
    return good, f"smallest difference {min(worst):.2e}"


def stiffens(solutions: Solutions) -> Finding:
    """du_max/dp just before first contact against its mean from p = 2 to 3."""
    ratios = []
    for s in SETS:
        columns = solutions.branch(SLIP[s]).columns
        free = columns["Z_front"] == 0
        u, p = columns["u_max"][free][-3:-1], columns["p"][free][-3:-1]
        after = solutions.value(SLIP[s], At("p", 3.0), "u_max") - solutions.value(
            SLIP[s], At("p", 2.0), "u_max"
        )
        ratios.append((u[1] - u[0]) / (p[1] - p[0]) / after)
    return min(ratios) > 5, "slope before contact over mean slope after: " + ", ".join(
        f"{r:.1f}" for r in ratios
    )


def laws_agree(solutions: Solutions) -> Finding:
    """At p = 3 both laws give u_max within 0.3 % and patches within 5 %, the adhesive one shorter."""
    at, good, rows = At("p", 3.0), True, []
    for s in SETS:
        u = [solutions.value(c[s], at, "u_max") for c in (SLIP, STICK)]
        length = [solutions.value(c[s], at, "contact_length") for c in (SLIP, STICK)]
        good &= abs(u[1] / u[0] - 1) < 3e-3 and 0.95 < length[1] / length[0] < 1 and length[0] < 6
        rows.append(f"u {u[1] / u[0] - 1:+.1e}, length {length[1] / length[0] - 1:+.1e}")
    return good, "adhesive against frictionless: " + "; ".join(rows)


def held_open(solutions: Solutions) -> Finding:
    """With a bilateral spring the tube stays open at p = 0; with a unilateral one it closes."""
    bonded = [solutions.value(BONDED[s], At("p", 0.0), "u_max") for s in SETS]
    closing = [solutions.value(PUSHING[s], At("p", 0.0), "u_max") for s in SETS if s[1] == 2]
    good = min(bonded) > 0.2 and max(abs(u) for u in closing) < 0.01
    return good, (
        "u_max at p = 0, bilateral: " + ", ".join(f"{u:.4f}" for u in bonded)
    ) + "; unilateral, delta1 = 2: " + ", ".join(f"{u:.1e}" for u in closing)


ENDS = tuple((c[s], At("p", p)) for c in (SLIP, STICK) for s in SETS for p in (1.5, 2.0, 3.0))

CASE = Case(
    title="Constrained inflation and deflation: displacement against pressure",
    source="Patil, Nordmark & Eriksson (2014), figure 6",
    panels=(
        Panel(
            "a",
            x=PRESSURE,
            y=DISPLACEMENT,
            title="frictionless",
            markers="contact_onset",
            curves=tuple(
                Curve(SLIP[s], label(s), reference=f"fig06a_alpha_{s[0]}_delta1_{s[1]}") for s in SETS
            ),
        ),
        Panel(
            "b",
            x=PRESSURE,
            y=DISPLACEMENT,
            title="adhesive: inflation, and deflation with a bilateral spring",
            markers="contact_onset",
            curves=tuple(
                Curve(STICK[s], label(s), reference=f"fig06b_alpha_{s[0]}_delta1_{s[1]}") for s in SETS
            )
            + tuple(
                Curve(
                    BONDED[s],
                    label(s, ", deflation"),
                    reference=f"fig06b_deflation_bilateral_alpha_{s[0]}_delta1_{s[1]}",
                )
                for s in SETS
            ),
        ),
    ),
    checks=(
        Points(
            "contact_onset",
            reference="contact_onset",
            base=tube(contact="frictionless"),
            parameters=("alpha", "delta1", "lf", "s"),
            asked={"p": 1e-6, "V": 1e-6},
        ),
        Claim(
            "ordered",
            "u_max grows with the pre-stretch and is larger for the neo-Hookean tube, for both contact laws",
            ENDS,
            ordered,
        ),
        Claim(
            "stiffens",
            "du_max/dp drops sharply at first contact",
            tuple((SLIP[s], At("p", p)) for s in SETS for p in (2.0, 3.0)),
            stiffens,
        ),
        Claim(
            "laws_agree",
            "frictionless and adhesive: u_max nearly equal, the adhesive patch the shorter by less than 5 %",
            tuple((c[s], At("p", 3.0)) for c in (SLIP, STICK) for s in SETS),
            laws_agree,
        ),
        Claim(
            "held_open",
            "by equation (9) the bonded substrate holds the tube open at p = 0; only a spring that does not "
            "pull lets it close",
            tuple((BONDED[s], At("p", 0.0)) for s in SETS)
            + tuple((PUSHING[s], At("p", 0.0)) for s in SETS if s[1] == 2),
            held_open,
        ),
    ),
    asked={
        "u_max": 1e-6,
        "contact_length": 1e-6,
        "Z_front": 1e-6,
        "lam1_mid": 1e-6,
        "lam2_mid": 1e-6,
        "t1_mid": 1e-6,
        "V": 1e-6,
        "line_force": 1e-3,
        "line_force_membrane": 1e-3,
        "traction_front": 1e-3,
        "traction_max": 1e-3,
        "spring_max": 1e-3,
    },
)
