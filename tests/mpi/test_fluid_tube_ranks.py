"""The fluid-loaded tube: the same numbers serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper3]


def test_where_a_law_of_bounded_force_gives_way(same_on_ranks):
    """The place that gives way first is known to one rank, and ends the branch on all of them."""
    mesh = {"cells": 16, "levels": 2}
    tube = {"problem": "fluid_tube", "model": "varga", "L": 8, "delta": 2.5, "gamma": 0.5, "n_max": 1}
    (found,) = same_on_ranks([tube | {"numerics": mesh}])
    assert "hardly resists meridional stretch" in found.absent[0].reason


@pytest.mark.slow
def test_a_tube_of_liquid_that_wrinkles(same_on_ranks):
    """Its fronts and its free surface are unknowns that every rank knows."""
    tube = {"problem": "fluid_tube", "energy": "relaxed", "delta": 1.05, "gamma": 0.5, "n_max": 1}
    coarse = {"cells": 32, "levels": 2, "degree": 4}
    (found,) = same_on_ranks([tube | {"at": [("V", 30.0)], "numerics": coarse}])
    assert "zone_opening" in [point.kind for point in found.special_points]
    assert 0.2 < found.states[0].quantities["Z_front_1"].value < 0.4
