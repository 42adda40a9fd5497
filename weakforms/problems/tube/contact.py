"""Paper 2, constrained inflation: the tube against a soft cylindrical substrate, with the front on the mesh.

The half tube is mapped from two fixed intervals: the patch ``x in [0, 1]`` to ``Z in [0, z_f]``, the free
part ``x in [1, 2]`` to ``Z in [z_f, l_f/2]``. The front ``z_f`` is a scalar unknown with the equation
``rho(z_f) = s``, so that the kink is never inside an element and the order of the elements is kept.

In a stuck patch the axial position is not an unknown: ``eta = E(Z)``, where ``E'`` is a Chebyshev series
(:class:`StuckHistory`). The unknown of the free part is then ``q = eta - E(z_f) (2 - x)``, zero at the front.
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
from numpy.polynomial import chebyshev
from ufl.core.expr import Expr

from weakforms.forms.kinematics import Slope, tube_stretches
from weakforms.forms.loads import enclosed_volume, gas_potential, substrate_potential
from weakforms.forms.materials import stress_resultants
from weakforms.problems.contact_series import Series
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meshes import tag_points
from weakforms.problems.tube.model import resistance
from weakforms.solvers.equilibrium.system import Formulation, System

MIDPLANE, FRONT, DISK = 1, 2, 3

UNILATERAL_QUADRATURE = 160
"""Degree of quadrature where a unilateral spring's force has a kink inside a cell. The quadrature error at
the kink dominates on fine meshes, and decreases with the square of the number of points."""

FIRST_FRONT = 0.004
"""Smallest front at which contact is followed, as a fraction of the half length."""


@dataclass(frozen=True)
class ContactData:
    """The tube, its substrate and its mesh."""

    alpha: float
    delta1: float
    lf: float
    k: float
    s: float
    cells: int
    degree: int
    grading: float
    terms: int = 0
    """Terms of the stuck patch's series; 0 for frictionless contact."""
    span: float = 1.0
    """The series is over ``Z`` in ``[0, span]``."""
    unilateral: bool = False
    """Whether the spring of a stuck patch only pushes."""
    material: Chosen | None = None
    """Law of the membrane; by default the paper's, with ``alpha``."""


def two_part_mesh(comm: MPI.Intracomm, cells: int, grading: float) -> Mesh:
    """``cells`` on the patch ``[0, 1]`` and as many on ``[1, 2]``, finer at the front and at the disk."""
    mesh = dmesh.create_interval(comm, 2 * cells, [0.0, 2.0])
    x = mesh.geometry.x
    left = x[:, 0] <= 1.0 + 1e-12
    t = np.where(left, x[:, 0], x[:, 0] - 1.0)
    one_end = t + grading * t * (1 - t)
    # On the free part both ends are refined: the front's boundary layer and the disk's.
    both_ends = t - grading * np.sin(2 * np.pi * t) / (2 * np.pi)
    x[:, 0] = np.where(left, one_end, 1.0 + both_ends)
    return mesh


