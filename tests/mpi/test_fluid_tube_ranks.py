"""The fluid-loaded tube: the same numbers serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper3]


def test_primary_branch(same_on_ranks):
    mesh = {"cells": 24, "degree": 4, "levels": 2}
    tube = {"problem": "fluid_tube", "n_max": 1, "zw_end": 0.93, "numerics": mesh}
    (found,) = same_on_ranks([tube | {"at": [("zw", 8.2), ("r_mid", 1.0)]}])
    assert [point.kind for point in found.special_points] == ["limit_point", "bifurcation_point"]
