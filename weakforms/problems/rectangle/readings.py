"""Numbers of a state of a rectangular membrane that are not functionals: stress and stretch at points."""

from __future__ import annotations

import basix
import numpy as np
import ufl
from dolfinx import fem

from weakforms.problems.rectangle.model import RULE, RectangleModel
from weakforms.solvers.support.sampling import Sampler

ALIKE = 1e-9
"""Relative difference of stresses at points that are images of each other."""


class Points:
    """The least principal stress over the quadrature points."""

    def __init__(self, model: RectangleModel) -> None:
        self._mesh = model.mesh
        points, _ = basix.make_quadrature(basix.CellType.triangle, RULE[model.sheet.degree])
        place = ufl.SpatialCoordinate(model.mesh)
        self._expression = fem.Expression(ufl.as_vector([model.least_stress, place[0], place[1]]), points)
        self._cells = np.arange(model.mesh.topology.index_map(2).size_local, dtype=np.int32)

    def least(self) -> tuple[tuple[float, float], float]:
        """Its place, with coordinates of the quarter ``X, Y >= 0``, and its value.

        Of points that share it by symmetry, the one with the largest ``X`` is given.
        """
        values = self._expression.eval(self._mesh, self._cells).reshape(-1, 3)
        values[:, 1:] = np.abs(values[:, 1:])
        lowest = values[:, 0].min(initial=np.inf)
        lowest = min(self._mesh.comm.allgather(lowest))
        near = values[values[:, 0] <= lowest + ALIKE * abs(lowest)]
        _, x, y = max((row for rows in self._mesh.comm.allgather(near.tolist()) for row in rows), key=_order)
        return (x, y), lowest


def _order(row: list[float]) -> tuple[float, float]:
    return round(row[1], 9), round(row[2], 9)


class Centre:
    """The larger stretch at the centre, where by symmetry the principal directions are those of the edges."""

    def __init__(self, model: RectangleModel) -> None:
        tangents = ufl.grad(model.membrane.position)
        c = {f"C{i}": ufl.dot(tangents[:, i], tangents[:, i]) for i in (0, 1)}
        self._sampler = Sampler(model.unknown, c, np.zeros((1, 2)))

    def stretch(self) -> float:
        """From the mean of ``C`` on the triangles around the centre."""
        return float(np.sqrt(max(values[0] for values in self._sampler().values())))
