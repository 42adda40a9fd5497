"""Extrema, along a curve, of an amount such as a volume, or of a number that follows from load and amount."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from weakforms.solvers.continuation.continuation import CurvePoint, Tangent
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.state import State

Rate = Callable[[float, float, float, float], float]
"""Rate of a number along the curve, from load, amount, and the rates of both."""


class AmountCurve(SolutionCurve):
    """A curve along which an amount has extrema."""

    def folds(
        self, load: str, amount: str, kinds: Mapping[str, Rate], within: tuple[int, int | None] = (0, None)
    ) -> list[tuple[int, Solved]]:
        """Points where a rate is zero, by their kind, each with the index of the point before it.

        Args:
            load: The load.
            amount: The functional.
            kinds: Rates by the kind of a point where they vanish.
            within: First point that is looked at, and the one after the last.
        """

        def value(at: Solved, rate: Rate, like: CurvePoint) -> float:
            tangent = self.continuation.direction(at.state, like.tangent)
            return rate(*self._rates(at.state, tangent, load, amount))

        found, points = [], self.points[slice(*within)]
        for kind, rate in kinds.items():
            rates = np.array([rate(*self._rates(p.state, p.tangent, load, amount)) for p in points])
            for i in (np.flatnonzero(rates[:-1] * rates[1:] < 0) + within[0]).tolist():
                found.append((i, self.zero(i, partial(value, rate=rate, like=self.points[i]), kind)))
        return found

    def _rates(
        self, state: State, along: Tangent, load: str, amount: str
    ) -> tuple[float, float, float, float]:
        """Load, amount and their rates along the curve at a state."""
        with self.system.at(state):
            rate, value = self.continuation.rate(amount, along), self.system.monitor(amount)
        return state.loads[load], value, along.loads[load], rate
