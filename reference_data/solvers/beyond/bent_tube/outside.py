r"""Second variation of a bent state outside of its symmetry, by the energy of method (a).

A displacement is a Fourier series in theta times polynomials along the tube, as the state is, with cosines
and sines exchanged where it is odd about the plane ``theta = 0``. Its wave numbers are those of the state, or
for ``n = 2`` the odd ones: such displacements change sign from one wave to the next. Odd about mid-length
means that ``X`` and ``Y`` vanish there in place of ``Z``. The mass is the mean over theta of
:math:`\int |q|^2`, over the pre-stretched tube.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from reference_data.solvers.beyond.bent_tube.energy import State, directions, stiffness
from reference_data.solvers.core.collocation import Array


def eigenvalues(state: State, odd: bool, middle_odd: bool, alternating: bool = False) -> Array:
    """All eigenvalues of a class at fixed pressure, in ascending order; that of the rotation is among them.

    Args:
        state: A bent state.
        odd: Whether the class is odd about the plane theta = 0.
        middle_odd: Whether it is odd about mid-length.
        alternating: Whether displacements change sign from one wave to the next.
    """
    series, nodes = state.series, len(state.series.basis.nodes)
    k = series.n * np.arange(series.highest + 1)
    if alternating:
        k = k[:-1] + series.n // 2
        waves = k, k, k
    else:
        waves = (k[1:], k, k[1:]) if odd else (k, k[1:], k)
    which = directions(series.angles, waves, odd)
    matrix = stiffness(state, which)
    _, _, phi, _ = series.basis.rule
    products = np.einsum("amp,anp->mn", which[0][..., :3], which[0][..., :3])
    weights = state.weights * state.tube.delta1
    mass = np.einsum("mn,gi,g,gj->minj", products, phi, weights, phi, optimize=True)
    first = np.cumsum([0, *map(len, waves)])
    rows = np.arange(first[-1])
    in_plane, axial = rows[: first[2]], rows[first[2] :]
    held = np.concatenate([rows * nodes + nodes - 1, (in_plane if middle_odd else axial) * nodes])
    free = np.setdiff1d(np.arange(first[-1] * nodes), held)
    cut = np.ix_(free, free)
    return eigh(matrix[cut], mass.reshape(matrix.shape)[cut], eigvals_only=True)
