"""Paper 2, constrained inflation: free part, frictionless contact, stick with its history, deflation."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from mpi4py import MPI
from numpy.polynomial import chebyshev

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.tube.contact import FIRST_FRONT, ContactData, ContactModel
from weakforms.problems.tube.model import FIRST_U, TAUT, free_branch, yielding, yields
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch, Solved
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import State

SWEEPS = 60
"""Largest number of sweeps over the fronts; about 15 are needed."""

HISTORY_ACCURACY = 2e-11
"""Largest accepted defect of ``E'(z_f) = eta'(z_f+)``."""

LAST_FRONT = 0.999
"""Largest front, as a fraction of the half length, up to which contact is followed."""


class ContactRun:
    """All phases of the constrained tube on one mesh; each is solved when it is first needed.

    Args:
        comm: Ranks.
        data: Tube, substrate and mesh.
        p_end: Pressure at which inflation ends and deflation begins.
        step: Largest arc-length step.
        terms: Number of terms of the stuck patch's axial stretch. It is refined together with the mesh, so
            that the uncertainties include the truncation error.
    """

    def __init__(
        self, comm: MPI.Intracomm, data: ContactData, p_end: float, step: float, terms: int = 18
    ) -> None:
        self.comm, self.data, self.p_end, self.step = comm, data, p_end, step
        self.terms = terms
        self.slip = ContactModel(comm, data)
        self._touch = data.s - 1

    # -- inflation -----------------------------------------------------------------------------

    @cached_property
    def free(self) -> EquilibriumBranch:
        """Free inflation up to first touch.

        Raises:
            ConvergenceError: If the branch ends before.
        """
        branch = free_branch(self.slip.system, self.data.delta1, self._touch, self.step)
        last = branch.points[-1]
        if last.monitors["u_max"] < self._touch:
            raise ConvergenceError(
                f"tube: s = {self.data.s:g} is not touched: {branch.stalled}; "
                f"lower s to less than {1 + last.monitors['u_max']:.6g}"
            )
        branch.stalled = None
        branch.end_at("u_max", self._touch)
        return branch

    @cached_property
    def onset(self) -> Solved:
        """State of first contact.

        Raises:
            InputError: If it comes after the pressure at which inflation ends.
        """
        last = self.free.points[-1]
        values = {**last.monitors, "p": last.state.loads["p"]}
        solved = Solved(values, last.state, "contact_onset")
        if solved.values["p"] >= self.p_end:
            raise InputError(
                f"tube: p_end = {self.p_end:g} is below first contact at p = {solved.values['p']:.6g}; "
                "raise p_end (allowed: up to 20) or lower s"
            )
        return solved

    @cached_property
    def frictionless(self) -> FittedBranch:
        """Frictionless contact, with the front as an unknown besides the pressure."""
        start = self.onset.state.copy()
        start.loads["k"] = self.data.k
        return self._follow(self.slip, start, self.p_end)

    def _follow(self, model: ContactModel, state: State, p_end: float) -> FittedBranch:
        solver = ExtendedNewton(model.system, ["p", "front"])
        continuation = Continuation(
            solver,
            [Held("gap", 0.0)],
            self._steps(16),
            allowed=lambda state: 0 < state.loads["front"] < model.half,
        )
        front = FIRST_FRONT * model.half
        start = continuation.start(state, Held("front", front), towards={"front": 1.0})
        least = start.state.loads["p"]
        if least >= p_end:
            raise InputError(
                f"tube: p_end = {p_end:g} is too close above first contact at p = "
                f"{self.onset.values['p']:.8g}; raise it to more than {least:.8g}"
            )
        last = LAST_FRONT * model.half

        def stop(point: CurvePoint) -> bool:
            loads = point.state.loads
            return loads["p"] > p_end or loads["front"] > last or yields(point)

        branch = FittedBranch(continuation, "p", start, stop)
        end = branch.points[-1]
        if end.state.loads["p"] < p_end:
            why = branch.stalled or f"there the patch covers {LAST_FRONT:g} of the tube's length"
            branch.stalled = (
                f"contact was followed up to p = {end.state.loads['p']:.6g}, not p_end = {p_end:g}: "
                f"{yielding(end) if yields(end) else why}"
            )
        return branch

    # -- stick ---------------------------------------------------------------------------------

    @cached_property
    def stick(self) -> ContactModel:
        r"""The stuck model with its history.

        While the patch grows there is no line force at its front, so the position frozen there continues
        the free part with its slope: :math:`E'(z_f) = \eta'(z_f^+)` at every front. This condition is
        collocated at Chebyshev points ``z_j`` of the patch at ``p_end``, and iterated: each sweep solves one
        front-fitted problem for each ``z_j`` with the last ``E``, and uses the slopes for the next sweep.

        Raises:
            ConvergenceError: If the sweeps do not converge.
        """
        span = self._reached(self.frictionless).state.loads["front"]
        model = ContactModel(self.comm, replace(self.data, terms=self.terms, span=span))
        t = -np.cos(np.pi * np.arange(self.terms) / (self.terms - 1))
        fronts = span * (1 + t[1:]) / 2
        first = self.onset.values["lam1_mid"] / self.data.delta1
        slipped = [self._slipped(z) for z in fronts]
        slopes = np.array([first, *(s.values["slope_outside"] for s in slipped)])
        solver = ExtendedNewton(model.system, ["p", "front"])
        states = [stick_guess(model, s) for s in slipped]
        for _ in range(SWEEPS):
            model.set_history(chebyshev.chebfit(t, slopes, self.terms - 1))
            for j, z in enumerate(fronts):
                states[j], _ = solver.solve(states[j], [Held("gap", 0.0), Held("front", z)])
                slopes[j + 1] = model.system.monitor("slope_outside")
            defect = np.abs(slopes - chebyshev.chebval(t, model.history)).max()
            if defect < HISTORY_ACCURACY:
                return model
        raise ConvergenceError(f"history of the stuck patch: defect {defect:.1e} after {SWEEPS} sweeps")

    def _slipped(self, front: float) -> Solved:
        """Frictionless contact with the edge of the patch at a position, even before the traced ones."""
        trace = self.frictionless
        first = trace.points[0].state
        return trace.near(first, "front", front) if front < first.loads["front"] else trace.at("front", front)

    def _reached(self, branch: FittedBranch) -> Solved:
        """The state at ``p_end``.

        Raises:
            ConvergenceError: If the branch ends before.
        """
        if len(branch.crossings("p", self.p_end)):
            return branch.at("p", self.p_end)
        raise ConvergenceError(f"tube: {branch.stalled}; lower p_end")

    @cached_property
    def adhesive(self) -> FittedBranch:
        """Adhesive inflation: every point that touched keeps its axial position."""
        model = self.stick
        return self._follow(model, stick_guess(model, self._first_slip()), self.p_end)

    def _first_slip(self) -> Solved:
        point = self.frictionless.points[0]
        return Solved({"contact_length": point.monitors["contact_length"]}, point.state)

    # -- deflation -----------------------------------------------------------------------------

    @cached_property
    def deflation(self) -> EquilibriumBranch:
        """Deflation to ``p = 0`` with the patch reached at ``p_end``, which does not peel."""
        state = self._reached(self.adhesive).state
        model = self.stick
        if self.data.unilateral:
            history = model.history
            model = ContactModel(self.comm, replace(model.data, unilateral=True))
            model.set_history(history)
        solver = ExtendedNewton(model.system, ["p"])
        continuation = Continuation(solver, control=self._steps(4))
        start = continuation.start(state, Held("p", self.p_end), towards={"p": -1.0})
        # With a unilateral spring, a tube without pre-stretch goes slack, as a free tube does.
        slack = FIRST_U if self.data.unilateral and self.data.delta1 < TAUT else -np.inf

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["p"] < 0.0 or point.monitors["u_max"] < slack

        return EquilibriumBranch(continuation, "p", start, stop)

    def _steps(self, fraction: int) -> StepControl:
        return StepControl(first=self.step / fraction, largest=self.step)


def stick_guess(model: ContactModel, slipped: Solved) -> State:
    """A frictionless state as a guess for the stuck model with the same mesh and front."""
    x = np.repeat(model.space.tabulate_dof_coordinates()[: model.system.size // 2, 0], 2)
    u = slipped.state.u.copy()
    axial = np.arange(len(u)) % 2 == 1
    outside = axial & (x > 1 + 1e-12)
    u[axial & ~outside] = 0.0
    # Shifted by its own position of the front; E differs from it and would cause a jump.
    u[outside] -= slipped.values["contact_length"] / 2 * (2 - x[outside])
    return State(u, dict(slipped.state.loads))
