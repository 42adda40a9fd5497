"""Numbers of a state of a rectangular membrane that are not functionals: the stretch at its centre."""

from __future__ import annotations

import numpy as np
import ufl

from weakforms.problems.rectangle.model import RectangleModel
from weakforms.solvers.support.sampling import Sampler


class Centre:
    """The larger stretch at the centre, where by symmetry the principal directions are those of the edges."""

    def __init__(self, model: RectangleModel) -> None:
        tangents = ufl.grad(model.membrane.position)
        c = {f"C{i}": ufl.dot(tangents[:, i], tangents[:, i]) for i in (0, 1)}
        self._sampler = Sampler(model.unknown, c, np.zeros((1, 2)))

    def stretch(self) -> float:
        """From the mean of ``C`` on the triangles around the centre."""
        return float(np.sqrt(max(values[0] for values in self._sampler().values())))
