"""Numbers with uncertainties, alone or in arrays, and the propagation of uncertainties."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev

from weakforms.results import Quantity, SpecialPoint


@dataclass(frozen=True, eq=False)
class Number:
    r"""Values with absolute uncertainties of the same shape.

    Arithmetic propagates them to first order, as if they were independent,
    :math:`u^2 = \sum (\partial f/\partial x_i)^2 u_i^2`; plain numbers are exact. ``<`` and ``==`` do not
    work; :mod:`weakforms.verification.judging.decide` compares them with their uncertainties.
    """

    value: Any
    uncertainty: Any
    __array_ufunc__ = None  # numpy arrays leave the arithmetic with a Number to this class

    def __post_init__(self) -> None:
        value = np.asarray(self.value, dtype=float)
        spread = np.broadcast_to(np.asarray(self.uncertainty, dtype=float), value.shape)
        # A negative uncertainty is invalid.
        object.__setattr__(self, "value", value)
        object.__setattr__(self, "uncertainty", np.where(spread >= 0, spread, np.nan))

    def __bool__(self) -> bool:
        raise TypeError("a number with an uncertainty is neither true nor false; ask weakforms.decide")

    def __len__(self) -> int:
        return len(self.value)

    def __getitem__(self, index: Any) -> Number:
        return Number(self.value[index], self.uncertainty[index])

    def __neg__(self) -> Number:
        return Number(-self.value, self.uncertainty)

    def __abs__(self) -> Number:
        return Number(np.abs(self.value), self.uncertainty)

    def __add__(self, other: Any) -> Number:
        other = number(other)
        return Number(self.value + other.value, np.hypot(self.uncertainty, other.uncertainty))

    def __sub__(self, other: Any) -> Number:
        return self + -number(other)

    def __mul__(self, other: Any) -> Number:
        other = number(other)
        spread = np.hypot(self.uncertainty * other.value, other.uncertainty * self.value)
        return Number(self.value * other.value, spread)

    def __truediv__(self, other: Any) -> Number:
        return self * number(other) ** -1

    def __pow__(self, exponent: float) -> Number:
        with np.errstate(all="ignore"):
            value, rate = self.value**exponent, exponent * self.value ** (exponent - 1)
            # A number that may be zero has no reciprocal, even if the first order suggests one.
            known = (exponent > 0) | (np.abs(self.value) > self.uncertainty)
            return Number(value, np.where(known, np.abs(rate) * self.uncertainty, np.nan))

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> Number:
        return number(other) - self

    def __rtruediv__(self, other: Any) -> Number:
        return number(other) / self

    def log(self) -> Number:
        """Natural logarithm; NaN for a number that may be zero or less."""
        with np.errstate(all="ignore"):
            known = self.value > self.uncertainty
            return Number(np.log(self.value), np.where(known, self.uncertainty / np.abs(self.value), np.nan))

    def diff(self) -> Number:
        """Differences between neighbouring entries."""
        return self[1:] - self[:-1]

    def largest(self) -> Number:
        """The largest entry, with the largest uncertainty of all entries."""
        return Number(np.max(self.value), np.max(self.uncertainty))

    def smallest(self) -> Number:
        """The smallest entry, with the largest uncertainty of all entries."""
        return Number(np.min(self.value), np.max(self.uncertainty))


def number(of: Any) -> Number:
    """A quantity or an exact number as a :class:`Number`.

    A quantity without an uncertainty is a count or exact; its uncertainty is its rounding.
    """
    if isinstance(of, Number):
        return of
    if isinstance(of, Quantity):
        rounding = np.finfo(float).eps * abs(of.value)
        return Number(of.value, rounding if of.uncertainty is None else of.uncertainty)
    return Number(of, 0.0)


def of_point(point: SpecialPoint, name: str) -> Number:
    """One number of a special point."""
    return Number(point.values[name], point.uncertainty[name])


def stack(items: Iterable[Any]) -> Number:
    """Stack numbers, or arrays of the same length, to one array with one row for each."""
    items = [number(item) for item in items]
    return Number([item.value for item in items], [item.uncertainty for item in items])


def join(items: Iterable[Any]) -> Number:
    """Join numbers and arrays to one array."""
    items = [number(item) for item in items]
    ends = [np.concatenate([np.atleast_1d(getattr(i, k)) for i in items]) for k in ("value", "uncertainty")]
    return Number(*ends)


def work(nodes: np.ndarray, force: np.ndarray, along: np.ndarray) -> Number:
    r"""Work :math:`\int f \,\mathrm{d}a` from the first of some nodes to the last, by polynomials over them.

    Args:
        nodes: Chebyshev-Lobatto points of an abscissa, ascending.
        force: Values of ``f`` there.
        along: Values of ``a``.

    Returns:
        The work; its uncertainty is the difference from polynomials of two degrees less. Errors of the values
        are not in it.
    """

    def done(degree: int) -> float:
        f, a = (Chebyshev.fit(nodes, values, degree) for values in (force, along))
        whole = (f * a.deriv()).integ()
        return float(whole(nodes[-1]) - whole(nodes[0]))

    most = len(nodes) - 1
    return Number(done(most), abs(done(most) - done(most - 2)))
