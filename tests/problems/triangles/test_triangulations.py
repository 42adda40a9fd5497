"""Meshes of triangles of the tube and the hemisphere."""

import numpy as np
import pytest

from weakforms import solve
from weakforms.problems.triangles.meshes import hemisphere, hemisphere_in_columns, tube

pytestmark = pytest.mark.paper5


@pytest.mark.parametrize("mirrored", [False, True])
def test_tube_of_triangles(mirrored):
    given = tube(8.0, 5, 7, mirrored)
    assert given.points.shape == (42, 3)
    assert given.triangles.shape == (70, 3)
    assert given.radius == pytest.approx(1.0)
    assert given.held.sum() == 14
    assert outward(given).min() > 0


def test_hemisphere_of_triangles():
    given = hemisphere(0.3)
    assert np.linalg.norm(given.points, axis=1) == pytest.approx(1.0)
    assert given.radius.min() < 1e-12
    assert given.points[given.held][:, 2] == pytest.approx(0.0, abs=1e-12)
    assert outward(given).min() > 0


def test_hemisphere_in_columns():
    """Every row is a ring, and a rotation by one column maps the mesh onto itself."""
    given = hemisphere_in_columns(5, 12)
    assert given.triangles.shape == (12 + 2 * 4 * 12, 3)
    assert np.linalg.norm(given.points, axis=1) == pytest.approx(1.0)
    assert given.radius[0] == 0
    assert given.points[given.held][:, 2] == pytest.approx(0.0, abs=1e-12)
    assert given.held.sum() == 12
    assert outward(given).min() > 0
    column = np.concatenate([[0], *(1 + 12 * i + (np.arange(12) + 1) % 12 for i in range(5))])
    turned = {tuple(sorted(column[t])) for t in given.triangles}
    assert turned == {tuple(sorted(t)) for t in given.triangles}
    assert len(turned) == len(given.triangles)
    angle = np.angle(np.exp(1j * (given.angle[column[1:]] - given.angle[1:])))
    assert angle == pytest.approx(2 * np.pi / 12)


def test_a_hemisphere_in_columns_has_the_state_of_an_unstructured_one():
    given = {"geometry": "hemisphere", "load_start": -0.6, "load_end": -0.65}
    quick = {"scan": 1, "shown": 1, "eigenvalues": 1}
    columns = solve("surface", **given, layout="columns", meridional=16, circumferential=48, numerics=quick)
    free = solve("surface", **given, size=0.1, numerics=quick)
    for name, apart in (("V", 5e-3), ("Lambda_1", 2e-2)):
        one, other = (result.branch()[name] for result in (columns, free))
        assert one == pytest.approx(other, rel=apart), name
    assert columns.quantities["triangles"].value == 48 + 2 * 15 * 48


def outward(given):
    """Normal of each triangle times the vector from the axis' middle, divided by its length."""
    corners = given.points[given.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    away = corners.mean(axis=1) * [1, 1, 0 if given.rings else 1]
    return np.einsum("ij,ij->i", normal, away) / np.linalg.norm(normal, axis=1)
