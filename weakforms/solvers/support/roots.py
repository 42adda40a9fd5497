"""Zeros of functions of one number, and polynomials through values."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from weakforms.errors import ConvergenceError


def root(
    function: Callable[[float], float],
    low: float,
    high: float,
    what: str,
    xtol: float = 2e-12,
    rtol: float = 4 * 2.0**-52,
) -> float:
    """The zero of a function between two numbers (Brent's method).

    Args:
        function: A function with different signs at both ends.
        low: One end of the interval.
        high: The other end.
        what: Name of the zero, for messages.
        xtol: Allowed absolute error ...
        rtol: ... and allowed error relative to the zero.

    Raises:
        ConvergenceError: If there is no change of sign, a value is not a number, or no zero is found.
    """
    try:
        return float(brentq(function, low, high, xtol=xtol, rtol=rtol))
    except (ValueError, RuntimeError) as error:  # errors of brentq only; exceptions of the function pass
        raise ConvergenceError(f"{what} is not found between {low:g} and {high:g}: {error}") from error


def polynomial_through(x: np.ndarray, values: np.ndarray) -> Callable[[float], np.ndarray]:
    """The polynomial through numbers or arrays at some points, by barycentric weights.

    It is the same in every run (SciPy's interpolator shuffles its nodes), and three times faster for a few
    points.

    Args:
        x: The points, all different, shape ``(n,)``.
        values: Values there, shape ``(n, ...)``.
    """
    apart = x[:, None] - x
    np.fill_diagonal(apart, 1.0)
    weights = 1 / np.prod(apart, axis=1)

    def polynomial(at: float) -> np.ndarray:
        away = at - x
        if not away.all():
            return values[np.argmin(np.abs(away))]
        terms = weights / away
        return terms @ values / terms.sum()

    return polynomial
