"""Paper 2, figure 9: profiles at p = 3 against the substrate, (a) frictionless, (b) adhesive."""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
SLIP = {s: tube(contact="frictionless", alpha=s[0], delta1=s[1]) for s in SETS}
STICK = {s: tube(contact="adhesive", alpha=s[0], delta1=s[1]) for s in SETS}
END = At("p", 3.0)


JUST = decide.Stated(
    1e-3, "just begins", "no number is printed; a thousandth of the radius is not visible in figure 9"
)
SIDEWAYS = decide.Stated(
    2, "bulge sideways", "no number is printed; the slope of the wall at the disk is less than half"
)
CURVATURE = decide.Stated(1e-4, "small", "t1 times the curvature of the plateau, which the balance neglects")


def overhang(solutions: Solutions) -> Finding:
    """Largest excess of eta over its value at the disk, frictionless, delta1 = 1."""
    most = {}
    for alpha in (0, 0.1):
        eta = solutions.samples(SLIP[alpha, 1], At("p", 3.0, profile=FINE), "eta")
        most[alpha] = (eta - eta[-1])[:-1].largest()
    return decide.all_of(
        decide.positive("alpha = 0", most[0]),
        decide.at_most("alpha = 0", most[0], JUST),
        decide.negative("alpha = 0.1", most[0.1]),
    )


def bulges(solutions: Solutions) -> Finding:
    """Slope of the wall at the disk and radius at the middle, for both contact laws."""
    found = []
    for laws, alpha in ((laws, alpha) for laws in (SLIP, STICK) for alpha in (0, 0.1)):
        steep, middle = {}, {}
        for d in (1, 2):
            columns = {
                n: solutions.column(laws[alpha, d], At("p", 3.0, profile=()), n) for n in ("rho", "eta")
            }
            rise, run = (abs(column[-1] - column[-2]) for column in columns.values())
            steep[d], middle[d] = run / rise, columns["rho"][0]
        found.append(decide.at_least(f"alpha = {alpha}: run over rise", steep[2] / steep[1], SIDEWAYS))
        found.append(decide.less("radius at the middle", middle[1], middle[2]))
    return decide.all_of(found)


def plateau(solutions: Solutions) -> Finding:
    """w_2 = P_eff rho lam1 at the mid-plane, that is t2 = P_eff rho, on the unstretched tube's plateau."""
    defects = []
    for alpha in (0, 0.1):
        rho, t2 = (solutions.column(SLIP[alpha, 1], At("p", 3.0, profile=()), n)[0] for n in ("rho", "t2"))
        effective = 3.0 - 20 * ((rho - 1.3) + (rho - 1.3) ** 2 / (2 * rho))
        defects.append(abs(t2 / (effective * rho) - 1))
    return decide.at_most("relative defect", decide.stack(defects), CURVATURE)


FINE = tuple(2.9 + 0.1 * i / 40 for i in range(41))

CASE = Case(
    title="Constrained profiles",
    source="Patil, Nordmark & Eriksson (2014), figure 9",
    panels=tuple(
        Panel(
            letter,
            x=Axis("eta", 0, 6),
            y=Axis("rho", 1, 2),
            title=title,
            mirrored=True,
            curves=tuple(
                Curve(
                    curves[s],
                    rf"$\alpha = {s[0]}$, $\delta_1 = {s[1]}$",
                    reference=f"fig09{letter}_alpha_{s[0]}_delta1_{s[1]}",
                    at=END,
                )
                for s in SETS
            ),
        )
        for letter, title, curves in (("a", "frictionless, p = 3", SLIP), ("b", "adhesive, p = 3", STICK))
    ),
    checks=(
        Claim(
            "bulges",
            "pre-stretched profiles bulge in radius, unstretched ones flatten and bulge sideways",
            tuple((laws[s], At("p", 3.0, profile=())) for laws in (SLIP, STICK) for s in SETS),
            bulges,
        ),
        Claim(
            "plateau",
            "on the frictionless plateau of the unstretched tube w_2 = P_eff rho lam1 holds up to the small "
            "curvature term",
            tuple((SLIP[a, 1], At("p", 3.0, profile=())) for a in (0, 0.1)),
            plateau,
        ),
        Claim(
            "overhang",
            "the unstretched neo-Hookean wall just starts to overhang the disk at p = 3 (eta exceeds its end "
            "value by less than 1e-3); the Mooney-Rivlin one does not",
            tuple((SLIP[a, 1], At("p", 3.0, profile=FINE)) for a in (0, 0.1)),
            overhang,
        ),
    ),
    asked={"rho": 1e-6, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-5, "t2": 2e-6},
)
