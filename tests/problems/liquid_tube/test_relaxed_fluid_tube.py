"""The tube of liquid with the relaxed energy: the same as the law's until it wrinkles, other beyond."""

import re
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.liquid_tube.parameters import FluidTubeNumerics, FluidTubeParameters
from weakforms.problems.liquid_tube.relaxed import WHOLE, RelaxedBranch
from weakforms.verification.cases.references import ROOT

pytestmark = pytest.mark.paper3
MESH = {"cells": 32, "levels": 2, "degree": 5}
TUBE = {"delta": 1.05, "gamma": 0.5, "alpha": 0.0, "n_max": 1}
TABLE = np.genfromtxt(ROOT / "reference_data/beyond/relaxed_fluid_part.csv", delimiter=",", names=True)
AT = TABLE["V"][1]
"""Volume beyond the first wrinkle."""


@cache
def solved(energy, at=("V", AT), **given):
    return solve("fluid_tube", energy=energy, at=dict([at]), numerics=MESH, **TUBE | given)


def value(result, name):
    return result.states[0].quantities[name].value


def test_it_is_the_law_up_to_the_first_wrinkle():
    one, other = (solved(energy, ("zw", 2.0)) for energy in ("relaxed", "standard"))
    ours, theirs = (result.states[0].quantities for result in (one, other))
    same = ours.keys() & theirs.keys()
    assert {"V", "Pi", "r_mid", "r_front", "T2_mid", "Lambda_n0", "Lambda_n1", "n_negative"} <= same
    for name in same:
        within = sum(found[name].uncertainty or 0.0 for found in (ours, theirs))
        assert within < 1e-3
        assert ours[name].value == pytest.approx(theirs[name].value, abs=within, rel=0), name
    opening = next(point for point in one.special_points if point.kind == "zone_opening")
    (text,) = (text for text in other.warnings if "compressed" in text)
    assert text.endswith("; energy = relaxed lets it wrinkle")
    told = {name: float(number) for name, number in re.findall(r"(\w+) = ([\d.]+)\(", text)}
    for name in ("V", "zw", "Z"):
        assert told[name] == pytest.approx(opening.values[name], rel=1e-4)
    assert not one.warnings
    assert np.isnan(one.branch("primary")["Z_front_1"][0])


def test_states_are_those_of_the_table():
    for name in ("zw", "r_max", "T1_ring", "Z_front", "Z_front_1", "Z_front_2"):
        found = solved("relaxed").states[0].quantities[name]
        assert found.uncertainty < 1e-3
        assert found.value == pytest.approx(TABLE[name][1], abs=found.uncertainty, rel=0), name


def test_the_hoop_resultant_is_zero_between_the_fronts_and_positive_beside():
    (state,) = solved("relaxed").states
    z, t2 = (state.fields[0].columns[name] for name in ("Z", "T2"))
    low, high = (value(solved("relaxed"), f"Z_front_{k}") for k in (1, 2))
    inside = (z > low) & (z < high)
    assert inside.any()
    assert np.abs(t2[inside]).max() < 1e-13
    assert t2[~inside].min() > 0
    assert value(solved("relaxed"), "wrinkled_fraction") == pytest.approx((high - low) * 1.05 / 8, rel=1e-9)


def test_a_first_integral_is_constant_across_the_fronts():
    (state,) = solved("relaxed").states
    (field,) = state.fields
    assert np.ptp(field.columns["H"]) < min(field.uncertainty["H"], 1e-3)


@pytest.mark.slow
def test_a_volume_that_it_does_not_have_is_refused_with_the_range():
    with pytest.raises(InputError, match=r"V = 1000 is not taken .* V ranges over \[0, 38"):
        solved("relaxed", ("V", 1000.0))


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"model": "harmonic", "delta": 1.1}, "model"),
        ({"model": "varga"}, "model"),
        ({"L": 40.0, "delta": 1.1}, "L/delta"),
    ],
)
def test_what_is_not_known_of_wrinkled_tubes_is_refused(given, named):
    with pytest.raises(InputError, match=rf"energy = 'relaxed'.*{named} = "):
        solve("fluid_tube", energy="relaxed", **given)


def test_states_are_asked_for_by_load_volume_and_points_alone():
    with pytest.raises(InputError, match="no state is solved for by r_mid; allowed: zw, V"):
        solve("fluid_tube", energy="relaxed", at={"r_mid": 1.5})


def heavy(**numerics):
    """The branch of a tube whose zone is 0.6 long at ``V = 29``."""
    tube = {"delta": 1.0585, "gamma": 0.588, "n_max": 1, "energy": "relaxed", "zw_end": 0.3}
    return RelaxedBranch(FluidTubeParameters(**tube), FluidTubeNumerics(**numerics), MPI.COMM_WORLD)


def test_a_state_is_found_where_newtons_method_fails_on_the_mesh_of_the_trace():
    branch = heavy(cells=48, degree=6, levels=2)
    with branch.membrane.weighed(), pytest.raises(ConvergenceError, match="DIVERGED_MAX_IT"):
        branch.trace.at("V_f", 29.0 / WHOLE["V"][1])
    found = branch.state("V", 29.0).quantities
    assert found["Z_front_2"].value > found["Z_front_1"].value + 0.5
    assert max(found[name].uncertainty for name in ("zw", "Z_front_1", "Z_front_2")) < 1e-6


def test_a_mesh_that_is_too_coarse_for_a_state_is_named():
    with pytest.raises(ConvergenceError, match=r"on the mesh of 1\d cells: .*; raise cells"):
        heavy(cells=32, degree=4, levels=3).state("V", 29.0)
