"""Meshes of a quarter of a body's mid-surface, of its wall, and of the wall's section; all quadratic."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from weakforms.decks.bodies import Body

CORNERS = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1))
"""Nodes of a quadrilateral on a grid of half steps: corners, middles of edges, centre."""

FIRST = 0.05
"""Length of a cell at a clamp over the mean."""


@dataclass(frozen=True)
class Surface:
    """Quadrilaterals of nine nodes, counterclockwise from outside."""

    s: np.ndarray
    """Place of each node along the meridian, in ``[0, 1]``."""
    points: np.ndarray
    normals: np.ndarray
    thickness: np.ndarray
    """Over its mean."""
    quads: np.ndarray
    stations: np.ndarray
    """The nodes in the plane ``y = 0``, along the meridian."""

    def triangles(self) -> np.ndarray:
        """Each quadrilateral as two triangles of six nodes."""
        a, b, c, d, ab, bc, cd, da, m = self.quads.T
        halves = np.stack([[a, b, c, ab, bc, m], [a, c, d, m, cd, da]])
        return halves.transpose(2, 0, 1).reshape(-1, 6)

    def on(self, x: float | None = None, y: float | None = None, z: float | None = None) -> np.ndarray:
        """Whether a node lies in a plane."""
        places = zip(self.points.T, (x, y, z), strict=True)
        found = [np.isclose(place, value, atol=1e-9) for place, value in places if value is not None]
        return np.all(found, axis=0)


@dataclass(frozen=True)
class Wall:
    """A solid of finite thickness about a mid-surface, in space or in the plane ``(r, z)``."""

    points: np.ndarray
    cells: np.ndarray
    """Nodes in the order of Abaqus; the first face is the inner one."""
    s: np.ndarray
    offset: np.ndarray
    """Distance of a node from the mid-surface."""
    stations: np.ndarray
    """Inner and outer node of each station along the meridian, ``(n, 2)``."""


def cells_along(body: Body) -> int:
    """Number of quadrilaterals along the meridian: a tenth of a radius long, at least 32."""
    return min(400, max(32, 2 * int(np.ceil(body.size / 0.2))))


def cells_around(cells: int, body: Body) -> int:
    """Number of quadrilaterals in a quarter of the circumference."""
    return cells // 2 if body.pole else max(4, round(8 * cells / cells_along(body)))


def graded(body: Body, t: np.ndarray) -> np.ndarray:
    """Places ``s`` for a solid wall, in smaller and smaller steps towards clamps.

    A membrane leaves its clamp at an angle, to which a wall bends within a length of its own thickness. In a
    long cell it bends too little, and the whole body is too stiff by about the cell's length. The middle node
    of a cell stays near its middle, as elements need.
    """
    ends = {clamp.end for clamp in body.clamps}
    if ends == {0, 1}:
        return t - (1 - FIRST) * np.sin(2 * np.pi * t) / (2 * np.pi)
    bent = (1 - FIRST) * np.sin(np.pi * t) / np.pi
    return t - bent if ends == {0} else t + bent if ends == {1} else t


def surface_mesh(body: Body, cells: int, solid: bool = False) -> Surface:
    """A quarter of the mid-surface, with its cells graded if it is that of a solid.

    Bodies with a pole have three blocks, like the faces at a corner of a cube, so that no cell degenerates.
    """
    if body.pole:
        places, quads = _cap(cells // 2)
    else:
        places, quads = _strip(cells, cells_around(cells, body))
    s, angle = places.T
    s = graded(body, s) if solid else s
    r, z = body.meridian(s)
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
    points[np.abs(points) < 1e-14] = 0.0
    nr, nz = _outward(body, s)
    normals = np.column_stack([nr * np.cos(angle), nr * np.sin(angle), nz])
    stations = np.flatnonzero(np.isclose(points[:, 1], 0.0, atol=1e-12))
    stations = stations[np.argsort(s[stations])]
    return Surface(s, points, normals, body.thickness(s), quads, stations)


def _outward(body: Body, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The normal to the left of the meridian."""
    step = 1e-6
    (r0, z0), (r1, z1) = body.meridian(s - step), body.meridian(s + step)
    size = np.hypot(r1 - r0, z1 - z0)
    return -(z1 - z0) / size, (r1 - r0) / size


