"""Lengths of tangent vectors at points of a mirror plane, one order more accurate than in elements."""

from __future__ import annotations

from collections.abc import Mapping

import basix
import numpy as np
from dolfinx import fem
from scipy.spatial import cKDTree

from weakforms.problems.liquid_tube.bent.front import FrontMap


class EdgeTangents:
    r"""``|x_,Z|`` and ``|x_,Theta|`` at points where a row of edges meets a plane of symmetry.

    Derivatives of one element are least accurate at its corners. Its values at the Gauss-Lobatto points have
    the higher order ``O(h^{p+2})``. The derivative of one polynomial through the values of the cells on both
    sides has an error of ``O(h^{p+1})``. Along the meridian these are the cells below and above; around the
    axis they are the cell at the mirror plane and its image, in which ``y`` is odd. By symmetry the
    derivatives of ``x`` and ``z`` with respect to ``Theta`` are zero there.

    Args:
        space: Space of the position on a sheet over ``(X, Theta)``, with nodes at the Gauss-Lobatto points.
        nodes: Rows of the sheet.
        around: Cells around.
        points: Side and height ``(Theta, X)`` of each point, on a row that is not an end.
        front: The front that the rows follow; ``None`` if ``Z = X``.
    """

    def __init__(
        self,
        space: fem.FunctionSpace,
        nodes: np.ndarray,
        around: int,
        points: Mapping[str, tuple[float, float]],
        front: FrontMap | None,
    ) -> None:
        self._front, self._comm = front, space.mesh.comm
        degree = space.ufl_element().degree
        self._t = lobatto(degree)
        self._points, self._width = dict(points), np.pi / around
        owned = space.dofmap.index_map.size_local
        tree = cKDTree(space.tabulate_dof_coordinates()[:owned, :2])
        self._lines: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        for name, (side, height) in self._points.items():
            k = int(np.argmin(np.abs(nodes - height)))
            along = np.concatenate(
                [low + (high - low) * self._t for low, high in (nodes[k - 1 : k + 1], nodes[k : k + 2])]
            )
            along = np.delete(along, degree)  # the row itself, once
            turned = np.abs(side - self._width * self._t)
            meridian = np.column_stack([along, np.full_like(along, side)])
            parallel = np.column_stack([np.full_like(turned, nodes[k]), turned])
            self._lines[name] = along, *(self._find(tree, line) for line in (meridian, parallel))

    @staticmethod
    def _find(tree: cKDTree, places: np.ndarray) -> np.ndarray:
        """Numbers of this rank's nodes at given positions, -1 for nodes of other ranks."""
        distance, index = tree.query(places) if tree.n else (np.full(len(places), np.inf), None)
        return np.where(distance < 1e-9, index, -1) if tree.n else np.full(len(places), -1)

    def __call__(self, position: fem.Function) -> dict[str, tuple[float, float]]:
        """Both lengths at each point."""
        out, degree = {}, len(self._t) - 1
        for name, (side, _) in self._points.items():
            along, meridian, parallel = self._lines[name]
            x, _, z = self._values(position, meridian).T
            _, y, _ = self._values(position, parallel).T
            heights = along
            if self._front is not None:
                heights = self._front.material(along, np.full_like(along, side))
            row = derivative_weights(heights, degree)
            angles = self._width * np.concatenate([-self._t[:0:-1], self._t])
            across = derivative_weights(angles, degree) @ np.concatenate([-y[:0:-1], y])
            out[name] = float(np.hypot(row @ x, row @ z)), float(abs(across))
        return out

    def _values(self, position: fem.Function, index: np.ndarray) -> np.ndarray:
        """Nodal values, shape ``(nodes, 3)``, on every rank."""
        values = position.x.array.reshape(-1, 3)
        local, here = np.zeros((len(index), 4)), index >= 0
        local[here, :3], local[here, 3] = values[index[here]], 1.0
        total = self._comm.allreduce(local) if self._comm.size > 1 else local
        return total[:, :3] / total[:, 3:]


def lobatto(degree: int) -> np.ndarray:
    """Nodes of an element along an edge, on ``[0, 1]``."""
    variant = basix.LagrangeVariant.gll_warped
    kind = basix.create_element(basix.ElementFamily.P, basix.CellType.interval, degree, variant)
    return np.sort(kind.points[:, 0])


def derivative_weights(x: np.ndarray, k: int) -> np.ndarray:
    """Weights of values at ``x`` that give the derivative of the polynomial through them at ``x[k]``."""
    apart = x[:, None] - x[None, :]
    np.fill_diagonal(apart, 1.0)
    scale = np.prod(apart / np.ptp(x), axis=1)  # its inverse is the barycentric weight
    out = np.zeros(len(x))
    others = np.arange(len(x)) != k
    out[others] = scale[k] / scale[others] / (x[k] - x[others])
    out[k] = -out.sum()
    return out
