"""The wrinkled membrane of Paper 4: the same fronts, states and thresholds serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper4]
MESH = {"cells": 4, "levels": 2, "step": 1}


def test_wrinkled_tube(same_on_ranks):
    fluid = {"problem": "wrinkled_tube", "M": 1.5, "load_end": 6, "at": [("zw", 6.0)]}
    # A zone opens at a flat minimum, whose place is the least certain number of all.
    same_on_ranks([fluid | {"numerics": MESH}])


def test_threshold_and_sheet(same_on_ranks):
    threshold = {"problem": "wrinkled_tube_threshold", "delta": 2, "numerics": MESH | {"cells": 8}}
    coarse = {"along": 4, "around": 4, "degree": 3}  # on less the coarser of two is barely convex
    sheet = {"problem": "wrinkled_sheet", "M": 0.5, "at_load": 2, "numerics": coarse}
    same_on_ranks([threshold, sheet])