def _quads(index: np.ndarray) -> np.ndarray:
    """Quadrilaterals on a grid of nodes in half steps."""
    rows, columns = index.shape
    return np.stack(
        [index[a : rows - 2 + a : 2, b : columns - 2 + b : 2].ravel() for a, b in CORNERS], axis=1
    )


def _strip(cells: int, around: int) -> tuple[np.ndarray, np.ndarray]:
    s, angle = np.meshgrid(
        np.linspace(0, 1, 2 * cells + 1), np.linspace(0, np.pi / 2, 2 * around + 1), indexing="ij"
    )
    index = np.arange(s.size).reshape(s.shape)
    return np.column_stack([s.ravel(), angle.ravel()]), _quads(index)


def _cap(cells: int) -> tuple[np.ndarray, np.ndarray]:
    line = np.tan(np.linspace(0, np.pi / 4, 2 * cells + 1))
    u, v = (g.ravel() for g in np.meshgrid(line, line, indexing="ij"))
    one = np.ones_like(u)
    faces = np.concatenate([np.column_stack(face) for face in ((u, v, one), (one, u, v), (v, one, u))])
    faces /= np.linalg.norm(faces, axis=1)[:, None]
    _, first, node = np.unique(np.round(faces, 12), axis=0, return_index=True, return_inverse=True)
    x, y, z = faces[first].T
    block = _quads(np.arange(u.size).reshape(len(line), -1))
    quads = np.concatenate([np.ravel(node)[block + k * u.size] for k in range(3)])
    return np.column_stack([np.arccos(np.clip(z, -1, 1)) * 2 / np.pi, np.arctan2(y, x)]), quads


def wall(surface: Surface, thickness: float) -> Wall:
    """The wall as hexahedra of 20 nodes, one through the thickness."""
    n = len(surface.points)
    corners = np.unique(surface.quads[:, :4])
    half = thickness / 2 * surface.thickness
    offset = np.concatenate([-half, half, np.zeros(len(corners))])
    foot = np.concatenate([np.arange(n), np.arange(n), corners])
    points = surface.points[foot] + offset[:, None] * surface.normals[foot]
    middle = np.zeros(n, dtype=int)
    middle[corners] = 2 * n + np.arange(len(corners))
    corner, edge = surface.quads[:, :4], surface.quads[:, 4:8]
    cells = np.hstack([corner, corner + n, edge, edge + n, middle[corner]])
    used, inverse = np.unique(cells, return_inverse=True)
    place = np.full(len(points), -1)
    place[used] = np.arange(len(used))
    stations = place[np.column_stack([surface.stations, surface.stations + n])]
    return Wall(points[used], inverse.reshape(cells.shape), surface.s[foot][used], offset[used], stations)


def section(body: Body, cells: int, thickness: float) -> Wall:
    """The section of the wall in the plane ``(r, z)`` as quadrilaterals of eight nodes."""
    s = graded(body, np.linspace(0, 1, 2 * cells + 1))
    normals = np.column_stack(_outward(body, s))
    mid = np.column_stack(body.meridian(s))
    half = thickness / 2 * body.thickness(s)
    n = len(s)
    inner, outer, middle = mid - half[:, None] * normals, mid + half[:, None] * normals, mid[::2]
    points = np.concatenate([inner, outer, middle])
    points[np.abs(points) < 1e-12] = 0.0
    k = np.arange(cells)
    a, b, c = 2 * k, 2 * k + 1, 2 * k + 2
    quads = np.column_stack([a, c, c + n, a + n, b, 2 * n + k + 1, b + n, 2 * n + k])
    places = np.concatenate([s, s, s[::2]])
    offset = np.concatenate([-half, half, np.zeros(len(middle))])
    return Wall(points, quads, places, offset, np.column_stack([np.arange(n), np.arange(n) + n]))
