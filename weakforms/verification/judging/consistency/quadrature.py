"""Derivatives, integrals and extremes of what is known at points only, each with its uncertainty."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from weakforms.solvers.support.roots import root

NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)

SAFETY = 3.0
"""Factor of a difference between two degrees, as between two meshes whose order is not known."""

PLACES = 401
"""Places between two neighbours at which an extreme is looked for."""

BEYOND, DEGREES = 12, (10, 9, 8, 7)
"""Points beyond a place from which one goes back to it, and the degrees of the polynomials through them. Of
6000 sums of four random poles 0.9 % are farther off than :func:`spread` says, with three degrees 2.6 %."""

Estimated = tuple[float, float]
"""A number and its absolute uncertainty: how far two degrees are apart, times :data:`SAFETY`."""


def splines(x: np.ndarray, y: np.ndarray) -> tuple[BSpline, BSpline]:
    """Through the points: of degree 5, and of degree 3 to see how far off that is."""
    return make_interp_spline(x, y, k=5), make_interp_spline(x, y, k=3)


def value_at(x: np.ndarray, y: np.ndarray, place: float, derivative: int = 0) -> Estimated:
    """A column or its derivative at a place."""
    fine, coarse = (float(s(place, derivative)) for s in splines(x, y))
    return fine, SAFETY * abs(fine - coarse)


def beyond(
    x: np.ndarray, y: np.ndarray, place: float, derivatives: int = 0, either: bool = False
) -> list[list[float]] | None:
    """A column and its derivatives at a place where it may have a kink, from the points beyond it alone.

    Args:
        x: Places, rising.
        y: The column there.
        place: Where it is wanted.
        derivatives: The highest.
        either: Whether points before it will do where there are too few beyond: without a kink.

    Returns:
        By each degree; ``None`` with too few points there.
    """
    outside = np.flatnonzero(x > place)[:BEYOND]
    if len(outside) < BEYOND and either:
        outside = np.flatnonzero(x < place)[-BEYOND:]
    if len(outside) < BEYOND:
        return None
    fits = [np.polynomial.Polynomial.fit(x[outside], y[outside], degree) for degree in DEGREES]
    return [[float(fit.deriv(m)(place)) for m in range(derivatives + 1)] for fit in fits]


def gain(x: np.ndarray, place: float, derivative: int) -> float:
    """Most that an error of one in each point changes what :func:`beyond` finds for a derivative."""
    outside = x[x > place][:BEYOND]
    found = (
        np.polynomial.Polynomial.fit(outside, unit, DEGREES[0]).deriv(derivative)(place)
        for unit in np.eye(len(outside))
    )
    return float(np.sum(np.abs(list(found))))


def spread(found: Sequence[float]) -> Estimated:
    """The first of the numbers that degrees give, and how far they are apart."""
    return float(found[0]), SAFETY * float(np.max(np.abs(np.diff(found))))


def where(x: np.ndarray, y: np.ndarray, level: float) -> float:
    """Where a rising column has a value; an end where it does not."""
    if level <= y[0]:
        return float(x[0])
    if level >= y[-1]:
        return float(x[-1])
    spline = make_interp_spline(x, y, k=5)
    i = int(np.searchsorted(y, level))
    return root(lambda at: float(spline(at)) - level, x[i - 1], x[i], f"a value of {level:g}")


def integral(x: np.ndarray, weight: np.ndarray, of: np.ndarray, end: float | None = None) -> Estimated:
    r"""Integral :math:`\int w \, \mathrm{d}f` along points, up to a place.

    Differences of the two degrees are added by interval without their signs, so that they do not cancel.
    """
    edges = np.append(x[x < end], end) if end is not None else x
    fine, coarse = (
        _by_interval(w, f, edges) for w, f in zip(splines(x, weight), splines(x, of), strict=True)
    )
    return float(np.sum(fine)), SAFETY * float(np.sum(np.abs(fine - coarse)))


def work_by_interval(along: np.ndarray, weight: np.ndarray, of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    r"""Integrals :math:`\int w \, \mathrm{d}f` from point to point, with their uncertainties."""
    fine, coarse = (
        _by_interval(w, f, along) for w, f in zip(splines(along, weight), splines(along, of), strict=True)
    )
    return fine, SAFETY * np.abs(fine - coarse)


def _by_interval(weight: BSpline, of: BSpline, edges: np.ndarray) -> np.ndarray:
    half = np.diff(edges) / 2
    at = edges[:-1, None] + half[:, None] * (1 + NODES)
    return (weight(at) * of(at, 1)) @ WEIGHTS * half


def extreme(x: np.ndarray, y: np.ndarray, pick: Callable[[np.ndarray], int]) -> Estimated:
    """Largest or smallest value, by the splines between the neighbours of the point that has it."""
    i, last = int(pick(y)), len(y) - 1
    about = np.linspace(x[max(i - 1, 0)], x[min(i + 1, last)], PLACES)
    values, others = (spline(about) for spline in splines(x, y))
    if about[pick(values)] == x[i] and i in (0, last):
        return float(y[i]), 0.0
    fine = float(values[pick(values)])
    apart = float(np.max(np.abs(values - others)))  # the difference at the tops alone may happen to vanish
    between = float(np.max(np.abs(np.diff(values, 2))))  # more than the top rises above the places looked at
    return fine, SAFETY * apart + between


def lengths(edges: list[float], inside: Callable[[float], bool]) -> float:
    """Length of the pieces between edges whose middle is inside."""
    return sum(b - a for a, b in pairwise(edges) if inside((a + b) / 2))
