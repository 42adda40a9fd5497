"""Uncertainties of a bent sheet, whose band of wrinkles ends inside of triangles."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from weakforms.results import Branch, Quantity
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.uncertainty.family import BranchFamily

KINK = 2.0
"""Order of the errors if stresses have a kink inside of triangles. Their signs change from mesh to mesh."""

FIRST_ROW = 0.05
"""Distance of the first quadrature points from an edge, over the width of a square of the mesh. No mesh sees
a band of wrinkles that is narrower."""

MOMENT = 3.0
"""Relative error of the moment if a band is not seen, over the square of its width. The stress ``m Y`` of a
taut sheet has the moment ``m/12``; that of a band of width ``b`` is ``m b^2/2`` at the arm 1/2. The error
of the force is a third of this."""


class BentFamily(BranchFamily):
    """A branch of relaxed states, wrinkled along the inner edge once the stress along it has vanished there.

    Args:
        make: Builds the branch on the mesh of a level.
        levels: Number of meshes.
        cap: Order of convergence of a taut sheet.
        across: Columns of the plane in which branches of two meshes are compared.
        cells: Squares across the width on the finest mesh.
    """

    def __init__(
        self,
        make: Callable[[int], SolutionCurve],
        levels: int,
        cap: float,
        across: tuple[str, ...],
        cells: int,
    ) -> None:
        super().__init__(make, levels, cap, across)
        self._width = FIRST_ROW / cells

    def smooth_order(self, values: Mapping[str, float]) -> float:
        """Lower than that of the elements if there is a front."""
        return KINK if values["S_least"] < 0 else np.inf

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All columns; uncertainties include what no mesh sees.

        Raises:
            ConvergenceError: If no point can be compared.
        """
        found = super().branch(with_uncertainty)
        wrinkled = found.columns["S_least"] < 0
        for name in found.uncertainty:
            found.uncertainty[name] += np.where(wrinkled, self._unseen(name, found.columns[name]), 0.0)
        return found

    def _columns(
        self, solved: Sequence[Solved], held: str, orders: Mapping[str, float]
    ) -> dict[str, Quantity]:
        found = super()._columns(solved, held, orders)
        if solved[-1].values["S_least"] >= 0:
            return found
        return {
            name: replace(q, uncertainty=q.uncertainty + float(self._unseen(name, q.value)))
            for name, q in found.items()
        }

    def _unseen(self, name: str, value: np.ndarray | float) -> np.ndarray | float:
        """Error of a number that no difference of meshes shows."""
        if name == "f_w":
            return self._width
        return MOMENT * self._width**2 * np.abs(value) if name in ("T_x", "M") else 0.0
