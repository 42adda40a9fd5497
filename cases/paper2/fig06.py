"""Paper 2, figure 6: mid-plane displacement against pressure in constrained inflation and deflation.

Panel (a) frictionless, panel (b) adhesive inflation and deflation from p = 3. In deflation the patch is
bonded; by the paper's equation (9) the spring then both pulls and pushes ("bilateral").
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Points, Solutions, decide, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
SLIP = {s: tube(contact="frictionless", alpha=s[0], delta1=s[1]) for s in SETS}
STICK = {s: tube(contact="adhesive", alpha=s[0], delta1=s[1]) for s in SETS}
BONDED = {s: STICK[s].at(phase="deflation", spring="bilateral") for s in SETS}
PUSHING = {s: STICK[s].at(phase="deflation", spring="unilateral") for s in SETS}
PRESSURE, DISPLACEMENT = Axis("p", 0, 3), Axis("u_max", 0, 0.6)


def label(which: tuple[float, float], what: str = "") -> str:
    """Legend entry."""
    return rf"$\alpha = {which[0]}$, $\delta_1 = {which[1]}${what}"


SHARPLY = decide.Stated(
    5, "sharply", "no number is printed; a kink of figure 6 that a reader sees without a ruler"
)
NEARLY_EQUAL = decide.Stated(
    3e-3, "nearly equal", "no number is printed; the width of a line in figure 6, 0.6 high"
)
SHORTER = decide.Stated(0.05, "by less than 5 %", "the claim's own number")
OPEN = decide.Stated(
    0.2, "held open", "two thirds of the substrate's distance 0.3: most of the inflation is kept"
)
CLOSED = decide.Stated(0.01, "close", "a thirtieth of the substrate's distance 0.3")


def ordered(solutions: Solutions) -> Finding:
    """u_max rises with delta1 and falls with alpha at p = 1.5, 2, 3, for both contact laws."""
    found = []
    for curves in (SLIP, STICK):
        for p in (1.5, 2.0, 3.0):
            u = {s: solutions.number(curves[s], At("p", p), "u_max") for s in SETS}
            found += [decide.less(f"alpha = {a}, p = {p}", u[a, 1], u[a, 2]) for a in (0, 0.1)]
            found += [decide.less(f"delta1 = {d}, p = {p}", u[0.1, d], u[0, d]) for d in (1, 2)]
    return decide.all_of(found)


def stiffens(solutions: Solutions) -> Finding:
    """du_max/dp over the last step before first contact, compared with its mean from p = 2 to 3."""
    ratios = []
    for s in SETS:
        u, p = (solutions.along(SLIP[s], name) for name in ("u_max", "p"))
        last = (
            int((solutions.branch(SLIP[s]).columns["Z_front"] == 0).sum()) - 2
        )  # the onset is the next point
        before = (u[last] - u[last - 1]) / (p[last] - p[last - 1])
        low, high = (solutions.number(SLIP[s], At("p", v), "u_max") for v in (2.0, 3.0))
        ratios.append(before / (high - low))
    return decide.at_least("slope before contact over mean slope after", decide.stack(ratios), SHARPLY)


def laws_agree(solutions: Solutions) -> Finding:
    """At p = 3 both laws give nearly the same u_max and patches, the adhesive one shorter."""
    at, found = At("p", 3.0), []
    for s in SETS:
        u, length = (
            [solutions.number(c[s], at, name) for c in (SLIP, STICK)] for name in ("u_max", "contact_length")
        )
        found += [
            decide.at_most("u_max apart", abs(u[1] / u[0] - 1), NEARLY_EQUAL),
            decide.at_most("patch shorter", 1 - length[1] / length[0], SHORTER),
            decide.less("patches and l_f", length[1], length[0], 6),
        ]
    return decide.all_of(found)


def held_open(solutions: Solutions) -> Finding:
    """With a bilateral spring the tube stays open at p = 0; with a unilateral one it closes."""
    bonded = decide.stack(solutions.number(BONDED[s], At("p", 0.0), "u_max") for s in SETS)
    closing = decide.stack(solutions.number(PUSHING[s], At("p", 0.0), "u_max") for s in SETS if s[1] == 2)
    return decide.all_of(
        decide.at_least("u_max at p = 0, bilateral", bonded, OPEN),
        decide.at_most("|u_max|, unilateral, delta1 = 2", abs(closing), CLOSED),
    )


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
            asked={"p": 5e-10, "V": 2e-9},
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
            "frictionless and adhesive contact have nearly equal u_max, and the adhesive patch is shorter by "
            "less than 5 %",
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
        "u_max": 5e-9,
        "contact_length": 1e-6,
        "Z_front": 1e-6,
        "lam1_mid": 5e-9,
        "lam2_mid": 1e-9,
        "t1_mid": 2e-8,
        "V": 1e-7,
        "line_force": 1e-5,
        "line_force_membrane": 1e-5,
        "traction_front": 5e-5,
        "traction_max": 2e-5,
        "spring_max": 1e-6,
    },
)
