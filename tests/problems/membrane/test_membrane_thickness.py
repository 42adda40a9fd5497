"""Problem ``membrane`` with a thickness that varies from place to place."""

from dataclasses import replace

import meshio
import numpy as np
import pytest
from mpi4py import MPI

from weakforms import InputError, solve
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.membrane.model import Body, MembraneModel
from weakforms.problems.membrane.reference import Reference
from weakforms.problems.membrane.shapes import disk
from weakforms.problems.meridian.thickness import Thickness

COARSE = {"cells": 8, "levels": 2}
DELTA = 1.1


def lifted(height):
    """A curved surface over the disk."""
    given = disk(4, 2)
    points = given.points.copy()
    points[:, 2] = height(*points[:, :2].T)
    return Reference(points, given.cells, given.held, {})


def test_a_disk_of_radial_thickness_is_that_of_circular():
    """By the axisymmetric problem, with lengths over the stress-free radius."""
    given = {"alpha": 0.1, "delta": DELTA, "w_end": 0.6, "at": {"w_c": 0.55}, "numerics": COARSE}
    (own,) = solve("membrane", thickness="1 + 0.4*(X**2 + Y**2)", **given).states
    (line,) = solve("circular", beta=DELTA, thickness="1 + 0.4*X**2", t_end=0.6, at={"t0": 0.5}).states
    for name, factor in (("p", 1 / DELTA), ("V", 2 * np.pi * DELTA**3)):
        value = factor * line.quantities[name].value
        assert own.quantities[name].value == pytest.approx(value, rel=5e-5), name


@pytest.mark.slow
def test_twice_the_thickness_bears_twice_the_load():
    given = {"alpha": 0.1, "w_end": 0.31, "at": {"w_c": 0.3}, "numerics": {"cells": 4, "levels": 2}}
    (once,), (twice,) = (solve("membrane", thickness=text, **given).states for text in (None, "2"))
    for name, factor in (("p", 2), ("U", 2), ("V", 1), ("S_least", 1)):
        value = factor * once.quantities[name].value
        assert twice.quantities[name].value == pytest.approx(value, rel=1e-10), name


def test_each_coordinate_of_the_thickness_has_its_own_place():
    """The energy of a uniform stretch, int H dA, on a flat sheet whose centre is off the axes."""
    given = lifted(lambda x, y: 0.5 + 0 * x)
    moved = replace(given, points=given.points + np.array([0.3, -0.2, 0.0]))
    thickness = Thickness("2 + X + 3*Y + Z", "X", ("Y", "Z"))
    body = Body(moved, mooney_rivlin_of(0.1), DELTA, thickness=thickness)
    of = MembraneModel(MPI.COMM_SELF, body)
    trace, area = 2 * DELTA**2, DELTA**4
    energy = trace + 1 / area - 3 + 0.1 * (area + trace / area - 3)
    with of.system.at(of.system.initial):
        found = of.system.monitor("U")
    assert found == pytest.approx(energy * of.area * (2 + 0.3 - 0.6 + 0.5), rel=1e-12)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"thickness": "1 - X"}, "is 0 at X = 1, Y = 0; allowed: from 0.01 to 100 everywhere"),
        ({"thickness": "Y + 0.5", "mesh": "square"}, "is -0.5 at X = -1, Y = -1; allowed"),
        ({"thickness": "1 + r"}, "unknown name 'r' at character 5; allowed: numbers, X, Y, Z, pi"),
        ({"thickness": "1/(X - Y)", "mesh": "airbag", "delta": 1}, "is not finite at X = 0, Y = 0"),
        ({"thickness": "__import__('os')"}, "unknown function '__import__'"),
        ({"thickness": 0}, "is 0 at X = "),
        ({"thickness": True}, "must be a text such as"),
    ],
)
def test_a_thickness_that_is_none_is_refused_in_one_line(given, told):
    with pytest.raises(InputError) as refused:
        solve("membrane", **given)
    assert told in str(refused.value)
    assert "thickness" in str(refused.value)
    assert "\n" not in str(refused.value)


def test_the_place_on_a_curved_surface_of_a_file_is_named_in_units_of_its_length(tmp_path):
    of = lifted(lambda x, y: 0.5 * (1 - x**2 - y**2))
    mesh = meshio.Mesh(20 * of.points, [("triangle6", of.cells[:, [0, 1, 2, 5, 3, 4]])])
    mesh.write(tmp_path / "cap.vtu")
    with pytest.raises(InputError, match=r"is 0 at X = 0, Y = 0, Z = 0\.5; allowed"):
        solve("membrane", mesh=str(tmp_path / "cap.vtu"), unit=20, thickness="1 - 2*Z", delta=1)
