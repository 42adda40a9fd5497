"""Free inflation with its stability against waves: special points of every family, and where it wrinkles."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np

from weakforms.problems.meridian.compression import ONSET, SLOPES
from weakforms.problems.meridian.families import WaveBranch, WaveFamily
from weakforms.problems.tube.waves import EXTREMES
from weakforms.results import Branch, Quantity
from weakforms.solvers.continuation.crossing import Crossing
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State

SLACK = 1e-9
"""Resultants below this magnitude count as zero: without pressure the hoop resultant is zero everywhere."""

PLACES = 6
"""Decimal places of the arc length by which special points are put in order."""


class TubeBranch(WaveBranch):
    """Free inflation with the stability against waves."""

    along = "u_max"

    limit: Callable[[State], str] = staticmethod(lambda _state: "")
    """Why the law takes no more than a state, where a trace may stall."""

    def special(self) -> list[Solved]:
        """Limit points, zeros of every family and onsets of wrinkling, in order along the branch."""
        return [self._flagged(solved) for solved in super().special()]

    def _placed(self) -> list[tuple[float, Solved]]:
        found = super()._placed()
        for i in self._symmetry_lost():
            found.append(self._beside(i, Crossing(self, i).located()))
        for i in self._onsets():
            found.append(self._beside(i, self.zero(i, self._least, ONSET)))
        # Short even and odd waves are neutral at one state to round-off: keep their order on all meshes.
        return [(round(s, PLACES), solved) for s, solved in found]

    def _beside(self, i: int, solved: Solved) -> tuple[float, Solved]:
        return self._arclength(i, solved), solved

    def _symmetry_lost(self) -> list[int]:
        """Points of the trace after which states of a whole tube lose their mirror symmetry."""
        if not self.modes.full:
            return []
        limits = {id(point) for point, _ in self._limits}
        counts = np.array([point.n_negative for point in self.points])
        return [i for i in np.flatnonzero(np.diff(counts)).tolist() if id(self.points[i]) not in limits]

    def _onsets(self) -> list[int]:
        """Points of the trace after which the smallest principal resultant changes its sign."""
        least = self._leasts()
        sign = np.where(np.abs(least) > SLACK, np.sign(least), 0.0)
        known = np.flatnonzero(sign)
        return [int(i) for i, j in pairwise(known) if sign[i] * sign[j] < 0]

    def _leasts(self) -> np.ndarray:
        """The smallest principal resultant at each point of the trace."""
        return self.over_points("t_min")

    def _least(self, solved: Solved) -> float:
        with self.system.at(solved.state):
            return self.modes.least_resultant()[0]

    def _flagged(self, solved: Solved) -> Solved:
        """The point with ``wrinkled``: 1 if its membrane is compressed somewhere."""
        return replace(solved, values=solved.values | {"wrinkled": float(is_wrinkled(self._least(solved)))})

    def counted(self, state: State, own: int | None = None) -> dict[str, int]:
        """Numbers of negative eigenvalues of a state, and whether it is wrinkled.

        Args:
            state: The state.
            own: Number in the symmetry of the states, if it is known (at a limit point it is round-off's).
        """
        with self.system.at(state):
            return self.modes.counts(own) | {"wrinkled": int(is_wrinkled(self.modes.least_resultant()[0]))}


def is_wrinkled(least: float) -> bool:
    """Whether a smallest principal resultant is compressive."""
    return least < -SLACK


class TubeFamily(WaveFamily):
    """Free inflation with its stability, on all meshes."""

    fine: TubeBranch
    marks: ClassVar = (*WaveFamily.marks, "wrinkled")
    located_by: ClassVar = {ONSET: "t_min"}

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All columns; the extremes have round-off too."""
        found = super().branch(with_uncertainty)
        return replace(found, uncertainty=_with_rounding(found.uncertainty))

    def located(self, kind: str) -> list[tuple[Solved, ...]]:
        """The special points of a kind in their order, each on all meshes."""
        return [same for same in self._special() if same[-1].kind == kind]

    def _quantity(
        self, values: list[float], name: str = "", held: str = "", in_mean: float = 0.0, most: float = np.inf
    ) -> Quantity:
        found = super()._quantity(values, name, held, in_mean, most)
        return replace(found, uncertainty=_with_rounding({name: found.uncertainty})[name])


def _with_rounding(uncertainty: Mapping[str, Any]) -> dict[str, Any]:
    """Uncertainties of columns, those of the extremes with round-off."""
    return {name: u + SLOPES if name in EXTREMES else u for name, u in uncertainty.items()}
