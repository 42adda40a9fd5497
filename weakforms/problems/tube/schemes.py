"""Paper 2's schemes for contact on a fixed mesh: pressure steps, and the front from node to node.

Here the contact indicator is ``rho > s``, a conditional in the residual whose derivative jumps (semi-smooth
Newton). Sticking nodes keep their axial position. There are three schemes:

- ``semismooth``: frictionless contact at the last pressure, by pressure steps;
- ``pressure_steps``: the printed rule; after each converged pressure step every node with ``rho > s`` keeps
  its axial position in all later steps. Nodes that touch within a step move without friction until its end;
- ``front_nodes``: the pressure is an unknown; one node after the other touches, ``rho(z_i) = s``, and sticks.

All are of about first order, unlike the fitted mesh of :mod:`weakforms.problems.tube.contact`. They show
convergence to the same limit. The history is stored per node, and each rank solves the whole of this small
problem.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Literal

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from pydantic import Field

from weakforms.forms.kinematics import tube_stretches
from weakforms.forms.loads import gas_potential, substrate_potential
from weakforms.forms.materials import mooney_rivlin
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
from weakforms.problems.tube.model import first_state
from weakforms.problems.tube.problem import ENERGY, SCALES, SOURCE
from weakforms.results import Absence, Result
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held, Plane
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import Formulation, State, System

MIDPLANE, DISK = 1, 2


class SchemeParameters(Parameters):
    """Constrained tube and the scheme for its contact."""

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1")
    delta1: float = Field(1.0, ge=1, le=5, description="axial pre-stretch")
    lf: float = Field(6.0, ge=1, le=60, description="stretched length L_f/R_f")
    k: float = Field(20.0, ge=0, le=1e4, description="substrate stiffness K R_f^2/(C1 h_o)")
    s: float = Field(1.3, gt=1, le=20, description="substrate radius S/R_f")
    p_end: float = Field(3.0, gt=0, le=20, description="pressure at which inflation ends")
    scheme: Literal["semismooth", "pressure_steps", "front_nodes"] = Field(
        "front_nodes", description="scheme for the contact"
    )


class SchemeNumerics(Numerics):
    """Linear elements; pressure steps are refined with the mesh."""

    cells: int = Field(200, ge=16, le=5000, multiple_of=2, description="cells on half the length, finest")
    steps: int = Field(
        64, ge=4, le=2000, multiple_of=2, description="pressure steps from first touch, finest"
    )


@dataclass
class FixedMesh:
    """The tube on one mesh with its contact indicator in the form."""

    system: System
    radial: np.ndarray
    """Degrees of freedom of ``rho`` that this rank owns, from the mid-plane outwards; the next one is ``eta``
    at the same node."""
    parameters: SchemeParameters
    _held: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    _at: np.ndarray = field(default_factory=lambda: np.empty(0))

    @classmethod
    def build(cls, comm: MPI.Intracomm, given: SchemeParameters, cells: int) -> FixedMesh:
        """Assemble the form."""
        half = given.lf / 2
        mesh = graded_interval(comm, cells, half, 0.0)
        element = basix.ufl.element("Lagrange", "interval", 1, shape=(2,))
        space = fem.functionspace(mesh, element)
        unknown = fem.Function(space)
        unknown.interpolate(lambda x: np.vstack([np.ones_like(x[0]), x[0]]))
        rho, eta = unknown
        values = {"p": 0.0, "k": 0.0, "delta1": given.delta1}
        constants = {name: fem.Constant(mesh, value) for name, value in values.items()}
        loads = {name: (c, ufl.variable(c)) for name, c in constants.items()}
        p, k, delta1 = (loads[name][1] for name in ("p", "k", "delta1"))
        stretches = tube_stretches(rho, eta, delta1)
        touches = ufl.conditional(ufl.gt(rho, given.s), 1.0, 0.0)
        dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 6})
        energy = mooney_rivlin(stretches.lam1, stretches.lam2, given.alpha) / ufl.sqrt(delta1)
        energy += gas_potential(rho, eta, p) + substrate_potential(rho, eta, k, given.s, touches)
        tags = tag_points(mesh, {MIDPLANE: 0.0, DISK: half})
        ends = ufl.Measure("ds", mesh, subdomain_data=tags)
        disk = fem.locate_dofs_topological(space, 0, tags.find(DISK))
        middle = fem.locate_dofs_topological(space.sub(1), 0, tags.find(MIDPLANE))
        test = ufl.TestFunction(space)
        system = System(
            Formulation(
                unknown=unknown,
                residual=ufl.derivative(energy * dx, unknown, test),
                loads=loads,
                bcs=[
                    fem.dirichletbc(np.array([1.0, half]), disk, space),
                    fem.dirichletbc(np.array(0.0), middle, space.sub(1)),
                ],
                mass=ufl.inner(ufl.TrialFunction(space), test) * dx,
                monitors={"u_max": (rho - 1) * ends(MIDPLANE)},
            )
        )
        z = space.tabulate_dof_coordinates()[: system.size // 2, 0]
        return cls(system, 2 * np.argsort(z), given)

    # -- the schemes ---------------------------------------------------------------------------

    def touch(self) -> tuple[State, bool]:
        """Free inflation to first touch or, where it is below that, to the last pressure; which of both."""
        solver, given = ExtendedNewton(self.system, ["p"]), self.parameters
        state, _ = first_state(solver, given.delta1)
        passed: list[State] = []

        def solve(before: State, u: float) -> State:
            found, _ = solver.solve(before, [Held("u_max", u)])
            if found.loads["p"] >= given.p_end:
                passed.append(found)
            return found

        state = solve(state, 0.02)
        state = walk(solve, state, 0.02, given.s - 1, abs(given.s - 1.02) / 7)
        if state.loads["p"] >= given.p_end:
            return solver.solve(passed[0], [Held("p", given.p_end)])[0], False
        state.loads["k"] = given.k
        return state, True

    def pressure_steps(self, state: State, steps: int, stick: bool) -> State:
        """Pressure steps from a state to the last pressure."""
        solver = ExtendedNewton(self.system, line_search="bt", max_iterations=60)

        def solve(before: State, p: float) -> State:
            return solver.solve(State(before.u, before.loads | {"p": p}))[0]

        for p in np.linspace(state.loads["p"], self.parameters.p_end, steps + 1)[1:]:
            at = state.loads["p"]
            state = walk(solve, state, at, float(p), float(p) - at)
            if stick:
                touched = self.radial[state.u[self.radial] > self.parameters.s] + 1
                self._hold(touched, state)
        return state

    def front_nodes(self, state: State) -> State:
        """One node after the other touches and sticks; then the last pressure is solved for."""
        solver = ExtendedNewton(self.system, ["p"], max_iterations=60)
        for i in range(len(self.radial) - 1):
            row = np.zeros(self.system.size)
            row[self.radial[i]] = 1.0
            new, _ = solver.solve(state, [Plane(row, {}, self.parameters.s)])
            if new.loads["p"] > self.parameters.p_end:
                break
            state = new
            self._hold(self.radial[: i + 1] + 1, state)
        at, end = state.loads["p"], self.parameters.p_end
        return walk(lambda before, p: solver.solve(before, [Held("p", p)])[0], state, at, end, abs(end - at))

    def _hold(self, dofs: np.ndarray, state: State) -> None:
        fresh = np.setdiff1d(dofs, self.system.bc_dofs)
        self._held = np.concatenate([self._held, fresh])
        self._at = np.concatenate([self._at, state.u[fresh]])
        self.system.hold(self._held, self._at)

    def outcome(self, state: State) -> dict[str, float]:
        """``u_max`` and contact length, with linear interpolation of the front between nodes."""
        rho, eta = state.u[self.radial], state.u[self.radial + 1]
        last = int(np.flatnonzero(rho > self.parameters.s)[-1])
        share = (rho[last] - self.parameters.s) / (rho[last] - rho[last + 1])
        front = eta[last] + share * (eta[last + 1] - eta[last])
        return {"u_max": float(rho[0] - 1), "contact_length": float(2 * front)}


class TubeScheme:
    """The constrained tube in contact, on a fixed mesh."""

    name: ClassVar[str] = "tube_scheme"
    title: ClassVar[str] = "Contact of the tube by the paper's schemes on a fixed mesh"
    paper: ClassVar[int] = 2
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = SCALES
    parameters = SchemeParameters
    numerics = SchemeNumerics
    columns = ()
    special_points = ()
    branches = ("primary",)
    control: ClassVar[str] = "p; the quantities u_max and contact_length are at p_end"

    def check(self, parameters: SchemeParameters, requests: Requests) -> None:
        """Refuse requests for states; the only state is that at ``p_end``."""
        check_requests(self, requests)

    def solve(
        self,
        parameters: SchemeParameters,
        numerics: SchemeNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Run the scheme on two meshes (and numbers of steps); uncertainties assume first order."""
        alone = MPI.COMM_SELF if comm.size > 1 else comm

        absent: list[Absence] = []

        def run(coarser: int) -> dict[str, float]:
            cells, steps = numerics.cells // coarser, numerics.steps // coarser
            return _run(alone, parameters, cells, steps, absent)

        result = solve_twice(self, parameters, numerics, comm, progress, run, order=1.0)
        result.absent.extend(absent[-1:])
        return result


def _run(
    comm: MPI.Intracomm, parameters: SchemeParameters, cells: int, steps: int, absent: list[Absence]
) -> dict[str, float]:
    """The quantities on one mesh; contact that is not there is noted in a list."""
    tube = FixedMesh.build(comm, parameters, cells)
    state, touched = tube.touch()
    if not touched:
        reason = (
            f"tube_scheme: p_end = {parameters.p_end:g} is reached before first contact; raise p_end "
            "(allowed: up to 20) or choose a smaller s"
        )
        absent.append(Absence("contact", reason))
        return {"u_max": float(state.u[tube.radial[0]] - 1), "contact_length": 0.0}
    if parameters.scheme == "front_nodes":
        state = tube.front_nodes(state)
    else:
        state = tube.pressure_steps(state, steps, stick=parameters.scheme == "pressure_steps")
    return tube.outcome(state)


registry.add(TubeScheme())
