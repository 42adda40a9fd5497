"""Problems of the wrinkled cylinder's two-dimensional form, of the thresholds and of the material."""

from math import cos, sin

import pytest

from weakforms import solve

pytestmark = pytest.mark.paper4
COARSE = {"cells": 6, "levels": 2}


def test_the_sheet_gives_the_axisymmetric_volume_and_potential():
    sheet = solve("wrinkled_sheet", M=1.5, at_load=4.5, numerics={"along": 2, "around": 2})
    tube = solve("wrinkled_tube", M=1.5, at={"zw": 4.5}, numerics=COARSE).states[0]
    for name in ("V", "Pi"):
        found, expected = sheet.quantities[name], tube.quantities[name]
        assert found.value == pytest.approx(expected.value, rel=1e-5)
        assert abs(found.value - expected.value) <= 2 * found.uncertainty
    assert sheet.quantities["twist"].value < 1e-3


def test_thresholds_mirror_each_other():
    below, above = (
        solve("wrinkled_tube_threshold", delta=2, upper=upper, numerics=COARSE).quantities
        for upper in (False, True)
    )
    assert below["M"].value == pytest.approx(0.7351817, abs=1e-6)
    assert below["M"].value + above["M"].value == pytest.approx(2, abs=1e-7)
    assert below["Z"].value + above["Z"].value == pytest.approx(8, abs=1e-5)


def test_a_threshold_that_is_not_there_is_a_failure_not_a_number():
    result = solve("wrinkled_tube_threshold", delta=6, L=2, numerics=COARSE)
    assert result.quantities == {}
    assert "taut" in result.failures[0].reason


def test_the_material_problem_has_the_states_of_the_table():
    slack = solve("wrinkled_material", l1=0.9, l2=0.8).quantities
    assert all(q.value == 0 for q in slack.values())
    wrinkled = solve("wrinkled_material", l1=1.5, l2=0.5).quantities
    assert wrinkled["W2"].value == wrinkled["W22"].value == 0
    full = solve("wrinkled_material", l1=1.5, l2=0.5, energy="standard").quantities
    assert full["W2"].value < 0
    assert full["W"].value > wrinkled["W"].value


def test_the_patch_has_the_potential_of_equation_33_and_the_shape_it_says():
    """``W = -b int z x' dX`` with its derivatives in ``e``, and no strain energy that goes with ``e``."""
    a, b, c, n, length, e = 0.4, 1.8, 0.2, 7.0, 1.3, 0.02
    (state,) = solve("wrinkled_patch", a=a, b=b, c=c, n=n, Lx=length, at={"e": e}).states
    linear, square = (a / n + c) * sin(n * length), n * length / 2 + sin(2 * n * length) / 4
    expected = {
        "W": -b * (a * length * c + e * linear + e**2 * square),
        "W_e": -b * (linear + 2 * e * square),
        "W_ee": -2 * b * square,
    }
    for name, value in expected.items():
        found = state.quantities[name]
        assert abs(found.value - value) <= 2 * found.uncertainty + 1e-13, name
        assert found.value == pytest.approx(value, rel=1e-9)
    rest = [state.quantities[name].value for name in ("U_e", "U_ee", "shear")]
    assert rest == pytest.approx([0.0] * 3, abs=1e-13)
    shape = state.fields[0].columns
    assert shape["X"][-1] == length
    assert shape["x"] == pytest.approx([a * s + e * sin(n * s) for s in shape["X"]], abs=1e-15)
    assert shape["z"] == pytest.approx([c + e * cos(n * s) for s in shape["X"]], abs=1e-15)
