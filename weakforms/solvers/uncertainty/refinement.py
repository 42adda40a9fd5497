"""Uncertainty of a number from a sequence of meshes, each twice as fine as the one before.

What is claimed: the true error lies within the uncertainty for 95 % of all numbers, within twice it (the
bound of every verdict) for all of them, and the uncertainty is at most 30 times the error, down to round-off.
That is tested over sets of parameters: :mod:`weakforms.verification.audit.coverage`,
``tests/verification/test_bounds_hold.py``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

ALGEBRAIC = 1e-11
"""Relative error that Newton's stopping rule and round-off may leave; added to every uncertainty."""

SAFETY = 1.25
"""Factor of the grid convergence index where the meshes converge (Roache 1998) ..."""

SAFETY_UNRESOLVED = 3.0
"""... and where the observed order is below one."""

TOO_FAST = 0.5
"""Orders by which a field may fall faster than its elements can converge and still count as resolved."""


@dataclass(frozen=True)
class Slow:
    """Part of an error that falls slower than the rest, and shows where that is small: on fine meshes."""

    size: float
    """Largest difference between two meshes that it may make, of a number or of 1 ..."""
    order: float
    """... and the highest order it has."""


@dataclass(frozen=True)
class Estimate:
    """Finest value, absolute uncertainty and observed order (``nan`` where two meshes cannot tell)."""

    value: np.ndarray
    uncertainty: np.ndarray
    order: np.ndarray


def estimate(
    levels: list[np.ndarray | float],
    cap: float | np.ndarray,
    guard: float | None = None,
    least: float = 0.0,
    slow: Slow | None = None,
) -> Estimate:
    r"""Grid convergence estimate from values on meshes of widths ``h``, ``h/2``, ``h/4``...

    With the last differences :math:`d_1, d_2`, the observed order is :math:`q = \log_2 |d_1/d_2|`, kept
    within ``[1, cap]``, and

    .. math:: u = F \frac{\max(|d_2|, |d_1|/2^{cap})}{2^q - 1} + u_\mathrm{algebraic}

    The maximum keeps an accidentally small ``d_2`` (a change of sign) from passing for accuracy. Two
    meshes alone are taken to converge at first order. To a slow part of the error belongs of the maximum as
    much as it may make, and that is added with its own ``cap``.

    Args:
        levels: Values from coarse to fine, scalars or arrays of one shape; two or more.
        cap: Highest order the method can have (twice the degree for energies and limit loads, the degree for
            derivatives at a point); one number or one a value.
        guard: Order at which ``d_1`` is taken to fall, where that is not ``cap``: where an error of low order
            shows on fine meshes only, the coarse ones' falls faster.
        least: Order that is known from elsewhere, reckoned with where a lower one is observed.
        slow: A part of the error that falls slower.

    Raises:
        ValueError: With fewer than two meshes: one mesh has no uncertainty.
    """
    if len(levels) < 2:
        raise ValueError("an uncertainty needs at least two meshes")
    values = [np.asarray(level, dtype=float) for level in levels]
    fine = values[-1]
    floor = ALGEBRAIC * np.maximum(np.abs(fine), 1.0)
    last = np.abs(fine - values[-2])
    if len(values) == 2:
        return Estimate(fine, SAFETY_UNRESOLVED * last + floor, np.full_like(fine, np.nan))
    first = np.abs(values[-2] - values[-3])
    tiny = np.finfo(float).tiny
    order = np.log2(np.maximum(first, tiny) / np.maximum(last, tiny))
    known = np.maximum(order, least)
    spread = _left(first, last, known, cap, guard)
    if slow is not None:
        most = slow.size * np.maximum(np.abs(fine), 1.0)
        spread += _left(first, last, known, np.minimum(cap, slow.order), None, most)
    observed = np.where(last > floor, order, np.nan)
    return Estimate(fine, spread + floor, observed)


def _left(
    first: np.ndarray,
    last: np.ndarray,
    known: np.ndarray,
    cap: float | np.ndarray,
    guard: float | None,
    most: float | np.ndarray = np.inf,
) -> np.ndarray:
    """What two differences leave, if no more than ``most`` of them counts."""
    used = np.clip(known, 1.0, cap)
    safety = np.where(known >= 1.0, SAFETY, SAFETY_UNRESOLVED)
    left = np.maximum(last, first / 2.0 ** (cap if guard is None else guard))
    return safety * np.minimum(left, most) / (2.0**used - 1.0)


def estimate_in_norm(
    levels: list[np.ndarray], cap: float, guard: float | None = None, slow: Slow | None = None
) -> float:
    r"""One uncertainty for a whole field: :func:`estimate` with differences in the maximum norm.

    Point by point differences of two meshes oscillate within cells and pass through zero anywhere, so that
    orders observed there mean little; those of the norms do not.

    Args:
        levels: Values at the same points from coarse to fine; two or more.
        cap: Highest order the method can have.
        guard: As for :func:`estimate`.
        slow: As for :func:`estimate`.
    """
    values = [np.asarray(level, dtype=float) for level in levels]
    steps = [float(np.max(np.abs(b - a))) for a, b in pairwise(values)]
    size = float(np.max(np.abs(values[-1])))
    like = [size + sum(steps[k:]) for k in range(len(values))]  # scalars with these differences
    return float(estimate(like, cap, guard, slow=slow).uncertainty)


def order_in_mean(levels: list[np.ndarray]) -> float:
    """Order at which the last two differences of a field fall in the root mean square over its points.

    Args:
        levels: Values at the same points from coarse to fine.

    Returns:
        The order; 0 with fewer than three meshes, or where only round-off is left.
    """
    if len(levels) < 3:
        return 0.0
    first, last = (float(np.sqrt(np.mean((b - a) ** 2))) for a, b in pairwise(levels[-3:]))
    floor = ALGEBRAIC * max(float(np.max(np.abs(levels[-1]))), 1.0)
    return float(np.log2(first / last)) if first > floor and last > floor else 0.0


def doubt(orders: Iterable[float], highest: float) -> float:
    r"""Factor for the uncertainties of a state whose coarse meshes do not resolve it; else 1.

    No field can converge faster than its elements, at an order :math:`q_0`. One whose differences, in the
    mean where nothing cancels, fall at an order :math:`q_0 + e` was not resolved where they were large. The
    numbers of an equilibrium err by the square of its fields: their differences may have fallen :math:`2e`
    orders faster than what is left will,

    .. math:: f = 4^{\min(e, 1)}, \quad e = \max_\mathrm{fields} q - q_0 > \tfrac12

    An excess beyond one order says that the coarsest mesh is far off, no more of the finer ones.

    One number alone cannot tell: where its difference passes through zero, any order is seen.

    Args:
        orders: Of the state's fields (:func:`order_in_mean`).
        highest: Order of the elements in the mean: their degree and one.
    """
    excess = max(orders, default=0.0) - highest
    return float(4.0 ** min(excess, 1.0)) if excess > TOO_FAST else 1.0
