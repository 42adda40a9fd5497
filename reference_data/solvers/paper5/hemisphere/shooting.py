r"""The hanging hemisphere under liquid by shooting from the pole: fronts and level are events.

Unknowns r, z and the components A, F of the meridional tension per radian,

.. math::
   r' = l A/T,\quad z' = l F/T,\quad A' = W_2 - p r z',\quad F' = p r r',\qquad
   T = \sqrt{A^2 + F^2} = R W_1(l, r/R),

valid in both taut and wrinkled parts (paper 5 of the thesis, section 3.3), from the pole's
expansion at a small angle t0,

.. math::
   l_1 = \lambda + \alpha t^2,\quad l_2 = \lambda + \beta t^2,\quad b = \pi/2 - c t,\quad
   c = p \lambda^2/(2 W_1),

with errors O(t0^4); the stretch lambda and the height of the pole are found by Newton's method from
r = 1 and z = 0 at the equator. Adaptive eighth-order Runge-Kutta steps; no pattern is given.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper5.hemisphere.collocation import EQUATOR, KAPPA

Array = np.ndarray


@dataclass(frozen=True)
class Tolerance:
    """End of the pole's expansion, and the relative tolerance of a step."""

    t0: float
    rtol: float


TOLERANCES = (Tolerance(2e-3, 1e-11), Tolerance(1e-3, 1e-13))


def stretch(force: float, l2: float, tense: bool, start: float = 0.0) -> float:
    """Root l of W_1(l, l2) = force, or of W_r'(l) = force; both rise and are concave."""
    l1 = start or max(force / 2, 0.7)
    for _ in range(60):
        if tense:
            step = (force - mat.slope(l1, l2, 0.0)) / mat.curvature(l1, l2, 0.0)
        else:
            step = (force - wri.relaxed_slope(l1, 0.0)) / wri.relaxed_curvature(l1, 0.0)
        l1 = max(l1 + step, 0.3)
        if abs(step) < 1e-15 * l1:
            break
    return l1


def pole(stretch0: float, z0: float, zw: float, t0: float) -> Array:
    """(r, z, A, F) at t0 from the expansion."""
    w = mat.slope(stretch0, stretch0, 0.0)
    w11, w12 = mat.curvature(stretch0, stretch0, 0.0), mat.mixed(stretch0, stretch0, 0.0)
    c = KAPPA * (zw - z0) * stretch0**2 / (2 * w)
    shift = stretch0 * (c * c - 1) / 2  # alpha = 3 beta + shift
    slope = 3 * (3 * w11 - w12) + 3 * w12 - w11
    beta = (w * (1 - c * c) / 2 - (3 * w11 - w12) * shift) / slope
    alpha = 3 * beta + shift
    l1, l2 = stretch0 + alpha * t0**2, stretch0 + beta * t0**2
    R, b = np.sin(t0), np.pi / 2 - c * t0
    tension = R * mat.slope(l1, l2, 0.0)
    return np.array([R * l2, z0 + stretch0 * c * t0**2 / 2, tension * np.sin(b), tension * np.cos(b)])


@dataclass
class Piece:
    """A smooth part: its ends, flags, and a dense interpolant of (r, z, A, F)."""

    low: float
    high: float
    tense: bool
    wet: bool
    curve: object


def shot(stretch0: float, z0: float, zw: float, tol: Tolerance) -> tuple[list[Piece], Array]:
    """Pieces from the pole to the equator, and the last values."""
    t, y, tense, wet, pieces = tol.t0, pole(stretch0, z0, zw, tol.t0), True, True, []

    while t < EQUATOR:
        memory = [0.0]

        def rates(t: float, y: Array, tense: bool = tense, wet: bool = wet, memory: list = memory) -> Array:
            R, tension = np.sin(t), np.hypot(y[2], y[3])
            l2 = y[0] / R
            l1 = memory[0] = stretch(tension / R, l2, tense, memory[0])
            dr, dz = l1 * y[2] / tension, l1 * y[3] / tension
            w2 = mat.slope(l2, l1, 0.0) if tense else 0.0
            p = KAPPA * (zw - y[1]) if wet else 0.0
            return np.array([dr, dz, w2 - p * y[0] * dz, p * y[0] * dr])

        def front(t: float, y: Array, tense: bool = tense) -> float:
            R = np.sin(t)
            l2 = y[0] / R
            return l2 * l2 * stretch(np.hypot(y[2], y[3]) / R, l2, tense) - 1

        def surface(t: float, y: Array) -> float:
            return y[1] - zw

        front.terminal = surface.terminal = True
        front.direction, surface.direction = (-1.0 if tense else 1.0), 1.0
        events = [front, surface] if wet else [front]
        out = solve_ivp(
            rates,
            (t, EQUATOR),
            y,
            method="DOP853",
            rtol=tol.rtol,
            atol=1e-3 * tol.rtol,
            events=events,
            dense_output=True,
            first_step=min(t / 10, 1e-4, (EQUATOR - t) / 2),
        )
        if not out.success:
            raise RuntimeError(f"hemisphere, shooting: {out.message}")
        end = float(out.t[-1])
        pieces.append(Piece(t, end, tense, wet, out.sol))
        t, y = end, out.y[:, -1]
        if out.status == 1:
            if len(out.t_events[0]):
                tense = not tense
            else:
                wet = False
    return pieces, y


