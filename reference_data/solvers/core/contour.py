r"""Derivatives of an energy from its values alone, at complex stretches around a point.

For a function analytic in a disk, the trapezoidal rule on a circle is exact to rounding,

.. math:: f^{(k)}(a) = \frac{k!}{N r^k} \sum_{j} f(a + r e^{i\theta_j})\, e^{-i k \theta_j}

so that derivatives by hand can be compared with their energy.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial
from typing import Any

import numpy as np

NODES = 48
RADIUS = 0.08
"""Radius of the circle, relative to the stretch at its centre."""

Energy = Callable[[Any, Any], Any]


def derivative(f: Callable[[Any], Any], at: float, order: int, radius: float = RADIUS) -> float:
    """One derivative of a function of one variable, real on the real axis."""
    r = radius * abs(at)
    angles = 2 * np.pi * np.arange(NODES) / NODES
    values = f(at + r * np.exp(1j * angles))
    return float(factorial(order) * np.mean(values * np.exp(-1j * order * angles)).real / r**order)


def six(energy: Energy, l1: float, l2: float) -> tuple[float, ...]:
    """``w, w_1, w_2, w_11, w_12, w_22``; the mixed one from the diagonal direction."""
    first = [derivative(lambda x: energy(x, l2), l1, k) for k in (0, 1, 2)]
    second = [derivative(lambda x: energy(l1, x), l2, k) for k in (0, 1, 2)]
    # along l1 = a (1 + s), l2 = b (1 + s): f'' = a^2 w11 + 2 a b w12 + b^2 w22
    along = derivative(lambda s: energy(l1 * s, l2 * s), 1.0, 2)
    mixed = (along - l1**2 * first[2] - l2**2 * second[2]) / (2 * l1 * l2)
    return first[0], first[1], second[1], first[2], mixed, second[2]


def two(energy: Energy, l1: float, l2: float) -> tuple[float, float]:
    """``w_1, w_2``, as :func:`six` finds them."""
    return derivative(lambda x: energy(x, l2), l1, 1), derivative(lambda x: energy(l1, x), l2, 1)
