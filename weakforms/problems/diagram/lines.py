"""The critical points of a primary branch, and the lines through them in a plane, on one mesh."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.diagram.followed import Followed, Part
from weakforms.problems.diagram.window import INSIDE, Window
from weakforms.problems.disk.phases import USUAL_LOAD
from weakforms.solvers.continuation.continuation import CurvePoint, StepControl
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.continuation.line import (
    CUSP,
    Bracket,
    CriticalLine,
    LineContinuation,
    Meeting,
    Turning,
    singular_too,
    tips,
    zeros_of,
)
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import Constraint, ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import OwnVariation, SecondVariation, Singular, nearest_to_zero
from weakforms.solvers.stability.spectra import Stability

SAME = 1e-3
"""Relative distance from an interpolated line within which a critical point lies on it."""

UNLOADED = 1e-9
"""Hoop resultant below which a tube that is only stretched counts as taut, whatever the sign of round-off."""

STEPS = 60
"""Number of steps over the range of a parameter that is long compared with the usual step."""

LOOP = 4.0
"""Number of steps after which a line that comes within a step of its first point is closed."""

ORDER = ("fold", "mirror", "localisation", "n1", "n2", "n3").index
"""Order of two kinds in the name of a point that is of both."""

Operator = Callable[[], SecondVariation]
"""Returns a second variation outside of the unknowns' symmetry, at the state that the base is lent to."""


@dataclass(frozen=True)
class Seed:
    """The ``index``-th critical point of a kind along the primary branch, where the parameter has a value."""

    kind: str
    at: float
    index: int


