"""The relaxed Saint Venant-Kirchhoff energy in plane stress at points, with stresses and moduli.

Over Young's modulus and the thickness, with ``e_i = (x_i - 1)/2`` of the eigenvalues ``x_1 >= x_2`` of ``C``

    W = [e_1^2 + e_2^2 + 2 nu e_1 e_2] / (2 (1 - nu^2))   taut: e_2 > -nu e_1 and e_1 > 0
    W = e_1^2/2                                           wrinkled: e_1 > 0
    W = 0                                                 slack

as a function of ``c = (x_X.x_X, x_Y.x_Y, x_X.x_Y)``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Array = np.ndarray
TAUT, WRINKLED, SLACK = 1, 0, -1


@dataclass(frozen=True)
class Point:
    """Energy, its gradient ``(3, q)`` and Hessian ``(3, 3, q)`` in ``c``, and the state of each point."""

    energy: Array
    gradient: Array
    hessian: Array
    state: Array


def relaxed(c: Array, nu: float) -> Point:
    """The energy at points, for ``c`` of shape ``(3, q)``."""
    mean, half = (c[0] + c[1]) / 2, (c[0] - c[1]) / 2
    radius = np.hypot(half, c[2])
    e1, e2 = (mean + radius - 1) / 2, (mean - radius - 1) / 2
    state = np.where(e1 <= 0, SLACK, np.where(e2 > -nu * e1, TAUT, WRINKLED))
    wrinkled, taut = state == WRINKLED, state == TAUT
    # In a wrinkled point e2 < e1, so that the radius is not zero.
    r = np.where(wrinkled, radius, 1.0)
    slope = np.array([0.5 + half / (2 * r), 0.5 - half / (2 * r), c[2] / r])
    aa, ac, cc = (x / r**3 for x in (c[2] ** 2, -half * c[2], half**2))
    bend = np.array([[aa / 4, -aa / 4, ac / 2], [-aa / 4, aa / 4, -ac / 2], [ac / 2, -ac / 2, cc]])
    folded = e1 / 2 * slope, slope[:, None] * slope / 4 + e1 / 2 * bend
    k = 1 / (4 * (1 - nu**2))
    moduli = k * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, 2 * (1 - nu)]])
    strain = np.array([c[0] - 1, c[1] - 1, c[2]])
    stress = np.einsum("ij,jq->iq", moduli, strain)
    gradient = np.where(taut, stress, wrinkled * folded[0])
    hessian = np.where(taut, moduli[:, :, None], wrinkled * folded[1])
    energy = np.where(taut, (strain * stress).sum(axis=0) / 2, wrinkled * e1**2 / 2)
    return Point(energy, gradient, hessian, state)


def stresses(x1: Array, x2: Array, point: Point) -> tuple[Array, Array]:
    """Derivatives of the energy in the tangents ``x_X, x_Y`` of shape ``(3, q)``: first and second ones.

    Shapes ``(2, 3, q)`` and ``(2, 3, 2, 3, q)``, by direction and component.
    """
    g, tangents = point.gradient, np.array([x1, x2])
    factors = np.array([[2 * g[0], g[2]], [g[2], 2 * g[1]]])
    strain = np.zeros((3, 2, 3, x1.shape[1]))
    strain[0, 0], strain[1, 1], strain[2, 0], strain[2, 1] = 2 * x1, 2 * x2, x2, x1
    rate = np.einsum("mnq,nsjq->msjq", point.hessian, strain)
    moduli = np.einsum("mriq,msjq->risjq", strain, rate)
    for i in range(3):
        moduli[:, i, :, i] += factors
    return np.einsum("rsq,siq->riq", factors, tangents), moduli
