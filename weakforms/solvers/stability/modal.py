"""Branches with eigenvalue columns for families of modes; zeros of eigenvalues are bifurcation points."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import replace
from functools import partial
from typing import ClassVar, Protocol

import numpy as np

from weakforms.errors import ConvergenceError, InputError
from weakforms.results import Quantity, SpecialPoint
from weakforms.solvers.continuation.apart import tell_apart
from weakforms.solvers.continuation.branch import FittedBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.modes import SecondVariation, Singular
from weakforms.solvers.uncertainty.family import BranchFamily

Family = Hashable
"""Modes of one symmetry: a wave number, or an object that says more."""

FEWEST = 2
"""Number of points that a trace keeps."""


class Modes(Protocol):
    """Quantities computed along a branch, at the state that the system is lent to."""

    wave_numbers: Sequence[Family]
    """Families whose zeros are bifurcation points."""

    columns: Sequence[str]
    """Names of the columns that :meth:`observe` returns."""

    def variation(self, n: Family) -> SecondVariation:
        """The operator of a family; of wave numbers, 0 is the symmetric space of the branch."""

    def observe(self) -> dict[str, float]:
        """Columns that are not functionals: eigenvalues, values at material points."""


class ModalBranch(FittedBranch):
    """A branch with columns that need a separate solve, and with bifurcations into other symmetries.

    Args:
        continuation: Follows the curve.
        control: The load over which it is drawn.
        start: First point.
        stop: True at the last requested point.
        modes: Quantities computed along it.
        hidden: Functionals that have no meaning on this branch.
    """

    def __init__(
        self,
        continuation: Continuation,
        control: str,
        start: CurvePoint,
        stop: Callable[[CurvePoint], bool],
        modes: Modes,
        hidden: Sequence[str] = (),
    ) -> None:
        self.modes, self.hidden = modes, tuple(hidden)
        self._limits: list[tuple[CurvePoint, Solved]] = []
        self._counted: dict[tuple[int, Family], tuple[CurvePoint, int]] = {}
        super().__init__(continuation, control, start, stop)
        self._insert_limits()

    def _insert_limits(self) -> None:
        """Locate the control's limit points and add them to the trace.

        The columns then contain the control's largest and smallest values, so that a state just below a
        maximum is bracketed.
        """
        for i in reversed(self.turns().tolist()):
            before = self.points[i]
            limit = self._turn(i)
            plane = self.continuation.plane(limit.state, before.tangent)
            state, record = self.solver.solve(limit.state, [*self.continuation.fixed, plane])
            with self.system.at(state):
                monitors = self.system.monitors()
            tangent = self.continuation.direction(state, before.tangent)
            s = before.arclength + self.continuation.distance(state, before.state)
            # Its zero eigenvalue makes the inertia depend on round-off: use the count of the point before it.
            point = CurvePoint(state, tangent, s, before.n_negative, record, monitors)
            self.insert(i, point)
            self._limits.insert(0, (point, limit))

    def end_before(self, beyond: Callable[[State], bool], why: str) -> None:
        """End a trace that goes beyond a limit at the last point before it.

        Args:
            beyond: Whether a state is beyond the limit.
            why: Why the branch ends there.
        """
        if self.stalled is None and beyond(self.points[-1].state):
            while len(self.points) > FEWEST and beyond(self.points[-1].state):
                del self.points[-1]
            left = {id(point) for point in self.points}
            self._limits = [both for both in self._limits if id(both[0]) in left]
            self.ended = why

    # -- columns -------------------------------------------------------------------------------

    @property
    def computed(self) -> Sequence[str]:
        """The additional columns."""
        return self.modes.columns

    def observe(self) -> dict[str, float]:
        """The additional columns at the state that the system is lent to."""
        return self.modes.observe()

    def columns(self) -> dict[str, np.ndarray]:
        """Every column over the points of the trace, including the additional ones."""
        rows = [self.observed(point) for point in self.points]
        return super().columns() | {n: np.array([row[n] for row in rows]) for n in self.modes.columns}

    @property
    def shown(self) -> list[str]:
        """Columns that results show, without diagnostics."""
        own = [name for name in super().shown if name not in self.hidden]
        return [*own, *self.modes.columns]

    def complete(self, solved: Solved) -> Solved:
        """The state with the additional columns."""
        with self.system.at(solved.state):
            return replace(solved, values=solved.values | self.observe())

    # -- states --------------------------------------------------------------------------------

    def at(self, name: str, value: float, crossing: int = 1) -> Solved:
        """As for any branch; an additional column reaches its value by root finding.

        Raises:
            InputError: If the column is unknown or does not take the value that often.
            ConvergenceError: If the state was bracketed but Newton's method did not converge to it.
        """
        return self.complete(super().at(name, value, crossing))

    def crossings(self, name: str, value: float) -> np.ndarray:
        """Indices of the points after which a column crosses a value.

        Raises:
            InputError: If there is no such column.
        """
        if name in self.hidden:
            return np.empty(0, dtype=int)
        return super().crossings(name, value)

    def at_position(self, like: CurvePoint, rates: dict[str, float], near: float) -> Solved:
        """As for any branch, with the additional columns."""
        return self.complete(super().at_position(like, rates, near))

    # -- special points ------------------------------------------------------------------------

    def special(self) -> list[Solved]:
        """Limit points of the control and zeros of every family of modes, in order along the branch."""
        return [self.complete(solved) for _, solved in sorted(self._placed(), key=lambda item: item[0])]

    def _placed(self) -> list[tuple[float, Solved]]:
        """The special points with their arc lengths."""
        for n in self.modes.wave_numbers:  # all before any is located: points that are added move the others
            tell_apart(self, partial(self._count_at, n=n), self._counts(n))
        found = [(point.arclength, solved) for point, solved in self._limits]
        for n in self.modes.wave_numbers:
            counts = self._counts(n)
            changes = np.flatnonzero(np.diff(counts))
            if np.any(np.abs(np.diff(counts)[changes]) > 1):
                raise ConvergenceError(
                    f"several eigenvalues of {self._called(n)} change sign between neighbours: "
                    "shorter steps are needed"
                )
            for i in changes:
                solved = self._bifurcation(int(i), n)
                found.append((self._arclength(int(i), solved), solved))
        return found

    def tell_apart(self) -> bool:
        """As for any curve, for the eigenvalues of every family."""
        each = [
            tell_apart(self, partial(self._count_at, n=n), self._counts(n), unseen=True)
            for n in self.modes.wave_numbers
        ]
        return any(each)

    def _arclength(self, i: int, solved: Solved) -> float:
        before = self.points[i]
        return before.arclength + self.continuation.distance(solved.state, before.state)

    def _counts(self, n: Family) -> np.ndarray:
        """Negative eigenvalues of a family at each point of the trace, by inertia, once for each point."""
        for point in self.points:
            if (id(point), n) not in self._counted:
                self._counted[id(point), n] = point, self._count_at(point.state, n)
        return np.array([self._counted[id(point), n][1] for point in self.points])

    def _bifurcation(self, i: int, n: Family) -> Solved:
        """The zero of a family's eigenvalue between two neighbours, by the system of :class:`Singular`.

        The interval is narrowed by the inertia of interpolated states. The mode comes from the side where the
        eigenvalue is negative: there it is the highest negative one, even if the family has other soft modes.
        """
        count, ends = partial(self._count_at, n=n), self.points[i : i + 2]
        before, after = (count(point.state) for point in ends)
        guess = self.between(i, self.narrowed(i, count, before, after))
        with self.system.at(guess):
            variation = self.modes.variation(n)
            border = variation.mass_times(variation.highest_negative().vector)
        kind, marks = self._named(n, 1.0 if after > before else -1.0)
        singular = Singular(lambda: self.modes.variation(n), border)
        try:
            solved = self._solve(guess, singular, kind)
            self.require_within(i, solved, f"bifurcation of {self._called(n)}")
        except ConvergenceError:  # as for a limit point, root finding needs no good guess
            solved = self.zero(i, partial(self._singularity, singular), kind)
        return replace(solved, values=solved.values | marks)

    def _singularity(self, singular: Singular, solved: Solved) -> float:
        """``g`` of a state, which is zero where an operator is singular."""
        with self.system.at(solved.state):
            return singular.value(self.solver)

    def _called(self, n: Family) -> str:
        """A family of modes in words."""
        return f"n = {n}" if isinstance(n, int) else str(n)

    def _named(self, n: Family, _direction: float) -> tuple[str, dict[str, float]]:
        """Kind of the special point at a zero of a family's eigenvalue, and the numbers that say which it is.

        Args:
            n: The family.
            _direction: 1 if the eigenvalue becomes negative along the branch, -1 if it becomes positive.
        """
        return "bifurcation_point", {"n": float(n)}

    def null_vector(self, solved: Solved) -> np.ndarray:
        """Mode of a bifurcation point, of unit length in the mass norm."""
        with self.system.at(solved.state):
            return self.modes.variation(round(solved.values["n"])).nearest().vector

    def _count_at(self, state: State, n: Family) -> int:
        with self.system.at(state):
            return self.modes.variation(n).negative_count()


class ModalFamily(BranchFamily):
    """A modal branch on a family of meshes."""

    fine: ModalBranch

    marks: ClassVar[tuple[str, ...]] = ("n",)
    """Values of special points that say what they are and have no error, such as the wave number."""

    def special_points(self) -> list[SpecialPoint]:
        """As for any branch; bifurcation points have their wave number ``n``."""
        points = super().special_points()
        for point, same in zip(points, self._special(), strict=True):
            for mark in self.marks:
                if mark in same[-1].values:
                    point.values[mark], point.uncertainty[mark] = same[-1].values[mark], 0.0
        return points

    def _locate(self) -> list[tuple[Solved, ...]]:
        located = super()._locate()
        for same in located:
            if any(len({solved.values.get(mark) for solved in same}) > 1 for mark in self.marks):
                raise ConvergenceError("the order of the bifurcation points depends on the mesh")
        return located

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Number of negative eigenvalues in the symmetric space, without the zero of a special point."""
        counts = []
        for level, s in zip(self.levels, solved, strict=True):
            with level.system.at(s.state):
                spectrum = level.modes.variation(0).spectrum(2)
            counts.append(sum(value < -critical for value in spectrum.eigenvalues))
        return {"n_negative": Quantity(same_count(counts))}


class SinglePoint(ModalBranch):
    """A branch of one point: the start of another branch."""

    def __init__(
        self,
        continuation: Continuation,
        control: str,
        start: CurvePoint,
        modes: Modes,
        hidden: Sequence[str] = (),
    ) -> None:
        super().__init__(continuation, control, start, lambda _: True, modes, hidden)
        del self.points[1:]
        self.stalled = None

    def at(self, name: str, value: float, crossing: int = 1) -> Solved:
        """The point itself, if it has the value."""
        if crossing > len(self.crossings(name, value)):
            raise InputError(f"{name} = {value:g} is not taken on this branch")
        return self._itself()

    def at_position(self, like: CurvePoint, rates: dict[str, float], near: float) -> Solved:
        """The point of the branch."""
        return self._itself()

    def special(self) -> list[Solved]:
        """None: a single point has no special points."""
        return []

    def _itself(self) -> Solved:
        point = self.points[0]
        return self.complete(Solved(self._values(point.state), point.state))
