"""Branches of surfaces, on one mesh and on a family of meshes, the coarsest of which may be too coarse."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.amounts import AmountCurve
from weakforms.solvers.continuation.crossing import Crossing
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.stability.modal import ModalBranch, ModalFamily

STEPS = 4
"""Number of steps beyond its end by which a mesh is followed for a special point of other meshes."""

ORDER_AT_EDGE = 2.0
"""Order of the errors if the pressure has a kink inside of elements. Their signs change from mesh to mesh."""

FEWEST = 2
"""Number of meshes that special points must be on, in the same order, for an uncertainty."""


class SurfaceBranch(ModalBranch):
    """A modal branch that other branches may cross within the states' own class of displacements.

    A strip that is the same along its edges is an example: a wave along them may keep both mirrors.
    """

    def _placed(self) -> list[tuple[float, Solved]]:
        """Besides, the points where the inertia of the tangent changes away from limit loads.

        Raises:
            ConvergenceError: If several eigenvalues change sign at once, as where a symmetry is broken.
        """
        counts = np.array([point.n_negative for point in self.points])
        limits = {i for i, p in enumerate(self.points) if any(p is limit for limit, _ in self._limits)}
        crossed = [i for i in np.flatnonzero(np.diff(counts)).tolist() if not {i, i + 1} & limits]
        if any(abs(counts[i + 1] - counts[i]) > 1 for i in crossed):
            raise ConvergenceError(
                f"several eigenvalues change sign between neighbours (after points {crossed}): shorter "
                "steps are needed, or a symmetry is broken"
            )
        own = {"n": 0.0} if self.modes.wave_numbers else {}
        found = []
        for i in crossed:  # before the classes are searched: points that are added then would move these
            solved = Crossing(self, i).located()
            found.append((self._arclength(i, solved), replace(solved, values=solved.values | own)))
        return super()._placed() + found


class FilledBranch(AmountCurve, SurfaceBranch):
    """States over a load; folds of the amount of gas or liquid, ``modes.amount``, are special points.

    They are the ends of what can be reached by filling. ``modes.folds`` names the kinds of folds, of the mass
    of a gas too.
    """

    def _placed(self) -> list[tuple[float, Solved]]:
        """Besides, the folds of the amount."""
        found = super()._placed()
        folds = self.folds(self.control, self.modes.amount, self.modes.folds)
        return found + [(self._arclength(i, solved), solved) for i, solved in folds]


class SurfaceFamily(ModalFamily):
    """As for any modal branch; a coarsest mesh with other special points than the finer ones is left out.

    Each mesh of a surface is only half as fine as the next one, and a few triangles do not resolve a small
    pond or a bulge. Special points are then compared, and uncertainties estimated, on the other meshes.
    """

    def _found(self) -> list[list[Solved]]:
        """The special points of each mesh; one near the end of a branch lies beyond it on some meshes."""
        found = super()._found()
        kinds = [[solved.kind for solved in points] for points in found]
        most = max(kinds, key=len)
        for k, level in enumerate(self.levels):
            if len(kinds[k]) < len(most) and kinds[k] == most[: len(kinds[k])]:
                found[k] = self._beyond(level, most) or found[k]
        return found

    @staticmethod
    def _beyond(level: SolutionCurve, wanted: list[str]) -> list[Solved]:
        """The special points of a mesh up to a few steps beyond its end, if they are those wanted."""
        count = len(level.points)
        with suppress(ConvergenceError):
            for _ in range(STEPS if level.stalled is level.ended is None else 0):
                level.go_on()
                found = level.special()
                if [solved.kind for solved in found] == wanted:
                    return found
        del level.points[count:]
        return []

    def _locate(self) -> list[tuple[Solved, ...]]:
        try:
            return super()._locate()
        except ConvergenceError as error:
            if len(self.levels) <= FEWEST:
                raise
            coarsest = self.levels.pop(0)
            try:
                found = self._locate()
            except ConvergenceError:
                self.levels.insert(0, coarsest)
                raise error from None
            self._samplers.clear()  # by the number of the mesh
            self.warnings.append(
                f"special points and states are those of the {len(self.levels)} finest meshes; with the "
                f"coarsest one: {error}; raise cells"
            )
            return found
