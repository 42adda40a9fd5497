r"""Waves around a part of a sphere by its energy as a surface in space (method b).

The integrand is that of ``tube_waves/ritz``, with the radius R(S) at rest in place of r0. A wave
(u cos n th, q sin n th, w cos n th) is smooth at the pole if, with x = S^2,

.. math:: u + q = S^{n+1} (1 - x) P(x), \qquad u - q = S^{n-1} (1 - x) P(x), \qquad
          w = S^n (1 - x) P(x)

with a polynomial P of each. Eigenvalues are those of its second derivatives against
int R (u^2 + q^2 + w^2) ds.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from reference_data.solvers.beyond.caps.energy import Point
from reference_data.solvers.beyond.caps.ring import Ring
from reference_data.solvers.beyond.tube_waves.ritz import hessian

Array = np.ndarray


def meridian(at: Point) -> tuple[Ring, float, Array, Array]:
    """Radius at rest, length of the meridian, and (r, z) of a state with their slopes by the arc."""
    s, degree = at.basis.points, at.basis.degree
    angle, alpha = (at.mu, at.other) if at.vary == "angle" else (at.other, at.mu)
    sine = np.sin(angle)
    length = angle / sine
    radius, slope = np.sin(angle * s) / sine, np.cos(angle * s)
    hoop, hoop_s, z_s = at.basis.rows @ at.u
    z = (1 - s**2) * np.polynomial.legendre.legval(2 * s**2 - 1, at.u[degree + 1 :])
    place = np.array([radius * (1 + hoop), z])
    rates = np.array([slope * (1 + hoop) + radius * hoop_s / length, z_s / length])
    return Ring(radius, alpha), length, place, rates


def shapes(at: Point, n: int) -> Array:
    """Trial functions of (u, q, w) and their slopes in S, shape (2, 3, points, functions)."""
    s, unit = at.basis.points[:, None], np.eye(at.basis.degree + 1)
    t = 2 * s[:, 0] ** 2 - 1
    legendre = np.polynomial.legendre
    value = legendre.legvander(t, at.basis.degree)
    slope = 4 * s * np.stack([legendre.legval(t, legendre.legder(e)) for e in unit], axis=1)

    def times(power: int) -> Array:
        factor, rate = s**power * (1 - s**2), power * s ** max(power - 1, 0) - (power + 2) * s ** (power + 1)
        return np.array([factor * value, rate * value + factor * slope])

    more, less, height = times(n + 1) / 2, times(n - 1) / 2, times(n)
    none = np.zeros_like(more)
    parts = [[more, less, none], [more, -less, none], [none, none, height]]
    return np.stack([np.concatenate(part, axis=2) for part in parts], axis=1)


def lowest(at: Point, n: int) -> float:
    """The lowest eigenvalue for n waves at a state."""
    ring, length, (r, z), (r_s, z_s) = meridian(at)
    weights = at.basis.weights * length
    value, slope = shapes(at, n)
    slope = slope / length
    count = 4 * n + 2
    stiff = np.zeros((value.shape[2],) * 2)
    for angle in (np.arange(count) + 0.5) * 2 * np.pi / count:
        c, s, cn, sn = np.cos(angle), np.sin(angle), np.cos(n * angle), np.sin(n * angle)
        radial, hoop, axial = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])
        surface = (np.outer(v, a) + np.outer(axial, b) for v, a, b in (
            (radial, r, z), (radial, r_s, z_s), (hoop, r, 0 * z)))  # fmt: skip
        second = hessian(ring, -at.p, *surface)  # the pole is above the clamp
        moved = np.array([cn * radial, sn * hoop, cn * axial])
        turned = np.array([-n * sn * radial + cn * hoop, n * cn * hoop - sn * radial, -n * sn * axial])
        nine = np.concatenate([
            np.einsum("ia,ipk->apk", direction, by)
            for direction, by in ((moved, value), (moved, slope), (turned, value))
        ])  # fmt: skip
        stiff += 2 / count * np.einsum("apk,abp,bpl->kl", nine, second * weights, nine, optimize=True)
    mass = np.einsum("ipk,p,ipl->kl", value, weights * ring.r0, value, optimize=True)
    stiff = (stiff + stiff.T) / 2
    v = eigh(stiff, mass, subset_by_index=(0, 0))[1][:, 0]
    return float(v @ (stiff @ v) / (v @ (mass @ v)))  # the quotient has less rounding than the eigenvalue
