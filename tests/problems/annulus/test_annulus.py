"""The turned annulus: zones, torque and energy of single states, and what is refused."""

import numpy as np
import pytest

from weakforms import InputError, solve

COARSE = {"cells": 16, "levels": 2}
KIRCHHOFF = {"model": "saint_venant_kirchhoff", "shear": 1.0, "poisson": 0.3}


@pytest.fixture(scope="module")
def stretched():
    return solve("annulus", a=0.4, s=1.05, psi_end=0.3, at={"psi": 0.2}, numerics={"cells": 32})


def test_without_a_turn_the_energy_is_that_of_equal_stretches():
    alpha, s, a = 0.1, 1.2, 0.5
    found = solve("annulus", a=a, s=s, psi_end=0.05, alpha=alpha, numerics=COARSE).branch()
    density = 2 * s**2 + s**-4 - 3 + alpha * (s**4 + 2 / s**2 - 3)
    assert found["psi"][0] == 0
    assert found["U"][0] == pytest.approx(np.pi * (1 - a**2) * density, rel=1e-12)
    assert abs(found["M"][0]) < 1e-12


def test_a_stretched_annulus_is_taut_and_then_wrinkles_from_the_inner_edge(stretched):
    (onset,) = stretched.special_points
    assert onset.kind == "wrinkling_onset"
    assert onset.values["gw_in"] == pytest.approx(1, abs=1e-12)
    branch = stretched.branch()
    before = branch["psi"] <= onset.values["psi"] + 1e-9
    assert (branch["R_front"][before] == 0.4).all()
    assert not branch["f_w"][before].any()
    assert (np.diff(branch["R_front"][~before]) > 0).all()
    assert (branch["gw_in"][before] >= 1 - 1e-12).all()
    assert (branch["gw_in"][~before][1:] < 1).all()
    assert not branch["n_negative"].any()


def test_the_mesh_follows_the_front(stretched):
    (state,) = stretched.states
    field = state.fields[0].columns
    front = state.quantities["R_front"].value
    inside = field["R"] < front
    assert (field["gw"][inside] < 1).all()
    assert (field["gw"][~inside] > 1).all()
    share = (front**2 - 0.4**2) / (1 - 0.4**2)
    assert state.quantities["f_w"].value == pytest.approx(share, rel=1e-10)


def test_the_torque_has_twice_the_order_of_the_elements_although_a_front_is_inside():
    runs = [
        solve(
            "annulus",
            alpha=0.0,
            psi_end=0.15,
            at={"psi": 0.1},
            numerics={"degree": 2, "cells": n, "levels": 2},
        )
        for n in (8, 16, 32, 64)
    ]
    torque = [run.states[0].quantities["M"].value for run in runs]
    first, second = np.abs(np.diff(torque))[:2] / np.abs(np.diff(torque))[1:]
    assert first > 2**3.5
    assert second > 2**3.5


def test_a_taut_ring_at_the_outer_edge_may_appear_later():
    """A sheet of Poisson's ratio 0.3, a = 0.6, wrinkles all over first; its hoops are held at the edge."""
    found = solve("annulus", a=0.6, psi_end=0.3, numerics=COARSE, **KIRCHHOFF)
    (point,) = found.special_points
    assert point.kind == "zone_opening"
    assert point.values["gw_out"] == pytest.approx(1, abs=1e-10)
    branch = found.branch()
    assert branch["R_front"][0] == 1
    assert branch["R_front"][-1] < 1


def test_a_sheet_that_bears_compression_has_no_front_and_more_torque():
    given = {"alpha": 0.0, "psi_end": 0.2, "at": {"psi": 0.15}, "numerics": COARSE}
    full, relaxed = (solve("annulus", energy=e, **given).states[0].quantities for e in ("full", "relaxed"))
    assert full["f_w"].value == 0
    assert full["gw_in"].value < 1
    assert full["M"].value > 1.2 * relaxed["M"].value


def test_the_branch_ends_where_the_sheet_folds_over():
    found = solve("annulus", a=0.05, psi_end=0.6, numerics={"cells": 32, "levels": 2})
    last = found.branch()["psi"][-1]
    assert last == pytest.approx(0.4729, abs=1e-3)
    assert "folds over at the inner edge" in found.branch().ended.reason


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"a": 1.0}, "a = 1.0"),
        ({"s": 0.9}, "s = 0.9"),
        ({"psi_end": 1.5}, "psi_end = 1.5"),
        ({"model": "harmonic"}, "model = 'harmonic'; allowed: neo_hookean"),
        ({**KIRCHHOFF, "energy": "full"}, "allowed: energy = 'relaxed'"),
        ({"model": "gent", "jm": 0.5, "s": 1.5}, "lower s"),
        ({"at": {"torque": 1.0}}, "cannot ask for a state at 'torque'"),
    ],
)
def test_wrong_input_is_refused_in_one_line(given, said):
    with pytest.raises(InputError) as error:
        solve("annulus", **given)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
