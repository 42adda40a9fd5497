"""Stress-free surfaces without a file: disk, square, quarters of a square airbag's sheet and a tube."""

from __future__ import annotations

import numpy as np

from weakforms.problems.membrane.reference import OPPOSITE, Reference, boundary
from weakforms.problems.triangles.checks import edges_of


def disk(rings: int, degree: int) -> Reference:
    """The unit disk in six sectors; with degree 2 its edge is curved.

    Args:
        rings: Triangles along the radius.
        degree: Of the triangles' sides: 1 straight (a polygon inscribed in the circle), 2 curved.
    """

    def node(ring: int, sector: int, place: int) -> int:
        return 1 + 3 * ring * (ring - 1) + (sector * ring + place) % (6 * ring) if ring else 0

    points, cells = [np.zeros((1, 3))], []
    for k in range(1, rings + 1):
        points.append(_hexagon(k) * k / rings)
        for s in range(6):
            cells += [(node(k, s, j), node(k, s, j + 1), node(k - 1, s, j)) for j in range(k)]
            cells += [(node(k - 1, s, j), node(k, s, j + 1), node(k - 1, s, j + 1)) for j in range(k - 1)]
    return _held(np.vstack(points), np.array(cells), degree)


def _hexagon(count: int) -> np.ndarray:
    angle = np.pi / 3 * np.arange(6 * count) / count
    return np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])


def _held(points: np.ndarray, cells: np.ndarray, degree: int) -> Reference:
    """A disk with its edge held."""
    rim = boundary(cells)
    if degree == 2:
        edges, more = _middles(cells)
        middle = points[edges].mean(axis=1)
        outer = np.isin(edges, rim).all(axis=1) & (np.linalg.norm(points[edges], axis=2) > 1 - 1e-9).all(
            axis=1
        )
        middle[outer] /= np.linalg.norm(middle[outer], axis=1)[:, None]
        points, cells = np.vstack([points, middle]), np.column_stack([cells, len(points) + more])
    return Reference(points, cells, rim, {}, edge_at=_on_circle)


def _middles(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Edges of triangles, ``(k, 2)``, and which of them is opposite to each corner, ``(m, 3)``."""
    edges = edges_of(cells)[0]
    number = {tuple(edge): i for i, edge in enumerate(edges.tolist())}
    found = [[number[tuple(sorted((c[a], c[b])))] for a, b in OPPOSITE] for c in cells.tolist()]
    return edges, np.array(found)


def _on_circle(points: np.ndarray) -> np.ndarray:
    return points / np.linalg.norm(points, axis=1)[:, None]


def square(cells: int) -> Reference:
    """The square ``[-1, 1]^2``, cut into squares with both diagonals.

    Args:
        cells: Squares along half a side.
    """
    line = np.linspace(-1, 1, 2 * cells + 1)
    points, found = _crossed(line, line)
    return Reference(points, found, boundary(found), {})


def airbag(cells: int) -> Reference:
    """A quarter ``[0, 1]^2`` of one of the two sheets of a square airbag, joined at its edges.

    By symmetry the seam slides in the plane ``Z = 0``.

    Args:
        cells: Squares along half a side.
    """
    line = np.linspace(0, 1, cells + 1)
    points, found = _crossed(line, line)
    edges = boundary(found)
    x, y = points[edges, :2].max(axis=1).T
    mirrors = {"X": edges[x == 0], "Y": edges[y == 0]}
    seam = edges[(points[edges, 0] == 1).all(axis=1) | (points[edges, 1] == 1).all(axis=1)]
    return Reference(points, found, np.empty((0, 2), int), mirrors, slides={"Z": seam})


def tube(cells: int, length: float, degree: int) -> Reference:
    """A quarter of a tube of radius 1 whose ends are held: ``Y >= 0``, and ``Z`` from the middle upwards.

    Triangles are shorter at the held end, where a tube without pre-stretch has a thin layer.

    Args:
        cells: Rectangles around the half circumference, on average as long as wide.
        length: Of the whole tube.
        degree: Of the triangles' sides: 1 straight, 2 curved.
    """
    share = np.linspace(0, 1, max(2, round(cells * length / (2 * np.pi))) + 1)
    along = length / 2 * np.sin(np.pi / 2 * share)
    flat, found = _crossed(np.linspace(0, np.pi, cells + 1), along)
    edges = boundary(found)
    if degree == 2:
        pairs, more = _middles(found)
        found = np.column_stack([found, len(flat) + more])
        flat = np.vstack([flat, flat[pairs].mean(axis=1)])
    angle, z, _ = flat.T

    def at(values: np.ndarray, value: float) -> np.ndarray:
        return edges[np.isclose(values[edges], value).all(axis=1)]

    mirrors = {"Y": np.vstack([at(angle, 0), at(angle, np.pi)]), "Z": at(z, 0)}
    points = np.column_stack([np.cos(angle), np.sin(angle), z])
    return Reference(points, found, at(z, length / 2), mirrors)


def _crossed(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and triangles of a rectangle cut into rectangles with both diagonals."""
    n, m = len(one) - 1, len(other) - 1
    corners = np.stack(np.meshgrid(one, other, indexing="ij"), axis=-1).reshape(-1, 2)
    halves = [(line[1:] + line[:-1]) / 2 for line in (one, other)]
    centres = np.stack(np.meshgrid(*halves, indexing="ij"), axis=-1).reshape(-1, 2)
    flat = np.vstack([corners, centres])
    i, j = np.divmod(np.arange(n * m), m)
    around = [(i + a) * (m + 1) + j + b for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    middle = (n + 1) * (m + 1) + np.arange(n * m)
    triangles = [np.column_stack([around[k], around[(k + 1) % 4], middle]) for k in range(4)]
    return np.column_stack([flat, 0 * flat[:, 0]]), np.stack(triangles, axis=1).reshape(-1, 3)
