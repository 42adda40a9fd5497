r"""Lines of critical points in a plane of two parameters.

A critical point is an equilibrium at which one more scalar condition holds: a second variation is singular
(limit points, symmetry breaking), or a functional has a value (onsets). With a second parameter as a further
unknown, such points form a line:

.. math:: R(U; \lambda, \mu) = 0, \qquad g(U; \lambda, \mu) = 0

It is followed by arc length in :math:`(U, \lambda, \mu)`. There it is smooth also at a cusp, where both
parameters turn, and where a line of symmetry breaking meets a line of limit points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import Constraint, ExtendedNewton
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import OwnVariation, Singular, SingularForm

AWAY = 1e-6
"""Shift of the inertia on a line of limit points: its critical eigenvalue, which is zero, does not count."""

Bracket = tuple[int, Callable[[State], float]]
"""A point of a line, and a function of states that changes sign between it and the next one."""


@runtime_checkable
class Turning(Protocol):
    """A condition that depends on a choice, which is made once for each solve."""

    def turn(self) -> None:
        """Choose at the state that the system is lent to."""


@dataclass(frozen=True)
class Meeting:
    """Points of a line at which a second condition holds too (points of codimension two)."""

    kind: str
    brackets: Callable[[CriticalLine], Iterable[Bracket]]


class LineContinuation(Continuation):
    """Follows critical points over the solver's two loads.

    Args:
        solver: Its scalars are the two loads, and fronts.
        condition: What makes a state critical. If it can ``turn``, it does so at the guess of each solve: the
            border of a singular form becomes its null vector there.
        control: Lengths of steps.
        fitted: The equations of the fronts.
        allowed: True for admissible states.
    """

    def __init__(
        self,
        solver: ExtendedNewton,
        condition: Constraint,
        control: StepControl,
        fitted: Sequence[Constraint] = (),
        allowed: Callable[[State], bool] = lambda _: True,
    ) -> None:
        self.condition = condition
        own = isinstance(condition, Singular) and isinstance(condition.variation(), OwnVariation)
        super().__init__(solver, [condition, *fitted], control, AWAY if own else 0.0, allowed)

    def solve(self, guess: State, constraint: Constraint, chord: bool = False) -> tuple[State, SolveRecord]:
        """Solve for the point of the line at which one more constraint holds."""
        if isinstance(self.condition, Turning):
            with self.system.at(guess):
                self.condition.turn()
        return super().solve(guess, constraint, chord)


class CriticalLine(SolutionCurve):
    """A line of critical points, with the points at which a second condition holds.

    Args:
        continuation: Follows the line.
        control: The parameter over which it is drawn.
        start: First point.
        stop: True at the last requested point.
        meetings: Second conditions.
    """

    def __init__(
        self,
        continuation: LineContinuation,
        control: str,
        start: CurvePoint,
        stop: Callable[[CurvePoint], bool],
        meetings: Sequence[Meeting] = (),
    ) -> None:
        self.condition, self.meetings = continuation.condition, meetings
        super().__init__(continuation, control, start, stop)

    def special(self) -> list[Solved]:
        """The points at which a second condition holds, in order along the line.

        Each is solved for: a root of the second condition over planes across the line, in which the line's
        own equations hold.
        """
        found = []
        for meeting in self.meetings:
            for i, function in meeting.brackets(self):
                solved = self.zero(i, lambda at, function=function: function(at.state), meeting.kind)
                found.append((self.arclength(i, solved.state), solved))
        return [solved for _, solved in sorted(found, key=lambda item: item[0])]

    def at(self, name: str, value: float, crossing: int = 1) -> Solved:
        """As for any curve; a column that is constant on one side, which cannot be prescribed, is a root.

        Raises:
            InputError: If the column cannot be asked for or does not take the value that often.
            ConvergenceError: If the state was bracketed but is not found.
        """
        try:
            return super().at(name, value, crossing)
        except ConvergenceError:
            if name in self.loads:
                raise
            i = int(self.crossings(name, value)[crossing - 1])
            return self.zero(i, lambda solved: solved.values[name] - value, "")

    def arclength(self, i: int, state: State) -> float:
        """Position of a state after point ``i``."""
        before = self.points[i]
        return before.arclength + self.continuation.distance(state, before.state)

    def counts(self, form: Callable[[], SingularForm], shift: float = 0.0) -> np.ndarray:
        """Number of eigenvalues of a form below ``-shift`` at each point of the line, by inertia."""
        found = []
        for point in self.points:
            with self.system.at(point.state):
                found.append(form().negative_count(shift))
        return np.array(found)


def fold_line(
    branch: EquilibriumBranch,
    second: str,
    towards: float,
    steps: StepControl,
    stop: Callable[[CurvePoint], bool],
) -> CriticalLine:
    """The first limit point of a branch, followed over a second load, with its cusps.

    Args:
        branch: The branch, which has a limit point.
        second: The second load.
        towards: Sign of its change along the line at first.
        steps: Lengths of steps.
        stop: True at the last requested point.
    """
    solver = ExtendedNewton(branch.system, [branch.control, second])
    own = OwnVariation(solver)
    middle = branch.points[int(branch.turns()[0])]
    condition = Singular(lambda: own, branch.system.mass_times(middle.tangent.u))
    continuation = LineContinuation(solver, condition, steps)
    return line_of(continuation, branch.special()[0].state, second, towards, stop, (CUSP,))


def line_of(
    continuation: LineContinuation,
    at: State,
    control: str,
    towards: float,
    stop: Callable[[CurvePoint], bool],
    meetings: Sequence[Meeting] = (),
) -> CriticalLine:
    """The line through a critical point, from there on.

    Args:
        continuation: Follows it.
        at: A critical point.
        control: The parameter over which the line is drawn.
        towards: Sign of its change along the line at first.
        stop: True at the last requested point.
        meetings: Second conditions.
    """
    start = continuation.start(at, Held(control, at.loads[control]), towards={control: towards})
    return CriticalLine(continuation, control, start, stop, meetings)


# -- second conditions -----------------------------------------------------------------------------


def cusps(line: CriticalLine) -> Iterable[Bracket]:
    """Cusps of a line of limit points: both parameters turn, and the cubic of the null vector is zero."""

    def cubic(state: State) -> float:
        with line.system.at(state):
            return line.condition.cubic()

    return [(int(i), cubic) for i in line.turns()]


def tips(line: CriticalLine) -> Iterable[Bracket]:
    """Turning points of the control: two points of the primary branch with this singular form merge."""
    found = []
    for i in line.turns().tolist():
        along = line.points[i].tangent

        def rate(state: State, along: Tangent = along) -> float:
            return line.continuation.direction(state, along).loads[line.control]

        found.append((i, rate))
    return found


def zeros_of(column: Callable[[Mapping[str, float]], float]) -> Callable[[CriticalLine], Iterable[Bracket]]:
    """Zeros of a function of the columns."""

    def brackets(line: CriticalLine) -> Iterable[Bracket]:
        def function(state: State) -> float:
            with line.system.at(state):
                return column(line.system.monitors())

        values = np.array([column(point.monitors) for point in line.points])
        return [(int(i), function) for i in np.flatnonzero(values[:-1] * values[1:] < 0)]

    return brackets


def singular_too(
    form: Callable[[], SingularForm], eigenvalue: Callable[[State, int], float]
) -> Callable[[CriticalLine], Iterable[Bracket]]:
    """Points at which a second form is singular, by its inertia at each point of the line.

    Args:
        form: Returns the second form, because one object may be used for several wave numbers.
        eigenvalue: Its eigenvalue of a number in ascending order, from 0, at a state that the system of the
            line is lent to.
    """

    def brackets(line: CriticalLine) -> Iterable[Bracket]:
        counts = line.counts(form)
        for i in np.flatnonzero(np.diff(counts)).tolist():
            index = int(min(counts[i], counts[i + 1]))

            def function(state: State, index: int = index) -> float:
                with line.system.at(state):
                    return eigenvalue(state, index)

            yield i, function

    return brackets


CUSP = Meeting("cusp_point", cusps)
