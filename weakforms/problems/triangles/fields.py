"""A triangulated state as tables: nodes with their lowest mode, triangles with their stretches."""

from __future__ import annotations

import numpy as np

from weakforms.problems.triangles.branch import Point, SurfaceRun
from weakforms.results import Field


def fields(run: SurfaceRun, point: Point) -> tuple[Field, Field]:
    """Nodes and triangles of a state.

    Nodes: reference ``Z`` and ``Theta``, position ``x, y, z``, lowest mode ``u_x, u_y, u_z`` (largest length
    1) and ``gw`` averaged over the triangles around. The nodes of a tube are in rows of ``Z``; the first
    meridian is repeated at ``Theta = 2 pi``. Triangles: the rows ``a, b, c`` of their nodes in that table,
    counted from 0 and counterclockwise as seen from outside, ``lam1 >= lam2``, and ``state`` (1 taut, 0
    wrinkled, -1 slack).
    """
    given = run.model.body.triangles
    with run.system.at(point.state):
        cells = run.model.by_triangle()
    columns = {"Z": given.points[:, 2], "Theta": np.mod(given.angle + 1e-12, 2 * np.pi)}
    columns |= dict(zip("xyz", run.model.nodal(point.state.u).T, strict=True))
    mode = run.model.nodal(run.lowest_mode(point).vector)
    mode /= np.linalg.norm(mode, axis=1).max()
    columns |= {f"u_{name}": part for name, part in zip("xyz", mode.T, strict=True)}
    gw = cells["lam2"] * np.sqrt(cells["lam1"])
    around = np.bincount(given.triangles.ravel(), minlength=len(given.points))
    columns["gw"] = np.bincount(given.triangles.ravel(), np.repeat(gw, 3), len(given.points)) / around
    triangles = given.triangles
    if given.rings:
        columns, triangles = _closed(columns, triangles, given.rings)
    corners = dict(zip("abc", triangles.T, strict=True))
    return Field("surface", columns), Field("triangles", {**corners, **cells})


def _closed(
    columns: dict[str, np.ndarray], triangles: np.ndarray, rings: tuple[int, int]
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Repeat the first meridian at the end of every row, and connect the last column's triangles to it."""
    around = rings[1]
    out = {}
    for name, values in columns.items():
        rows = values.reshape(-1, around)
        last = np.full((len(rows), 1), 2 * np.pi) if name == "Theta" else rows[:, :1]
        out[name] = np.hstack([rows, last]).ravel()
    row, column = np.divmod(triangles, around)
    wraps = (column == 0) & (column.max(axis=1) == around - 1)[:, None]
    return out, row * (around + 1) + np.where(wraps, around, column)
