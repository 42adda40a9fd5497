r"""Limit points of a part of a sphere by its energy in polynomials of high degree.

The clamp lies at the angle A from the pole and has the radius 1. Over the fraction S of the meridian from the
pole, with x = S^2 and R = sin(AS)/sin A, c = A/sin A, the trial functions are

.. math:: \lambda_2 = 1 + (1 - x) \sum_k u_k P_k(2x - 1), \qquad z = (1 - x) \sum_k w_k P_k(2x - 1),

which meet the conditions at the clamp; radius R lambda_2 and height z are even or odd in S, as exact
solutions are. With X1 = (r_S^2 + z_S^2)/c^2 and X2 = lambda_2^2 the energy over 2 pi C1 h R_f^2 is

.. math:: \int_0^1 \Big[ c R\, \big(X_1 + X_2 + \tfrac1{X_1 X_2} + \alpha (\tfrac1{X_1} + \tfrac1{X_2} + X_1
          X_2)\big) + \frac p2 R^2 \lambda_2^2 z_S \Big] dS .

A limit point has a null vector v of its second derivatives H: gradient = 0, H v = 0, b.v = 1. At a cusp the
third derivative along v vanishes too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import numpy as np

from reference_data.solvers.core.newton import newton, secant

Array = np.ndarray
STEP = 1e-30
DIFFERENCE = 1e-5
"""Of third derivatives, which are needed in Newton's matrix only."""
CIRCLE = 0.02 * np.exp(2j * np.pi * (np.arange(16) + 0.5) / 16)
DEGREES = (26, 34)
"""Degrees in x of both trial functions."""


@dataclass(frozen=True)
class Basis:
    """Trial functions at the points of Gauss's rule on [0, 1], and their slopes."""

    degree: int

    @cached_property
    def points(self) -> Array:
        """Points in S."""
        return (1 + np.polynomial.legendre.leggauss(4 * self.degree)[0]) / 2

    @cached_property
    def weights(self) -> Array:
        """Weights."""
        return np.polynomial.legendre.leggauss(4 * self.degree)[1] / 2

    @cached_property
    def at_pole(self) -> Array:
        """Values at S = 0."""
        return np.polynomial.legendre.legvander(np.array([-1.0]), self.degree)[0]

    @cached_property
    def rows(self) -> Array:
        """Maps from (u, w) to (lambda_2 - 1, its slope, the slope of z), shape (3, points, unknowns)."""
        s = self.points
        t = 2 * s**2 - 1
        value = np.polynomial.legendre.legvander(t, self.degree)
        unit = np.eye(self.degree + 1)
        slope = np.stack(
            [np.polynomial.legendre.legval(t, np.polynomial.legendre.legder(e)) for e in unit], axis=1
        )
        s = s[:, None]
        phi, phi_s = (1 - s**2) * value, -2 * s * value + (1 - s**2) * 4 * s * slope
        none = np.zeros_like(phi)
        return np.stack([np.hstack([phi, none]), np.hstack([phi_s, none]), np.hstack([none, phi_s])])


basis = cache(Basis)


