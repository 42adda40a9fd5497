"""The tube that wrinkles in frictionless contact: what its states must satisfy, and what is refused."""

from functools import cache

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import InputError

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


def test_a_tube_that_wrinkles_before_it_touches_is_refused():
    with pytest.raises(InputError, match=r"taut until it touches.*s = 3; lower s below"):
        solve("tube", energy="relaxed", contact="frictionless", alpha=0.0, s=3.0, numerics=COARSE)