class LinesOnMesh:
    """Primary branches and lines of one membrane on one mesh.

    Args:
        model: The weak form.
        window: The part of the plane.
        touch: Value of the column ``depth`` at first contact.
        step: Largest arc-length step.
        broken: Kinds of broken symmetry that are looked for on lines of other kinds.
    """

    def __init__(
        self,
        model: Followed,
        window: Window,
        touch: float,
        step: float,
        broken: Sequence[str] = ("mirror",),
    ) -> None:
        self.model, self.window, self.touch, self.step = model, window, touch, step
        self.broken = tuple(broken)
        self.system, self.depth = model.system, model.depth
        self._branches: dict[float, Sequence[SolutionCurve]] = {}
        self._lines: dict[Seed, CriticalLine] = {}
        self.failed: dict[tuple[str, float], str] = {}
        """Kinds and values of the parameter at which no critical point could be searched, and why."""

    def parts(self, at: float) -> Sequence[SolutionCurve]:
        """The primary branch where the parameter has a value."""
        if at not in self._branches:
            self.system.initial.loads[self.window.vary] = at
            found = self.model.primary(self.window.end, self.step)
            self._branches[at] = [found] if isinstance(found, SolutionCurve) else found
        return self._branches[at]

    # -- critical points of the primary branch ---------------------------------------------------

    def starts(self, kind: str, at: float) -> list[State]:
        """The critical points of a kind in the window, in order along the primary branch.

        The branch's last step may pass the largest displacement.
        """
        broken = self.model.operators(kind).values()
        found = []
        for branch in self.parts(at):
            if broken:
                states = [state for form in broken for state in self._neutral(branch, form)]
                states.sort(key=lambda state: self._place_of(state)[0])
            else:
                states = getattr(self, f"_{kind}")(branch)
            found += [state for state in states if not self._outside(state)]
        return found

    def seeds(self, kind: str, places: Sequence[float]) -> list[Seed]:
        """One critical point for each line that crosses a primary branch at one of some values.

        Where the search or a line does not converge, :attr:`failed` says so; the other values are searched.
        """
        seeds: list[Seed] = []
        for at in dict.fromkeys(places):
            try:
                for index, state in enumerate(self.starts(kind, at)):
                    if not any(self.has(self.line(seed), state) for seed in seeds):
                        self.line(Seed(kind, at, index))
                        seeds.append(Seed(kind, at, index))
            except ConvergenceError as error:
                self.failed[kind, at] = str(error)
        return seeds

    def _fold(self, branch: SolutionCurve) -> list[State]:
        return [found.state for found in branch.special() if found.kind == "limit_point"]

    def _neutral(self, branch: SolutionCurve, form: Operator) -> list[State]:
        """Points at which a second variation outside of the unknowns' symmetry is singular."""

        def count(state: State) -> int:
            with self.system.at(state):
                return form().negative_count()

        counts = [count(point.state) for point in branch.points]
        found = []
        for i in np.flatnonzero(np.diff(counts)).tolist():
            guess = branch.between(i, branch.narrowed(i, count, counts[i], counts[i + 1]))
            with self.system.at(guess):
                border = form().mass_times(form().highest_negative().vector)
            found.append(self._solved(branch, i, guess, Singular(form, border)))
        return found

    def _contact(self, branch: SolutionCurve) -> list[State]:
        count = len(branch.crossings(self.depth, self.touch))
        return [branch.at(self.depth, self.touch, k + 1).state for k in range(count)]

    def _end(self, branch: SolutionCurve) -> list[State]:
        """The largest displacement, which closes the regions of a diagram."""
        found = branch.crossings(self.depth, self.window.end)
        return [branch.at(self.depth, self.window.end).state] if len(found) else []

    def _wrinkling(self, branch: SolutionCurve) -> list[State]:
        margins = np.array([point.monitors["t_min"] for point in branch.points])
        margins[np.abs(margins) < UNLOADED] = 0.0
        found = []
        for i in np.flatnonzero(margins[:-1] * margins[1:] < 0).tolist():
            guess = branch.between(i, margins[i] / (margins[i] - margins[i + 1]))
            if isinstance(self.model.least, Turning):
                with self.system.at(guess):
                    self.model.least.turn()
            found.append(self._solved(branch, i, guess, self.model.least))
        return found

    def _solved(self, branch: SolutionCurve, i: int, guess: State, condition: Constraint) -> State:
        state, _ = branch.continuation.solve(guess, condition)
        branch.require_within(i, branch.solved(state), "critical point")
        return state

    # -- lines -----------------------------------------------------------------------------------

    def line(self, seed: Seed) -> CriticalLine:
        """The line through a critical point, from one end to the other; it is followed once.

        Raises:
            ConvergenceError: If this mesh has no such critical point.
        """
        if seed not in self._lines:
            self._lines[seed] = self._both_ways(seed.kind, self._start(seed))
        return self._lines[seed]

    def beyond(self, seed: Seed) -> CriticalLine:
        """The same line in a wider window.

        Raises:
            ConvergenceError: As :meth:`line`.
        """
        wider = LinesOnMesh(self.model, self.window.wider(), self.touch, self.step, self.broken)
        return wider._both_ways(seed.kind, self._start(seed))

    def _start(self, seed: Seed) -> State:
        at = f"diagram: {self.window.vary} = {seed.at:g}"
        try:
            starts = self.starts(seed.kind, seed.at)
        except ConvergenceError as error:
            raise ConvergenceError(
                f"{at}: the critical points of kind {seed.kind} were not found on every mesh: raise cells "
                f"({error})"
            ) from error
        if len(starts) <= seed.index:
            raise ConvergenceError(
                f"{at}: the meshes have different numbers of critical points of kind {seed.kind}: raise cells"
            )
        return starts[seed.index]

    def _both_ways(self, kind: str, at: State) -> CriticalLine:
        """The line through a state: against the sense of the parameter to an end, and from there back."""
        window, vary = self.window, self.window.vary
        continuation = self._continuation(kind, at)
        size, here = window.high - window.low, at.loads[vary]
        at_low, at_high = (abs(here - side) <= INSIDE * size for side in (window.low, window.high))
        first = continuation.start(at, Held(vary, here), towards={vary: 1.0 if at_low else -1.0})
        if not (at_low or at_high):
            back = reversed(self._followed(continuation, first, ()).points)
            first = next(point for point in back if not self.model.gives_way(point)).reversed()
        return self._followed(continuation, first, self._meetings(kind))

    def _followed(
        self, continuation: LineContinuation, first: CurvePoint, meetings: Sequence[Meeting]
    ) -> CriticalLine:
        """The line from a point to where it leaves the window, returns to that point, or the law ends."""
        window, part = self.window, self.model.part(first.state)

        def stop(point: CurvePoint) -> bool:
            longest = continuation.control.most(point.state, (self.window.load,))
            far = point.arclength > LOOP * longest
            closed = far and continuation.distance(point.state, first.state) < longest
            outside = self._beyond(point.monitors | point.state.loads, part)
            return closed or bool(outside) or bool(self.model.gives_way(point))

        line = CriticalLine(continuation, window.vary, first, stop, meetings)
        line.end_at_limit(self.model.limit)
        why = ""
        while line.stalled is None and (outside := self._outside(line.points[-1].state)):
            line.end_at(*outside[0])
            why = part.why if outside[0] in [bound[:2] for bound in part.bounds] else ""
        last, vary = line.points[-1], window.vary
        if given_way := line.ended or self.model.gives_way(last):
            why = f"{given_way}; change low or high, or the constants of the law"
        if why:
            line.ended = (
                f"diagram: the line was followed up to {vary} = {last.state.loads[vary]:.6g}, "
                f"{self.window.load} = {last.state.loads[self.window.load]:.6g}: {why}"
            )
        return line

    def _outside(self, state: State) -> list[tuple[str, float]]:
        """Sides of the window, or of its part of the branch, beyond which a state lies: column and value."""
        return self._beyond(self._columns(state), self.model.part(state))

    def _columns(self, state: State) -> dict[str, float]:
        with self.system.at(state):
            return self.system.monitors() | state.loads

    def _beyond(self, columns: Mapping[str, float], part: Part) -> list[tuple[str, float]]:
        return self.window.outside(columns, self.depth, part.bounds)

    def _continuation(self, kind: str, at: State) -> LineContinuation:
        """Follows the critical points of a kind, beginning near a state."""
        part = self.model.part(at)
        solver = ExtendedNewton(self.system, [self.window.load, self.window.vary, *part.fronts])
        longest = self.longest
        steps = StepControl(longest / 4, longest, usual_load=USUAL_LOAD, growing=(self.window.load,))
        condition = self._condition(kind, at, solver)
        return LineContinuation(solver, condition, steps, [*part.fronts.values()], part.allowed)

    @property
    def longest(self) -> float:
        """Largest step along a line; constants of laws have different sizes."""
        return max(self.step, (self.window.high - self.window.low) / STEPS)

    def _condition(self, kind: str, at: State, solver: ExtendedNewton) -> Constraint:
        if kind in ("contact", "end"):
            return Held(self.depth, self.touch if kind == "contact" else self.window.end)
        if kind == "wrinkling":
            return self.model.least
        if kind == "fold":
            own = OwnVariation(solver)
            mode = nearest_to_zero(Stability(self.system), at)
            return Singular(lambda: own, self.system.mass_times(mode.vector))
        with self.system.at(at):
            found = [(form, form().nearest()) for form in self.model.operators(kind).values()]
            form, mode = min(found, key=lambda item: abs(item[1].eigenvalue))
            return Singular(form, form().mass_times(mode.vector))

    def _meetings(self, kind: str) -> list[Meeting]:
        """The points of codimension two that are looked for on a line."""
        if kind != "fold" and not self.model.operators(kind):
            return []
        onsets = [Meeting(f"wrinkling_{kind}", zeros_of(lambda columns: columns["t_min"]))]
        if self.touch < self.window.end:
            gap = zeros_of(lambda columns: columns[self.depth] - self.touch)
            onsets.append(Meeting(f"contact_{kind}", gap))
        others = [
            Meeting("_".join(sorted((kind, other), key=ORDER)), neutral_too(form))
            for other in self.broken
            if other != kind
            for form in self.model.operators(other).values()
        ]
        if kind == "fold":
            return [CUSP, *others, *onsets]
        own, stability = OwnVariation(ExtendedNewton(self.system, [self.window.load])), Stability(self.system)
        folds = Meeting(f"fold_{kind}", singular_too(lambda: own, stability.nearest_by_index))
        return [Meeting(f"tip_{kind}", tips), folds, *others, *onsets]

    def has(self, line: CriticalLine, state: State) -> bool:
        """Whether a critical point of a primary branch lies on a line, as far as interpolation tells."""
        vary = self.window.vary
        here, wanted = state.loads[vary], self._place_of(state)
        for i in line.crossings(vary, here).tolist():
            found = self._place_of(line.interpolated(i, vary, here))
            if np.abs(found - wanted).max() < SAME * (1 + np.abs(wanted).max()):
                return True
        return False

    def _place_of(self, state: State) -> np.ndarray:
        """Largest displacement and load."""
        columns = self._columns(state)
        return np.array([columns[self.depth], columns[self.window.load]])


def neutral_too(form: Operator) -> Callable[[CriticalLine], Iterable[Bracket]]:
    """Points of a line at which a second variation outside of the unknowns' symmetry is singular too."""
    return singular_too(form, lambda _state, index: form().eigenvalue(index))
