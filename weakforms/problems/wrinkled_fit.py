"""States of a wrinkled membrane on meshes fitted to its zones, and on a plain mesh to begin with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.wrinkled_body import Body
from weakforms.problems.wrinkled_fields import Zones, zones
from weakforms.problems.wrinkled_model import BY_STATE, DRY, TAUT, WRINKLED, WrinkledModel
from weakforms.problems.wrinkled_state import (
    BLOCKS,
    AtBreak,
    Held,
    Layout,
    Mesh,
    Touch,
    model_on,
    solver_of,
)
from weakforms.solvers.newton import Constraint, SolveRecord
from weakforms.solvers.system import State

HOMOTOPY = (1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0)
"""Residual hoop stiffness of wrinkled zones on the way to none."""

VERGE, VERGE_FITTED = 1e-7, 1e-10
"""Deviation of ``gw`` from 1 that is none, on a plain mesh and on a fitted one."""

THINNEST, SLIVER = 1e-8, 1e-6
"""Zones thinner than this fraction of the length are left out; the second where round-off in a thin zone's
block keeps Newton's method from converging. Nothing else feels them."""

COARSE, PASSES = 1e-3, 2
"""Zones thinner than this fraction of the length get no break points before the fronts are unknowns; and how
often break points are put where the last solution shows fronts before that."""

WALK = 0.1
"""Largest step of a parameter on the way from an easy membrane to the one wanted."""

ATTEMPTS = 8
"""Patterns of zones tried for one state."""

FLAT = 1e-8
"""Relative Newton step accepted where a minimum of ``gw`` is located: its place may be known no better, and
what is asked for is not sensitive to it."""

PLACE = 1e-7
"""What that may leave in the place."""


