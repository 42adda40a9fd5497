"""Values of expressions at points of the body, the same on every rank."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import ufl
from dolfinx import fem, geometry
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.solvers import compat


class Sampler:
    """Evaluates expressions of an unknown at points along a one-dimensional mesh.

    The expressions are interpolated element by element in polynomials of one degree more than the
    unknown's, then evaluated: what that adds is smaller than the discretisation error of a derivative.

    Args:
        unknown: The function the expressions depend on; evaluated as it stands at each call.
        expressions: Name and expression of each column.
        points: Coordinates, shape ``(n,)``.
    """

    def __init__(self, unknown: fem.Function, expressions: Mapping[str, Expr], points: np.ndarray) -> None:
        self.names = tuple(expressions)
        space = unknown.function_space
        degree = space.ufl_element().degree + 1
        target = compat.scalar_space(space, "Lagrange", degree, len(self.names))
        self._function = fem.Function(target)
        nodes = compat.interpolation_points(target.element)
        self._expression = fem.Expression(ufl.as_vector(list(expressions.values())), nodes)
        self._comm = space.mesh.comm
        self._points = np.zeros((len(points), 3))
        self._points[:, 0] = points
        self._cells, self._mine = self._locate(space.mesh)

    def _locate(self, mesh: object) -> tuple[np.ndarray, np.ndarray]:
        """A cell for each point on this rank, and which points this rank answers for."""
        tree = geometry.bb_tree(mesh, mesh.topology.dim, padding=1e-10)
        candidates = geometry.compute_collisions_points(tree, self._points)
        cells = geometry.compute_colliding_cells(mesh, candidates, self._points)
        owned = mesh.topology.index_map(mesh.topology.dim).size_local
        first = np.full(len(self._points), -1, dtype=np.int32)
        for i in range(len(self._points)):
            links = cells.links(i)
            here = links[links < owned]
            first[i] = here[0] if len(here) else -1
        rank = np.where(first >= 0, self._comm.rank, self._comm.size)
        answering = self._comm.allreduce(rank, op=MPI.MIN)
        if np.any(answering == self._comm.size):
            raise ValueError("a sample point lies outside the mesh")
        return first, np.flatnonzero(answering == self._comm.rank)

    def __call__(self) -> dict[str, np.ndarray]:
        """One array a column."""
        self._function.interpolate(self._expression)
        values = np.zeros((len(self._points), len(self.names)))
        if len(self._mine):
            found = self._function.eval(self._points[self._mine], self._cells[self._mine])
            values[self._mine] = found.reshape(len(self._mine), -1)
        values = self._comm.allreduce(values, op=MPI.SUM)
        return dict(zip(self.names, values.T, strict=True))
