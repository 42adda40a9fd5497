"""The turned annulus: the same zones, fronts and numbers serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


def test_annulus(same_on_ranks):
    coarse = {"cells": 16, "levels": 2, "step": 0.3}
    turned = {"problem": "annulus", "psi_end": 0.2, "numerics": coarse, "at": [("psi", 0.1)]}
    stretched = {"problem": "annulus", "s": 1.05, "psi_end": 0.2, "numerics": coarse, "at": [("psi", 0.15)]}
    found = same_on_ranks([turned, stretched])
    assert [len(result.special_points) for result in found] == [0, 1]
