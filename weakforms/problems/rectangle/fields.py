"""A state of a rectangular membrane as tables: corners and triangles of the whole sheet."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem

from weakforms.forms.relaxed_surface import state as state_of
from weakforms.problems.rectangle.model import RectangleModel
from weakforms.results import Field

VERTICES = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
CENTROID = np.array([[1 / 3, 1 / 3]])
MIRRORS = ((1, 1), (-1, 1), (1, -1), (-1, -1))


class Shape:
    """Tables of the deformed sheet, the same on any number of ranks."""

    def __init__(self, model: RectangleModel) -> None:
        self._model = model
        at, place = model.membrane, ufl.SpatialCoordinate(model.mesh)
        tangents = ufl.grad(at.position)
        corner = [*place, *at.position]
        middle = [*place, *(tangents[i, j] for i in range(3) for j in range(2)), state_of(at.cauchy_green)]
        self._corners = fem.Expression(ufl.as_vector(corner), VERTICES)
        self._middle = fem.Expression(ufl.as_vector(middle), CENTROID)
        self._cells = np.arange(model.mesh.topology.index_map(2).size_local, dtype=np.int32)

    def __call__(self) -> tuple[Field, Field]:
        """Corners and triangles at the state that the system is lent to.

        Corners: reference ``X, Y`` and position ``x, y, z``. Triangles: the rows ``a, b, c`` of their corners
        in that table, counterclockwise seen from above; at their centroids the principal stretches, the state
        (1 taut, 0 wrinkled, -1 slack) and the deformed direction ``t_x, t_y, t_z`` of the larger stretch.
        """
        corners, middle = self._gathered()
        mirrors = ((1, 1),) if self._model.sheet.whole else MIRRORS
        corners = np.concatenate([corners * (sx, sy, sx, sy, 1) for sx, sy in mirrors])
        turned = np.concatenate([np.full(len(middle), sx * sy < 0) for sx, sy in mirrors])
        corners[turned] = corners[turned][:, ::-1]
        nodes = corners.reshape(-1, 5)
        _, first, which = np.unique(
            nodes[:, :2].round(9) + 0.0, axis=0, return_index=True, return_inverse=True
        )
        columns = dict(zip(("X", "Y", "x", "y", "z"), nodes[first].T, strict=True))
        abc = dict(zip("abc", which.reshape(-1, 3).T, strict=True))
        values = [_stretched(middle[:, 2:8].reshape(-1, 3, 2), middle[:, 8], mirror) for mirror in mirrors]
        cells = {name: np.concatenate([part[name] for part in values]) for name in values[0]}
        return Field("sheet", columns), Field("triangles", {**abc, **cells})

    def _gathered(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners ``(n, 3, 5)`` and centroids ``(n, 9)`` of all ranks' triangles, sorted by place."""
        mesh = self._model.mesh
        corners = self._corners.eval(mesh, self._cells).reshape(-1, 3, 5)
        a, b, c = corners[:, 0, :2], corners[:, 1, :2], corners[:, 2, :2]
        below = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
        corners[below] = corners[below][:, ::-1]
        middle = self._middle.eval(mesh, self._cells).reshape(-1, 9)
        corners, middle = (np.concatenate(mesh.comm.allgather(part)) for part in (corners, middle))
        order = np.lexsort(middle[:, :2].round(9).T)
        return corners[order], middle[order]


def _stretched(f: np.ndarray, mode: np.ndarray, mirror: tuple[int, int]) -> dict[str, np.ndarray]:
    """Principal stretches, state and direction of the larger stretch from tangents ``(n, 3, 2)``."""
    squares, vectors = np.linalg.eigh(np.einsum("nki,nkj->nij", f, f))
    along = np.einsum("nki,ni->nk", f, vectors[:, :, 1]) / np.sqrt(squares[:, 1])[:, None]
    along *= np.sign(along[:, :1] + (along[:, :1] == 0)) * np.array([*mirror, 1])
    out = {"lam1": np.sqrt(squares[:, 1]), "lam2": np.sqrt(squares[:, 0]), "state": mode}
    return out | dict(zip(("t_x", "t_y", "t_z"), along.T, strict=True))
