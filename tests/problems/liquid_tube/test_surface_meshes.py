"""Meshes of the fluid-loaded tube as a surface."""

import numpy as np
import pytest
from dolfinx import mesh as dmesh
from mpi4py import MPI

from weakforms.problems.liquid_tube.bent.mesh import fitted_heights, flat_sheet, heights, polygon, prism

pytestmark = pytest.mark.paper3
ONE = MPI.COMM_SELF


def test_sheet_is_uniform_around_and_refined_from_the_top_down():
    nodes = heights(16, 4.0)
    sheet = flat_sheet(ONE, nodes, 6)
    x = np.round(sheet.geometry.x, 12)
    assert np.unique(x[:, 0]) == pytest.approx(nodes)
    assert np.diff(np.unique(x[:, 1])) == pytest.approx(np.pi / 6)
    assert sheet.topology.index_map(2).size_global == 96
    assert {1.0, 2.0} <= set(nodes.tolist()), "a quarter and half of the length are nodes"
    assert np.diff(nodes)[-1] > 1.5 * np.diff(nodes)[0]
    assert np.diff(nodes)[-1] < np.diff(nodes)[12], "finer again towards the upper ring"
    assert heights(32, 4.0)[::2] == pytest.approx(nodes)
    with pytest.raises(ValueError, match="multiple of 4"):
        heights(6, 1.0)


@pytest.mark.parametrize(
    "sides", [np.full(8, np.pi / 4), np.array([0.5, 0.9, 1.1, 0.8, 1.3, 2 * np.pi - 4.6])]
)
def test_polygon_closes_with_the_sides_asked_for(sides):
    corners = polygon(sides)
    closed = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    assert closed == pytest.approx(sides, rel=1e-12)


def test_prism_is_closed():
    mesh = prism(ONE, heights(4, 2.0), np.arange(6) * np.pi / 3)
    mesh.topology.create_connectivity(1, 2)
    assert len(dmesh.exterior_facet_indices(mesh.topology)) == 12, "only the two rings are edges"


@pytest.mark.parametrize(
    ("front", "rows"),
    [(3.5, (2.0, 3.5, 4.0)), (4.0, (2.0, 3.8, 4.0)), (1.3, (1.0, 1.3, 2.0)), (2.1, (1, 1.8, 2))],
)
def test_fitted_sheet_has_a_row_for_the_free_surface(front, rows):
    nodes, found = fitted_heights(12, 4.0, front)
    assert found == pytest.approx(rows)
    for row in (*rows, 1.0, 2.0):
        assert min(abs(nodes - row)) < 1e-12
    assert fitted_heights(24, 4.0, front)[0][::2] == pytest.approx(nodes)
    with pytest.raises(ValueError, match="multiple of 6"):
        fitted_heights(8, 4.0, front)


@pytest.mark.parametrize("front", [0.5, 0.9, 1.3, 2.1, 3.5])
def test_a_third_of_the_cells_lies_below_the_free_surface(front):
    """Where the membrane bulges; with fewer cells the coarsest mesh of a long tube misses its bifurcation."""
    nodes, (_, row, _) = fitted_heights(12, 4.0, front)
    assert np.sum(nodes < row - 1e-12) >= 12 / 3
