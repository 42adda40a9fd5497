"""One state of a wrinkled membrane: its zones as blocks of a mesh, its equations at break points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from mpi4py import MPI

from weakforms.problems.material_choice import Chosen
from weakforms.problems.wrinkled.body import Body
from weakforms.problems.wrinkled.fields import Meridian, Zones
from weakforms.problems.wrinkled.model import DRY, WET, WrinkledModel
from weakforms.solvers.equilibrium.newton import ExtendedNewton, SolveRecord
from weakforms.solvers.equilibrium.system import State

BLOCKS = 10
"""Blocks of a mesh; more where more break points need them."""

GROWTH = 4.0
"""How many times as long as its neighbour a block may be where meshes are graded to fronts."""

ALIKE = 1e-6
"""Relative difference of two blocks' lengths below which they are equal."""

NEAR_DISKS = (1 / 32, 1 / 8, 7 / 8, 31 / 32)
"""Shares of the length at which blocks end besides, to resolve the layers at the ends."""


@dataclass(frozen=True)
class Mesh:
    """What a model is built on."""

    comm: MPI.Intracomm = field(compare=False)
    ranks: int
    """Handle of the communicator: models are kept by it."""
    body: Body
    cells: int
    """Cells a block."""
    degree: int
    energy: str
    material: Chosen | None = None


@dataclass(frozen=True)
class AtBreak:
    """A field at a break point or end has a value: ``gw = 1`` at a front, ``z = zw`` at the surface."""

    model: WrinkledModel
    functional: str
    node: int
    target: float = 1.0
    minus: str = ""
    """Load the field is counted from."""
    after: bool = False

    def value(self, solver: ExtendedNewton) -> float:
        """Distance from the value."""
        self.model.look_at(self.node, self.after)
        known = solver.system.monitor(self.functional)
        return known - (solver.system.load(self.minus) if self.minus else self.target)

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """Of the functional, less the load."""
        self.model.look_at(self.node, self.after)
        row, loads = solver.system.monitor_gradient(self.functional, solver.scalars)
        if self.minus in loads:
            loads[self.minus] -= 1.0
        return row, loads


@lru_cache(maxsize=64)
def model_on(mesh: Mesh, blocks: int) -> WrinkledModel:
    """A model and its compiled forms serve all parameters: those are constants of the form."""
    values = {name: 1.0 for name in mesh.body.parameters}
    kind = mesh.energy, mesh.material
    return WrinkledModel(mesh.comm, mesh.body, values, blocks, mesh.cells, mesh.degree, *kind)


@lru_cache(maxsize=64)
def meridian_of(model: WrinkledModel) -> Meridian:
    """The fields of a model; kept."""
    return Meridian(model)


@lru_cache(maxsize=256)
def solver_of(model: WrinkledModel, scalars: tuple[str, ...], stol: float = 1e-10) -> ExtendedNewton:
    """The Newton solver of a model for some unknown loads; kept."""
    return ExtendedNewton(model.system, scalars, stol=stol, max_iterations=30)


@dataclass
class Held:
    """A state of a model: put back into it whenever something is read from it."""

    model: WrinkledModel
    state: State
    zones: Zones
    record: SolveRecord | None
    taut: np.ndarray
    wet: np.ndarray
    scalars: tuple[str, ...] = ()
    constraints: tuple[AtBreak, ...] = ()
    touched: float | None = None
    """Where ``gw`` touches 1, if that was asked for."""
    layout: Layout | None = None
    """Of a fitted mesh."""
    slivers: tuple[float, ...] = ()
    """Fronts of zones too thin for a block of their own, as the solution without them shows them."""

    def put(self) -> Meridian:
        """Put the state into its model; the fields to read from."""
        self.model.mark(self.taut, self.wet)
        self.model.system.set_state(self.state.u, self.state.loads)
        return meridian_of(self.model)

    def all_zones(self, length: float) -> Zones:
        """Zones, the slivers included (which lie at the ends)."""
        first = -self.zones.first if any(z < length / 2 for z in self.slivers) else self.zones.first
        return replace(self.zones, first=first, fronts=tuple(sorted([*self.zones.fronts, *self.slivers])))

    def sampled(self, s: np.ndarray) -> dict[str, np.ndarray]:
        """Fields at material points."""
        return self.put().sampled(s, self.state.loads)


@dataclass(frozen=True)
class Touch:
    """A point where ``gw = 1`` is just reached: at an end, or inside where its slope is zero."""

    at: float
    at_end: bool


def _graded(breaks: list[float]) -> list[float]:
    """The same with blocks divided so that none is longer than :data:`GROWTH` times a neighbour."""
    breaks = list(breaks)
    k = 0
    while k < len(breaks) - 1:
        length = breaks[k + 1] - breaks[k]
        low = breaks[k] - breaks[k - 1] if k > 0 else np.inf
        high = breaks[k + 2] - breaks[k + 1] if k + 2 < len(breaks) else np.inf
        if length <= GROWTH * min(low, high) * (1 + 1e-9):
            k += 1
        elif length <= 2 * GROWTH * min(low, high):
            breaks.insert(k + 1, breaks[k] + length / 2)
            k = max(k - 1, 0)
        else:
            at = breaks[k] + GROWTH * low if low <= high else breaks[k + 1] - GROWTH * high
            breaks.insert(k + 1, at)
            k = max(k - 1, 0)
    return breaks


@dataclass(frozen=True)
class Layout:
    """Break points of a fitted mesh, which of them are unknowns, and the marks of its blocks."""

    breaks: np.ndarray
    fronts: tuple[int, ...]
    surface: int | None
    taut: np.ndarray
    wet: np.ndarray

    @classmethod
    def of(
        cls, found: Zones, length: float, extra: Sequence[float] = (), near_fronts: Sequence[float] = ()
    ) -> Layout:
        """Fronts, surface and further points, the longest blocks halved until there are enough.

        Args:
            found: Zones.
            length: Of the meridian.
            extra: Points that are to be break points.
            near_fronts: Distances from fronts at which blocks end besides, ascending.
        """
        given = [*found.fronts, *([] if found.surface is None else [found.surface]), *extra]
        breaks = [0.0, *sorted(given), length]
        for distance in near_fronts:
            for point in (f + side * distance for f in found.fronts for side in (-1, 1)):
                if 0 < point < length and np.abs(np.array(breaks) - point).min() > distance / 2:
                    breaks = sorted([*breaks, point])
        if near_fronts:
            breaks = _graded(breaks)
        for share in NEAR_DISKS:
            point = share * length
            if np.abs(np.array(breaks) - point).min() > 0.5 * min(point, length - point):
                breaks = sorted([*breaks, point])
        while len(breaks) < BLOCKS + 1:
            widths = np.diff(breaks)
            # Of equal ones the first: which is longest only round-off would say, and so the number of ranks.
            k = int(np.argmax(widths > widths.max() * (1 - ALIKE)))
            breaks.insert(k + 1, (breaks[k] + breaks[k + 1]) / 2)
        points = np.array(breaks)
        middles = (points[1:] + points[:-1]) / 2
        surface = None if found.surface is None else breaks.index(found.surface)
        wet = np.full(len(middles), WET if found.wet else DRY)
        if surface is not None:
            wet[surface:] *= -1
        return cls(points, tuple(breaks.index(f) for f in found.fronts), surface, found.states(middles), wet)
