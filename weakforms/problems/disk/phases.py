"""Paper 1 on one mesh: free, frictionless and adhesive inflation, deflation, peeling."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from mpi4py import MPI
from scipy.interpolate import CubicSpline

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.disk.guesses import FIRST_T0, HIGHEST_P, parabola, stick_guess
from weakforms.problems.disk.history import STIFFER, History
from weakforms.problems.disk.model import Bond, DiskData, DiskModel
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch, Solved
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import State

TAUT = 1.02
"""Pre-stretch above which the branch starts at ``p = 0``."""

FREE_FRONT = 0.5
"""Position at which the free membrane's mesh is divided, as a fraction of its radius; it is arbitrary."""

USUAL = 10.0
"""Pressure up to which the usual step is used; at large pre-stretch the pressure dominates the arc length."""

FIRST_FRONT = 0.02
"""Smallest front at which contact is followed, as a fraction of the radius."""

SOFT = 2.0
"""Stiffness of a soft substrate, over the pressure of first contact and its height."""

SPANS, WIDER = 6, 1.02
"""Spans tried for a history that the patch outgrows, or that is not found, and by how much they change."""

PASSED = 0.1
"""By how much of ``p_end`` a step of deflation may pass its last pressure."""

LAST_FRONT = 0.97
"""Largest front at which contact is followed."""


