"""Problems of the wrinkled cylinder's two-dimensional form, of the thresholds and of the material."""

from math import cos, sin

import pytest

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems import registry
from weakforms.problems.wrinkled import critical

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


def test_round_off_counts_for_more_where_the_least_gw_hardly_changes(monkeypatch):
    """The rate of the least ``gw`` at the threshold, 9.5e-4 here, is that of this membrane."""
    spread = []
    for left in (0.0, 1e-6):
        monkeypatch.setattr(critical, "ROUND_OFF", left)
        found = solve("wrinkled_tube_threshold", delta=1.5, numerics=COARSE).quantities
        spread.append(found["M"].uncertainty)
    assert spread[1] - spread[0] == pytest.approx(1e-6 / 9.54e-4, rel=0.02)


def test_a_membrane_that_wrinkles_at_no_thickness_ratio_is_told_by_how_far_it_is_taut():
    result = solve("wrinkled_tube_threshold", delta=6, L=2, numerics=COARSE)
    assert result.failures == []
    assert set(result.quantities) == {"M_taut", "gw_min"}
    assert result.quantities["M_taut"].value == pytest.approx(0.05)
    least = result.quantities["gw_min"]
    assert least.value - 1 > 1e3 * least.uncertainty


WIDE = {"Af": 2.0, "delta": 1.05}, {"Af": 1.9, "delta": 4.36, "c2": 0.78}


@pytest.mark.parametrize("given", WIDE)
def test_thresholds_between_wide_disks_are_found_and_mirror_each_other(given):
    below, above = (
        solve("wrinkled_tube_threshold", **given, upper=upper, numerics=COARSE).quantities
        for upper in (False, True)
    )
    assert 0.05 < below["M"].value < 1
    assert below["M"].value + above["M"].value == pytest.approx(2, abs=1e-7)
    gw = solve("wrinkled_tube", M=below["M"].value, load="gas", **given, at={"p": 0.0}, numerics=COARSE)
    assert gw.states[0].quantities["gw_min"].value == pytest.approx(1, abs=1e-8)


def test_a_threshold_at_the_thick_end_is_where_that_end_wrinkles():
    """Disks hardly wider than the natural radius: ``Af sqrt(lam1) = 1`` at the thick end."""
    given = {"delta": 5.364, "c2": 0.019, "L": 13.597, "Af": 0.435}
    found = solve("wrinkled_tube_threshold", **given, numerics=COARSE).quantities
    assert found["Z"].value == pytest.approx(13.597, abs=1e-9)
    assert found["M"].value == pytest.approx(0.984819, abs=1e-6)


def test_a_threshold_of_a_long_membrane_is_as_uncertain_as_round_off_leaves_it():
    """``1 - gw`` grows as ``(1 - M)^2`` from nothing: 1.3e-9 at ``M = 0.9945``."""
    given = {"delta": 2.032, "c2": 0.8876, "L": 36.06, "Af": 1.9}
    result = solve("wrinkled_tube_threshold", **given, numerics=COARSE)
    assert result.failures == []
    found = result.quantities["M"]
    assert found.value + found.uncertainty == 1.0
    assert 1e-5 < found.uncertainty < 1e-3


def test_disks_between_which_no_membrane_is_taut_are_refused():
    with pytest.raises(InputError, match=r"allowed: Af above delta\^\(-1/2\) = 0.533"):
        solve("wrinkled_tube_threshold", delta=3.517, Af=0.1635)


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
    about = registry.get("wrinkled_patch").about
    declared = {column.name for column in (*about.columns, *about.numbers)}
    assert set(state.quantities) <= declared | {"residual", "iterations"}
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
