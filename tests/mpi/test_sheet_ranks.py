"""Sheets in their plane: the same numbers serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


def test_sheets(same_on_ranks):
    coarse = {"cells": 4, "levels": 2, "step": 0.3}
    sheared = {"problem": "sheet", "s": 1.1, "gam_end": 0.5, "at": [("gam", 0.4)]}
    strip = {"problem": "sheet", "loading": "strip", "lam_end": 1.4, "at": [("lam", 1.2)]}
    bent = {"problem": "sheet", "loading": "bend", "c": 0.5, "kap_end": 0.8, "at": [("kap", 0.7)]}
    found = same_on_ranks([given | {"numerics": coarse} for given in (sheared, strip, bent)])
    assert all(result.states[0].quantities["lam1"].value > 1.1 for result in found)
    assert found[-1].states[0].quantities["f_w"].value > 0.2
