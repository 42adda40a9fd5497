r"""Paper 1's scheme for adhesive contact on a fixed mesh: steps of the pole height, and frozen rings.

The pole is raised by equal steps. Nodes that have touched keep their stretch and their depth below the pole.
A ring that touches within a step moves without friction until the end of the step, and is then frozen. The
pressure is an unknown, from the vertical balance of the patch as a whole,

.. math:: \delta\Pi(r = 0,\ e = 1 \text{ on the patch}) = 0 .

The scheme is of first order in the step. It shows convergence to the limit that
:mod:`weakforms.problems.disk.phases` solves for. The history is stored per node, and each rank solves the
whole of this small problem.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import Mesh
from mpi4py import MPI
from pydantic import Field
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError, InputError
from weakforms.forms.kinematics import Slope, disk_stretches
from weakforms.forms.loads import bed_potential, gas_potential
from weakforms.forms.materials import mooney_rivlin
from weakforms.problems.disk.guesses import FIRST_T0, parabola
from weakforms.problems.disk.problem import ENERGY, SCALES, SOURCE
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.meshes import graded_interval, tag_points
from weakforms.problems.problem import (
    Numerics,
    Parameters,
    Progress,
    Requests,
    check_requests,
    registry,
    silent,
)
from weakforms.problems.quantity_problem import solve_twice
from weakforms.results import Result
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import Formulation, State, System

POLE, RIM = 1, 2

DEEPEST = 3.0
"""Height of the pole, over that of the substrate, up to which the scheme is followed."""


class CircularSchemeParameters(Parameters):
    """The disk, its substrate, and where inflation ends: at most at :data:`DEEPEST` times its height.

    Beyond that, and on a substrate stiffer than ``k = 1000``, Newton's method alternates between states with
    one node more and one node less of the fixed mesh in contact, however short the steps. The problem
    ``circular``, whose mesh follows the front, has neither limit.
    """

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1")
    beta: float = Field(1.0, ge=1, le=10, description="uniform pre-stretch")
    k: float = Field(50.0, gt=0, le=1000, description="substrate stiffness K R_f^2/(C1 h)")
    l: float = Field(0.5, gt=0.06, le=5, description="height of the substrate L/R_f")  # noqa: E741
    t_end: float = Field(0.57, gt=0.06, le=5, description="pole height at which inflation ends")


class CircularSchemeNumerics(Numerics):
    """Linear elements; the coarser of the two runs has half as many cells and steps."""

    cells: int = Field(400, ge=32, le=10_000, multiple_of=2, description="cells on the radius, finest")
    steps: int = Field(28, ge=4, le=2000, multiple_of=2, description="steps of the pole height, finest")


@dataclass
class FixedDisk:
    """The disk on one mesh with its contact indicator in the form."""

    system: System
    rigid: fem.Function
    """Unit vertical displacement of the patch."""
    x: np.ndarray
    """Radii of the nodes from the pole outwards."""
    order: np.ndarray
    """Degrees of freedom of ``lam2`` at these nodes; the next one is ``eta`` at the same node."""

    @classmethod
    def build(cls, comm: MPI.Intracomm, given: CircularSchemeParameters, cells: int) -> FixedDisk:
        """Assemble the form."""
        edge = 1 / given.beta
        mesh = graded_interval(comm, cells, edge, 0.0)
        space = fem.functionspace(mesh, basix.ufl.element("Lagrange", "interval", 1, shape=(2,)))
        unknown, rigid = fem.Function(space), fem.Function(space)
        loads = {"p": fem.Constant(mesh, 0.0)}
        variables = {name: (c, ufl.variable(c)) for name, c in loads.items()}
        tags = tag_points(mesh, {POLE: 0.0, RIM: edge})
        dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 4})
        ends = ufl.Measure("ds", mesh, subdomain_data=tags)
        energy = _potential(mesh, unknown, variables["p"][1], given) * dx
        test = ufl.TestFunction(space)
        residual = ufl.derivative(energy, unknown, test)
        rim = fem.locate_dofs_topological(space, 0, tags.find(RIM))
        system = System(
            Formulation(
                unknown=unknown,
                residual=residual,
                loads=variables,
                bcs=[fem.dirichletbc(np.array([given.beta, 0.0]), rim, space)],
                mass=ufl.inner(ufl.TrialFunction(space), test) * dx,
                monitors={"t0": unknown[1] * ends(POLE), "balance": ufl.action(residual, rigid)},
            )
        )
        x = space.tabulate_dof_coordinates()[: system.size // 2, 0]
        order = np.argsort(x)
        return cls(system, rigid, x[order], 2 * order)

    def run(self, given: CircularSchemeParameters, steps: int) -> dict[str, float]:
        """Inflate to first touch, then step by step."""
        solver = ExtendedNewton(self.system, ["p"], max_iterations=60)
        state = self._touch(solver, given)
        stuck, depth, lam2 = 0, np.empty(0), np.empty(0)
        for t0 in np.linspace(given.l, given.t_end, steps + 1)[1:]:
            state = self._raised(solver, state, float(t0), lam2, depth)
            above = state.u[self.order + 1] > given.l
            stuck = int(above.argmin()) if not above.all() else len(above)
            nodes = self.order[:stuck]
            lam2, depth = state.u[nodes], t0 - state.u[nodes + 1]
            self.rigid.x.array[:] = 0.0
            self.rigid.x.array[nodes + 1] = 1.0
        return {"p": state.loads["p"], "lam_pole": float(state.u[self.order[0]]), **self._edge(state, given)}

    def _raised(
        self, solver: ExtendedNewton, state: State, t0: float, lam2: np.ndarray, depth: np.ndarray
    ) -> State:
        """The pole at a height, the nodes that are stuck below it as they were.

        Where Newton's method does not reach it at once, heights between come first; nothing sticks there.
        """
        nodes, pole = self.order[: len(lam2)], self.order[0] + 1

        def solve(before: State, height: float) -> State:
            self.system.hold(np.concatenate([nodes, nodes + 1]), np.concatenate([lam2, height - depth]))
            # A guess without a tear at the edge: what is free rises in proportion.
            guess = State(before.u.copy(), dict(before.loads))
            guess.u[self.order + 1] *= height / before.u[pole]
            guess.u[nodes + 1] = height - depth
            held = Held("balance", 0.0) if len(nodes) else Held("t0", height)
            found, _ = solver.solve(guess, [held])
            if found.u[self.order].min() <= 0:
                raise ConvergenceError("Newton's method found a membrane turned inside out")
            return found

        at = float(state.u[pole])
        return walk(solve, state, at, t0, t0 - at)

    def _touch(self, solver: ExtendedNewton, given: CircularSchemeParameters) -> State:
        """State of first contact, by free inflation to ``t0 = l``."""
        state = self.system.state()
        x = np.empty(len(state.u))
        x[self.order], x[self.order + 1] = self.x, self.x
        u, p = parabola(x, mooney_rivlin_of(given.alpha), given.beta)
        state, _ = solver.solve(State(u, {"p": p}), [Held("t0", FIRST_T0)])

        def solve(before: State, t0: float) -> State:
            return solver.solve(before, [Held("t0", t0)])[0]

        return walk(solve, state, FIRST_T0, given.l, (given.l - FIRST_T0) / 9)

    def _edge(self, state: State, given: CircularSchemeParameters) -> dict[str, float]:
        """Deformed radius of the front, interpolated linearly between the nodes around it."""
        eta = state.u[self.order + 1] - given.l
        rho = self.x * state.u[self.order]
        last = int(np.flatnonzero(eta > 0)[-1])
        share = eta[last] / (eta[last] - eta[last + 1])
        return {"rho_contact": float(rho[last] + share * (rho[last + 1] - rho[last]))}


def _potential(mesh: Mesh, unknown: fem.Function, p: Expr, given: CircularSchemeParameters) -> Expr:
    """The potential of :mod:`weakforms.problems.disk.model` with contact where ``eta > l``."""
    x = ufl.SpatialCoordinate(mesh)[0]
    lam2, eta = unknown
    rho, rho_slope = x * lam2, lam2 + x * lam2.dx(0)
    stretches = disk_stretches(x, lam2, lam2.dx(0), eta.dx(0))
    touches = ufl.conditional(ufl.gt(eta, given.l), 1.0, 0.0)
    energy = mooney_rivlin(stretches.lam1, stretches.lam2, given.alpha) * x
    energy += gas_potential(rho, Slope(-eta.dx(0)), p)
    return energy + bed_potential(rho, rho_slope, eta - given.l, given.k, touches)


class CircularScheme:
    """Adhesive inflation of the disk by the paper's scheme."""

    name: ClassVar[str] = "circular_scheme"
    title: ClassVar[str] = "Adhesive inflation of the disk by frozen rings on a fixed mesh"
    paper: ClassVar[int] = 1
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = SCALES
    parameters = CircularSchemeParameters
    numerics = CircularSchemeNumerics
    columns = ()
    special_points = ()
    branches = ("primary",)
    control: ClassVar[str] = "t0; the quantities p, rho_contact and lam_pole are at t_end"

    def check(self, parameters: CircularSchemeParameters, requests: Requests) -> None:
        """Refuse requests for states; the only state is that at ``t_end``.

        Raises:
            InputError: For a state, or an end below the substrate or far above it.
        """
        check_requests(self, requests)
        if parameters.t_end <= parameters.l:
            raise InputError(
                f"circular_scheme: t_end = {parameters.t_end:g} must be above l = {parameters.l:g}"
            )
        if parameters.t_end > DEEPEST * parameters.l:
            raise InputError(
                f"circular_scheme: t_end = {parameters.t_end:g} is more than {DEEPEST:g} l = "
                f"{DEEPEST * parameters.l:g}, up to which the scheme converges on its fixed mesh; lower "
                "t_end or raise l"
            )

    def solve(
        self,
        parameters: CircularSchemeParameters,
        numerics: CircularSchemeNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Run the scheme twice; uncertainties assume first order."""

        def run(coarser: int) -> dict[str, float]:
            disk = FixedDisk.build(MPI.COMM_SELF, parameters, numerics.cells // coarser)
            return disk.run(parameters, numerics.steps // coarser)

        return solve_twice(self, parameters, numerics, comm, progress, run, order=1.0)


registry.add(CircularScheme())
