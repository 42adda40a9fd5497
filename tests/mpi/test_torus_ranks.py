"""The inflated torus: the same numbers serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


def test_torus(same_on_ranks):
    request = {"problem": "torus", "b": 0.3, "numerics": {"cells": 16, "levels": 2}, "at": [("r_out", 1.6)]}
    (found,) = same_on_ranks([request])
    assert [point.kind for point in found.special_points] == ["limit_point"]
