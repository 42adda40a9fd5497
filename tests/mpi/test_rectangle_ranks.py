"""The rectangular membrane: the same branches, states and counts serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


def test_rectangle(same_on_ranks):
    coarse = {"cells": 4, "levels": 2}
    liquid = {"problem": "rectangle", "gamma": 5.0, "w_end": 0.35, "numerics": coarse, "at": [("w_c", 0.3)]}
    slack = {"problem": "rectangle", "load": "gas", "delta": 1.0, "c": 1.5, "w_end": 0.35, "numerics": coarse}
    gas = {"problem": "rectangle", "load": "gas", "alpha": 0.0, "V_r": 60.0, "w_end": 1.8, "numerics": coarse}
    found = same_on_ranks([liquid, slack, gas])
    assert [len(result.special_points) for result in found] == [1, 0, 2]
