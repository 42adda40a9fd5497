"""A state on triangles as tables: corners and triangles of the whole sheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import Mesh
from ufl.core.expr import Expr

from weakforms.forms.materials import SurfaceLaw
from weakforms.forms.relaxed_surface import state as state_of
from weakforms.problems.triangles.weak_form import Membrane
from weakforms.results import Field

VERTICES = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
CENTROID = np.array([[1 / 3, 1 / 3]])
NO_COMPONENT = 1e-6
"""A direction is turned so that its first component is positive; smaller components may be round-off."""


class Shape:
    """Tables of the deformed sheet, the same on any number of ranks.

    Args:
        mesh: The reference surface, in the plane or in space.
        membrane: The membrane at the unknown position.
        mirrors: Signs of ``X`` and ``Y`` of each copy of the mesh that makes the whole sheet.
        law: See :func:`weakforms.forms.relaxed_surface.state`.
        more: Further numbers of triangles.
    """

    def __init__(
        self,
        mesh: Mesh,
        membrane: Membrane,
        mirrors: Sequence[tuple[int, int]] = ((1, 1),),
        law: SurfaceLaw | None = None,
        more: Mapping[str, Expr] | None = None,
    ) -> None:
        self._more = dict(more or {})
        self._mesh, self._mirrors, self._dim = mesh, mirrors, mesh.geometry.dim
        place, reference = ufl.SpatialCoordinate(mesh), ufl.Jacobian(mesh)
        deformed = ufl.dot(ufl.grad(membrane.position), reference)
        tangents = [
            t[i, j]
            for t, rows in ((reference, self._dim), (deformed, 3))
            for i in range(rows)
            for j in (0, 1)
        ]
        corner = [*place, *membrane.position]
        middle = [*place, *tangents, state_of(membrane.cauchy_green, law), *self._more.values()]
        self._corners = fem.Expression(ufl.as_vector(corner), VERTICES)
        self._middle = fem.Expression(ufl.as_vector(middle), CENTROID)
        self._cells = np.arange(mesh.topology.index_map(2).size_local, dtype=np.int32)

    def __call__(self) -> tuple[Field, Field]:
        """Corners and triangles at the state that the system is lent to.

        Corners: reference ``X, Y`` (in space also ``Z``) and position ``x, y, z``. Triangles: the rows
        ``a, b, c`` of their corners in that table, counterclockwise seen from the side that the normal points
        to; at their centroids the principal stretches, the state (1 taut, 0 wrinkled, -1 slack) and the
        deformed direction ``t_x, t_y, t_z`` of the larger stretch.
        """
        d, mirrors = self._dim, self._mirrors
        corners, middle = self._gathered()
        third = [1] * (d - 2)
        corners = np.concatenate([corners * (sx, sy, *third, sx, sy, 1) for sx, sy in mirrors])
        turned = np.concatenate([np.full(len(middle), sx * sy < 0) for sx, sy in mirrors])
        corners[turned] = corners[turned][:, ::-1]
        nodes = corners.reshape(-1, d + 3)
        _, first, which = np.unique(
            nodes[:, :d].round(9) + 0.0, axis=0, return_index=True, return_inverse=True
        )
        columns = dict(zip((*"XYZ"[:d], *"xyz"), nodes[first].T, strict=True))
        abc = dict(zip("abc", which.reshape(-1, 3).T, strict=True))
        reference = middle[:, d : 3 * d].reshape(-1, d, 2)
        deformed = middle[:, 3 * d : 3 * d + 6].reshape(-1, 3, 2)
        mode, *more = middle[:, 3 * d + 6 :].T
        own = dict(zip(self._more, more, strict=True))
        values = [stretched(reference, deformed, mode, mirror) | own for mirror in mirrors]
        cells = {name: np.concatenate([part[name] for part in values]) for name in values[0]}
        return Field("sheet", columns), Field("triangles", {**abc, **cells})

    def _gathered(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners ``(n, 3, d + 3)`` and centroids of all ranks' triangles, sorted by place."""
        mesh, d = self._mesh, self._dim
        corners = self._corners.eval(mesh, self._cells).reshape(-1, 3, d + 3)
        if d == 2:
            a, b, c = corners[:, 0, :2], corners[:, 1, :2], corners[:, 2, :2]
            below = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
            corners[below] = corners[below][:, ::-1]
        middle = self._middle.eval(mesh, self._cells).reshape(-1, 3 * d + 7 + len(self._more))
        corners, middle = (np.concatenate(mesh.comm.allgather(part)) for part in (corners, middle))
        order = np.lexsort(middle[:, :d].round(9).T)
        return corners[order], middle[order]


def stretched(
    reference: np.ndarray, deformed: np.ndarray, mode: np.ndarray, mirror: tuple[int, int]
) -> dict[str, np.ndarray]:
    """Principal stretches, state and direction of the larger stretch from tangents.

    Args:
        reference: Tangents of the reference surface along any two coordinates, ``(n, d, 2)``.
        deformed: Those of the deformed one along the same coordinates, ``(n, 3, 2)``.
        mode: State of each triangle.
        mirror: Signs of ``x`` and ``y``.
    """
    metric = np.einsum("nki,nkj->nij", reference, reference)
    frame = np.linalg.inv(np.linalg.cholesky(metric)).transpose(0, 2, 1)
    f = deformed @ frame
    squares, vectors = np.linalg.eigh(np.einsum("nki,nkj->nij", f, f))
    along = np.einsum("nki,ni->nk", f, vectors[:, :, 1]) / np.sqrt(squares[:, 1])[:, None]
    leading = np.take_along_axis(along, (np.abs(along) > NO_COMPONENT).argmax(axis=1)[:, None], axis=1)
    along *= np.sign(leading) * np.array([*mirror, 1])
    out = {"lam1": np.sqrt(squares[:, 1]), "lam2": np.sqrt(squares[:, 0]), "state": mode}
    return out | dict(zip(("t_x", "t_y", "t_z"), along.T, strict=True))
