"""The membrane of any shape: the same branches, states and fields serially and on two ranks."""

import meshio
import numpy as np
import pytest

pytestmark = pytest.mark.mpi


def test_membrane(same_on_ranks):
    coarse = {"cells": 4, "levels": 2}
    disk = {"problem": "membrane", "alpha": 0.0, "w_end": 1.4, "numerics": coarse, "at": [("w_max", 0.5)]}
    slack = {"problem": "membrane", "mesh": "square", "delta": 1.0, "w_end": 0.4, "numerics": coarse}
    bag = {
        "problem": "membrane",
        "mesh": "airbag",
        "delta": 1,
        "model": "saint_venant_kirchhoff",
        "w_end": 0.56,
    }
    # At a pressure of this size the pleats of the seam, of which round-off may choose others, are few.
    bag |= {"shear": 0.357, "poisson": 0.4, "at": [("p", 0.06)]}
    bag["numerics"] = {**coarse, "degree": 1, "p_start": 0.05}
    pond = {"problem": "membrane", "load": "liquid", "gamma": 5.0, "w_end": 1.2, "at": [("zw", 0.03)]}
    pond |= {"thickness": "1 + 0.2*X"}
    pond |= {"numerics": coarse}
    tilted = pond | {"tilt": 20.0}
    bows = {"problem": "membrane", "mesh": "tube", "lf": 6, "delta": 1, "thickness": "1 + 0.05*X"}
    bows |= {"alpha": 0.0, "w_end": 0.5, "numerics": coarse}
    found = same_on_ranks([disk, slack, bag, pond, tilted, bows])
    assert [len(result.special_points) for result in found] == [1, 0, 0, 2, 1, 0]


@pytest.mark.slow
def test_adapted_meshes(same_on_ranks):
    """The triangles that are cut are the same on any number of ranks, by symmetry and by value."""
    coarse = {"cells": 4, "levels": 2, "degree": 1}
    slack = {"problem": "membrane", "mesh": "square", "delta": 1.0, "w_end": 0.31}
    slack |= {"numerics": coarse | {"refine": 2}, "at": [("w_c", 0.3)]}
    disk = {"problem": "membrane", "w_end": 0.31, "numerics": coarse | {"refine": 1}}
    square, _ = (result.numerics["triangles"] for result in same_on_ranks([slack, disk]))
    assert square[1] == 4 * square[0] > 4 * 64


@pytest.mark.slow
def test_moved_supports(same_on_ranks, tmp_path):
    """A ring of a file whose inner edge is turned and raised."""
    sides, rows = 12, 4
    angle, radius = np.meshgrid(2 * np.pi * np.arange(sides) / sides, np.linspace(0.4, 1.0, rows))
    points = np.column_stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()])
    a = np.arange((rows - 1) * sides)
    b = a // sides * sides + (a + 1) % sides
    cells = np.vstack([np.column_stack([a, b + sides, b]), np.column_stack([a, a + sides, b + sides])])
    hole, last = np.column_stack([a, b])[:sides], (rows - 1) * sides
    blocks = [("triangle", cells[:, [0, 2, 1]]), ("line", hole), ("line", hole + last)]
    tags = [np.full(len(block), k + 1) for k, (_, block) in enumerate(blocks)]
    mesh = meshio.Mesh(np.column_stack([points, 0 * points[:, 0]]), blocks)
    mesh.cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    mesh.field_data = {"hole": np.array([2, 1]), "rim": np.array([3, 1])}
    mesh.write(tmp_path / "ring.msh", file_format="gmsh22")
    ring = {"problem": "membrane", "mesh": str(tmp_path / "ring.msh"), "moved": "hole", "turn": 10.0}
    ring |= {"shift_z": 0.2, "load": "liquid", "w_end": 0.31, "numerics": {"levels": 2, "p_start": 0.1}}
    (found,) = same_on_ranks([ring])
    assert found.failures == []