@dataclass(frozen=True)
class Point:
    """A limit point, or a guess of one; also a state, whose null vector has no meaning.

    Attributes:
        vary: The parameter that is unknown, alpha or angle.
        other: The value of the other one.
        u: Coefficients of both functions.
        v: Those of the null vector.
        p: Pressure.
        mu: The unknown parameter.
    """

    vary: str
    other: float
    u: Array
    v: Array
    p: float
    mu: float

    @property
    def basis(self) -> Basis:
        """Its trial functions."""
        return basis(len(self.u) // 2 - 1)

    @property
    def numbers(self) -> dict[str, float]:
        """Height and stretch of the pole, pressure, parameter."""
        pole, n = self.basis.at_pole, len(self.u) // 2
        found = {"t0": float(pole @ self.u[n:]), "lam_pole": float(1 + pole @ self.u[:n])}
        return found | {"p": self.p, self.vary: self.mu}


def slopes(at: Point, q: Array, p: Any, mu: Any) -> Array:
    """Derivatives of the energy's density by (lambda_2, its slope, z_S) at all points."""
    alpha, angle = (mu, at.other) if at.vary == "alpha" else (at.other, mu)
    s = at.basis.points
    sine = np.sin(angle)
    radius, radius_s, c = np.sin(angle * s) / sine, angle * np.cos(angle * s) / sine, angle / sine
    hoop = 1 + q[0]
    a, b = (radius_s * hoop + radius * q[1]) / c, q[2] / c
    x1, x2 = a * a + b * b, hoop * hoop
    f1 = 1 - 1 / (x1 * x1 * x2) + alpha * (x2 - 1 / (x1 * x1))
    f2 = 1 - 1 / (x2 * x2 * x1) + alpha * (x1 - 1 / (x2 * x2))
    by_a, by_b = 2 * c * radius * a * f1, 2 * c * radius * b * f1
    direct = 2 * c * radius * hoop * f2 + p * radius**2 * hoop * q[2]
    return np.array([direct + by_a * radius_s / c, by_a * radius / c, by_b / c + p * radius**2 * hoop**2 / 2])


def gradient(at: Point, u: Array, p: Any, mu: Any) -> Array:
    """First derivatives of the energy by the coefficients."""
    rows = at.basis.rows
    return np.einsum("imk,im->k", rows, at.basis.weights * slopes(at, rows @ u, p, mu))


def second(at: Point, u: Array, p: float, mu: float) -> Array:
    """Second derivatives, exact."""
    rows = at.basis.rows
    q = rows @ u
    found = np.zeros((len(u), len(u)))
    for j in range(3):
        moved = q.astype(complex)
        moved[j] += 1j * STEP
        column = at.basis.weights * np.imag(slopes(at, moved, p, mu)) / STEP
        found += np.einsum("imk,im,ml->kl", rows, column, rows[j], optimize=True)
    return (found + found.T) / 2


def _by(f: Any, x: float) -> Array:
    """Derivative of the gradient by a number."""
    return np.imag(f(x + 1j * STEP)) / STEP


def equilibrium(at: Point, t0: float) -> Point:
    """The state with a height of the pole at given parameters, from a guess."""
    n = len(at.u) // 2
    row = np.concatenate([np.zeros(n), at.basis.at_pole])

    def correct(x: Array) -> tuple[float, Any]:
        u, p = x[:-1], x[-1]
        by_p = _by(lambda value: gradient(at, u, value, at.mu), p)
        matrix = np.block([[second(at, u, p, at.mu), by_p[:, None]], [row, 0.0]])
        step = np.linalg.solve(matrix, np.append(gradient(at, u, p, at.mu), row @ u - t0))
        return float(np.abs(step).max()), lambda share: x - share * step

    x = newton(np.append(at.u, at.p), correct, f"part of a sphere at t0 = {t0:g}", longest=0.3, close=1e-9)
    return replace(at, u=x[:-1], p=float(x[-1]))


def under(at: Point, p: float) -> Point:
    """The state at a pressure, from a guess."""

    def correct(u: Array) -> tuple[float, Any]:
        step = np.linalg.solve(second(at, u, p, at.mu), gradient(at, u, p, at.mu))
        return float(np.abs(step).max()), lambda share: u - share * step

    return replace(
        at, u=newton(at.u, correct, f"part of a sphere at p = {p:g}", longest=0.3, close=1e-9), p=p
    )


def limit(at: Point, **held: float) -> Point:
    """The limit point at which t0, lam_pole, or the parameter has a value, from a guess."""
    ((name, value),) = held.items()
    n, m = len(at.u) // 2, len(at.u)
    row = np.zeros(2 * m + 2)
    if name == "t0":
        row[n:m] = at.basis.at_pole
    elif name == "lam_pole":
        row[:n], value = at.basis.at_pole, value - 1
    else:
        row[-1] = 1.0
    border = at.v / (at.v @ at.v)

    def correct(x: Array) -> tuple[float, Any]:
        u, v, p, mu = x[:m], x[m : 2 * m], float(x[-2]), float(x[-1])
        own = second(at, u, p, mu)

        def turned(du: Any, dp: float, dmu: float) -> Array:
            """Derivative of the second derivatives in a direction."""
            ends = [second(at, u + h * du, p + h * dp, mu + h * dmu) for h in (DIFFERENCE, -DIFFERENCE)]
            return (ends[0] - ends[1]) / (2 * DIFFERENCE)

        by_p = _by(lambda value: gradient(at, u, value, mu), p)
        by_mu = _by(lambda value: gradient(at, u, p, value), mu)
        zero, line = np.zeros((m, m)), np.zeros((1, m))
        matrix = np.vstack([
            np.hstack([own, zero, by_p[:, None], by_mu[:, None]]),
            np.hstack([turned(v, 0, 0), own, (turned(0, 1, 0) @ v)[:, None], (turned(0, 0, 1) @ v)[:, None]]),
            np.hstack([line, border[None], [[0.0, 0.0]]]),
            row[None],
        ])  # fmt: skip
        missed = np.concatenate([gradient(at, u, p, mu), own @ v, [border @ v - 1, row @ x - value]])
        step = np.linalg.solve(matrix, missed)
        return float(np.abs(step).max()), lambda share: x - share * step

    x = newton(
        np.concatenate([at.u, at.v, [at.p, at.mu]]),
        correct,
        f"limit point at {held}",
        longest=0.5,
        close=1e-9,
    )
    return replace(at, u=x[:m], v=x[m : 2 * m], p=float(x[-2]), mu=float(x[-1]))


def cubic(at: Point) -> float:
    """Third derivative of the energy along the null vector, by a sum over a circle."""
    v = at.v / np.abs(at.v).max()
    found = [v @ gradient(at, at.u + t * v, at.p, at.mu) / t**2 for t in CIRCLE]
    return 2 * float(np.mean(found).real)


def cusp(near: Point) -> Point:
    """The limit point at which the cubic vanishes, from one near it."""
    here = [near]

    def at_stretch(lam: float) -> float:
        here[0] = limit(here[0], lam_pole=lam)
        return cubic(here[0])

    begin = near.numbers["lam_pole"]
    lam = secant(at_stretch, begin, begin + 1e-3, 0.05)[0]
    return limit(here[0], lam_pole=lam)


def start(vary: str, alpha: float, angle: float, t0: float, degree: int) -> Point:
    """A guess of a limit point near a height: the state of that membrane, with its softest displacement."""
    own = basis(degree)
    x = np.cos(np.pi * (np.arange(2 * degree) + 0.5) / (2 * degree))
    s2 = (1 + x) / 2
    height = (np.cos(angle * np.sqrt(s2)) - np.cos(angle)) / np.sin(angle) / (1 - s2)
    w = np.linalg.lstsq(np.polynomial.legendre.legvander(x, degree), height, rcond=None)[0]
    u = np.zeros(degree + 1)
    u[0] = 0.1
    mu, other = (alpha, angle) if vary == "alpha" else (angle, alpha)
    here = Point(vary, other, np.concatenate([u, 1.1 * w]), np.zeros(2 * degree + 2), 1.0, mu)
    begin = 1.1 * float(own.at_pole @ w)
    for now in np.append(np.arange(begin, t0, 0.05), t0):
        here = equilibrium(here, float(now))
    v = np.linalg.eigh(second(here, here.u, here.p, here.mu))
    softest = v[1][:, np.argmin(np.abs(v[0]))]
    return replace(here, v=softest / np.abs(softest).max())


def refined(at: Point, degree: int) -> Point:
    """The same point with trial functions of a higher degree, as a guess."""
    n = len(at.u) // 2

    def wider(x: Array) -> Array:
        return np.concatenate([np.pad(part, (0, degree + 1 - n)) for part in (x[:n], x[n:])])

    return replace(at, u=wider(at.u), v=wider(at.v))
