"""Paper 3: a pre-stretched cylindrical membrane that holds a liquid: axisymmetric states, all variations.

Patil, Nordmark & Eriksson (2015), Proc. R. Soc. A 471, 20150016. Lengths are divided by the radius ``A`` of
the stress-free tube, energies by ``mu H A^2`` (``mu = 2 C1``, or twice the stress ``S`` by which the
constants of another law are divided); ``Z`` in ``[0, L/delta]`` is measured along the stress-free tube from
the lower disk.

The tube is mapped from two fixed intervals: ``x in [0, 1]`` to ``Z in [0, Zf]``, ``x in [1, 2]`` to
``Z in [Zf, L/delta]``. While the tube is partially filled, the free surface meets the membrane at ``Zf``, a
scalar unknown with the equation ``z(Zf) = zw``. The kink of the pressure is then never inside an element, and
the order of the elements is kept. Two more scalars say which of the two parts are wet, so that dry, partially
filled and full tubes are states of one system. The unknown is the displacement from the uniformly stretched
cylinder, ``(r - 1, z - delta Z)``. Next to a ring, where a part of the mesh may be very short, the
displacement is small too, and its derivative keeps all digits.
"""

from __future__ import annotations

from dataclasses import dataclass

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from dolfinx.mesh import Mesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.fluid import (
    Surface,
    axisymmetric,
    harmonic,
    hydrostatic,
    membrane_work,
    pressure_work,
    principal_resultants,
    strain_energy,
)
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meshes import tag_points
from weakforms.solvers.equilibrium.system import Formulation, State, System
from weakforms.solvers.stability.modes import SecondVariation

LOWER, FRONT, UPPER = 1, 2, 3

FULL, PART, DRY = {"low": 1.0, "high": 1.0}, {"low": 1.0, "high": 0.0}, {"low": 0.0, "high": 0.0}
"""Names of the loads that say which parts of the mesh are wet."""


@dataclass(frozen=True)
class TubeData:
    """The tube, its liquid and its mesh (``cells`` on each of the two parts)."""

    L: float
    delta: float
    gamma: float
    alpha: float
    cells: int
    degree: int
    grading: float = 0.6
    material: Chosen | None = None
    """A law that replaces the Mooney-Rivlin law with ``alpha``."""

    @property
    def length(self) -> float:
        """Length of the stress-free tube."""
        return self.L / self.delta


def two_part_mesh(comm: MPI.Intracomm, cells: int, grading: float) -> Mesh:
    """Mesh with ``cells`` on ``[0, 1]`` and as many on ``[1, 2]``, both finer at their ends."""
    mesh = dmesh.create_interval(comm, 2 * cells, [0.0, 2.0])
    x = mesh.geometry.x
    part = np.where(x[:, 0] <= 1.0 + 1e-12, 0.0, 1.0)
    t = x[:, 0] - part
    x[:, 0] = part + t - grading * np.sin(2 * np.pi * t) / (2 * np.pi)
    return mesh