@dataclass
class Shot:
    """A converged shot: the pole's stretch and height, the level, the pieces."""

    stretch0: float
    z0: float
    zw: float
    pieces: list[Piece]
    tol: Tolerance

    @property
    def fronts(self) -> Array:
        """Angles of the fronts."""
        p = self.pieces
        return np.array([a.high for a, b in pairwise(p) if a.tense != b.tense])

    @property
    def level(self) -> float:
        """Angle of the level."""
        p = self.pieces
        return next(a.high for a, b in pairwise(p) if a.wet != b.wet)

    def values(self, t: Array) -> tuple[Array, Array]:
        """(r, z, A, F) and the stretch l1 at angles t >= t0."""
        out, l1 = np.empty((len(t), 4)), np.empty(len(t))
        for i, x in enumerate(t):
            p = next(p for p in self.pieces if x <= p.high or p is self.pieces[-1])
            out[i] = p.curve(x)
            R = np.sin(x)
            l1[i] = stretch(np.hypot(out[i, 2], out[i, 3]) / R, out[i, 0] / R, p.tense)
        return out, l1

    @property
    def volume(self) -> float:
        """Volume per 2 pi, int r^2 z'/2 dt = int r^2 dz/2, by Gauss sums; the pole's cap is cut like r^4."""
        x, w = np.polynomial.legendre.leggauss(24)
        total = 0.0
        for p in self.pieces:
            edges = np.linspace(p.low, p.high, 9)
            for a, b in pairwise(edges):
                t = a + (b - a) * (x + 1) / 2
                y, l1 = self.values(t)
                dz = l1 * y[:, 3] / np.hypot(y[:, 2], y[:, 3])
                total += float(np.sum(w * (b - a) / 2 * y[:, 0] ** 2 * dz / 2))
        return total


def solve(stretch0: float, z0: float, given: str, value: float, tol: Tolerance, zw: float = 0.0) -> Shot:
    """Newton's method; given is "zw" or "z_pole", value its value.

    Args:
        stretch0: Guess for the pole's stretch.
        z0: Guess for the pole's height, if the level is given.
        given: What is prescribed.
        value: Its value.
        tol: Expansion and steps.
        zw: Guess for the level, if the pole's height is given.

    Raises:
        RuntimeError: If it does not converge.
    """
    level = given == "zw"
    x, done = np.array([stretch0, z0 if level else zw]), False

    def run(x: Array) -> tuple[list[Piece], Array]:
        pieces, end = shot(x[0], *((x[1], value) if level else (value, x[1])), tol)
        return pieces, np.array([end[0] - 1, end[1]])

    matrix = None
    for _ in range(30):
        pieces, defect = run(x)
        if done:
            z0, zw = (x[1], value) if level else (value, x[1])
            return Shot(float(x[0]), float(z0), float(zw), pieces, tol)
        if matrix is None:
            columns = []
            for j in range(2):
                h = 1e-6 * np.eye(2)[j]
                columns.append((run(x + h)[1] - run(x - h)[1]) / 2e-6)
            matrix = np.array(columns).T
        step = np.linalg.solve(matrix, -defect)
        size = float(np.abs(step).max())
        x = x + step * min(1.0, 0.05 / size)
        if size > 1e-6:
            matrix = None
        done = size < 1e-11
    raise RuntimeError(f"hemisphere, shooting: no convergence at {given} = {value:g}")
