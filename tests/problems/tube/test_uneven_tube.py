"""Tubes of uneven thickness: both sides mirror one another, coefficients of the two-thirds law, refusals."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import InputError, solve
from weakforms.problems.problem import Requests, Task
from weakforms.problems.tube.parameters import TubeNumerics, TubeParameters
from weakforms.problems.tube.problem import Tube
from weakforms.problems.tube.secondary.imperfect import largest_step

pytestmark = pytest.mark.paper2
COARSE = {"cells": 16, "levels": 2, "step": 0.2}
WHOLE = {"alpha": 0.0, "u_end": 1.8, "extent": "full", "secondary": True}


@pytest.fixture(scope="module")
def both_sides():
    """The same tube from either end."""
    return [solve("tube", uneven=uneven, **WHOLE, numerics=COARSE) for uneven in (1e-3, -1e-3)]


@pytest.mark.slow
def test_the_detached_branch_has_a_largest_pressure_and_a_smallest_volume(both_sides):
    for found in both_sides:
        assert found.failures == []
        kinds = [point.kind for point in found.special_points if point.branch == "secondary"]
        assert kinds[:2] == ["limit_point", "volume_fold"]


def test_a_tube_and_its_mirror_image_have_the_same_states(both_sides):
    one, other = both_sides
    for name in ("p", "V", "u_max"):
        assert one.branch("secondary")[name] == pytest.approx(other.branch("secondary")[name], rel=1e-8)
    assert one.branch("secondary")["w_mid"] == pytest.approx(-other.branch("secondary")["w_mid"], rel=1e-8)


def test_the_bulge_moves_to_the_thin_end_and_the_detached_one_is_at_the_thick_end(both_sides):
    thick_above, _ = both_sides
    for branch, side in (("primary", 1), ("secondary", -1)):
        middle = thick_above.branch(branch)["w_mid"]
        assert side * middle[-1] > 0.2  # the middle is pushed away from the bulge
        assert np.all(side * middle > 0)


def test_the_force_of_the_thickness_is_the_difference_of_forces():
    """``B`` against residuals of tubes that are a little uneven, at the state of the even one."""
    given, numerics = TubeParameters(**WHOLE), TubeNumerics(**COARSE)
    families = Tube().families(Task(given, numerics, Requests(), MPI.COMM_SELF, lambda *_: None))
    branch = families["secondary"].fine
    system, e, h = branch.system, branch.expansion, 1e-3
    forces = []
    for uneven in (-h, h):
        state = e.state.copy()
        state.loads["uneven"] = uneven
        with system.at(state):
            forces.append(system.residual())
    assert e.push == pytest.approx(system.dot(e.mode, forces[1] - forces[0]) / (2 * h), rel=1e-9)


def test_steps_shrink_like_the_distance_of_both_branches():
    assert largest_step(0.2, 0.0) == largest_step(0.2, 1e-2) == 0.2
    assert largest_step(0.2, -1e-7) == pytest.approx(0.02)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"uneven": 1e-8, "extent": "full"}, "too small"),
        ({"uneven": 0.1}, "extent"),
        ({"uneven": 0.6, "extent": "full"}, "0.5"),
        ({"uneven": 0.1, "extent": "full", "contact": "frictionless"}, "contact"),
    ],
)
def test_refusals(given, said):
    with pytest.raises(InputError, match=said):
        solve("tube", **given)
