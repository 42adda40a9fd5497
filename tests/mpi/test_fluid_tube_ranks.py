"""The fluid-loaded tube: the same numbers serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper3]


def test_where_a_law_of_bounded_force_gives_way(same_on_ranks):
    """The place that gives way first is known to one rank, and ends the branch on all of them."""
    mesh = {"cells": 16, "levels": 2}
    tube = {"problem": "fluid_tube", "model": "varga", "L": 8, "delta": 2.5, "gamma": 0.5, "n_max": 1}
    (found,) = same_on_ranks([tube | {"numerics": mesh}])
    assert "hardly resists meridional stretch" in found.absent[0].reason
