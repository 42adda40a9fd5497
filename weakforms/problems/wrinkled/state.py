"""One state of a wrinkled membrane: its zones as blocks of a mesh, and its equations at break points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from mpi4py import MPI

from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.model import DRY, WET, Marks
from weakforms.problems.wrinkled.fields import Zones, zones
from weakforms.problems.wrinkled.model import WrinkledModel, kept_with_model
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.state import State

BLOCKS = 10
"""Smallest number of blocks of a mesh; more break points need more."""

GROWTH = 4.0
"""Largest ratio of the lengths of neighbouring blocks in meshes that are graded towards fronts."""

ALIKE = 1e-6
"""Relative difference of two blocks' lengths below which they are equal."""

NEAR_DISKS = (1 / 32, 1 / 8, 7 / 8, 31 / 32)
"""Fractions of the length at which further blocks end, to resolve the layers at the ends."""


@dataclass(frozen=True)
class Mesh:
    """The mesh of a model."""

    comm: MPI.Intracomm = field(compare=False)
    ranks: int
    """Handle of the communicator, part of the key of kept models."""
    body: Body
    cells: int
    """Cells of each block."""
    degree: int
    energy: str
    material: Chosen | None = None


@dataclass(frozen=True)
class AtBreak:
    """Condition for a field at a break point or end: ``gw = 1`` at a front, ``z = zw`` at the surface."""

    model: WrinkledModel
    functional: str
    node: int
    target: float = 1.0
    minus: str = ""
    """Load from which the field is measured."""
    after: bool = False

    def value(self, solver: ExtendedNewton) -> float:
        """Distance from the value."""
        self.model.look_at(self.node, self.after)
        known = solver.system.monitor(self.functional)
        return known - (solver.system.load(self.minus) if self.minus else self.target)

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """Gradient of the functional minus the load."""
        self.model.look_at(self.node, self.after)
        row, loads = solver.system.monitor_gradient(self.functional, solver.scalars)
        if self.minus in loads:
            loads[self.minus] -= 1.0
        return row, loads


@lru_cache(maxsize=64)
def model_on(mesh: Mesh, blocks: int) -> WrinkledModel:
    """The model on a mesh; it is kept for all parameters, which are constants of its forms."""
    values = {name: 1.0 for name in mesh.body.parameters}
    kind = mesh.energy, mesh.material
    return WrinkledModel(mesh.comm, mesh.body, values, blocks, mesh.cells, mesh.degree, *kind)


@kept_with_model
def meridian_of(model: WrinkledModel) -> Meridian:
    """The fields of a model."""
    return Meridian(model)


@kept_with_model
def solver_of(model: WrinkledModel, scalars: tuple[str, ...], stol: float = 1e-10) -> ExtendedNewton:
    """The Newton solver of a model for some unknown loads."""
    return ExtendedNewton(model.system, scalars, stol=stol, max_iterations=30)


@dataclass
class ZonedState:
    """A state with its zones and its model, which many states share: it is read inside of :meth:`lent`."""

    model: WrinkledModel
    state: State
    zones: Zones
    record: SolveRecord | None
    scalars: tuple[str, ...] = ()
    constraints: tuple[AtBreak, ...] = ()
    touched: float | None = None
    """Position where ``gw`` touches 1, if requested."""
    layout: Layout | None = None
    """Break points and marks of a fitted mesh."""
    slivers: tuple[float, ...] = ()
    """Fronts of zones that are too thin for a block, from the solution without these zones."""

    @contextmanager
    def lent(self) -> Iterator[Meridian]:
        """Context in which the model belongs to the state; gives the fields of the state."""
        with self.model.system.at(self.state):
            yield meridian_of(self.model)

    def shown_zones(self, flat: float, liquid: bool) -> Zones:
        """Zones that the fields show: see :func:`zones`."""
        with self.lent() as meridian:
            return zones(meridian, self.state.loads, flat, liquid)

    def extreme(self, name: str, sign: int) -> float:
        """Largest (``sign`` 1) or smallest (-1) value of a field."""
        with self.lent() as meridian:
            return meridian.extreme(name, sign)

    def all_zones(self, length: float) -> Zones:
        """All zones, including the thin ones without a block (which lie at the ends)."""
        first = -self.zones.first if any(z < length / 2 for z in self.slivers) else self.zones.first
        return replace(self.zones, first=first, fronts=tuple(sorted([*self.zones.fronts, *self.slivers])))

    def sampled(self, s: np.ndarray) -> dict[str, np.ndarray]:
        """Fields at material points."""
        with self.lent() as meridian:
            return meridian.sampled(s, self.state.loads)


@dataclass(frozen=True)
class Touch:
    """A point where ``gw`` just reaches 1: at an end, or inside with zero slope."""

    at: float
    at_end: bool


def _graded(breaks: list[float]) -> list[float]:
    """Break points with blocks divided so that none is longer than :data:`GROWTH` times a neighbour."""
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
    """Break points of a fitted mesh, the unknown ones among them, and the marks of its blocks."""

    breaks: np.ndarray
    fronts: tuple[int, ...]
    surface: int | None
    marks: Marks

    @classmethod
    def of(
        cls, found: Zones, length: float, extra: Sequence[float] = (), near_fronts: Sequence[float] = ()
    ) -> Layout:
        """Layout with fronts, surface and further points; the longest blocks are halved if needed.

        Args:
            found: Zones of the state.
            length: Length of the meridian.
            extra: Further break points.
            near_fronts: Distances from fronts at which further blocks end, ascending.
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
            # Take the first of equal ones, so that round-off, which depends on the number of ranks, does not
            # decide.
            k = int(np.argmax(widths > widths.max() * (1 - ALIKE)))
            breaks.insert(k + 1, (breaks[k] + breaks[k + 1]) / 2)
        points = np.array(breaks)
        middles = (points[1:] + points[:-1]) / 2
        surface = None if found.surface is None else breaks.index(found.surface)
        wet = np.full(len(middles), WET if found.wet else DRY)
        if surface is not None:
            wet[surface:] *= -1
        fronts = tuple(breaks.index(f) for f in found.fronts)
        return cls(points, fronts, surface, Marks(found.states(middles), wet))
