"""All phases of a membrane against a substrate: inflation, free and in contact, with a patch that may stick.

What sticks is in the bond of the model and in its :class:`History`.
"""

from __future__ import annotations

from functools import cached_property
from math import inf

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.contact.guesses import moved, stick_guess
from weakforms.problems.contact.history import History
from weakforms.problems.contact.inflation import Inflation
from weakforms.problems.contact.model import PatchModel
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State

SPANS, SMALLER, LARGER = 24, 1.08, 1.15
"""Number of spans tried for a history that is not found, or that the patch outgrows, and by which factors
they change. Beyond its span a history is extrapolated; the branch serves as a guess for a larger span."""

BEYOND = 1e-6
"""By how much a patch may pass the end of its history, relative to that."""


class ContactPhases(Inflation):
    """All phases on one mesh; each is solved when it is first needed.

    Args:
        slip: The model without friction.
        p_end: Pressure at which inflation ends and deflation begins.
        step: Largest arc-length step.
        terms: Number of terms of the series of a stuck patch. It is refined together with the mesh, so that
            the uncertainties include the truncation error.
    """

    def __init__(self, slip: PatchModel, p_end: float, step: float, terms: int) -> None:
        super().__init__(slip, p_end, step)
        self.terms = terms

    def bonded(self, span: float) -> History:
        """The history, not yet solved for, of a model whose patch sticks."""
        raise NotImplementedError

    @property
    def stick(self) -> PatchModel:
        """The model whose patch sticks, with its history, up to the front reached.

        Raises:
            ConvergenceError: If no history is found.
        """
        return self.history.model

    @property
    def history(self) -> History:
        """The history of the stuck patch."""
        return self._stuck[0]

    @property
    def adhesive(self) -> FittedBranch:
        """Adhesive inflation: every point that touched keeps what the bond locks."""
        return self._stuck[1]

    @cached_property
    def _stuck(self) -> tuple[History, FittedBranch]:
        """Find a history that covers the whole patch, which can grow larger than without friction."""
        span, found, before = self._slipping_span(), 0.0, None
        for _ in range(SPANS):
            try:
                history = self._history(span, before)
            except ConvergenceError:  # a patch that sticks may not grow as far as one that slips
                span = (span + found) / 2 if found else span / SMALLER
                continue
            first = self.frictionless.points[0]
            begin = stick_guess(history.model, Solved(first.monitors, first.state))
            branch = self._follow(history.model, begin)
            farthest = max(point.state.loads["front"] for point in branch.points)
            passes = len(branch.crossings("p", self.p_end)) > 0
            reached = branch.at("p", self.p_end).state.loads["front"] if passes else farthest
            if reached <= span * (1 + BEYOND):
                if passes:  # the extrapolated history multiplies round-off by far
                    branch.end_at("p", self.p_end)
                return history, branch
            found, before, span = (
                span,
                branch,
                min(farthest, LARGER * span, self.last_front * self.data.length),
            )
        raise ConvergenceError(
            f"{self.name}: the history of the stuck patch is not found up to a front at "
            f"{span / self.data.length:.4g} of the {self.whole}; lower p_end, or k"
        )

    def _slipping_span(self) -> float:
        """The largest front without friction up to ``p_end``.

        Raises:
            AbsentError: If the law gives way before.
            InputError: If contact does not raise the pressure.
        """
        trace = self.frictionless
        crossed = trace.crossings("p", self.p_end)
        if not len(crossed):
            if self.gives_way(trace.points[-1]):
                raise AbsentError("contact up to p_end", trace.ended)
            if max(point.state.loads["p"] for point in trace.points[1:]) <= self.onset.values["p"]:
                trace.at("p", self.p_end)  # contact does not raise the pressure: says what is reached
            return max(point.state.loads["front"] for point in trace.points)
        before = max(point.state.loads["front"] for point in trace.points[: int(crossed[0]) + 1])
        return max(before, trace.at("p", self.p_end).state.loads["front"])

    def _history(self, span: float, before: FittedBranch | None) -> History:
        """A model whose patch sticks, and its history up to a front.

        Args:
            span: The front.
            before: A branch with a shorter history, for guesses; without one, frictionless states serve.

        Raises:
            ConvergenceError: If it is not found.
        """
        history = self.bonded(span)
        known = [self._known(float(front), history.model, before) for front in history.fronts]
        history.solve([state for state, _ in known], history.guess([solved for _, solved in known]))
        return history

    def _known(self, front: float, model: PatchModel, before: FittedBranch | None) -> tuple[State, Solved]:
        """A guess of the state with the edge of the stuck patch at a place, and what it is made of."""
        if before is not None and len(before.crossings("front", front)):
            solved = before.at("front", front)
            return solved.state, solved
        solved = self._slipped(front)
        return stick_guess(model, solved), solved

    def _slipped(self, front: float) -> Solved:
        """Frictionless contact with the edge of the patch at a place, even beyond the traced ones."""
        trace = self.frictionless
        first = trace.points[0].state
        last = max((point.state for point in trace.points), key=lambda state: state.loads["front"])
        if front > last.loads["front"]:
            return trace.near(last, "front", front)
        if front < first.loads["front"]:
            return trace.near(moved(self.slip, first, front), "front", front)
        return trace.at("front", front)

    @cached_property
    def end_of_inflation(self) -> State:
        """The adhesive state at ``p_end``.

        Raises:
            AbsentError: If contact ends before.
            ConvergenceError: If its trace does.
        """
        if len(self.adhesive.crossings("p", self.p_end)):
            return self.adhesive.at("p", self.p_end).state
        if self.adhesive.ended:
            raise AbsentError("contact up to p_end", self.adhesive.ended)
        raise ConvergenceError(f"{self.name}: {self.adhesive.stalled}; lower p_end")

    # -- deflation -----------------------------------------------------------------------------

    @property
    def deflations(self) -> tuple[str, ...]:
        """Names of the parts of the branch of deflation, in order."""
        return ("deflation",)

    @cached_property
    def deflation(self) -> EquilibriumBranch:
        """Deflation to ``p = 0`` with the patch reached at ``p_end``, which does not peel."""
        return self.lowered(0.0)

    def lowered(self, p: float, slack: float = -inf) -> EquilibriumBranch:
        """Deflation down to a pressure."""
        return self._deflated(self.stick, self.end_of_inflation, p, slack)
