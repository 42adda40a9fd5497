"""Paper 2, constrained inflation: free part, frictionless contact, stick with its history, deflation."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from mpi4py import MPI
from numpy.polynomial import chebyshev

from weakforms.errors import AbsentError, ConvergenceError, InputError, WeakformsError
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

BEYOND = 1e-6
"""By how much a patch may pass the end of its history, relative to that."""

SPANS, WIDER = 4, 1.02
"""Histories tried for a patch that outgrows them, and how much further the next one goes."""

HIGHEST_P = 20.0
"""Largest pressure at which inflation may end."""

PASSED = 0.1
"""By how much of ``p_end`` a step of deflation may pass ``p = 0``."""

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
    def inflated(self) -> EquilibriumBranch:
        """Free inflation up to first touch, as far as it goes."""
        return free_branch(self.slip.system, self.data.delta1, self._touch, self.step)

    @cached_property
    def free(self) -> EquilibriumBranch:
        """Free inflation up to first touch.

        Raises:
            AbsentError: When the law gives way, or locks, before.
            ConvergenceError: When the branch is not followed that far.
        """
        branch = self.inflated
        last = branch.points[-1]
        if last.monitors["u_max"] < self._touch:
            refused = f"tube: s = {self.data.s:g} is not touched: {branch.ended or branch.stalled}; "
            refused += f"lower s to less than {1 + max(p.monitors['u_max'] for p in branch.points):.6g}"
            if branch.ended:
                raise AbsentError("contact", refused)
            raise ConvergenceError(refused)
        branch.stalled = branch.ended = None
        branch.end_at("u_max", self._touch)
        return branch

    @cached_property
    def onset(self) -> Solved:
        """First touch."""
        last = self.free.points[-1]
        return Solved({**last.monitors, "p": last.state.loads["p"]}, last.state, "contact_onset")

    @property
    def untouched(self) -> str:
        """What ``p_end`` below first contact means, for people; empty when there is contact.

        Raises:
            ConvergenceError: When neither first contact nor ``p_end`` is reached.
            AbsentError: The same, where free inflation ends.
        """
        try:
            self.onset  # noqa: B018
        except WeakformsError as error:
            if max(point.state.loads["p"] for point in self.inflated.points) < self.p_end:
                raise
            return f"{error}; p_end = {self.p_end:g} is reached before"
        if self.onset.values["p"] < self.p_end:
            return ""
        first = self.onset.values["p"]
        higher = "raise p_end above it, or " if first < HIGHEST_P else ""
        below = f"tube: p_end = {self.p_end:g} is below first contact at p = {first:.6g}"
        return f"{below}; {higher}lower s (allowed: p_end up to {HIGHEST_P:g})"

    @cached_property
    def until_end(self) -> EquilibriumBranch:
        """Free inflation up to ``p_end``, where that is below first contact.

        Raises:
            InputError: When it is below the first state of a tube that is slack without pressure, too.
        """
        branch = free_branch(self.slip.system, self.data.delta1, self._touch, self.step)
        pressures = np.array([point.state.loads["p"] for point in branch.points])
        if pressures[0] >= self.p_end:
            raise InputError(
                f"tube: p_end = {self.p_end:g} is below p = {pressures[0]:.6g}, where a tube with "
                f"delta1 = {self.data.delta1:g} is first taut enough; raise p_end"
            )
        passed = int(np.argmax(pressures >= self.p_end))
        del branch.points[passed + 1 :]
        branch.stalled = branch.ended = None
        branch.end_at("p", self.p_end)
        return branch

    @cached_property
    def emptied(self) -> EquilibriumBranch:
        """The way back from there to ``p = 0``, or to where the tube is slack."""
        return self._deflated(self.slip, self.until_end.points[-1].state, self.data.delta1 < TAUT)

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
            followed = f"contact was followed up to p = {end.state.loads['p']:.6g}, not p_end = {p_end:g}"
            if branch.stalled:
                branch.stalled = f"{followed}: {branch.stalled}"
            else:
                full = f"there the patch holds {LAST_FRONT:g} of the tube's length"
                branch.ended = f"{followed}: {yielding(end) if yields(end) else full}; lower p_end"
        return branch

    # -- stick ---------------------------------------------------------------------------------

    @property
    def stick(self) -> ContactModel:
        """The stuck model with its history, as far as the patch grows."""
        return self._stuck[0]

    @property
    def adhesive(self) -> FittedBranch:
        """Adhesive inflation: every point that touched keeps its axial position."""
        return self._stuck[1]

    @cached_property
    def _stuck(self) -> tuple[ContactModel, FittedBranch]:
        """Find a history that covers the whole patch, which can grow larger than without friction.

        Raises:
            InputError: If contact without friction ends before ``p_end``.
            ConvergenceError: If no history covers the patch.
        """
        span = self._reached(self.frictionless).state.loads["front"]
        for _ in range(SPANS):
            model = self._with_history(span)
            branch = self._follow(model, stick_guess(model, self._first_slip()), self.p_end)
            crosses = len(branch.crossings("p", self.p_end))
            state = branch.at("p", self.p_end).state if crosses else branch.points[-1].state
            if state.loads["front"] <= span * (1 + BEYOND):
                return model, branch
            span = min(WIDER * state.loads["front"], LAST_FRONT * model.half)
        raise ConvergenceError(
            f"tube: the stuck patch grows beyond Z = {model.data.span:.6g}, up to which its history is "
            "known; lower p_end"
        )

    def _with_history(self, span: float) -> ContactModel:
        r"""A stuck model with its history up to a front.

        While the patch grows there is no line force at its front, so the position frozen there continues
        the free part with its slope: :math:`E'(z_f) = \eta'(z_f^+)` at every front. This condition is
        collocated at Chebyshev points ``z_j`` of the patch, and iterated: each sweep solves one front-fitted
        problem for each ``z_j`` with the last ``E``, and uses the slopes for the next sweep.

        Raises:
            ConvergenceError: If the sweeps do not converge.
        """
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
        ends = (trace.points[0].state, trace.points[-1].state)
        for end, beyond in zip(ends, (-1, 1), strict=True):
            if beyond * (front - end.loads["front"]) > 0:
                return trace.near(end, "front", front)
        return trace.at("front", front)

    def _reached(self, branch: FittedBranch) -> Solved:
        """The state at ``p_end``.

        Raises:
            InputError: When contact ends before.
            ConvergenceError: When the trace does.
        """
        if len(branch.crossings("p", self.p_end)):
            return branch.at("p", self.p_end)
        if branch.ended:
            raise InputError(f"tube: {branch.ended}")
        raise ConvergenceError(f"tube: {branch.stalled}; lower p_end")

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
        # With a spring that does not pull, a tube without pre-stretch goes slack, as a free one does.
        return self._deflated(model, state, self.data.unilateral and self.data.delta1 < TAUT)

    def _deflated(self, model: ContactModel, state: State, goes_slack: bool) -> EquilibriumBranch:
        """From a state at ``p_end`` to ``p = 0``."""
        solver = ExtendedNewton(model.system, ["p"])
        least = -PASSED * self.p_end
        continuation = Continuation(
            solver, control=self._steps(4), allowed=lambda state: state.loads["p"] > least
        )
        start = continuation.start(state, Held("p", self.p_end), towards={"p": -1.0})
        slack = FIRST_U if goes_slack else -np.inf

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
