"""Free inflation with the relaxed energy: the same as the law's until the tube wrinkles, other beyond."""

from functools import cache

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import InputError
from weakforms.verification.cases.references import ROOT

pytestmark = pytest.mark.paper2
MESH = {"cells": 32, "levels": 2, "step": 0.2}
AT = 2.0
"""Beyond the first wrinkle of the tubes here."""


@cache
def solved(energy, extent="half", at=AT, **given):
    tube = {"alpha": 0.0, "u_end": 2.2} | given
    name, asked = at if isinstance(at, tuple) else ("u_max", at)
    return solve("tube", energy=energy, extent=extent, at={name: asked}, numerics=MESH, **tube)


def value(result, name):
    return result.states[0].quantities[name].value


def test_it_is_the_law_up_to_the_first_wrinkle():
    one, other = (solved(energy, at=1.5) for energy in ("relaxed", "standard"))
    (limit, onset), (same,) = one.special_points, other.special_points
    assert limit.kind == same.kind == "limit_point"
    assert limit.values == pytest.approx(same.values, rel=1e-13)
    assert onset.kind == "wrinkling_onset"
    assert onset.values["Z_front_1"] == onset.values["Z_front_2"] == pytest.approx(2.9385, abs=1e-3)
    assert value(one, "p") == pytest.approx(value(other, "p"), rel=1e-13)
    assert value(one, "wrinkled_fraction") == 0


def test_at_the_same_volume_it_stores_less_energy():
    one, other = (solved(energy, at=("V", 10.0)) for energy in ("relaxed", "standard"))
    stored, ordinary = (value(r, "Pi") + value(r, "p") * value(r, "V") for r in (one, other))
    assert stored < ordinary - 1e-7
    assert stored == pytest.approx(ordinary, rel=1e-3)
    assert 0 < value(one, "wrinkled_fraction") < 1


def test_the_hoop_resultant_is_zero_between_the_fronts_and_positive_beside():
    (state,) = solved("relaxed").states
    z, t2 = (state.fields[0].columns[name] for name in ("Z", "t2"))
    low, high = (value(solved("relaxed"), f"Z_front_{k}") for k in (1, 2))
    inside = (z > low) & (z < high)
    assert inside.sum() >= 3
    assert np.abs(t2[inside]).max() < 1e-13
    assert t2[~inside].min() > 0


def test_states_are_those_of_the_table():
    table = np.genfromtxt(ROOT / "reference_data/beyond/relaxed_tube_inside.csv", delimiter=",", names=True)
    (row,) = table[table["u_max"] == AT]
    for name, least in {"p": 1e-7, "V": 1e-7, "Z_front_1": 1e-3, "Z_front_2": 1e-3}.items():
        stated = solved("relaxed").states[0].quantities[name].uncertainty
        assert stated < least
        assert value(solved("relaxed"), name) == pytest.approx(row[name], abs=stated, rel=0)


def test_a_whole_tube_has_a_zone_at_either_disk():
    half, whole = solved("relaxed"), solved("relaxed", "full")
    for name in ("p", "Z_front_1", "Z_front_2", "wrinkled_fraction"):
        assert value(whole, name) == pytest.approx(value(half, name), abs=1e-8)
    assert value(whole, "V") == pytest.approx(2 * value(half, "V"), rel=1e-8)
    assert "bifurcation_point" in [point.kind for point in whole.special_points]


def test_wrinkles_that_begin_at_the_disk_end_there():
    found = solved("relaxed", delta1=1.2, lf=8.0)
    assert value(found, "Z_front_2") == 4.0
    assert 3.5 < value(found, "Z_front_1") < 4.0


def test_a_taut_tube_has_no_wrinkle():
    found = solved("relaxed", alpha=0.1)
    assert "wrinkling_onset" not in [point.kind for point in found.special_points]
    assert set(found.branch("primary")["wrinkled_fraction"]) == {0.0}


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"contact": "adhesive"}, "contact"),
        ({"n": (0, 1)}, "n"),
        ({"extent": "full", "uneven": 0.1}, "uneven"),
        ({"model": "harmonic"}, "model"),
    ],
)
def test_what_is_not_known_of_wrinkled_tubes_is_refused(given, named):
    with pytest.raises(InputError, match=f"energy = 'relaxed'.*{named} = "):
        solve("tube", energy="relaxed", **given)
