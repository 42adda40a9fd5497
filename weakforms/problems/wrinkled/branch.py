"""A branch of wrinkled states: traced on a plain mesh, with states on meshes fitted to their zones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from math import inf

import numpy as np

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.wave_numbers import EIGENVALUE
from weakforms.problems.wrinkled.events import Event, events
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.readings import EVENTS, Readings
from weakforms.problems.wrinkled.state import ZonedState, solver_of
from weakforms.problems.wrinkled.waves.stability import Change, StabilityChanges
from weakforms.results import Absence, Branch, Failure, SpecialPoint, State
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import DIAGNOSTICS, SolutionCurve, Solved
from weakforms.solvers.equilibrium import constraints as fixed
from weakforms.solvers.support.provenance import quadrature_degree
from weakforms.solvers.uncertainty.family import CRITICAL

NEAR_TURN = 2
"""Number of points around a limit load at which the volume is prescribed instead of the load."""

PAST_LIMIT = 0.8
"""After a limit load a branch ends when the load has decreased to this fraction of it."""

MARGIN = 0.1
"""The search for a limit load extends beyond its neighbours on the trace by this fraction of their
distance."""

SHARES = (0.0, 0.5, 0.75)
"""Parts of the way between these neighbours at which the search begins, one after the other."""

PREDICTOR = 2e-2
"""Target distance between predictor and solution on the plain mesh, where the tangent jumps when zones
change."""


STEP, VOLUME_END = 0.5, 30.0
"""Default largest step of a branch, and volume over the unloaded one at which it ends."""


class WrinkledBranch:
    """States of a membrane over its load, from zero to an end, on a family of meshes.

    Args:
        membrane: Object that solves for single states.
        load_end: Load at which the branch ends.
        volume_end: Volume, relative to the unloaded one, at which it ends if it does not reach this load.
        step: Largest arc-length step of the trace.
        readings: Post-processing of its states, with the wave numbers of the stability analysis.
    """

    name = "primary"
    usual_load = inf
    """Load above which steps grow in proportion to it."""

    def __init__(
        self, membrane: Membrane, load_end: float, volume_end: float, step: float, readings: Readings
    ) -> None:
        self.membrane, self.readings = membrane, readings
        self.control = membrane.control
        self._settings = (load_end, volume_end, step)
        self._failures: list[Failure] = []
        self.fronts: list[SpecialPoint] = []
        """Fronts of the states requested so far."""

    # -- the trace on the plain mesh -----------------------------------------------------------

    @cached_property
    def trace(self) -> SolutionCurve:
        """The branch on the finest plain mesh, by arc length from the unloaded state."""
        load_end, volume_end, step = self._settings
        steps = StepControl(step / 8, step, predictor_error=PREDICTOR, usual_load=self.usual_load)
        continuation = Continuation(solver_of(self.membrane.plain_model, (self.control,)), control=steps)
        with self.membrane.weighed():
            start = self._start(continuation)
            most, peak = volume_end * start.monitors["V"], [start.state.loads[self.control]]

            def stop(point: CurvePoint) -> bool:
                load = point.state.loads[self.control]
                peak[0] = max(peak[0], load)
                return load > load_end or self._is_past_limit(point, peak[0]) or point.monitors["V"] > most

            return SolutionCurve(continuation, self.control, start, stop)

    def _is_past_limit(self, point: CurvePoint, peak: float) -> bool:
        """Whether the load has decreased so far from its largest value that the branch ends."""
        return point.state.loads[self.control] < PAST_LIMIT * peak

    def _start(self, continuation: Continuation) -> CurvePoint:
        """The start of the trace: no load.

        Raises:
            AbsentError: If its law gives way at the disks.
            ConvergenceError: If it is not found; the message names the parameters of the membrane's shape.
        """
        try:
            state, _ = self.membrane.by_homotopy(0.0)
        except ConvergenceError as error:
            shape = [name for name in ("delta", "M", "Af") if name in self.membrane.values]
            hint = f"; choose a smaller delta, or another {' or '.join(shape[1:])}" if shape else ""
            raise ConvergenceError(f"the membrane without load is not found: {error}{hint}") from error
        unloaded = fixed.Held(self.control, 0.0)
        return continuation.start(state, unloaded, towards={self.control: 1.0})

    @property
    def absent(self) -> list[Absence]:
        """Nothing: a branch of any membrane begins without load, and ends where it was asked to."""
        return []

    @property
    def warnings(self) -> list[str]:
        """None: every mesh is used."""
        return []

    @property
    def failures(self) -> list[Failure]:
        """Solves that did not converge."""
        stalled = self.trace.stalled
        return [*([Failure(f"branch {self.name}", stalled)] if stalled else []), *self._failures]

    # -- single states -------------------------------------------------------------------------

    @property
    def quadrature_degree(self) -> int:
        """Quadrature degree of the residual."""
        return quadrature_degree(self.membrane.plain_model.system.formulation.residual)

    def near(self, name: str, value: float, crossing: int = 1) -> Solved:
        """The state of the plain mesh at a value of a column, from which fitted meshes start.

        Where a front is inside of a cell, Newton's method may go back and forth between two states of the
        cell. Then it is the state between two points of the trace, which fitted meshes can start from too.

        Raises:
            InputError: If the column does not take the value that often.
        """
        trace = self.trace
        with self.membrane.weighed():
            try:
                return trace.at(name, value, crossing)
            except ConvergenceError:
                before = int(trace.crossings(name, value)[crossing - 1])
                return Solved({name: value}, trace.interpolated(before, name, value))

    def _fitted(self, solved: Solved, name: str, fine_only: bool = False) -> list[ZonedState]:
        plain = self.membrane.plain(solved.state)
        return self.membrane.fitted(plain, fixed.Held(name, solved.values[name]), fine_only)

    # -- the branch ----------------------------------------------------------------------------

    @cached_property
    def _fine(self) -> list[tuple[int, ZonedState]]:
        """Fitted states at the points of the trace; a failed one is listed and left out."""
        kept = []
        for i, (solved, name) in enumerate(self._prescribed()):
            try:
                kept.append((i, self._fine_state(solved, name, kept[-1][1] if kept else None)))
            except ConvergenceError as error:
                self._failures.append(Failure(f"branch {self.name}, point {i}", str(error)))
        if not kept:
            raise ConvergenceError(f"branch {self.name}: no point could be solved for on fitted meshes")
        return kept

    def _fine_state(self, solved: Solved, name: str, before: ZonedState | None) -> ZonedState:
        """A state on the finest mesh, from that on the plain mesh or else from the state before it."""
        try:
            return self._fitted(solved, name, fine_only=True)[0]
        except ConvergenceError:
            if before is None:
                raise
            return self.membrane.fitted(before, fixed.Held(name, solved.values[name]), fine_only=True)[0]

    def _prescribed(self) -> list[tuple[Solved, str]]:
        """The column prescribed at each point of the trace: its load, or near a limit load its volume."""
        turns, out = self.trace.turns(), []
        first = turns[0] if len(turns) else len(self.trace.points)
        for i, point in enumerate(self.trace.points):
            values = {self.control: point.state.loads[self.control], "V": point.monitors["V"]}
            out.append((Solved(values, point.state), "V" if i >= first - NEAR_TURN else self.control))
        return out

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All columns over the points of the trace, with uncertainties if requested.

        Raises:
            ConvergenceError: If no point can be solved for on all meshes.
        """
        fine = [(i, self._all_columns(held) | self.readings.diagnostics(held)) for i, held in self._fine]
        names = list(fine[0][1])
        columns = {n: np.array([row[n] for _, row in fine]) for n in names}
        if not with_uncertainty:
            return Branch(self.name, self.control, columns)
        shown, errors, kept = [n for n in names if n not in DIAGNOSTICS], [], []
        for j, (i, held) in enumerate(self._fine):
            try:
                table = [self._all_columns(one) for one in self._levels(i, held)]
            except ConvergenceError as error:
                self._failures.append(Failure(f"branch {self.name}, point {i}", str(error)))
                continue
            errors.append([self.readings.estimate(n, [v[n] for v in table]).uncertainty for n in shown])
            kept.append(j)
        if not kept:
            raise ConvergenceError(
                f"branch {self.name}: no point could be solved for on all meshes; raise cells"
            )
        spread = dict(zip(shown, np.array(errors).T, strict=True))
        columns = {n: values[kept] for n, values in columns.items()}
        return Branch(self.name, self.control, columns, spread)

    def _all_columns(self, held: ZonedState) -> dict[str, float]:
        return self.readings.without_fronts(held) | self.readings.eigenvalues(held)

    def _levels(self, i: int, held: ZonedState) -> list[ZonedState]:
        """A point of the branch on all meshes, without its thinnest zone if a coarse mesh needs that."""
        solved, name = self._prescribed()[i]
        try:
            return [*self.membrane.others(held, fixed.Held(name, solved.values[name])), held]
        except ConvergenceError:
            return self._fitted(solved, name)

    # -- special points ------------------------------------------------------------------------

    def special_points(self) -> list[SpecialPoint]:
        """Limit loads, openings and closings of zones, appearance and disappearance of waves, in order."""
        out = [(i, self._limit(i)[0]) for i in self.trace.turns().tolist()]
        out += [(e.after, self._point(self._event_values(e), e.kind, ("state",))) for e in self._events]
        for change in self.changes:
            out.append((change.after, self._changed(change)))
        return [point for _, point in sorted(out, key=lambda item: item[0])]

    def _point(self, same: Sequence[dict[str, float]], kind: str, exact: Sequence[str] = ()) -> SpecialPoint:
        return self.readings.point([Solved(values, None, kind) for values in same], self.name, exact)

    def _changed(self, change: Change) -> SpecialPoint:
        """A change of stability; if a zone's event replaces it, their distance adds to the uncertainty."""
        read = self.readings.without_fronts
        exact = {"n": float(change.n), "direction": change.direction}
        point = self._point([read(held) | exact for held in change.levels], "stability_change", tuple(exact))
        if change.beside is None:
            return point
        near, own = read(change.beside), read(change.levels[-1])
        off = {name: abs(near[name] - own[name]) for name in near}
        wider = {name: u + off.get(name, 0.0) for name, u in point.uncertainty.items()}
        return replace(point, uncertainty=wider)

    @cached_property
    def changes(self) -> list[Change]:
        """Points where waves appear or disappear, for each wave number."""
        found = []
        for n in self.readings.waves:
            passages = self._passages(n)
            found += passages.between(self._points)
            self._failures += passages.failures
        return found

    @property
    def _points(self) -> list[tuple[int, str, float, ZonedState]]:
        """Number, name and value of the prescribed column, and state of each point of the branch."""
        prescribed = self._prescribed()
        return [(i, prescribed[i][1], prescribed[i][0].values[prescribed[i][1]], h) for i, h in self._fine]

    def _passages(self, n: int, k: int = 1, value: float = 0.0) -> StabilityChanges:
        return StabilityChanges(self.membrane, n, self.readings.beta, lambda: self._events, k, value)

    @cached_property
    def _events(self) -> list[Event]:
        found, failures = events(self.membrane, self._fine, [name for _, name in self._prescribed()])
        self._failures.extend(failures)
        return found

    def _event_values(self, event: Event) -> list[dict[str, float]]:
        return [
            {
                **self.readings.without_fronts(held),
                "load": held.state.loads[self.control],
                self.readings.abscissa: held.touched,
                "state": event.state,
            }
            for held in event.levels
        ]

    def _limit(self, turn: int) -> tuple[SpecialPoint, list[ZonedState]]:
        """The limit load after a point of the trace, on all meshes.

        If a zone opens or closes near it, only states on the same side have its zones.
        """
        before, after = (self.trace.points[i].monitors["V"] for i in (turn, turn + 1))
        margin, errors = MARGIN * (after - before), []
        for share in SHARES:
            begin = before - margin + share * (after - before)
            try:
                starts = self._fitted(self.near("V", begin), "V")
                found = [self.membrane.limit(start, begin, after + margin) for start in starts]
            except ConvergenceError as error:
                errors.append(error)
            else:
                values = [self.readings.without_fronts(held) for held in found]
                return self._point(values, "limit_point"), found
        raise errors[0]

    # -- states --------------------------------------------------------------------------------

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """The state at which a column has exactly a value, with its fronts, and its profile if requested.

        Raises:
            InputError: If the branch has no such state.
            ConvergenceError: If the solve fails on some mesh.
        """
        levels = self._special_state(name, value)
        eigenvalue = EIGENVALUE.fullmatch(name)
        if eigenvalue:
            passages = self._passages(int(eigenvalue[1]), int(eigenvalue[2]), value)
            levels = passages.passage(self._points, crossing)
        elif levels is None:
            levels = self._fitted(self.near(name, value, crossing), name)
        quantities = self.readings.quantities(levels, CRITICAL if name == "limit_point" else 0.0)
        self.fronts.extend(self.readings.fronts(levels, self.name))
        fields = () if profile is None else self.readings.fields(levels, profile)
        return State({name: value}, self.name, quantities, fields, crossing)

    def _special_state(self, name: str, value: float) -> list[ZonedState] | None:
        if name == "limit_point":
            found = [self._limit(i)[1] for i in self.trace.turns().tolist()]
        elif name in EVENTS:
            found = [list(event.levels) for event in self._events if event.kind == name]
        elif name == "stability_change":
            found = [list(change.levels) for change in sorted(self.changes, key=lambda c: c.after)]
        else:
            return None
        if not 1 <= value <= len(found):
            raise InputError(f"{name} = {value:g}: this branch has {len(found)} of them")
        return found[int(value) - 1]
