r"""The free tube as a surface whose pattern repeats around the axis: one half wave of one half of its length.

The position has the components ``(X, Y, Z)`` in the frame :math:`(e_r, e_\theta, e_z)` of the material angle
``Theta``, over ``[0, lf/2] x [0, pi/n]``. Both meridians and the mid-plane are mirrors: ``Y = 0`` on
``Theta = 0`` and ``pi/n``, the height is zero at mid-length, and the disk holds the last ring. Energy and
volume are those of the half tube over :math:`2\pi`, as of :mod:`weakforms.problems.tube.model`:

.. math:: \frac\Pi{2\pi} = \frac n\pi \int_0^{l_f/2}\!\!\int_0^{\pi/n} \Big[ \frac{w(C)}{\sqrt{\delta_1}}
          - \frac p2\, (X N_r + Y N_\theta) \Big] \mathrm d\Theta\, \mathrm dZ, \quad
          N = x_{,\Theta} \times x_{,Z}

The gas acts on the actual surface. The integral of :math:`(X N_r + Y N_\theta)/2` is its volume, because the
mirrors contain the axis or are normal to it. An axisymmetric state is the same in both models.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms import revolution
from weakforms.forms.fluid import Surface
from weakforms.forms.materials import stress_resultants
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import one_end
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

AMPLITUDE = "u_wave"
"""Column of the amplitude, ``c.x``: the part of ``cos(n Theta)`` in the mid-plane's radial displacement."""

MIDDLE = 1
"""Tag of the edge at mid-length."""

Shape = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Components ``(X, Y, Z)``, or a displacement, of shape ``(3, k)``, at ``Z`` and ``Theta``."""


@dataclass(frozen=True)
class BentMesh:
    """Cells along half the tube, and around one half wave; polynomial degree, grading towards the disk."""

    cells: int
    around: int
    degree: int
    grading: float


class BentTube:
    """Weak form of the surface; load ``p``.

    Args:
        comm: Ranks.
        material: The law.
        delta1: Axial pre-stretch.
        half: Half the length.
        n: Number of waves around the axis, at least 1.
        at: The mesh.
    """

    def __init__(
        self, comm: MPI.Intracomm, material: Chosen, delta1: float, half: float, n: int, at: BentMesh
    ) -> None:
        self.half, self.n, self.delta1 = half, n, delta1
        corners = [np.zeros(2), np.array([1.0, np.pi / n])]
        self.mesh = dmesh.create_rectangle(comm, corners, [at.cells, at.around], dmesh.CellType.quadrilateral)
        nodes = self.mesh.geometry.x
        nodes[:, 0] = half * one_end(at.grading)(nodes[:, 0])
        element = basix.ufl.element("Lagrange", "quadrilateral", at.degree, shape=(3,))
        self.space = fem.functionspace(self.mesh, element)
        self.unknown = fem.Function(self.space, name="bent_tube")
        self.unknown.interpolate(lambda x: np.vstack([np.ones_like(x[0]), 0 * x[0], x[0]]))
        self._law = material.surface_law(self.mesh)
        pressure = fem.Constant(self.mesh, 0.0)
        self.loads = {"p": (pressure, ufl.variable(pressure))}
        facets = dmesh.locate_entities_boundary(self.mesh, 1, lambda x: np.isclose(x[0], 0.0))
        tags = dmesh.meshtags(self.mesh, 1, np.sort(facets), np.full(len(facets), MIDDLE, dtype=np.int32))
        rule = {"quadrature_degree": 2 * at.degree + 2}
        self.dx = ufl.Measure("dx", self.mesh, metadata=rule)
        self.middle = ufl.Measure("ds", self.mesh, subdomain_data=tags, metadata=rule)(MIDDLE)
        self.system = System(self.formulation())

    def surface(self) -> Surface:
        """The position with its derivatives; the frame turns with ``Theta``."""
        x = self.unknown
        a, b = x.dx(0), x.dx(1)
        return Surface(ufl.as_vector(list(x)), a, ufl.as_vector([b[0] - x[1], b[1] + x[0], b[2]]))

    def metric(self, at: Surface) -> Expr:
        """Right Cauchy-Green tensor of the stress-free tube."""
        return revolution.gradient_tensor(at, 1.0, (self.delta1, self.delta1**-0.5))

    def potential(self, at: Surface) -> Expr:
        """The potential per ``dTheta dZ``."""
        c = self.metric(at)
        strain = self._law.invariants(ufl.tr(c), ufl.det(c)) / self.delta1**0.5
        return strain + revolution.gas_energy(at, self.loads["p"][1])

    def formulation(self) -> Formulation:
        """The weak form with its columns; ``u_max`` is the mean around the axis."""
        at, share = self.surface(), self.n / np.pi
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        energy = share * self.potential(at) * self.dx
        wave = ufl.cos(self.n * ufl.SpatialCoordinate(self.mesh)[1])
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(energy, self.unknown, test),
            loads=self.loads,
            bcs=self.conditions(),
            mass=share * ufl.inner(trial, test) * self.dx,
            monitors={
                "u_max": share * (at.x[0] - 1) * self.middle,
                "V": share * revolution.gas_energy(at, -1.0) * self.dx,
                "Pi": energy,
                AMPLITUDE: 2 * share * at.x[0] * wave * self.middle,
            },
            profile=self.profile(at),
        )

    def profile(self, at: Surface) -> dict[str, Expr]:
        """Position and, on the mirrors, stretches along meridian and circumference with their resultants."""
        c = self.metric(at)
        lam1, lam2 = ufl.sqrt(c[0, 0]), ufl.sqrt(c[1, 1])
        t1, t2 = stress_resultants(self._law.stretches, lam1, lam2)
        return {"rho": at.x[0], "eta": at.x[2], "lam1": lam1, "lam2": lam2, "t1": t1, "t2": t2}

    def conditions(self) -> list[fem.DirichletBC]:
        """The ring at the disk, the height at mid-length, and the direction around on both meridians."""
        width = np.pi / self.n
        ring = dmesh.locate_entities_boundary(self.mesh, 1, lambda x: np.isclose(x[0], self.half))
        held = fem.Function(self.space)
        held.interpolate(lambda x: np.vstack([np.ones_like(x[0]), 0 * x[0], np.full_like(x[0], self.half)]))
        out = [fem.dirichletbc(held, fem.locate_dofs_topological(self.space, 1, ring))]
        mirrors = (
            (2, lambda x: np.isclose(x[0], 0.0)),
            (1, lambda x: np.isclose(x[1], 0.0) | np.isclose(x[1], width)),
        )
        for component, where in mirrors:
            facets, part = dmesh.locate_entities_boundary(self.mesh, 1, where), self.space.sub(component)
            dofs = fem.locate_dofs_topological(part, 1, facets)
            out.append(fem.dirichletbc(np.array(0.0), dofs, part))
        return out

    def interpolated(self, shape: Shape) -> np.ndarray:
        """Owned degrees of freedom of a position or a displacement."""
        function = fem.Function(self.space)
        function.interpolate(lambda x: shape(x[0], x[1]))
        return function.x.array[: self.system.size].copy()

    def state_of(self, shape: Shape, p: float) -> State:
        """The state with a position and a pressure."""
        return State(self.interpolated(shape), {"p": p})
