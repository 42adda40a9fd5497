"""Paper 1, figure 6: frictionless against adhesive contact at equal pressure, with and without pre-stretch.

(a) neo-Hookean at p = 4 (above the limit pressures of free inflation, which is possible with the substrate),
(b) Mooney-Rivlin at p = 6.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular, decide

PANELS = (("a", 0, 4.0, "neo-Hookean"), ("b", 0.1, 6.0, "Mooney-Rivlin"))
LAWS = ("frictionless", "adhesive")
PAIRS = {
    (alpha, beta, law): circular(alpha=alpha, beta=beta, contact=law, p_end=p + 0.5)
    for _, alpha, p, _ in PANELS
    for beta in (1, 2)
    for law in LAWS
}
AT = {alpha: At("p", p) for _, alpha, p, _ in PANELS}


def stick_indents_more(solutions: Solutions) -> Finding:
    """Pole height, peak stress, mean gradient of the stress and contact radius of both laws."""
    found = []
    for alpha, at in AT.items():
        for beta in (1, 2):
            slip, stick = (
                {
                    name: solutions.number(PAIRS[alpha, beta, law], at, name)
                    for name in ("t0", "sigma_pole", "X_contact", "rho_contact")
                }
                for law in LAWS
            )
            gradient = [abs(v["sigma_pole"]) / v["X_contact"] for v in (slip, stick)]
            found += [
                decide.less("t0", slip["t0"], stick["t0"]),
                decide.less("sigma_pole", stick["sigma_pole"], slip["sigma_pole"], 0),
                decide.less("mean gradient", *gradient),
                decide.less("rho_contact", stick["rho_contact"], slip["rho_contact"]),
            ]
    return decide.all_of(found)


BEYOND = decide.Stated(1.01, "bulges beyond its clamp", "no number is printed; a line of figure 6 is as wide")


def bulges(solutions: Solutions) -> Finding:
    """Largest radius at p = 6, frictionless, Mooney-Rivlin, compared with the clamp's radius."""
    at = At("p", 6.0, profile=())
    reach = {b: solutions.column(PAIRS[0.1, b, LAWS[0]], at, "rho") for b in (1, 2)}
    return decide.all_of(
        decide.at_least("beta = 1", reach[1].largest(), BEYOND),
        decide.less("beta = 2, without the clamp", reach[2][:-1].largest(), 1),
    )


WANTS = tuple((spec, AT[key[0]]) for key, spec in PAIRS.items())

CASE = Case(
    title="Frictionless against adhesive contact",
    source="Patil, DasGupta & Eriksson (2015), figure 6",
    panels=tuple(
        Panel(
            letter,
            x=Axis("rho", 0, 1.2),
            y=Axis("eta", 0, 1.0),
            level=0.5,
            title=f"{material}, p = {p:g}",
            curves=tuple(
                Curve(
                    PAIRS[alpha, beta, law],
                    rf"{law}, $\beta = {beta}$",
                    reference=f"fig06{letter}_{law}_beta_{beta}",
                    at=At("p", p),
                )
                for beta in (1, 2)
                for law in LAWS
            ),
        )
        for letter, alpha, p, material in PANELS
    ),
    checks=(
        Claim(
            "stick_indents_more",
            "at equal pressure adhesive contact has the deeper indentation, the larger peak stress and mean "
            "gradient of the stress, and the smaller patch",
            WANTS,
            stick_indents_more,
        ),
        Claim(
            "bulges",
            "without pre-stretch the membrane bulges beyond its clamp at a pressure at which the "
            "stretched one "
            "does not",
            tuple((PAIRS[0.1, b, LAWS[0]], At("p", 6.0, profile=())) for b in (1, 2)),
            bulges,
        ),
    ),
    asked={"rho": 1e-7, "eta": 1e-6, "lam1": 1e-6, "lam2": 1e-6, "t1": 5e-6, "t2": 1e-6, "sigma": 1e-7},
)
