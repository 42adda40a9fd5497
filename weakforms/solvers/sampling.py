"""Values of expressions at points of the body, the same on every rank."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import ufl
from dolfinx import fem, geometry
from dolfinx.mesh import Mesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.solvers import compat


class Interpolant:
    """Expressions of an unknown as polynomials on each cell, discontinuous between cells.

    Args:
        unknown: The function the expressions depend on; evaluated as it stands at each call.
        expressions: Name and expression of each column.
        raise_degree: How much the polynomials' degree exceeds the unknown's.
    """

    def __init__(self, unknown: fem.Function, expressions: Mapping[str, Expr], raise_degree: int = 1) -> None:
        space = unknown.function_space
        degree = space.ufl_element().degree + raise_degree
        target = compat.scalar_space(space, "Lagrange", degree, len(expressions))
        self.function = fem.Function(target)
        nodes = compat.interpolation_points(target.element)
        self._expression = fem.Expression(ufl.as_vector(list(expressions.values())), nodes)
        self._columns = len(expressions)
        self._owned = target.dofmap.index_map.size_local

    def update(self) -> None:
        """Interpolate the expressions as they stand."""
        self.function.interpolate(self._expression)

    def values(self) -> np.ndarray:
        """Values at the nodes of this rank's cells, shape ``(nodes, expressions)``."""
        self.update()
        return self.function.x.array.reshape(-1, self._columns)[: self._owned]


class Sampler:
    """Evaluates expressions of an unknown at points along a one-dimensional mesh.

    The expressions are interpolated element by element in polynomials of one degree more than the
    unknown's, then evaluated: what that adds is smaller than the discretisation error of a derivative. A
    point between two cells gets the mean of both sides, so that the ranks' order does not matter.

    Args:
        unknown: The function the expressions depend on; evaluated as it stands at each call.
        expressions: Name and expression of each column.
        points: Coordinates, shape ``(n,)``.
    """

    def __init__(self, unknown: fem.Function, expressions: Mapping[str, Expr], points: np.ndarray) -> None:
        self.names = tuple(expressions)
        self._interpolant = Interpolant(unknown, expressions)
        space = unknown.function_space
        self._comm = space.mesh.comm
        self._points = np.zeros((len(points), 3))
        self._points[:, 0] = points
        self._index, self._cells = self._locate(space.mesh)
        count = np.bincount(self._index, minlength=len(points))
        self._count = self._comm.allreduce(count, op=MPI.SUM)
        if np.any(self._count == 0):
            raise ValueError(f"sample point {points[np.argmin(self._count)]} lies outside the mesh")

    def _locate(self, mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
        """Every pair of a point and a cell of this rank that holds it."""
        tree = geometry.bb_tree(mesh, mesh.topology.dim, padding=1e-10)
        candidates = geometry.compute_collisions_points(tree, self._points)
        cells = geometry.compute_colliding_cells(mesh, candidates, self._points)
        owned = mesh.topology.index_map(mesh.topology.dim).size_local
        pairs = [(i, c) for i in range(len(self._points)) for c in cells.links(i) if c < owned]
        index, cell = np.array(pairs, dtype=np.int32).reshape(-1, 2).T
        return index, cell

    def __call__(self) -> dict[str, np.ndarray]:
        """One array a column."""
        self._interpolant.update()
        values = np.zeros((len(self._points), len(self.names)))
        if len(self._index):
            found = self._interpolant.function.eval(self._points[self._index], self._cells)
            np.add.at(values, self._index, found.reshape(len(self._index), -1))
        values = self._comm.allreduce(values, op=MPI.SUM) / self._count[:, None]
        return dict(zip(self.names, values.T, strict=True))
