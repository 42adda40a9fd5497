r"""Paper 3: the fluid-loaded tube as a surface in space, in Cartesian components.

Patil, Nordmark & Eriksson (2015), Proc. R. Soc. A 471, 20150016; scaling as in
:mod:`weakforms.problems.liquid_tube.model`. The unknown is the position ``(x, y, z)`` over the material
rectangle ``(Z, Theta)``, on half the circumference with ``y = 0`` on ``Theta = 0`` and ``pi`` (states of C1v
symmetry), or on a mesh that closes on itself (no symmetry imposed).

The potential of the liquid is written with the vertical flux. Because ``P`` depends on ``z`` alone, up to a
function of ``zw``

.. math:: -\int P\,\mathrm dV = \int\!\!\int \tfrac\gamma2 (z_w - z)_+^2 N_z\,\mathrm d\Theta\,\mathrm dZ,
          \qquad N = b \times a

It is twice differentiable in the position. Its first variation contains the pressure; its second one has a
bounded step at the free surface and no line term. UFL's derivatives are therefore correct, and the tangent is
symmetric for every quadrature. The printed ``-P(z) (x e_x + y e_y).N/2`` has the same value, but UFL drops a
line term of its second variation. By the same flux the volume of the liquid is

.. math:: V = -\frac1\gamma \frac{\partial\Pi}{\partial z_w}
            = \pi \min(z_w, L) - \int\!\!\int (z_w - z)_+ N_z \,\mathrm d\Theta\,\mathrm dZ

UFL computes its derivative in the position completely; its derivative in ``zw`` is the free surface's area
``A_s``.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.fluid import (
    Surface,
    principal_stretches,
    relaxed_strain_energy,
    strain_energy,
    submerged_flux,
)
from weakforms.forms.wrinkling import wrinkling_function
from weakforms.problems.homogeneous.material_point import first_derivatives
from weakforms.problems.liquid_tube.bent.edge_points import EdgePoints
from weakforms.problems.liquid_tube.bent.edge_tangents import EdgeTangents
from weakforms.problems.liquid_tube.bent.front import HalfSystem
from weakforms.problems.liquid_tube.bent.surface import MaterialSurface, Shape, SurfaceData
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.meridian.kinks import FRACTION, INDICATED
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

READ = {"mid": 1 / 2, "quarter": 1 / 4}
"""Positions ``Z`` of the points in columns, over the length of the stress-free tube."""

RULES = 3, 5, 16
"""Quadrature degrees over the degree of the elements: membrane, liquid, and its volume, which is assembled
once for each state."""

FITTED_RULE = 2
"""Quadrature degree minus twice the degree of the elements, if no element contains the load's kink."""

SIDES = {"0": 0.0, "pi": np.pi}
"""Meridians of these points."""


