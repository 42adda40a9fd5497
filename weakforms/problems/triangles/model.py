r"""Weak form of a relaxed membrane on flat three-node triangles, without any symmetry imposed.

.. math:: \Pi = \int H\, W(C)\,\mathrm dA + \int \Phi(z)\, N_z\,\mathrm dA, \qquad
          \Phi = -p z + \tfrac12 \gamma (z_w - z)_+^2

with the mesh as reference surface. The unknown is the position of the nodes. ``W`` is the relaxed energy of
:mod:`weakforms.forms.relaxed_surface`, ``H`` the thickness at a triangle's centroid. Lengths are divided by
the radius, thicknesses by their mean ``h``, energies by ``C1 h`` (Patil, Nordmark & Eriksson 2016).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from weakforms.forms.relaxed_surface import (
    MIDPOINTS,
    printed_potential,
    state,
)
from weakforms.forms.wrinkling import principal_stretches
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meridian.pre_stretch import unloaded_heights
from weakforms.problems.triangles.meshes import Triangulation
from weakforms.problems.triangles.symmetry import Meridian, subspace_of
from weakforms.problems.triangles.weak_form import Membrane, scalars
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.subspace import Subspace
from weakforms.solvers.equilibrium.system import System

RULES = {
    1: MIDPOINTS,
    2: {"quadrature_degree": 1},
    3: {"quadrature_degree": 2, "quadrature_rule": "default"},
    4: {"quadrature_degree": 6},
}
"""Quadrature of the load on a triangle: edge midpoints, its centroid, three inner points, degree 6."""

SAG = {1: 0.02, 2: 0.05}
"""Displacement of the first guess from the stretched reference surface, by its number of clamped edges."""


@dataclass(frozen=True)
class Body:
    """A triangulated membrane, its supports and its load.

    Attributes:
        triangles: The reference surface.
        M: Thickness over its mean at the lowest node; it is ``2 - M`` at the highest, and linear between.
        delta: Stretch of the heights of the clamped edges, from the lowest node.
        Af: Radius of the clamped edges over that in the reference surface.
        c2: ``C2/C1``.
        material: An incompressible law that replaces the Mooney-Rivlin law.
        gamma: Weight of the liquid.
        rule: Quadrature of the load, see :data:`RULES`.
        potential: ``vertical``: the flux of ``Phi`` through the surface; ``horizontal``: the printed one.
    """

    triangles: Triangulation
    M: float = 1.0
    delta: float = 1.0
    Af: float = 1.0
    c2: float = 0.0
    gamma: float = 0.0
    rule: int = 1
    potential: str = "vertical"
    material: Chosen | None = None

    def start(self) -> np.ndarray:
        """First guess of the nodes' positions; its values at the clamped nodes are the prescribed ones.

        It is the reference surface with the radius and stretch of the supports; bowls are a little deeper.
        """
        x, held = self.triangles.points.copy(), self.triangles.held
        z = x[:, 2]
        low, high = z.min(), z.max()
        s = (z - low) / (high - low)
        if np.ptp(z[held]) > 0.5 * (high - low):  # both ends clamped
            x[:, :2] *= self.Af
            x[:, 2] = low + self.delta * (z - low) * (1 + SAG[2] * (1 - s))
        else:
            rim = z[held].mean()
            x[:, 2] = rim + (1 + SAG[1]) * (z - rim)
        return x

    def starts(self) -> Iterator[np.ndarray]:
        """:meth:`start`; then, for a tube, guesses with the same force in its thin and thick parts."""
        first = self.start()
        yield first
        if not self.triangles.rings:
            return
        s, place = np.unique(self.triangles.points[:, 2], return_inverse=True)
        s = (s - s[0]) / np.ptp(s)
        law = self.material or mooney_rivlin_of(self.c2)
        z = np.ptp(self.triangles.points[:, 2]) * unloaded_heights(law, self.M, self.delta, s)
        for sag in (SAG[2], 0.0):
            x = first.copy()
            x[:, 2] = self.triangles.points[:, 2].min() + (z * (1 + sag * (1 - s)))[place]
            yield x

    def thickness(self, x: np.ndarray) -> np.ndarray:
        """``H`` over its mean at points ``(3, n)``."""
        z = self.triangles.points[:, 2]
        return self.M + 2 * (1 - self.M) * (x[2] - z.min()) / np.ptp(z)


class SurfaceModel:
    """The discrete equations on one mesh and the axisymmetric, or ring-periodic, subspace of it.

    Attributes:
        system: Residual, tangent and functionals; loads ``p`` and ``zw``.
        node: Node of the triangulation of each of this rank's nodes, owned ones first.
    """

    def __init__(self, comm: MPI.Intracomm, body: Body) -> None:
        self.body = body
        self.mesh = body.triangles.mesh(comm)
        element = basix.ufl.element("Lagrange", "triangle", 1, shape=(3,))
        self.space = fem.functionspace(self.mesh, element)
        self.node = self._nodes()
        self.owned = self.space.dofmap.index_map.size_local
        self.position = fem.Function(self.space, name="position")
        self.position.x.array[:] = body.start()[self.node].ravel()
        self.thickness = fem.Function(fem.functionspace(self.mesh, ("DG", 0)))
        self.thickness.interpolate(body.thickness)
        self.system = System(self._formulation())

    def _nodes(self) -> np.ndarray:
        """Node of the triangulation each block of degrees of freedom belongs to."""
        cells = self.mesh.topology.index_map(2)
        count = cells.size_local + cells.num_ghosts
        given = self.mesh.geometry.input_global_indices
        out = np.zeros(len(self.space.tabulate_dof_coordinates()), dtype=np.int64)
        out[self.space.dofmap.list[:count]] = given[self.mesh.geometry.dofmap[:count]]
        return out

    # -- form ----------------------------------------------------------------------------------

    def _formulation(self) -> Formulation:
        body, x = self.body, self.position
        loads = scalars(self.mesh, ("p", "zw"))
        gamma, c2 = (fem.Constant(self.mesh, float(v)) for v in (body.gamma, body.c2))
        law = body.material.surface_law(self.mesh) if body.material else c2
        membrane = Membrane.at(x, self.mesh, law, loads, gamma, self.thickness)
        self.cauchy_green, normal = membrane.cauchy_green, membrane.normal
        given = (loads["p"][1], loads["zw"][1], gamma)
        once = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 0})
        over = ufl.Measure("dx", self.mesh, metadata=RULES[body.rule])
        exact = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 2})
        strain = membrane.strain * once
        if body.potential == "vertical":
            load = membrane.load * over
        else:
            load = printed_potential(x, normal, *given) * over
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        return Formulation(
            unknown=x,
            residual=ufl.derivative(strain + load, x, test),
            loads=loads,
            bcs=[self._held()],
            mass=self.thickness * ufl.inner(trial, test) * exact,
            monitors={
                "V": (x[0] * normal[0] + x[1] * normal[1]) / 2 * exact,
                "Pi": strain + printed_potential(x, normal, *given) * over,
            },
        )

    def _held(self) -> fem.DirichletBC:
        values = fem.Function(self.space)
        values.x.array[:] = self.position.x.array
        held = self.body.triangles.held
        blocks = np.flatnonzero(held[self.node]).astype(np.int32)
        return fem.dirichletbc(values, blocks)

    # -- values by node and triangle ------------------------------------------------------------------------

    def nodal(self, values: np.ndarray) -> np.ndarray:
        """A vector of owned degrees of freedom by node of the triangulation, ``(n, 3)``, on every rank."""
        comm = self.mesh.comm
        out = np.zeros((len(self.body.triangles.points), 3))
        out[self.node[: self.owned]] = values.reshape(-1, 3)
        return comm.allreduce(out, op=MPI.SUM) if comm.size > 1 else out

    def owned_of(self, nodal: np.ndarray) -> np.ndarray:
        """The inverse of :meth:`nodal`: this rank's degrees of freedom from values by node."""
        return nodal[self.node[: self.owned]].ravel()

    def by_triangle(self) -> dict[str, np.ndarray]:
        """Stretches and state of every triangle of the triangulation, on every rank."""
        if not hasattr(self, "_cellwise"):
            l1, l2 = principal_stretches(self.cauchy_green)
            space = fem.functionspace(self.mesh, ("DG", 0, (3,)))
            points = np.array([[1 / 3, 1 / 3]])
            expression = fem.Expression(ufl.as_vector([l1, l2, state(self.cauchy_green)]), points)
            self._cellwise = fem.Function(space), expression
        function, expression = self._cellwise
        function.interpolate(expression)
        comm, count = self.mesh.comm, self.mesh.topology.index_map(2).size_local
        out = np.zeros((len(self.body.triangles.triangles), 3))
        out[self.mesh.topology.original_cell_index[:count]] = function.x.array.reshape(-1, 3)[:count]
        out = comm.allreduce(out, op=MPI.SUM) if comm.size > 1 else out
        return dict(zip(("lam1", "lam2", "state"), out.T, strict=True))

    def symmetric(self) -> Subspace:
        """The equations in the subspace of surfaces of revolution."""
        meridian = Meridian.of(self.body.triangles)
        nodes = self.node[: self.owned]
        basis, lift = subspace_of(meridian, self.body.start(), nodes, self.mesh.comm)
        return Subspace(self.system, basis, lift)
