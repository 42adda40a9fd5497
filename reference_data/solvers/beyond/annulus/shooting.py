r"""Method (a) for the turned annulus: shooting with principal stretches, the front being an event.

The force across a circle of reference radius R is, per radian, ``(p, q)`` along the deformed radius and the
circle, with ``q = m/r`` and the constant moment ``m = M/2 pi``. With the reference angle g of the larger
stretch to the radius, and b its angle in the deformed sheet,

.. math:: l_1 \sin g = (r/R) \sin b, \qquad l_2 \cos g = (r/R) \cos b

because hoops stay hoops. Where the sheet is wrinkled, the force is along the larger stretch, so b is known,
and ``W'(l_1) cos g = |(p, q)|/R`` gives l_1. Where it is taut, l_1, l_2, b follow from both components:

.. math:: p R^{-1} = W_1 \cos g \cos b + W_2 \sin g \sin b, \qquad
          q R^{-1} = W_1 \cos g \sin b - W_2 \sin g \cos b

Then ``r' = l_1 cos g cos b + l_2 sin g sin b``, ``r w' = l_1 cos g sin b - l_2 sin g cos b``, and
``p' = R dW/dr = (force of the hoop) + q w'`` closes the system for (r, w, p).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from reference_data.solvers.core.newton import Secants, newton

Array = np.ndarray


@dataclass(frozen=True)
class Ring:
    """One annulus of a Mooney-Rivlin sheet: ratio of radii, stretch of both radii, C2/C1."""

    a: float
    s: float
    alpha: float


def slopes(l1: float, l2: float, alpha: float) -> tuple[float, float]:
    """Derivatives of the energy over C1 in both stretches."""
    squares = 1 / (l1 * l2) ** 2
    w1 = 2 * (l1 - squares / l1) + 2 * alpha * (l1 * l2**2 - 1 / l1**3)
    w2 = 2 * (l2 - squares / l2) + 2 * alpha * (l2 * l1**2 - 1 / l2**3)
    return w1, w2


def pulled(l1: float, alpha: float) -> float:
    """Stress in uniaxial tension over C1."""
    return 2 * (1 + alpha / l1) * (l1 - l1**-2)


def energy(l1: float, l2: float, alpha: float) -> float:
    """Energy over C1."""
    square = (l1 * l2) ** 2
    return l1**2 + l2**2 + 1 / square - 3 + alpha * (square + 1 / l1**2 + 1 / l2**2 - 3)


@dataclass
class Local:
    """Stretches and angles at a point."""

    l1: float
    l2: float
    g: float
    b: float

    @property
    def frame(self) -> tuple[float, float, float, float]:
        """Cosines and sines of both angles."""
        return np.cos(self.g), np.sin(self.g), np.cos(self.b), np.sin(self.b)

    @property
    def rates(self) -> tuple[float, float]:
        """``r'`` and ``r w'``."""
        cg, sg, cb, sb = self.frame
        return self.l1 * cg * cb + self.l2 * sg * sb, self.l1 * cg * sb - self.l2 * sg * cb


def wrinkled(hoop: float, force: tuple[float, float], alpha: float) -> Local:
    """Stretches of a wrinkled point from the hoop's stretch r/R and the force over R."""
    p, q = force
    b, size = np.arctan2(q, p), np.hypot(p, q)
    across = hoop * np.sin(b)

    def miss(l1: float) -> float:
        return pulled(l1, alpha) * np.sqrt(1 - (across / l1) ** 2) - size

    low, high = max(1.0, abs(across)) * (1 + 1e-15), 2.0
    while miss(high) < 0:
        high *= 2
    l1 = brentq(miss, low, high, xtol=1e-15, rtol=1e-15)
    g = np.arcsin(across / l1)
    return Local(l1, hoop * np.cos(b) / np.cos(g), g, b)


def taut(hoop: float, force: tuple[float, float], alpha: float, near: Array) -> Local:
    """Stretches of a taut point by Newton's method on ``r'`` and ``r w'``, with a complex step."""

    def stress(x: Array) -> Array:
        """Derivatives of the energy in r' and r w' from the invariants, which may be complex."""
        t, d = x[0] ** 2 + x[1] ** 2 + hoop**2, (x[0] * hoop) ** 2
        by_t, by_d = 1 + alpha / d, -1 / d**2 + alpha * (1 - t / d**2)
        return np.array([2 * x[0] * by_t + 2 * x[0] * hoop**2 * by_d, 2 * x[1] * by_t])

    def correct(z: Array) -> tuple[float, Callable[[Any], Array]]:
        columns = [np.imag(stress(z + 1e-30j * unit)) / 1e-30 for unit in np.eye(2)]
        step = np.linalg.solve(np.array(columns).T, np.array(force) - stress(z))
        return float(np.max(np.abs(step))), lambda share: z + share * step

    return resolved(newton(near, correct, "taut point"), hoop)


