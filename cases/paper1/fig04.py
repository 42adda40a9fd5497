"""Paper 1, figure 4: profiles and paths of material points in adhesive inflation.

Both stretches of points that have touched are locked, and the patch moves vertically as a whole ("locked").
The unknowns that the text lists do not determine the problem; the vertical balance of the whole patch does.
(a) beta = 1, (b) beta = 2.
"""

import numpy as np

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

STICK = {
    1: circular(alpha=0.1, beta=1, contact="adhesive"),
    2: circular(alpha=0.1, beta=2, contact="adhesive", p_end=8.49),
}
FREE = {beta: circular(alpha=0.1, beta=beta) for beta in (1, 2)}
SAME_STATE = {(2, 2.66): "fig03b_p_2.66", (2, 4.49): "fig03b_p_4.49"}
FIRST_TOUCH = {1: 2.03, 2: 4.89}
PRINTED = {1: (0.408, 2.094, 2.833, 3.477), 2: (2.66, 4.49, 6.16, 8.49)}
CLEAR_OF_EDGE = 0.01
"""Distance of points from the edge, inside the patch."""
HUNDREDTHS = tuple(k / 100 for k in range(45, 66))
"""Pole heights in contact, around the substrate at l = 0.5, that count as round numbers."""
POINTS = tuple(i / 10 for i in range(1, 10))
PATHS = {beta: Path(STICK[beta], f"paths_fig04{letter}", POINTS) for beta, letter in ((1, "a"), (2, "b"))}
OVER = {beta: [at.value for at in path.states(1)] for beta, path in PATHS.items()}
LATE = {beta: [p for p in pressures if p > 1.05 * FIRST_TOUCH[beta]] for beta, pressures in OVER.items()}


def of(beta: int, p: float) -> Spec:
    """The free membrane below the pressure of first contact, the constrained one above.

    While the patch is small, the stretch at the clamp needs more cells.
    """
    if p < FIRST_TOUCH[beta]:
        return FREE[beta]
    return STICK[beta].on(cells=144) if p < 1.05 * FIRST_TOUCH[beta] else STICK[beta]


def samples(solutions: Solutions, beta: int, pressures: list[float], name: str) -> decide.Number:
    """A column at the material points of the paths, one row for each pressure."""
    at = [At("p", p, profile=POINTS) for p in pressures]
    return decide.stack(solutions.samples(STICK[beta], a, name) for a in at)


def vertical(solutions: Solutions) -> Finding:
    """Radius and stretches of points in contact while the pressure grows: frozen, not solved for."""
    found = []
    for beta, pressures in LATE.items():
        front = np.array([solutions.value(STICK[beta], At("p", p), "X_contact") for p in pressures])
        for name in ("rho", "lam1", "lam2"):
            values = samples(solutions, beta, pressures, name)
            for i, x in enumerate(POINTS):
                stuck = values[front > x + CLEAR_OF_EDGE, i]
                if len(stuck) > 1:
                    found.append(decide.constant(f"{name} of X = {x}", stuck, 1e-6))
    return decide.all_of(found)


def pole_frozen(solutions: Solutions) -> Finding:
    """The stretch at the pole against its value at first contact."""
    return decide.all_of(
        decide.agree(
            f"lam_pole, beta = {beta}",
            solutions.numbers(STICK[beta], [At("p", p) for p in pressures], "lam_pole"),
            solutions.point(STICK[beta], "contact_onset", "lam_pole"),
            5e-7,
        )
        for beta, pressures in LATE.items()
    )


def rise_to_the_edge(solutions: Solutions) -> Finding:
    """Both stretches along the patch at the last pressure, between points 0.1 apart."""
    found = []
    for beta, pressures in LATE.items():
        edge = solutions.value(STICK[beta], At("p", pressures[-1], profile=POINTS), "X_contact")
        inside = [i for i, x in enumerate(POINTS) if x < edge]
        found += [
            decide.rises(f"{name}, beta = {beta}", samples(solutions, beta, pressures[-1:], name)[0, inside])
            for name in ("lam1", "lam2")
        ]
    return decide.all_of(found)


def inflexion(solutions: Solutions) -> Finding:
    """Slope of the path of X = 0.6, which does not touch: it decreases, then increases."""
    found = []
    for beta, pressures in OVER.items():
        rho, eta = (
            samples(solutions, beta, pressures, name)[:, POINTS.index(0.6)] for name in ("rho", "eta")
        )
        slope = eta.diff() / rho.diff()
        found.append(decide.falls(f"deta/drho at first, beta = {beta}", slope[:2]))
        found.append(decide.rises("at last", slope[-2:]))
    return decide.all_of(found)


ALONG = tuple(wanted for path in PATHS.values() for wanted in path.wants(1))

CASE = Case(
    title="Profiles and paths in adhesive inflation",
    source="Patil, DasGupta & Eriksson (2015), figure 4",
    panels=tuple(
        Panel(
            letter,
            x=Axis("rho", 0, 1.2),
            y=Axis("eta", 0, 1.0),
            level=0.5,
            title=f"beta = {beta}",
            paths=(PATHS[beta],),
            curves=tuple(
                Curve(
                    of(beta, p),
                    f"$p = {p:g}$",
                    reference=SAME_STATE.get((beta, p), f"fig04{letter}_p_{p:g}"),
                    at=At("p", p),
                )
                for p in PRINTED[beta]
            ),
        )
        for letter, beta in (("a", 1), ("b", 2))
    ),
    checks=(
        Claim("vertical", "points in contact move vertically, with frozen stretches", ALONG, vertical),
        Claim("pole_frozen", "the pole keeps the stretch it had at first contact", ALONG, pole_frozen),
        Claim("rise_to_the_edge", "both stretches grow from the pole to the edge", ALONG, rise_to_the_edge),
        PrintedInput(
            "pressure 0.408 of figure 4a",
            "0.408",
            FREE[1],
            At("p", 0.408),
            "t0",
            searched=(0.25,),
            within=3e-3,
            source="legend of figure 4a",
        ),
        *(
            PrintedInput(
                f"pressure {p} of figure 4a",
                str(p),
                STICK[1],
                At("p", p),
                "t0",
                searched=HUNDREDTHS,
                within=3e-3,
                source="legend of figure 4a",
                decoded=False,
            )
            for p in PRINTED[1][1:]
        ),
        Claim(
            "inflexion",
            "paths of points outside, near the patch, first become flatter, then steeper",
            ALONG,
            inflexion,
        ),
    ),
    asked={"rho": 1e-7, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-4, "t2": 5e-6, "sigma": 5e-7},
)