class DiskRun:
    """All phases of the disk on one mesh; each is solved when it is first needed.

    Args:
        comm: Ranks.
        data: Membrane, substrate and mesh.
        adhesion: ``locked`` (both stretches stick) or ``radial`` (only the radius does).
        p_end: Pressure at which inflation against the substrate ends.
        step: Largest arc-length step.
        terms: Number of terms of the stuck patch's series. It is refined together with the mesh, so that the
            uncertainties include the truncation error.
    """

    def __init__(
        self, comm: MPI.Intracomm, data: DiskData, adhesion: str, p_end: float, step: float, terms: int
    ) -> None:
        self.comm, self.data, self.adhesion = comm, data, adhesion
        self.p_end, self.step, self.terms = p_end, step, terms
        self.coarser: DiskRun | None = None
        """The run on the next coarser mesh, if there is one: its history is a guess."""
        self.slip = DiskModel(comm, data)
        self._flat = self.slip.system.state()
        """Start of every branch; it is kept, because each run changes the state of its system."""

    # -- free and frictionless -----------------------------------------------------------------

    def free(self, t_end: float) -> EquilibriumBranch:
        """Free inflation up to a pole height."""
        solver = ExtendedNewton(self.slip.system, ["p"])
        front = FREE_FRONT * self.data.edge
        state = State(self._flat.u.copy(), self._flat.loads | {"front": front})
        held = Held("p", 0.0)
        if self.data.beta < TAUT:
            state, held = self._first_guess(state), Held("t0", FIRST_T0)
        continuation = Continuation(solver, control=self.steps(8))
        start = continuation.start(state, held, towards={"t0": 1.0})
        return EquilibriumBranch(continuation, "p", start, stop=lambda q: q.monitors["t0"] > t_end)

    def _first_guess(self, state: State) -> State:
        u, p = parabola(self._radii(state), self.data.chosen, self.data.beta)
        return State(u, state.loads | {"p": p})

    def _radii(self, state: State) -> np.ndarray:
        """``x`` of every degree of freedom of this rank."""
        s = np.repeat(self.slip.space.tabulate_dof_coordinates()[: self.slip.system.size // 2, 0], 2)
        front, edge = state.loads["front"], self.data.edge
        return np.where(s <= 1, front * s, front * (edge / front) ** (s - 1))

    def _moved(self, state: State, front: float) -> State:
        """A guess for the same membrane on a differently divided mesh, by splines through nodal values."""
        new = State(state.u.copy(), state.loads | {"front": front})
        old, wanted = self._radii(state), self._radii(new)
        for component in (slice(0, None, 2), slice(1, None, 2)):
            pairs = self.comm.allgather((old[component], state.u[component]))
            x, first = np.unique(np.concatenate([p[0] for p in pairs]), return_index=True)
            values = np.concatenate([p[1] for p in pairs])[first]
            new.u[component] = CubicSpline(x, values)(wanted[component])
        return new

    @cached_property
    def before_contact(self) -> EquilibriumBranch:
        """Free inflation up to first touch."""
        branch = self.free(self.data.l)
        branch.end_at("t0", self.data.l)
        return branch

    @cached_property
    def onset(self) -> Solved:
        """First touch."""
        last = self.before_contact.points[-1]
        return Solved({**last.monitors, "p": last.state.loads["p"]}, last.state, "contact_onset")

    @property
    def untouched(self) -> str:
        """What ``p_end`` below first contact means, for people; empty when there is contact."""
        if self.onset.values["p"] < self.p_end:
            return ""
        first = self.onset.values["p"]
        higher = "raise p_end above it, or " if first < HIGHEST_P else ""
        below = f"p_end = {self.p_end:g} is below first contact at p = {first:.6g}"
        return f"{below}; {higher}choose a smaller l or beta (allowed: p_end up to {HIGHEST_P:g})"

    @cached_property
    def until_end(self) -> EquilibriumBranch:
        """Free inflation up to ``p_end``, where that is below first contact.

        Raises:
            InputError: When it is below the first state of a disk that is slack without pressure, too.
        """
        branch = self.free(self.data.l)
        pressures = np.array([point.state.loads["p"] for point in branch.points])
        if pressures[0] >= self.p_end:
            raise InputError(
                f"circular: p_end = {self.p_end:g} is below p = {pressures[0]:.6g}, where a disk with "
                f"beta = {self.data.beta:g} is first taut enough; raise p_end"
            )
        passed = int(np.argmax(pressures >= self.p_end))
        del branch.points[passed + 1 :]
        branch.end_at("p", self.p_end)
        return branch

    @cached_property
    def emptied(self) -> EquilibriumBranch:
        """The way back from there to ``p = 0``, or to where the disk is slack."""
        continuation = self._deflating(ExtendedNewton(self.slip.system, ["p"]), 0.0)
        end = self.until_end.points[-1].state
        start = continuation.start(end, Held("p", self.p_end), towards={"p": -1.0})
        slack = FIRST_T0 if self.data.beta < TAUT else -np.inf

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["p"] < 0.0 or point.monitors["t0"] < slack

        return EquilibriumBranch(continuation, "p", start, stop)

    @cached_property
    def frictionless(self) -> FittedBranch:
        """Frictionless contact, with the front as an unknown besides the pressure."""
        return self._follow(self.slip, self._small_front(), self.p_end)

    def _small_front(self) -> State:
        """The membrane at first touch, on the mesh of a small patch, with springs."""
        solver = ExtendedNewton(self.slip.system, ["p"])
        guess = self._moved(self.onset.state, FIRST_FRONT * self.data.edge)
        state, _ = solver.solve(guess, [Held("t0", self.data.l)])
        state.loads["k"] = self.data.k
        return state

    def _follow(self, model: DiskModel, state: State, p_end: float) -> FittedBranch:
        solver = ExtendedNewton(model.system, ["p", "front"])
        continuation = Continuation(solver, [Held("gap", 0.0)], self.steps(16))
        first = Held("front", FIRST_FRONT * self.data.edge)
        start = continuation.start(state, first, towards={"front": 1.0})
        last = LAST_FRONT * self.data.edge

        def ends(point: CurvePoint) -> str:
            if point.state.loads["front"] > last:
                return f"the patch holds {LAST_FRONT:g} of the radius"
            shrinks = model.bond is not None and point.tangent.loads["front"] < 0
            return "the patch stops growing, and what sticks would have to peel" if shrinks else ""

        branch = FittedBranch(continuation, "p", start, lambda q: q.state.loads["p"] > p_end or bool(ends(q)))
        end = branch.points[-1]
        if end.state.loads["p"] < p_end and ends(end):
            branch.ended = (
                f"circular: contact was followed up to p = {end.state.loads['p']:.6g}, not "
                f"p_end = {p_end:g}: there {ends(end)}; lower p_end"
            )
        return branch

    # -- stick ---------------------------------------------------------------------------------

    @property
    def stick(self) -> DiskModel:
        """The model with the bond and its history, up to the front reached.

        Raises:
            ConvergenceError: If the history does not converge.
        """
        return self._stuck[0]

    @property
    def history(self) -> History:
        """Of the stuck patch."""
        return self._stuck[1]

    @property
    def adhesive(self) -> FittedBranch:
        """Adhesive inflation: every point that touched keeps its stretches, or its radius."""
        return self._stuck[2]

    @cached_property
    def _stuck(self) -> tuple[DiskModel, History, FittedBranch]:
        """Find a history that covers the whole patch, which can grow larger than without friction."""
        span, failed = self._slipping_span(), np.inf
        for _ in range(SPANS):
            model = DiskModel(self.comm, self.data, Bond(self.adhesion == "locked", self.terms, span))
            try:
                history = self._history_of(model)
            except ConvergenceError:
                failed, span = span, span / WIDER**4  # a patch that sticks may not grow so far
                continue
            first = self.frictionless.points[0]
            lam2 = first.monitors["rho_contact"] / first.state.loads["front"]
            branch = self._follow(model, stick_guess(model, first.state, lam2), self.p_end)
            if len(branch.crossings("p", self.p_end)):
                reached = branch.at("p", self.p_end).state.loads["front"]
            else:
                reached = max(point.state.loads["front"] for point in branch.points)
            if reached <= span:
                return model, history, branch
            span = min(WIDER * reached, LAST_FRONT * self.data.edge)
            if span >= failed:
                break
        raise ConvergenceError(
            f"circular: the history of the stuck patch is not found up to X = {span * self.data.beta:.4g}; "
            "lower p_end, or k"
        )

    def _slipping_span(self) -> float:
        """The largest front without friction up to ``p_end``."""
        trace = self.frictionless
        crossed = trace.crossings("p", self.p_end)
        if not len(crossed):
            if max(point.state.loads["p"] for point in trace.points[1:]) <= self.onset.values["p"]:
                trace.at("p", self.p_end)  # contact does not raise the pressure: says what is reached
            return max(point.state.loads["front"] for point in trace.points)
        before = max(point.state.loads["front"] for point in trace.points[: int(crossed[0]) + 1])
        return max(before, trace.at("p", self.p_end).state.loads["front"])

    def _history_of(self, model: DiskModel) -> History:
        """The history of a model, whose series are written."""
        history = History(model)
        slipped = self._slipped(history.fronts)
        try:
            history.solve(*self._guesses(model, slipped, history.fronts))
        except ConvergenceError:
            self._solve_stiff(model, history, slipped)
        return history

    def _solve_stiff(self, model: DiskModel, history: History, slipped: list[Solved]) -> None:
        """The history where plain sweeps diverge: from that of the coarser mesh, or of a soft substrate."""
        if self.coarser is not None:
            history.solve_like(self.coarser.history)
        else:
            soft = SOFT * self.onset.values["p"] / self.data.l
            if soft >= self.data.k:
                raise ConvergenceError("history of the stuck patch: sweeps diverge on a soft substrate")
            softened = [self._softened(v.state, soft) for v in slipped]
            history.solve_stiff(*self._guesses(model, softened, history.fronts), self.data.k)

    def _guesses(
        self, model: DiskModel, slipped: list[Solved], fronts: np.ndarray
    ) -> tuple[list[State], np.ndarray, np.ndarray]:
        """States at the fronts, their hoop stretches and steepness, as guesses for a stuck patch."""
        lam2 = np.array([v.values["rho_contact"] for v in slipped]) / fronts
        steepness = np.array([v.values["steepness"] for v in slipped])
        return [stick_guess(model, v.state, at) for v, at in zip(slipped, lam2, strict=True)], lam2, steepness

    def _softened(self, state: State, k: float) -> Solved:
        """A frictionless state with its front where it is, on a softer substrate."""
        solver = ExtendedNewton(self.slip.system, ["p", "front"])
        held = [Held("gap", 0.0), Held("front", state.loads["front"])]

        def solve(before: State, log_k: float) -> State:
            return solver.solve(State(before.u, before.loads | {"k": float(np.exp(log_k))}), held)[0]

        state = walk(solve, state, float(np.log(self.data.k)), float(np.log(k)), STIFFER)
        self.slip.system.set_state(state.u, state.loads)
        return Solved(self.slip.system.monitors(), state)

    def _slipped(self, fronts: np.ndarray) -> list[Solved]:
        """Frictionless states at some fronts, as guesses."""
        first = self.frictionless.points[0].state
        last = max(
            (point.state for point in self.frictionless.points), key=lambda state: state.loads["front"]
        )
        solver = ExtendedNewton(self.slip.system, ["p", "front"])
        solved = []
        for front in fronts:
            if front > last.loads["front"]:
                solved.append(self.frictionless.near(last, "front", float(front)))
                continue
            if front > first.loads["front"]:
                solved.append(self.frictionless.at("front", float(front)))
                continue
            held = [Held("gap", 0.0), Held("front", float(front))]
            state, _ = solver.solve(self._moved(first, float(front)), held)
            self.slip.system.set_state(state.u, state.loads)
            solved.append(Solved(self.slip.system.monitors(), state))
        return solved

    @cached_property
    def end_of_inflation(self) -> State:
        """The adhesive state at ``p_end``.

        Raises:
            InputError: When contact ends before.
            ConvergenceError: When its trace does.
        """
        if len(self.adhesive.crossings("p", self.p_end)):
            return self.adhesive.at("p", self.p_end).state
        if self.adhesive.ended:
            raise InputError(self.adhesive.ended)
        raise ConvergenceError(f"p_end = {self.p_end:g} is not reached: {self.adhesive.stalled}")

    @cached_property
    def deflation(self) -> EquilibriumBranch:
        """Deflation to ``p = 0`` with the patch reached at ``p_end``, which does not peel."""
        return self.lowered(0.0)

    def lowered(self, p: float) -> EquilibriumBranch:
        """Deflation down to a given pressure."""
        solver = ExtendedNewton(self.stick.system, ["p"])
        continuation = self._deflating(solver, p)
        held = Held("p", self.p_end)
        start = continuation.start(self.end_of_inflation, held, towards={"p": -1.0})
        return EquilibriumBranch(continuation, "p", start, lambda point: point.state.loads["p"] < p)

    def _deflating(self, solver: ExtendedNewton, end: float) -> Continuation:
        """Steps that do not pass the last pressure by much; those of a large load are long."""
        least = end - PASSED * self.p_end
        return Continuation(solver, control=self.steps(4), allowed=lambda state: state.loads["p"] > least)

    def steps(self, fraction: int) -> StepControl:
        """Step control that starts with a fraction of the largest step."""
        return StepControl(first=self.step / fraction, largest=self.step, usual_load=USUAL)
