"""The stress-free surface of a membrane of any shape: its triangles, straight or curved, and its supports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve

from weakforms.problems.triangles.checks import edges_of

OPPOSITE = ((1, 2), (2, 0), (0, 1))
"""Corners at the ends of the edge opposite to each corner."""

NODES = np.array([(0, 0), (1, 0), (0, 1), (0.5, 0.5), (0, 0.5), (0.5, 0)])
"""Places of the six nodes on the triangle of reference."""

CHILDREN = ((0, 5, 4), (5, 1, 3), (4, 3, 2), (3, 4, 5))
"""Corners of the four parts of a triangle, among its six nodes."""

PLANE = 1e-6
"""Largest distance from a plane, relative to the size of the surface, of what counts as lying in it."""

AXES = "XYZ"
"""Mirrors: the coordinate that is constant on each."""


@dataclass(frozen=True)
class Reference:
    """Triangles in space, the same on every rank."""

    points: np.ndarray
    """Nodes, ``(n, 3)``."""
    cells: np.ndarray
    """Corners, ``(m, 3)``; curved triangles ``(m, 6)``: also the nodes on the edges opposite to each."""
    held: np.ndarray
    """Edges that are held, as pairs of corners ``(k, 2)``."""
    mirrors: Mapping[str, np.ndarray]
    """Edges on planes of symmetry, by the coordinate that is constant there."""
    point: int | None = None
    """A corner at which the deflection is read; by default one that :attr:`centre` chooses."""
    slides: Mapping[str, np.ndarray] = field(default_factory=dict)
    """Edges that slide in a plane to which the surface need not be normal, by the coordinate that is constant
    there."""
    moved: np.ndarray = field(default_factory=lambda: np.empty((0, 2), int))
    """Held edges that are moved as a rigid body, among :attr:`held`."""
    pivot: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """The point about which these are turned."""

    @property
    def corners(self) -> np.ndarray:
        """Corners of the triangles, ``(m, 3)``."""
        return self.cells[:, :3]

    @property
    def normals(self) -> np.ndarray:
        """Normal of each triangle of the corners, its length twice the area."""
        a, b, c = (self.points[self.corners[:, i]] for i in range(3))
        return np.cross(b - a, c - a)

    @property
    def size(self) -> float:
        """Largest extent along a coordinate."""
        return float(np.ptp(self.points, axis=0).max())

    @property
    def is_flat(self) -> bool:
        """Whether all nodes lie in a plane."""
        away = self.points - self.points.mean(axis=0)
        return bool(np.linalg.svd(away, compute_uv=False)[2] <= PLANE * self.size * np.sqrt(len(away)))

    @property
    def middle(self) -> np.ndarray:
        """The point that a pre-stretch keeps: the centroid of the area, on every plane of symmetry.

        It is also on planes in which edges slide, if no parallel plane of symmetry is given.
        """
        weight = np.linalg.norm(self.normals, axis=1)
        out = weight @ self.points[self.corners].mean(axis=1) / weight.sum()
        for axis, edges in (self.slides | self.mirrors).items():
            i = AXES.index(axis)
            out[i] = self.points[edges[0, 0], i]
        return out

    @cached_property
    def centre(self) -> int:
        """The corner where a shallow membrane rises most (:attr:`rise`)."""
        if self.point is not None:
            return self.point
        # Of equal ones the first in space, so that the order of a file does not matter.
        top = np.flatnonzero(self.rise > 1 - 1e-9)
        return int(top[np.lexsort(self.points[top].round(9).T)[0]])

    @cached_property
    def rise(self) -> np.ndarray:
        r"""Height ``w`` of a shallow membrane at each node over the largest one: :math:`\Delta w = -1`.

        The solution, by linear triangles on the corners, vanishes on edges that are held or slide; without
        any, on planes of symmetry. It is zero at nodes that are no corners.
        """
        lowest = np.vstack([self.held, *self.slides.values()])
        out = self._drum(lowest if len(lowest) else np.vstack([*self.mirrors.values()]), 1.0)
        return out / out.max()

    @property
    def follows(self) -> np.ndarray:
        """Share of the motion of :attr:`moved` at each corner: harmonic, 1 on these edges, 0 on other."""
        return self._drum(np.vstack([self.held, *self.slides.values()]), 0.0)

    def _drum(self, edges: np.ndarray, source: float) -> np.ndarray:
        """``div grad w = -source``; zero on edges, but without a source 1 on :attr:`moved`."""
        nodes, inverse = np.unique(self.corners, return_inverse=True)
        cells = inverse.reshape(-1, 3)
        sides = np.stack(
            [self.points[self.corners[:, b]] - self.points[self.corners[:, a]] for a, b in OPPOSITE]
        )
        twice = np.linalg.norm(self.normals, axis=1)
        stiffness = np.einsum("imd,jmd->mij", sides, sides) / (2 * twice[:, None, None])
        rows, columns = np.repeat(cells, 3, axis=1).ravel(), np.tile(cells, 3).ravel()
        matrix = csr_matrix((stiffness.ravel(), (rows, columns)), shape=(len(nodes),) * 2)
        load = source * np.bincount(cells.ravel(), np.repeat(twice / 6, 3), len(nodes))
        given = np.isin(nodes, self.moved) * (1.0 - source)
        free = np.flatnonzero(~np.isin(nodes, edges))
        out = np.zeros(len(self.points))
        out[nodes] = given
        out[nodes[free]] = spsolve(matrix[free][:, free].tocsc(), (load - matrix @ given)[free])
        return out

    @property
    def slope(self) -> float:
        """Vertical part of the area that the open edges span, over the area of the surface."""
        normals = self.normals
        return float(normals[:, 2].sum() / np.linalg.norm(normals, axis=1).sum())

    def upwards(self) -> Reference:
        """The same surface with normals whose sum points upwards."""
        if self.slope >= 0:
            return self
        turned = [0, 2, 1, 3, 5, 4][: self.cells.shape[1]]
        return replace(self, cells=self.cells[:, turned])

    @property
    def edge(self) -> float:
        """Height of the edges that move in a horizontal plane, at which they bear no load; 0 without any."""
        horizontal = self.mirrors.get("Z", self.slides.get("Z"))
        return 0.0 if horizontal is None else float(self.points[horizontal[0, 0], 2])

    @property
    def is_loose(self) -> bool:
        """Whether edges slide and none is held: a pre-stretch of the supports has no effect."""
        return bool(self.slides) and not len(self.held)

    @property
    def far(self) -> int:
        """The node of the sliding edges farthest from :attr:`centre`; of equal ones the first in space."""
        nodes = np.unique(np.vstack([*self.slides.values()]))
        away = np.linalg.norm(self.points[nodes] - self.points[self.centre], axis=1)
        most = nodes[away > away.max() * (1 - 1e-9)]
        return int(most[np.lexsort(self.points[most].round(9).T)[0]])

    @property
    def direction(self) -> np.ndarray:
        """Unit normal of the surface around :attr:`centre`."""
        around = self.normals[(self.corners == self.centre).any(axis=1)].sum(axis=0)
        return around / np.linalg.norm(around)

    def refined(self) -> Reference:
        """The same surface with four triangles for each; the corners keep their numbers."""
        points, six = self.points, self.cells
        if six.shape[1] == 3:
            edges = edges_of(self.cells)[0]
            points = np.vstack([points, points[edges].mean(axis=1)])
            middles = [_numbers(edges, self.cells[:, ends]) + len(self.points) for ends in OPPOSITE]
            six = np.column_stack([self.cells, *middles])
        cells = six[:, CHILDREN].reshape(-1, 3)
        if self.cells.shape[1] == 6:
            points, cells = self._curved(cells)
        halves = [np.column_stack([six[:, a], six[:, 3 + i], six[:, b]]) for i, (a, b) in enumerate(OPPOSITE)]
        chains = np.vstack(halves)
        mirrors, slides = (
            {axis: _halved(edges, chains) for axis, edges in planes.items()}
            for planes in (self.mirrors, self.slides)
        )
        return replace(
            self,
            points=points,
            cells=cells,
            held=_halved(self.held, chains),
            moved=_halved(self.moved, chains),
            mirrors=mirrors,
            slides=slides,
            point=self.centre,
        )

    def _curved(self, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nodes on the edges of the parts of curved triangles, on the same quadratic surface."""
        sides = np.array([[[child[a], child[b]] for a, b in OPPOSITE] for child in CHILDREN])
        at = NODES[sides].mean(axis=2).reshape(-1, 2)
        curved = np.einsum("qi,mid->mqd", quadratics(at), self.points[self.cells])
        edges, _ = edges_of(cells)
        new = np.zeros((len(edges), 3))
        number = np.stack([_numbers(edges, cells[:, ends]) for ends in OPPOSITE], axis=1)
        new[number.reshape(len(self.cells), -1)] = curved
        return np.vstack([self.points, new]), np.column_stack([cells, number + len(self.points)])


