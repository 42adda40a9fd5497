"""Fields of a wrinkled membrane along its meridian: samples, extreme values, zones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import ufl
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError
from weakforms.problems.meridian.model import TAUT, WRINKLED
from weakforms.problems.wrinkled.model import WrinkledModel
from weakforms.solvers.support.sampling import Interpolant

PER_CELL = 9
"""Number of points of each cell at which zones are searched."""

NEAR_ENDS = 10.0 ** -np.arange(1.0, 11.0)
"""Distances from the ends, relative to the length, at which thin zones are searched in addition."""

NEGATIVE_RADIUS = 1e-9
"""Largest negative radius, relative to the length, that is round-off (at a pole)."""

FINE, ZOOMS, CANDIDATES = 24, 6, 3
"""For extreme values: number of points of each cell, number of refinements, number of refined cells."""


class Meridian:
    """Expressions of a model's unknown as polynomials on each cell; samples are the same on every rank.

    Args:
        model: The model.
        expressions: The expressions; by default the unknown's components ``u``, ``w`` and the profile.
    """

    def __init__(self, model: WrinkledModel, expressions: Mapping[str, Expr] | None = None) -> None:
        self.model = model
        if expressions is None:
            profile = model.system.formulation.profile
            expressions = {"u": model.unknown[0], "w": model.unknown[1], **profile}
        columns = {"x": ufl.SpatialCoordinate(model.mesh)[0], **expressions}
        self.names = tuple(columns)
        self._interpolant = Interpolant(model.unknown, columns)
        self._local = model.mesh.topology.index_map(1).size_local
        self._comm = model.mesh.comm
        self._order: np.ndarray | None = None

    def _nodes(self) -> np.ndarray:
        """Values at this rank's nodes, shape ``(cells, nodes, columns)``, in order along each cell."""
        nodes = self._interpolant.values().reshape(self._local, -1, len(self.names))
        if self._order is None:
            first = np.arange(self._local)[:, None] * nodes.shape[1]
            self._order = first + np.argsort(nodes[:, :, 0], axis=1)
        return nodes.reshape(-1, len(self.names))[self._order]

    def at(self, x: np.ndarray) -> dict[str, np.ndarray]:
        """Columns at mesh coordinates; between two cells the mean of both sides."""
        nodes, cells = self._nodes(), self.model.cells
        sums, count = np.zeros((len(x), len(self.names))), np.zeros(len(x))
        if self._local:
            first = np.round(nodes[:, 0, 0] * cells).astype(int)
            places = (nodes[0, :, 0] - nodes[0, 0, 0]) * cells
            row_of = np.full(self.model.blocks * cells, -1)
            row_of[first] = np.arange(self._local)
            left, right = np.ceil(x * cells - 1e-9).astype(int) - 1, np.floor(x * cells + 1e-9).astype(int)
            for cell, meant in ((left, np.full(len(x), True)), (right, right != left)):
                rows = np.where(
                    meant & (cell >= 0) & (cell < len(row_of)), row_of[np.clip(cell, 0, len(row_of) - 1)], -1
                )
                mine = np.flatnonzero(rows >= 0)
                basis = _lagrange(places, x[mine] * cells - cell[mine])
                sums[mine] += np.einsum("pn,pnc->pc", basis, nodes[rows[mine]])
                count[mine] += 1
        sums, count = self._comm.allreduce(sums, op=MPI.SUM), self._comm.allreduce(count, op=MPI.SUM)
        return dict(zip(self.names, (sums / count[:, None]).T, strict=True))

    def sampled(self, s: np.ndarray, loads: Mapping[str, float]) -> dict[str, np.ndarray]:
        """Columns at material points."""
        return self.at(self.model.position(s, loads))

    def extreme(self, name: str, sign: int) -> float:
        """Largest (``sign`` 1) or smallest (-1) value of a column, by the cells' polynomials."""
        nodes = self._nodes()
        best = -np.inf
        if self._local:
            places = (nodes[0, :, 0] - nodes[0, 0, 0]) * self.model.cells
            column = sign * nodes[:, :, self.names.index(name)]
            grid = np.linspace(0.0, 1.0, FINE + 1)
            peaks = (column @ _lagrange(places, grid).T).max(axis=1)
            # If two cells share the best sample, the maximum may be in either.
            best = _top(places, column[np.argsort(peaks)[-CANDIDATES:]])
        return sign * float(self._comm.allreduce(best, op=MPI.MAX))


def _top(places: np.ndarray, values: np.ndarray) -> float:
    """Largest value on [0, 1] of polynomials, each given by a row of its values at ``places``."""
    rows, share = np.arange(len(values)), np.linspace(0.0, 1.0, FINE + 1)
    low, high, best = np.zeros(len(values)), np.ones(len(values)), -np.inf
    for _ in range(ZOOMS):
        t = low[:, None] + (high - low)[:, None] * share
        found = np.einsum("rpn,rn->rp", _lagrange(places, t), values)
        i = found.argmax(axis=1)
        best = max(best, float(found.max()))
        low, high = t[rows, np.maximum(i - 1, 0)], t[rows, np.minimum(i + 1, FINE)]
    return best


