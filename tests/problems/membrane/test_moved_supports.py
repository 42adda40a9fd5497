"""Problem ``membrane`` with held edges that are moved as a rigid body before the load."""

import numpy as np
import pytest
import shapes_of_gmsh as shapes
from dolfinx import fem
from mpi4py import MPI
from scipy.spatial.transform import Rotation

from weakforms import InputError, solve
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.membrane.files import from_file
from weakforms.problems.membrane.model import Body, MembraneModel, Motion
from weakforms.solvers.support import compat

NUMERICS = {"levels": 2, "p_start": 0.1}
GIVEN = {"alpha": 0.1, "delta": 1.1, "w_end": 0.45, "at": {"p": 0.5}, "numerics": NUMERICS}


@pytest.fixture(scope="module")
def ring(tmp_path_factory):
    path = tmp_path_factory.mktemp("ring") / "ring.msh"
    return str(shapes.written(path, shapes.ring, 0.3, order=2))


def numbers(result):
    assert result.failures == []
    (state,) = result.states
    return {name: state.quantities[name].value for name in ("U", "V", "Pi")}


@pytest.mark.parametrize("degree", [1, 2])
def test_edges_that_are_moved_are_where_the_motion_has_them(tmp_path, degree):
    """A hole off the middle, turned about its own middle and shifted, on a surface that is stretched too."""
    path = shapes.written(tmp_path / "hole.msh", lambda: shapes.round_sheet(True), 0.4, order=2)
    given = from_file(str(path), 1.0, [], [], [], ["hole"])
    assert given.pivot == pytest.approx([0.3, 0.1, 0.0], abs=1e-3)
    shift, angle, delta = (0.1, -0.2, 0.3), 0.7, 1.2
    motion = Motion(shift, angle, 1)
    of = MembraneModel(MPI.COMM_SELF, Body(given, mooney_rivlin_of(0.1), delta, degree=degree, motion=motion))
    place = fem.Function(of.space)
    with of.system.at(of.system.initial):
        points = compat.interpolation_points(of.space.element)
        place.interpolate(fem.Expression(of.membrane.position, points))
    dofs = of.system.bc_dofs[::3] // 3
    before = of.space.tabulate_dof_coordinates()[np.unique(of.system.bc_dofs // 3)]
    after = place.x.array.reshape(-1, 3)[np.unique(of.system.bc_dofs // 3)]
    assert len(dofs)
    hole = np.linalg.norm(before - given.pivot, axis=1) < 0.4
    turned = Rotation.from_rotvec(angle * np.eye(3)[1]).apply(before - given.pivot)
    rest = given.middle + delta * (before - given.middle)
    moved = given.middle + delta * (given.pivot - given.middle) + delta * turned + shift
    assert after[hole] == pytest.approx(moved[hole], abs=1e-12)
    assert after[~hole] == pytest.approx(rest[~hole], abs=1e-12)


@pytest.mark.slow
def test_a_turned_ring_has_the_energy_of_the_annulus(ring):
    """With little gas, against the problem of a plane: a taut ring, its inner edge turned by ten degrees."""
    given = {"alpha": 0.1, "w_end": 0.31, "numerics": {"levels": 2, "p_start": 1e-3}}
    found = solve("membrane", mesh=ring, moved="hole", turn=10, delta=1.3, **given)
    (plane,) = solve("annulus", a=0.4, s=1.3, alpha=0.1, psi_end=0.2, at={"psi": np.pi / 18}).states
    branch = found.branch()
    assert branch["U"][0] == pytest.approx(plane.quantities["U"].value, rel=1e-4)
    unturned = solve("membrane", mesh=ring, delta=1.3, **given).branch()["U"][0]
    assert branch["U"][0] > 1.02 * unturned
    assert branch["f_w"][0] == 0


@pytest.mark.slow
def test_a_ring_that_rises_is_one_whose_rim_sinks(ring):
    up, down = (
        numbers(solve("membrane", mesh=ring, moved=name, shift_z=shift, **GIVEN))
        for name, shift in (("hole", 0.3), ("rim", -0.3))
    )
    assert up["U"] == pytest.approx(down["U"], rel=1e-9)
    assert up["V"] - down["V"] == pytest.approx(0.3 * 1.1**2 * np.pi * (1 - 0.4**2), rel=1e-3)


@pytest.mark.slow
def test_a_sheet_that_is_turned_as_a_whole_has_the_same_energy(ring):
    (one, other) = (
        numbers(solve("membrane", mesh=ring, **GIVEN | more))
        for more in ({}, {"moved": "rim,hole", "turn": 40, "axis": "X", "shift_y": 0.2, "w_end": 0.9})
    )
    assert other["U"] == pytest.approx(one["U"], rel=1e-8)


def test_a_liquid_stands_on_a_sheet_with_a_sunken_ring(ring):
    given = {"load": "liquid", "gamma": 1.0, "delta": 1.1, "w_end": 0.5, "at": {"zw": 0.3}}
    found = solve("membrane", mesh=ring, moved="hole", shift_z=-0.3, **given, numerics=NUMERICS)
    assert found.failures == []
    branch = found.branch()
    assert branch["zw"][0] == pytest.approx(0.1)
    assert (np.diff(branch["V_f"]) > 0).all()
    assert not branch["n_negative"].any()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"moved": "hole", "held": "rim", "slide": "hole"}, "group 'hole' of moved is not held"),
        ({"moved": "hoel"}, "no group of edges is called 'hoel'"),
        ({"moved": "hole", "turn": 120}, "turn = 120"),
        ({"moved": "hole", "axis": "W"}, "axis = 'W'"),
        ({"moved": "hole", "shift_z": 4}, "shift_z = 4"),
    ],
)
def test_motions_that_are_refused(ring, given, words):
    with pytest.raises(InputError) as refused:
        solve("membrane", mesh=ring, **given)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_part_of_an_edge_is_not_moved(tmp_path):
    def sheet():
        bottom, *rest = shapes.polygon([(0, 0), (1, 0), (1, 1), (0, 1)])
        return {"bottom": [bottom], "rest": rest}

    path = str(shapes.written(tmp_path / "square.msh", sheet, 0.4))
    with pytest.raises(InputError, match="edges of moved meet edges with another support at"):
        solve("membrane", mesh=path, moved="bottom", shift_z=0.1)


def test_a_motion_of_nothing_has_no_effect():
    with pytest.warns(UserWarning, match=r"shift_z = 0\.1 has no effect here; it needs moved"):
        solve("membrane", shift_z=0.1, w_end=0.31, numerics={"cells": 4, "levels": 2})
