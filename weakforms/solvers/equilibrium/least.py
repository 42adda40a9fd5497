r"""The condition that the least value of an expression along a meridian is zero: an onset.

Where :math:`T` is least, at :math:`S^*`, its change is :math:`\mathrm dT(S^*) = \partial_U T\,\mathrm dU`,
because :math:`T_{,S}(S^*) = 0` inside, and :math:`S^*` is fixed at an end. In a cell, :math:`T` is
interpolated by the polynomial through its values at the Gauss points :math:`x_j`,

.. math:: T(S^*) = \sum_j L_j(S^*)\, T(x_j) = \int T\,\omega\,\mathrm dx, \qquad
          \omega(x_j) = L_j(S^*)/w_j

with the weights :math:`w_j` of the quadrature. Value and derivatives are therefore those of a form.
"""

from __future__ import annotations

from functools import cached_property

import basix
import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from numpy.polynomial import polynomial
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import System

BESIDE = 2.0
"""How far from the middle of its cell, in half cells, the place may move within one solve."""

SAMPLES = 4
"""Number of samples for each Gauss point where the cell is searched for."""


class LeastValue:
    """The least value of an expression on the mesh of an interval, and the condition that it is zero.

    Args:
        system: The equilibrium equations.
        expression: An expression of its unknown.
        points: Number of Gauss points of a cell.

    Attributes:
        place: Mesh coordinate of the least value.
        at_end: Whether this is the last end of the mesh.
    """

    def __init__(self, system: System, expression: Expr, points: int) -> None:
        self.system, self._comm = system, system.comm
        self._mesh = mesh = system.unknown.function_space.mesh
        degree = 2 * points - 2
        gauss, self._weights = basix.make_quadrature(basix.CellType.interval, degree)
        self._powers = np.arange(points)
        self._to_coefficients = np.linalg.inv((2 * gauss - 1) ** self._powers)
        space = fem.functionspace(mesh, basix.ufl.quadrature_element("interval", (), "default", degree))
        self._omega = fem.Function(space)
        self._dofs = space.dofmap.list[: mesh.topology.index_map(1).size_local]
        self._cells = np.arange(len(self._dofs), dtype=np.int32)
        self._ends = np.sort(mesh.geometry.x[mesh.geometry.dofmap[: len(self._dofs)], 0], axis=1)
        self._last = max(self._comm.allgather(float(self._ends.max(initial=-np.inf))))
        self._sampled = fem.Expression(expression, gauss)
        self._ufl = expression * self._omega * ufl.Measure("dx", mesh, metadata={"quadrature_degree": degree})
        self._owner, self._cell = 0, 0
        self.place, self.at_end = np.nan, False

    @cached_property
    def _form(self) -> fem.Form:
        return fem.form(self._ufl)

    def _polynomials(self) -> np.ndarray:
        """Coefficients of the expression on each cell of this rank, over a coordinate in ``[-1, 1]``."""
        values = self._sampled.eval(self._mesh, self._cells).reshape(len(self._cells), -1)
        return values @ self._to_coefficients.T

    def turn(self) -> None:
        """Find the cell with the least value at the lent state; Newton's method must not meet another one.

        Raises:
            ConvergenceError: If the expression is not a number there.
        """
        t = np.linspace(-1, 1, SAMPLES * len(self._powers))
        values = self._polynomials() @ (t[:, None] ** self._powers).T
        least = np.nan_to_num(values.min(axis=1, initial=np.inf), nan=-np.inf)
        cell = int(np.argmin(least)) if len(least) else -1
        found = self._comm.allgather((float(least[cell]) if len(least) else np.inf, self._comm.rank, cell))
        _, self._owner, self._cell = min(found)
        self._locate()

    def _locate(self) -> None:
        """Place of the least value of the cell's polynomial, and the weights that evaluate it there."""
        self._omega.x.array[:] = 0.0
        place = np.nan
        if self._comm.rank == self._owner:
            coefficients, (low, high) = self._polynomials()[self._cell], self._ends[self._cell]
            if np.isfinite(coefficients).all():
                t = _least_of(coefficients, 1.0 if high == self._last else BESIDE)
                lagrange = (t**self._powers) @ self._to_coefficients
                self._omega.x.array[self._dofs[self._cell]] = lagrange / (self._weights * (high - low))
                place = (low + high) / 2 + t * (high - low) / 2
        self._omega.x.scatter_forward()
        self.place = self._comm.bcast(place, root=self._owner)
        if not np.isfinite(self.place):  # on all ranks
            raise ConvergenceError("the state has stretches at which the law is not defined")
        self.at_end = abs(self.place - self._last) < 1e-12

    def value(self, _solver: ExtendedNewton) -> float:
        """The least value at the lent state, in the cell of :meth:`turn`."""
        self._locate()
        return float(self.system.sum(fem.assemble_scalar(self._form)))

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """Its gradient, at a fixed place."""
        self._locate()
        return self.system.scalar_gradient("least", self._ufl, solver.scalars)


def _least_of(coefficients: np.ndarray, last: float) -> float:
    """Place of the least value of a polynomial, in half cells: a minimum near the cell, or an end.

    Args:
        coefficients: The polynomial.
        last: Largest place; 1 if the cell is the last one of the mesh, which may have its least value there.
    """
    roots = polynomial.polyroots(polynomial.polyder(coefficients))
    inside = roots[np.abs(roots.imag) < 1e-9].real
    inside = inside[(inside > -BESIDE) & (inside < last)]
    curved = polynomial.polyval(inside, polynomial.polyder(coefficients, 2)) > 0
    places = np.append(inside[curved], [1.0] if last == 1.0 or not curved.any() else [])
    return float(places[np.argmin(polynomial.polyval(places, coefficients))])
