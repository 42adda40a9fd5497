"""Stress-free surfaces that need no file: a disk, a square, and a quarter of one sheet of a square airbag."""

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
        edges = edges_of(cells)[0]
        middle = points[edges].mean(axis=1)
        outer = np.isin(edges, rim).all(axis=1) & (np.linalg.norm(points[edges], axis=2) > 1 - 1e-9).all(
            axis=1
        )
        middle[outer] /= np.linalg.norm(middle[outer], axis=1)[:, None]
        number = {tuple(edge): len(points) + i for i, edge in enumerate(edges.tolist())}
        more = [[number[tuple(sorted((c[a], c[b])))] for a, b in OPPOSITE] for c in cells.tolist()]
        points, cells = np.vstack([points, middle]), np.column_stack([cells, more])
    return Reference(points, cells, rim, {}, edge_at=_on_circle)


def _on_circle(points: np.ndarray) -> np.ndarray:
    return points / np.linalg.norm(points, axis=1)[:, None]


def square(cells: int) -> Reference:
    """The square ``[-1, 1]^2``, cut into squares with both diagonals.

    Args:
        cells: Squares along half a side.
    """
    points, found = _crossed(np.linspace(-1, 1, 2 * cells + 1))
    return Reference(points, found, boundary(found), {})


def airbag(cells: int) -> Reference:
    """A quarter ``[0, 1]^2`` of one of the two sheets of a square airbag, joined at its edges.

    By symmetry the seam slides in the plane ``Z = 0``.

    Args:
        cells: Squares along half a side.
    """
    points, found = _crossed(np.linspace(0, 1, cells + 1))
    edges = boundary(found)
    x, y = points[edges, :2].max(axis=1).T
    mirrors = {"X": edges[x == 0], "Y": edges[y == 0]}
    seam = edges[(points[edges, 0] == 1).all(axis=1) | (points[edges, 1] == 1).all(axis=1)]
    return Reference(points, found, np.empty((0, 2), int), mirrors, slides={"Z": seam})


def _crossed(line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and triangles of a square cut into squares with both diagonals."""
    n = len(line) - 1
    corners = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    half = (line[1:] + line[:-1]) / 2
    centres = np.stack(np.meshgrid(half, half, indexing="ij"), axis=-1).reshape(-1, 2)
    flat = np.vstack([corners, centres])
    i, j = np.divmod(np.arange(n * n), n)
    around = [(i + a) * (n + 1) + j + b for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    middle = (n + 1) ** 2 + np.arange(n * n)
    triangles = [np.column_stack([around[k], around[(k + 1) % 4], middle]) for k in range(4)]
    return np.column_stack([flat, 0 * flat[:, 0]]), np.stack(triangles, axis=1).reshape(-1, 3)
