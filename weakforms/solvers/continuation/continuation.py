"""Pseudo-arclength continuation of the solutions of a system with scalar unknowns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.constraints import Plane
from weakforms.solvers.equilibrium.linear import BorderedMatrix
from weakforms.solvers.equilibrium.newton import Constraint, ExtendedNewton
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.state import State


@dataclass(frozen=True)
class Tangent:
    """Direction of a curve, of unit length in the mass norm of ``U`` and the absolute value of loads."""

    u: np.ndarray
    loads: dict[str, float]
    dual: np.ndarray | None = None
    """``M u`` if it is known already; its inner product projects on this direction."""


SLOW = 8
"""Iterations with one factorisation above which its error may be larger than its last step: Newton's method
then makes the last ones."""


@dataclass
class CurvePoint:
    """A converged point of a curve, with the curve's direction and the inertia of ``K`` there."""

    state: State
    tangent: Tangent
    arclength: float
    n_negative: int
    record: SolveRecord
    monitors: dict[str, float]

    def reversed(self) -> CurvePoint:
        """The same point as the first one of the curve, followed the other way."""
        along = self.tangent
        dual = None if along.dual is None else -along.dual
        back = Tangent(-along.u, {name: -rate for name, rate in along.loads.items()}, dual)
        return replace(self, tangent=back, arclength=0.0)


@dataclass(frozen=True)
class StepControl:
    """Lengths of arc-length steps, and the rules for changing them."""

    first: float = 0.05
    largest: float = 0.1
    smallest: float = 1e-7
    predictor_error: float = 2e-3
    """Target distance between predictor and solution; with cubic extrapolation it grows like step⁴."""
    max_turn: float = 0.85
    """If the cosine of the turn within a step is smaller, the step may have changed branch and is repeated
    shorter."""
    max_aside: float = 0.1
    """If the sine of the angle between a step's chord and the mean of its tangents is larger, the step is
    repeated shorter.

    For a smooth curve this sine is of second order in the step (below 0.05 for all curves of the papers).
    After a jump to a neighbouring branch, even a parallel one, it is the length of the jump divided by the
    length of the step.
    """
    max_points: int = 3000
    usual_load: float = inf
    """Above this load the largest step grows in proportion to the load, which dominates the arc length of
    stiff laws."""
    growing: tuple[str, ...] = ()
    """The loads that count for this; if none are named, all unknown ones."""

    def most(self, state: State, loads: Sequence[str]) -> float:
        """The largest allowed step from a state."""
        sizes = (abs(state.loads[name]) / self.usual_load for name in self.growing or loads)
        return self.largest * max(1.0, *sizes)


