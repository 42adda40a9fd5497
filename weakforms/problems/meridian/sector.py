r"""A membrane of revolution as a surface whose pattern repeats around the axis: one half wave of it.

The position has the components ``(X, Y, Z)`` in the frame :math:`(e_r, e_\theta, e_z)` of the material angle
``Theta``, over ``[0, length] x [0, pi/n]``. Both meridians are mirrors: ``Y = 0`` on ``Theta = 0`` and
``pi/n``. An axisymmetric state is the same as on the meridian alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.fluid import Surface
from weakforms.solvers.equilibrium.state import State

Shape = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Components ``(X, Y, Z)``, or a displacement, of shape ``(3, k)``, at ``Z`` and ``Theta``."""

Place = Callable[[np.ndarray], np.ndarray]
"""Whether points of the mesh, of shape ``(3, k)``, are at some place."""


@dataclass(frozen=True)
class SectorMesh:
    """Cells along the membrane, and around one half wave; polynomial degree, grading."""

    cells: int
    around: int
    degree: int
    grading: float


class Sector:
    """Mesh, space and unknown of the surface.

    Args:
        comm: Ranks.
        length: Length of the stress-free membrane.
        n: Number of waves around the axis, at least 1.
        at: The mesh.
        graded: Places of the nodes along the length by equidistant ones, both from 0 to 1.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        length: float,
        n: int,
        at: SectorMesh,
        graded: Callable[[np.ndarray], np.ndarray],
    ) -> None:
        self.length, self.n, self.width = length, n, np.pi / n
        corners = [np.zeros(2), np.array([1.0, self.width])]
        self.mesh = dmesh.create_rectangle(comm, corners, [at.cells, at.around], dmesh.CellType.quadrilateral)
        places = self.mesh.geometry.x
        places[:, 0] = length * graded(places[:, 0])
        element = basix.ufl.element("Lagrange", "quadrilateral", at.degree, shape=(3,))
        self.space = fem.functionspace(self.mesh, element)
        self.unknown = fem.Function(self.space, name="sector")

    def surface(self, x: Expr | None = None) -> Surface:
        """A position (default: the unknown one) with its derivatives; the frame turns with ``Theta``."""
        x = self.unknown if x is None else x
        a, b = x.dx(0), x.dx(1)
        return Surface(ufl.as_vector([*x]), a, ufl.as_vector([b[0] - x[1], b[1] + x[0], b[2]]))

    def held(self, ring: Place, position: Shape) -> fem.DirichletBC:
        """The condition that holds a ring at a position."""
        value = fem.Function(self.space)
        value.interpolate(lambda x: position(x[0], x[1]))
        facets = dmesh.locate_entities_boundary(self.mesh, 1, ring)
        return fem.dirichletbc(value, fem.locate_dofs_topological(self.space, 1, facets))

    def mirrors(self) -> list[fem.DirichletBC]:
        """The conditions of both meridians."""
        return self.vanishing([(1, lambda x: np.isclose(x[1], 0.0) | np.isclose(x[1], self.width))])

    def vanishing(self, components: Iterable[tuple[int, Place]]) -> list[fem.DirichletBC]:
        """Conditions on components that are zero, and where."""
        out = []
        for component, where in components:
            facets, part = dmesh.locate_entities_boundary(self.mesh, 1, where), self.space.sub(component)
            dofs = fem.locate_dofs_topological(part, 1, facets)
            out.append(fem.dirichletbc(np.array(0.0), dofs, part))
        return out

    def interpolated(self, shape: Shape) -> np.ndarray:
        """Owned degrees of freedom of a position or a displacement."""
        function, own = fem.Function(self.space), self.space.dofmap
        function.interpolate(lambda x: shape(x[0], x[1]))
        return function.x.array[: own.index_map.size_local * own.index_map_bs].copy()

    def state_of(self, shape: Shape, loads: Mapping[str, float]) -> State:
        """The state with a position and loads."""
        return State(self.interpolated(shape), dict(loads))
