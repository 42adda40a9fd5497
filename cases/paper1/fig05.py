"""Paper 1, figure 5: profiles and paths in adhesive deflation without peeling.

The end of inflation is not printed; here it is the last profile of figure 4: p = 3.477 (beta = 1) and 8.49
(beta = 2).
"""

import numpy as np
from scipy.interpolate import CubicSpline

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Path,
    Solutions,
    circular,
    decide,
    reference,
)

DOWN = {
    1: circular(alpha=0.1, beta=1, contact="adhesive", phase="deflation"),
    2: circular(alpha=0.1, beta=2, contact="adhesive", phase="deflation", p_end=8.49),
}
TURNS = {1: (2.4, 1.4), 2: (4.2, 2.2)}
"""Printed pressures between which the curvature changes its sign (table ``curvature_change`` has where)."""
PRINTED = {1: (0.6, 1.4, 2.4, 3.2), 2: (0.2, 2.2, 4.2, 6.43)}
CLEAR_OF_EDGE = 0.01
"""Distance of points from the edge, inside the patch."""
POINTS = tuple(i / 10 for i in range(1, 10))
PATHS = {beta: Path(DOWN[beta], f"paths_fig05{letter}", POINTS) for beta, letter in ((1, "a"), (2, "b"))}
OVER = {beta: [at.value for at in path.states(1)][::-1] for beta, path in PATHS.items()}
"""Pressures of the paths, from the highest one down."""


def bulges(solutions: Solutions) -> Finding:
    """Meridional curvature of the free part at the edge: positive at the higher pressure, then negative."""
    found = []
    for beta, (high, low) in TURNS.items():
        kappa = [solutions.number(DOWN[beta], At("p", p), "kappa") for p in (low, high)]
        found.append(
            decide.less(f"kappa at p = {low} and {high}, on both sides of zero", kappa[0], 0, kappa[1])
        )
    return decide.all_of(found)


def paths_differ(solutions: Solutions) -> Finding:
    """Radius of outer points at the lowest pressure of deflation, and in inflation at the same height."""
    found, ways = [], {1: decide.positive, 2: decide.negative}
    for beta, letter in ((1, "a"), (2, "b")):
        up = reference(1, f"paths_fig04{letter}")
        for x in (0.6, 0.8):
            at = PATHS[beta].states(1)[0]
            rho, eta = (solutions.samples(DOWN[beta], at, name)[POINTS.index(x)] for name in ("rho", "eta"))
            way = [up.columns[f"{name}_{x}"] for name in ("eta", "rho")]
            cubic, straight = float(CubicSpline(*way)(eta.value)), float(np.interp(eta.value, *way))
            before = decide.Number(cubic, abs(cubic - straight))
            found.append(ways[beta](f"radius of X = {x} inflating minus deflating", before - rho))
    return decide.all_of(found)


def rigid(solutions: Solutions) -> Finding:
    """sigma(X) - sigma(edge) at the same points of the patch, over the pressures."""
    found = []
    for beta, pressures in OVER.items():
        front = solutions.value(DOWN[beta], At("p", pressures[0]), "X_contact")
        inside = [i for i, x in enumerate(POINTS) if x < front - CLEAR_OF_EDGE]
        ats = [At("p", p, profile=POINTS) for p in pressures]
        rows = [
            solutions.samples(DOWN[beta], at, "sigma")[inside]
            - solutions.number(DOWN[beta], at, "sigma_contact")
            for at in ats
        ]
        found += [
            decide.agree(f"p = {p}", row, rows[0], 2e-7)
            for p, row in zip(pressures[1:], rows[1:], strict=True)
        ]
    return decide.all_of(found)


def tensile_from_the_edge(solutions: Solutions) -> Finding:
    """Points of the patch under tension as the pressure falls: the outer ones, and increasingly many."""
    found, shares = [], {}
    for beta, pressures in OVER.items():
        shares[beta] = []
        for p in pressures:
            at = At("p", p, profile=POINTS)
            where = solutions.profile(DOWN[beta], at).columns["X"]
            sigma = solutions.column(DOWN[beta], at, "sigma")[
                where < solutions.value(DOWN[beta], at, "X_contact")
            ]
            compressed, tensile = decide.sides(sigma, 0)
            found.append(decide.every("signs that are known", compressed | tensile))
            found.append(decide.every("tensile ones outside", np.diff(tensile.astype(int)) >= 0))
            shares[beta].append(float(tensile.mean()))
        found.append(
            decide.every(f"beta = {beta}: the tensile fraction does not decrease", np.diff(shares[beta]) >= 0)
        )
    found.append(decide.same("beta = 1, last tensile fraction", shares[1][-1], 1.0))
    found.append(decide.less("and the first one", shares[1][0], shares[1][-1]))
    return decide.all_of(found)


ALONG = tuple(wanted for path in PATHS.values() for wanted in path.wants(1))

CASE = Case(
    title="Profiles and paths in adhesive deflation",
    source="Patil, DasGupta & Eriksson (2015), figure 5",
    panels=tuple(
        Panel(
            letter,
            x=Axis("rho", 0, 1.2),
            y=Axis("eta", 0, 1.0),
            level=0.5,
            title=f"beta = {beta}",
            paths=(PATHS[beta],),
            edge="X_contact",
            curves=tuple(
                Curve(DOWN[beta], f"$p = {p:g}$", reference=f"fig05{letter}_p_{p:g}", at=At("p", p))
                for p in PRINTED[beta]
            ),
        )
        for letter, beta in (("a", 1), ("b", 2))
    ),
    checks=(
        Claim(
            "bulges",
            "the free part's curvature at the edge changes sign as the pressure falls",
            tuple((DOWN[b], At("p", p)) for b, pressures in TURNS.items() for p in pressures),
            bulges,
        ),
        Claim(
            "paths_differ",
            "outer points take other paths in deflation than in inflation: nearer to the axis without "
            "pre-stretch, farther from it with pre-stretch",
            ALONG,
            paths_differ,
        ),
        Claim("rigid", "the patch moves rigidly: sigma - sigma(edge) does not change", ALONG, rigid),
        Claim(
            "tensile_from_the_edge",
            "the contact stress becomes tensile first at the edge; the tensile zone grows inwards, for beta "
            "= 1 over the whole patch",
            ALONG,
            tensile_from_the_edge,
        ),
    ),
    asked={"rho": 5e-8, "eta": 1e-7, "lam1": 1e-6, "lam2": 1e-6, "t1": 5e-6, "t2": 2e-6, "sigma": 1e-7},
    quick=True,
)