class Continuation:
    """Follows ``R(U, λ) = 0`` plus ``m - 1`` fixed constraints along its one-dimensional solution curve.

    Each step needs two factorisations: one at the predictor, kept for all Newton iterations, and one at the
    solution, which gives tangent and inertia.

    Args:
        solver: Newton solver whose ``m`` scalars are the unknown loads.
        fixed: Constraints that hold along the whole curve (the fold condition, for a fold line).
        control: Step lengths.
        shift: Inertia is computed for ``K + shift M``. On a fold line, where ``K`` is singular by definition,
            a small shift leaves the critical eigenvalue out of the count.
        allowed: True for admissible states; a step to another state is repeated shorter.
    """

    def __init__(
        self,
        solver: ExtendedNewton,
        fixed: Sequence[Constraint] = (),
        control: StepControl | None = None,
        shift: float = 0.0,
        allowed: Callable[[State], bool] = lambda _: True,
    ) -> None:
        self.solver, self.system = solver, solver.system
        self.allowed = allowed
        self.shift = shift
        self.fixed = tuple(fixed)
        self.control = control or StepControl()

    # -- geometry in (U, λ) ------------------------------------------------------------------

    def _norm(self, u: np.ndarray, dual: np.ndarray, loads: dict[str, float]) -> float:
        square = self.system.dot(u, dual)
        return sqrt(max(square + sum(v * v for v in loads.values()), 0.0))

    def distance(self, a: State, b: State) -> float:
        """Length of the chord between two states."""
        return self._length(self._chord(a, b))

    def _chord(self, a: State, b: State) -> Tangent:
        """The vector from one state to another, not normalised."""
        return Tangent(b.u - a.u, {name: b.loads[name] - a.loads[name] for name in self.solver.scalars})

    def _length(self, chord: Tangent) -> float:
        return self._norm(chord.u, self.system.mass_times(chord.u), chord.loads)

    def _dual(self, tangent: Tangent) -> np.ndarray:
        return self.system.mass_times(tangent.u) if tangent.dual is None else tangent.dual

    def _inner(self, a: Tangent, b: Tangent) -> float:
        loads = sum(a.loads[name] * b.loads[name] for name in self.solver.scalars)
        return self.system.dot(a.u, self._dual(b)) + loads

    def plane(self, through: State, tangent: Tangent, offset: float = 0.0) -> Plane:
        """Plane normal to the curve's tangent at a distance along it."""
        row = self._dual(tangent)
        weights = tangent.loads
        target = self.system.dot(row, through.u)
        target += sum(w * through.loads[name] for name, w in weights.items()) + offset
        return Plane(row, weights, target)

    def _tangent(self, along: Tangent) -> Tangent:
        """Direction of the curve at the lent state, whose ``K`` is factorised, oriented like ``along``."""
        plane = Plane(self._dual(along), along.loads, 0.0)
        bordered = self.solver.border([*self.fixed, plane])
        return self._unit(*self._along(bordered))

    def _along(self, bordered: BorderedMatrix) -> tuple[np.ndarray, dict[str, float]]:
        """Rate of the state if only the last equation of a bordered system changes."""
        goal = [0.0] * (len(self.solver.scalars) - 1) + [1.0]
        u, values = bordered.solve(None, goal)
        return u, dict(zip(self.solver.scalars, values.tolist(), strict=True))

    def _unit(self, u: np.ndarray, loads: dict[str, float], sign: float = 1.0) -> Tangent:
        dual = self.system.mass_times(u)
        factor = sign / self._norm(u, dual, loads)
        return Tangent(u * factor, {name: v * factor for name, v in loads.items()}, dual * factor)

    def direction(self, state: State, along: Tangent) -> Tangent:
        """Direction of the curve at a state, oriented like another direction."""
        with self.system.at(state):
            self.solver.factor.update()
            return self._tangent(along)

    # -- stepping ----------------------------------------------------------------------------

    def solve(self, guess: State, constraint: Constraint, chord: bool = False) -> tuple[State, SolveRecord]:
        """Solve for the point of the curve at which one more constraint holds."""
        return self.solver.solve(guess, [*self.fixed, constraint], chord)

    def point(self, state: State, record: SolveRecord, along: Tangent, s: float) -> CurvePoint:
        """Complete a converged state: tangent, inertia, functionals."""
        with self.system.at(state):
            negative = self._factorised()
            tangent = self._tangent(along)
            return CurvePoint(state, tangent, s, negative, record, self.system.monitors())

    def _factorised(self) -> int:
        """Factorise ``K``, and count the negative eigenvalues of ``K + shift M``."""
        factor, negative = self.solver.factor, None
        if self.shift:
            self.system.tangent()
            self.system.shift(self.shift)
            factor.refactor()
            negative = factor.negative_count()
        factor.update()
        return factor.negative_count() if negative is None else negative

    def start(self, guess: State, constraint: Constraint, towards: dict[str, float]) -> CurvePoint:
        """First point of a curve, solved for with ``constraint`` instead of an arc-length step.

        Args:
            guess: Initial guess.
            constraint: Equation that selects the point, such as a prescribed functional.
            towards: Requested sign for the change of one functional or load along the curve.
        """
        try:
            state, record = self.solve(guess, constraint)
        except ConvergenceError:
            state, record = self.solve(self._approached(guess, constraint), constraint)
        (name, sign), *_ = towards.items()
        with self.system.at(state):
            self.solver.factor.update()
            bordered = self.solver.border([*self.fixed, constraint])
            u, loads = self._along(bordered)
            rate = self.rate(name, Tangent(u, loads))
        along = self._unit(u, loads, float(np.sign(rate) * np.sign(sign)))
        return self.point(state, record, along, 0.0)

    def _approached(self, guess: State, constraint: Constraint) -> State:
        """The state from a guess from which full Newton steps diverge, by steps that are shortened."""
        careful = ExtendedNewton(self.system, self.solver.scalars, max_iterations=100, line_search="bt")
        return careful.solve(guess, [*self.fixed, constraint])[0]

    def rate(self, name: str, tangent: Tangent) -> float:
        """Derivative of a functional or load along a direction at the state that the system is lent to."""
        if name in tangent.loads:
            return tangent.loads[name]
        row, rates = self.system.monitor_gradient(name)
        loads = sum(rates.get(key, 0.0) * v for key, v in tangent.loads.items())
        return self.system.dot(row, tangent.u) + loads

    def predict(self, before: CurvePoint | None, at: CurvePoint, step: float) -> State:
        """Extrapolate: cubic through two points with their tangents, linear from the first point."""
        if before is None:
            return _combine(self.solver.scalars, [(1.0, at.state), (step, at.tangent)])
        h = at.arclength - before.arclength
        x = 1.0 + step / h
        terms = hermite(x)
        parts = [before.state, before.tangent, at.state, at.tangent]
        weights = [terms[0], terms[1] * h, terms[2], terms[3] * h]
        return _combine(self.solver.scalars, list(zip(weights, parts, strict=True)))

    def advance(self, before: CurvePoint | None, at: CurvePoint, step: float) -> CurvePoint:
        """Make one step of a given length.

        Raises:
            ConvergenceError: If it does not converge, or turns too sharply to be on the same curve.
        """
        guess = self.predict(before, at, step)
        plane = self.plane(at.state, at.tangent, step)
        state, record = self.solve(guess, plane, chord=not self.fixed)
        if record.iterations > SLOW:
            state, last = self.solve(state, plane)
            record = record.followed_by(last)
        if not self.allowed(state):
            raise ConvergenceError("the step leads out of the range of the problem")
        chord = self._chord(at.state, state)
        length = self._length(chord)
        new = self.point(state, record, at.tangent, at.arclength + length)
        turn = self._inner(new.tangent, at.tangent)
        if turn < self.control.max_turn:
            raise ConvergenceError("the curve turns too sharply within a step")
        along = self._inner(chord, at.tangent) + self._inner(chord, new.tangent)
        if _chord_deviation(along / length, turn) > self.control.max_aside:
            raise ConvergenceError("the step leads to another curve")
        self._error = self.distance(state, guess)
        return new

    def trace(self, start: CurvePoint, stop: Callable[[CurvePoint], bool]) -> Iterator[CurvePoint]:
        """Yield ``start`` and the points after it, up to the first for which ``stop`` is true.

        Raises:
            ConvergenceError: If even the smallest step fails; all points before it were yielded.
        """
        control = self.control
        before, at, step = None, start, control.first
        yield start
        for _ in range(control.max_points):
            try:
                new = self.advance(before, at, step)
            except ConvergenceError as error:
                step /= 2
                if step < control.smallest:
                    raise ConvergenceError(f"continuation stalled: {error}") from error
                continue
            yield new
            if stop(new):
                return
            order = 2 if before is None else 4
            grow = (control.predictor_error / max(self._error, 1e-16)) ** (1 / order)
            before, at = at, new
            step = min(step * min(max(grow, 0.4), 1.8), control.most(at.state, self.solver.scalars))
        raise ConvergenceError(
            f"continuation did not end within {control.max_points} points; raise step, or choose an earlier "
            "end"
        )


def hermite(x: float) -> tuple[float, float, float, float]:
    """Cubic Hermite basis on [0, 1]: value and slope at 0, value and slope at 1."""
    return (
        (1 + 2 * x) * (1 - x) ** 2,
        x * (1 - x) ** 2,
        x * x * (3 - 2 * x),
        x * x * (x - 1),
    )


def _chord_deviation(along: float, turn: float) -> float:
    """Sine of the angle between a step's chord and the mean of the tangents at its ends.

    Args:
        along: Sum of the cosines of the chord's angles with the two.
        turn: Cosine of the angle between them.
    """
    return sqrt(max(0.0, 1 - along**2 / (2 + 2 * turn)))


def _combine(scalars: Sequence[str], terms: list[tuple[float, State | Tangent]]) -> State:
    (weight, part), *others = terms
    u = weight * part.u
    for weight, part in others:
        u += weight * part.u
    loads = {name: sum(w * part.loads[name] for w, part in terms) for name in scalars}
    first = next(part for _, part in terms if isinstance(part, State))
    return State(u, {**first.loads, **loads}, first.marks)
