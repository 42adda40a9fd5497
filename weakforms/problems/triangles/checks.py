"""Checks that a triangulation is a surface, and one suitable for a membrane of revolution."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from weakforms.errors import InputError

Refuse = Callable[[str], None]

COINCIDENT = 1e-6
"""Distance, relative to the size of the surface, within which two nodes are the same point."""

FLAT = 1e-12
"""Largest area, relative to the square of the surface's size, of a degenerate triangle."""

CIRCULARITY = 1e-3
"""Largest spread of radius and height of a circular edge, relative to the size of the surface."""


def edges_of(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Edges as pairs of nodes in ascending order, ``(k, 2)``, and the number of triangles of each."""
    return np.unique(np.sort(_directed(triangles), axis=1), axis=0, return_counts=True)


def _directed(triangles: np.ndarray) -> np.ndarray:
    return np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def require_surface(points: np.ndarray, triangles: np.ndarray, name: str) -> None:
    """Refuse a mesh unless it is a connected, oriented surface whose edges are circles about the ``z`` axis.

    Args:
        points: Nodes, ``(n, 3)``, each of them used.
        triangles: ``(m, 3)``.
        name: Name of the file, for the message.

    Raises:
        InputError: With a message that says what is wrong, where, and what is allowed.
    """

    def refuse(what: str) -> None:
        raise InputError(f"surface: geometry = {name}: {what}")

    size = float(np.ptp(points, axis=0).max())
    _require_clamped(points, require_manifold(points, triangles, refuse), size, refuse)


def require_manifold(points: np.ndarray, triangles: np.ndarray, refuse: Refuse) -> np.ndarray:
    """Refuse a mesh unless it is one connected and oriented surface, without doubtful nodes and triangles.

    Args:
        points: Nodes, ``(n, 3)``, each of them used.
        triangles: ``(m, 3)``.
        refuse: Raises an error with a text.

    Returns:
        Edges of one triangle, as pairs of nodes.
    """
    if not np.isfinite(points).all():
        refuse("a coordinate is not a finite number")
    size = float(np.ptp(points, axis=0).max())
    pairs = cKDTree(points).query_pairs(COINCIDENT * size, output_type="ndarray")
    if len(pairs):
        a, b = pairs[0]
        refuse(f"{len(pairs)} duplicate nodes, the first {at(points[b])} ({a} and {b}); merge them")
    _require_triangles(points, triangles, size, refuse)
    edges, count = edges_of(triangles)
    if count.max() > 2:
        a, b = edges[np.argmax(count)]
        refuse(
            f"not a manifold: the edge from {place(points[a])} to {place(points[b])} has {count.max()} "
            "triangles; allowed: 1 or 2"
        )
    directed, times = np.unique(_directed(triangles), axis=0, return_counts=True)
    if times.max() > 1:
        a, b = directed[np.argmax(times)]
        refuse(
            f"{np.sum(times > 1)} edges have the same direction in both their triangles, the first "
            f"{at(points[a])}; orient all triangles alike"
        )
    graph = coo_matrix((np.ones(len(edges)), edges.T), shape=(len(points),) * 2)
    parts, _ = connected_components(graph, directed=False)
    if parts > 1:
        refuse(f"it has {parts} parts that are not connected; allowed: 1")
    _require_conforming(points, edges[count == 1], size, refuse)
    return edges[count == 1]


def _require_conforming(points: np.ndarray, boundary: np.ndarray, size: float, refuse: Refuse) -> None:
    """Refuse nodes inside of other triangles' edges: the surface is open there without a gap."""
    if not len(boundary):
        return
    nodes = np.unique(boundary)
    ends = points[boundary]
    along = ends[:, 1] - ends[:, 0]
    lengths = np.linalg.norm(along, axis=1)
    near = cKDTree(points[nodes]).query_ball_point(ends.mean(axis=1), lengths / 2)
    for (a, b), start, side, length, found in zip(boundary, ends[:, 0], along, lengths, near, strict=True):
        for node in set(nodes[found].tolist()) - {int(a), int(b)}:
            off = np.linalg.norm(np.cross(points[node] - start, side)) / length
            if off < COINCIDENT * size:
                refuse(
                    f"node {node} {at(points[node])} hangs on the edge from {place(points[a])} to "
                    f"{place(points[b])}; allowed: edges that end at common nodes"
                )


def _require_triangles(points: np.ndarray, triangles: np.ndarray, size: float, refuse: Refuse) -> None:
    same = len(triangles) - len(np.unique(np.sort(triangles, axis=1), axis=0))
    if same:
        refuse(f"{same} duplicate triangles; allowed: none")
    corners = points[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat = np.flatnonzero(np.linalg.norm(normal, axis=1) < 2 * FLAT * size**2)
    if len(flat):
        refuse(f"{len(flat)} triangles without area, the first {at(corners[flat[0], 0])}; allowed: none")


def _require_clamped(points: np.ndarray, boundary: np.ndarray, size: float, refuse: Refuse) -> None:
    """Refuse a surface unless it has one or two edges, which are circles about the axis."""
    if not len(boundary):
        refuse("it is closed and has no edge to clamp; allowed: one or two edges")
    nodes, ends = np.unique(boundary, return_inverse=True)
    graph = coo_matrix((np.ones(len(boundary)), ends.reshape(-1, 2).T), shape=(len(nodes),) * 2)
    parts, which = connected_components(graph, directed=False)
    if parts > 2:
        refuse(f"it has {parts} edges; allowed: one or two")
    for part in range(parts):
        x, y, z = points[nodes[which == part]].T
        spread = max(np.ptp(np.hypot(x, y)), np.ptp(z)) / size
        if spread > CIRCULARITY:
            refuse(
                f"an edge is not a circle about the z axis: its radius or height varies by {spread:.1e} "
                f"of the size; allowed: {CIRCULARITY:g}"
            )


def at(point: np.ndarray) -> str:
    """Where something is, in a message."""
    return f"at {place(point)}"


def place(point: np.ndarray) -> str:
    """Coordinates in a message."""
    return "({:.6g}, {:.6g}, {:.6g})".format(*point)
