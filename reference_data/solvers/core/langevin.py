r"""Langevin function :math:`L(y) = \coth y - 1/y`, its inverse by Newton's method, and the chain's energy."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

NEAR = 0.15
"""Magnitude of ``y`` below which power series are used."""

_BERNOULLI = (1 / 3, -1 / 45, 2 / 945, -1 / 4725, 2 / 93555, -1382 / 638512875)
"""Coefficients of ``L`` in odd powers of ``y``."""


def _apart(y: Any) -> tuple[Any, Any]:
    """``y`` where it is not small, and small ``y``, each with harmless values elsewhere."""
    small = np.abs(y) < NEAR
    return np.where(small, 1.0, y), np.where(small, y, 0.0)


def _chosen(y: Any, series: Any, closed: Any) -> Any:
    return np.where(np.abs(y) < NEAR, series, closed)


def langevin(y: Any) -> Any:
    """``L(y)``, real or complex."""
    big, low = _apart(y)
    e = np.exp(-2 * big)
    series = sum(c * low ** (2 * k + 1) for k, c in enumerate(_BERNOULLI))
    return _chosen(y, series, (1 + e) / (1 - e) - 1 / big)


def langevin_slope(y: Any) -> Any:
    """``L'(y) = 1/y^2 - 1/sinh^2 y``."""
    big, low = _apart(y)
    e = np.exp(-2 * big)
    series = sum((2 * k + 1) * c * low ** (2 * k) for k, c in enumerate(_BERNOULLI))
    return _chosen(y, series, 1 / big**2 - 4 * e / (1 - e) ** 2)


def inverse(x: Any) -> Any:
    """The ``y`` with ``L(y) = x`` for ``0 <= x < 1``, or complex ``x`` near there: Cohen's start, Newton."""
    if isinstance(x, float):
        return _one(float(x))
    return _newton(np.asarray(x))


@lru_cache(maxsize=10_000)
def _one(x: float) -> float:
    """The inverse of one number; it is kept, because each derivative of a law needs it."""
    y = x * (3 - x * x) / (1 - x * x)
    for _ in range(7):
        if y < NEAR:
            value = sum(c * y ** (2 * k + 1) for k, c in enumerate(_BERNOULLI))
            slope = sum((2 * k + 1) * c * y ** (2 * k) for k, c in enumerate(_BERNOULLI))
        else:
            e = math.exp(-2 * y)
            value, slope = (1 + e) / (1 - e) - 1 / y, 1 / (y * y) - 4 * e / (1 - e) ** 2
        y -= (value - x) / slope
    return y


def _newton(x: Any) -> Any:
    y = x * (3 - x**2) / (1 - x**2)
    for _ in range(7):
        if np.any(np.abs(y) < NEAR):
            y = y - (langevin(y) - x) / langevin_slope(y)
        else:  # the same, with the exponential computed once
            e = np.exp(-2 * y)
            y = y - ((1 + e) / (1 - e) - 1 / y - x) / (1 / y**2 - 4 * e / (1 - e) ** 2)
    return y[()]


def inverse_slope(x: Any) -> Any:
    """Derivative of the inverse, ``1/L'(y)``."""
    return 1 / langevin_slope(inverse(x))


def chain_jet(x: Any) -> tuple[Any, Any, Any]:
    """Energy of a chain, its first and its second derivative."""
    y = inverse(x)
    if isinstance(x, float) and y > NEAR:
        e = math.exp(-2 * y)
        energy = x * y - (y - math.log(2 * y) + math.log(1 - e))
        return energy, y, 1 / (1 / (y * y) - 4 * e / (1 - e) ** 2)
    return chain(x, y), y, 1 / langevin_slope(y)


def chain(x: Any, y: Any = None) -> Any:
    """``x y - ln(sinh y/y)`` with ``y`` the inverse at ``x``."""
    y = inverse(x) if y is None else y
    big, low = _apart(y)
    closed = big - np.log(2 * big) + np.log(1 - np.exp(-2 * big))
    series = sum(c * low ** (2 * k + 2) / (2 * k + 2) for k, c in enumerate(_BERNOULLI))
    return (x * y - _chosen(y, series, closed))[()]
