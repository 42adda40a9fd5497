"""States of a wrinkled membrane on meshes fitted to its zones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.fields import carried
from weakforms.problems.meridian.model import BY_STATE, Marks
from weakforms.problems.wrinkled.fields import Zones
from weakforms.problems.wrinkled.model import WrinkledModel
from weakforms.problems.wrinkled.state import (
    AtBreak,
    Layout,
    Mesh,
    Touch,
    ZonedState,
    model_on,
    solver_of,
)
from weakforms.solvers.continuation.branch import FittedBranch
from weakforms.solvers.continuation.continuation import Continuation, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import Constraint
from weakforms.solvers.equilibrium.state import State

THINNEST, SLIVER = 1e-8, 1e-6
"""Zones thinner than this fraction of the length are left out; the second value applies if round-off in a
thin zone's block prevents convergence. Such zones have no effect on other quantities."""

COARSE, PASSES = 1e-3, 2
"""Before the fronts are unknowns, zones thinner than this fraction of the length get no break points; and the
number of solves before that in which break points follow the fronts of the last solution."""

ATTEMPTS = 8
"""Largest number of patterns of zones that are tried for one state."""

FLAT = 1e-8
"""Accepted relative Newton step for the position of a minimum of ``gw``, which is less accurate than other
unknowns and has little effect on them."""

PLACE = 1e-7
"""Resulting error of the position."""


VERGE, VERGE_FITTED = 1e-7, 1e-10
"""Deviation of ``gw`` from 1 that counts as zero, on a plain mesh and on a fitted mesh."""