def _lagrange(nodes: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Lagrange basis of ``nodes`` at points ``t``, shape ``(*t.shape, nodes)``."""
    gaps = nodes[:, None] - nodes[None, :]
    np.fill_diagonal(gaps, 1.0)
    distance = t[..., None] - nodes
    # The product of all distances but one: of those before it and those after it.
    before, after = np.ones_like(distance), np.ones_like(distance)
    before[..., 1:] = np.cumprod(distance[..., :-1], axis=-1)
    after[..., :-1] = np.cumprod(distance[..., :0:-1], axis=-1)[..., ::-1]
    return before * after / gaps.prod(axis=1)


@dataclass(frozen=True)
class Zones:
    """Taut and wrinkled zones of a state, and the point where the liquid's surface cuts the meridian."""

    first: float
    """State of the zone at the first end."""
    fronts: tuple[float, ...]
    """Material points where the state changes."""
    surface: float | None = None
    """Material point at the fluid level; ``None`` if the membrane is all wet or all dry."""
    wet: bool = False
    """Whether the membrane is all wet or, with a surface, wet up to it."""

    @property
    def kind(self) -> tuple:
        """The pattern of zones, which does not change while fronts move."""
        return self.first, len(self.fronts), self.surface is None, self.wet

    def states(self, s: np.ndarray) -> np.ndarray:
        """State at material points."""
        return np.where(np.searchsorted(self.fronts, s) % 2 == 0, self.first, -self.first)

    def left_out_of(self, others: Zones) -> tuple[float, ...]:
        """Fronts of another state that are not the nearest one to any front of this state."""
        left = list(others.fronts)
        for front in self.fronts:
            left.remove(min(left, key=lambda f, front=front: abs(f - front)))
        return tuple(left)

    def share(self, state: float, length: float) -> float:
        """Fraction of the length in a state."""
        widths = np.diff([0.0, *self.fronts, length])
        return float(widths[(0 if self.first == state else 1) :: 2].sum() / length)

    def without_thinnest(self, length: float) -> Zones:
        """The same zones without the thinnest one, which joins its neighbours."""
        edges = np.array([0.0, *self.fronts, length])
        k = int(np.argmin(np.diff(edges)))
        drop = {k - 1, k} if 0 < k < len(edges) - 2 else {0} if k == 0 else {k - 1}
        kept = tuple(f for i, f in enumerate(self.fronts) if i not in drop)
        return Zones(-self.first if k == 0 else self.first, kept, self.surface, self.wet)


def zones(meridian: Meridian, loads: Mapping[str, float], flat: float, liquid: bool) -> Zones:
    """Zones of the state that a model holds.

    Args:
        meridian: Fields of the state.
        loads: Loads of the state.
        flat: Deviations of ``gw`` from 1 up to this count as taut.
        liquid: Whether there is a liquid.

    Raises:
        ConvergenceError: If the surface crosses the axis, which is not a physical equilibrium.
    """
    model = meridian.model
    breaks = model.breaks_of(loads)
    length = breaks[-1]
    t = (1 - np.cos(np.pi * (np.arange(PER_CELL) + 0.5) / PER_CELL)) / 2
    inner = ((np.arange(model.blocks * model.cells)[:, None] + t) / model.cells).ravel()
    s = np.concatenate(
        [model.material(inner, loads), length * NEAR_ENDS, length * (1 - NEAR_ENDS), [0.0, length]]
    )
    s = np.unique(s)
    found = meridian.sampled(s, loads)
    if found["r"].min() < -NEGATIVE_RADIUS * length:
        raise ConvergenceError("the equilibrium is turned inside out")
    excess = found["gw"] - 1.0
    sign = np.where(np.abs(excess) > flat, np.sign(excess), 0.0)
    known = np.flatnonzero(sign)
    if not len(known):
        first, fronts = TAUT, ()
    else:
        first = TAUT if sign[known[0]] > 0 else WRINKLED
        change = known[:-1][sign[known[:-1]] != sign[known[1:]]]
        after = known[1:][sign[known[:-1]] != sign[known[1:]]]
        fronts = tuple(_crossing(s, excess, i, j) for i, j in zip(change, after, strict=True))
    surface, wet = None, False
    if liquid:
        under = loads["zw"] - found["z"]
        wet = bool(under[0] > 0)
        across = np.flatnonzero(under[:-1] * under[1:] < 0)
        if len(across):
            surface = _crossing(s, under, int(across[0]), int(across[0]) + 1)
    return Zones(first, fronts, surface, wet)


def _crossing(s: np.ndarray, values: np.ndarray, i: int, j: int) -> float:
    share = values[i] / (values[i] - values[j])
    return float(s[i] + share * (s[j] - s[i]))
