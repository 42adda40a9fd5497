"""Wrinkled membranes at parameters for which an audit once got no answer, on coarse meshes."""

import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.api import solve_requests
from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.problem import StateRequest
from weakforms.problems.wrinkled.problem import WrinkledNumerics, WrinkledParameters, wrinkled_membrane
from weakforms.problems.wrinkled.waves.bands import Bands

COARSE = {"cells": 8, "levels": 2}


@pytest.mark.parametrize(
    "given",
    [
        {"M": 0.6, "delta": 1.357, "Af": 0.5, "L": 4.567},
        {"M": 0.6, "delta": 2.0, "Af": 0.2},
        {"M": 0.3, "delta": 1.1, "Af": "critical"},
        {"M": 1.917, "delta": 1.473, "c2": 0.245, "L": 7.87, "Af": "critical"},
        {"M": 0.227, "delta": 1.012, "c2": 0.907, "L": 8.67, "Af": "critical"},
    ],
)
def test_a_membrane_that_does_not_wrinkle_is_found_between_narrow_disks(given):
    """A cylinder of that radius would be compressed along its axis; the membrane widens and is in tension."""
    parameters = WrinkledParameters(**given, energy="standard")
    membrane = wrinkled_membrane(parameters, WrinkledNumerics(**COARSE), MPI.COMM_WORLD)
    own = dict(membrane.values)
    state, _ = membrane.by_homotopy(0.0)
    found = membrane.plain(state)
    assert membrane.values == own
    for name in ("M", "delta", "Af"):
        assert state.loads[name] == pytest.approx(own[name], rel=1e-14)
    assert found.extreme("r", -1) == pytest.approx(own["Af"])
    assert found.extreme("tension", -1) > 0


SOFTENING = {"model": "beda_chevalier", "k1": 0.5378, "k2": 21.05, "k3": 0.0001374, "power": 11.21}
SHORT = SOFTENING | {"M": 1.17, "delta": 1.157, "L": 1.307}


@pytest.mark.parametrize(
    ("problem", "given", "what"),
    [
        ("wrinkled_tube", {"load": "gas", "numerics": COARSE}, "branch primary"),
        ("wrinkled_sheet", {"load": "gas", "at_load": 32.08}, "state at p = 0"),
        ("wrinkled_linear", {"zw": 0.1, "numerics": COARSE}, "state at zw = 0.1"),
    ],
)
def test_a_law_that_gives_way_at_wide_disks_has_no_state_between_them(problem, given, what):
    """The force of the law at the disk has a largest value; states end near ``Af = 1.42`` on fine meshes."""
    result = solve(problem, **SHORT, Af=1.55, **given)
    assert result.failures == []
    (absence,) = result.absent
    assert absence.what == what
    assert (
        f"{problem}: Af = 1.55: the membrane was followed from narrower disks to Af = 1.4" in absence.reason
    )
    assert "'beda_chevalier' hardly resists more of it; choose a smaller Af" in absence.reason
    assert "raise volume_end" not in absence.reason


def test_a_membrane_between_disks_at_which_its_law_does_not_give_way_is_there():
    given = SHORT | {"load": "gas", "Af": 1.38}
    membrane = wrinkled_membrane(WrinkledParameters(**given), WrinkledNumerics(**COARSE), MPI.COMM_WORLD)
    membrane.by_homotopy(0.0)


def test_waves_that_no_stiffness_removes_leave_the_other_numbers(monkeypatch):
    """The whole result was lost, with the advice to lower a level at which there is a state."""

    def none(_bands, _most):
        raise AbsentError("beta_c", "n = 13 is unstable at any bending stiffness up to 1")

    monkeypatch.setattr(Bands, "most_stiffness", none)
    result = solve("wrinkled_bending", zw=7.0, beta=5e-6, numerics={"cells": 6, "levels": 2})
    assert result.failures == []
    assert {"Lambda_membrane", "Lambda_B1", "Lambda_B2", "n_minus", "n_plus"} == set(result.quantities)
    (absence,) = result.absent
    assert absence.what == "beta_c"
    assert absence.reason == "wrinkled_bending: n = 13 is unstable at any bending stiffness up to 1"


def test_a_zone_that_closes_at_the_surface_of_the_liquid_is_found():
    """The block between the surface and the point where ``gw`` touches 1 is too thin for Newton's method."""
    wanted = [StateRequest("zone_closing", 1, profile=())]
    given = {"gamma": 2.0, "low_end": -0.85}
    result = solve_requests("hemisphere", given, COARSE, wanted, branch_uncertainty=False)
    assert result.failures == []
    (closing,) = [point for point in result.special_points if point.kind == "zone_closing"]
    assert closing.values["state"] == -1
    (state,) = result.states
    assert abs(closing.values["t"] - state.quantities["t_level"].value) < 5e-4
    assert state.quantities["gw_min"].value == pytest.approx(1, abs=1e-7)
    assert state.quantities["wrinkled_fraction"].value == 0


@pytest.mark.parametrize(
    ("problem", "given"),
    [("wrinkled_tube", {"M": 1.5, "Af": 0.6, "load_end": 1.0}), ("hemisphere", {"low_end": -0.9})],
)
def test_meshes_too_coarse_for_any_point_are_told(problem, given):
    """One cell in each block of the coarsest mesh: the branch ended with an internal error."""
    with pytest.raises(ConvergenceError, match="no point could be solved for on all meshes; raise cells"):
        solve(problem, numerics={"cells": 4}, **given)