class ContactModel:
    """Weak form of the tube with a front-fitted mesh, with constants that can be changed.

    Loads: ``p``, ``front`` (``z_f``), ``k`` and ``delta1``; ``k = 0`` is the free tube.
    """

    def __init__(self, comm: MPI.Intracomm, data: ContactData) -> None:
        self.data = data
        self.half = data.lf / 2
        self.mesh = two_part_mesh(comm, data.cells, data.grading)
        element = basix.ufl.element("Lagrange", "interval", data.degree, shape=(2,))
        self.space = fem.functionspace(self.mesh, element)
        self.unknown = fem.Function(self.space, name="tube")
        values = {"p": 0.0, "front": FIRST_FRONT * self.half, "k": 0.0, "delta1": data.delta1}
        self.constants = {name: fem.Constant(self.mesh, value) for name, value in values.items()}
        self.loads = {name: (c, ufl.variable(c)) for name, c in self.constants.items()}
        fixed = {"half": self.half, "s": data.s, "span": data.span}
        self.fixed = {name: fem.Constant(self.mesh, value) for name, value in fixed.items()}
        self.axial_slope, self.axial = (Series(self.mesh, data.terms + n, self.fixed["span"]) for n in (0, 1))
        self.patch = fem.Function(fem.functionspace(self.mesh, ("DG", 0)))
        cells = dmesh.locate_entities(self.mesh, 1, lambda x: x[0] <= 1.0 + 1e-12)
        self.patch.x.array[cells] = 1.0
        self.tags = tag_points(self.mesh, {MIDPLANE: 0.0, FRONT: 1.0, DISK: 2.0})
        self._set_reference_state()
        self.system = System(self._formulation())

    # -- geometry ------------------------------------------------------------------------------

    @property
    def stuck(self) -> bool:
        """Whether the patch sticks."""
        return self.data.terms > 0

    def _in_patch(self, inside: Expr | float, outside: Expr | float) -> Expr:
        """Indicator by cell, because at the front the coordinate does not distinguish the sides."""
        return ufl.conditional(ufl.gt(self.patch, 0.5), inside, outside)

    def locate(self, z: np.ndarray, loads: dict[str, float]) -> np.ndarray:
        """Mesh coordinates of material points ``Z`` for a state's front."""
        front = loads["front"]
        return np.where(z <= front, z / front, 1 + (z - front) / (self.half - front))

    def _jacobian(self) -> Expr:
        front = self.loads["front"][1]
        return self._in_patch(front, self.fixed["half"] - front)

    def _set_reference_state(self) -> None:
        front = self.constants["front"].value

        def reference(x: np.ndarray) -> np.ndarray:
            z = np.where(x[0] <= 1, front * x[0], front + (self.half - front) * (x[0] - 1))
            return np.vstack([np.ones_like(z), z])

        self.unknown.interpolate(reference)

    # -- the stuck patch -----------------------------------------------------------------------

    def set_history(self, coefficients: np.ndarray) -> None:
        """Set the series of ``E'``; ``E`` is its integral, zero at the mid-plane."""
        self.history = coefficients
        self.axial_slope.set(coefficients)
        self.axial.set(chebyshev.chebint(coefficients, lbnd=-1.0) * self.data.span / 2)

    def axial_position(self) -> tuple[Expr, Expr]:
        """``(eta, deta/dx)``, in a stuck patch from the history."""
        x = ufl.SpatialCoordinate(self.mesh)[0]
        q = self.unknown[1]
        if not self.stuck:
            return q, q.dx(0)
        front = self.loads["front"][1]
        place = front * x
        (at_front, _), (inside, _), (slope, _) = self.axial(front), self.axial(place), self.axial_slope(place)
        eta = self._in_patch(inside, q + at_front * (2 - x))
        return eta, self._in_patch(front * slope, q.dx(0) - at_front)

    # -- the form ------------------------------------------------------------------------------

    def _formulation(self) -> Formulation:
        data, unknown, s = self.data, self.unknown, self.fixed["s"]
        rho = unknown[0]
        eta, eta_x = self.axial_position()
        p, k, delta1 = (self.loads[name][1] for name in ("p", "k", "delta1"))
        jacobian = self._jacobian()
        axial = Slope(eta_x)
        stretches = tube_stretches(rho, axial, delta1, jacobian)
        contact = self._in_patch(1.0, 0.0)
        if data.unilateral:
            contact = contact * ufl.conditional(ufl.gt(rho, s), 1.0, 0.0)
        quadrature = UNILATERAL_QUADRATURE if data.unilateral else 2 * data.degree + 4
        dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": quadrature})
        law = (data.material or mooney_rivlin_of(data.alpha)).law(self.mesh)
        density = law(stretches.lam1, stretches.lam2) / ufl.sqrt(delta1) * jacobian
        density += gas_potential(rho, axial, p) + substrate_potential(rho, axial, k, s, contact)
        energy = density * dx
        t1, t2 = stress_resultants(law, stretches.lam1, stretches.lam2)
        membrane = ufl.sqrt(delta1) * t1 * stretches.lam2 * stretches.cos_beta
        spring = (rho - s) + (rho - s) ** 2 / (2 * rho)
        force = membrane - p * rho**2 / 2 + k * contact * rho * (rho - s) ** 2 / 2
        # Per deformed area: the substrate's axial traction on the membrane, and the spring's radial part.
        f_t = -delta1 * force.dx(0) / jacobian / (rho * stretches.lam1)
        f_k = -k * contact * stretches.cos_beta * spring
        pressure = p - k * contact * spring
        kappa = (t2 * stretches.lam1 * stretches.cos_beta - pressure * rho * stretches.lam1) / (
            ufl.sqrt(delta1) * t1 * stretches.lam2 * stretches.lam1
        )
        ends = ufl.Measure("ds", self.mesh, subdomain_data=self.tags)
        inner = ufl.Measure("dS", self.mesh, subdomain_data=self.tags)
        test = ufl.TestFunction(self.space)
        return Formulation(
            unknown=unknown,
            residual=ufl.derivative(energy, unknown, test),
            loads=self.loads,
            bcs=self._conditions(),
            mass=ufl.inner(ufl.TrialFunction(self.space), test) * jacobian * dx,
            monitors={
                "u_max": (rho - 1) * ends(MIDPLANE),
                "lam1_mid": stretches.lam1 * ends(MIDPLANE),
                "lam2_mid": stretches.lam2 * ends(MIDPLANE),
                "t1_mid": t1 * ends(MIDPLANE),
                "V": enclosed_volume(rho, axial) * dx,
                "Pi": energy,
                "resistance": resistance(law, stretches) * ends(MIDPLANE),
                "slope_outside": self._one_sided(self._in_patch(0.0, eta_x / jacobian)),
                "jump": self._one_sided(self._in_patch(force, -force) / rho),
                "membrane_jump": self._one_sided(self._in_patch(membrane, -membrane) / rho),
                "f_t_front": self._one_sided(self._in_patch(f_t, 0.0)),
                "kappa": self._one_sided(self._in_patch(0.0, kappa)),
                "Z_front": self.loads["front"][1] * inner(FRONT),
                "gap": ufl.avg(rho - s) * inner(FRONT),
                "contact_length": 2 * ufl.avg(eta) * inner(FRONT),
            },
            maxima={"spring_max": abs(f_k), "t2_max_negative": -t2},
            # |f_t| is largest at the front. Its one-sided value there is used, not the maximum over all
            # cells: where a unilateral spring goes slack, second derivatives of the solution jump inside a
            # cell.
            derived={
                "traction_max": lambda v: abs(v["f_t_front"]),
                "line_force": lambda v: abs(v["jump"]),
                "line_force_membrane": lambda v: abs(v["membrane_jump"]),
                "traction_front": lambda v: abs(v["f_t_front"]),
                "t2_min": lambda v: -v["t2_max_negative"],
            },
            internal=(
                "front",
                "gap",
                "jump",
                "membrane_jump",
                "f_t_front",
                "t2_max_negative",
                "slope_outside",
                "resistance",
            ),
            locate=self.locate,
            profile={
                "rho": rho,
                "eta": eta,
                "lam1": stretches.lam1,
                "lam2": stretches.lam2,
                "t1": t1,
                "t2": t2,
                "f_t": self._in_patch(f_t, 0.0),
                "f_k": f_k,
                "F_axial": force,
                "H": law(stretches.lam1, stretches.lam2) - stretches.lam1 * t1 * stretches.lam2,
            },
        )

    def _one_sided(self, value: Expr) -> ufl.Form:
        """One-sided value at the front of an expression that is zero on the other side."""
        inner = ufl.Measure("dS", self.mesh, subdomain_data=self.tags)
        return (value("+") + value("-")) * inner(FRONT)

    def _conditions(self) -> list[fem.DirichletBC]:
        space, mesh = self.space, self.mesh
        disk = fem.locate_dofs_topological(space, 0, self.tags.find(DISK))
        axial = space.sub(1)
        if self.stuck:
            mesh.topology.create_connectivity(1, 1)  # needed to locate the conditions
            held = dmesh.locate_entities(mesh, 1, lambda x: x[0] <= 1.0 + 1e-12)
            dofs = fem.locate_dofs_topological(axial, 1, held)
        else:
            dofs = fem.locate_dofs_topological(axial, 0, self.tags.find(MIDPLANE))
        return [
            fem.dirichletbc(np.array([1.0, self.half]), disk, space),
            fem.dirichletbc(np.array(0.0), dofs, axial),
        ]
