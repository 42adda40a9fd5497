"""The branch of an annulus on one mesh, in parts: taut, with a front, wrinkled all over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.annulus.model import FRONT, AnnulusModel, Ring, Zones
from weakforms.problems.meridian.fields import Meridian, carried
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

THINNEST = 1e-5
"""Part of the width that a new zone has on its first mesh; its front moves in proportion to the angle."""

VERGE = 1e-3
"""Distance of ``gw`` from 1, on the wrong side, that counts as an error of the elements next to a front. Such
a zone changes the energy by the square of it; meshes that are finer show whether it is there."""

SAMPLES = 301
"""Number of places at which the zones of a state are looked at."""

STEP = 0.25
"""Steps of the pre-stretch, relative to the first angle, on the way to an annulus without one."""

ON_FRONT = Held("gw_front", 1.0)
"""The equation of the front."""

WHOLE = Held("psi", 0.0)
"""No turn: the first state of a pre-stretched annulus."""


@dataclass(frozen=True)
class Event:
    """What ends a part of the branch: a column that passes a value; and the part that follows."""

    column: str
    rises: bool
    kind: str
    after: Zones


EVENTS: dict[Zones, Event] = {
    "taut": Event("gw_in", False, "wrinkling_onset", "front"),
    "front": Event(FRONT, True, "zone_closing", "wrinkled"),
    "wrinkled": Event("gw_out", True, "zone_opening", "front"),
}
"""Wrinkles spread from the inner edge outwards; the last taut ring is at the outer edge."""


@dataclass
class Part:
    """One part of the branch, and the point at which it ends and the next one begins, if there is one."""

    zones: Zones
    curve: SolutionCurve
    joint: Solved | None = None


class AnnulusPhases:
    """All parts of the branch on one mesh.

    Args:
        comm: Ranks.
        ring: The annulus.
        relaxed: Whether it wrinkles; else the full energy holds everywhere.
        ends: First angle of an annulus without pre-stretch, which wrinkles at once, and the last angle.
        cells: Cells over the radius.
        degree: Degree of the elements.
        step: Largest arc-length step.
        judged: Whether states with other zones than their mesh are refused, as on the finest mesh.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        ring: Ring,
        relaxed: bool,
        ends: tuple[float, float],
        cells: int,
        degree: int,
        step: float,
        judged: bool = True,
    ) -> None:
        self._model = cache(lambda zones: AnnulusModel(comm, ring, zones, cells, degree))
        self._fields = cache(lambda zones: _fields(self._model(zones)))
        self.ring, self.relaxed, self.ends, self.step = ring, relaxed, ends, step
        self.judged = judged and relaxed

    @cached_property
    def parts(self) -> list[Part]:
        """The parts in their order.

        Raises:
            ConvergenceError: If a part is not found, or its zones are not those of its states.
        """
        return list(self._parts())

    def _parts(self) -> Iterator[Part]:
        begins_taut = not self.relaxed or self.ring.s > 1
        zones, start = ("taut", (self._at_rest("taut"), WHOLE)) if begins_taut else self._first()
        while True:
            yield (part := self._part(zones, *start))
            if part.joint is None:
                return
            event = EVENTS[zones]
            start = self._start(zones, event.after, part.joint.state)
            zones = event.after

    def _part(self, zones: Zones, start: State, held: Held) -> Part:
        """A part from its first state until its event, or until the last angle."""
        model, event, last = self._model(zones), EVENTS[zones], self.ends[1]
        limit = self._thin(outer=True) if event.column == FRONT else 1.0

        def beyond(point: CurvePoint) -> bool:
            value = {**point.state.loads, **point.monitors}[event.column]
            return self.relaxed and (value > limit) == event.rises

        steps = StepControl(first=self.step / 8, largest=self.step)
        continuation = Continuation(self._solver(zones), [ON_FRONT] if model.fronts else [], steps)
        begin = continuation.start(start, held, towards={"psi": 1.0})
        kind = FittedBranch if model.fronts else EquilibriumBranch

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["psi"] > last or beyond(point) or point.monitors["J_in"] < 0

        curve = kind(continuation, "psi", begin, stop)
        part = Part(zones, curve)
        if curve.stalled is None and curve.points[-1].monitors["J_in"] < 0:
            curve.end_at("J_in", 0.0)
            curve.ended = (
                f"annulus: at psi = {curve.points[-1].state.loads['psi']:.6g} the sheet folds over at the "
                "inner edge, where it has no width left across its wrinkles; lower psi_end"
            )
        elif curve.stalled is None and beyond(curve.points[-1]):
            curve.end_at(event.column, limit)
            part.joint = curve.solved(curve.points[-1].state, event.kind)
        for point in curve.points if self.judged else ():
            self._require_zones(zones, point.state)
        return part

    def _at_rest(self, zones: Zones) -> State:
        """The annulus with equal stretches, before its turn."""
        model = self._model(zones)
        return replace(model.system.initial, marks=model.marks)

    def _solver(self, zones: Zones) -> ExtendedNewton:
        model = self._model(zones)
        return ExtendedNewton(model.system, ["psi", *model.fronts])

    def _thin(self, outer: bool) -> float:
        """Radius of a front next to an edge."""
        a = self.ring.a
        return 1 - THINNEST * (1 - a) if outer else a + THINNEST * (1 - a)

    # -- from one mesh to another --------------------------------------------------------------

    def _start(self, before: Zones, after: Zones, state: State) -> tuple[State, Held]:
        """First state of the next part, and what selects it."""
        if after == "wrinkled":
            return self._moved(before, after, state), Held("psi", state.loads["psi"])
        front = self._thin(outer=before == "wrinkled")
        return self._moved(before, after, state, front), Held(FRONT, front)

    def _moved(self, before: Zones, after: Zones, state: State, front: float | None = None) -> State:
        """A state interpolated to another mesh."""
        old, new = self._model(before), self._model(after)
        loads = {"psi": state.loads["psi"], "s": self.ring.s}
        loads |= {} if front is None else {FRONT: front}
        with old.system.at(state):
            u = carried(lambda at: self._fields(before).sampled(at, state.loads), new, loads)
        return State(u, loads, new.marks)

    def _first(self) -> tuple[Zones, tuple[State, Held]]:
        """The first state of an annulus without pre-stretch, from a slightly stretched one.

        Newton's method may not settle where zones change inside of cells. The annulus is then wrinkled all
        over, or nearly so.

        Raises:
            ConvergenceError: If it is not found, or has other zones than a wrinkled and a taut one.
        """
        try:
            return self._first_on("by_state")
        except ConvergenceError:
            return self._first_on("wrinkled")

    def _first_on(self, zones: Zones) -> tuple[Zones, tuple[State, Held]]:
        """The same, solved for on a mesh without a front at first."""
        model, psi = self._model(zones), self.ends[0]
        solver = ExtendedNewton(model.system, max_iterations=60, line_search="bt")

        def at(state: State, s: float) -> State:
            return solver.solve(State(state.u, {"psi": psi, "s": s}, state.marks))[0]

        state = walk(at, at(self._at_rest(zones), 1 + psi), 1 + psi, 1.0, STEP * psi)
        places = np.linspace(self.ring.a, 1.0, SAMPLES)
        with model.system.at(state):
            taut = self._fields(zones).sampled(places, state.loads)["gw"] > 1
        held = Held("psi", psi)
        if not taut.any():
            return "wrinkled", (self._moved(zones, "wrinkled", state), held)
        if np.any(np.diff(taut.astype(int)) < 0):
            raise ConvergenceError(f"annulus: at psi = {psi:g} a taut ring lies inside of a wrinkled one")
        front = float(np.clip(places[np.argmax(taut)], self._thin(outer=False), self._thin(outer=True)))
        return "front", (self._moved(zones, "front", state, front), held)

    def _require_zones(self, zones: Zones, state: State) -> None:
        """Refuse a state whose zones are not those of its mesh.

        Raises:
            ConvergenceError: With the place where they differ.
        """
        model, x = self._model(zones), np.linspace(0.0, self._model(zones).blocks, SAMPLES)
        with model.system.at(state):
            found = self._fields(zones).at(x)
        wrinkled = np.full(SAMPLES, zones == "wrinkled") if zones != "front" else x < 1
        if np.min(found["J"]) < -VERGE:
            raise ConvergenceError(f"annulus: at psi = {state.loads['psi']:.6g} the sheet folds over")
        wrong = np.where(wrinkled, np.maximum(found["gw"] - 1, 1 - found["lam1"]), 1 - found["gw"])
        if not np.all(wrong < VERGE):
            place = model.material(x, state.loads)[np.argmax(wrong)]
            raise ConvergenceError(
                f"annulus: at psi = {state.loads['psi']:.6g} the zones differ from one wrinkled part inside "
                f"and one taut ring outside, at R = {place:.6g}; raise cells, or lower psi_end"
            )


def _fields(model: AnnulusModel) -> Meridian:
    e = model.expressions
    named = {"u": model.unknown[0], "w": model.unknown[1], "gw": e["gw"], "lam1": e["lam1"]}
    named["J"] = e["J"]
    return Meridian(model, named)
