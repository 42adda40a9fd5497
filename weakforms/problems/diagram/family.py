"""A line on a family of meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import compress
from typing import ClassVar

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.diagram.about import LINES
from weakforms.problems.diagram.followed import PLACE
from weakforms.problems.diagram.lines import LinesOnMesh, Seed
from weakforms.problems.disk.problem import POLE, order_at_pole
from weakforms.problems.tube.problem import MIDDLE, order_at_middle
from weakforms.problems.tube.stability import is_wrinkled
from weakforms.results import Quantity, SpecialPoint
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.continuation.line import AWAY
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.uncertainty.family import BranchFamily, Compared

COUNTS = {"mirror": "n_mirror", "localisation": "n_localisation"}
"""Column with the number of negative eigenvalues of a kind, if it is not that of waves."""


POINTS_OF = {"t_min": "t2", "u_max": "rho", "lam1_mid": "lam1"}
"""Columns that are values at a point of the meridian, and of which field; the least resultant is the hoop's,
because tension along a meridian bears the pressure."""


def orders_of(degree: int, pole: bool) -> dict[str, float]:
    """Highest orders of the columns that are no functionals of the whole membrane.

    Args:
        degree: Of the elements; inside of a cell and at a clamp it is the order of a resultant.
        pole: Whether the membrane has a pole.
    """
    caps = {"t_min": float(degree)} | dict.fromkeys(MIDDLE, order_at_middle(degree))
    return caps | dict.fromkeys(POLE if pole else (), order_at_pole(degree))


class LineFamily(BranchFamily):
    """A line on all meshes; its trace also has numbers of negative eigenvalues of other symmetries.

    Args:
        meshes: Primary branches and lines, coarse to fine.
        seed: Where the line starts.
        name: Name of the line.
        cap: Highest order of convergence.
        caps: Lower ones of some columns.
        size: Usual change of the column ``depth`` over that of the parameter.
    """

    located_by: ClassVar = {f"wrinkling_{kind}": "t_min" for kind in LINES}

    def __init__(
        self,
        meshes: Sequence[LinesOnMesh],
        seed: Seed,
        name: str,
        cap: float,
        caps: Mapping[str, float],
        size: float = 1.0,
    ) -> None:
        self.meshes, self.models, self.seed = meshes, [mesh.model for mesh in meshes], seed
        self.kind, self.size = seed.kind, size
        self.counted = meshes[0].broken
        across = meshes[0].window.vary, meshes[0].depth
        super().__init__(lambda k: meshes[k].line(seed), len(meshes), cap, across, name, caps, POINTS_OF)

    def _trace(self) -> dict[str, np.ndarray]:
        """Columns of the finest mesh's trace."""
        own = [self._own(-1, point.state, 0.0) for point in self.fine.points]
        names = [name for name in own[0] if name != PLACE]  # it needs a solve for its uncertainty
        return super()._trace() | {name: np.array([row[name] for row in own]) for name in names}

    def _compared(self, point: CurvePoint, near: float, row: dict[str, float]) -> Compared:
        """As for any branch, in a plane across the line in which the displacement is over its usual size."""
        vary, depth = self.across
        rates = self.fine.direction(point, self.across)
        plane = {vary: rates[vary], depth: rates[depth] / self.size**2}
        others = [level.at_position(point, plane, near).values for level in self.levels[:-1]]
        return [*others, row], row

    def special_points(self) -> list[SpecialPoint]:
        """Points at which a second condition holds, with ``wrinkled``: 1 if their membrane is compressed."""
        points = super().special_points()
        for point in points:
            point.values["wrinkled"] = float(is_wrinkled(point.values["t_min"]))
            point.uncertainty["wrinkled"] = 0.0
        return points

    def _found(self) -> list[list[Solved]]:
        """The special points of each mesh; one near a side of the window may be beyond it on another mesh."""
        found = super()._found()
        if _same_kinds(found):
            return found
        with suppress(ConvergenceError):  # the caller says that the meshes differ
            wider = [mesh.beyond(self.seed).special() for mesh in self.meshes]
            window, depth = self.meshes[-1].window, self.meshes[-1].depth
            inside = [not window.outside(point.values, depth) for point in wider[-1]]
            kept = [list(compress(points, inside)) for points in wider]
            if _same_kinds(wider) and _same_kinds([kept[-1], found[-1]]):
                return kept
        return found

    def _own(self, level: int, state: State, critical: float) -> dict[str, float]:
        """Negative eigenvalues of other symmetries without a critical one, and what is said of wrinkling."""
        model, line = self.models[level], self.levels[level]
        found: dict[str, float] = {}
        with model.system.at(state):
            for kind in self.counted:
                shift = AWAY if self.kind == kind else critical
                counts = [form().negative_count(shift) for form in model.operators(kind).values()]
                if counts:
                    found[COUNTS.get(kind, f"n_negative_{kind}")] = sum(counts)
            if self.kind == "wrinkling":
                found |= model.at_onset()
            else:
                found["wrinkled"] = int(is_wrinkled(model.system.monitors()["t_min"]))
            for parity, form in model.operators(self.kind).items():
                if parity and form() is line.condition.variation():
                    found["parity"] = parity
        return found

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """As for any branch, with the same columns as the trace."""
        own = [self._own(k, s.state, critical) for k, s in enumerate(solved)]
        found = super()._diagnostics(solved, critical)
        for name in own[-1]:
            values = [row[name] for row in own]
            found[name] = self._quantity(values, name) if name == PLACE else Quantity(same_count(values))
        return found


def _same_kinds(found: Sequence[Sequence[Solved]]) -> bool:
    """Whether the meshes have points of the same kinds in the same order."""
    return len({tuple(point.kind for point in points) for points in found}) == 1
