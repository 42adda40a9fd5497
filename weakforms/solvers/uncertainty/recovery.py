"""Where the error of a solution is: the indicator of Zienkiewicz and Zhu, and the triangles that hold it."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc
from dolfinx.la import InsertMode
from dolfinx.mesh import Mesh
from petsc4py import PETSc
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError

MOST = 0.5
"""Share of the squared error that the marked triangles hold (Doerfler 1996)."""

ALIKE = 1e-6
"""Relative difference of the squares of triangles that are images of each other: all or none is marked."""

SOLVED = 1e-13
"""Relative residual of the projection."""


class Recovery:
    r"""Error of a discontinuous stress, by a continuous one (Zienkiewicz & Zhu 1987).

    .. math:: \eta_T^2 = \int_T |\sigma^* - \sigma|^2\,\mathrm dA, \qquad
              \int (\sigma^* - \sigma)\cdot v\,\mathrm dA = 0 \quad\mathrm{for\ all\ } v

    with the recovered stress and ``v`` in continuous elements of the degree of the unknown. On regular meshes
    of a smooth solution the recovered stress of degree 1 converges faster than the other, and ``eta`` tends
    to the error; of degree 2 it tends to a part of it, two thirds on squares with both diagonals.

    Args:
        mesh: Of triangles.
        stress: A vector, a function of the state.
        degree: Of the unknown.
        dx: Measure on the mesh.

    Attributes:
        local: Root mean square of the error in each triangle.
    """

    def __init__(self, mesh: Mesh, stress: Expr, degree: int, dx: ufl.Measure) -> None:
        size = stress.ufl_shape[0]
        space = fem.functionspace(mesh, ("Lagrange", degree, (size,)))
        one, places = space.sub(0).collapse()
        # dolfinx 0.11 gives the places as the one item of a list.
        self._places = np.ravel(places)[:, None] + np.arange(size)
        u, v = ufl.TrialFunction(one), ufl.TestFunction(one)
        self._mass = petsc.assemble_matrix(fem.form(u * v * dx))
        self._mass.assemble()
        self._load = fem.form(ufl.inner(stress, ufl.TestFunction(space)) * dx)
        self._recovered, self._part, self._right = fem.Function(space), fem.Function(one), fem.Function(one)
        self.local = fem.Function(fem.functionspace(mesh, ("DG", 0)))
        rest, whole = self._recovered - stress, ufl.TestFunction(self.local.function_space)
        self._error = fem.form(ufl.inner(rest, rest) * whole * dx)
        self._areas = fem.assemble_vector(fem.form(whole * dx)).array

    def __call__(self) -> np.ndarray:
        """The squares of this rank's triangles at the present state.

        Raises:
            ConvergenceError: If the projection fails, as where the stress is not finite.
        """
        load = fem.assemble_vector(self._load)
        load.scatter_reverse(InsertMode.add)
        solver = PETSc.KSP().create(self._mass.comm)
        solver.setOperators(self._mass)
        solver.setType("cg")
        solver.getPC().setType("jacobi")
        solver.setTolerances(rtol=SOLVED, atol=0.0)
        for places in self._places.T:
            self._right.x.array[:] = load.array[places]
            solver.solve(self._right.x.petsc_vec, self._part.x.petsc_vec)
            if solver.getConvergedReason() < 0:
                raise ConvergenceError("the stress of this state has no continuous approximation")
            self._part.x.scatter_forward()
            self._recovered.x.array[places] = self._part.x.array
        solver.destroy()
        owned = self.local.function_space.dofmap.index_map.size_local
        squares = fem.assemble_vector(self._error).array
        self.local.x.array[:owned] = np.sqrt(squares[:owned] / self._areas[:owned])
        self.local.x.scatter_forward()
        return squares[self.local.function_space.dofmap.list[:owned, 0]]


def marked(squares: np.ndarray) -> np.ndarray:
    """The fewest triangles that hold :data:`MOST` of the squared error, with all that are like the last one.

    Args:
        squares: Of all triangles, the same on every rank up to round-off.

    Returns:
        Whether a triangle is one of them; none without an error.
    """
    held = np.cumsum(np.sort(squares)[::-1])
    if held[-1] == 0:
        return np.zeros(len(squares), bool)
    last = np.sort(squares)[::-1][np.searchsorted(held, (1 - ALIKE) * MOST * held[-1])]
    return squares >= (1 - ALIKE) * last
