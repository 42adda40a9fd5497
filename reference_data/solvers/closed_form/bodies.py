r"""Balloons, long tubes and test pieces: homogeneous states from derivatives by hand or from energies alone.

Every function takes the derivatives of the law, ``d(l1, l2) -> (w, w1, w2, w11, w12, w22)``. With the
derivatives by :func:`by_hand` and by :func:`by_contour` it computes the same number in two ways.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq, fsolve

from reference_data.solvers.core.contour import derivative, six, two

FINE = 4 * np.finfo(float).eps
GAUSS = np.polynomial.legendre.leggauss(48)


@dataclass(frozen=True)
class Derivatives:
    """Derivatives of a law: all up to the second, and the first ones alone, which roots need often.

    Attributes:
        whole: To ``(w, w1, w2, w11, w12, w22)``.
        slopes: To ``(w1, w2)``.
    """

    whole: Callable[[float, float], tuple[float, ...]]
    slopes: Callable[[float, float], tuple[float, float]]

    def __call__(self, l1: float, l2: float) -> tuple[float, ...]:
        """All of them."""
        return self.whole(l1, l2)


def by_hand(law: Any) -> Derivatives:
    """Derivatives that the law gives in closed form."""
    return Derivatives(
        lambda a, b: (
            law.energy(a, b),
            law.slope(a, b),
            law.slope(b, a),
            law.curvature(a, b),
            law.mixed(a, b),
            law.curvature(b, a),
        ),
        lambda a, b: (law.slope(a, b), law.slope(b, a)),
    )


def by_contour(law: Any) -> Derivatives:
    """Derivatives from the law's energy alone."""
    return Derivatives(lambda a, b: six(law.energy, a, b), lambda a, b: two(law.energy, a, b))


def roots(f: Callable[[float], float], low: float, high: float, steps: int) -> list[float]:
    """All roots that a scan over an interval separates."""
    grid = np.linspace(low, high, steps + 1)
    values = [f(x) for x in grid]
    pairs = zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True)
    return [brentq(f, a, b, xtol=1e-15, rtol=FINE) for a, b, u, v in pairs if u * v < 0]


# -- balloon ----------------------------------------------------------------------------------------


def balloon(d: Derivatives, lam: float) -> float:
    """``P = 2 w1/lam^2``."""
    return 2 * d(lam, lam)[1] / lam**2


def balloon_slope(d: Derivatives, lam: float) -> float:
    """``dP/dlam``."""
    _, w1, _, w11, w12, _ = d(lam, lam)
    return 2 * (w11 + w12) / lam**2 - 4 * w1 / lam**3


def balloon_limits(d: Derivatives, end: float) -> list[tuple[float, float]]:
    """``(P, lam)`` at every limit point from rest on."""
    found = roots(lambda x: balloon_slope(d, x), 1.01, end, 300)
    return [(balloon(d, x), x) for x in found]


def balloon_merge(make: Callable[[float], Derivatives], guess: tuple[float, float]) -> tuple[float, ...]:
    """``(constant, P, lam)`` at which two limit points merge: ``P' = P'' = 0``."""

    def equations(z: np.ndarray) -> list[float]:
        lam, constant = z
        d = make(constant)
        h = 2e-3 * lam
        # P'' by differences of P' of sixth order
        weights, places = (-1, 9, -45, 45, -9, 1), (-3, -2, -1, 1, 2, 3)
        bent = sum(w * balloon_slope(d, lam + k * h) for w, k in zip(weights, places, strict=True))
        return [balloon_slope(d, lam), bent / (60 * h)]

    lam, constant = fsolve(equations, guess[::-1], xtol=1e-14)
    return constant, balloon(make(constant), lam), lam


def balloon_merge_from_energy(
    make: Callable[[float], Callable[[Any, Any], Any]], guess: tuple[float, float]
) -> tuple[float, ...]:
    """The same point from three derivatives of ``w(lam, lam)``, each by contour."""

    def jet(z: np.ndarray) -> tuple[float, float, float]:
        w = make(z[1])
        return tuple(derivative(lambda x: w(x, x), z[0], k) for k in (1, 2, 3))

    def equations(z: np.ndarray) -> list[float]:
        f1, f2, f3 = jet(z)
        lam = z[0]
        return [f2 - 2 * f1 / lam, f3 - 4 * f2 / lam + 6 * f1 / lam**2]

    z = fsolve(equations, guess[::-1], xtol=1e-14)
    return z[1], jet(z)[0] / z[0] ** 2, z[0]


# -- long tube with closed ends ---------------------------------------------------------------------


