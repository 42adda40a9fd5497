"""The branch of a membrane of any shape on a family of meshes, with the deformed surface of each state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from weakforms.problems.triangles.shape import Shape
from weakforms.results import Quantity, SpecialPoint, State
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.stability.surface_family import ORDER_AT_EDGE, FilledBranch, SurfaceFamily
from weakforms.solvers.uncertainty.family import BranchFamily


class MembraneFamily(SurfaceFamily):
    """As for any branch; a state with a profile has the surface on the finest mesh instead of the profile."""

    fine: FilledBranch
    _last: Solved | None = None

    def smooth_order(self, values: Mapping[str, float]) -> float:
        """Of a liquid that wets a part only, the edge of the wet part crosses elements."""
        partly = values.get("zw", np.inf) < self.fine.modes.model.body.top
        return ORDER_AT_EDGE if partly else np.inf

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """As for any branch, with corners and triangles if a profile is wanted.

        Raises:
            InputError: If the branch has no such state.
        """
        state = super().state(name, value, crossing)
        if profile is None:
            return state
        model = self.fine.modes.model
        with model.system.at(self._last.state):
            model.recovery()
            more = {"error": model.recovery.local}
            return replace(state, fields=Shape(model.mesh, model.membrane, law=model.law, more=more)())

    def special_points(self) -> list[SpecialPoint]:
        """As for any branch: there are no classes of modes."""
        return BranchFamily.special_points(self)

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        self._last = solved[-1]
        return BranchFamily._diagnostics(self, solved, critical)
