r"""Method (b) for the inflated torus: stationary energy of trigonometric polynomials.

.. math:: r = \sum_{k=0}^n a_k \cos kt, \qquad z = \sum_{k=1}^n c_k \sin kt

of a whole meridian without stress ``R = 1 + b cos t``, ``Z = b sin t``, integrated by the trapezoidal rule,
which is exact up to its number of points for periodic functions. The energy is that of the invariants of the
metric, without stretches. Pressure is the multiplier of the volume.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from reference_data.solvers.core.collocation import STEP
from reference_data.solvers.core.newton import newton

Array = np.ndarray


@dataclass(frozen=True)
class Series:
    """One torus: ratio of the radii, C2/C1, number of the highest wave.

    Unknowns are ``a_0 .. a_n``, ``c_1 .. c_n`` and the pressure.
    """

    b: float
    alpha: float
    n: int

    @cached_property
    def _waves(self) -> tuple[Array, Array, Array, Array]:
        """Angles of the rule; cosines and sines of all waves there; numbers of the waves."""
        return self._at(2 * np.pi * np.arange(6 * self.n) / (6 * self.n))

    def _at(self, t: Array) -> tuple[Array, Array, Array, Array]:
        k = np.arange(self.n + 1)
        return t, np.cos(np.outer(t, k)), np.sin(np.outer(t, k)), k

    def start(self, size: float) -> Array:
        """A guess: the torus with a thicker tube."""
        x = np.zeros(2 * self.n + 2)
        x[0], x[1], x[self.n + 1], x[-1] = 1.0, size * self.b, size * self.b, 1.0
        return x

    def _meridian(self, x: Array, waves: tuple[Array, ...] | None = None) -> tuple[Array, ...]:
        """r, z and their slopes, at the angles of the rule or of other waves."""
        _, cosines, sines, k = waves or self._waves
        a, c = x[: self.n + 1], np.concatenate([[0.0], x[self.n + 1 : -1]])
        return cosines @ a, sines @ c, -sines @ (k * a), cosines @ (k * c)

    def _metric(self, x: Array) -> tuple[Array, Array, Array]:
        """Radius without stress, and the metric's two components over those without stress."""
        r, _, r_t, z_t = self._meridian(x)
        radius = 1 + self.b * np.cos(self._waves[0])
        return radius, (r_t**2 + z_t**2) / self.b**2, (r / radius) ** 2

    def volume(self, x: Array) -> Any:
        """Volume inside."""
        r, _, _, z_t = self._meridian(x)
        return 2 * np.pi**2 * np.mean(r**2 * z_t)

    def _partial(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Derivatives of the energy in the metric's components."""
        t, d = first + second, first * second
        by_t, by_d = 1 + self.alpha / d, -1 / d**2 + self.alpha * (1 - t / d**2)
        return by_t + second * by_d, by_t + first * by_d

    def residual(self, x: Array, volume: float) -> Array:
        """Derivatives of the energy less pressure times volume, and what the volume misses."""
        _, cosines, sines, k = self._waves
        r, _, r_t, z_t = self._meridian(x)
        radius, first, second = self._metric(x)
        by_first, by_second = self._partial(first, second)
        share, p = 2 * np.pi / len(r), x[-1]
        of_slope = 2 * radius * by_first / self.b
        of_r = 2 * self.b * by_second * r / radius - p * r * z_t
        a = share * (cosines.T @ of_r - k * (sines.T @ (of_slope * r_t)))
        c = share * k * (cosines.T @ (of_slope * z_t - p * r**2 / 2))
        return np.concatenate([a, c[1:], [self.volume(x) - volume]])

    def state(self, volume: float, guess: Array) -> tuple[dict[str, float], Array]:
        """The state of a volume, and its unknowns, from a guess of them."""

        def correct(x: Array) -> tuple[float, Callable[[Any], Array]]:
            units = np.eye(len(x))
            slopes = np.array([self.residual(x + 1j * STEP * unit, volume).imag / STEP for unit in units]).T
            step = np.linalg.solve(slopes, -self.residual(x, volume))
            return float(np.max(np.abs(step))), lambda share: x + share * step

        x = newton(guess, correct, f"torus at V = {volume:g}", longest=0.2)
        return self._numbers(x), x

    def meridian(self, x: Array, t: Array) -> dict[str, Array]:
        """Position and stretches of a state at angles."""
        r, z, r_t, z_t = self._meridian(x, self._at(t))
        lam2 = r / (1 + self.b * np.cos(t))
        return {"r": r, "z": z, "lam1": np.sqrt(r_t**2 + z_t**2) / self.b, "lam2": lam2}

    def slopes(self, x: Array, t: Array) -> tuple[Array, Array, Array]:
        """Distance from the axis, its slope, and that of the height, of a state at angles."""
        r, _, r_t, z_t = self._meridian(x, self._at(t))
        return r, r_t, z_t

    def _numbers(self, x: Array) -> dict[str, float]:
        r, z, _, _ = self._meridian(x)
        radius, first, second = self._metric(x)
        t, d = first + second, first * second
        by_first, by_second = self._partial(first, second)
        area = 4 * np.pi**2 * self.b * radius
        density = t + 1 / d - 3 + self.alpha * (d + t / d - 3)
        return {
            "p": float(x[-1]),
            "r_out": float(r[0]),
            "r_in": float(r[len(r) // 2]),
            "z_top": self._top(x, int(np.argmax(z))),
            "U": float(np.mean(area * density)),
            "virial": float(np.mean(2 * area * (by_first * first + by_second * second))),
        }

    def _top(self, x: Array, near: int) -> float:
        """Largest height, by Newton's method from the highest angle of the rule."""
        t, _, _, k = self._waves
        c, at = np.concatenate([[0.0], x[self.n + 1 : -1]]), t[near]
        for _ in range(8):
            at += (k * c) @ np.cos(k * at) / ((k**2 * c) @ np.sin(k * at))
        return float(c @ np.sin(k * at))
