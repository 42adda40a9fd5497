"""The inflated torus: the same numbers serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


def test_torus(same_on_ranks):
    coarse = {"cells": 16, "levels": 2, "step": 0.3}
    (found,) = same_on_ranks([{"problem": "torus", "b": 0.3, "numerics": coarse, "at": [("r_out", 1.6)]}])
    assert [point.kind for point in found.special_points] == ["limit_point"]


def test_waves_around_a_torus(same_on_ranks):
    given = {"problem": "torus", "alpha": 0.0, "v_end": 3.8, "n": (0, 1), "at": [("v", 2.0)]}
    (found,) = same_on_ranks([given | {"numerics": {"cells": 16, "levels": 2, "step": 0.3}}])
    assert [point.kind for point in found.special_points] == ["limit_point", "bifurcation_n1"]
