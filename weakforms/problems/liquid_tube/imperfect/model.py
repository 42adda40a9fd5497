r"""The over-filled tube as a surface: one half wave of it around the axis, with an imperfection.

The tube is that of :mod:`weakforms.problems.liquid_tube.model`. Its thickness is
:math:`h = 1 + \varepsilon\cos n\Theta`, and gravity is tilted by an angle :math:`\tau` about the axis ``y``
(for one wave only, as otherwise the pattern would not repeat). With ``x = X cos(Theta) - Y sin(Theta)``

.. math:: \frac\Pi{\mu H A^2} = 2n \int_0^{L/\delta}\!\!\int_0^{\pi/n} \Big[ h\,w
          - \gamma \Big( \frac{z_w - z\cos\tau}2 - \frac{x\sin\tau}3 \Big) (X N_r + Y N_\theta) \Big]
          \mathrm d\Theta\, \mathrm dZ, \quad N = x_{,\Theta} \times x_{,Z}

The second term is :math:`-\int P\,\mathrm dV` with :math:`P = \gamma\,(z_w - z\cos\tau - x\sin\tau)`: the
fields ``(x, y, 0)/2``, ``z (x, y, 0)/2`` and ``x (x, y, 0)/3`` have the divergences 1, ``z`` and ``x``, have
no flux through the disks, and the mirrors contain the axis. It is true where the liquid wets all of the
membrane: up to :meth:`LiquidSector.top` at least.

The force of a small tilt along a mode ``(u cos Theta, q sin Theta, w cos Theta)`` of an axisymmetric state is

.. math:: B = \gamma\pi \int_0^{L/\delta} r\,(r z' u - r r' w)\,\mathrm dZ

per radian, because :math:`\Pi_{,\tau}` varies by :math:`\gamma\int\!\!\int x\, N\cdot v` and
``N = r (z', 0, -r')``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.fluid import Surface, normal, principal_resultants, strain_energy
from weakforms.problems.liquid_tube.bent.edge_points import EdgePoints
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.meridian.blocks import both_ends
from weakforms.problems.meridian.sector import Sector, SectorMesh
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.support.sampling import Sampler

AMPLITUDE = "u_wave"
"""Column of the amplitude: half the difference of the radii at mid-length on both mirrors."""

IMPERFECTIONS = "tilt", "uneven"
"""Loads that break the symmetry of revolution: degrees, and a part of the thickness."""

LOOKED_AT = 61, 13
"""Points along and around the surface at which its heights are compared with the level."""


@dataclass(frozen=True)
class Liquid:
    """The tube and its liquid."""

    L: float
    delta: float
    gamma: float
    alpha: float

    @property
    def length(self) -> float:
        """Length of the stress-free tube."""
        return self.L / self.delta


class LiquidSector(Sector):
    """Weak form of the surface. Loads: ``zw``, and the imperfections.

    Args:
        comm: Ranks.
        tube: The tube and its liquid.
        n: Number of waves around the axis, at least 1.
        at: The mesh.
    """

    def __init__(self, comm: MPI.Intracomm, tube: Liquid, n: int, at: SectorMesh) -> None:
        graded = both_ends(at.grading)
        super().__init__(comm, tube.length, n, at, graded)
        self.tube = tube
        self.unknown.interpolate(lambda x: self._cylinder(x[0], x[1]))
        self._law = mooney_rivlin_of(tube.alpha).surface_law(self.mesh)
        self._gamma = fem.Constant(self.mesh, tube.gamma)
        constants = {name: fem.Constant(self.mesh, 0.0) for name in ("zw", *IMPERFECTIONS)}
        self.loads = {name: (value, ufl.variable(value)) for name, value in constants.items()}
        nodes = tube.length * graded(np.linspace(0, 1, at.cells + 1))
        self._points = [(0.0, tube.length / 2), (self.width, tube.length / 2)]
        self._edges = EdgePoints(self.mesh, nodes, self._points, at.degree)
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 2 * at.degree + 2})
        self.system = System(self.formulation())
        lines = np.linspace(0, tube.length, LOOKED_AT[0]), np.linspace(0, self.width, LOOKED_AT[1])
        places = np.column_stack([part.ravel() for part in np.meshgrid(*lines)])
        self._heights = Sampler(self.unknown, {"height": sum(self.height(self.surface()))}, places)

    def top(self) -> float:
        """Greatest height along the vertical of the state that the system is lent to, on a grid of points."""
        return float(self._heights()["height"].max())

    def _cylinder(self, s: np.ndarray, _theta: np.ndarray) -> np.ndarray:
        """The uniformly stretched cylinder."""
        return np.vstack([np.ones_like(s), 0 * s, self.tube.delta * s])

    def height(self, at: Surface) -> tuple[Expr, Expr]:
        """The parts ``z cos(tau)`` and ``x sin(tau)`` of the height along the vertical."""
        theta, tilt = ufl.SpatialCoordinate(self.mesh)[1], self.loads["tilt"][1] * ufl.pi / 180
        x = at.x[0] * ufl.cos(theta) - at.x[1] * ufl.sin(theta)
        return at.x[2] * ufl.cos(tilt), x * ufl.sin(tilt)

    def thickness(self) -> Expr:
        """The thickness over its mean."""
        theta = ufl.SpatialCoordinate(self.mesh)[1]
        return 1 + self.loads["uneven"][1] * ufl.cos(self.n * theta)

    def formulation(self) -> Formulation:
        """The weak form with its columns."""
        at, copies = self.surface(), 2 * self.n
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        (up, aside), out = self.height(at), normal(at)
        flux = at.x[0] * out[0] + at.x[1] * out[1]
        head = (self.loads["zw"][1] - up) / 2 - aside / 3
        strain = self.thickness() * strain_energy(at.a, at.b, self._law)
        energy = copies * (strain - self._gamma * head * flux) * self.dx
        (near, far), read = self._points, self._edges.read
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(energy, self.unknown, test),
            loads=self.loads,
            bcs=[self.held(self._rings, self._cylinder), *self.mirrors()],
            mass=copies * ufl.inner(trial, test) * self.dx,
            monitors={
                "V": copies * flux / 2 * self.dx,
                "Pi": energy,
                "r_mid": read(at.x[0], near),
                AMPLITUDE: read(at.x[0] / 2, near) - read(at.x[0] / 2, far),
            },
            profile=self.profile(at),
        )

    def _rings(self, x: np.ndarray) -> np.ndarray:
        return np.isclose(x[0], 0.0) | np.isclose(x[0], self.length)

    def profile(self, at: Surface) -> dict[str, Expr]:
        """Position and, on the mirrors, stretches along meridian and circumference with their resultants."""
        lam1, lam2 = (ufl.sqrt(ufl.dot(v, v)) for v in (at.a, at.b))
        resultants = (self.thickness() * t for t in principal_resultants(lam1, lam2, self._law))
        named = dict(zip(("T1", "T2"), resultants, strict=True))
        return {"r": at.x[0], "z": at.x[2], "lam1": lam1, "lam2": lam2, **named}
