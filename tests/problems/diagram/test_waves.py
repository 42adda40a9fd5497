"""Lines at which waves around the axis of a tube are neutral: against single tubes, and where two meet."""

import numpy as np
import pytest

from weakforms import solve
from weakforms.problems.diagram.bodies.varied import VariedTube
from weakforms.problems.diagram.parameters import DiagramParameters
from weakforms.problems.tube.waves import EVEN, ODD

MESH = {"cells": 48, "levels": 2}
OVER_LENGTH = {"x": "lf", "alpha": 0.0, "low": 5.5, "high": 8.2, "u_end": 2.0}


@pytest.fixture(scope="module")
def over_length():
    return solve("diagram", **OVER_LENGTH, kind="fold,mirror,n1", numerics=MESH, at={"lf": 8.0}, branch="n1")


@pytest.fixture(scope="module")
def tube():
    """One tube of length 8 in its own discretisation, with the eigenvalues of both parities."""
    fine = {"cells": 96, "levels": 2, "step": 0.2}
    return solve("tube", alpha=0.0, lf=8.0, u_end=1.5, n=(0, 1), numerics=fine, at={"u_max": 1.0})


def test_a_line_of_bending_passes_the_points_at_which_single_tubes_bend(over_length, tube):
    (bends,) = tube.points("bifurcation_n1")
    (state,) = over_length.states
    for name in ("p", "u_max"):
        assert state.quantities[name].value == pytest.approx(bends.values[name], abs=1e-6), name
    assert state.quantities["parity"].value == bends.values["parity"] == EVEN
    assert state.quantities["n_negative_n1"].value == 0  # the critical one is left out
    assert over_length.failures == []


def test_operators_of_both_parities_have_the_eigenvalues_of_the_tube(tube):
    """The mass is per ``dS`` here and per ``dZ = l_f/2 dS`` there."""
    given = DiagramParameters(x="lf", alpha=0.0, kind="n1", low=5.0, high=10.0)
    from mpi4py import MPI

    model = VariedTube(MPI.COMM_WORLD, given.material, {"delta1": 1.0, "lf": 8.0}, 48, 4, 0.6)
    at = model.primary(1.5, 0.08).at("u_max", 1.0).state
    wanted = [tube.states[0].quantities[f"Lambda_n1_{k}"].value for k in (1, 2, 3)]
    found = []
    with model.system.at(at):
        for parity in (EVEN, ODD):
            found += model.operators("n1")[parity]().spectrum(3).eigenvalues
    assert np.sort(found)[:3] / 4.0 == pytest.approx(wanted, abs=1e-6)
    assert model.operators("fold") == {}


def test_bending_and_the_limit_point_coincide_at_one_length(over_length):
    """Shorter tubes reach the limit point first, longer ones bend first."""
    one, two = over_length.points("fold_n1")
    assert {one.branch, two.branch} == {"fold", "n1"}
    for name in ("lf", "p", "u_max"):
        assert one.values[name] == pytest.approx(two.values[name], abs=1e-7), name
    assert 7.5 < one.values["lf"] < 8.5
    line = over_length.branch("fold").columns
    assert np.all((line["n_negative_n1"] == 1) == (line["lf"] > one.values["lf"]))


def test_bending_ends_in_a_tip_and_meets_mirror_breaking(over_length):
    (tip,) = over_length.points("tip_n1")
    line = over_length.branch("n1").columns
    assert tip.values["lf"] <= line["lf"].min() + 1e-12
    beside = line["u_max"] - tip.values["u_max"]
    near = np.abs(beside) < 0.15
    *_, curvature, slope, gap = np.polyfit(beside[near], line["lf"][near] - tip.values["lf"], 4)
    assert curvature > 0.1
    assert abs(slope) < 0.01 * curvature
    assert abs(gap) < 1e-5
    one, two = over_length.points("mirror_n1")
    assert one.values["p"] == pytest.approx(two.values["p"], abs=1e-6)


def test_points_on_lines_past_first_wrinkling_are_flagged(over_length):
    (onset,) = over_length.points("wrinkling_n1")
    assert onset.values["t_min"] == pytest.approx(0.0, abs=1e-9)
    line = over_length.branch("n1").columns
    assert np.all((line["wrinkled"] == 1) == (line["u_max"] > onset.values["u_max"]))
    assert {int(p.values["wrinkled"]) for p in over_length.special_points} == {0}


def test_points_past_the_largest_displacement_start_no_line():
    """At ``delta1 = 1.9375`` the last step of the primary branch has a point at ``u_max = 4.05``."""
    coarse = {"cells": 24, "levels": 2}
    given = {"alpha": 0.0, "delta1": 2.0, "low": 1.9, "high": 2.2, "u_end": 4.0}
    found = solve("diagram", **given, kind="n2", numerics=coarse)
    assert [branch.name for branch in found.branches] == ["n2", "end"]
    assert found.branch("n2").columns["u_max"].max() == pytest.approx(4.0)


def test_two_waves_become_neutral_far_out_on_a_stretched_tube():
    given = {"alpha": 0.0, "delta1": 2.0, "low": 1.95, "high": 2.05, "kind": "n2"}
    line = solve("diagram", **given, numerics=MESH | {"step": 0.2}, at={"delta1": 2.0}, branch="n2")
    single = {"alpha": 0.0, "delta1": 2.0, "u_end": 4.0, "n": 2}
    tube = solve("tube", **single, numerics=MESH | {"step": 0.2})
    (point,) = tube.points("bifurcation_n2")
    assert line.states[0].quantities["p"].value == pytest.approx(point.values["p"], abs=1e-7)
