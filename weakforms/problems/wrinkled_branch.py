"""A branch of wrinkled states: traced on a plain mesh, its states solved on meshes fitted to their zones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.wrinkled_events import Event, events
from weakforms.problems.wrinkled_fit import PLACE, Membrane
from weakforms.problems.wrinkled_model import WRINKLED
from weakforms.problems.wrinkled_state import Held, solver_of
from weakforms.results import Branch, Failure, Field, Quantity, SpecialPoint, State
from weakforms.solvers import constraints as fixed
from weakforms.solvers.branch import DIAGNOSTICS, FittedBranch, SolutionCurve, Solved
from weakforms.solvers.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.family import CRITICAL, special_point
from weakforms.solvers.refinement import Estimate, estimate, estimate_in_norm
from weakforms.solvers.stability import Stability

NEAR_TURN = 2
"""Points around a limit load at which the volume is held in place of the load."""

PAST_LIMIT = 0.8
"""A branch ends past a limit load when the load has fallen to this share of it."""

MARGIN = 0.1
"""How much farther than its neighbours on the trace a limit load is looked for, over their distance."""

ROUND_OFF = 1e-10
"""Relative error that round-off may leave: of derivatives, and of fronts, on blocks of very different
length."""

PREDICTOR = 2e-2
"""Distance of predictor and solution aimed at on the plain mesh: the tangent jumps where zones change."""

EVENTS = ("zone_opening", "zone_closing")

VALUES = ("V", "Pi", "N")


class WrinkledBranch:
    """States of a membrane over its load, from none to an end, on a family of meshes.

    Args:
        membrane: Solves for single states.
        load_end: Load at which the branch ends.
        volume_end: Volume, over the unloaded one, at which it ends if the load does not get there.
        step: Largest arc-length step of the trace.
        cap: Highest order of convergence to reckon with.
    """

    name = "primary"

    def __init__(
        self, membrane: Membrane, load_end: float, volume_end: float, step: float, cap: float
    ) -> None:
        self.membrane, self.cap = membrane, cap
        self.control = membrane.control
        self._settings = (load_end, volume_end, step)
        self._failures: list[Failure] = []
        self.fronts: list[SpecialPoint] = []
        """Fronts of the states asked for so far, on the way."""

    # -- the trace on the plain mesh -----------------------------------------------------------

    @cached_property
    def trace(self) -> SolutionCurve:
        """The branch on the finest plain mesh, by arc-length from the unloaded state."""
        load_end, volume_end, step = self._settings
        membrane = self.membrane
        state, _ = membrane.by_homotopy(0.0)
        steps = StepControl(first=step / 8, largest=step, predictor_error=PREDICTOR)
        continuation = Continuation(solver_of(membrane.plain_model, (self.control,)), control=steps)
        unloaded = fixed.Held(self.control, 0.0)
        start = continuation.start(state, unloaded, towards={self.control: 1.0})
        most = volume_end * start.monitors["V"]

        peak = [0.0]

        def stop(point: CurvePoint) -> bool:
            load = point.state.loads[self.control]
            peak[0] = max(peak[0], load)
            return load > load_end or load < PAST_LIMIT * peak[0] or point.monitors["V"] > most

        return SolutionCurve(continuation, self.control, start, stop)

    @property
    def failures(self) -> list[Failure]:
        """What did not converge."""
        stalled = self.trace.stalled
        return [*([Failure(f"branch {self.name}", stalled)] if stalled else []), *self._failures]

    # -- single states -------------------------------------------------------------------------

    def near(self, name: str, value: float, crossing: int = 1) -> Solved:
        """The state of the plain mesh at a value of a column.

        Raises:
            InputError: When the column does not take the value that often.
        """
        trace = self.trace
        self.membrane.prepare()
        return trace.at(name, value, crossing)

    def _fitted(self, solved: Solved, name: str, fine_only: bool = False) -> list[Held]:
        plain = self.membrane.plain(solved.state)
        return self.membrane.fitted(plain, fixed.Held(name, solved.values[name]), fine_only)

    def columns(self, held: Held) -> dict[str, float]:
        """Columns of a state, and its fronts."""
        meridian = held.put()
        monitors = held.model.system.monitors()
        zones = held.all_zones(self.membrane.length)
        fronts = {f"Z_front_{i}": z for i, z in enumerate(zones.fronts, 1)}
        return {
            self.control: held.state.loads[self.control],
            **{name: monitors[name] for name in VALUES},
            "wrinkled_fraction": zones.share(WRINKLED, self.membrane.length),
            "r_max": meridian.extreme("r", 1),
            "gw_max": meridian.extreme("gw", 1),
            "gw_min": meridian.extreme("gw", -1),
            **fronts,
        }

    def _diagnostics(self, held: Held) -> dict[str, float]:
        held.put()
        factor = solver_of(held.model, held.scalars).factor
        factor.update()
        return {
            "n_negative": factor.negative_count(),
            "residual": held.record.norms[-1],
            "iterations": held.record.iterations,
        }

    # -- the branch ----------------------------------------------------------------------------

    @cached_property
    def _fine(self) -> list[tuple[int, Held]]:
        """Fitted states at the points of the trace; one that fails is listed and left out."""
        kept = []
        for i, (solved, name) in enumerate(self._prescribed()):
            try:
                kept.append((i, *self._fitted(solved, name, fine_only=True)))
            except ConvergenceError as error:
                self._failures.append(Failure(f"branch {self.name}, point {i}", str(error)))
        if not kept:
            raise ConvergenceError(f"branch {self.name}: no point could be solved for on fitted meshes")
        return kept

    def _prescribed(self) -> list[tuple[Solved, str]]:
        """What is held at each point of the trace: its load, or past a limit load its volume."""
        turns, out = self.trace.turns(), []
        first = turns[0] if len(turns) else len(self.trace.points)
        for i, point in enumerate(self.trace.points):
            values = {self.control: point.state.loads[self.control], "V": point.monitors["V"]}
            out.append((Solved(values, point.state), "V" if i >= first - NEAR_TURN else self.control))
        return out

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All columns over the points of the trace, each number with its uncertainty if wanted."""
        fine = [(i, self.columns(held) | self._diagnostics(held)) for i, held in self._fine]
        names = [n for n in fine[0][1] if not n.startswith("Z_front")]
        columns = {n: np.array([row[n] for _, row in fine]) for n in names}
        if not with_uncertainty:
            return Branch(self.name, self.control, columns)
        shown, errors, kept = [n for n in names if n not in DIAGNOSTICS], [], []
        for j, (i, held) in enumerate(self._fine):
            try:
                table = [self.columns(one) for one in self._levels(i, held)]
            except ConvergenceError as error:
                self._failures.append(Failure(f"branch {self.name}, point {i}", str(error)))
                continue
            errors.append([self._estimate(n, [v[n] for v in table]).uncertainty for n in shown])
            kept.append(j)
        spread = dict(zip(shown, np.array(errors).T, strict=True))
        columns = {n: values[kept] for n, values in columns.items()}
        return Branch(self.name, self.control, columns, spread)

    def _levels(self, i: int, held: Held) -> list[Held]:
        """A point of the branch on all meshes, its thinnest zone left out where a coarse one needs that."""
        solved, name = self._prescribed()[i]
        try:
            return [*self.membrane.others(held, fixed.Held(name, solved.values[name])), held]
        except ConvergenceError:
            return self._fitted(solved, name)

    # -- special points ------------------------------------------------------------------------

    def special_points(self) -> list[SpecialPoint]:
        """Limit loads, and loads at which zones open or close, in the order of the branch."""
        out = [(i, self._limit(i)[0]) for i in self.trace.turns().tolist()]
        for event in self._events:
            same = [
                Solved(values, event.levels[-1].state, event.kind) for values in self._event_values(event)
            ]
            out.append((event.after, self._point(same)))
        return [point for _, point in sorted(out, key=lambda item: item[0])]

    @cached_property
    def _events(self) -> list[Event]:
        found, failures = events(self.membrane, self._fine)
        self._failures.extend(failures)
        return found

    def _event_values(self, event: Event) -> list[dict[str, float]]:
        return [
            {
                **_without_fronts(self.columns(held)),
                "load": held.state.loads[self.control],
                "Z": held.touched,
                "state": event.state,
            }
            for held in event.levels
        ]

    def _point(self, same: Sequence[Solved]) -> SpecialPoint:
        shown = list(same[-1].values)
        caps = {name: self._order(name) for name in shown}
        point = special_point(same, shown, self.cap, self.name, self.control, caps)
        left = {n: ROUND_OFF * max(1.0, abs(v)) for n, v in point.values.items()}
        if point.kind in EVENTS:
            left["Z"] += PLACE
        return replace(point, uncertainty={n: u + left[n] for n, u in point.uncertainty.items()})

    def _limit(self, turn: int) -> tuple[SpecialPoint, list[Held]]:
        """The limit load after a point of the trace, on every mesh."""
        before, after = (self.trace.points[i].monitors["V"] for i in (turn, turn + 1))
        margin = MARGIN * (after - before)
        starts = self._fitted(self.near("V", before - margin), "V")
        found = [self._limit_from(start, before - margin, after + margin) for start in starts]
        values = [_without_fronts(self.columns(held)) for held in found]
        same = [Solved(v, held.state, "limit_point") for v, held in zip(values, found, strict=True)]
        return self._point(same), found

    def _limit_from(self, held: Held, low: float, high: float) -> Held:
        """The limit load between two volumes by arc-length, the zones' fronts unknowns as the load is."""
        model = held.model
        held.put()
        model.system.update_mass()
        continuation = Continuation(
            solver_of(model, held.scalars), held.constraints, StepControl(first=0.05, largest=0.5)
        )
        begin = continuation.start(held.state, fixed.Held("V", low), towards={"V": 1.0})
        branch = FittedBranch(continuation, self.control, begin, lambda point: point.monitors["V"] > high)
        limits = branch.special()
        if len(limits) != 1:
            raise ConvergenceError(
                f"{len(limits)} limit loads between V = {low:.6g} and {high:.6g} on a fitted mesh"
            )
        state = limits[0].state
        fronts = tuple(state.loads[name] for name in held.scalars[1 : 1 + len(held.zones.fronts)])
        return replace(held, state=state, zones=replace(held.zones, fronts=fronts), record=begin.record)

    # -- states --------------------------------------------------------------------------------

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """A state with a column at exactly a value, its fronts, and its profile if wanted.

        Raises:
            InputError: When the branch has no such state.
            ConvergenceError: When it is not solved on all meshes.
        """
        levels = self._special_state(name, value)
        if levels is None:
            levels = self._fitted(self.near(name, value, crossing), name)
        values = [self.columns(held) for held in levels]
        if any(set(v) != set(values[-1]) for v in values):
            raise ConvergenceError("the number of fronts depends on the mesh")
        quantities = {n: self._quantity(n, [v[n] for v in values]) for n in values[-1]}
        most = quantities["gw_max"]
        left = self._sliver_error(levels[-1], most.value)
        quantities["gw_max"] = replace(most, uncertainty=most.uncertainty + left)
        quantities |= self._spectrum(levels, CRITICAL if name == "limit_point" else 0.0)
        self.fronts.extend(self._fronts(values))
        fields = () if profile is None else (self._profile(levels, profile),)
        return State({name: value}, self.name, quantities, fields, crossing)

    def _sliver_error(self, held: Held, most: float) -> float:
        """What thin zones leave in the largest ``gw``, which is reached in them.

        In one without a block of its own the other state's law was used: ``gw - 1`` is right there to its
        order only. In one with a block, positions known to round-off are differentiated over tiny cells.
        """
        if held.slivers:
            return abs(most - 1)
        thinnest = np.diff([0.0, *held.zones.fronts, self.membrane.length]).min()
        return float(np.finfo(float).eps * held.model.cells / thinnest)

    def _special_state(self, name: str, value: float) -> list[Held] | None:
        if name == "limit_point":
            found = [self._limit(i)[1] for i in self.trace.turns().tolist()]
        elif name in EVENTS:
            found = [list(event.levels) for event in self._events if event.kind == name]
        else:
            return None
        if not 1 <= value <= len(found):
            raise InputError(f"{name} = {value:g}: this branch has {len(found)} of them")
        return found[int(value) - 1]

    def _order(self, name: str) -> float:
        """Highest order of convergence to reckon with: of energies, or of stretches, which all else holds."""
        return self.cap if name in (self.control, "load", "V", "Pi", "eigenvalue_1") else self.cap / 2

    def _estimate(self, name: str, values: list[float] | list[np.ndarray]) -> Estimate:
        found = estimate(values, self._order(name))
        left = ROUND_OFF * np.maximum(1.0, np.abs(found.value))
        return replace(found, uncertainty=found.uncertainty + left)

    def _quantity(self, name: str, values: list[float]) -> Quantity:
        found = self._estimate(name, values)
        order = float(found.order)
        return Quantity(float(found.value), float(found.uncertainty), order if order > 0 else None)

    def _spectrum(self, levels: Sequence[Held], critical: float) -> dict[str, Quantity]:
        """Lowest eigenvalue at fixed load and number of negative ones (below ``-critical``).

        By SLEPc, and by inertia.
        """
        spectra = []
        for held in levels:
            held.put()
            held.model.system.update_mass()
            spectra.append(Stability(held.model.system).spectrum(held.state, shift=critical))
        counts = {spectrum.n_negative for spectrum in spectra}
        if len(counts) != 1:
            raise ConvergenceError(f"stability depends on the mesh: negative counts {sorted(counts)}")
        lowest = self._quantity("eigenvalue_1", [spectrum.eigenvalues[0] for spectrum in spectra])
        return {"n_negative": Quantity(counts.pop()), "eigenvalue_1": lowest}

    def _fronts(self, values: Sequence[dict[str, float]]) -> list[SpecialPoint]:
        names = [name for name in values[-1] if name.startswith("Z_front")]
        out = []
        for name in names:
            rows = [{self.control: v[self.control], "V": v["V"], "Z": v[name]} for v in values]
            same = [Solved(row, None, "front") for row in rows]
            out.append(self._point(same))
        return out

    def _profile(self, levels: Sequence[Held], points: np.ndarray) -> Field:
        samples = [held.sampled(points) for held in levels]
        columns: dict[str, np.ndarray] = {"Z": points}
        uncertainty = {"Z": 0.0}
        for name in levels[-1].model.system.formulation.profile:
            columns[name] = samples[-1][name]
            left = ROUND_OFF * max(1.0, float(np.abs(columns[name]).max()))
            spread = estimate_in_norm([sample[name] for sample in samples], self._order(name))
            uncertainty[name] = spread + left
        return Field("profile", columns, uncertainty)


def _without_fronts(values: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in values.items() if not name.startswith("Z_front")}
