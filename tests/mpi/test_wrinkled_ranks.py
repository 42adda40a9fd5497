"""The wrinkled membrane of Paper 4: the same fronts, states and thresholds serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper4]
MESH = {"cells": 4, "levels": 2, "step": 1}


def test_wrinkled_tube(same_on_two_ranks):
    fluid = {"problem": "wrinkled_tube", "M": 1.5, "load_end": 7, "at": [("zw", 6.0)]}
    gas = {"problem": "wrinkled_tube", "load": "gas", "load_end": 0.1, "at": [("p", 0.05)]}
    # The place where a zone opens is that of a flat minimum: the least certain number of all.
    same_on_two_ranks([item | {"numerics": MESH} for item in (fluid, gas)], rel=1e-7, branches=False)


def test_threshold_and_sheet(same_on_two_ranks):
    threshold = {"problem": "wrinkled_tube_threshold", "delta": 2, "numerics": MESH}
    coarse = {"along": 2, "around": 2, "degree": 3}
    sheet = {"problem": "wrinkled_sheet", "M": 0.5, "at_load": 2, "numerics": coarse}
    same_on_two_ranks([threshold, sheet], rel=1e-7)