def quadratics(at: np.ndarray) -> np.ndarray:
    """The six quadratic shape functions of a triangle at points ``(n, 2)``, as ``(n, 6)``."""
    x, y = at.T
    z = 1 - x - y
    own = [z * (2 * z - 1), x * (2 * x - 1), y * (2 * y - 1)]
    return np.column_stack([*own, 4 * x * y, 4 * y * z, 4 * z * x])


def _numbers(edges: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Rows of sorted edges, ``(k, 2)``, that hold given pairs of nodes in any order."""
    base = int(edges.max()) + 1
    low, high = np.sort(pairs, axis=1).T.astype(np.int64)
    return np.searchsorted(edges[:, 0].astype(np.int64) * base + edges[:, 1], low * base + high)


def _halved(edges: np.ndarray, chains: np.ndarray) -> np.ndarray:
    """The halves of some edges, whose nodes are listed with all others in ``chains``, ``(k, 3)``."""
    if not len(edges):
        return edges
    every, first = np.unique(np.sort(chains[:, [0, 2]], axis=1), axis=0, return_index=True)
    middle = chains[first][_numbers(every, edges), 1]
    return np.vstack([np.column_stack([edges[:, 0], middle]), np.column_stack([middle, edges[:, 1]])])


def boundary(cells: np.ndarray) -> np.ndarray:
    """Edges of one triangle."""
    edges, count = edges_of(cells[:, :3])
    return edges[count == 1]
