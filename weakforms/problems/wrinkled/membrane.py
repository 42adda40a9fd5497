"""A wrinkled membrane: its first states on a plain mesh, and unloaded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import replace

import numpy as np

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.meridian.limits import giving_way
from weakforms.problems.meridian.model import BY_STATE, DRY, TAUT, WRINKLED, Marks
from weakforms.problems.wrinkled.fields import Zones
from weakforms.problems.wrinkled.fitted import VERGE, FittedMembrane
from weakforms.problems.wrinkled.model import WrinkledModel
from weakforms.problems.wrinkled.state import BLOCKS, ZonedState, model_on, solver_of
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.state import State

HOMOTOPY = (1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0)
"""Residual hoop stiffness of wrinkled zones, in steps to zero."""

GAS_TO_LIQUID = (
    (0.5, 0.0),
    (0.5, 0.5),
    (0.5, 1.0),
    *((p, 1.0) for p in (0.3, 0.2, 0.1, 0.05, 0.02, 0.01, 0.0)),
)
"""Gas pressure (for a neo-Hookean law with ``C1 = 1``) and fraction of the liquid's weight, in steps from
a gas to a liquid."""

WALK = 0.1
"""Largest step of a parameter on the way from an easy membrane to the one wanted."""

STEEP = 1.2
"""Pre-stretch from which a first state of a taut cylinder is solved for."""


def natural_radius(delta: float) -> float:
    """Radius over that undeformed of an incompressible cylinder in uniaxial tension."""
    return delta**-0.5


class Membrane(FittedMembrane):
    """One membrane at given parameters: its first states on a plain mesh, then states on fitted meshes."""

    # -- plain mesh ----------------------------------------------------------------------------

    @property
    def plain_model(self) -> WrinkledModel:
        """The finest mesh with equal blocks."""
        return model_on(self.meshes[-1], BLOCKS)

    def undisplaced(self) -> State:
        """Undisplaced state of the plain mesh, a guess for solves on it."""
        model = self.plain_model
        breaks = np.linspace(0.0, self.length, BLOCKS + 1)
        marks = Marks(np.full(BLOCKS, BY_STATE), np.full(BLOCKS, BY_STATE if self.liquid else DRY))
        loads = {name: float(self.values[name]) for name in model.loads if name in self.values}
        loads |= {f"b{k}": float(breaks[k]) for k in range(1, BLOCKS)}
        return State(np.zeros(model.system.size), loads, marks)

    @contextmanager
    def weighed(self) -> Iterator[None]:
        """Context in which arc length on the plain mesh is measured by the mass of this membrane."""
        system = self.plain_model.system
        with system.at(self.undisplaced()), system.weighed_here():
            yield

    def by_homotopy(self, load: float) -> tuple[State, SolveRecord]:
        """State of the plain mesh at a load, from the completely wrinkled unloaded membrane.

        Wrinkled zones first keep a hoop stiffness, which is removed step by step. Otherwise Newton's method
        does not converge, or finds an equilibrium that is turned inside out.

        Raises:
            AbsentError: If the law gives way at disks that are wide.
            ConvergenceError: If a step does not converge, also not from other disks.
        """
        try:
            return self._by_homotopy(load)
        except ConvergenceError:
            wide = self.values.get("Af", 0.0) > natural_radius(self.values.get("delta", 1.0))
            if "Af" not in self.values or not (wide or self.energy == "standard"):
                raise
        steep = {"delta": max(self.values["delta"], STEEP)}
        ways: tuple[Mapping[str, float], ...] = ({}, {**steep, **dict(self.body.easy)})
        for begin in ways:
            try:
                return self._widened(load, begin)
            except ConvergenceError as error:
                last = error
        raise last

    def _widened(self, load: float, begin: Mapping[str, float]) -> tuple[State, SolveRecord]:
        """The state, from disks that leave the unloaded membrane its natural width.

        Args:
            load: The load.
            begin: Other parameters that the membrane begins with.

        Raises:
            AbsentError: If the law gives way at disks that are wide.
            ConvergenceError: If a step does not converge.
        """
        easy = {"Af": natural_radius(begin.get("delta", self.values["delta"])), **begin}
        goal, on_meshes = {name: self.values[name] for name in easy}, self.on_meshes
        try:
            self.values |= easy
            self.on_meshes = [{} for _ in self.meshes]  # they hold the radius that is walked to
            state, record = self._by_homotopy(load)
        finally:
            self.values |= goal
            self.on_meshes = on_meshes
        solver = solver_of(self.plain_model, ())

        last = state

        def changed(before: tuple[State, SolveRecord], share: float) -> tuple[State, SolveRecord]:
            nonlocal last
            loads = {n: goal[n] if share == 1 else easy[n] + share * (goal[n] - easy[n]) for n in easy}
            last = before[0]
            return solver.solve(replace(last, loads=last.loads | loads))

        far = max(abs(goal[name] - easy[name]) for name in easy)
        try:
            return walk(changed, (state, record), 0.0, 1.0, WALK / far) if far else (state, record)
        except ConvergenceError:
            if not begin and goal["Af"] > easy["Af"]:
                self._require_resisted(last, load)
            raise

    def _require_resisted(self, state: State, load: float) -> None:
        """Refuse wide disks beyond those of a state at which the law is about to give way.

        Raises:
            AbsentError: With a message that says where.
        """
        why = giving_way(self.plain_model, state)
        if why:
            raise AbsentError(
                f"state at {self.control} = {load:g}",
                f"Af = {self.values['Af']:.4g}: the membrane was followed from narrower disks to "
                f"Af = {state.loads['Af']:.4g}, where {why}; choose a smaller Af, or another law",
            )

    def _by_homotopy(self, load: float) -> tuple[State, SolveRecord]:
        folded = self.unloaded(len(self.meshes) - 1, WRINKLED)
        undisplaced = self.undisplaced()
        breaks = self.plain_model.breaks_of(undisplaced.loads)
        state = self.moved(folded, self.plain_model, breaks, undisplaced.marks)
        state.loads[self.control] = load
        solver = solver_of(self.plain_model, ())
        if self.energy == "standard":
            return solver.solve(state)
        if load == 0.0:
            with suppress(ConvergenceError):  # for disks that are not too large this is already the solution
                return solver.solve(state)
        for eps in HOMOTOPY:
            state.loads["residual_stiffness"] = eps
            state, record = solver.solve(state)
        return state, record

    def by_gas(self, load: float, stiffness: float = 1.0) -> State:
        """State of the plain mesh at a load, from the body's shape, which a gas keeps taut.

        A liquid replaces the gas step by step, because without both the membrane has no stiffness.

        Args:
            load: The load.
            stiffness: Of the law, relative to a neo-Hookean one with ``C1 = 1``; the gas is so much stronger.

        Raises:
            ConvergenceError: If a step does not converge, also not in shorter steps.
        """
        state = self.undisplaced()
        state.loads[self.control] = load
        solver = solver_of(self.plain_model, ())
        if not self.liquid:
            return solver.solve(state)[0]
        stages = np.arange(len(GAS_TO_LIQUID))
        pressures, shares = np.transpose(GAS_TO_LIQUID)

        def filled(before: State, at: float) -> State:
            gas, liquid = (float(np.interp(at, stages, part)) for part in (pressures, shares))
            loads = {"p": gas * stiffness, "gamma": liquid * self.values["gamma"]}
            return solver.solve(replace(before, loads=before.loads | loads))[0]

        return walk(filled, filled(state, 0.0), 0.0, float(stages[-1]), 1.0)

    def plain(self, state: State) -> ZonedState:
        """A state of the plain mesh with its zones."""
        held = ZonedState(self.plain_model, state, Zones(TAUT, ()), None)
        held.zones = held.shown_zones(VERGE, self.liquid)
        return held

    def unloaded(self, level: int, state: float) -> ZonedState:
        """The unloaded membrane on one mesh, either completely taut or completely wrinkled.

        It starts from the body's easy parameters and takes steps of at most :data:`WALK`.

        Args:
            level: Number of the mesh.
            state: ``TAUT`` or ``WRINKLED``.

        Raises:
            ConvergenceError: If a step does not converge.
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

    def unloaded_from(self, level: int, state: float, start: ZonedState | None) -> ZonedState:
        """The same from a state of neighbouring parameters, or from the undisplaced one."""
        undisplaced = self.undisplaced()
        begin = self.plain(undisplaced)
        if start is not None:
            loads = start.state.loads | self._own(undisplaced)
            begin = replace(start, state=replace(start.state, loads=loads))
        return self.fit(level, begin, Zones(state, ()), (), free=())

    def _own(self, state: State) -> dict[str, float]:
        return {name: value for name, value in state.loads.items() if name in self.values}
