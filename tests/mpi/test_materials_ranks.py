"""Membranes of other rubbers: the same numbers serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi]


@pytest.mark.slow
def test_other_laws(same_on_ranks):
    tube = {"problem": "fluid_tube", "model": "ogden", "n_max": 1, "zw_end": 0.97}
    tube |= {"at": [("zw", 5.4), ("r_mid", 1.0)], "numerics": {"cells": 24, "levels": 2, "step": 1}}
    folded = {
        "problem": "wrinkled_tube",
        "model": "gent",
        "load": "gas",
        "load_end": 0.1,
        "at": [("p", 0.05)],
    }
    folded["numerics"] = {"cells": 4, "levels": 2, "step": 1}
    found, _ = same_on_ranks([tube, folded])
    assert found.special_points[0].kind == "limit_point"