def axial(d: Derivatives, l2: float) -> float:
    """Axial stretch at a hoop stretch: ``2 lam1 w1 = lam2 w2``."""

    def balance(l1: float) -> float:
        w1, w2 = d.slopes(l1, l2)
        return 2 * l1 * w1 - l2 * w2

    low = 0.5 * l2**-0.5  # less than the width in uniaxial hoop tension
    while balance(1.05 * low) < 0:
        low *= 1.05
    return brentq(balance, low, 1.05 * low, xtol=1e-15, rtol=FINE)


def tube_state(d: Derivatives, l2: float) -> tuple[float, float, float]:
    """``(p, lam1, Pi)`` at a hoop stretch."""
    l1 = axial(d, l2)
    w, _, w2, *_ = d(l1, l2)
    p = w2 / (l1 * l2)
    return p, l1, w - p * l1 * l2**2 / 2


def tube_slope(d: Derivatives, l2: float) -> float:
    """``dp/dlam2`` along the branch, by implicit differentiation."""
    l1 = axial(d, l2)
    _, w1, w2, w11, w12, w22 = d(l1, l2)
    rate = -(2 * l1 * w12 - w2 - l2 * w22) / (2 * w1 + 2 * l1 * w11 - l2 * w12)
    return (w12 * rate + w22) / (l1 * l2) - w2 * (rate / l1 + 1 / l2) / (l1 * l2)


def tube_limits(d: Derivatives, end: float) -> list[tuple[float, float, float]]:
    """``(p, lam1, lam2)`` at every limit point."""
    found = roots(lambda x: tube_slope(d, x), 1.01, end, 150)
    return [(*tube_state(d, x)[:2], x) for x in found]


def tube_maxwell(d: Derivatives, turns: list[float], end: float) -> tuple[float, ...]:
    """``(p, lam1, lam2, lam1', lam2')`` of two states of equal pressure and equal potential.

    Args:
        d: Derivatives.
        turns: Hoop stretches of the two limit points, which separate the rising branches.
        end: Hoop stretch at which the last one ends.
    """
    pair = _pair_of(d, turns, end)

    def gap(p: float) -> float:
        thin, thick = pair(p)
        return tube_state(d, thin)[2] - tube_state(d, thick)[2]

    low, high = _overlap(d, turns, end)
    p = brentq(gap, low, high, xtol=1e-15, rtol=FINE)
    thin, thick = pair(p)
    return p, axial(d, thin), thin, axial(d, thick), thick


def tube_maxwell_by_area(d: Derivatives, turns: list[float], end: float) -> tuple[float, ...]:
    """The same states by Maxwell's rule of equal areas: ``int (p - p_M) dV = 0`` over the loop."""
    pair = _pair_of(d, turns, end)

    def rate(l2: float) -> float:
        """V dp/dlam2."""
        return axial(d, l2) * l2**2 * tube_slope(d, l2)

    def area(p: float) -> float:
        thin, thick = pair(p)
        # int p dV = [p V] - int V dp, by parts over the hoop stretch
        parts = [thin, *turns, thick]
        inner = sum(
            (b - a) / 2 * sum(w * rate((a + b) / 2 + (b - a) / 2 * x) for x, w in zip(*GAUSS, strict=True))
            for a, b in pairwise(parts)
        )
        return -inner

    low, high = _overlap(d, turns, end)
    p = brentq(area, low, high, xtol=1e-14, rtol=FINE)
    thin, thick = pair(p)
    return p, axial(d, thin), thin, axial(d, thick), thick


def _overlap(d: Derivatives, turns: list[float], end: float) -> tuple[float, float]:
    low = tube_state(d, turns[1])[0]
    high = min(tube_state(d, turns[0])[0], tube_state(d, end)[0])
    slack = 1e-6 * (high - low)
    return low + slack, high - slack


def _pair_of(d: Derivatives, turns: list[float], end: float) -> Callable[[float], tuple[float, float]]:
    def pair(p: float) -> tuple[float, float]:
        ends = ((1.0001, turns[0]), (turns[1], end))
        thin, thick = (brentq(lambda x: tube_state(d, x)[0] - p, *e, xtol=1e-15, rtol=FINE) for e in ends)
        return thin, thick

    return pair


# -- test pieces ------------------------------------------------------------------------------------


def nominal(law: Any, loading: str, lam: float, d: Derivatives) -> float:
    """Nominal stress along the load."""
    across = {"uniaxial": lambda: law.width(lam)[0], "equibiaxial": lambda: lam, "pure_shear": lambda: 1.0}
    return d(lam, across[loading]())[1]
