"""Waves around wrinkled membranes (Paper 5): the same changes of stability serially and on two ranks."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper5]
MESH = {"cells": 4, "levels": 2, "step": 1}
PAPER = {"M": 1.5, "delta": 3, "Af": 0.4362}


def test_waves_around_the_cylinder(same_on_ranks):
    fluid = {
        "problem": "wrinkled_tube",
        **PAPER,
        "n": [20],
        "load_end": 5,
        "at": [("zw", 3.0), ("stability_change", 1)],
    }
    same_on_ranks([fluid | {"numerics": MESH}])


@pytest.mark.slow
def test_waves_around_the_hemisphere(same_on_ranks):
    low = {"problem": "hemisphere", "n": [1], "low_end": -0.82, "at": [("zw", -0.8)]}
    mesh = {"cells": 4, "levels": 2, "step": 0.2}
    same_on_ranks([low | {"numerics": mesh}])


@pytest.mark.slow
def test_real_wave_numbers(same_on_ranks):
    mesh = {"cells": 4, "levels": 2}
    linear = {"problem": "wrinkled_linear", "zw": 4.0}
    bending = {"problem": "wrinkled_bending", "zw": 6.0, "beta": 5e-6}
    same_on_ranks([one | {"numerics": mesh} for one in (linear, bending)])
