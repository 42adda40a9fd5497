"""Edges of a membrane that stay in a plane ``X``, ``Y`` or ``Z = constant``: on mirrors, or sliding."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

import numpy as np

from weakforms.problems.membrane.reference import AXES, OPPOSITE, PLANE, Reference
from weakforms.problems.triangles.checks import at, edges_of

Groups = Mapping[str, np.ndarray]
"""Edges as pairs of corners, by a name."""

RIGID = 1e-6
"""Singular value, relative to the largest, of a rigid motion that supports do not prevent."""


def keys(edges: np.ndarray) -> np.ndarray:
    """One number for each edge, whatever its direction."""
    low, high = np.sort(edges, axis=1).T
    return low * 2**31 + high


@dataclass(frozen=True)
class Surface:
    """The surface of a file, to which groups of edges belong."""

    points: np.ndarray
    corners: np.ndarray
    refuse: Callable[[str], NoReturn]
    """Raises an error about the file."""

    @cached_property
    def _size(self) -> float:
        return float(np.ptp(self.points, axis=0).max())

    @cached_property
    def _normals(self) -> np.ndarray:
        a, b, c = (self.points[self.corners[:, i]] for i in range(3))
        normals = np.cross(b - a, c - a)
        return normals / np.linalg.norm(normals, axis=1)[:, None]

    def mirrors(self, groups: Groups) -> dict[str, np.ndarray]:
        """Groups of edges on planes of symmetry, by the coordinate that is constant on each.

        The surface is on one side of each plane and goes on beyond it. A straight edge has two constant
        coordinates, one of which may be that of the plane in which the surface lies beside it: the other one
        is chosen.

        Raises:
            InputError: If a group is on no such plane.
        """
        out: dict[str, np.ndarray] = {}
        for name, edges in groups.items():
            i = self._plane("mirror", name, edges, np.argmin)
            away = self.points[:, i] - self.points[edges[0, 0], i]
            if away.min() < -PLANE * self._size and away.max() > PLANE * self._size:
                place = at(self.points[np.argmin(np.sign(away.sum()) * away)])
                self.refuse(
                    f"the surface has nodes on both sides of the mirror {AXES[i]} = "
                    f"{self.points[edges[0, 0], i]:.6g} of group {name!r}, such as {place}; allowed: one side"
                )
            if AXES[i] in out:
                self.refuse(
                    f"two groups of mirror have {AXES[i]} = constant; allowed: one, with all its edges"
                )
            out[AXES[i]] = edges
        return out

    def slides(self, groups: Groups) -> dict[str, np.ndarray]:
        """Groups of edges that slide, by the coordinate that is constant in their plane.

        Of the two constant coordinates of a straight edge it is that of the plane in which the surface lies
        beside it: in the other one the edge would be a mirror.

        Raises:
            InputError: If a group is in no such plane, or two are in parallel planes.
        """
        out: dict[str, np.ndarray] = {}
        for name, edges in groups.items():
            i = self._plane("slide", name, edges, np.argmax)
            before = out.get(AXES[i], edges)
            if abs(self.points[edges[0, 0], i] - self.points[before[0, 0], i]) > PLANE * self._size:
                self.refuse(
                    f"group {name!r} of slide lies in another plane {AXES[i]} = constant than another group; "
                    "allowed: one plane of each direction"
                )
            out[AXES[i]] = np.vstack([before, edges]) if before is not edges else edges
        return out

    def _plane(self, kind: str, name: str, edges: np.ndarray, chosen: Callable[[np.ndarray], np.intp]) -> int:
        """The coordinate that is constant on open edges; of two, by the normals of the triangles beside."""
        spread = np.ptp(self.points[np.unique(edges)], axis=0)
        constant = np.flatnonzero(spread < PLANE * self._size)
        if not len(constant):
            self.refuse(f"group {name!r} of {kind} lies in no plane X, Y or Z = constant")
        every, count = edges_of(self.corners)
        inner = edges[~np.isin(keys(edges), keys(every[count == 1]))]
        if len(inner):
            place = at(self.points[inner[0]].mean(axis=0))
            self.refuse(f"group {name!r} of {kind} is inside of the surface {place}; allowed: open edges")
        sides = np.column_stack([keys(self.corners[:, ends]) for ends in OPPOSITE])
        beside = self._normals[np.isin(sides, keys(edges)).any(axis=1)]
        return int(constant[chosen(np.abs(beside[:, constant]).mean(axis=0))])


def rigid_motions(given: Reference) -> int:
    """Number of rigid motions, out of six, that the supports do not prevent."""
    held = {axis: [given.held] for axis in AXES}
    for planes in (given.mirrors, given.slides):
        for axis, edges in planes.items():
            held[axis].append(edges)
    away = (given.points - given.points.mean(axis=0)) / given.size
    rows = []
    for i, parts in enumerate(held.values()):
        nodes = np.unique(np.vstack([edges.reshape(-1, 2) for edges in parts]))
        unit = np.eye(3)[i]
        turns = np.cross(away[nodes], unit)  # e_i . (w x r) = w . (r x e_i)
        rows.append(np.column_stack([np.tile(unit, (len(nodes), 1)), turns]))
    found = np.linalg.svd(np.vstack(rows), compute_uv=False)
    return 6 - int((found > RIGID * found.max(initial=1.0)).sum())
