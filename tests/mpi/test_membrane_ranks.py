"""The membrane of any shape: the same branches, states and fields serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


def test_membrane(same_on_ranks):
    coarse = {"cells": 4, "levels": 2}
    disk = {"problem": "membrane", "alpha": 0.0, "w_end": 1.4, "numerics": coarse, "at": [("w_max", 0.5)]}
    slack = {"problem": "membrane", "mesh": "square", "delta": 1.0, "w_end": 0.4, "numerics": coarse}
    found = same_on_ranks([disk, slack])
    assert [len(result.special_points) for result in found] == [1, 0]
