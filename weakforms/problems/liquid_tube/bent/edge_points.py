"""Values at points of an edge of a rectangular sheet, as forms."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from ufl.core.expr import Expr


class EdgePoints:
    r"""Points on the edges ``x[1] = side`` of a sheet, at its nodes, whose values are computed as integrals.

    On each side of a point the weight :math:`\sum_j (2j+1) P_j(1 - 2t)/h`, with the distance ``t`` over the
    cell's size ``h`` and the Legendre polynomials ``P_j``, gives the value at ``t = 0`` of every polynomial
    of the given degree; both sides are averaged. For other functions the error equals the error of their L2
    projection. Every rank gets the value, and a form gives its derivatives.

    Args:
        mesh: A sheet of quadrilaterals along the axes.
        nodes: Its nodes in ``x[0]``.
        points: ``(side, height)`` of each point; a height is taken at the nearest node, not an end.
        degree: Degree of the polynomials whose values are exact.
    """

    def __init__(
        self, mesh: dmesh.Mesh, nodes: np.ndarray, points: Iterable[tuple[float, float]], degree: int
    ) -> None:
        self.mesh, self.nodes, self.degree = mesh, nodes, degree
        self._first: dict[tuple[float, float], int] = {}
        facets, tags = [], []
        for number, point in enumerate(points):
            self._first[point] = 2 * number
            for above in (0, 1):
                found = self._piece(*point, above)
                facets.append(found)
                tags.append(np.full(len(found), 2 * number + above, dtype=np.int32))
        entities, values = np.concatenate(facets), np.concatenate(tags)
        order = np.argsort(entities)
        tagged = dmesh.meshtags(mesh, 1, entities[order], values[order])
        rule = {"quadrature_degree": 4 * degree}
        self._edges = ufl.Measure("ds", mesh, subdomain_data=tagged, metadata=rule)

    def _node(self, height: float) -> int:
        return int(np.argmin(np.abs(self.nodes - height)))

    def _piece(self, side: float, height: float, above: int) -> np.ndarray:
        """The facet of an edge just below, or above, a point."""
        k = self._node(height) - 1 + above
        low, high = self.nodes[k] - 1e-9, self.nodes[k + 1] + 1e-9

        def on(x: np.ndarray) -> np.ndarray:
            return np.isclose(x[1], side) & (x[0] > low) & (x[0] < high)

        return dmesh.locate_entities_boundary(self.mesh, 1, on)

    def read(self, value: Expr, point: tuple[float, float]) -> ufl.Form:
        """The value of a function at one of the points."""
        k, form = self._node(point[1]), 0
        for above in (0, 1):
            size = fem.Constant(self.mesh, self.nodes[k + above] - self.nodes[k - 1 + above])
            t = abs(ufl.SpatialCoordinate(self.mesh)[0] - fem.Constant(self.mesh, self.nodes[k])) / size
            form += value * end_weight(t, self.degree) / size / 2 * self._edges(self._first[point] + above)
        return form


def end_weight(t: Expr | float, degree: int) -> Expr | float:
    """``sum_j (2j + 1) P_j(1 - 2t)`` up to a degree, on [0, 1]."""
    s = 1 - 2 * t
    before, here, total = 1.0, s, 1 + 3 * s
    for j in range(1, degree):
        before, here = here, ((2 * j + 1) * s * here - j * before) / (j + 1)
        total += (2 * j + 3) * here
    return total
