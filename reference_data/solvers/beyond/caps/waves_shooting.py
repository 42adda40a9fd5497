r"""Waves around a part of a sphere by shooting from the pole, with the strong equations (method a).

The equations of a wave are those of ``tube_waves/strong`` with R(s) in place of r0 and the inertia
:math:`\Lambda R\,(u, q, w)` of an eigenvalue. They are integrated in the logarithm of the arc together with
the state. At the pole the membrane is flat and stretched alike in both directions; regular solutions there
are powers of the arc, n - 1, n and n + 1. Their values at the clamp have a combination that vanishes where a
3 x 3 determinant is zero.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from reference_data.solvers.beyond.caps import shooting as shoot
from reference_data.solvers.beyond.caps.ring import Ring
from reference_data.solvers.beyond.tube_waves.strong import forces
from reference_data.solvers.core.newton import secant

Array = np.ndarray


def matrices(
    n: int, p: float, ring: Ring, base: tuple[float, float, float]
) -> tuple[Array, Array, Array, Array]:
    """Matrices of m and of m' less inertia, by the wave and by its slope."""
    unit, zero = np.eye(3), np.zeros(3)
    found = [
        forces(ring, n, p, base, *pair) for pair in [(e, zero) for e in unit] + [(zero, e) for e in unit]
    ]
    m, rest = (np.array([f[k] for f in found]).T for k in (0, 1))
    return m[:, :3], m[:, 3:], rest[:, :3], rest[:, 3:]


def regular(n: int, l0: float, alpha: float, s: float) -> Array:
    """Three regular waves with their forces, at a small arc."""
    m, m_s, rest, rest_s = matrices(n, 0.0, Ring(s, alpha), (l0 * s, l0, np.pi / 2))
    columns = []
    for k in (n - 1, n, n + 1):
        force = m + k / s * m_s
        wave = np.linalg.svd(k / s * force - rest - k / s * rest_s)[2][-1]
        columns.append(np.append(wave, force @ wave))
    return np.linalg.qr(np.array(columns).T)[0]


def rates(y: Array, log_s: float, of: shoot.Data, n: int, inertia: float) -> Array:
    """(l2, m, z), and three waves with their forces, by the logarithm of s."""
    s, sine = np.exp(log_s), np.sin(of.angle)
    radius, l2 = np.sin(s * sine) / sine, y[0]
    across, along = y[1], of.p * l2**2 * radius / 2
    l1 = shoot.stretch(l2, np.hypot(across, along), of.alpha)
    base = (radius * l2, l1, np.arctan2(across, along))
    m, m_s, rest, rest_s = matrices(n, of.p, Ring(radius, of.alpha), base)
    waves = y[3:].reshape(6, 3)
    slope = np.linalg.solve(m_s, waves[3:] - m @ waves[:3])
    turned = rest @ waves[:3] + rest_s @ slope - inertia * radius * waves[:3]
    return np.concatenate([shoot.rates(y[:3], log_s, of), s * slope.ravel(), s * turned.ravel()])


def determinant(l0: float, of: shoot.Data, n: int, inertia: float, how: shoot.Accuracy) -> float:
    """That of the values at the clamp."""
    length = of.angle / np.sin(of.angle)
    left = (1 - np.arange(how.steps + 1) / how.steps) ** shoot.SHORTER * np.log(how.piece)
    start = regular(n, l0, of.alpha, length * how.piece)
    force = shoot.meridional(l0, l0, of.alpha)
    y = np.concatenate([[l0, force, 0.0], start.ravel()])
    for begin, end in pairwise((np.log(length) + left).tolist()):
        y = shoot.extrapolated(lambda y, at: rates(y, at, of, n, inertia), y, begin, end)
        q, r = np.linalg.qr(y[3:].reshape(6, 3))  # without it all turn to the one that grows most
        y[3:] = (q * np.sign(np.diag(r))).ravel()
    return float(np.linalg.det(y[3:].reshape(6, 3)[:3]))


def eigenvalue(l0: float, of: shoot.Data, n: int, near: float, how: shoot.Accuracy) -> float:
    """The eigenvalue near a guess."""
    return secant(lambda value: determinant(l0, of, n, value, how), near, near * (1 + 1e-3), 0.1 * near)[0]


def pole(near: float, of: shoot.Data, how: shoot.Accuracy) -> float:
    """Stretch of the pole of the state at a pressure, near a guess."""
    return secant(lambda l0: float(shoot.shot(np.array(l0), of, how)[0]) - 1, near, near + 1e-5, 0.01)[0]
