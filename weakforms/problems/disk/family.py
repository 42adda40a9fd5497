"""A branch of the disk on a family of meshes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from weakforms.problems.disk.model import UNEQUAL
from weakforms.results import Quantity
from weakforms.solvers.uncertainty.family import BranchFamily

STRETCHES = 1e-13
"""Round-off of the difference of two stretches. Where they begin to differ in a nearly slack disk, that place
is scattered over meshes of 64 to 192 cells and degrees 4 to 6 by 4e-14 to 1.1e-13 over their slope."""


def rounded(place: float) -> float:
    """Round-off of ``X_iso``, whose difference of stretches rises with the square of the place."""
    return STRETCHES * place / (2 * UNEQUAL)


class DiskFamily(BranchFamily):
    """A branch of the disk; where its stretches begin to differ has their round-off over their slope."""

    def left_by_round_off(self, index: int) -> Mapping[str, float]:
        """That of ``X_iso`` at a point of the trace."""
        return {"X_iso": rounded(self.fine.points[index].monitors["X_iso"])}

    def _quantity(
        self, values: list[float], name: str = "", held: str = "", in_mean: float = 0.0, most: float = np.inf
    ) -> Quantity:
        found = super()._quantity(values, name, held, in_mean, most)
        if name != "X_iso":
            return found
        return replace(found, uncertainty=found.uncertainty + rounded(found.value))
