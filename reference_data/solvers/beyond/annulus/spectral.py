r"""Method (b) for the turned annulus: stationary strain energy of polynomials on one or two pieces.

.. math:: \frac{U}{2\pi} = \int_a^1 W\, R\, \mathrm{d}R

On each piece r and w are polynomials through their values at Chebyshev's points, and Gauss's rule integrates.
The front between a wrinkled and a taut piece is an unknown with the equation ``x_2 sqrt(x_1) = 1`` of squared
principal stretches. The energy is that of the invariants of C where taut and of x_1 alone where wrinkled. All
derivatives are complex steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from reference_data.solvers.core.collocation import STEP, differentiation, rule
from reference_data.solvers.core.newton import newton

Array = np.ndarray


def metric(radius: Array, r: Array, r_s: Array, turn_s: Array) -> tuple[Array, Array, Array]:
    """Half the trace of C, half the difference of its diagonal, and its other component."""
    first, second = r_s**2 + (r * turn_s) ** 2, (r / radius) ** 2
    return (first + second) / 2, (first - second) / 2, r**2 * turn_s / radius


def density(kinematics: tuple[Array, Array, Array, Array], alpha: float, is_wrinkled: bool) -> Array:
    """Energy per reference area over C1."""
    m, h, c = metric(*kinematics)
    if is_wrinkled:
        x = m + np.sqrt(h**2 + c**2)
        return x + 2 / np.sqrt(x) - 3 + alpha * (2 * np.sqrt(x) + 1 / x - 3)
    t, d = 2 * m, m**2 - h**2 - c**2
    return t + 1 / d - 3 + alpha * (d + t / d - 3)


def width(kinematics: tuple[Array, Array, Array, Array]) -> Array:
    """``x_2 sqrt(x_1)``, 1 at a front."""
    m, h, c = metric(*kinematics)
    apart = np.sqrt(h**2 + c**2)
    return (m - apart) * np.sqrt(m + apart)


@dataclass(frozen=True)
class Pieces:
    """One annulus with its pieces, from the inner edge outwards.

    Attributes:
        a: Inner radius.
        s: Stretch of both radii.
        alpha: C2/C1.
        wrinkled: Whether each piece is wrinkled.
        degree: Degree of the polynomials.
    """

    a: float
    s: float
    alpha: float
    wrinkled: tuple[bool, ...]
    degree: int

    @property
    def count(self) -> int:
        """Number of inner nodes, each with r and w."""
        return len(self.wrinkled) * self.degree - 1

    def start(self, psi: float) -> Array:
        """A guess: a front in the middle, and a turn that is linear in R."""
        breaks = np.linspace(self.a, 1.0, len(self.wrinkled) + 1)
        nodes = rule(self.degree).nodes
        at = np.concatenate([low + (high - low) * nodes[:-1] for low, high in pairwise(breaks)])[1:]
        return np.concatenate([self.s * at, psi * (1 - at) / (1 - self.a), breaks[1:-1]])

    def turned(self, z: Array, factor: float) -> Array:
        """A guess for a larger angle: all angles times a factor."""
        out = z.copy()
        out[self.count : 2 * self.count] *= factor
        return out

    def _values(self, z: Array, psi: Any) -> tuple[Array, Array, Array]:
        """Radii of the breaks, and r and w at all nodes."""
        n = self.count
        breaks = np.concatenate([[self.a], z[2 * n :], [1.0]])
        r = np.concatenate([[self.s * self.a], z[:n], [self.s]])
        return breaks, r, np.concatenate([[psi], z[n : 2 * n], [0.0]])

    def _at(self, z: Array, psi: Any, k: int, value: Array, deriv: Array, points: Array) -> tuple:
        """Radius, r, r' and w' of piece k at fractions of it."""
        breaks, r, w = self._values(z, psi)
        own = slice(k * self.degree, (k + 1) * self.degree + 1)
        span = breaks[k + 1] - breaks[k]
        return breaks[k] + span * points, value @ r[own], deriv @ r[own] / span, deriv @ w[own] / span

    def residual(self, z: Array, psi: Any) -> Array:
        """Derivatives of the energy in the inner values of r and w, and what the front misses."""
        use, n = rule(self.degree), self.count
        breaks, _, _ = self._values(z, psi)
        of_r, of_w = (np.zeros(n + 2, dtype=complex) for _ in range(2))
        for k, is_wrinkled in enumerate(self.wrinkled):
            at = self._at(z, psi, k, use.value, use.deriv, use.points)
            by = _slopes(at, self.alpha, is_wrinkled)
            span, own = breaks[k + 1] - breaks[k], slice(k * self.degree, (k + 1) * self.degree + 1)
            weight = use.weights * at[0]
            of_r[own] += span * (use.value.T @ (weight * by[0])) + use.deriv.T @ (weight * by[1])
            of_w[own] += use.deriv.T @ (weight * by[2])
        fronts = [self.at_end(z, psi, k)[0] - 1 for k in range(len(self.wrinkled) - 1)]
        return np.concatenate([of_r[1:-1], of_w[1:-1], fronts])

    def at_end(self, z: Array, psi: Any, k: int, first: bool = False) -> tuple[Any, Any]:
        """``x_2 sqrt(x_1)`` and the radius at the last (or first) end of a piece."""
        use, end = rule(self.degree), 0 if first else -1
        slopes = nodal_slopes(self.degree)[[end]]
        value = np.eye(self.degree + 1)[[end]]
        at = self._at(z, psi, k, value, slopes, use.nodes[[end]])
        return width(at)[0], at[0][0]

    def columns(self, z: Array, psi: float) -> dict[str, float]:
        """Torque, energy and front."""
        use = rule(self.degree)

        def stored(angle: Any) -> Any:
            breaks, total = self._values(z, angle)[0], 0.0
            for k, is_wrinkled in enumerate(self.wrinkled):
                at = self._at(z, angle, k, use.value, use.deriv, use.points)
                weight = use.weights * at[0] * (breaks[k + 1] - breaks[k])
                total = total + 2 * np.pi * weight @ density(at, self.alpha, is_wrinkled)
            return total

        found = stored(psi + 1j * STEP)
        front = float(z[-1].real) if len(self.wrinkled) > 1 else np.nan
        return {"M": float(found.imag / STEP), "U": float(found.real), "R_front": front}

    def solve(self, psi: float, start: Array) -> Array:
        """The stationary state at an angle."""
        return _root(lambda z: self.residual(z, psi), start, f"annulus at psi = {psi:g}")

    def onset(self, psi: float, start: Array) -> tuple[Array, float]:
        """The taut state whose inner edge begins to wrinkle, and its angle."""

        def miss(z: Array) -> Array:
            return np.append(self.residual(z[:-1], z[-1]), self.at_end(z[:-1], z[-1], 0, first=True)[0] - 1)

        found = _root(miss, np.append(start, psi), "onset of wrinkling")
        return found[:-1], float(found[-1])


def nodal_slopes(degree: int) -> Array:
    """Derivatives at the nodes of the polynomials through them."""
    return differentiation(rule(degree).nodes)


def _slopes(at: tuple[Array, ...], alpha: float, is_wrinkled: bool) -> list[Array]:
    """Derivatives of the energy in r, r' and w' in closed form, so that complex steps may follow."""
    radius, r, r_s, turn_s = at
    m, h, c = metric(*at)
    if is_wrinkled:
        apart = np.sqrt(h**2 + c**2)
        x = m + apart
        slope = 1 - x**-1.5 + alpha * (x**-0.5 - x**-2)
        by_m, by_h, by_c = slope, slope * h / apart, slope * c / apart
    else:
        t, d = 2 * m, m**2 - h**2 - c**2
        by_t, by_d = 1 + alpha / d, -1 / d**2 + alpha * (1 - t / d**2)
        by_m, by_h, by_c = 2 * by_t + 2 * m * by_d, -2 * h * by_d, -2 * c * by_d
    by_11, by_22 = (by_m + by_h) / 2, (by_m - by_h) / 2
    by_r = 2 * r * turn_s**2 * by_11 + 2 * r / radius**2 * by_22 + 2 * r * turn_s / radius * by_c
    return [by_r, 2 * r_s * by_11, 2 * r**2 * turn_s * by_11 + r**2 / radius * by_c]


def _root(f: Callable[[Array], Array], start: Array, what: str) -> Array:
    def correct(z: Array) -> tuple[float, Callable[[Any], Array]]:
        columns = [f(z + 1j * STEP * unit).imag / STEP for unit in np.eye(len(z))]
        step = np.linalg.solve(np.array(columns).T, -f(z.astype(complex)).real)
        return float(np.max(np.abs(step))), lambda share: z + share * step

    return newton(start, correct, what, longest=0.1)
