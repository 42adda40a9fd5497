"""The stress-free surface of a membrane of any shape: its triangles, straight or curved, and its supports."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from dolfinx import mesh as dmesh
from mpi4py import MPI
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree

from weakforms.problems.triangles.checks import edges_of
from weakforms.problems.triangles.meshes import in_space

OPPOSITE = ((1, 2), (2, 0), (0, 1))
"""Corners at the ends of the edge opposite to each corner."""

NODES = np.array([(0, 0), (1, 0), (0, 1), (0.5, 0.5), (0, 0.5), (0.5, 0)])
"""Places of the six nodes on the triangle of reference."""

UP = np.array([0.0, 0.0, 1.0])
"""The vertical of a weight that is not tilted."""

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
    edge_at: Callable[[np.ndarray], np.ndarray] | None = None
    """The place on the true edge of new nodes of held edges; by default they stay where the triangles are."""

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

    def slope(self, up: np.ndarray = UP) -> float:
        """Vertical part of the area that the open edges span, over the area of the surface.

        Args:
            up: Unit vector upwards; by default along ``Z``.
        """
        normals = self.normals
        return float((normals @ up).sum() / np.linalg.norm(normals, axis=1).sum())

    def upwards(self, up: np.ndarray = UP) -> Reference:
        """The same surface with normals whose sum points upwards.

        Args:
            up: Unit vector upwards; by default along ``Z``.
        """
        if self.slope(up) >= 0:
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

    def refined(self, marked: np.ndarray | None = None) -> Reference:
        """The same surface with four triangles for each; the corners keep their numbers.

        Args:
            marked: Whether a triangle is to be cut; by default all. Others are cut if a node would hang.
        """
        points, six = self.points, self.cells
        if six.shape[1] == 3:
            edges = edges_of(self.cells)[0]
            points = np.vstack([points, points[edges].mean(axis=1)])
            middles = [_numbers(edges, self.cells[:, ends]) + len(self.points) for ends in OPPOSITE]
            six = np.column_stack([self.cells, *middles])
        if marked is None:
            parents, parts = np.repeat(np.arange(len(six)), 4), np.tile(CHILDREN, (len(six), 1))
        else:
            parents, parts = bisected(points, six, marked)
        cells = six[parents[:, None], parts]
        cut = np.isin(np.arange(len(points)), cells)  # middles of edges that are not cut are no corners
        if self.cells.shape[1] == 6:
            points, cells = self._curved(parents, parts, cells)
        chains = np.vstack([six[:, [a, 3 + i, b]] for i, (a, b) in enumerate(OPPOSITE)])
        kept = np.unique(cells)
        number = np.full(len(points), -1)
        number[kept] = np.arange(len(kept))

        def halves(edges: np.ndarray) -> np.ndarray:
            return number[_halved(edges, chains, cut)]

        mirrors, slides = (
            {axis: halves(edges) for axis, edges in planes.items()} for planes in (self.mirrors, self.slides)
        )
        out = replace(
            self,
            points=points[kept],
            cells=number[cells],
            held=halves(self.held),
            moved=halves(self.moved),
            mirrors=mirrors,
            slides=slides,
            point=int(number[self.centre]),
        )
        return out._on_edge() if self.edge_at else out

    def _curved(
        self, parents: np.ndarray, parts: np.ndarray, cells: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Nodes on the edges of the parts of curved triangles, on the same quadratic surface."""
        at = NODES[parts[:, OPPOSITE]].mean(axis=2)
        shapes = quadratics(at.reshape(-1, 2)).reshape(len(cells), 3, 6)
        edges, _ = edges_of(cells)
        new = np.zeros((len(edges), 3))
        number = np.stack([_numbers(edges, cells[:, ends]) for ends in OPPOSITE], axis=1)
        new[number] = np.einsum("cqi,cid->cqd", shapes, self.points[self.cells[parents]])
        return np.vstack([self.points, new]), np.column_stack([cells, number + len(self.points)])

    def _on_edge(self) -> Reference:
        """The same with all nodes of held edges on the true edge."""
        nodes, base = np.unique(self.held), [len(self.points), 1]
        if self.cells.shape[1] == 6:
            rim = np.sort(self.held, axis=1) @ base
            on = [np.isin(np.sort(self.cells[:, ends], axis=1) @ base, rim) for ends in OPPOSITE]
            nodes = np.append(nodes, self.cells[:, 3:][np.column_stack(on)])
        points = self.points.copy()
        points[nodes] = self.edge_at(points[nodes])
        return replace(self, points=points)


def bisected(points: np.ndarray, six: np.ndarray, marked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cut triangles by DOLFINx: all edges of those marked, and longest edges of others until no node hangs.

    Every rank cuts the same mesh by itself, with the same result.

    Args:
        points: Nodes, ``(n, 3)``.
        six: Nodes of the triangles, ``(m, 6)``.
        marked: Whether a triangle is to be cut.

    Returns:
        For each part the triangle that it belongs to, and its corners among that triangle's six nodes.
    """
    corners, numbers = np.unique(six[:, :3], return_inverse=True)
    mesh = in_space(MPI.COMM_SELF, points[corners], numbers.reshape(-1, 3))
    mesh.topology.create_entities(1)
    cells = np.flatnonzero(marked[mesh.topology.original_cell_index]).astype(np.int32)
    edges = dmesh.compute_incident_entities(mesh.topology, cells, 2, 1)
    fine = dmesh.refine(mesh, edges)[0]
    # Releases differ in the triangles that they name as parents, so that these are found by their nodes.
    flat = points.copy()
    for i, ends in enumerate(OPPOSITE):
        flat[six[:, 3 + i]] = points[six[:, ends]].mean(axis=1)
    nodes = np.unique(six)
    parts = nodes[cKDTree(flat[nodes]).query(fine.geometry.x)[1]][fine.geometry.dofmap]
    shared = (_incidence(parts, len(points)) @ _incidence(six, len(points)).T).tocoo()
    parents = np.zeros(len(parts), int)
    parents[shared.row[shared.data == 3]] = shared.col[shared.data == 3]
    parts = (six[parents][:, None] == parts[:, :, None]).argmax(axis=2)
    (ax, ay), (bx, by) = ((NODES[parts[:, i]] - NODES[parts[:, 0]]).T for i in (1, 2))
    turned = ax * by < ay * bx
    parts[turned] = parts[turned][:, [0, 2, 1]]
    order = np.lexsort([*parts.T, parents])
    return parents[order], parts[order]


def _incidence(cells: np.ndarray, nodes: int) -> csr_matrix:
    """Which nodes each cell has."""
    rows = np.repeat(np.arange(len(cells)), cells.shape[1])
    return csr_matrix((np.ones(cells.size), (rows, cells.ravel())), shape=(len(cells), nodes))


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


def _halved(edges: np.ndarray, chains: np.ndarray, cut: np.ndarray) -> np.ndarray:
    """The halves of some edges, whose nodes are listed with all others in ``chains``, ``(k, 3)``.

    Edges whose middle is not in ``cut`` stay whole.
    """
    if not len(edges):
        return edges
    every, first = np.unique(np.sort(chains[:, [0, 2]], axis=1), axis=0, return_index=True)
    middle = chains[first][_numbers(every, edges), 1]
    at, whole = cut[middle], edges[~cut[middle]]
    halves = np.column_stack([edges[:, 0], middle])[at], np.column_stack([middle, edges[:, 1]])[at]
    return np.vstack([*halves, whole])


def boundary(cells: np.ndarray) -> np.ndarray:
    """Edges of one triangle."""
    edges, count = edges_of(cells[:, :3])
    return edges[count == 1]
