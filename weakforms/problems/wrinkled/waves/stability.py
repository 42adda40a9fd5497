"""Loads at which a wrinkled membrane becomes unstable to waves around it, or stable again."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.wrinkled.events import SLACK, Event
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.problems.wrinkled.waves.modes import waves_at
from weakforms.results import Failure
from weakforms.results.wording import not_crossed
from weakforms.solvers.equilibrium import constraints as fixed

TOLERANCE = 1e-11
"""Accuracy of a root, relative to the load or volume."""

STEPS, NOISE = 60, 1e-12
"""Largest number of steps to a root, and the magnitude of an eigenvalue that counts as zero."""

JUMP = 1e-3
"""A change is a jump if the eigenvalues on both sides exceed this fraction of those at the ends of the
interval. The tangent jumps where a zone opens or closes."""

MOST_SECANTS = 12
"""Largest number of secant steps on a coarser mesh, from the root on the finest one."""

MOST_SEARCHES = 3
"""Number of searches for an eigenvalue of the other sign next to the point of smallest magnitude."""


@dataclass(frozen=True)
class Sample:
    """A state of the finest mesh, its position on the branch, and its lowest eigenvalue."""

    value: float
    """Value of the prescribed column."""
    held: ZonedState
    lowest: float


@dataclass(frozen=True)
class Change:
    """A point where the lowest eigenvalue of a wave number is zero, or jumps from one sign to the other."""

    n: int
    direction: float
    """1 if the eigenvalue becomes negative along the branch, -1 if it becomes positive."""
    after: int
    """Index of the point of the branch before it."""
    levels: tuple[ZonedState, ...]
    """The state on every mesh, coarse to fine."""
    beside: ZonedState | None = None
    """The finest mesh's state of smallest magnitude, if ``levels`` belong to a zone's event close to it."""


class StabilityChanges:
    """Computes all changes of stability for one wave number.

    Args:
        membrane: Solves for states.
        n: Wave number.
        beta: Additional bending stiffness against waves.
        events: Gives the zones that open or close along the branch; called if an eigenvalue jumps.
        k: Which eigenvalue, in ascending order.
        value: The value that it passes.
    """

    def __init__(
        self,
        membrane: Membrane,
        n: int,
        beta: float = 0.0,
        events: Callable[[], Sequence[Event]] = tuple,
        k: int = 1,
        value: float = 0.0,
    ) -> None:
        self._wanted = k, value
        self.membrane, self.n, self.beta, self._events = membrane, n, beta, events
        self.failures: list[Failure] = []

    def lowest(self, held: ZonedState) -> float:
        """The eigenvalue, by default the lowest, minus the value that it passes."""
        k, value = self._wanted
        with waves_at(held) as waves:
            return waves.spectrum(self.n, k, self.beta).eigenvalues[k - 1] - value

    def between(self, points: Sequence[tuple[int, str, float, ZonedState]]) -> list[Change]:
        """All changes between neighbours of a branch, in order.

        Args:
            points: For each point its number, name and value of the prescribed column, and state.
        """
        found = []
        values = [self.lowest(held) for *_, held in points]
        for j in range(len(points) - 1):
            for a, b in self._brackets(points, values, j):
                try:
                    found.append(self._located(a, b, points[j + 1][1], points[j][0]))
                except ConvergenceError as error:
                    what = f"change of stability, n = {self.n}, after {points[j][1]} = {a.value:.6g}"
                    self.failures.append(Failure(what, str(error)))
        return found

    def passage(
        self, points: Sequence[tuple[int, str, float, ZonedState]], crossing: int
    ) -> list[ZonedState]:
        """The state on every mesh at which the eigenvalue has the value for the ``crossing``-th time.

        Raises:
            InputError: If it does not take the value that often.
            ConvergenceError: If it jumps over the value where a zone opens or closes, or is not found.
        """
        found, (k, value) = self.between(points), self._wanted
        name = f"Lambda_n{self.n}_{k}"
        if len(found) < crossing:
            if self.failures:
                raise ConvergenceError(f"{self.failures[0].what}: {self.failures[0].reason}")
            over = [self.lowest(held) + value for *_, held in points]
            raise InputError(not_crossed(name, value, crossing, len(found), over))
        change, control = found[crossing - 1], self.membrane.control
        if change.beside is not None:
            at = f"{control} = {change.levels[-1].state.loads[control]:.9g}"
            raise ConvergenceError(f"{name} jumps over {value:g} at {at}, where a zone opens or closes")
        return list(change.levels)

    # -- intervals ------------------------------------------------------------------------------

    def _brackets(
        self, points: Sequence[tuple[int, str, float, ZonedState]], values: Sequence[float], j: int
    ) -> list[tuple[Sample, Sample]]:
        """Intervals between two neighbours in which the eigenvalue changes its sign once."""
        name = points[j + 1][1]
        ends = [Sample(self._value(points[k], name), points[k][3], values[k]) for k in (j, j + 1)]
        if values[j] * values[j + 1] < 0:
            return [(ends[0], ends[1])]
        dip = _dips(values, j)
        if dip is None:
            return []
        return self._around_a_dip(*ends, name, dip)

    @staticmethod
    def _value(point: tuple[int, str, float, ZonedState], name: str) -> float:
        _, own, value, held = point
        if own == name:
            return value
        with held.lent():
            return held.model.system.monitor(name)

    def _around_a_dip(self, a: Sample, b: Sample, name: str, dip: float) -> list[tuple[Sample, Sample]]:
        """Two changes between neighbours of the same sign, if there are any."""
        for _ in range(MOST_SEARCHES):
            try:
                middle = self._at(name, a.value + dip * (b.value - a.value), a.held)
            except ConvergenceError:
                return []
            if middle.lowest * a.lowest < 0:
                return [(a, middle), (middle, b)]
            a, b = (a, middle) if abs(a.lowest) < abs(b.lowest) else (middle, b)
            dip = 0.5
        return []

    # -- roots ---------------------------------------------------------------------------------

    def _at(self, name: str, value: float, start: ZonedState) -> Sample:
        """The state of the finest mesh at a value of a column."""
        (held,) = self.membrane.fitted(start, fixed.Held(name, value), fine_only=True)
        return Sample(value, held, self.lowest(held))

    def _located(self, a: Sample, b: Sample, name: str, after: int) -> Change:
        tried = self._narrowed(a, b, name)
        direction, sides = 1.0 if a.lowest > 0 else -1.0, _jump(tried, a, b)
        try:
            return Change(self.n, direction, after, self._on_all(tried, name, sides))
        except ConvergenceError:
            fine = sides[0] if sides else tried[0]
            event = self._event_at(fine, name)
            if event is None:
                raise
            return Change(self.n, direction, after, event.levels, fine.held)

    def _on_all(
        self, tried: Sequence[Sample], name: str, sides: tuple[Sample, Sample] | None
    ) -> tuple[ZonedState, ...]:
        """The root on every mesh, starting from the root on the finest one."""
        if sides is not None:
            before, beyond = sides
            raise ConvergenceError(
                f"Lambda for n = {self.n} jumps from {before.lowest:.3g} to {beyond.lowest:.3g} at "
                f"{name} = {before.value:.9g}, where no zone opens or closes"
            )
        fine = tried[0]
        slope = _slope(tried)
        coarser = self.membrane.others(fine.held, fixed.Held(name, fine.value))
        levels = [self._on_mesh(k, held, name, fine.value, slope) for k, held in enumerate(coarser)]
        return (*levels, fine.held)

    def _event_at(self, fine: Sample, name: str) -> Event | None:
        """The zone that opens or closes where an eigenvalue changes its sign, if one does.

        An opening zone stiffens the membrane by a finite amount while it is still too thin for a mesh,
        because its width grows like the square root of the load.
        """
        for event in self._events():
            held = event.levels[-1]
            value = self._value(
                (0, self.membrane.control, held.state.loads[self.membrane.control], held), name
            )
            if abs(value - fine.value) <= SLACK * max(1.0, abs(value)):
                return event
        return None

    def _narrowed(self, a: Sample, b: Sample, name: str) -> list[Sample]:
        """Samples up to the root between two samples, the nearest to the root first.

        False position with halved weights (Illinois). If a state is not found, for example at zero width of a
        zone, the next one is tried.

        Raises:
            ConvergenceError: If there is no state near the root.
        """
        tried, fa, fb, side = [a, b], a.lowest, b.lowest, 0
        for _ in range(STEPS):
            middle = self._first_found(a, b, name, (fa / (fa - fb), 0.5, 0.4, 0.6, 0.25, 0.75))
            moved = abs(middle.value - tried[-1].value)
            tried.append(middle)
            if abs(middle.lowest) < NOISE or moved <= TOLERANCE * max(1.0, abs(middle.value)):
                return sorted(tried, key=lambda s: abs(s.lowest))
            if middle.lowest * b.lowest > 0:
                b, fb, fa, side = middle, middle.lowest, fa / 2 if side < 0 else fa, -1
            else:
                a, fa, fb, side = middle, middle.lowest, fb / 2 if side > 0 else fb, 1
        raise ConvergenceError(f"no root of Lambda for n = {self.n} after {STEPS} steps")

    def _first_found(self, a: Sample, b: Sample, name: str, shares: Sequence[float]) -> Sample:
        """The first state that is found at some positions between two samples."""
        last = ConvergenceError("no position was tried")
        for share in shares:
            value = a.value + share * (b.value - a.value)
            nearest = a if share < 0.5 else b
            try:
                return self._at(name, value, nearest.held)
            except ConvergenceError as error:
                last = error
        raise last

    def _on_mesh(self, level: int, held: ZonedState, name: str, value: float, slope: float) -> ZonedState:
        """The root on a coarser mesh by secants, starting from the root on the finest one."""
        last = None
        for _ in range(MOST_SECANTS):
            lowest = self.lowest(held)
            if last is not None and value != last[0] and lowest != last[1]:
                slope = (lowest - last[1]) / (value - last[0])
            step = -lowest / slope
            if abs(step) <= TOLERANCE * max(1.0, abs(value)):
                return held
            last = value, lowest
            value += step
            held = self.membrane.fit(level, held, held.zones, (fixed.Held(name, value),), same=True)
        raise ConvergenceError(f"the root of Lambda for n = {self.n} was not found on mesh {level}")


def _jump(tried: Sequence[Sample], a: Sample, b: Sample) -> tuple[Sample, Sample] | None:
    """The samples next to a jump between two samples; none if the eigenvalue passes through zero."""
    before, beyond = (
        min((s for s in tried if s.lowest * near.lowest > 0), key=lambda s: abs(s.value - far.value))
        for near, far in ((a, b), (b, a))
    )
    least = JUMP * (abs(a.lowest) + abs(b.lowest))
    return (before, beyond) if min(abs(before.lowest), abs(beyond.lowest)) > least else None


def _slope(nearest: Sequence[Sample]) -> float:
    """Slope of the eigenvalue at the first of some samples, from samples that are not too close together."""
    first = nearest[0]
    far = next((s for s in nearest[1:] if abs(s.value - first.value) > 1e-6), nearest[-1])
    return (far.lowest - first.lowest) / (far.value - first.value)


def _dips(values: Sequence[float], j: int) -> float | None:
    """Position between two points of the same sign where the eigenvalue may be zero, as a fraction.

    It is the middle, if one of the two is a point of smallest magnitude on the branch.
    """
    k = j if abs(values[j]) < abs(values[j + 1]) else j + 1
    if not 0 < k < len(values) - 1:
        return None
    before, here, after = values[k - 1 : k + 2]
    if before * here < 0 or here * after < 0 or abs(here) > min(abs(before), abs(after)):
        return None
    return 0.5
