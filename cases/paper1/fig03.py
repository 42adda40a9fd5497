"""Paper 1, figure 3: profiles and paths of material points in free inflation and frictionless contact.

Mooney-Rivlin, alpha = 0.1, k = 50, l = 0.5; (a) beta = 1, (b) beta = 2. The pressures are the paper's
legends. Points in contact move outwards as the pressure grows; their paths diverge and have no inflexion.
"""

import numpy as np

from weakforms import (
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
)

SLIP = {beta: circular(alpha=0.1, beta=beta, contact="frictionless", p_end=9.0) for beta in (1, 2)}
FREE = {beta: circular(alpha=0.1, beta=beta) for beta in (1, 2)}
FIRST_TOUCH = {1: 2.03, 2: 4.89}
PRINTED = {1: (0.409, 1.659, 4.83, 7.10), 2: (2.66, 4.49, 6.81, 8.63)}
PATHS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
OVER = {
    1: tuple(At("p", p) for p in (0.1, 0.409, 1.0, 1.659, 2.1, 2.5, 3.0, 3.5, 4.0, 4.83, 5.5, 6.3, 7.10)),
    2: tuple(At("p", p) for p in (0.5, 1.5, 2.66, 3.6, 4.49, 5.0, 5.4, 5.8, 6.3, 6.81, 7.3, 8.0, 8.63)),
}
IN_CONTACT = {1: (2.5, 3.0, 3.5, 4.0, 4.83, 5.5, 6.3, 7.10), 2: (5.4, 5.8, 6.3, 6.81, 7.3, 8.0, 8.63)}


def of(beta: int, p: float) -> Spec:
    """The free membrane below the pressure of first contact, the constrained one above."""
    return FREE[beta] if p < FIRST_TOUCH[beta] else SLIP[beta]


def outwards(solutions: Solutions) -> Finding:
    """Radii of material points on the patch, over the pressures in contact."""
    worst, points = np.inf, 0
    for beta, pressures in IN_CONTACT.items():
        for x in (0.1, 0.2, 0.3):
            rho = []
            for p in pressures:
                at = At("p", p, profile=PATHS)
                inside = solutions.value(SLIP[beta], at, "X_contact") > x
                if inside:
                    rho.append(float(solutions.sampled(SLIP[beta], at, "rho")[0][PATHS.index(x)]))
            worst, points = min(worst, float(np.diff(rho).min())), points + len(rho)
    return worst > 0, f"smallest step of rho over {points} states of points in contact: {worst:.2e}"


def no_inflexion(solutions: Solutions) -> Finding:
    """Sign of the turning of the paths in the (rho, eta) plane, for points that touch late or never."""
    signs = set()
    for beta, over in OVER.items():
        for x in (0.3, 0.5, 0.7):
            xy = []
            for at in over:
                where = At(at.name, at.value, profile=PATHS)
                xy.append(
                    [solutions.sampled(SLIP[beta], where, n)[0][PATHS.index(x)] for n in ("rho", "eta")]
                )
            step = np.diff(np.array(xy), axis=0)
            turn = step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0]
            signs.add(tuple(np.unique(np.sign(turn))))
    return signs == {(-1.0,)}, f"signs of the turning along the paths of X = 0.3, 0.5, 0.7: {sorted(signs)}"


STATES = tuple((SLIP[b], At("p", p, profile=PATHS)) for b, ps in IN_CONTACT.items() for p in ps)
ALONG = tuple((SLIP[b], At(at.name, at.value, profile=PATHS)) for b, over in OVER.items() for at in over)

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
            paths=(Path(SLIP[beta], OVER[beta], PATHS),),
            curves=tuple(
                Curve(of(beta, p), f"$p = {p:g}$", reference=f"fig03{letter}_p_{p:g}", at=At("p", p))
                for p in PRINTED[beta]
            ),
        )
        for letter, beta in (("a", 1), ("b", 2))
    ),
    checks=(
        Claim("outwards", "points in contact move outwards as the pressure grows", STATES, outwards),
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
    asked={"rho": 1e-6, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-4, "t2": 1e-4, "sigma": 1e-4},
    quick=True,
)
