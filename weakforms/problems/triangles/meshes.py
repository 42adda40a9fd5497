"""Triangulated membranes of revolution: the structured tube, a hemisphere by gmsh, a file of the user."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import basix.ufl
import numpy as np
import ufl
from dolfinx import mesh as dmesh
from mpi4py import MPI

from weakforms.errors import InputError
from weakforms.problems.triangles.checks import edges_of, require_surface
from weakforms.problems.triangles.files import compact, read_mesh
from weakforms.solvers.support import compat


@dataclass(frozen=True)
class Triangulation:
    """Flat triangles in space, the same on every rank; their vertices are counterclockwise from outside."""

    points: np.ndarray
    """Reference position of the nodes, ``(n, 3)``; the axis is the ``z`` axis."""
    triangles: np.ndarray
    """Nodes of the triangles, ``(m, 3)``."""
    rings: tuple[int, int] | None = None
    """Rows and columns of quadrilaterals, each with one diagonal, if nodes are numbered ring by ring."""

    @property
    def held(self) -> np.ndarray:
        """Whether a node lies on an edge of the surface."""
        edges, count = edges_of(self.triangles)
        out = np.zeros(len(self.points), dtype=bool)
        out[edges[count == 1]] = True
        return out

    @property
    def angle(self) -> np.ndarray:
        """``Theta`` of the nodes, in ``(-pi, pi]``."""
        return np.arctan2(self.points[:, 1], self.points[:, 0])

    @property
    def radius(self) -> np.ndarray:
        """Distance of the nodes from the axis."""
        return np.hypot(self.points[:, 0], self.points[:, 1])

    @property
    def size(self) -> float:
        """Mean length of the edges."""
        edges, _ = edges_of(self.triangles)
        return float(np.linalg.norm(np.diff(self.points[edges], axis=1)[:, 0], axis=1).mean())

    def mesh(self, comm: MPI.Intracomm) -> dmesh.Mesh:
        """The mesh on all ranks: a manifold in space, which is the reference surface."""
        return in_space(comm, self.points, self.triangles)


def in_space(comm: MPI.Intracomm, points: np.ndarray, cells: np.ndarray) -> dmesh.Mesh:
    """A mesh of given triangles on all ranks, a manifold in space.

    Args:
        comm: Ranks.
        points: Nodes, ``(n, 3)``, the same on every rank.
        cells: Corners, ``(m, 3)``; or ``(m, 6)`` with the nodes opposite to each corner.
    """
    count = cells.shape[1]
    element = basix.ufl.element("Lagrange", "triangle", {3: 1, 6: 2}[count], shape=(3,))
    if comm.rank:
        cells, points = np.empty((0, count)), np.empty((0, 3))
    mesh = compat.create_mesh(comm, cells.astype(np.int64), points, ufl.Mesh(element))
    mesh.topology.create_connectivity(1, 2)
    return mesh


def tube(length: float, meridional: int, circumferential: int, mirrored: bool = False) -> Triangulation:
    """A cylinder of radius 1 with uniform nodes in ``(S, Theta)`` and all diagonals in the same direction.

    The nodes lie on the cylinder and the triangles are flat, so that the metric belongs to the inscribed
    prism, as in any finite element code.

    Args:
        length: Length of the cylinder.
        meridional: Number of quadrilaterals along it.
        circumferential: Number of quadrilaterals around it.
        mirrored: Whether quadrilaterals have the other diagonal.

    Raises:
        InputError: If there are fewer than three columns.
    """
    if circumferential < 3:
        raise InputError(
            f"surface: a mesh of circumferential = {circumferential} cannot close; allowed: 3 or more"
        )
    s = length * np.arange(meridional + 1) / meridional
    theta = 2 * np.pi * np.arange(circumferential) / circumferential
    around = np.column_stack([np.cos(theta), np.sin(theta)])
    points = np.column_stack([np.tile(around, (meridional + 1, 1)), np.repeat(s, circumferential)])
    i, k = np.divmod(np.arange(meridional * circumferential), circumferential)
    corners = [(i + a) * circumferential + (k + b) % circumferential for a in (0, 1) for b in (0, 1)]
    low, low_next, high, high_next = corners
    if mirrored:
        pairs = (low, low_next, high), (low_next, high_next, high)
    else:
        pairs = (low, low_next, high_next), (low, high_next, high)
    triangles = np.stack([np.stack(pair, axis=1) for pair in pairs], axis=1).reshape(-1, 3)
    return Triangulation(points, triangles, (meridional, circumferential))


def hemisphere_in_columns(meridional: int, circumferential: int) -> Triangulation:
    """The lower half of the unit sphere in columns along meridians, with a fan of triangles at the pole.

    Its edges follow the meridians, as on the structured tube. Short waves around the axis do not stretch the
    meridian; they are resolved by much fewer triangles than on an unstructured mesh.

    Args:
        meridional: Number of rows from the pole to the equator.
        circumferential: Number of columns.
    """
    t = np.pi / 2 * np.arange(1, meridional + 1) / meridional
    theta = 2 * np.pi * np.arange(circumferential) / circumferential
    around = np.column_stack([np.cos(theta), np.sin(theta)])
    rows = [np.column_stack([np.sin(a) * around, np.full(circumferential, -np.cos(a))]) for a in t]
    points = np.concatenate([[[0.0, 0.0, -1.0]], *rows])
    points[-circumferential:, 2] = 0.0
    k = np.arange(circumferential)
    after = (k + 1) % circumferential
    parts = [np.column_stack([np.zeros_like(k), 1 + after, 1 + k])]
    for i in range(meridional - 1):
        low, high = 1 + i * circumferential, 1 + (i + 1) * circumferential
        parts += [
            np.column_stack([low + k, low + after, high + after]),
            np.column_stack([low + k, high + after, high + k]),
        ]
    return Triangulation(points, np.concatenate(parts).astype(np.int64))


def hemisphere(size: float) -> Triangulation:
    """The lower half of the unit sphere, unstructured, by gmsh on four octants, with a node at the pole.

    Args:
        size: Length of the edges.
    """
    import gmsh  # its library is large, and few meshes need it

    mine = not gmsh.isInitialized()
    if mine:
        gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("hemisphere")
    try:
        geo = gmsh.model.geo
        centre = geo.addPoint(0, 0, 0)
        pole = geo.addPoint(0, 0, -1, size)
        rim = [geo.addPoint(x, y, 0, size) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        down = [geo.addCircleArc(point, centre, pole) for point in rim]
        along = [geo.addCircleArc(rim[k], centre, rim[(k + 1) % 4]) for k in range(4)]
        for k in range(4):
            loop = geo.addCurveLoop([along[k], down[(k + 1) % 4], -down[k]])
            geo.addSurfaceFilling([loop], sphereCenterTag=centre)
        geo.synchronize()
        gmsh.model.mesh.generate(2)
        tags, flat, _ = gmsh.model.mesh.getNodes()
        _, nodes = gmsh.model.mesh.getElementsByType(2)
    finally:
        gmsh.model.remove()
        if mine:
            gmsh.finalize()
    place = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    place[tags] = np.arange(len(tags))
    points, triangles = compact(flat.reshape(-1, 3), place[nodes].reshape(-1, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    return outwards(Triangulation(points, triangles))


def from_file(path: Path) -> Triangulation:
    """A user's triangulated surface of revolution about the ``z`` axis.

    Args:
        path: A file that meshio reads; lines and single nodes in it are ignored.

    Raises:
        InputError: If it cannot be read or is not a suitable surface; the message says what is wrong.
        EnvironmentLackError: Without meshio.
    """
    named = f"surface: geometry = {path}"
    read = read_mesh(path, named, ("triangle",))
    blocks = [block.data for block in read.cells if block.type == "triangle"]
    points, triangles = compact(np.asarray(read.points, float), np.vstack(blocks).astype(np.int64))
    if points.shape[1] != 3:
        raise InputError(f"{named} lies in a plane; allowed: a surface in space")
    require_surface(points, triangles, str(path))
    return outwards(Triangulation(points, triangles))


def outwards(given: Triangulation) -> Triangulation:
    """The same consistently oriented surface, with normals away from the axis."""
    corners = given.points[given.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = corners.mean(axis=1)
    if np.sum(middle[:, :2] * normal[:, :2]) >= 0:
        return given
    return Triangulation(given.points, given.triangles[:, ::-1].copy(), None)
