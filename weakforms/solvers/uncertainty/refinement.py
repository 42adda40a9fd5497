"""Uncertainty of a number from a sequence of meshes, each twice as fine as the one before.

The claims are: the true error is within the uncertainty for 95 % of all numbers, and within twice the
uncertainty (the bound of every verdict) for all of them; the uncertainty is at most 30 times the error, down
to round-off. They are tested over sets of parameters: :mod:`weakforms.verification.audit.coverage`,
``tests/verification/audit/test_bounds_hold.py``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from weakforms.results import Quantity

ALGEBRAIC = 1e-11
"""Relative error of Newton's stopping rule and of round-off; it is added to every uncertainty."""

SAFETY = 1.25
"""Factor of the grid convergence index if the meshes converge (Roache 1998)."""

SAFETY_UNRESOLVED = 3.0
"""Factor of the grid convergence index if the observed order is below one."""

TOO_FAST = 0.5
"""A field is resolved if its observed order exceeds the order of its elements by less than this."""


@dataclass(frozen=True)
class Slow:
    """Part of an error that converges more slowly than the rest and dominates on fine meshes."""

    size: float
    """Largest contribution of this part to the difference between two meshes, relative to the number or to 1
    ..."""
    order: float
    """Highest order of this part."""


@dataclass(frozen=True)
class Estimate:
    """Value on the finest mesh, absolute uncertainty and observed order (``nan`` with two meshes)."""

    value: np.ndarray
    uncertainty: np.ndarray
    order: np.ndarray

    def quantity(self, left: float = 0.0) -> Quantity:
        """A number of a result, with a further error, relative to the number or to 1 if that is larger."""
        value, order = float(self.value), float(self.order)
        spread = float(self.uncertainty) + left * max(1.0, abs(value))
        return Quantity(value, spread, order if order > 0 else None)


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

    The maximum protects against an accidentally small ``d_2`` (a change of sign). Two meshes alone are
    assumed to converge at first order. A slow part of the error takes its share of the maximum, up to its
    limit, and is added with its own ``cap``.

    Args:
        levels: Values from coarse to fine, scalars or arrays of one shape; two or more.
        cap: Highest order of the method (twice the degree for energies and limit loads, the degree for
            derivatives at a point); one number, or one for each value.
        guard: Assumed order of ``d_1``, if it is not ``cap``: if an error of low order appears only on fine
            meshes, the error on coarse meshes decreases faster.
        least: A known order, which is used if a lower one is observed.
        slow: A part of the error that converges more slowly.

    Raises:
        ValueError: With fewer than two meshes, because one mesh gives no uncertainty.
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
    spread = _from_differences(first, last, known, cap, guard)
    if slow is not None:
        most = slow.size * np.maximum(np.abs(fine), 1.0)
        spread += _from_differences(first, last, known, np.minimum(cap, slow.order), None, most)
    observed = np.where(last > floor, order, np.nan)
    return Estimate(fine, spread + floor, observed)


def _from_differences(
    first: np.ndarray,
    last: np.ndarray,
    known: np.ndarray,
    cap: float | np.ndarray,
    guard: float | None,
    most: float | np.ndarray = np.inf,
) -> np.ndarray:
    """The uncertainty from two differences; a difference counts only up to ``most``."""
    used = np.clip(known, 1.0, cap)
    safety = np.where(known >= 1.0, SAFETY, SAFETY_UNRESOLVED)
    left = np.maximum(last, first / 2.0 ** (cap if guard is None else guard))
    return safety * np.minimum(left, most) / (2.0**used - 1.0)


def estimate_in_norm(
    levels: list[np.ndarray], cap: float, guard: float | None = None, slow: Slow | None = None
) -> float:
    r"""One uncertainty for a whole field: :func:`estimate` with differences in the maximum norm.

    Pointwise differences of two meshes oscillate within cells and pass through zero, so that their observed
    orders have little meaning. Norms do not have this problem.

    Args:
        levels: Values at the same points from coarse to fine; two or more.
        cap: Highest order of the method.
        guard: As for :func:`estimate`.
        slow: As for :func:`estimate`.
    """
    values = [np.asarray(level, dtype=float) for level in levels]
    steps = [float(np.max(np.abs(b - a))) for a, b in pairwise(values)]
    size = float(np.max(np.abs(values[-1])))
    like = [size + sum(steps[k:]) for k in range(len(values))]  # scalars with these differences
    return float(estimate(like, cap, guard, slow=slow).uncertainty)


def order_in_mean(levels: list[np.ndarray]) -> float:
    """Observed order of a field: of the root mean square of its last two differences.

    Args:
        levels: Values at the same points from coarse to fine.

    Returns:
        The order; 0 with fewer than three meshes, or if only round-off is left.
    """
    if len(levels) < 3:
        return 0.0
    first, last = (float(np.sqrt(np.mean((b - a) ** 2))) for a, b in pairwise(levels[-3:]))
    floor = ALGEBRAIC * max(float(np.max(np.abs(levels[-1]))), 1.0)
    return float(np.log2(first / last)) if first > floor and last > floor else 0.0


def doubt(orders: Iterable[float], highest: float) -> float:
    r"""Factor for the uncertainties of a state that the coarse meshes do not resolve; else 1.

    No field can converge faster than its elements, whose order is :math:`q_0`. If its differences, in the
    mean, decrease at the order :math:`q_0 + e`, the coarse meshes did not resolve it. The error of the
    numbers of an equilibrium is of the square of the error of its fields. Their differences may thus have
    decreased :math:`2e` orders faster than they will on finer meshes:

    .. math:: f = 4^{\min(e, 1)}, \quad e = \max_\mathrm{fields} q - q_0 > \tfrac12

    A larger excess than one order shows that the coarsest mesh is far off, and gives no more information on
    the finer ones.

    A single number is not sufficient: if its difference passes through zero, any order may be observed.

    Args:
        orders: Orders of the state's fields (:func:`order_in_mean`).
        highest: Order of the elements in the mean: their degree plus one.
    """
    excess = max(orders, default=0.0) - highest
    return float(4.0 ** min(excess, 1.0)) if excess > TOO_FAST else 1.0


def widened(uncertainty: np.ndarray) -> np.ndarray:
    """Largest value of each point and its neighbours, because a difference may pass through zero."""
    padded = np.pad(uncertainty, ((1, 1), (0, 0)), mode="edge")
    return np.maximum.reduce([padded[:-2], padded[1:-1], padded[2:]])