class SurfaceModel(MaterialSurface):
    """Weak form of the surface on one mesh. Load: ``zw``; on the whole circumference also ``phase``.

    On the whole circumference a bent state can be rotated about the axis. A condition prescribes the
    rotation, and ``phase`` times ``partner`` is a force that makes the system regular. The force is zero at
    every solution.

    Attributes:
        system: Residual, tangent and columns in the space of the states (C1v on the half circumference).
    """

    def __init__(self, comm: MPI.Intracomm, data: SurfaceData) -> None:
        super().__init__(comm, data)
        self.unknown = fem.Function(self.space, name="surface")
        self.level = fem.Constant(self.mesh, 0.0)
        self.zw = ufl.variable(self.level)
        self.partner, self._phase = fem.Function(self.space), fem.Constant(self.mesh, 0.0)
        self._fixed = {
            name: fem.Constant(self.mesh, float(getattr(data, name))) for name in ("L", "gamma", "alpha")
        }
        law = data.material or (mooney_rivlin_of(data.alpha) if data.relaxed else None)
        self._law = law.surface_law(self.mesh) if law else self._fixed["alpha"]
        self.copies = 1 if data.full else 2
        self.unknown.interpolate(self._over(_cylinder(data.delta)))
        self._rings = fem.Function(self.space)
        self._rings.interpolate(self._over(_cylinder(data.delta)))
        self._points = None if data.full else self._edge_points(self.nodes)
        self._tangents = None
        if not data.full:
            at = {side: self._point("quarter", side) for side in SIDES}
            self._tangents = EdgeTangents(self.space, self.nodes, data.around, at, self.front)
        # The load's kink at the free surface lies inside cells, and its quadrature limits the accuracy.
        self.dx, self._wet, self._wet_once = (
            ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": rule}) for rule in self._rules()
        )
        conditions = self._ring_conditions()
        mirrored = [] if data.full else self._mirror_conditions((1,))
        self.formulation = self._formulation(conditions + mirrored)
        self.system = self._assembled(self.formulation)

    @cached_property
    def breaking(self) -> System:
        """On half the circumference, the second variation for displacements that break the mirror symmetry.

        ``u`` is odd, ``v`` even, ``w`` odd about ``Theta = 0`` and ``pi``. It is made when it is needed.
        """
        odd = self._ring_conditions() + self._mirror_conditions((0, 2))
        return self._assembled(self._second_variation_only(odd), beside=self.system)

    def _rules(self) -> list[int]:
        if self.front is not None:
            return [2 * self.data.degree + FITTED_RULE] * len(RULES)
        return [times * self.data.degree for times in RULES]

    def _assembled(self, formulation: Formulation, beside: System | None = None) -> System:
        if self.data.full:
            return System(formulation)
        return HalfSystem(formulation, self.front, self._resultants_read, beside)

    # -- states ----------------------------------------------------------------------------------

    def state_of(self, position: Shape, loads: Mapping[str, float]) -> State:
        """The state with a position and some loads; those not given are the initial ones."""
        whole = self.system.initial.loads | dict(loads)
        return State(self.interpolated(position, whole), whole)

    def interpolated(self, shape: Shape, loads: Mapping[str, float] | None = None) -> np.ndarray:
        """Owned degrees of freedom of a position or displacement, on the mesh that follows the loads' front.

        Args:
            shape: The position or displacement.
            loads: Loads of a state; by default the initial ones, whose front is nowhere.
        """
        function, nowhere = fem.Function(self.space), np.full(self.system.size, np.nan)
        with self.system.at(State(nowhere, dict(loads or self.system.initial.loads))):
            function.interpolate(self._over(shape))
        return function.x.array[: self.system.size].copy()

    # -- forms -----------------------------------------------------------------------------------

    def energy(self, position: Expr) -> ufl.Form:
        """The part of ``Pi`` that depends on the position; doubled on half the circumference."""
        at, fixed = self.surface(position), self._fixed
        strain = relaxed_strain_energy if self.data.relaxed else strain_energy
        membrane = strain(at.a, at.b, self._law) * self._stretch * self.dx
        liquid = fixed["gamma"] * submerged_flux(at, self.zw, 2) * self._stretch * self._wet
        return self.copies * membrane + self.copies * liquid

    def _formulation(self, conditions: list[fem.DirichletBC]) -> Formulation:
        at, gamma = self.surface(self.unknown), self._fixed["gamma"]
        energy = self.energy(self.unknown)
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        full_head = ufl.max_value(self.zw - self._fixed["L"], 0.0)
        area = fem.Constant(self.mesh, self.data.length * 2 * np.pi / self.copies)
        # The fluxes of the disks are distributed over the surface, so that they are the integral of a form.
        base = ufl.pi * (self.zw - full_head) / area
        potential = -gamma * ufl.pi / 2 * (self.zw**2 - full_head**2) / area
        loads = {"zw": (self.level, self.zw)}
        residual = ufl.derivative(energy, self.unknown, test)
        if self.data.full:
            loads["phase"] = (self._phase, ufl.variable(self._phase))
            residual += loads["phase"][1] * ufl.inner(self.partner, test) * self.dx
        return Formulation(
            unknown=self.unknown,
            residual=residual,
            loads=loads,
            bcs=conditions,
            mass=self.product(trial, test),
            monitors={
                "V": (base - self.copies * submerged_flux(at, self.zw, 1)) * self._stretch * self._wet_once,
                "Pi": energy + potential * self._stretch * self.dx,
                **({FRACTION: self._wrinkled_part(at)} if self.data.relaxed else {}),
                **({} if self.data.full else self._read_points(at)),
            },
            profile={
                f"{prefix}{name}": part[i]
                for prefix, part in (("", at.x), ("a_", at.a), ("b_", at.b))
                for i, name in enumerate("xyz")
            },
        )

    def _wrinkled_part(self, at: Surface) -> ufl.Form:
        """Part of the stress-free surface that is wrinkled."""
        wrinkled = ufl.lt(wrinkling_function(*principal_stretches(at)), 1)
        share = fem.Constant(self.mesh, self.copies / (2 * np.pi * self.data.length))
        rule = {"quadrature_degree": INDICATED * self.data.degree}
        return ufl.conditional(wrinkled, share, 0.0) * self._stretch * self.dx(metadata=rule)

    def readings(self, sampled: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Columns of a profile from the sampled position and tangent vectors.

        Stretches, ``lam1 >= lam2``, are computed at each point and not interpolated: where both are equal,
        they are not smooth functions of the position.
        """
        a, b = (np.array([sampled[f"{part}_{name}"] for name in "xyz"]) for part in "ab")
        g11, g22, g12 = (np.sum(u * v, axis=0) for u, v in ((a, a), (b, b), (a, b)))
        root = np.sqrt((g11 - g22) ** 2 + 4 * g12**2)
        lam1, lam2 = (np.sqrt((g11 + g22 + sign * root) / 2) for sign in (1, -1))
        out = {name: sampled[name] for name in "xyz"} | {"lam1": lam1, "lam2": lam2}
        return out | self._resultants(lam1, lam2)

    def _second_variation_only(self, conditions: list[fem.DirichletBC]) -> Formulation:
        """The same second variation on another space of displacements."""
        whole = self.formulation
        return Formulation(self.unknown, whole.residual, whole.loads, conditions, whole.mass, monitors={})

    def turn(self) -> Expr:
        """``e_z x x - x_,Theta``: the displacement that rotates a state's pattern about the axis."""
        at = self.surface(self.unknown)
        return ufl.as_vector([-at.x[1], at.x[0], 0]) - at.b

    def product(self, u: Expr, v: Expr) -> ufl.Form:
        """Inner product of two displacements on the whole circumference."""
        return self.copies * ufl.inner(u, v) * self._stretch * self.dx

    # -- points that columns show ----------------------------------------------------------------

    def _point(self, name: str, side: str) -> tuple[float, float]:
        return SIDES[side], READ[name] * self.data.length

    def _edge_points(self, nodes: np.ndarray) -> EdgePoints:
        points = [self._point(name, side) for name in READ for side in SIDES]
        return EdgePoints(self.mesh, nodes, points, self.data.degree)

    def _read_points(self, at: Surface) -> dict[str, ufl.Form]:
        """Radius at mid-length and position at a quarter of it, at both meridians."""
        x, z, read = at.x[0], at.x[2], self._points.read
        forms = {
            "r_mid": read(x, self._point("mid", "0")),
            "r_mid_pi": read(-x, self._point("mid", "pi")),
        }
        for name, value in {"x": x, "z": z}.items():
            for side in SIDES:
                forms[f"{name}_quarter_{side}"] = read(value, self._point("quarter", side))
        return forms

    def _resultants_read(self) -> dict[str, float]:
        """Resultants of the current state at the quarter points.

        On a mirror plane the principal directions lie along the meridian and the circumference.
        """
        out = {}
        for side, (lam1, lam2) in self._tangents(self.unknown).items():
            for name, value in self._resultants(lam1, lam2).items():
                out[f"{name}_quarter_{side}"] = float(value)
        return out

    def _resultants(self, lam1: np.ndarray | float, lam2: np.ndarray | float) -> dict[str, np.ndarray]:
        """Principal Cauchy resultants ``T1`` and ``T2``; of a wrinkled membrane the second is zero."""
        if self.data.relaxed:
            smooth = np.maximum(lam2, lam1**-0.5)
            found = self._taut_resultants(lam1, smooth)
            return {"T1": found["T1"] * smooth / lam2, "T2": np.where(smooth > lam2, 0.0, found["T2"])}
        return self._taut_resultants(lam1, lam2)

    def _taut_resultants(self, lam1: np.ndarray | float, lam2: np.ndarray | float) -> dict[str, np.ndarray]:
        if self.data.material:
            stresses = first_derivatives(self.data.material, lam1, lam2)
            return {"T1": stresses[0] / 2 / lam2, "T2": stresses[1] / 2 / lam1}
        out = {}
        for name, own, other in (("T1", lam1, lam2), ("T2", lam2, lam1)):
            first = own - own**-3 / other**2
            second = own * other**2 - own**-3
            out[name] = (first + self.data.alpha * second) / other
        return out

    # -- conditions ------------------------------------------------------------------------------

    def _ring_conditions(self) -> list[fem.DirichletBC]:
        """Both rings fixed where the stress-free tube was bonded to its disks, with the upper one lifted."""
        axis = 2 if self.data.full else 0

        def rings(x: np.ndarray) -> np.ndarray:
            return np.isclose(x[axis], 0.0) | np.isclose(x[axis], self.data.length)

        facets = dmesh.locate_entities_boundary(self.mesh, 1, rings)
        dofs = fem.locate_dofs_topological(self.space, 1, facets)
        return [fem.dirichletbc(self._rings, dofs)]

    def _mirror_conditions(self, components: tuple[int, ...]) -> list[fem.DirichletBC]:
        """Components that vanish on the plane of symmetry, on both its meridians."""

        def plane(x: np.ndarray) -> np.ndarray:
            return np.isclose(x[1], 0.0) | np.isclose(x[1], np.pi)

        facets = dmesh.locate_entities_boundary(self.mesh, 1, plane)
        out = []
        for i in components:
            component = self.space.sub(i)
            dofs = fem.locate_dofs_topological(component, 1, facets)
            out.append(fem.dirichletbc(np.array(0.0), dofs, component))
        return out


def _cylinder(delta: float) -> Shape:
    """The uniformly stretched cylinder."""
    return lambda z, theta: np.vstack([np.cos(theta), np.sin(theta), delta * z])
