"""Meshes of cylindrical sheets, made by gmsh: transfinite, uniform around, graded along."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

import numpy as np
from dolfinx import mesh as dmesh
from mpi4py import MPI

from weakforms.solvers.support import compat

SURFACE = 1
"""Tag of the physical group that gmsh exports."""


TOP = 0.4
"""Grading of the upper half of a sheet: the last cell is smaller than the mean by this."""


SHARES = {1: (2, 1, 1, 2), 2: (2, 1, 1, 2), 3: (2, 2, 1, 1)}
"""Cells, in sixths, between the ends, a quarter and half of the length, and the free surface, by the number
of these other rows below it."""

GRADED = 0.4
"""Cells at a ring are smaller than the mean of those up to the next row by this."""

CLEAR = 0.05
"""Smallest distance of the free surface's row from a fixed row of the original mesh, relative to the
length."""


def heights(cells: int, length: float) -> np.ndarray:
    """Nodes along a sheet: half of the cells are on the lowest quarter, a quarter of them on the next one.

    They are smooth maps of equidistant nodes on each half; the upper one is graded towards the upper ring's
    boundary layer. Doubling the number of cells therefore refines every cell. ``length/4`` and ``length/2``
    are nodes.

    Args:
        cells: Number of cells, a multiple of four.
        length: Length of the sheet.
    """
    if cells % 4:
        raise ValueError(f"cells = {cells} along the sheet must be a multiple of 4")
    xi = np.linspace(0, 1, cells + 1)
    low = xi / 2 + 2 / 3 * xi * (xi - 1 / 2) + 4 / 3 * xi * (xi - 1 / 2) * (xi - 3 / 4)
    t = 4 * xi - 3
    return length * np.where(t < 0, low, (1 + t + TOP * t * (1 - t)) / 2)


def fitted_heights(cells: int, length: float, front: float) -> tuple[np.ndarray, tuple[float, float, float]]:
    """Nodes along a sheet with a row for the free surface; that row and the fixed rows around it.

    ``length/4`` and ``length/2`` are nodes. Between these and the free surface cells have one size; towards
    the rings they are smaller. Doubling their number refines every cell.

    Args:
        cells: Number of cells, a multiple of six.
        length: Length of the sheet.
        front: Approximate position of the free surface; it stays away from fixed rows by :data:`CLEAR`.
    """
    if cells % 6:
        raise ValueError(f"cells = {cells} along a fitted sheet must be a multiple of 6")
    stay = [0.0, length / 4, length / 2, length]
    # The level decreases along a branch: a free surface that starts near a row moves on below it.
    above = next(k for k in (1, 2, 3) if front < stay[k] + CLEAR * length or k == 3)
    low, high = stay[above - 1], stay[above]
    row = min(max(front, low + CLEAR * length), high - CLEAR * length)
    ends = sorted([*stay, row])
    parts = [cells * share // 6 for share in SHARES[above]]
    pieces = []
    for start, stop, count in zip(ends[:-1], ends[1:], parts, strict=True):
        t = np.arange(count) / count
        finer = GRADED * t * (1 - t) * ((stop == length) - (start == 0.0))
        pieces.append(start + (stop - start) * (t + finer))
    return np.concatenate([*pieces, [length]]), (low, row, high)


def flat_sheet(comm: MPI.Intracomm, nodes: np.ndarray, around: int) -> dmesh.Mesh:
    """Quadrilaterals on ``[0, Z_end] x [0, pi]``, half the circumference unrolled: ``(Z, Theta)``.

    Args:
        comm: Ranks that share the mesh; gmsh runs on the first of them.
        nodes: ``Z`` of the nodes, from 0.
        around: Cells over the half circumference, all of one width.
    """
    with _gmsh(comm) as model:
        if model is not None:
            base = [model.geo.addPoint(0, theta, 0) for theta in (0.0, np.pi)]
            line = model.geo.addLine(*base)
            model.geo.mesh.setTransfiniteCurve(line, around + 1)
            _extrude(model, [line], nodes, (1, 0, 0))
        return _shared(comm, model, 2)


def prism(comm: MPI.Intracomm, nodes: np.ndarray, angles: np.ndarray) -> dmesh.Mesh:
    """Quadrilaterals on a closed prism; each face is isometric to its strip of the cylinder.

    The edges are at the material angles ``angles``, and a face is as wide as the strip's arc is long, so that
    a cell is exactly its rectangle of ``(Z, Theta)``. The edges lie on one circle, whose radius follows from
    the closing condition.

    Args:
        comm: Ranks that share the mesh; gmsh runs on the first of them.
        nodes: ``Z`` of the nodes, from 0.
        angles: ``Theta`` of the edges, ascending from 0, the last below ``2 pi``.
    """
    corners = polygon(np.diff([*angles, angles[0] + 2 * np.pi]))
    with _gmsh(comm) as model:
        if model is not None:
            points = [model.geo.addPoint(x, y, 0) for x, y in corners]
            pairs = zip(points, [*points[1:], points[0]], strict=True)
            lines = [model.geo.addLine(a, b) for a, b in pairs]
            for line in lines:
                model.geo.mesh.setTransfiniteCurve(line, 2)
            _extrude(model, lines, nodes, (0, 0, 1))
        return _shared(comm, model, 3)


def polygon(sides: np.ndarray) -> np.ndarray:
    """Corners, shape ``(n, 2)``, of the polygon with given sides and its corners on a circle about 0.

    The first corner lies on the ``x`` axis; the centre of the circle is inside the polygon.
    """
    sides = np.asarray(sides, dtype=float)
    low, high = sides.max() / 2, sides.sum()

    def excess(radius: float) -> float:
        return float(np.sum(2 * np.arcsin(sides / (2 * radius))) - 2 * np.pi)

    for _ in range(200):  # the excess decreases with the radius
        middle = (low + high) / 2
        low, high = (middle, high) if excess(middle) > 0 else (low, middle)
    turn = np.concatenate([[0.0], np.cumsum(2 * np.arcsin(sides / (2 * low)))[:-1]])
    return low * np.column_stack([np.cos(turn), np.sin(turn)])


def _extrude(model: ModuleType, lines: list[int], nodes: np.ndarray, axis: tuple[int, int, int]) -> None:
    """Sweep lines along an axis into rows of quadrilaterals that end at given nodes."""
    length = nodes[-1] - nodes[0]
    layers = ((nodes[1:] - nodes[0]) / length).tolist()
    swept = model.geo.extrude(
        [(1, line) for line in lines],
        *(length * component for component in axis),
        numElements=[1] * len(layers),
        heights=layers,
        recombine=True,
    )
    model.geo.synchronize()
    model.addPhysicalGroup(2, [tag for dimension, tag in swept if dimension == 2], SURFACE)
    model.mesh.generate(2)


@contextmanager
def _gmsh(comm: MPI.Intracomm) -> Iterator[ModuleType | None]:
    """A gmsh model on the first rank, ``None`` on the others."""
    import gmsh  # its library is large, and few problems need it

    if comm.rank:
        yield None
        return
    mine = not gmsh.isInitialized()
    if mine:
        gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("sheet")
    try:
        yield gmsh.model
    finally:
        gmsh.model.remove()
        if mine:
            gmsh.finalize()


def _shared(comm: MPI.Intracomm, model: ModuleType | None, dimension: int) -> dmesh.Mesh:
    return compat.mesh_from_gmsh(model, comm, 0, dimension)
