"""Paper 3: a pre-stretched cylindrical membrane that holds a liquid: axisymmetric states, all variations.

Patil, Nordmark & Eriksson (2015), Proc. R. Soc. A 471, 20150016. Lengths are divided by the radius ``A`` of
the stress-free tube, energies by ``mu H A^2`` (``mu = 2 C1``, or twice the stress ``S`` by which the
constants of another law are divided); ``Z`` in ``[0, L/delta]`` is measured along the stress-free tube from
the lower disk.

The tube has two blocks, below and above ``Zf``. While it is partially filled, the free surface meets the
membrane at ``Zf``, a scalar unknown with the equation ``z(Zf) = zw``. Two more scalars say which of the two
blocks are wet, so that dry, partially filled and full tubes are states of one system. The unknown is the
displacement from the uniformly stretched cylinder, ``(r - 1, z - delta Z)``. Next to a ring, where a block
may be very short, the displacement is small too, and its derivative keeps all digits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import ufl
from dolfinx import fem
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
from weakforms.forms.materials import surface_law
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import BREAK, LOWER, UPPER, Blocks, both_ends
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.compression import PrincipalResultants
from weakforms.problems.meridian.model import MeridianModel
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation

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


CYLINDER = Body(
    name="liquid_tube",
    parameters=(),
    length=lambda _q: 1.0,
    radius=lambda _s, _q: 1.0,
    thickness=lambda _s, _q: 1.0,
)
"""``S`` is ``Z`` as a fraction of the length."""


class TubeModel(MeridianModel):
    """Weak form on one mesh, and its second variations in Fourier modes.

    The first variation is that of a surface in space (:mod:`weakforms.forms.fluid`), from which variations
    that are not axisymmetric follow too.

    Loads: ``zw``, ``front`` (``Zf`` as a fraction of the length), ``L``, ``delta``, ``gamma``, constants of
        the law, and ``low``, ``high`` (1 if that block is wet).
    """

    name = "tube"

    def __init__(self, comm: MPI.Intracomm, data: TubeData) -> None:
        self.data = data
        ends_finer = [both_ends(data.grading)] * 2
        mesh = Blocks([0.0, 0.5, 1.0], data.cells, data.degree, 4 * data.degree, {"front": 1}, ends_finer)
        of_tube = {"L": data.L, "delta": data.delta, "gamma": data.gamma}
        law = data.material
        constants = {"alpha": data.alpha} if law is None else dict(law.constants)
        super().__init__(comm, CYLINDER, {"zw": 0.0, **of_tube, **DRY, **constants}, mesh)
        of_law = {name: self.q[name] for name in constants}
        self.surface_law = of_law["alpha"] if law is None else surface_law(law.model, of_law)
        self.wave_number = fem.Constant(self.mesh, 0.0)
        everything = [(1.0, 0.0), (0.0, 1.0)]
        self.axial = self._variation("axial", self.space, (0, 2), everything[:1])
        self.torsion = self._variation("torsion", self.components(1), (1,), everything[1:])
        self.waves = self._variation("waves", self.components(3), (0, 1, 2), everything)

    # -- geometry ------------------------------------------------------------------------------

    def _jacobian(self) -> Expr:
        """``dZ/dx``."""
        return self.q["L"] / self.q["delta"] * self.place()[1]

    def position(self, s: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Mesh coordinates of material points ``Z`` for a state's front."""
        return super().position(np.asarray(s) * loads["delta"] / loads["L"], loads)

    def material(self, x: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Material points ``Z`` of mesh coordinates: the inverse of :meth:`position`."""
        return loads["L"] / loads["delta"] * super().material(x, loads)

    def points(self, loads: Mapping[str, float]) -> np.ndarray:
        """Material points of the nodes this rank owns."""
        return self.material(self.nodes(), loads)

    def state_from(self, r: np.ndarray, z: np.ndarray, loads: dict[str, float]) -> State:
        """A state, for use as a guess, from radius and height at this rank's nodes (:meth:`points`)."""
        return State(np.column_stack([r - 1, z - loads["delta"] * self.points(loads)]).ravel(), dict(loads))

    # -- forms ---------------------------------------------------------------------------------

    @property
    def radius(self) -> Expr:
        """``r``."""
        return 1 + self.unknown[0]

    @property
    def height(self) -> Expr:
        """``z``."""
        return self.unknown[1] + self.q["L"] * self.place()[0]

    def stretches(self) -> tuple[Expr, Expr]:
        """``lam1, lam2``."""
        a = self.surface().a
        return ufl.sqrt(ufl.dot(a, a)), self.radius

    def surface(self) -> Surface:
        """The axisymmetric surface in the frame that rotates with ``Theta``."""
        slope = self.unknown.dx(0) / self._jacobian()
        return axisymmetric(self.radius, self.height, (slope[0], self.q["delta"] + slope[1]))

    def _wet(self) -> Expr:
        return self.in_patch(self.q["low"], self.q["high"])

    def _work(self, at: Surface, v: Surface) -> Expr:
        """First variation per ``Z`` and ``Theta``."""
        pressure = hydrostatic(at.x[2], self.q["zw"], self.q["gamma"], self._wet())
        return membrane_work(at, v, self.surface_law) + pressure_work(at, v, pressure)

    def formulation(self) -> Formulation:
        """The weak form, with columns and fields."""
        space, jacobian, at = self.space, self._jacobian(), self.surface()
        r, z = self.radius, self.height
        test = ufl.TestFunction(space)
        v = axisymmetric(test[0], test[1], (test[0].dx(0) / jacobian, test[1].dx(0) / jacobian))
        zw, gamma, law = self.q["zw"], self.q["gamma"], self.surface_law
        t1, t2 = self.fields["T1"], self.fields["T2"]
        volume = ufl.pi * self._wet() * r**2 * at.a[2]
        liquid = hydrostatic(z, zw, gamma, 1.0)
        energy = 2 * ufl.pi * strain_energy(at.a, at.b, law) - liquid * volume
        ends, inner = self.ends, self.inner
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
                "Z_front": ufl.avg(self.front) * self.q["L"] / self.q["delta"] * inner(BREAK),
                "r_front": ufl.avg(r) * inner(BREAK),
                "gap": (ufl.avg(z) - zw) * inner(BREAK),
            },
            internal=("front", "gap"),
            locate=self.position,
            aim=self.aim,
            profile=self.fields,
            tension=PrincipalResultants(self, t1, t2),
        )

    @cached_property
    def fields(self) -> dict[str, Expr]:
        """What is sampled along the tube; ``H`` is a first integral of the membrane under any pressure."""
        (lam1, lam2), at, law = self.stretches(), self.surface(), self.surface_law
        t1, t2 = principal_resultants(lam1, lam2, law)
        first = strain_energy(at.a, at.b, law) - lam1 * lam2 * t1
        placed = {"r": self.radius, "z": self.height}
        return {**placed, "lam1": lam1, "lam2": lam2, "T1": t1, "T2": t2, "H": first}

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
                aim=self.aim,
            ),
            self.system,
        )
