"""Surfaces on which fronts of wrinkles lie inside of elements, where stresses have kinks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from weakforms.results import Branch, Quantity
from weakforms.solvers.uncertainty.family import BranchFamily

FRACTION = "wrinkled_fraction"
"""Column of the part of the membrane that is wrinkled."""

INDICATED = 4
"""Quadrature degree, over that of the unknowns, by which this part is measured on a surface."""

KINK = 2.0
"""Highest assumed order of a wrinkled state: stresses have kinks inside of elements, and signs of errors
change from mesh to mesh."""

EDGE, SEEN = 1.0, 0.1
"""The same of the wrinkled part, and its relative error that no difference of meshes shows: it is about as
wide as a cell at the disk. For the neo-Hookean tube of length 10 at seven volumes from 6.5 to 9, the part on
meshes of 24 cells differs from that on 40 by 0.3 to 10 %."""


class KinkedFamily(BranchFamily):
    """A branch of taut and wrinkled states of a surface, which has the column :data:`FRACTION`."""

    def smooth_order(self, values: Mapping[str, float]) -> float:
        """Lower than that of the elements if there is a front."""
        return KINK if values[FRACTION] > 0 else np.inf

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All columns; the wrinkled part also with what no mesh shows."""
        found = super().branch(with_uncertainty)
        if with_uncertainty:
            found.uncertainty[FRACTION] += SEEN * found.columns[FRACTION]
        return found

    def _quantity(
        self, values: list[float], name: str = "", held: str = "", in_mean: float = 0.0, most: float = np.inf
    ) -> Quantity:
        found = super()._quantity(values, name, held, in_mean, most)
        unseen = SEEN * found.value if name == FRACTION else 0.0
        return replace(found, uncertainty=found.uncertainty + unseen)
