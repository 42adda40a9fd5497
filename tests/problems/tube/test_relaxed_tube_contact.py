"""The tube that wrinkles in frictionless contact: what its states must satisfy, and what is refused."""

from functools import cache

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.tube.relaxed_contact import RelaxedContact
from weakforms.verification.cases.references import ROOT

GIVEN = {"contact": "frictionless", "alpha": 0.02, "lf": 6.0, "s": 1.8, "p_end": 5.8}
COARSE = {"degree": 5, "cells": 24}


@cache
def solved(energy):
    return solve("tube", energy=energy, at={"p": 5.6}, numerics=COARSE, **GIVEN)


def value(found, name):
    return found.states[0].quantities[name].value


def fields(found):
    return found.states[0].fields[0].columns


def test_it_wrinkles_between_the_patch_and_the_disk_and_nowhere_else():
    found = solved("relaxed")
    edge, low, high = (value(found, name) for name in ("Z_front", "Z_front_1", "Z_front_2"))
    assert 0 < edge < low < high < 3.0
    place, t2 = (fields(found)[name] for name in ("Z", "t2"))
    inside = (low + 0.02 < place) & (place < high - 0.02)
    assert inside.sum() > 10
    assert np.abs(t2[inside]).max() < 1e-9
    assert t2[(place < low - 0.02) | (place > high + 0.02)].min() > 0.0


def test_the_edge_of_the_patch_is_at_the_substrate_and_gw_is_one_at_both_ends():
    found = solved("relaxed")
    of = fields(found)
    assert np.interp(value(found, "Z_front"), of["Z"], of["rho"]) == pytest.approx(1.8, abs=1e-3)
    gw = of["lam2"] * np.sqrt(of["lam1"])
    for name in ("Z_front_1", "Z_front_2"):
        assert np.interp(value(found, name), of["Z"], gw) == pytest.approx(1.0, abs=1e-3)


def test_the_ordinary_tube_is_compressed_there_and_stores_more():
    relaxed, ordinary = solved("relaxed"), solved("standard")
    assert value(ordinary, "t2_min") < -0.05
    assert value(relaxed, "t2_min") > -1e-9
    assert value(relaxed, "Pi") < value(ordinary, "Pi") - 1e-6


def test_up_to_the_first_wrinkle_the_tube_is_the_ordinary_one():
    taut, ordinary = (
        solve("tube", energy=energy, at={"p": 4.0}, numerics=COARSE, **GIVEN | {"p_end": 4.5})
        for energy in ("relaxed", "standard")
    )
    for name in ("u_max", "V", "Z_front", "Pi"):
        assert value(taut, name) == value(ordinary, name)
    assert set(taut.branch("primary")["wrinkled_fraction"]) == {0.0}


FAR = {"contact": "frictionless", "alpha": 0.0, "lf": 6.0, "s": 3.0}
FINER = {"degree": 5, "cells": 32, "levels": 2}


@cache
def far(energy, p_end=3.5, cells=32, **given):
    return solve("tube", energy=energy, numerics=FINER | {"cells": cells}, p_end=p_end, **FAR | given)


def test_far_from_its_substrate_it_wrinkles_touches_becomes_taut_and_wrinkles_again():
    found = far("relaxed")
    wanted = ["limit_point", "wrinkling_onset", "contact_onset", "limit_point"]
    assert [p.kind for p in found.special_points] == [*wanted, "wrinkling_onset", "wrinkling_onset"]
    reached = [p.values["u_max"] for p in found.special_points]
    assert reached == sorted(reached)
    assert reached[2] == pytest.approx(2.0, abs=1e-10)
    primary = found.branch("primary")
    u, fraction, edge = (primary[name] for name in ("u_max", "wrinkled_fraction", "Z_front"))
    wrinkled = (reached[1] < u) & (u < reached[4]) | (u > reached[5] * (1 + 1e-12))
    assert np.array_equal(fraction > 0, wrinkled)
    assert np.array_equal(edge > 0, u > 2.0 + 1e-9)


def test_its_states_before_and_after_first_contact_are_those_of_the_table():
    table = np.genfromtxt(ROOT / "reference_data/beyond/relaxed_tube_early.csv", delimiter=",", names=True)
    at = [("u_max", u) for u in (1.8, 2.01, 2.15)]
    found = solve("tube", energy="relaxed", numerics=FINER, p_end=3.6, at=at, **FAR)
    for state in found.states:
        (row,) = table[np.isclose(table["u_max"], state.at["u_max"], rtol=1e-12)]
        for name, least in {"p": 1e-6, "V": 1e-5, "Z_front_1": 1e-3, "Z_front_2": 1e-3}.items():
            stated = state.quantities[name]
            assert stated.uncertainty < least
            assert stated.value == pytest.approx(row[name], abs=stated.uncertainty + 1e-11)


def test_while_it_is_taut_in_contact_it_is_the_ordinary_one():
    taut, ordinary = (
        solve("tube", energy=energy, at={"u_max": 2.1}, numerics=FINER, p_end=3.0, **FAR).states[0]
        for energy in ("relaxed", "standard")
    )
    for name in ("p", "V", "Z_front", "Pi"):
        ours, theirs = (state.quantities[name].value for state in (taut, ordinary))
        assert ours == pytest.approx(theirs, rel=1e-11)


def test_a_zone_leaves_the_disk_in_contact():
    given = {"alpha": 0.037, "delta1": 1.09, "lf": 8.7, "s": 2.84}
    with pytest.raises(ConvergenceError, match="on another mesh; raise cells"):
        far("relaxed", 1.75, **given)
    found = far("relaxed", 1.75, cells=48, **given)
    assert [p.kind for p in found.special_points].count("wrinkling_onset") == 1
    assert not found.absent
    primary = found.branch("primary")
    u, end, wrinkled = (primary[name] for name in ("u_max", "Z_front_2", "wrinkled_fraction"))
    assert set(end[(wrinkled > 0) & (u < 1.865)]) == {4.35}
    assert np.all(np.diff(end[u > 1.8651]) < 0)


def test_a_pressure_that_ends_before_contact_is_said():
    found = far("relaxed", 1.2)
    assert "wrinkling_onset" not in [p.kind for p in found.special_points]
    assert any("below first contact" in item.reason for item in found.absent)
    assert found.branch("primary")["p"][-1] == pytest.approx(1.2)


def test_a_substrate_touched_with_a_zone_too_small_to_be_followed_is_refused():
    with pytest.raises(InputError, match=r"s = 2\.5332.*lower s below 2\.533.*or raise it above 2\.533"):
        far("relaxed", s=2.5332)


def test_meshes_that_disagree_about_the_order_of_events_are_said(monkeypatch):
    settle = RelaxedContact.settle

    def taut(run):
        settle(run)
        if not run.finest:
            del run.parts[1:]

    monkeypatch.setattr(RelaxedContact, "settle", taut)
    with pytest.raises(ConvergenceError, match="in another order on another mesh; raise cells"):
        solve("tube", energy="relaxed", numerics=FINER, p_end=3.0, **FAR)
