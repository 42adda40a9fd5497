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

from typing import ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.meridian.blocks import Blocks
from weakforms.problems.meridian.pre_stretch import require_stretched
from weakforms.problems.problem import Numerics, Problem, Requests, Task
from weakforms.problems.quantity_problem import on_two_meshes
from weakforms.problems.tube.about import TUBE_SCHEME
from weakforms.problems.tube.model import TubeModel, first_state
from weakforms.results import Absence, Result
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held, Plane
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.roots import root


class SchemeParameters(MaterialChoice):
    """Constrained tube and the scheme for its contact."""

    ratio: ClassVar[str] = "alpha"

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
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


class FixedMesh(TubeModel):
    """The tube on one mesh, in contact where ``rho > s``."""

    def __init__(self, comm: MPI.Intracomm, given: SchemeParameters, cells: int) -> None:
        values, half = {"p": 0.0, "k": 0.0, "s": given.s, "delta1": given.delta1}, given.lf / 2
        mesh = Blocks([0.0, half], cells, degree=1, quadrature=6)
        super().__init__(comm, given.material, values, half, mesh)
        self.parameters = given
        self.radial = 2 * np.argsort(self.nodes())
        """Degrees of freedom of ``rho`` that this rank owns, from the mid-plane outwards; the next one is
        ``eta`` at the same node."""
        self._held, self._at = np.empty(0, dtype=np.int64), np.empty(0)
        self._falls = False
        """Whether the pressure falls at first touch, beyond a limit point."""

    # -- the schemes ---------------------------------------------------------------------------

    def touch(self) -> tuple[State, bool]:
        """Free inflation to first touch or, where it is below that, to the last pressure; which of both."""
        solver, given = ExtendedNewton(self.system, ["p"]), self.parameters
        guess, held = first_state(solver, given.delta1)
        state, _ = solver.solve(guess, [held])  # a law that contracts more than others makes a neck at first
        first = state.loads["p"]
        if first >= given.p_end:
            raise InputError(
                f"tube_scheme: p_end = {given.p_end:g} is below p = {first:.6g}, where the membrane is first "
                "taut enough at this pre-stretch; raise p_end"
            )
        reached = [(float(state.u[self.radial[0]] - 1), state)]

        def solve(before: State, u: float) -> State:
            found, _ = solver.solve(before, [Held("u_max", u)])
            reached.append((u, found))
            return found

        state = solve(state, 0.02)
        try:
            state = walk(solve, state, 0.02, given.s - 1, abs(given.s - 1.02) / 7)
        except ConvergenceError:
            state = reached[-1][1]
            if state.loads["p"] < given.p_end:
                raise
        if state.loads["p"] >= given.p_end:
            passed = next(i for i, (_, found) in enumerate(reached) if found.loads["p"] >= given.p_end)
            (low, begin), (high, _) = reached[passed - 1 : passed + 1]
            near = root(lambda u: solve(begin, u).loads["p"] - given.p_end, low, high, "p = p_end", xtol=1e-6)
            return solver.solve(solve(begin, near), [Held("p", given.p_end)])[0], False
        self._falls = state.loads["p"] < reached[-2][1].loads["p"]
        state.loads["k"] = given.k
        return state, True

    def pressure_steps(self, state: State, steps: int, stick: bool) -> State:
        """Pressure steps from a state to the last pressure.

        Raises:
            AbsentError: If the pressure falls at first touch, and Newton's method finds no state beyond it.
            ConvergenceError: If it finds none though the pressure rises.
        """
        solver = ExtendedNewton(self.system, line_search="bt", max_iterations=60)

        def solve(before: State, p: float) -> State:
            return solver.solve(State(before.u, before.loads | {"p": p}))[0]

        for p in np.linspace(state.loads["p"], self.parameters.p_end, steps + 1)[1:]:
            at = state.loads["p"]
            try:
                state = walk(solve, state, at, float(p), float(p) - at)
            except ConvergenceError as error:
                if not self._falls:
                    raise
                raise AbsentError(
                    "contact at p_end",
                    f"tube_scheme: the pressure falls at first contact, and steps of it find no state beyond "
                    f"p = {at:.6g} ({error}); scheme = 'front_nodes' follows the branch",
                ) from error
            if stick:
                touched = self.radial[state.u[self.radial] > self.parameters.s] + 1
                self._hold(touched, state)
        return state

    def front_nodes(self, state: State) -> State:
        """One node after the other touches and sticks; then the last pressure is solved for.

        A node of a steep flank may be far from the substrate: it approaches in steps.
        """
        solver = ExtendedNewton(self.system, ["p"], max_iterations=60)
        for i in range(len(self.radial) - 1):
            row = np.zeros(self.system.size)
            row[self.radial[i]] = 1.0

            def solve(before: State, rho: float, row: np.ndarray = row) -> State:
                return solver.solve(before, [Plane(row, {}, rho)])[0]

            here, touch = float(state.u[self.radial[i]]), self.parameters.s
            new = walk(solve, state, here, touch, abs(touch - here))
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

    def untouched(self, state: State) -> dict[str, float]:
        """The same as :meth:`outcome` for a state without contact."""
        return {"u_max": float(state.u[self.radial[0]] - 1), "contact_length": 0.0}

    def outcome(self, state: State) -> dict[str, float]:
        """``u_max`` and contact length, with linear interpolation of the front between nodes."""
        rho, eta = state.u[self.radial], state.u[self.radial + 1]
        last = int(np.flatnonzero(rho > self.parameters.s)[-1])
        share = (rho[last] - self.parameters.s) / (rho[last] - rho[last + 1])
        front = eta[last] + share * (eta[last + 1] - eta[last])
        return {"u_max": float(rho[0] - 1), "contact_length": float(2 * front)}


