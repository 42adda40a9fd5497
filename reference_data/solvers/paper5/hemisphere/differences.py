r"""Untracked central differences for the hanging hemisphere: a first state for the tracked solvers.

On n equal intervals in t, with R = sin t and stretches at the mid-points,

.. math:: (R W_1 r'/l_1)' = W_2 - p r z',\qquad (R W_1 z'/l_1)' = p r r',

where the sign of l2^2 l1 - 1 decides at each mid-point between taut and wrinkled (paper 5 of the thesis,
section 3.3). At the pole r = 0, and the vertical force balances the pressure on half an interval.
"""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper4 import material as wri

Array = np.ndarray
STEP = 1e-30
CAP = 0.02  # longest step of Newton's method


def residual(y: Array, level: float, kappa: float) -> Array:
    """Defects at the nodes from nodal (r, z)."""
    n = len(y) - 1
    h = np.pi / 2 / n
    R = np.sin(h * (np.arange(n) + 0.5))
    r, z = y[:, 0], y[:, 1]
    dr, dz = np.diff(r) / h, np.diff(z) / h
    l1, l2 = np.sqrt(dr * dr + dz * dz), (r[1:] + r[:-1]) / 2 / R
    tense = np.real(l2 * l2 * l1) > 1
    force = R * np.where(tense, mat.slope(l1, l2, 0.0), wri.relaxed_slope(l1, 0.0)) / l1
    hoop = np.where(tense, mat.slope(l2, l1, 0.0), 0.0)
    p = np.where(np.real(z) < level, kappa * (level - z), 0.0)
    out = np.empty_like(y)
    out[0] = r[0], force[0] * dz[0] - p[0] * r[1] ** 2 / 8
    out[1:-1, 0] = np.diff(force * dr) - h * (hoop[1:] + hoop[:-1]) / 2
    out[1:-1, 0] += p[1:-1] * r[1:-1] * (z[2:] - z[:-2]) / 2
    out[1:-1, 1] = np.diff(force * dz) - p[1:-1] * r[1:-1] * (r[2:] - r[:-2]) / 2
    out[-1] = r[-1] - 1, z[-1]
    return out


def newton(y: Array, level: float, kappa: float, max_iter: int = 200) -> Array:
    """Nodal (r, z) at a level, by Newton's method with short steps.

    Raises:
        RuntimeError: If it does not converge.
    """
    n = len(y) - 1
    for _ in range(max_iter):
        matrix = np.zeros((n + 1, 2, n + 1, 2))
        for colour in range(3):
            for c in range(2):
                nodes = np.arange(colour, n + 1, 3)
                bumped = y.astype(complex)
                bumped[nodes, c] += 1j * STEP
                slope = np.imag(residual(bumped, level, kappa)) / STEP
                for off in (-1, 0, 1):
                    inside = (nodes + off >= 0) & (nodes + off <= n)
                    matrix[nodes[inside] + off, :, nodes[inside], c] = slope[nodes[inside] + off]
        step = np.linalg.solve(matrix.reshape(2 * n + 2, -1), -residual(y, level, kappa).ravel())
        size = float(np.abs(step).max())
        y = y + step.reshape(-1, 2) * min(1.0, CAP / size)
        if size < 1e-10:
            return y
    raise RuntimeError(f"hemisphere: differences do not converge at zw = {level:g}")


def state(level: float, kappa: float, n: int = 120) -> tuple[Array, Array]:
    """Angles t and nodal (r, z) at a high level, starting from a sphere lowered by a fiftieth."""
    t = np.linspace(0, np.pi / 2, n + 1)
    return t, newton(np.stack([np.sin(t), -1.02 * np.cos(t)], axis=-1), level, kappa)
