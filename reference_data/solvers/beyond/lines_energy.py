"""Points at which waves around the free tube are neutral, by its energy as a surface in space.

At a prescribed displacement of the mid-plane the state is solved for, and the parameter of the tube is moved
until an eigenvalue of its waves is zero (``tube_waves.ritz``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.linalg import eigh

from reference_data.solvers.beyond.lines_collocation import Point, mesh_of
from reference_data.solvers.beyond.tube_waves import ritz
from reference_data.solvers.beyond.tube_waves.family import EVEN, Family
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import secant

BASES = ritz.Basis(10, 12), ritz.Basis(14, 14)
FAMILIES = {"n1": Family(1, EVEN), "n2": Family(2, EVEN)}
LOWEST = 4
"""Number of eigenvalues among which the neutral one is."""
APART = 1e-4
"""Distance of the two guesses of a secant."""


def solve(kind: str, tube: Tube, vary: str, points: Sequence[Point]) -> list[Array]:
    """The points with these displacements, on both bases, from the other method's as guesses.

    Returns:
        Rows u_max, p and the parameter; one column for each point.
    """
    return [np.array([_neutral(kind, tube, vary, at, basis) for at in points]).T for basis in BASES]


def _neutral(kind: str, tube: Tube, vary: str, at: Point, basis: ritz.Basis) -> tuple[float, float, float]:
    family, x = FAMILIES[kind], basis.nodes
    r, z = mesh_of(at.y[0]).evaluate(at.y[0], x).T[:2]
    near = float(at.c[1])
    here = [ritz.State(replace(tube, **{vary: near}), basis, r, z, float(at.c[0]))]

    def state(value: float) -> ritz.State:
        moved, old = replace(tube, **{vary: value}), here[0]
        height = old.z * moved.lf / old.tube.lf
        here[0] = ritz.solve(ritz.State(moved, basis, old.r, height, old.p), u_max=at.u_max)
        return here[0]

    values = eigh(*ritz.free(state(near), family), eigvals_only=True, subset_by_index=(0, LOWEST - 1))
    index = int(np.argmin(np.abs(values)))
    root, _ = secant(lambda value: ritz.eigenvalue(state(value), family, index), near, near + APART)
    return at.u_max, state(root).p, root