class Membrane:
    """One membrane at given parameters; its states on a plain mesh and on fitted ones.

    Args:
        comm: Ranks.
        body: Geometry and thickness.
        values: Parameters: the body's, ``c2``, ``gamma``.
        liquid: Whether ``zw`` is the load, or ``p``.
        cells: Cells a block on each mesh, coarse to fine.
        degree: Of the elements.
        energy: See :class:`WrinkledModel`.
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
    ) -> None:
        self.body, self.liquid, self.energy = body, liquid, energy
        self.values = {"gamma": 0.0, "c2": 0.0, "residual_stiffness": 0.0, "p": 0.0, "zw": 0.0, **values}
        self.length = float(body.length(self.values))
        self.meshes = [Mesh(comm, comm.py2f(), body, n, degree, energy) for n in cells]
        self.control = "zw" if liquid else "p"

    # -- plain mesh ----------------------------------------------------------------------------

    @property
    def plain_model(self) -> WrinkledModel:
        """The finest mesh with equal blocks; its state is put into it before anything is done with it."""
        return model_on(self.meshes[-1], BLOCKS)

    def prepare(self) -> State:
        """Undisplaced state of the plain mesh, its model made ready for solves on it (models are shared)."""
        model = self.plain_model
        breaks = np.linspace(0.0, self.length, BLOCKS + 1)
        model.mark(np.full(BLOCKS, BY_STATE), np.full(BLOCKS, BY_STATE if self.liquid else DRY))
        loads = {name: float(self.values[name]) for name in model.loads if name in self.values}
        loads |= {f"b{k}": float(breaks[k]) for k in range(1, BLOCKS)}
        model.system.set_loads(loads)
        model.system.update_mass()
        return State(np.zeros(model.system.size), loads)

    def by_homotopy(self, load: float) -> tuple[State, SolveRecord]:
        """State of the plain mesh at a load, from the unloaded membrane wrinkled all over.

        The hoop stiffness of wrinkled zones is left in place at first and taken away step by step. Without
        that Newton's method finds nothing, or an equilibrium turned inside out.

        Raises:
            ConvergenceError: When a step does not converge.
        """
        folded = self.unloaded(len(self.meshes) - 1, WRINKLED)
        undisplaced = self.prepare()
        state = self._moved(folded, self.plain_model, self.plain_model.breaks_of(undisplaced.loads))
        self.prepare()
        state.loads[self.control] = load
        solver = solver_of(self.plain_model, ())
        if self.energy == "standard":
            return solver.solve(state)
        if load == 0.0:
            with suppress(ConvergenceError):  # on disks that are not too large this is the solution already
                return solver.solve(state)
        for eps in HOMOTOPY:
            state.loads["residual_stiffness"] = eps
            state, record = solver.solve(state)
        return state, record

    def plain(self, state: State) -> Held:
        """A state of the plain mesh with the zones it shows."""
        model = self.plain_model
        wet = np.full(BLOCKS, BY_STATE if self.liquid else DRY)
        held = Held(model, state, Zones(TAUT, ()), None, np.full(BLOCKS, BY_STATE), wet)
        held.zones = zones(held.put(), state.loads, VERGE, self.liquid)
        return held

    def unloaded(self, level: int, state: float) -> Held:
        """The unloaded membrane on one mesh, taken for taut or for wrinkled all over.

        Walks there from the parameters the body calls easy, in steps of at most :data:`WALK`.

        Args:
            level: Which mesh.
            state: ``TAUT`` or ``WRINKLED``.

        Raises:
            ConvergenceError: When a step does not converge.
        """
        easy = dict(self.body.easy)
        goal = {name: self.values[name] for name in easy}
        far = max((abs(goal[name] - easy[name]) for name in easy), default=0.0)
        steps = max(1, int(np.ceil(far / WALK)))
        held = None
        try:
            for share in np.arange(0 if far else steps, steps + 1) / steps:
                self.values |= {n: float(easy[n] + share * (goal[n] - easy[n])) for n in easy}
                held = self.unloaded_from(level, state, held)
        finally:
            self.values |= goal
        return held

    def unloaded_from(self, level: int, state: float, start: Held | None) -> Held:
        """The same from a state of neighbouring parameters, or from the undisplaced one."""
        undisplaced = self.prepare()
        begin = self.plain(undisplaced)
        if start is not None:
            begin = replace(start, state=State(start.state.u, start.state.loads | self._own(undisplaced)))
        return self.fit(level, begin, Zones(state, ()), (), free=())

    def _own(self, state: State) -> dict[str, float]:
        return {name: value for name, value in state.loads.items() if name in self.values}

    # -- fitted meshes -------------------------------------------------------------------------

    def fitted(self, start: Held, constraint: Constraint, fine_only: bool = False) -> list[Held]:
        """The state selected by a constraint on the control, on every mesh, coarse to fine, or on the finest.

        Raises:
            ConvergenceError: When no pattern of zones is found that the solution shows itself.
        """
        try:
            return self._fitted(start, constraint, THINNEST, fine_only)
        except ConvergenceError:
            return self._fitted(start, constraint, SLIVER, fine_only)

    def _fitted(self, start: Held, constraint: Constraint, thinnest: float, fine_only: bool) -> list[Held]:
        fine = self._pattern(start, constraint, thinnest)
        return [fine] if fine_only else [*self.others(fine, constraint), fine]

    def others(self, fine: Held, constraint: Constraint) -> list[Held]:
        """A state of the finest mesh on the coarser ones."""
        coarser = range(len(self.meshes) - 1)
        out = [self.fit(k, fine, fine.zones, (constraint,), same=True) for k in coarser]
        for held in out if fine.slivers else ():
            shown = zones(held.put(), held.state.loads, VERGE_FITTED, self.liquid)
            own = fine.zones.left_out_of(shown)
            nothing = tuple(0.0 if z < self.length / 2 else self.length for z in fine.slivers)
            held.slivers = own if len(own) == len(fine.slivers) else nothing
        return out

    def _pattern(self, start: Held, constraint: Constraint, thinnest: float) -> Held:
        """Solve on the finest mesh with the zones the last solution shows until they are its own."""
        held = self._adapted(start, constraint)
        wanted, last = self._thick(held.zones, thinnest), "none tried"
        for _ in range(ATTEMPTS):
            try:
                held = self.fit(len(self.meshes) - 1, held, wanted, (constraint,))
            except ConvergenceError as error:
                if not wanted.fronts:
                    raise
                last, wanted = str(error), wanted.without_thinnest(self.length)
                continue
            shown = zones(held.put(), held.state.loads, VERGE_FITTED, self.liquid)
            found = self._thick(shown, thinnest)
            if found.kind == held.zones.kind:
                held.slivers = found.left_out_of(shown)
                return held
            wanted = found
        raise ConvergenceError(f"no pattern of zones is its own solution's ({last})")

    def _adapted(self, start: Held, constraint: Constraint) -> Held:
        """A plain state solved again, by state, with break points where the last solution shows fronts.

        What a front inside a cell does to the solution is gone then, but for the front's own error.
        """
        held = start
        for _ in range(PASSES):
            layout = Layout.of(self._thick(held.zones, COARSE), self.length)
            model = model_on(self.meshes[-1], len(layout.breaks) - 1)
            guess = self._moved(held, model, layout.breaks)
            unmarked = np.full(model.blocks, BY_STATE)
            wet = unmarked if self.liquid else layout.wet
            model.mark(unmarked, wet)
            state, record = solver_of(model, (self.control,)).solve(guess, [constraint])
            held = Held(model, state, held.zones, record, unmarked, wet, (self.control,))
            held.zones = zones(held.put(), state.loads, VERGE, self.liquid)
        return held

    def _thick(self, found: Zones, share: float) -> Zones:
        while found.fronts and np.diff([0.0, *found.fronts, self.length]).min() < share * self.length:
            found = found.without_thinnest(self.length)
        return found

    def fit(
        self,
        level: int,
        start: Held,
        wanted: Zones,
        constraints: Sequence[Constraint],
        free: Sequence[str] | None = None,
        touch: Touch | None = None,
        same: bool = False,
    ) -> Held:
        """Solve on one mesh with its break points at the fronts and at the surface.

        Args:
            level: Which mesh.
            start: A state to interpolate from.
            wanted: The zones.
            constraints: One a free load, besides those that ``touch`` brings.
            free: Unknown loads besides the break points; by default the control.
            touch: A point where ``gw`` just touches 1, an equation more.
            same: Keep the blocks of the state to start from: meshes of one state are to be nested.

        Raises:
            ConvergenceError: When it does not converge, or break points pass each other.
        """
        layout = Layout.of(wanted, self.length, () if touch is None or touch.at_end else (touch.at,))
        if same:
            layout = replace(start.layout, breaks=start.model.breaks_of(start.state.loads))
        model = model_on(self.meshes[level], len(layout.breaks) - 1)
        guess = self._moved(start, model, layout.breaks)
        model.mark(layout.taut, layout.wet)
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
        stol = 1e-10 if touch is None or touch.at_end else FLAT
        state, record = solver_of(model, scalars, stol).solve(guess, [*constraints, *own])
        breaks = model.breaks_of(state.loads)
        if np.diff(breaks).min() <= 0:
            raise ConvergenceError("fronts passed each other")
        fronts = tuple(float(breaks[k]) for k in layout.fronts)
        surface = None if layout.surface is None else float(breaks[layout.surface])
        found = Zones(wanted.first, fronts, surface, wanted.wet)
        touched = None if touch is None else float(breaks[node])
        return Held(
            model, state, found, record, layout.taut, layout.wet, scalars, tuple(own), touched, layout
        )

    def _moved(self, start: Held, model: WrinkledModel, breaks: np.ndarray) -> State:
        """A state interpolated to another mesh."""
        loads = {k: v for k, v in start.state.loads.items() if not (k[0] == "b" and k[1:].isdigit())}
        loads |= {f"b{k}": float(breaks[k]) for k in range(1, model.blocks)}
        loads["residual_stiffness"] = 0.0
        own = model.space.tabulate_dof_coordinates()[: model.system.size // 2, 0]
        comm = model.mesh.comm
        everywhere = comm.allgather(own)
        s = model.material(np.concatenate(everywhere), loads)
        found = start.put().sampled(s, start.state.loads)
        first = sum(len(part) for part in everywhere[: comm.rank])
        mine = slice(first, first + len(own))
        u = np.column_stack([found["u"][mine], found["w"][mine]]).ravel()
        u[model.system.bc_dofs] = 0.0
        return State(u, loads)
