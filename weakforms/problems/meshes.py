"""Meshes of the reference bodies."""

from __future__ import annotations

import numpy as np
from dolfinx import mesh as dmesh
from mpi4py import MPI


def graded_interval(
    comm: MPI.Intracomm, cells: int, length: float, grading: float, mirrored: bool = False
) -> dmesh.Mesh:
    r"""Mesh of ``[0, length]``, finer towards the end, or of ``[-length, length]``, finer towards both ends.

    Nodes lie at :math:`Z = L\,[\xi + a\,\xi(1-\xi)]` for equidistant :math:`\xi`: a smooth map, so that
    doubling the number of cells refines every cell and orders of convergence can be observed.

    Args:
        comm: Ranks that share the mesh.
        cells: Number of cells on ``[0, length]``.
        length: Length of the interval.
        grading: ``a`` in [0, 1): the first cell is (1+a)/(1-a) times as long as the last.
        mirrored: Mesh both halves.
    """
    if mirrored:
        mesh = dmesh.create_interval(comm, 2 * cells, [-1.0, 1.0])
    else:
        mesh = dmesh.create_interval(comm, cells, [0.0, 1.0])
    x = mesh.geometry.x
    xi = np.abs(x[:, 0])
    x[:, 0] = length * np.sign(x[:, 0]) * (xi + grading * xi * (1 - xi))
    return mesh


def tag_points(mesh: dmesh.Mesh, places: dict[int, float]) -> dmesh.MeshTags:
    """Tag the vertices at given coordinates of an interval mesh.

    Args:
        mesh: An interval mesh.
        places: Coordinate of each tag.
    """
    found = {
        tag: dmesh.locate_entities(mesh, 0, lambda x, z=z: np.isclose(x[0], z, atol=1e-12))
        for tag, z in places.items()
    }
    vertices = np.concatenate(list(found.values())).astype(np.int32)
    tags = np.concatenate([np.full(len(v), tag) for tag, v in found.items()]).astype(np.int32)
    mesh.topology.create_connectivity(0, mesh.topology.dim)  # needed to locate the conditions
    order = np.argsort(vertices)
    return dmesh.meshtags(mesh, 0, vertices[order], tags[order])
