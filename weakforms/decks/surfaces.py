"""The mid-surface as a mesh file, for gmsh and NGSolve."""

from __future__ import annotations

import numpy as np

from weakforms.decks.bodies import Body
from weakforms.decks.meshes import Surface

MEMBRANE = "membrane"


def edges_of(body: Body, surface: Surface) -> dict[str, np.ndarray]:
    """Edges of the quarter by name, each of three nodes: corners, middle."""
    quads = surface.quads
    edges = np.concatenate([quads[:, [k, (k + 1) % 4, 4 + k]] for k in range(4)])
    names = {f"clamp{clamp.end}": np.isclose(surface.s, clamp.end, atol=1e-9) for clamp in body.clamps}
    if body.mirror:
        names["z0"] = surface.on(z=0.0)
    names |= {"x0": surface.on(x=0.0), "y0": surface.on(y=0.0)}
    return {name: edges[held[edges].all(axis=1)] for name, held in names.items()}


def msh(body: Body, surface: Surface) -> str:
    """The mid-surface as triangles of six nodes, with physical groups, in gmsh's format 2.2."""
    edges = edges_of(body, surface)
    triangles = surface.triangles()
    groups = [(1, k, name) for k, name in enumerate(edges, 1)] + [(2, len(edges) + 1, MEMBRANE)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {number} "{name}"' for dimension, number, name in groups]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(surface.points))]
    lines += [f"{n} {x:.16g} {y:.16g} {z:.16g}" for n, (x, y, z) in enumerate(surface.points, 1)]
    cells = [(8, k, line) for k, found in enumerate(edges.values(), 1) for line in found]
    cells += [(9, len(edges) + 1, triangle) for triangle in triangles]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [
        f"{n} {kind} 2 {group} {group} {' '.join(map(str, nodes + 1))}"
        for n, (kind, group, nodes) in enumerate(cells, 1)
    ]
    data = ["$NodeData", "1", '"thickness"', "1", "0", "3", "0", "1", str(len(surface.points))]
    data += [f"{n} {value:.16g}" for n, value in enumerate(surface.thickness, 1)]
    return "\n".join([*lines, "$EndElements", *data, "$EndNodeData", ""])
