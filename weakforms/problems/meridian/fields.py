"""Fields of an axisymmetric membrane along its meridian: samples and extreme values."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import ufl
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.problems.meridian.model import MeridianModel
from weakforms.solvers.support.sampling import Interpolant

NEAR = 1e-4
"""Largest distance, in a cell, between the sample of an extreme value and its place."""

FINE, ZOOMS, CANDIDATES = 24, 6, 3
"""For extreme values: number of points of each cell, number of refinements, number of refined cells."""


class Meridian:
    """Expressions of a model's unknown as polynomials on each cell; samples are the same on every rank.

    Args:
        model: The model.
        expressions: The expressions; by default the unknown's components ``u``, ``w`` and the profile.
    """

    def __init__(self, model: MeridianModel, expressions: Mapping[str, Expr] | None = None) -> None:
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
        """Columns at mesh coordinates of equal cells; between two cells the mean of both sides."""
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

    def at_nodes(self) -> tuple[float, float]:
        """Smallest value and largest magnitude, at the nodes of the cells, of all columns but the place."""
        values = self._nodes()[:, :, 1:]
        own = float(values.min(initial=np.inf)), float(np.abs(values).max(initial=0.0))
        lowest, highest = zip(*self._comm.allgather(own), strict=True)
        return min(lowest), max(highest)

    def extreme(self, name: str, sign: int) -> float:
        """Largest (``sign`` 1) or smallest (-1) value of a column, by the cells' polynomials."""
        return self.extreme_at(name, sign)[0]

    def extreme_at(
        self, name: str, sign: int, within: tuple[float, float] = (-np.inf, np.inf)
    ) -> tuple[float, float]:
        """The same in the cells with a middle within two mesh coordinates, and the coordinate where it is."""
        nodes = self._nodes()
        best = -np.inf, 0.0
        if self._local:
            first = nodes[:, 0, 0]
            lengths = nodes[:, -1, 0] - first
            places = (nodes[0, :, 0] - first[0]) / lengths[0]
            column = sign * nodes[:, :, self.names.index(name)]
            grid = np.linspace(0.0, 1.0, FINE + 1)
            peaks = (column @ _lagrange(places, grid).T).max(axis=1)
            # If two cells share the best sample, the maximum may be in either.
            middle, (low, high) = first + lengths / 2, within
            inside = np.flatnonzero((low <= middle) & (middle <= high))
            rows = inside[np.argsort(peaks[inside])[-CANDIDATES:]]
            if len(rows):
                value, row, t = _top(places, column[rows])
                t = _stationary(places, column[rows[row]], t)
                best = value, float(first[rows[row]] + t * lengths[rows[row]])
        value, x = max(self._comm.allgather(best))
        return sign * value, x

    def on_cells(self) -> dict[str, np.ndarray]:
        """Columns at :data:`FINE` + 1 places of every cell: one row a cell, in order along the meridian."""
        nodes, sampled = self._nodes(), np.zeros((0, FINE + 1, len(self.names)))
        if self._local:
            places = (nodes[0, :, 0] - nodes[0, 0, 0]) / (nodes[0, -1, 0] - nodes[0, 0, 0])
            sampled = np.einsum("pn,rnc->rpc", _lagrange(places, np.linspace(0.0, 1.0, FINE + 1)), nodes)
        everywhere = np.concatenate(self._comm.allgather(sampled))
        ordered = everywhere[np.argsort(everywhere[:, 0, 0])]
        return {name: ordered[:, :, k] for k, name in enumerate(self.names)}


def carried(
    sampled: Callable[[np.ndarray], Mapping[str, np.ndarray]],
    model: MeridianModel,
    loads: Mapping[str, float],
) -> np.ndarray:
    """Degrees of freedom of this rank on another mesh, from samples of ``u`` and ``w`` at material points.

    Args:
        sampled: The samples; called by all ranks with the same points.
        model: The model on the other mesh.
        loads: Its loads, which may move the mesh.
    """
    own, comm = model.nodes(), model.mesh.comm
    everywhere = comm.allgather(own)
    found = sampled(model.material(np.concatenate(everywhere), loads))
    first = sum(len(part) for part in everywhere[: comm.rank])
    mine = slice(first, first + len(own))
    return np.column_stack([found["u"][mine], found["w"][mine]]).ravel()


def _top(places: np.ndarray, values: np.ndarray) -> tuple[float, int, float]:
    """Largest value on [0, 1] of polynomials, each given by a row of its values at ``places``.

    Also the row that has it, and where.
    """
    rows, share = np.arange(len(values)), np.linspace(0.0, 1.0, FINE + 1)
    low, high, best = np.zeros(len(values)), np.ones(len(values)), (-np.inf, 0, 0.0)
    for _ in range(ZOOMS):
        t = low[:, None] + (high - low)[:, None] * share
        found = np.einsum("rpn,rn->rp", _lagrange(places, t), values)
        i = found.argmax(axis=1)
        row = int(found.max(axis=1).argmax())
        best = max(best, (float(found[row, i[row]]), row, float(t[row, i[row]])))
        low, high = t[rows, np.maximum(i - 1, 0)], t[rows, np.minimum(i + 1, FINE)]
    return best


def _stationary(places: np.ndarray, values: np.ndarray, t: float) -> float:
    """The zero of a polynomial's slope next to its largest value, which is flat there, or that sample."""
    slope = np.polynomial.Polynomial.fit(places, values, len(places) - 1, domain=[0.0, 1.0]).deriv()
    zeros = slope.roots()
    near = zeros[(np.abs(zeros.imag) < NEAR) & (np.abs(zeros.real - t) < NEAR)].real
    inside = near[(near >= 0) & (near <= 1)]
    return float(inside[np.argmin(np.abs(inside - t))]) if len(inside) else t


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
