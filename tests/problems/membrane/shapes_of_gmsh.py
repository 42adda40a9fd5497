"""Meshes by gmsh, as a user has them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import gmsh


def written(path: Path, draw: Callable[[], dict[str, list[int]]], size: float, order: int = 1) -> Path:
    """A file with triangles and named groups of curves.

    Args:
        path: The file.
        draw: Adds a shape to the model and returns its groups of curves; the surfaces are a group too.
        size: Length of the edges.
        order: 1 for straight triangles, 2 for curved ones.
    """
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
        groups = draw()
        for name, curves in groups.items():
            gmsh.model.addPhysicalGroup(1, curves, name=name)
        gmsh.model.addPhysicalGroup(2, [tag for _, tag in gmsh.model.getEntities(2)], name="sheet")
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


def polygon(corners: list[tuple[float, float]]) -> list[int]:
    """A flat polygon; returns its sides."""
    points = [gmsh.model.geo.addPoint(x, y, 0) for x, y in corners]
    n = len(points)
    sides = [gmsh.model.geo.addLine(points[i], points[(i + 1) % n]) for i in range(n)]
    gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(sides)])
    gmsh.model.geo.synchronize()
    return sides


def ell() -> dict[str, list[int]]:
    """An L."""
    sides = polygon([(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1)])
    return {"rim": sides}


def square() -> dict[str, list[int]]:
    """The square of the built-in mesh."""
    return {"rim": polygon([(-1, -1), (1, -1), (1, 1), (-1, 1)])}


def round_sheet(hole: bool = False) -> dict[str, list[int]]:
    """A unit disk, with or without a hole off its centre."""
    occ = gmsh.model.occ
    rim = occ.addCircle(0, 0, 0, 1)
    loops = [occ.addCurveLoop([rim])]
    inner = occ.addCircle(0.3, 0.1, 0, 0.25) if hole else 0
    if hole:
        loops.append(occ.addCurveLoop([inner]))
    occ.addPlaneSurface(loops)
    occ.synchronize()
    return {"rim": [rim]} | ({"hole": [inner]} if hole else {})


def ring() -> dict[str, list[int]]:
    """A unit disk with a hole of radius 0.4 in its middle."""
    occ = gmsh.model.occ
    rim, hole = occ.addCircle(0, 0, 0, 1), occ.addCircle(0, 0, 0, 0.4)
    occ.addPlaneSurface([occ.addCurveLoop([rim]), occ.addCurveLoop([hole])])
    occ.synchronize()
    return {"rim": [rim], "hole": [hole]}


def quarter_disk() -> dict[str, list[int]]:
    """A quarter of the unit disk."""
    geo = gmsh.model.geo
    o, a, b = (geo.addPoint(*x, 0) for x in ((0, 0), (1, 0), (0, 1)))
    bottom, rim, left = geo.addLine(o, a), geo.addCircleArc(a, o, b), geo.addLine(b, o)
    geo.addPlaneSurface([geo.addCurveLoop([bottom, rim, left])])
    geo.synchronize()
    return {"rim": [rim], "bottom": [bottom], "left": [left]}


def octant() -> dict[str, list[int]]:
    """An eighth of the unit sphere, with normals outwards, away from the origin."""
    geo = gmsh.model.geo
    ends = ((0, 0, 0.3), (1, 0, 0.3), (0, 1, 0.3), (0, 0, 1.3))
    o, x, y, z = (geo.addPoint(*at) for at in ends)
    xy, yz, zx = geo.addCircleArc(x, o, y), geo.addCircleArc(y, o, z), geo.addCircleArc(z, o, x)
    geo.addSurfaceFilling([geo.addCurveLoop([xy, yz, zx])], sphereCenterTag=o)
    geo.synchronize()
    return {"x": [yz], "y": [zx], "z": [xy]}
