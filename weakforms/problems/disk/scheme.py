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

from dataclasses import replace
from typing import ClassVar

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.disk.about import CIRCULAR_SCHEME
from weakforms.problems.disk.model import FreeDisk
from weakforms.problems.disk.phases import FIRST_T0, parabola
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.meridian.blocks import Blocks
from weakforms.problems.meridian.limits import limit_along
from weakforms.problems.meridian.pre_stretch import require_taut
from weakforms.problems.problem import Numerics, Problem, Requests, Task
from weakforms.problems.quantity_problem import on_two_meshes
from weakforms.results import Absence, Result
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

DEEPEST = 2.0
"""Height of the pole, over that of the substrate, up to which the scheme is followed."""


class CircularSchemeParameters(MaterialChoice):
    """The disk, its substrate, and where inflation ends: at most at :data:`DEEPEST` times its height.

    Beyond that, and on a substrate further away than ``l = 2`` or stiffer than ``k = 200``, Newton's method
    alternates between states with one node more and one node less of the fixed mesh in contact, however short
    the steps. The problem ``circular``, whose mesh follows the front, has neither limit.
    """

    ratio: ClassVar[str] = "alpha"

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    beta: float = Field(1.0, ge=1, le=10, description="uniform pre-stretch")
    k: float = Field(50.0, gt=0, le=200, description="substrate stiffness K R_f^2/(C1 h)")
    l: float = Field(0.5, gt=0.06, le=2, description="height of the substrate L/R_f")  # noqa: E741
    t_end: float = Field(0.57, gt=0.06, le=4, description="pole height at which inflation ends")


class CircularSchemeNumerics(Numerics):
    """Linear elements; the coarser of the two runs has half as many cells and steps."""

    cells: int = Field(400, ge=32, le=10_000, multiple_of=2, description="cells on the radius, finest")
    steps: int = Field(28, ge=4, le=2000, multiple_of=2, description="steps of the pole height, finest")


class FixedDisk(FreeDisk):
    """The disk on one mesh, in contact where ``eta > l``, with the vertical balance of what sticks."""

    def __init__(self, comm: MPI.Intracomm, given: CircularSchemeParameters, cells: int) -> None:
        mesh = Blocks([0.0, 1 / given.beta], cells, degree=1, quadrature=4)
        values = {"p": 0.0, "k": given.k, "l": given.l}
        super().__init__(comm, given.material, values, given.beta, mesh)
        self.rigid = fem.Function(self.space)
        """Unit vertical displacement of the patch."""
        x = self.material(self.nodes(), {})
        order = np.argsort(x)
        self.x, self.order = x[order], 2 * order
        """Radii of the nodes from the pole outwards, and the degrees of freedom of ``lam2`` there; the next
        one is ``eta`` at the same node."""
        self._limit = limit_along(self)

    def formulation(self) -> Formulation:
        """The weak form with the balance of the patch as a whole."""
        given = super().formulation()
        balance = ufl.action(given.residual, self.rigid)
        return replace(given, monitors={"t0": given.monitors["t0"], "balance": balance})

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
            return self._borne(found, height)

        at = float(state.u[pole])
        return walk(solve, state, at, t0, t0 - at)

    def _borne(self, state: State, t0: float) -> State:
        """The state at a height of the pole, if the law bears its stretches.

        Raises:
            AbsentError: If it does not: the stretch of the pole then depends on the mesh alone.
        """
        if why := self._limit(state):
            raise AbsentError(
                "state at t_end",
                f"circular_scheme: inflation was followed up to t0 = {t0:.6g}, p = {state.loads['p']:.6g}: "
                f"{why}; lower l and t_end below that, or change the law",
            )
        return state

    def _touch(self, solver: ExtendedNewton, given: CircularSchemeParameters) -> State:
        """State of first contact, by free inflation to ``t0 = l``."""
        x, loads = np.empty(self.system.size), self.system.initial.loads
        x[self.order], x[self.order + 1] = self.x, self.x
        u, p = parabola(x, given.material, given.beta)
        state, _ = solver.solve(State(u, loads | {"p": p}), [Held("t0", FIRST_T0)])

        def solve(before: State, t0: float) -> State:
            return self._borne(solver.solve(before, [Held("t0", t0)])[0], t0)

        try:
            return walk(solve, state, FIRST_T0, given.l, (given.l - FIRST_T0) / 9)
        except ConvergenceError as error:
            raise ConvergenceError(f"pole height in free inflation: {error}; lower l or beta") from error

    def _edge(self, state: State, given: CircularSchemeParameters) -> dict[str, float]:
        """Deformed radius of the front, interpolated linearly between the nodes around it."""
        eta = state.u[self.order + 1] - given.l
        rho = self.x * state.u[self.order]
        last = int(np.flatnonzero(eta > 0)[-1])
        share = eta[last] / (eta[last] - eta[last + 1])
        return {"rho_contact": float(rho[last] + share * (rho[last + 1] - rho[last]))}


class CircularScheme(Problem):
    """Adhesive inflation of the disk by the paper's scheme."""

    about = CIRCULAR_SCHEME
    parameters = CircularSchemeParameters
    numerics = CircularSchemeNumerics

    def check(self, parameters: CircularSchemeParameters, requests: Requests) -> None:
        """Refuse requests for states; the only state is that at ``t_end``.

        Raises:
            InputError: For a state, or an end below the substrate or far above it.
        """
        super().check(parameters, requests)
        require_taut(self.name, parameters.material, parameters.beta, "beta")
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

    def fill(self, result: Result, task: Task) -> None:
        """Run the scheme twice; uncertainties assume first order."""
        parameters, numerics, progress = task.parameters, task.numerics, task.progress

        def run(coarser: int) -> dict[str, float]:
            disk = FixedDisk(MPI.COMM_SELF, parameters, numerics.cells // coarser)
            return disk.run(parameters, numerics.steps // coarser)

        try:
            result.quantities |= on_two_meshes(run, 1.0, self.name, progress)
        except AbsentError as error:
            result.absent.append(Absence(error.what, str(error)))
