"""The inflated torus: its first state, its symmetries, where it ends, and what states it gives."""

import numpy as np
import pytest
from mpi4py import MPI
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from weakforms import solve
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.torus.model import TorusModel, stress_free_volume

NONE = dict.fromkeys(("c01", "c20", "c02", "c30", "c03", "c11"), 0.0)
COARSE = {"cells": 16, "levels": 2}


@pytest.fixture(scope="module")
def inflated():
    return solve("torus", b=0.3, v_end=2.0, at={"r_out": 1.35}, numerics=COARSE)


def test_without_stress_it_is_a_torus():
    system = TorusModel(MPI.COMM_SELF, mooney_rivlin_of(0.1), 0.3, 8, 4).system
    with system.at(system.initial):
        found = system.monitors()
        residual = system.residual()
    assert found["V"] == pytest.approx(stress_free_volume(0.3), rel=1e-10)
    assert [found[name] for name in ("r_out", "r_in", "z_top")] == pytest.approx([1.3, 0.7, 0.3], rel=1e-8)
    assert [found[name] for name in ("U", "Pi", "virial")] == pytest.approx([0, 0, 0], abs=1e-10)
    assert np.abs(residual).max() < 1e-9


def test_the_equators_stay_in_the_plane_of_symmetry_and_turn_upright(inflated):
    (state,) = inflated.states
    columns = state.fields[0].columns
    assert columns["z"][[0, -1]] == pytest.approx([0, 0], abs=1e-14)
    assert (columns["z"][1:-1] > 0).all()
    assert abs(columns["r"][1] - columns["r"][0]) < 0.1 * (columns["z"][1] - columns["z"][0])
    assert state.quantities["r_out"].value == pytest.approx(columns["r"][0], rel=1e-12)


def test_stretches_are_those_of_the_meridian(inflated):
    columns = inflated.states[0].fields[0].columns
    t, r, z = (columns[name] for name in "trz")
    slope = np.hypot(*(CubicSpline(t, x)(t, 1) for x in (r, z)))
    assert columns["lam1"][2:-2] == pytest.approx(slope[2:-2] / 0.3, rel=1e-3)
    assert columns["lam2"] == pytest.approx(r / (1 + 0.3 * np.cos(t)), rel=1e-7)


def test_it_starts_with_little_pressure_and_ends_at_a_volume(inflated):
    branch = inflated.branch()
    assert branch["p"][0] == pytest.approx(0.1 * 1.1 / 0.3), "over the stiffness 1 + alpha"
    assert branch["V"][0] < 1.05 * stress_free_volume(0.3)
    assert branch["v"][-2] < 2 <= branch["v"][-1]
    assert branch["v"] == pytest.approx(branch["V"] / stress_free_volume(0.3), rel=1e-12)
    assert (branch.ended.by, branch.ended.value) == ("v_end", 2.0)


def test_a_slender_torus_is_nearly_a_long_tube():
    """A closed one: its meridional resultant is twice the one along its axis."""

    def resultants(l1):
        l2 = 1.5 / l1**2
        square = (l1 * l2) ** -2
        return 2 * (l1 - square / l1) / l2, 2 * (l2 - square / l2) / l1

    l1 = brentq(lambda l1: resultants(l1)[0] - 2 * resultants(l1)[1], 1.1, 1.3)
    found = solve("torus", b=0.1, alpha=0.0, v_end=1.6, at={"V": 1.5 * stress_free_volume(0.1)})
    pressure = resultants(l1)[0] / (0.1 * l1)
    assert found.states[0].quantities["p"].value == pytest.approx(pressure, rel=0.01)


def test_a_law_that_locks_ends_the_branch():
    found = solve("torus", model="gent", jm=2.0, b=0.3, v_end=20.0, numerics=COARSE | {"step": 0.3})
    (absent,) = found.absent
    assert absent.what == "rest of branch primary"
    assert "lower v_end" in absent.reason
    assert found.failures == []


@pytest.mark.slow
def test_the_pressure_is_in_proportion_to_the_stiffness_of_the_law():
    given = {"b": 0.3, "v_end": 1.5, "numerics": COARSE | {"step": 0.3}, "at": {"r_out": 1.32}}
    stiff, soft = (
        solve("torus", model="rivlin", c10=7.0, **NONE, **given),
        solve("torus", alpha=0.0, **given),
    )
    pressures = [found.states[0].quantities["p"].value for found in (stiff, soft)]
    assert stiff.branch()["p"][0] == pytest.approx(7 * soft.branch()["p"][0])
    assert pressures[0] == pytest.approx(7 * pressures[1], rel=1e-9)
