"""A membrane inflated against a substrate without friction: free up to first touch, then in contact."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from math import inf
from typing import ClassVar

import numpy as np

from weakforms.errors import AbsentError, ConvergenceError, InputError, WeakformsError
from weakforms.problems.contact.model import PatchModel
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch, MirroredBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import Constraint, ExtendedNewton
from weakforms.solvers.equilibrium.state import State

SOFTEST = -5.0
"""Power of ten by which springs are softened at first, if the first state in contact is not found."""

STIFF = 1e-3
"""Fraction of the way to the substrate below which a nearer substrate is no advice."""

PASSED = 0.1
"""By how much of ``p_end`` a step of deflation may pass its last pressure."""


class Inflation:
    """Inflation on one mesh; each phase is solved when it is first needed.

    What differs between bodies is in a subclass: first states, guesses, and where a branch ends.

    Args:
        slip: The model without friction.
        p_end: Pressure at which inflation ends and deflation begins.
        step: Largest arc-length step.
    """

    name: ClassVar[str]
    """Name of the problem."""
    depth: ClassVar[str]
    """Functional that grows along free inflation; at first contact it has the value ``data.touch``."""
    place: ClassVar[tuple[str, float]]
    """Parameter that says where the substrate is, and its value if the undeformed membrane touches."""
    nearer: ClassVar[str]
    """How the substrate is touched at a lower pressure, as text."""
    whole: ClassVar[str]
    """What the largest possible patch covers, as text."""
    highest_p: ClassVar[float]
    """Largest allowed ``p_end``."""
    first_front: ClassVar[float]
    last_front: ClassVar[float]
    """Smallest and largest front at which contact is followed, over ``data.length``."""
    usual_load: ClassVar[float] = inf
    """Pressure up to which the usual step is used."""

    def __init__(self, slip: PatchModel, p_end: float, step: float) -> None:
        self.slip, self.data, self.p_end, self.step = slip, slip.data, p_end, step

    # -- what depends on the body --------------------------------------------------------------

    def inflate(self, depth: float) -> EquilibriumBranch:
        """Free inflation up to a value of the functional :attr:`depth`, as far as it goes."""
        raise NotImplementedError

    def small_patch(self) -> State:
        """A guess of the first state in contact, with its springs."""
        raise NotImplementedError

    def gives_way(self, _point: CurvePoint) -> str:
        """Why there is no solution beyond a point, as text; empty if there may be one."""
        return ""

    @property
    def slack(self) -> float:
        """Value of :attr:`depth` below which the free membrane is slack."""
        return -inf

    # -- free ----------------------------------------------------------------------------------

    @cached_property
    def inflated(self) -> EquilibriumBranch:
        """Free inflation up to first touch, as far as it goes."""
        return self.inflate(self.data.touch)

    @cached_property
    def free(self) -> EquilibriumBranch:
        """Free inflation up to first touch.

        Raises:
            AbsentError: If the law gives way, or locks, before.
            ConvergenceError: If the branch is not followed that far.
        """
        branch = self.inflated
        if branch.points[-1].monitors[self.depth] < self.data.touch:
            (place, rest), why = self.place, branch.ended or branch.stalled
            deepest = max(point.monitors[self.depth] for point in branch.points)
            nearer = f"lower {place} to less than {rest + deepest:.6g}"
            softer = "choose less pre-stretch, or constants of the law with which it stiffens less"
            refused = f"{self.name}: {place} = {rest + self.data.touch:g} is not touched: {why}; "
            refused += nearer if deepest > STIFF * self.data.touch else softer
            if branch.ended:
                raise AbsentError("contact", refused)
            raise ConvergenceError(refused)
        branch.stalled = branch.ended = None
        branch.end_at(self.depth, self.data.touch)
        return branch

    @cached_property
    def onset(self) -> Solved:
        """First touch."""
        last = self.free.points[-1]
        loads = {name: last.state.loads[name] for name in self.free.loads}
        return Solved({**last.monitors, **loads}, last.state, "contact_onset")

    @property
    def highest(self) -> float:
        """Largest pressure of free inflation, as far as it goes."""
        return highest(self.inflated)

    @property
    def untouched(self) -> str:
        """What ``p_end`` below first contact means, as text; empty if there is contact.

        Raises:
            ConvergenceError: If neither first contact nor ``p_end`` is reached.
            AbsentError: The same, if free inflation ends.
        """
        try:
            first = self.onset.values["p"]
        except WeakformsError as error:
            if self.highest < self.p_end:
                raise
            reason = str(error).removeprefix(f"{self.name}: ")
            return f"{reason}; p_end = {self.p_end:g} is reached before"
        if first < self.p_end:
            return ""
        higher = "raise p_end above it, or " if first < self.highest_p else ""
        below = f"p_end = {self.p_end:g} is below first contact at p = {first:.6g}"
        return f"{below}; {higher}{self.nearer} (allowed: p_end up to {self.highest_p:g})"

    @cached_property
    def until_end(self) -> EquilibriumBranch:
        """Free inflation up to ``p_end``, if that is below first contact.

        Raises:
            InputError: If it is below the first state of a membrane that is slack without pressure, too.
        """
        return self._until_end(self.inflate(self.data.touch))

    def _until_end(self, branch: EquilibriumBranch) -> EquilibriumBranch:
        pressures = np.array([point.state.loads["p"] for point in branch.points])
        if pressures[0] >= self.p_end:
            raise InputError(
                f"{self.name}: p_end = {self.p_end:g} is below p = {pressures[0]:.6g}, where the membrane "
                "is first taut enough at this pre-stretch; raise p_end"
            )
        passed = int(np.argmax(pressures >= self.p_end))
        del branch.points[passed + 1 :]
        branch.stalled = branch.ended = None
        branch.end_at("p", self.p_end)
        return branch

    @cached_property
    def emptied(self) -> EquilibriumBranch:
        """The way back from there to ``p = 0``, or to where the membrane is slack."""
        return self._deflated(self.slip, self.until_end.points[-1].state, 0.0, self.slack)

    # -- contact -------------------------------------------------------------------------------

    @cached_property
    def frictionless(self) -> FittedBranch:
        """Frictionless contact, with the front as an unknown besides the pressure."""
        return self._follow(self.slip, self.small_patch())

    def _follow(
        self,
        model: PatchModel,
        state: State,
        start: Callable[[Continuation], CurvePoint] | None = None,
    ) -> FittedBranch:
        """Contact from a guess of the first state with the smallest patch, or from any other start."""
        length, signs = self.data.length, {name: sign for name, (_, sign) in model.edges.items()}
        continuation = Continuation(
            ExtendedNewton(model.system, ["p", *model.edges]),
            [Held(gap, 0.0) for gap, _ in model.edges.values()],
            self.steps(16),
            allowed=lambda state: all(0 < sign * state.loads[n] < length for n, sign in signs.items()),
        )

        def ends(point: CurvePoint) -> str:
            if point.state.loads["front"] > self.last_front * length:
                return f"there the patch holds {self.last_front:g} of the {self.whole}"
            if model.bond is not None and point.tangent.loads["front"] < 0:
                return "there the patch stops growing, and what sticks would have to peel"
            return self.gives_way(point)

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["p"] > self.p_end or bool(ends(point))

        kind = FittedBranch if len(signs) == 1 else MirroredBranch
        first = start(continuation) if start else self._first_contact(continuation, state)
        branch = kind(continuation, "p", first, stop)
        end = branch.points[-1]
        reached = end.state.loads["p"]
        if reached < self.p_end:
            followed = f"contact was followed up to p = {reached:.6g}, not p_end = {self.p_end:g}"
            if branch.stalled and not ends(end):
                branch.stalled = f"{followed}: {branch.stalled}"
            else:
                branch.stalled = None
                branch.ended = f"{self.name}: {followed}: {ends(end)}; lower p_end"
        return branch

    def _first_contact(self, continuation: Continuation, state: State) -> CurvePoint:
        """The state with the smallest patch, from a guess of it.

        Raises:
            InputError: If its pressure is ``p_end`` already.
        """
        first = Held("front", self.first_front * self.data.length)
        try:
            start = continuation.start(state, first, towards={"front": 1.0})
        except ConvergenceError:
            state = self._stiffened(continuation.solver, state, [*continuation.fixed, first])
            start = continuation.start(state, first, towards={"front": 1.0})
        least = start.state.loads["p"]
        if least >= self.p_end:
            raise InputError(
                f"{self.name}: p_end = {self.p_end:g} is too close above first contact at p = "
                f"{self.onset.values['p']:.8g}; raise it to more than {least:.8g}"
            )
        return start

    @staticmethod
    def _stiffened(solver: ExtendedNewton, state: State, constraints: Sequence[Constraint]) -> State:
        """The first state in contact, from one with soft springs, which are then stiffened in steps.

        Against stiff springs, Newton's method leads from the free membrane to stretches that no law allows.
        """
        stiff = state.loads["k"]

        def solve(before: State, power: float) -> State:
            guess = State(before.u, before.loads | {"k": stiff * 10**power})
            return solver.solve(guess, constraints)[0]

        return walk(solve, solve(state, SOFTEST), SOFTEST, 0.0, 1.0)

    # -- steps and the way back --------------------------------------------------------------

    def _deflated(
        self, model: PatchModel, state: State, p: float, slack: float, begin: Held | None = None
    ) -> EquilibriumBranch:
        """From a state, at ``p_end`` or as given, down to a pressure, or to where the membrane is slack."""
        # A long step, of a large load, must not pass the last pressure by much.
        least = p - PASSED * self.p_end
        continuation = Continuation(
            ExtendedNewton(model.system, ["p"]),
            control=self.steps(4),
            allowed=lambda state: state.loads["p"] > least,
        )
        start = continuation.start(state, begin or Held("p", self.p_end), towards={"p": -1.0})

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["p"] < p or point.monitors[self.depth] < slack

        return EquilibriumBranch(continuation, "p", start, stop)

    def steps(self, fraction: int) -> StepControl:
        """Step control that starts with a fraction of the largest step."""
        return StepControl(self.step / fraction, self.step, usual_load=self.usual_load)


def highest(branch: SolutionCurve) -> float:
    """Largest pressure at the points of a trace."""
    return max(point.state.loads["p"] for point in branch.points)
