"""A solution curve on one mesh: its trace, its special points, and the state at any value of a column."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from weakforms.errors import ConvergenceError, InputError
from weakforms.results.model import ROUND_OFF, crossings
from weakforms.results.wording import not_crossed
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, hermite
from weakforms.solvers.equilibrium.constraints import Held, MonitorPlane
from weakforms.solvers.equilibrium.newton import Constraint
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import judged
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.support.roots import root

DIAGNOSTICS = ("n_negative", "residual", "iterations")
"""Columns that describe the solve; they cannot be prescribed."""

FAR = 0.1
"""Distance along a curve, relative to its length, within which a point of another mesh's curve is sought."""
JUST_BEYOND = 1e-3
"""Part of its first and of its last step by which a curve counts as crossing a plane that it ends before."""

AT_END = 1e-10
"""Value at one end of an interval, over that at the other, which counts as a zero there, up to round-off."""

BISECTIONS = 6
"""Number of bisections of an interval before a change of stability is solved for in it."""


@dataclass(frozen=True)
class Solved:
    """A state that was solved for on a branch: its columns and its degrees of freedom."""

    values: dict[str, float]
    state: State
    kind: str = ""
    """Kind of the special point; empty for any other state."""


class SolutionCurve:
    """A one-dimensional set of solutions from a start to an end.

    Args:
        continuation: Follows the curve.
        control: The load over which the curve is drawn; limit points are its extrema.
        start: First point.
        stop: True at the last requested point.

    Attributes:
        points: The converged points in order.
        stalled: Why the trace ended early; ``None`` if it did not.
        ended: Why there is no more to trace, such as a law that gives way; ``None`` if that is not so.
    """

    ended: str | None = None

    computed: Sequence[str] = ("eigenvalue_1",)
    """Columns that need a solve of their own; a state has a value of one by root finding."""

    def __init__(
        self,
        continuation: Continuation,
        control: str,
        start: CurvePoint,
        stop: Callable[[CurvePoint], bool],
    ) -> None:
        self.continuation = continuation
        self.solver, self.system = continuation.solver, continuation.system
        self.control = control
        self.loads = continuation.solver.scalars
        self.points: list[CurvePoint] = []
        self._observed: dict[int, tuple[CurvePoint, dict[str, float]]] = {}
        self.stalled: str | None = None
        try:
            for point in continuation.trace(start, stop):
                self.points.append(point)
        except ConvergenceError as error:
            self.stalled = str(error)

    # -- columns -----------------------------------------------------------------------------

    def columns(self) -> dict[str, np.ndarray]:
        """Every column over the points of the trace."""
        points = self.points
        out = {name: np.array([p.state.loads[name] for p in points]) for name in self.loads}
        for name in points[0].monitors:
            out[name] = np.array([p.monitors[name] for p in points])
        out["n_negative"] = np.array([p.n_negative for p in points])
        out["residual"] = np.array([p.record.norms[-1] for p in points])
        out["iterations"] = np.array([p.record.iterations for p in points])
        return out

    @property
    def shown(self) -> list[str]:
        """Columns that results show, without diagnostics."""
        names = [*self.loads, *self.points[0].monitors]
        return [name for name in names if name not in self.system.formulation.internal]

    def _values(self, state: State) -> dict[str, float]:
        """Columns of a state."""
        with self.system.at(state):
            return {**{name: state.loads[name] for name in self.loads}, **self.system.monitors()}

    def observe(self) -> dict[str, float]:
        """The computed columns at the state that the system is lent to."""
        with self.system.weighed_here():
            spectrum = judged(Stability(self.system), self.system.state(), 1)
        return {"eigenvalue_1": spectrum.eigenvalues[0]}

    def observed(self, point: CurvePoint) -> dict[str, float]:
        """The computed columns at a point of the trace, once."""
        if id(point) not in self._observed:
            with self.system.at(point.state):
                self._observed[id(point)] = point, self.observe()
        return self._observed[id(point)][1]

    # -- states on demand --------------------------------------------------------------------

    def at(self, name: str, value: float, crossing: int = 1) -> Solved:
        """Solve for the state at which a column takes a value for the ``crossing``-th time along the branch.

        Raises:
            InputError: If the column cannot be prescribed or does not take the value that often.
            ConvergenceError: If the state was bracketed but Newton's method did not converge to it.
        """
        hits = self.crossings(name, value)
        if len(hits) < crossing:
            raise InputError(not_crossed(name, value, crossing, len(hits), self.over_points(name)))
        i = int(hits[crossing - 1])
        if name in self.computed:
            return replace(self.zero(i, lambda solved: self._computed(solved, name) - value, name), kind="")
        solved = self._solve(self.interpolated(i, name, value), Held(name, value))
        self.require_within(i, solved, f"state at {name} = {value:g}")
        return solved

    def near(self, guess: State, name: str, value: float) -> Solved:
        """Solve for the state at which a column takes a value, from a state near it."""
        return self._solve(guess, Held(name, value))

    def interpolated(self, i: int, name: str, value: float) -> State:
        """The state between point ``i`` and the next one where a column has a value, by interpolation."""
        return self.between(i, self._fraction(i, name, value))

    def _fraction(self, i: int, name: str, value: float) -> float:
        """Fraction of the interval between two neighbours where a column (a load: its cubic) has a value."""
        before, after = (self._column(point, name) - value for point in self.points[i : i + 2])
        for share, left in ((0.0, before), (1.0, after)):
            if abs(left) <= ROUND_OFF * abs(value):
                return share
        if name in self.loads:
            return root(lambda x: self.between(i, x).loads[name] - value, 0.0, 1.0, f"{name} = {value:g}")
        return before / (before - after)

    def crossings(self, name: str, value: float) -> np.ndarray:
        """Indices of the points after which a column crosses a value.

        Raises:
            InputError: If the column cannot be prescribed.
        """
        known = (*self.loads, *self.system.formulation.monitors, *self.computed)
        if name not in known:
            raise InputError(f"cannot ask for a state at {name!r}; allowed: {', '.join(known)}")
        return crossings(self.over_points(name), value)

    def at_position(self, like: CurvePoint, rates: dict[str, float], near: float) -> Solved:
        """Solve for the state of this mesh in the plane across the branch through a point of another mesh.

        Args:
            like: The point of the other mesh.
            rates: Direction of that branch in some columns; the plane is normal to it.
            near: Position along the branch, as a fraction of the arc length.
        """
        target = sum(rate * self._column(like, name) for name, rate in rates.items())
        places = np.array([sum(r * self._column(p, n) for n, r in rates.items()) for p in self.points])
        arclengths = np.array([p.arclength for p in self.points])
        spans = np.diff(places)
        at_end = np.isin(np.arange(len(spans)), (0, len(spans) - 1))
        crossed = (places[:-1] - target) * (places[1:] - target) <= JUST_BEYOND * at_end * spans**2
        apart = np.abs((arclengths[:-1] + arclengths[1:]) / 2 - near * arclengths[-1])
        # This curve may end just before the plane, which may cut it a second time far from there.
        i = int(np.argmin(np.where(crossed & (apart <= FAR * arclengths[-1]), apart - arclengths[-1], apart)))
        share = (target - places[i]) / spans[i] if spans[i] else 0.5
        return self._solve(self.between(i, share), MonitorPlane(rates, target))

    def over_points(self, name: str) -> np.ndarray:
        """A column, also a computed one, over the points of the trace."""
        return np.array([self._column(point, name) for point in self.points])

    def _column(self, point: CurvePoint, name: str) -> float:
        if name in self.computed:
            return self.observed(point)[name]
        return point.state.loads[name] if name in self.loads else point.monitors[name]

    def _computed(self, solved: Solved, name: str) -> float:
        with self.system.at(solved.state):
            return self.observe()[name]

    def _solve(self, guess: State, constraint: Constraint, kind: str = "") -> Solved:
        state, _ = self.continuation.solve(guess, constraint)
        return self.solved(state, kind)

    def solved(self, state: State, kind: str = "") -> Solved:
        """A state that was solved for, with its columns."""
        return Solved(self._values(state), state, kind)

    def between(self, i: int, fraction: float) -> State:
        """Cubic interpolation between two neighbours of the trace."""
        a, b = self.points[i], self.points[i + 1]
        h, (v0, s0, v1, s1) = b.arclength - a.arclength, hermite(fraction)
        u = v0 * a.state.u + s0 * h * a.tangent.u + v1 * b.state.u + s1 * h * b.tangent.u
        loads = {
            name: v0 * a.state.loads[name]
            + v1 * b.state.loads[name]
            + h * (s0 * a.tangent.loads[name] + s1 * b.tangent.loads[name])
            for name in self.loads
        }
        return State(u, {**a.state.loads, **loads}, a.state.marks)

    def narrowed(self, i: int, count: Callable[[State], int], before: int, after: int) -> float:
        """Fraction of an interval close to where an eigenvalue changes sign, where it is negative.

        Args:
            i: Index of the point before it.
            count: Number of negative eigenvalues of a state; here, of interpolated ones.
            before: The number at the first point of the interval.
            after: The number at the second one.
        """
        low, high = 0.0, 1.0
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            if count(self.between(i, middle)) == before:
                low = middle
            else:
                high = middle
        return high if after > before else low

    def require_within(self, i: int, solved: Solved, what: str) -> None:
        """Refuse a solution outside of the interval in which Newton's method should find it."""
        a, b = self.points[i], self.points[i + 1]
        length = b.arclength - a.arclength
        for end in (a, b):
            gap = self.continuation.distance(solved.state, end.state)
            if gap > 1.2 * length:
                raise ConvergenceError(f"{what}: converged {gap:.2g} away from where it was bracketed")

    def zero(self, i: int, function: Callable[[Solved], float], kind: str) -> Solved:
        """Solve for the state between two neighbours where a function is zero, over planes across it."""
        tangent, what = self.points[i].tangent, f"{kind} in {self.control}"

        @functools.cache
        def solved(at: float) -> Solved:
            guess = self.between(i, at)
            return self._solve(guess, self.continuation.plane(guess, tangent), kind)

        value = functools.cache(lambda at: function(solved(at)))
        small, large = sorted((0.0, 1.0), key=lambda end: abs(value(end)))
        if abs(value(small)) <= AT_END * abs(value(large)):
            return solved(small)
        found = solved(root(value, 0.0, 1.0, what, xtol=1e-13, rtol=1e-13))
        self.require_within(i, found, what)
        return found

    def direction(self, point: CurvePoint, names: tuple[str, ...]) -> dict[str, float]:
        """Rates of some columns along the branch at a point of the trace."""
        with self.system.at(point.state):
            return {name: self.continuation.rate(name, point.tangent) for name in names}

    def end_at(self, name: str, value: float) -> None:
        """Replace the last point by the point at which a column has a value, which lies just before it.

        Raises:
            ConvergenceError: If the trace ended before it.
        """
        crossings = len(self.crossings(name, value))
        if not crossings:
            raise ConvergenceError(f"{name} = {value:g} is not reached: {self.stalled or 'the branch ends'}")
        solved = self.at(name, value, crossings)
        before, last = self.points[-2:]
        arclength = before.arclength + self.continuation.distance(solved.state, before.state)
        self.points[-1] = self.continuation.point(solved.state, last.record, before.tangent, arclength)

    def go_on(self) -> None:
        """Add one more point at the end, after a step as long as the last one.

        Raises:
            ConvergenceError: If the step fails.
        """
        before, at = self.points[-2:]
        self.points.append(self.continuation.advance(before, at, at.arclength - before.arclength))

    def end_at_limit(self, limit: Callable[[State], str]) -> None:
        """End a trace that stalled where ``limit`` gives a reason, without its last points that have one.

        Args:
            limit: Why no solution follows a state, as text; empty if one may.
        """
        why = limit(self.points[-1].state) if self.stalled else ""
        if why:
            while len(self.points) > 2 and limit(self.points[-1].state):
                del self.points[-1]
            self.ended, self.stalled = why, None

    def tell_apart(self) -> bool:
        """Add points where eigenvalues change sign between neighbours with the same inertia, if any do.

        Returns:
            Whether points were added.
        """
        return False

    def point_between(self, i: int, fraction: float) -> CurvePoint:
        """Solve for a point of the curve between two neighbours of the trace."""
        guess, before = self.between(i, fraction), self.points[i]
        state, record = self.continuation.solve(guess, self.continuation.plane(guess, before.tangent))
        self.require_within(i, self.solved(state), "point between two points")
        length = self.continuation.distance(state, before.state)
        return self.continuation.point(state, record, before.tangent, before.arclength + length)

    def insert(self, i: int, point: CurvePoint) -> None:
        """Add a point after point ``i``; arc lengths beyond it grow, because a chord is replaced by two."""
        after = self.points[i + 1]
        longer = point.arclength + self.continuation.distance(after.state, point.state) - after.arclength
        for later in self.points[i + 1 :]:
            later.arclength += longer
        self.points.insert(i + 1, point)

    def turns(self) -> np.ndarray:
        """Indices of the points after which the control changes direction."""
        rates = np.array([p.tangent.loads[self.control] for p in self.points])
        return np.flatnonzero(rates[:-1] * rates[1:] < 0)

    def _turn(self, i: int) -> Solved:
        """The turn after a point: the zero of the control's rate along the curve."""
        along = self.points[i].tangent

        def rate(solved: Solved) -> float:
            return self.continuation.direction(solved.state, along).loads[self.control]

        return self.zero(i, rate, "limit_point")

    def _turn_guess(self, i: int) -> State:
        ra, rb = (self.points[j].tangent.loads[self.control] for j in (i, i + 1))
        return self.between(i, ra / (ra - rb))