def resolved(z: Array, hoop: float) -> Local:
    """Principal stretches and angles of the gradient ``[[r', 0], [r w', r/R]]``."""
    left, (l1, l2), right = np.linalg.svd(np.array([[z[0], 0.0], [z[1], hoop]]))
    sign = np.sign(right[0, 0]) or 1.0
    g, b = (
        np.arctan2(sign * right[0, 1], sign * right[0, 0]),
        np.arctan2(sign * left[1, 0], sign * left[0, 0]),
    )
    return Local(float(l1), float(l2), float(g), float(b))


class Shooting:
    """States of one annulus, from the inner edge outwards.

    Args:
        ring: The annulus.
        tolerance: Relative tolerance of the integration.
    """

    def __init__(self, ring: Ring, tolerance: float) -> None:
        self.ring, self.tolerance = ring, tolerance
        self._near = np.array([1.0, 0.0])

    def _local(self, at: float, y: Array, moment: float, is_wrinkled: bool) -> Local:
        r, _, p = y[:3]
        force = p / at, -moment / r / at
        if is_wrinkled:
            return wrinkled(r / at, force, self.ring.alpha)
        found = taut(r / at, force, self.ring.alpha, self._near)
        self._near = np.array(found.rates)
        return found

    def _rates(self, at: float, y: Array, moment: float, is_wrinkled: bool) -> list[float]:
        local = self._local(at, y, moment, is_wrinkled)
        r_s, shear = local.rates
        cg, sg, cb, sb = local.frame
        if is_wrinkled:
            w1, w2 = pulled(local.l1, self.ring.alpha), 0.0
            stored = energy(local.l1, local.l1**-0.5, self.ring.alpha)
        else:
            w1, w2 = slopes(local.l1, local.l2, self.ring.alpha)
            stored = energy(local.l1, local.l2, self.ring.alpha)
        hoop_force = w1 * sg * sb + w2 * cg * cb
        turn_s = shear / y[0]
        return [r_s, turn_s, hoop_force - moment / y[0] * turn_s, 2 * np.pi * at * stored]

    def march(self, pull: float, moment: float, wrinkles: bool) -> tuple[Array, float]:
        """Values at the outer edge and the front, from the force at the inner edge.

        Args:
            pull: Its radial component per radian.
            moment: Its moment per radian.
            wrinkles: Whether the inner edge is wrinkled.
        """
        a = self.ring.a
        y, at, front = np.array([self.ring.s * a, 0.0, pull, 0.0]), a, a
        if wrinkles:

            def verge(x: float, y: Array) -> float:
                local = self._local(x, y, moment, True)
                return local.l2 * np.sqrt(local.l1) - 1

            verge.terminal, verge.direction = True, 1
            found = self._integrate(at, y, moment, True, verge)
            y, at = found.y[:, -1], found.t[-1]
            front = float(at)
            if at < 1:
                last = self._local(at, y, moment, True)
                self._near = np.array(last.rates)
        else:
            self._near = np.array([self.ring.s, 0.0])
        if at < 1:
            y = self._integrate(at, y, moment, False, None).y[:, -1]
        return y, front

    def _integrate(self, at: float, y: Array, moment: float, is_wrinkled: bool, event: object):  # noqa: ANN202
        return solve_ivp(
            lambda x, z: self._rates(x, z, moment, is_wrinkled),
            (at, 1.0),
            y,
            "DOP853",
            rtol=self.tolerance,
            atol=self.tolerance / 10,
            events=event,
        )

    def onset(self, guess: tuple[float, float]) -> dict[str, float]:
        """The state at which the taut sheet begins to wrinkle at the inner edge."""

        def miss(z: Array) -> Array:
            y, _ = self.march(z[0], z[1], False)
            a, s = self.ring.a, self.ring.s
            edge = taut(s, (z[0] / a, -z[1] / (s * a) / a), self.ring.alpha, np.array([s, 0.0]))
            return np.array([y[0] - s, edge.l2 * np.sqrt(edge.l1) - 1])

        pull, moment = Secants().solve(miss, guess, "onset of wrinkling")
        y, _ = self.march(pull, moment, False)
        return {"psi": float(-y[1]), "M": float(2 * np.pi * moment), "U": float(y[3])}

    def state(self, psi: float, guess: tuple[float, float], wrinkles: bool) -> dict[str, float]:
        """The state at an angle: torque, energy, front, and the force at the inner edge."""

        def miss(z: Array) -> Array:
            y, _ = self.march(z[0], z[1], wrinkles)
            return np.array([y[0] - self.ring.s, y[1] + psi])

        pull, moment = Secants().solve(miss, guess, f"annulus at psi = {psi:g}")
        y, front = self.march(pull, moment, wrinkles)
        out = {"pull": pull, "moment": moment, "M": 2 * np.pi * moment, "U": y[3], "R_front": front}
        return {key: float(value) for key, value in out.items()}
