"""A branch of a surface on a family of meshes, the coarsest of which may be too coarse for it."""

from __future__ import annotations

from contextlib import suppress

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.stability.modal import ModalFamily

STEPS = 4
"""Number of steps beyond its end by which a mesh is followed for a special point of other meshes."""

FEWEST = 2
"""Number of meshes that special points must be on, in the same order, for an uncertainty."""


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
