"""Annulus, sheets and torus: the same fronts, points and numbers serially and on two ranks."""

import pytest

pytestmark = pytest.mark.mpi


@pytest.mark.slow
def test_annulus(same_on_ranks):
    coarse = {"cells": 16, "levels": 2, "step": 0.3}
    turned = {"problem": "annulus", "psi_end": 0.2, "numerics": coarse, "at": [("psi", 0.1)]}
    stretched = {"problem": "annulus", "s": 1.05, "psi_end": 0.2, "numerics": coarse, "at": [("psi", 0.15)]}
    found = same_on_ranks([turned, stretched])
    assert [len(result.special_points) for result in found] == [0, 1]


def test_sheets(same_on_ranks):
    coarse = {"cells": 4, "levels": 2, "step": 0.3}
    sheared = {"problem": "sheet", "s": 1.1, "gam_end": 0.5, "at": [("gam", 0.4)]}
    strip = {"problem": "sheet", "loading": "strip", "lam_end": 1.4, "at": [("lam", 1.2)]}
    bent = {"problem": "sheet", "loading": "bend", "c": 0.5, "kap_end": 0.8, "at": [("kap", 0.7)]}
    found = same_on_ranks([given | {"numerics": coarse} for given in (sheared, strip, bent)])
    assert all(result.states[0].quantities["lam1"].value > 1.1 for result in found)
    assert found[-1].states[0].quantities["f_w"].value > 0.2


def test_torus(same_on_ranks):
    coarse = {"cells": 16, "levels": 2, "step": 0.3}
    (found,) = same_on_ranks([{"problem": "torus", "b": 0.3, "numerics": coarse, "at": [("r_out", 1.6)]}])
    assert [point.kind for point in found.special_points] == ["limit_point"]


@pytest.mark.slow
def test_waves_around_a_torus(same_on_ranks):
    given = {"problem": "torus", "alpha": 0.0, "v_end": 3.8, "n": (0, 1), "at": [("v", 2.0)]}
    (found,) = same_on_ranks([given | {"numerics": {"cells": 16, "levels": 2, "step": 0.3}}])
    assert [point.kind for point in found.special_points] == ["limit_point", "bifurcation_n1"]
