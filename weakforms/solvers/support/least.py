"""Smallest values of expressions anywhere on a mesh of quadrilaterals, also between nodes."""

from __future__ import annotations

from collections.abc import Mapping

import basix.ufl
import numpy as np
from dolfinx import fem
from mpi4py import MPI
from scipy.optimize import minimize
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError
from weakforms.solvers.support.sampling import Interpolant

SEARCHED = 3
"""Cells of each rank that are searched: the smallest value lies in one with the smallest nodal values."""

SAMPLES = 9
"""Number of samples along each side of such a cell, from the least of which the minimum is sought."""

AT_REST = 1e-10
"""Slope at the end of that search; a value there has the square of the position's error."""


class Least:
    """The smallest value of several expressions, by polynomials on each cell with two additional degrees.

    Args:
        unknown: The function on which the expressions depend; each call uses its current values.
        expressions: The expressions.
    """

    def __init__(self, unknown: fem.Function, expressions: Mapping[str, Expr]) -> None:
        self._interpolant = Interpolant(unknown, expressions, raise_degree=2)
        space = self._interpolant.function.function_space
        self._comm = space.mesh.comm
        self._cells = space.dofmap.list[: space.mesh.topology.index_map(2).size_local]
        self._element = basix.ufl.element(
            "Lagrange", "quadrilateral", space.ufl_element().degree, discontinuous=True
        ).basix_element
        side = np.linspace(0.0, 1.0, SAMPLES)
        self._places = np.column_stack([grid.ravel() for grid in np.meshgrid(side, side, indexing="ij")])
        self._samples = self._element.tabulate(0, self._places)[0, :, :, 0]

    def __call__(self) -> float:
        """The smallest value at the current state, the same on every rank.

        Raises:
            ConvergenceError: If one of the values is no number.
        """
        values = self._interpolant.values()[self._cells]
        found = np.inf if np.isfinite(values).all() else -np.inf
        if len(values) and found > 0:
            nodal = values.min(axis=(1, 2))
            found = min(self._within(values[cell]) for cell in np.argsort(nodal)[:SEARCHED])
        least = self._comm.allreduce(float(found), op=MPI.MIN)
        if not np.isfinite(least):
            raise ConvergenceError("the state has stretches at which the law is not defined")
        return least

    def _within(self, values: np.ndarray) -> float:
        """The smallest value in one cell, from nodal values, shape ``(nodes, expressions)``."""
        column = int(np.argmin(values.min(axis=0)))
        nodal = values[:, column]
        samples = self._samples @ nodal

        def polynomial(at: np.ndarray) -> tuple[float, np.ndarray]:
            table = self._element.tabulate(1, at.reshape(1, 2))[:, 0, :, 0] @ nodal
            return float(table[0]), table[1:]

        start = self._places[int(np.argmin(samples))]
        best = minimize(
            polynomial,
            start,
            jac=True,
            method="L-BFGS-B",
            bounds=[(0.0, 1.0)] * 2,
            options={"gtol": AT_REST, "ftol": 0.0},
        )
        return min(float(best.fun), float(samples.min()), float(nodal.min()))
