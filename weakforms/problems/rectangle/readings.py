"""What is read at a state of a rectangular membrane at points: the centre's stretch, a square's diagonals."""

from __future__ import annotations

import numpy as np
import ufl

from weakforms.errors import ConvergenceError
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


SEEN = np.linspace(0.07, 0.93, 8)
"""Coordinates of the points of an octant at which a square is held against its mirror image."""

LOST = 1e-6
"""Largest difference of a displacement from its mirror image, over the largest displacement there."""


class Diagonal:
    """Whether a state of a square, on the quarter of it, has the mirrors in its diagonals."""

    def __init__(self, model: RectangleModel) -> None:
        points = np.array([(x, y) for x in SEEN for y in SEEN if y < x])
        components = dict(zip("xyz", model.unknown, strict=True))
        both = np.vstack([points, points[:, ::-1]])
        self._sampler = Sampler(model.unknown, components, both)

    def require_mirrored(self) -> None:
        """Compare the displacement with its mirror image.

        Raises:
            ConvergenceError: If they differ.
        """
        (x, image_x), (y, image_y), (z, image_z) = (np.split(v, 2) for v in self._sampler().values())
        wrong = np.abs([x - image_y, y - image_x, z - image_z]).max()
        if wrong > LOST * np.abs([x, y, z]).max():
            raise ConvergenceError(
                f"a state of the square has lost the mirrors in its diagonals by {wrong:.1e}: the branch has "
                "changed to another one; a smaller step may keep it"
            )
