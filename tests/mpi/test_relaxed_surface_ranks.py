"""The triangulated membrane of Paper 5: the same states, eigenvalues and counts serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper5]


def test_surface(same_on_ranks):
    tube = {
        "problem": "surface",
        "meridional": 8,
        "circumferential": 36,
        "load_start": 5.0,
        "load_end": 7.0,
        "gamma": 0.06,
        "numerics": {"scan": 4, "shown": 2},
    }
    bowl = {
        "problem": "surface",
        "geometry": "hemisphere",
        "size": 0.25,
        "load_start": -0.55,
        "load_end": -0.7,
        "numerics": {"scan": 3, "shown": 1},
        "at": [("zw", -0.65)],
    }
    found = same_on_ranks([tube, bowl])
    assert found[0].special_points