class FittedMembrane:
    """One membrane at given parameters, with its states on meshes fitted to their zones.

    Args:
        comm: Ranks.
        body: Geometry and thickness.
        values: Parameters: the body's, ``c2``, ``gamma``.
        liquid: Whether the load is ``zw``; else it is ``p``.
        cells: Cells of each block on each mesh, coarse to fine.
        degree: Degree of the elements.
        energy: See :class:`WrinkledModel`.
        near_fronts: Distances from fronts at which further blocks end, for short waves.
        material: A law that replaces the Mooney-Rivlin law.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        body: Body,
        values: Mapping[str, float],
        liquid: bool,
        cells: Sequence[int],
        degree: int,
        energy: str,
        near_fronts: Sequence[float] = (),
        material: Chosen | None = None,
    ) -> None:
        self.body, self.liquid, self.energy = body, liquid, energy
        self.near_fronts = tuple(near_fronts)
        self.values = {"gamma": 0.0, "c2": 0.0, "residual_stiffness": 0.0, "p": 0.0, "zw": 0.0, **values}
        self.length = float(body.length(self.values))
        self.meshes = [Mesh(comm, comm.py2f(), body, n, degree, energy, material) for n in cells]
        self.control = "zw" if liquid else "p"
        self.on_meshes: list[dict[str, float]] = [{} for _ in cells]
        """Parameters that are results themselves, for each mesh, so that differences between meshes include
        their errors. Those of the finest mesh are also in ``values``."""

    def fitted(self, start: ZonedState, constraint: Constraint, fine_only: bool = False) -> list[ZonedState]:
        """The state given by a constraint on the control, on every mesh, coarse to fine, or the finest.

        Raises:
            ConvergenceError: If no pattern of zones agrees with the zones of its solution.
        """
        ways = [(THINNEST, True), (SLIVER, True)]
        if start.layout is not None:  # fitted already: its own zones may suffice if a plain mesh does not
            ways.append((THINNEST, False))
        for thinnest, adapt in ways:
            try:
                fine = self._pattern(start, constraint, thinnest, adapt)
                return [fine] if fine_only else [*self.others(fine, constraint), fine]
            except ConvergenceError as error:
                last = error
        raise last

    def others(self, fine: ZonedState, constraint: Constraint) -> list[ZonedState]:
        """A state of the finest mesh on the coarser ones.

        Raises:
            ConvergenceError: If one of them has no such state; the message says which.
        """
        out = []
        for k, mesh in enumerate(self.meshes[:-1]):
            try:
                out.append(self.fit(k, fine, fine.zones, (constraint,), same=True))
            except ConvergenceError as error:
                cells = mesh.cells * fine.model.blocks
                raise ConvergenceError(f"on the mesh of {cells} cells: {error}; raise cells") from error
        for held in out if fine.slivers else ():
            shown = held.shown_zones(VERGE_FITTED, self.liquid)
            own = fine.zones.left_out_of(shown)
            nothing = tuple(0.0 if z < self.length / 2 else self.length for z in fine.slivers)
            held.slivers = own if len(own) == len(fine.slivers) else nothing
        return out

    def _pattern(self, start: ZonedState, constraint: Constraint, thinnest: float, adapt: bool) -> ZonedState:
        """Solve on the finest mesh with the zones of the last solution until they do not change."""
        held = self._adapted(start, constraint) if adapt else start
        wanted, last = held.zones.thicker_than(thinnest, self.length), "none tried"
        for _ in range(ATTEMPTS):
            try:
                held = self.fit(len(self.meshes) - 1, held, wanted, (constraint,))
            except ConvergenceError as error:
                if not wanted.fronts:
                    raise
                last, wanted = str(error), wanted.without_thinnest(self.length)
                continue
            shown = held.shown_zones(VERGE_FITTED, self.liquid)
            found = shown.thicker_than(thinnest, self.length)
            if found.kind == held.zones.kind:
                if self.near_fronts and found.fronts:
                    held = self.fit(len(self.meshes) - 1, held, held.zones, (constraint,), graded=True)
                held.slivers = found.left_out_of(shown)
                return held
            wanted = found
        raise ConvergenceError(f"no pattern of zones agrees with its own solution ({last})")

    def _adapted(self, start: ZonedState, constraint: Constraint) -> ZonedState:
        """A plain state solved again, with break points at the fronts of the last solution.

        This removes the error of a front inside a cell, except for the error of the front itself.
        """
        held = start
        for _ in range(PASSES):
            layout = Layout.of(held.zones.thicker_than(COARSE, self.length), self.length)
            model = model_on(self.meshes[-1], len(layout.breaks) - 1)
            unmarked = np.full(model.blocks, BY_STATE)
            marks = Marks(unmarked, unmarked if self.liquid else layout.marks.wet)
            guess = self.moved(held, model, layout.breaks, marks)
            state, record = solver_of(model, (self.control,)).solve(guess, [constraint])
            held = ZonedState(model, state, held.zones, record, (self.control,))
            held.zones = held.shown_zones(VERGE, self.liquid)
        return held

    def fit(
        self,
        level: int,
        start: ZonedState,
        wanted: Zones,
        constraints: Sequence[Constraint],
        free: Sequence[str] | None = None,
        touch: Touch | None = None,
        same: bool = False,
        graded: bool = False,
    ) -> ZonedState:
        """Solve on one mesh with its break points at the fronts and at the surface.

        Args:
            level: Number of the mesh.
            start: A state, which is interpolated as a guess.
            wanted: Zones of the state.
            constraints: One for each unknown load, besides those from ``touch``.
            free: Unknown loads besides the break points; by default the control.
            touch: A point where ``gw`` just touches 1, an additional equation.
            same: Keep the blocks of the start, so that the meshes of one state are nested.
            graded: Use short blocks near fronts.

        Raises:
            ConvergenceError: If it does not converge, or break points change their order.
        """
        extra = () if touch is None or touch.at_end else (touch.at,)
        layout = Layout.of(wanted, self.length, extra, self.near_fronts if graded else ())
        if same:
            layout = replace(start.layout, breaks=start.model.breaks_of(start.state.loads))
        model = model_on(self.meshes[level], len(layout.breaks) - 1)
        guess = self.moved(start, model, layout.breaks, layout.marks)
        guess.loads |= self.on_meshes[level]
        nodes = [*layout.fronts, *([] if layout.surface is None else [layout.surface])]
        own = [AtBreak(model, "gw", k) for k in layout.fronts]
        if layout.surface is not None:
            own.append(AtBreak(model, "z", layout.surface, minus="zw"))
        if touch is not None:
            node = int(np.argmin(np.abs(layout.breaks - touch.at)))
            own.append(AtBreak(model, "gw", node))
            if not touch.at_end:
                own.append(AtBreak(model, "gw_slope", node, target=0.0))
                nodes.append(node)
        scalars = (*((self.control,) if free is None else free), *(f"b{k}" for k in nodes))
        sharp = touch is None or touch.at_end
        try:
            tight = solver_of(model, scalars, 1e-10 if sharp else FLAT)
            state, record = tight.solve(guess, [*constraints, *own])
        except ConvergenceError:
            if not (sharp and self.near_fronts and layout.fronts):
                raise
            # The slope of ``gw`` at the front is small, as when a zone has just opened.
            state, record = solver_of(model, scalars, FLAT).solve(guess, [*constraints, *own])
        breaks = model.breaks_of(state.loads)
        if np.diff(breaks).min() <= 0:
            raise ConvergenceError("fronts changed their order")
        fronts = tuple(float(breaks[k]) for k in layout.fronts)
        surface = None if layout.surface is None else float(breaks[layout.surface])
        found = Zones(wanted.first, fronts, surface, wanted.wet)
        touched = None if touch is None else float(breaks[node])
        return ZonedState(model, state, found, record, scalars, tuple(own), touched, layout)

    def touching(
        self, start: ZonedState, touch: Touch, free: Sequence[str] | None = None
    ) -> list[ZonedState]:
        """The state at which ``gw`` just touches 1 at a point, on every mesh, coarse to fine.

        Args:
            start: A state near it, with its zones.
            touch: About where; each mesh starts from the place that the finer one has found.
            free: Unknown loads besides the break points; by default the control.

        Raises:
            ConvergenceError: If it is not found on some mesh.
        """
        found: list[ZonedState] = []
        for level in reversed(range(len(self.meshes))):
            start = self.fit(level, start, start.zones, (), free, touch, same=bool(found))
            touch = replace(touch, at=start.touched)
            found.append(start)
        return found[::-1]

    def limit(self, held: ZonedState, low: float, high: float) -> ZonedState:
        """The first limit load between two volumes by arc length, with fronts and load as unknowns.

        Args:
            held: The state at the lower volume.
            low: Its volume.
            high: The other one.

        Raises:
            ConvergenceError: If there is none, or if zones open or close before it.
        """
        system, control = held.model.system, self.control
        steps = StepControl(first=0.05, largest=0.5)
        continuation = Continuation(solver_of(held.model, held.scalars), held.constraints, steps)
        with held.lent(), system.weighed_here():
            begin = continuation.start(held.state, Held("V", low), towards={"V": 1.0})
            rate = begin.tangent.loads[control]
            branch = FittedBranch(
                continuation,
                control,
                begin,
                lambda q: q.monitors["V"] > high or q.tangent.loads[control] * rate < 0,
            )
            limits = branch.special()
        if len(limits) != 1:
            raise ConvergenceError(
                f"{len(limits)} limit loads between V = {low:.6g} and {high:.6g} on a fitted mesh"
            )
        state = limits[0].state
        moved = [state.loads[name] for name in held.scalars[1:]]
        count = len(held.zones.fronts)
        surface = None if held.zones.surface is None else moved[count]
        zones = replace(held.zones, fronts=tuple(moved[:count]), surface=surface)
        found = replace(held, state=state, zones=zones, record=begin.record)
        inside = np.diff([0.0, *zones.fronts, self.length]).min() > 0
        shown = found.shown_zones(VERGE_FITTED, self.liquid) if inside else zones
        if not inside or shown.thicker_than(SLIVER, self.length).kind != zones.kind:
            raise ConvergenceError(f"zones open or close between V = {low:.6g} and the limit load")
        return found

    def moved(self, start: ZonedState, model: WrinkledModel, breaks: np.ndarray, marks: Marks) -> State:
        """A state interpolated to another mesh with its marks."""
        loads = {k: v for k, v in start.state.loads.items() if not (k[0] == "b" and k[1:].isdigit())}
        loads |= {f"b{k}": float(breaks[k]) for k in range(1, model.blocks)}
        loads["residual_stiffness"] = 0.0
        u = carried(start.sampled, model, loads)
        u[model.system.bc_dofs] = 0.0
        return State(u, loads, marks)
