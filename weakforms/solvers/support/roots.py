"""Zeros of functions of one number."""

from __future__ import annotations

from collections.abc import Callable

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
    """Where a function is zero between two numbers (Brent's method).

    Args:
        function: Has different signs at the two.
        low: One end.
        high: The other.
        what: What is sought, for messages.
        xtol: Error allowed, absolute ...
        rtol: ... and relative to the zero.

    Raises:
        ConvergenceError: When there is no change of sign, a value is no number, or no zero is found.
    """
    try:
        return float(brentq(function, low, high, xtol=xtol, rtol=rtol))
    except (ValueError, RuntimeError) as error:  # brentq's own; what the function raises is none of ours
        raise ConvergenceError(f"{what} is not found between {low:g} and {high:g}: {error}") from error
