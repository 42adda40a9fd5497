"""The mesh of a meridian: unit blocks between break points, which may be unknowns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from dolfinx import mesh as dmesh
from mpi4py import MPI

LOWER, UPPER, BREAK = 1, 2, 3
"""Tags of the first end, of the last one, and of the first vertex between blocks; the others follow."""


@dataclass(frozen=True)
class Blocks:
    """Blocks of ``cells`` cells each, with elements of one degree."""

    breaks: Sequence[float]
    """First positions of the ends and of the break points between them."""
    cells: int
    """Cells of each block."""
    degree: int
    quadrature: int
    """Degree of the quadrature."""
    fronts: Mapping[str, int] = field(default_factory=dict)
    """Names of the loads that are break points, and their indices."""
    grading: Sequence[Callable[[np.ndarray], np.ndarray]] = ()
    """For each block a smooth map of [0, 1] to itself that moves the nodes. Doubling the number of cells then
    refines every cell, and orders of convergence can be observed."""

    @property
    def count(self) -> int:
        """Number of blocks."""
        return len(self.breaks) - 1

    def mesh(self, comm: MPI.Intracomm) -> dmesh.Mesh:
        """The mesh of ``[0, count]``."""
        mesh = dmesh.create_interval(comm, self.count * self.cells, [0.0, float(self.count)])
        x = mesh.geometry.x
        nodes = x[:, 0].copy()
        for k, moved in enumerate(self.grading):
            inside = (nodes >= k - 1e-12) & (nodes <= k + 1 + 1e-12)
            x[inside, 0] = k + moved(nodes[inside] - k)
        return mesh


def one_end(grading: float) -> Callable[[np.ndarray], np.ndarray]:
    """Cells finer towards 1; the first is ``(1 + a)/(1 - a)`` times as long as the last, ``0 <= a < 1``."""
    return lambda t: t + grading * t * (1 - t)


def both_ends(grading: float) -> Callable[[np.ndarray], np.ndarray]:
    """Cells finer towards 0 and 1, ``0 <= a < 1``."""
    return lambda t: t - grading * np.sin(2 * np.pi * t) / (2 * np.pi)


def mirrored(grading: Callable[[np.ndarray], np.ndarray]) -> Callable[[np.ndarray], np.ndarray]:
    """The grading of the mirror image of a block."""
    return lambda t: 1 - grading(1 - t)


def tags_of(mesh: dmesh.Mesh, blocks: int) -> dmesh.MeshTags:
    """Tags of the ends and of the vertices between blocks."""
    mesh.topology.create_connectivity(0, mesh.topology.dim)  # needed to locate the conditions
    found = {
        LOWER: dmesh.locate_entities(mesh, 0, lambda x: np.abs(x[0]) < 1e-9),
        UPPER: dmesh.locate_entities(mesh, 0, lambda x: np.abs(x[0] - blocks) < 1e-9),
    }
    for k in range(1, blocks):
        found[BREAK + k - 1] = dmesh.locate_entities(mesh, 0, lambda x, k=k: np.abs(x[0] - k) < 1e-9)
    vertices = np.concatenate(list(found.values())).astype(np.int32)
    tags = np.concatenate([np.full(len(v), tag) for tag, v in found.items()]).astype(np.int32)
    order = np.argsort(vertices)
    return dmesh.meshtags(mesh, 0, vertices[order], tags[order])
