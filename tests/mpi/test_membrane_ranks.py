"""The membrane of any shape: the same branches, states and fields serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


def test_membrane(same_on_ranks):
    coarse = {"cells": 4, "levels": 2}
    disk = {"problem": "membrane", "alpha": 0.0, "w_end": 1.4, "numerics": coarse, "at": [("w_max", 0.5)]}
    slack = {"problem": "membrane", "mesh": "square", "delta": 1.0, "w_end": 0.4, "numerics": coarse}
    bag = {
        "problem": "membrane",
        "mesh": "airbag",
        "delta": 1,
        "model": "saint_venant_kirchhoff",
        "w_end": 0.56,
    }
    # At a pressure of this size the pleats of the seam, of which round-off may choose others, are few.
    bag |= {"shear": 0.357, "poisson": 0.4, "at": [("p", 0.06)]}
    bag["numerics"] = {**coarse, "degree": 1, "p_start": 0.05}
    pond = {"problem": "membrane", "load": "liquid", "gamma": 5.0, "w_end": 1.2, "at": [("zw", 0.03)]}
    pond |= {"thickness": "1 + 0.2*X"}
    found = same_on_ranks([disk, slack, bag, pond | {"numerics": coarse}])
    assert [len(result.special_points) for result in found] == [1, 0, 0, 2]
