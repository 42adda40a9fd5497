"""Paper 1, figure 3: profiles and paths of material points in free inflation and frictionless contact.

Mooney-Rivlin, alpha = 0.1, k = 50, l = 0.5; (a) beta = 1, (b) beta = 2. The pressures are taken from the
paper's legends. Points in contact move outwards as the pressure grows; their paths diverge and have no
inflexion.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Path,
    PrintedInput,
    Solutions,
    Spec,
    circular,
    decide,
)

SLIP = {beta: circular(alpha=0.1, beta=beta, contact="frictionless", p_end=9.0) for beta in (1, 2)}
FREE = {beta: circular(alpha=0.1, beta=beta) for beta in (1, 2)}
FIRST_TOUCH = {1: 2.03, 2: 4.89}
PRINTED = {1: (0.409, 1.659, 4.83, 7.10), 2: (2.66, 4.49, 6.81, 8.63)}
POINTS = tuple(i / 10 for i in range(1, 10))
SHORT = {"rho": 1e-8, "eta": 1e-8}
"""Accuracy asked of paths, relative to their own largest value (small near the axis and the clamp)."""
PATHS = {
    beta: Path(SLIP[beta], f"paths_fig03{letter}", POINTS, SHORT) for beta, letter in ((1, "a"), (2, "b"))
}


def of(beta: int, p: float) -> Spec:
    """The free membrane below the pressure of first contact, the constrained one above."""
    return FREE[beta] if p < FIRST_TOUCH[beta] else SLIP[beta]


def outwards(solutions: Solutions) -> Finding:
    """Radii of material points on the patch, over the pressures in contact."""
    found = []
    for beta, path in PATHS.items():
        for x in (0.1, 0.2, 0.3):
            inside = [at for at in path.states(1) if solutions.value(SLIP[beta], at, "X_contact") > x]
            rho = decide.stack(solutions.samples(SLIP[beta], at, "rho")[POINTS.index(x)] for at in inside)
            found.append(decide.rises(f"rho of X = {x}", rho))
    return decide.all_of(found)


def no_inflexion(solutions: Solutions) -> Finding:
    """Curvature of the paths in the (rho, eta) plane, for points that touch late or never."""
    found = []
    for beta, path in PATHS.items():
        for x in (0.3, 0.5, 0.7):
            rho, eta = (
                decide.stack(
                    solutions.samples(SLIP[beta], at, n)[POINTS.index(x)] for at in path.states(1)
                ).diff()
                for n in ("rho", "eta")
            )
            found.append(decide.negative(f"turning of X = {x}", rho[:-1] * eta[1:] - eta[:-1] * rho[1:]))
    return decide.all_of(found)


ALONG = tuple(wanted for path in PATHS.values() for wanted in path.wants(1))

CASE = Case(
    title="Profiles and paths in frictionless contact",
    source="Patil, DasGupta & Eriksson (2015), figure 3",
    panels=tuple(
        Panel(
            letter,
            x=Axis("rho", 0, 1.2),
            y=Axis("eta", 0, 1.0),
            level=0.5,
            title=f"beta = {beta}",
            paths=(PATHS[beta],),
            curves=tuple(
                Curve(of(beta, p), f"$p = {p:g}$", reference=f"fig03{letter}_p_{p:g}", at=At("p", p))
                for p in PRINTED[beta]
            ),
        )
        for letter, beta in (("a", 1), ("b", 2))
    ),
    checks=(
        Claim("outwards", "points in contact move outwards as the pressure grows", ALONG, outwards),
        Claim("no_inflexion", "paths of material points diverge without inflexion", ALONG, no_inflexion),
        *(
            PrintedInput(
                f"pressure {p} of figure {where}",
                str(p),
                SLIP[beta],
                At("p", p),
                "t0",
                searched=(t0,),
                within=3e-3,
                source=f"legend of figure {where}",
            )
            for p, beta, t0, where in (
                (0.409, 1, 0.25, "3a"),
                (1.659, 1, 0.45, "3a"),
                (2.66, 2, 0.25, "3b"),
                (4.49, 2, 0.45, "3b"),
            )
        ),
    ),
    asked={"rho": 1e-9, "eta": 2e-9, "lam1": 1e-6, "lam2": 1e-9, "t1": 2e-6, "t2": 5e-7, "sigma": 1e-8},
    quick=True,
)
