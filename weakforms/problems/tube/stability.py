"""Free inflation with its stability against waves: special points of every family, and where it wrinkles."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf
from typing import Any, ClassVar

import numpy as np

from weakforms.problems.meridian.compression import ONSET, SLOPES
from weakforms.problems.tube.waves import EXTREMES, Wave
from weakforms.results import Branch, Quantity
from weakforms.solvers.continuation.crossing import Crossing
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.modal import ModalBranch, ModalFamily
from weakforms.solvers.uncertainty.family import BranchFamily

SLACK = 1e-9
"""Resultants below this magnitude count as zero: without pressure the hoop resultant is zero everywhere."""

PLACES = 6
"""Decimal places of the arc length by which special points are put in order."""


class TubeBranch(ModalBranch):
    """Axisymmetric states over the pressure, with the stability against waves."""

    end = inf
    """``u_max`` at which the branch ends. Its last step goes beyond, on each mesh by another length."""

    limit: Callable[[State], str] = staticmethod(lambda _state: "")
    """Why the law takes no more than a state, where a trace may stall."""

    @property
    def computed(self) -> Sequence[str]:
        """The additional columns, and the lowest eigenvalue in the symmetry of the states."""
        return ("eigenvalue_1", *self.modes.columns)

    def special(self) -> list[Solved]:
        """Limit points, zeros of every family and onsets of wrinkling, in order along the branch."""
        found = [self._flagged(solved) for solved in super().special()]
        return [s for s in found if s.kind == "limit_point" or s.values["u_max"] <= self.end]

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
        least = self.over_points("t_min")
        sign = np.where(np.abs(least) > SLACK, np.sign(least), 0.0)
        known = np.flatnonzero(sign)
        return [int(i) for i, j in pairwise(known) if sign[i] * sign[j] < 0]

    def _least(self, solved: Solved) -> float:
        with self.system.at(solved.state):
            return self.modes.least_resultant()[0]

    def _flagged(self, solved: Solved) -> Solved:
        """The point with ``wrinkled``: 1 if its membrane is compressed somewhere."""
        return replace(
            solved, values=solved.values | {"wrinkled": float(is_wrinkled(solved.values["t_min"]))}
        )

    def counted(self, state: State, own: int | None = None) -> dict[str, int]:
        """Numbers of negative eigenvalues of a state, and whether it is wrinkled.

        Args:
            state: The state.
            own: Number in the symmetry of the states, if it is known (at a limit point it is round-off's).
        """
        with self.system.at(state):
            return self.modes.counts(own) | {"wrinkled": int(is_wrinkled(self.modes.least_resultant()[0]))}

    def _named(self, n: Wave, direction: float) -> tuple[str, dict[str, float]]:
        return n.kind, {"n": float(n.n), "parity": float(n.parity), "direction": direction}


def is_wrinkled(least: float) -> bool:
    """Whether a smallest principal resultant is compressive."""
    return least < -SLACK


class TubeFamily(ModalFamily):
    """Free inflation with its stability, on all meshes."""

    fine: TubeBranch
    marks: ClassVar = ("n", "parity", "direction", "wrinkled")
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

    def _trace(self) -> dict[str, np.ndarray]:
        """Columns of the finest mesh's trace, with the counts."""
        rows = [self.fine.counted(point.state, point.n_negative) for point in self.fine.points]
        return super()._trace() | {name: np.array([row[name] for row in rows]) for name in rows[0]}

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Numbers of negative eigenvalues; at a special point those of the waves are left out."""
        found = BranchFamily._diagnostics(self, solved, critical)
        if critical:
            return found
        rows = [level.counted(s.state) for level, s in zip(self.levels, solved, strict=True)]
        return found | {name: Quantity(same_count(row[name] for row in rows)) for name in rows[0]}


def _with_rounding(uncertainty: Mapping[str, Any]) -> dict[str, Any]:
    """Uncertainties of columns, those of the extremes with round-off."""
    return {name: u + SLOPES if name in EXTREMES else u for name, u in uncertainty.items()}