class TubeModel:
    """Weak form on one mesh, and its second variations in Fourier modes.

    Loads: ``zw``, ``front`` (``Zf`` as a fraction of the length), ``delta``, and ``low``, ``high`` (1 if that
        part is wet).
    """

    def __init__(self, comm: MPI.Intracomm, data: TubeData) -> None:
        self.data = data
        self.mesh = two_part_mesh(comm, data.cells, data.grading)
        self.unknown = fem.Function(self._space(2), name="tube")
        values = {"zw": 0.0, "front": 0.5, "delta": data.delta, **DRY}
        self.constants = {name: fem.Constant(self.mesh, float(value)) for name, value in values.items()}
        self.loads = {name: (c, ufl.variable(c)) for name, c in self.constants.items()}
        self._fixed = {
            name: fem.Constant(self.mesh, float(getattr(data, name))) for name in ("L", "gamma", "alpha")
        }
        self.law = data.material.surface_law(self.mesh) if data.material else self._fixed["alpha"]
        self._low = fem.Function(fem.functionspace(self.mesh, ("DG", 0)))
        cells = dmesh.locate_entities(self.mesh, 1, lambda x: x[0] <= 1.0 + 1e-12)
        self._low.x.array[cells] = 1.0
        self.tags = tag_points(self.mesh, {LOWER: 0.0, FRONT: 1.0, UPPER: 2.0})
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 4 * data.degree})
        self.system = System(self._formulation())
        self.wave_number = fem.Constant(self.mesh, 0.0)
        everything = [(1.0, 0.0), (0.0, 1.0)]
        self.axial = self._variation("axial", self.unknown.function_space, (0, 2), everything[:1])
        self.torsion = self._variation("torsion", self._space(1), (1,), everything[1:])
        self.waves = self._variation("waves", self._space(3), (0, 1, 2), everything)

    def _space(self, components: int) -> fem.FunctionSpace:
        element = basix.ufl.element("Lagrange", "interval", self.data.degree, shape=(components,))
        return fem.functionspace(self.mesh, element)

    # -- geometry ------------------------------------------------------------------------------

    def _by_part(self, low: Expr | float, high: Expr | float) -> Expr:
        """Indicator by cell, because at the front the coordinate does not distinguish the sides."""
        return ufl.conditional(ufl.gt(self._low, 0.5), low, high)

    def _jacobian(self) -> Expr:
        """``dZ/dx``."""
        front, delta = self.loads["front"][1], self.loads["delta"][1]
        return self._fixed["L"] / delta * self._by_part(front, 1 - front)

    def locate(self, z: np.ndarray, loads: dict[str, float]) -> np.ndarray:
        """Mesh coordinates of material points ``Z`` for a state's front."""
        length, front = self.data.L / loads["delta"], loads["front"]
        t = np.clip(np.asarray(z) / length, 0.0, 1.0)
        return np.where(t <= front, t / front, 1 + (t - front) / (1 - front))

    def material(self, x: np.ndarray, loads: dict[str, float]) -> np.ndarray:
        """Material points ``Z`` of mesh coordinates: the inverse of :meth:`locate`."""
        length, front = self.data.L / loads["delta"], loads["front"]
        return length * np.where(x <= 1, front * x, front + (1 - front) * (x - 1))

    def state_from(self, r: np.ndarray, z: np.ndarray, loads: dict[str, float]) -> State:
        """A state, for use as a guess, from radius and height at this rank's nodes (:meth:`nodes`)."""
        return State(np.column_stack([r - 1, z - loads["delta"] * self.nodes(loads)]).ravel(), dict(loads))

    def nodes(self, loads: dict[str, float]) -> np.ndarray:
        """Material points of the nodes this rank owns."""
        count = self.system.size // 2
        x = self.unknown.function_space.tabulate_dof_coordinates()[:count, 0]
        return self.material(x, loads)

    # -- forms ---------------------------------------------------------------------------------

    @property
    def radius(self) -> Expr:
        """``r``."""
        return 1 + self.unknown[0]

    @property
    def height(self) -> Expr:
        """``z``."""
        x, front = ufl.SpatialCoordinate(self.mesh)[0], self.loads["front"][1]
        return self.unknown[1] + self._fixed["L"] * self._by_part(front * x, front + (1 - front) * (x - 1))

    def surface(self) -> Surface:
        """The axisymmetric surface in the frame that rotates with ``Theta``."""
        slope = self.unknown.dx(0) / self._jacobian()
        return axisymmetric(self.radius, self.height, (slope[0], self.loads["delta"][1] + slope[1]))

    def _wet(self) -> Expr:
        return self._by_part(self.loads["low"][1], self.loads["high"][1])

    def _work(self, at: Surface, v: Surface) -> Expr:
        """First variation per ``Z`` and ``Theta``."""
        pressure = hydrostatic(at.x[2], self.loads["zw"][1], self._fixed["gamma"], self._wet())
        return membrane_work(at, v, self.law) + pressure_work(at, v, pressure)

    def _formulation(self) -> Formulation:
        space, jacobian, at = self.unknown.function_space, self._jacobian(), self.surface()
        r, z = self.radius, self.height
        test = ufl.TestFunction(space)
        v = axisymmetric(test[0], test[1], (test[0].dx(0) / jacobian, test[1].dx(0) / jacobian))
        zw, gamma, law = self.loads["zw"][1], self._fixed["gamma"], self.law
        lam1, lam2 = ufl.sqrt(ufl.dot(at.a, at.a)), r
        t1, t2 = principal_resultants(lam1, lam2, law)
        volume = ufl.pi * self._wet() * r**2 * at.a[2]
        liquid = hydrostatic(z, zw, gamma, 1.0)
        energy = 2 * ufl.pi * strain_energy(at.a, at.b, law) - liquid * volume
        ends = ufl.Measure("ds", self.mesh, subdomain_data=self.tags)
        inner = ufl.Measure("dS", self.mesh, subdomain_data=self.tags)
        scale = self.data.length / 2
        return Formulation(
            unknown=self.unknown,
            residual=self._work(at, v) * jacobian * self.dx,
            loads=self.loads,
            bcs=self._rings(space),
            mass=ufl.inner(ufl.TrialFunction(space), test) * scale * self.dx,
            monitors={
                "V": volume * jacobian * self.dx,
                "Pi": energy * jacobian * self.dx,
                "T1_ring": t1 * ends(LOWER),
                "T2_ring": t2 * ends(LOWER),
                "Z_front": self.loads["front"][1] * self._fixed["L"] / self.loads["delta"][1] * inner(FRONT),
                "r_front": ufl.avg(r) * inner(FRONT),
                "gap": (ufl.avg(z) - zw) * inner(FRONT),
            },
            internal=("front", "gap"),
            locate=self.locate,
            # H is a first integral of the homogeneous membrane under any pressure.
            profile={
                "r": r,
                "z": z,
                "lam1": lam1,
                "lam2": lam2,
                "T1": t1,
                "T2": t2,
                "H": strain_energy(at.a, at.b, law) - lam1 * lam2 * t1,
            },
        )

    def _rings(self, space: fem.FunctionSpace) -> list[fem.DirichletBC]:
        """No displacement at the disks."""
        ends = np.concatenate([self.tags.find(LOWER), self.tags.find(UPPER)])
        # A function, not a constant, whose shape for one component depends on the dolfinx release.
        return [fem.dirichletbc(fem.Function(space), fem.locate_dofs_topological(space, 0, ends))]

    def _variation(
        self, name: str, space: fem.FunctionSpace, held: tuple[int, ...], angles: list[tuple[float, float]]
    ) -> SecondVariation:
        r"""Second variation in ``u cos(n Theta) e_r + beta sin(n Theta) e_theta + w cos(n Theta) e_z``.

        UFL differentiates the first variation at the displaced state with respect to the displacement. The
        result is quadratic in ``cos`` and ``sin``, and ``cos^2`` and ``sin^2`` have the same mean. Its
        integral over ``Theta`` is therefore the sum of its values at the two angles ``n Theta = 0`` and
        ``pi/2``, times pi (for ``n = 0`` one angle and 2 pi). This factor is left out here and in the mass
        matrix.

        Args:
            name: Name of the operator.
            space: Space with one component for each entry of ``held``.
            held: The components of ``(u, beta, w)`` on which it acts.
            angles: ``(cos, sin)`` of the angles in the sum.
        """
        jacobian = self._jacobian()
        q, test = fem.Function(space, name=name), ufl.TestFunction(space)

        def displacement(function: Expr, c: float, s: float) -> Surface:
            zero = ufl.as_ufl(0)
            parts = {i: function[k] for k, i in enumerate(held)}
            value = ufl.as_vector([parts.get(i, zero) for i in range(3)])
            slope = ufl.as_vector([parts[i].dx(0) / jacobian if i in parts else zero for i in range(3)])
            return harmonic(value, slope, self.wave_number, c, s)

        base = self.surface()
        work = sum(self._work(base + displacement(q, c, s), displacement(test, c, s)) for c, s in angles)
        return SecondVariation(
            Formulation(
                unknown=q,
                residual=work * jacobian * self.dx,
                loads=self.loads,
                bcs=self._rings(space),
                mass=ufl.inner(ufl.TrialFunction(space), test) * jacobian * self.dx,
                monitors={},
            ),
            self.system,
        )
