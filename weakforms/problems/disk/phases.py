"""Paper 1 on one mesh: free, frictionless and adhesive inflation, deflation, peeling."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from mpi4py import MPI
from scipy.interpolate import CubicSpline

from weakforms.errors import InputError
from weakforms.problems.disk.history import History
from weakforms.problems.disk.model import Bond, DiskData, DiskModel
from weakforms.problems.homogeneous.material_point import evaluated
from weakforms.problems.material_choice import Chosen
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch, Solved
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import State

FIRST_T0 = 0.05
"""Pole height of the first state of a disk without pre-stretch, whose tangent at rest is singular."""

TAUT = 1.02
"""Pre-stretch above which the branch starts at ``p = 0``."""

FREE_FRONT = 0.5
"""Position at which the free membrane's mesh is divided, as a fraction of its radius; it is arbitrary."""

USUAL = 10.0
"""Pressure up to which the usual step is used; at large pre-stretch the pressure dominates the arc length."""

FIRST_FRONT = 0.02
"""Smallest front at which contact is followed, as a fraction of the radius."""

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
        """State of first contact.

        Raises:
            InputError: If it comes after the pressure at which inflation ends.
        """
        last = self.before_contact.points[-1]
        solved = Solved({**last.monitors, "p": last.state.loads["p"]}, last.state, "contact_onset")
        if solved.values["p"] >= self.p_end:
            raise InputError(
                f"circular: p_end = {self.p_end:g} is below first contact at p = {solved.values['p']:.6g}; "
                "raise p_end above it, or choose a smaller l or beta"
            )
        return solved

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

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["p"] > p_end or point.state.loads["front"] > last

        branch = FittedBranch(continuation, "p", start, stop)
        if branch.points[-1].state.loads["p"] < p_end and branch.stalled is None:
            branch.stalled = f"the front reaches {LAST_FRONT:g} of the radius before p = {p_end:g}"
        return branch

    # -- stick ---------------------------------------------------------------------------------

    @cached_property
    def stick(self) -> DiskModel:
        """The model with the bond and its history, up to a front beyond that at ``p_end``.

        Raises:
            ConvergenceError: If the history does not converge.
        """
        span = self.frictionless.at("p", self.p_end).state.loads["front"]
        bond = Bond(self.adhesion == "locked", self.terms, span)
        model = DiskModel(self.comm, self.data, bond)
        history = History(model)
        slipped = self._slipped(history.fronts)
        lam2 = np.array([v.values["rho_contact"] for v in slipped]) / history.fronts
        steepness = np.array([v.values["steepness"] for v in slipped])
        guesses = [stick_guess(model, v.state, start) for v, start in zip(slipped, lam2, strict=True)]
        history.solve(guesses, lam2, steepness)
        return model

    def _slipped(self, fronts: np.ndarray) -> list[Solved]:
        """Frictionless states at some fronts, as guesses."""
        first = self.frictionless.points[0].state
        solver = ExtendedNewton(self.slip.system, ["p", "front"])
        solved = []
        for front in fronts:
            if front > first.loads["front"]:
                solved.append(self.frictionless.at("front", float(front)))
                continue
            held = [Held("gap", 0.0), Held("front", float(front))]
            state, _ = solver.solve(self._moved(first, float(front)), held)
            self.slip.system.set_state(state.u, state.loads)
            solved.append(Solved(self.slip.system.monitors(), state))
        return solved

    @cached_property
    def adhesive(self) -> FittedBranch:
        """Adhesive inflation: every point that touched keeps its stretches, or its radius."""
        first = self.frictionless.points[0]
        lam2 = first.monitors["rho_contact"] / first.state.loads["front"]
        return self._follow(self.stick, stick_guess(self.stick, first.state, lam2), self.p_end)

    @cached_property
    def end_of_inflation(self) -> State:
        """The adhesive state at ``p_end``."""
        return self.adhesive.at("p", self.p_end).state

    @cached_property
    def deflation(self) -> EquilibriumBranch:
        """Deflation to ``p = 0`` with the patch reached at ``p_end``, which does not peel."""
        return self.lowered(0.0)

    def lowered(self, p: float) -> EquilibriumBranch:
        """Deflation down to a given pressure."""
        solver = ExtendedNewton(self.stick.system, ["p"])
        continuation = Continuation(solver, control=self.steps(4))
        held = Held("p", self.p_end)
        start = continuation.start(self.end_of_inflation, held, towards={"p": -1.0})
        return EquilibriumBranch(continuation, "p", start, lambda point: point.state.loads["p"] < p)

    def steps(self, fraction: int) -> StepControl:
        """Step control that starts with a fraction of the largest step."""
        return StepControl(first=self.step / fraction, largest=self.step, usual_load=USUAL)


def parabola(x: np.ndarray, law: Chosen, beta: float) -> tuple[np.ndarray, float]:
    """A slightly stretched first state of pole height ``FIRST_T0``, and the pressure it carries.

    Args:
        x: Radius of every degree of freedom, ``lam2`` and ``eta`` in turn.
        law: Material law.
        beta: Pre-stretch.
    """
    lam = beta + 0.3 * FIRST_T0**2
    square = (x * beta) ** 2
    u = np.empty_like(x)
    u[0::2] = beta + (lam - beta) * (1 - square[0::2])
    u[1::2] = FIRST_T0 * (1 - square[1::2])
    tension = evaluated(law, lam, lam)["W1"]
    return u, 4 * FIRST_T0 * tension / beta


def stick_guess(model: DiskModel, slipped: State, lam2_front: float) -> State:
    """A frictionless state as a guess for the stuck model with the same mesh and front."""
    s = np.repeat(model.space.tabulate_dof_coordinates()[: model.system.size // 2, 0], 2)
    u = slipped.u.copy()
    stretch = np.arange(len(u)) % 2 == 0
    outside = s > 1 + 1e-12
    u[stretch & ~outside] = 0.0
    # Shifted by its own stretch at the front; the stretch of the series differs and would cause a jump.
    u[stretch & outside] -= (lam2_front * (2 - s))[stretch & outside]
    if model.bond.rigid:
        u[~stretch & ~outside] = model.data.l
    return State(u, dict(slipped.loads))
