"""Paper 5, figure 1: the four states of a sheet over its stretches, 0 to 5, and where they meet.

The states are bounded by lam2 = lam1^(-1/2), lam1 = lam2^(-1/2) and lam = 1. Energy and stresses are
continuous across every boundary, the tangent is not. The paper's appendix: the modified deformation gradient
gives the same energy.
"""

import numpy as np

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Finding,
    Line,
    Panel,
    Solutions,
    Spec,
    decide,
    wrinkled_material,
)

LAWS = (0.01, 0.0)
NAMES = ("W", "W1", "W2", "W11", "W12", "W22")
NEAR = 1e-7
"""Relative distance of the points on both sides of a boundary."""
CONTINUOUS = decide.Stated(
    50 * NEAR, "continuous", "a slope of 25 times the distance of the two sides; the tangent is below that"
)
JUMPS = decide.Stated(0.1, "the tangent is not", "a million times that; the tangent's own size is about 2")
ALONG = (1.2, 2.0, 3.5, 5.0)
"""Larger stretch of the points."""
ACROSS = (0.2, 0.5, 0.9)
"""Smaller stretch of the points, at the boundary to the slack state."""
BOUNDARIES = {
    "A/B": [lambda e, v=v: (v, v**-0.5 * (1 + e)) for v in ALONG],
    "A/C": [lambda e, v=v: (v**-0.5 * (1 + e), v) for v in ALONG],
    "B/D": [lambda e, v=v: (1 + e, v) for v in ACROSS],
    "C/D": [lambda e, v=v: (v, 1 + e) for v in ACROSS],
}


BEYOND = np.linspace(1, 5, 81)


def edge(x: np.ndarray, y: np.ndarray) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Points of a boundary."""
    return tuple(x.tolist()), tuple(y.tolist())


def sheet(stretches: tuple[float, float], c2: float, energy: str = "relaxed") -> Spec:
    """The solution at two stretches."""
    return wrinkled_material(l1=stretches[0], l2=stretches[1], c2=c2, energy=energy)


def found(solutions: Solutions, spec: Spec) -> np.ndarray:
    """Energy, stresses and tangent."""
    quantities = solutions.result(spec).quantities
    return np.array([quantities[name].value for name in NAMES])


def pairs(solutions: Solutions, points: list) -> list[np.ndarray]:
    """Jumps across the boundary at its points, for both laws, over the larger side."""
    out = []
    for point in points:
        for c2 in LAWS:
            below, above = (found(solutions, sheet(point(side * NEAR), c2)) for side in (-1, 1))
            out.append(np.abs(above - below) / np.maximum(1.0, np.abs(above)))
    return out


def continuous(solutions: Solutions) -> Finding:
    """Jumps of energy and stresses over each boundary, and of the tangent."""
    rows = []
    for name, points in BOUNDARIES.items():
        jumps = pairs(solutions, points)
        rows.append(decide.at_most(f"{name}: energy and stresses", [j[:3].max() for j in jumps], CONTINUOUS))
        rows.append(decide.at_least("tangent", [j[3:].max() for j in jumps], JUMPS))
    return decide.all_of(rows)


def stresses(solutions: Solutions) -> Finding:
    """Stresses on both sides: both above 0 in A, one of them 0 in B and C, both 0 in D."""
    rows = []
    expected = {
        "A/B": ((1, 0), (1, 1)),
        "A/C": ((0, 1), (1, 1)),
        "B/D": ((0, 0), (1, 0)),
        "C/D": ((0, 0), (0, 1)),
    }
    for name, points in BOUNDARIES.items():
        for point in points:
            for side, signs in zip((-1, 1), expected[name], strict=True):
                values = found(solutions, sheet(point(side * NEAR), LAWS[0]))[1:3]
                rows.append(decide.same(f"{name} {side:+d}", [int(v > 0) for v in values], list(signs)))
    return decide.all_of(rows)


def same_by_modified_gradient(solutions: Solutions) -> Finding:
    """The two forms on both sides of every boundary, relative to the largest number of each."""
    rows = []
    for point in POINTS:
        one, two = (
            found(solutions, sheet(point, LAWS[0], energy)) for energy in ("relaxed", "modified_gradient")
        )
        rows.append(decide.exact("relaxed and modified", one, two, max(1.0, np.abs(one).max())))
    return decide.all_of(rows)


POINTS = [point(side * NEAR) for points in BOUNDARIES.values() for point in points for side in (-1, 1)]
BOTH = tuple((sheet(p, c2), None) for p in POINTS for c2 in LAWS)
MODIFIED = tuple((sheet(p, LAWS[0], "modified_gradient"), None) for p in POINTS)

CASE = Case(
    title="States of a sheet",
    source="Patil, Nordmark & Eriksson (2016), figure 1 and appendix",
    panels=(
        Panel(
            "1",
            x=Axis("lam1", 0, 5, r"$\lambda_1$"),
            y=Axis("lam2", 0, 5, r"$\lambda_2$"),
            curves=(),
            title="A taut, B in tension along 1 (below), C along 2 (left), D slack",
            note="The boundaries; that the states of the weak form change there is checked below.",
            lines=(
                Line("A/B", *edge(BEYOND, BEYOND**-0.5)),
                Line("A/C", *edge(BEYOND**-0.5, BEYOND)),
                Line("B/D", (1.0, 1.0), (0.0, 1.0)),
                Line("C/D", (0.0, 1.0), (1.0, 1.0)),
            ),
        ),
    ),
    checks=(
        Claim(
            "continuous",
            "energy and stresses are continuous where two states meet, the tangent is not",
            BOTH,
            continuous,
        ),
        Claim(
            "stresses",
            "A is taut, B and C have tension in one direction, D has no stress; the boundaries are lam2 = "
            "lam1^(-1/2), "
            "lam1 = lam2^(-1/2) and lam = 1",
            BOTH,
            stresses,
        ),
        Claim(
            "same_by_modified_gradient",
            "the modified deformation gradient gives the relaxed energy (appendix)",
            (*BOTH, *MODIFIED),
            same_by_modified_gradient,
        ),
    ),
    quick=True,
)
