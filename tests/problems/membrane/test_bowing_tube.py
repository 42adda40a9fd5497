"""Problem ``membrane`` for a quarter of a tube, which bows."""

import numpy as np
import pytest

from weakforms import solve
from weakforms.problems.membrane.shapes import tube

COARSE = {"cells": 8, "levels": 2}


@pytest.mark.parametrize("degree", [1, 2])
def test_a_quarter_of_a_tube(degree):
    of = tube(4, 6.0, degree)
    x, y, z = of.points.T
    assert np.hypot(x, y) == pytest.approx(1.0)
    assert (y.min(), z.min(), z.max()) == (pytest.approx(0), 0, 3)
    assert (np.einsum("md,md->m", of.normals, of.points[of.corners].mean(axis=1) * (1, 1, 0)) > 0).all()
    edges = {"held": of.held, **of.mirrors}
    lengths = {
        name: np.linalg.norm(np.diff(of.points[ends], axis=1)[:, 0], axis=1).sum()
        for name, ends in edges.items()
    }
    chord = 4 * 2 * np.sin(np.pi / 8)
    assert lengths == pytest.approx({"held": chord, "Y": 2 * 3.0, "Z": chord})


@pytest.mark.slow
def test_an_even_tube_bows_where_tube_does():
    """One bifurcation, of one wave, by the axisymmetric problem with waves around."""
    own = solve("membrane", mesh="tube", lf=10, delta=1, alpha=0.0, w_end=0.7, numerics=COARSE)
    line = solve("tube", alpha=0.0, delta1=1, lf=10, n=(1,), u_end=0.7)
    (one,), (other,) = own.points("bifurcation_point"), line.points("bifurcation_n1")
    assert one.values["p"] == pytest.approx(other.values["p"], rel=1e-4)
    assert one.values["w_max"] == pytest.approx(other.values["u_max"], rel=3e-3)
    assert own.points("limit_point") == []


def test_a_tube_that_is_thinner_on_one_side_has_a_limit_pressure_instead():
    given = {"mesh": "tube", "lf": 10, "delta": 1, "alpha": 0.0, "w_end": 1.3, "numerics": COARSE}
    found = solve("membrane", thickness="1 + 0.01*X", **given)
    (limit,) = found.special_points
    assert limit.kind == "limit_point"
    assert limit.values["p"] == pytest.approx(1.65319, rel=1e-4)  # by two other methods: beyond.bowed_tube
