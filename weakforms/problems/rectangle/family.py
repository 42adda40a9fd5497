"""The branch of a rectangular membrane on a family of meshes, with the deformed sheet of each state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np

from weakforms.problems.triangles.shape import Shape
from weakforms.results import Field, Quantity, State
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.stability.surface_family import ORDER_AT_EDGE, FilledBranch, SurfaceFamily

MIRRORS = ((1, 1), (-1, 1), (1, -1), (-1, -1))
"""Signs of ``X`` and ``Y`` of the quarters that make the whole sheet."""


class RectangleFamily(SurfaceFamily):
    """As for any modal branch; a state with a profile also has the sheet on the finest mesh."""

    fine: FilledBranch
    marks: ClassVar = ("n", "C4v")
    _last: Solved | None = None

    def smooth_order(self, values: Mapping[str, float]) -> float:
        """Of a pond that wets a part only, the edge of the wet part crosses elements."""
        return ORDER_AT_EDGE if values.get("zw", 0.0) < 0 else np.inf

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """As for any branch, with corners and triangles before the profile.

        Raises:
            InputError: If the branch has no such state.
        """
        state = super().state(name, value, crossing, profile)
        if profile is None:
            return state
        model = self.fine.modes.model
        mirrors = ((1, 1),) if model.sheet.whole else MIRRORS
        with model.system.at(self._last.state):
            return replace(state, fields=(*Shape(model.mesh, model.membrane, mirrors)(), *state.fields))

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """As for any modal branch; of a square also the lowest eigenvalue in each class."""
        rows = []
        for level, at in zip(self.levels, solved, strict=True):
            with level.system.at(at.state):
                rows.append({f"eigenvalue_{name}": mu for name, mu in level.modes.lowest().items()})
        found = {name: self._quantity([row[name] for row in rows], name) for name in rows[-1]}
        return super()._diagnostics(solved, critical) | found

    def _profile(self, solved: Sequence[Solved], points: np.ndarray) -> Field:
        self._last = solved[-1]
        return super()._profile(solved, points)