class TubeScheme(Problem):
    """The constrained tube in contact, on a fixed mesh."""

    about = TUBE_SCHEME
    parameters = SchemeParameters
    numerics = SchemeNumerics

    def check(self, parameters: SchemeParameters, requests: Requests) -> None:
        """Refuse requests for states, and a pre-stretch at which the law has stresses without measure.

        Raises:
            InputError: For either.
        """
        super().check(parameters, requests)
        require_stretched(self.name, parameters.material, parameters.delta1, "delta1")

    def fill(self, result: Result, task: Task) -> None:
        """Run the scheme on two meshes (and numbers of steps); uncertainties assume first order."""
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        alone = MPI.COMM_SELF if comm.size > 1 else comm
        absent: list[Absence] = []

        def run(coarser: int) -> dict[str, float]:
            cells, steps = numerics.cells // coarser, numerics.steps // coarser
            return _run(alone, parameters, cells, steps, absent)

        try:
            result.quantities |= on_two_meshes(run, 1.0, self.name, progress)
        except AbsentError as error:
            absent.append(Absence(error.what, str(error)))
        result.absent.extend(absent[-1:])


def _run(
    comm: MPI.Intracomm, parameters: SchemeParameters, cells: int, steps: int, absent: list[Absence]
) -> dict[str, float]:
    """The quantities on one mesh; contact that is not there is noted in a list."""
    tube = FixedMesh(comm, parameters, cells)
    state, touched = tube.touch()
    if not touched:
        reason = (
            f"tube_scheme: p_end = {parameters.p_end:g} is reached before first contact; raise p_end "
            "(allowed: up to 20) or choose a smaller s"
        )
        absent.append(Absence("contact", reason))
        return tube.untouched(state)
    if parameters.scheme == "front_nodes":
        state = tube.front_nodes(state)
    else:
        first = state.loads["p"]
        state = tube.pressure_steps(state, steps, stick=parameters.scheme == "pressure_steps")
        if not np.any(state.u[tube.radial] > parameters.s):
            reason = (
                f"tube_scheme: first contact is at p = {first:.6g}, where the pressure falls; steps up to "
                f"p_end = {parameters.p_end:g} lead to a state without contact; choose a smaller s"
            )
            absent.append(Absence("contact at p_end", reason))
            return tube.untouched(state)
    return tube.outcome(state)
