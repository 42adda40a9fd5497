"""The hemisphere that holds a liquid or a gas: the numbers of one state are consistent."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms.api import solve_requests
from weakforms.errors import AbsentError, InputError
from weakforms.problems.problem import StateRequest, validated
from weakforms.problems.wrinkled.hemisphere import (
    HemisphereBranch,
    HemisphereNumerics,
    HemisphereParameters,
    hemisphere_membrane,
)
from weakforms.problems.wrinkled.readings import Readings

COARSE = {"cells": 8, "levels": 2}


def test_level_at_the_limit_point_is_where_the_membrane_has_that_height():
    """The surface of the liquid is a point of the mesh and moves with the state up to the limit point."""
    wanted = [StateRequest("limit_point", 1, profile=())]
    given = {"c2": 0.0658, "gamma": 3.1549}
    result = solve_requests("hemisphere", given, COARSE, wanted, branch_uncertainty=False)
    (state,) = result.states
    columns = state.fields[0].columns
    level = state.quantities["t_level"].value
    height = np.interp(level, columns["t"], columns["z"])
    assert height == pytest.approx(state.quantities["zw"].value, abs=2e-4)  # linear between 161 points
    (limit,) = [point for point in result.special_points if point.kind == "limit_point"]
    assert limit.values["t_level"] == pytest.approx(level, abs=1e-12)


def test_the_full_energy_is_unstable_against_waves_where_a_wrinkled_hemisphere_is_stable():
    """Without wrinkling the membrane is compressed around; both forms of the relaxed energy agree."""
    wanted = [StateRequest("zw", -0.75)]
    found = {}
    for energy in ("relaxed", "modified_gradient", "standard"):
        given = {"energy": energy, "low_end": -0.8, "n": (10,)}
        coarse = {"cells": 4, "levels": 2, "step": 0.2}
        (state,) = solve_requests("hemisphere", given, coarse, wanted, branch_uncertainty=False).states
        found[energy] = {name: q.value for name, q in state.quantities.items()}
    assert found["modified_gradient"] == pytest.approx(found["relaxed"], rel=1e-9)
    assert found["standard"]["V"] > 1.05 * found["relaxed"]["V"]
    assert found["standard"]["Lambda_n10_1"] < 0 < found["relaxed"]["Lambda_n10_1"]


@pytest.mark.parametrize(
    ("law", "limits"),
    [({}, 1), ({"c2": 0.3, "volume_end": 8.0}, 0), ({"model": "gent", "volume_end": 4.0}, 1)],
    ids=["neo-Hookean", "Mooney-Rivlin", "Gent"],
)
def test_a_gas_inflates_the_hemisphere_of_any_law(law, limits):
    """Virtual work on the branch, a taut membrane, and the limit point where n_negative changes."""
    coarse = {"cells": 4, "levels": 2, "step": 0.2}
    wanted = [StateRequest("p", 0.5, profile=())]
    result = solve_requests("hemisphere", {"load": "gas"} | law, coarse, wanted, branch_uncertainty=False)
    columns = result.branch().columns
    assert columns["p"][0] == pytest.approx(0.01, rel=1e-12)
    assert columns["V"][0] == pytest.approx(1 / 3, rel=2e-3)
    assert np.diff(columns["V"]).min() > 0
    assert columns["gw_min"].min() > 1
    assert "t_level" not in columns
    assert "zw" not in columns
    found = [point for point in result.special_points if point.kind == "limit_point"]
    assert len(found) == limits
    counts = np.array(columns["n_negative"])
    past = columns["V"] > (found[0].values["V"] if found else np.inf)
    np.testing.assert_array_equal(counts, past.astype(int))
    state = result.states[0]
    field, spread = state.fields[0].columns, state.fields[0].uncertainty
    assert np.abs(field["axial"]).max() <= 2 * spread["axial"]
    assert spread["axial"] < 1e-4
    assert state.quantities["lam_pole"].value == pytest.approx(field["lam1"][0], rel=1e-9)
    assert result.failures == []


@pytest.mark.parametrize(
    ("given", "numerics"),
    [
        # There was no start: at zw = -0.8 and under a part of the gas there is no state.
        ({"gamma": 8.0}, {"cells": 8, "levels": 2}),
        # The zone closes shortly before the limit load, which was sought with the zone.
        ({"gamma": 7.0, "low_end": -0.8}, {"cells": 8, "levels": 2}),
        # The zone closes shortly after it, at a load above those of both neighbours.
        ({"gamma": 8.0, "low_end": -0.8, "model": "varga"}, {}),
    ],
    ids=["start", "limit load", "zone"],
)
def test_a_heavy_liquid_has_a_limit_load_and_a_zone_that_closes_near_it(given, numerics):
    result = solve_requests("hemisphere", given, numerics, [], branch_uncertainty=False)
    assert result.failures == []
    (limit,) = [point for point in result.special_points if point.kind == "limit_point"]
    (closing,) = [point for point in result.special_points if point.kind == "zone_closing"]
    assert -0.8 < closing.values["zw"] < limit.values["zw"]
    assert limit.values["zw"] - closing.values["zw"] < 0.005
    columns = result.branch().columns
    assert max(columns["zw"]) == pytest.approx(limit.values["zw"], abs=2e-3)
    assert (columns["V"] > limit.values["V"]).any()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"model": "gent", "shear": 0.4},
            r"gamma = 4\.\d+: allowed with this stiffness of the law: 0\.2 to 1\.6;",
        ),
        ({"c2": 1.0, "gamma": 1.0}, "allowed with this stiffness of the law: 2 to 16"),
        (
            {"energy": "standard", "low_end": -1.1},
            "of -1.1: with energy = 'standard' .*raise low_end and zw to -0.9",
        ),
    ],
)
def test_what_has_no_states_is_refused_with_what_to_change(given, message):
    with pytest.raises(InputError, match=message):
        solve_requests("hemisphere", given, COARSE, [], branch_uncertainty=False)


@pytest.mark.parametrize(
    ("given", "begin"),
    [({}, -1.1), ({"energy": "standard"}, -0.9), ({"energy": "standard", "low_end": -0.85}, -0.85)],
)
def test_the_full_energy_begins_where_it_has_states(given, begin):
    assert validated(HemisphereParameters, given, "hemisphere").low_end == begin
    gas = validated(HemisphereParameters, {**given, "load": "gas"}, "hemisphere")
    assert ("low_end" in gas.model_fields_set) == ("low_end" in given), "no warning that it has no effect"


def test_a_highest_level_below_the_first_one_is_an_absence():
    given = validated(HemisphereParameters, {"gamma": 8.0}, "hemisphere")
    numerics = HemisphereNumerics(**COARSE)
    membrane = hemisphere_membrane(given, numerics, MPI.COMM_WORLD)
    branch = HemisphereBranch(membrane, 0.0, np.inf, numerics.step, Readings(membrane, 6))
    branch.low_end = -0.75
    with pytest.raises(AbsentError, match=r"level is near -0\.7\d+, below low_end = -0\.75; lower"):
        branch.follow()


@pytest.mark.parametrize(
    ("given", "asked", "message"),
    [
        ({"load": "gas"}, ("zw", -0.9), "with load = 'gas' there is no zw; the load is p"),
        ({}, ("p", 0.5), "with load = 'fluid' there is no p; the load is zw"),
        ({"load": "gas"}, ("p", 0.001), "p = 0.001; allowed: from 0.002 to below 100"),
        ({}, ("zw", 0.1), "zw = 0.1; allowed: from -1.18 to below 0, the equator"),
        ({"load": "gas", "volume_end": 1.0}, ("p", 0.5), "volume_end = 1.0: input should be greater than 1"),
    ],
    ids=["level of a gas", "pressure of a liquid", "too small", "above the equator", "no volume gained"],
)
def test_a_load_that_the_hemisphere_does_not_have_is_refused(given, asked, message):
    with pytest.raises(InputError, match=message):
        solve_requests("hemisphere", given, {}, [StateRequest(*asked)])


def test_parameters_of_the_other_load_are_said_to_have_no_effect():
    gas = validated(HemisphereParameters, {"load": "gas", "gamma": 3.0, "low_end": -1.0}, "hemisphere")
    assert [text.split(" has")[0] for text in gas.without_effect()] == ["gamma = 3.0", "low_end = -1.0"]
    fluid = validated(HemisphereParameters, {"load_end": 2.0, "volume_end": 4.0}, "hemisphere")
    assert [text.split(" has")[0] for text in fluid.without_effect()] == [
        "load_end = 2.0",
        "volume_end = 4.0",
    ]


def test_a_small_pressure_below_the_start_is_reached():
    """The growth of the sphere, p/24 to first order, at the pole."""
    (state,) = solve_requests(
        "hemisphere", {"load": "gas"}, {"levels": 2}, [StateRequest("p", 0.002)], branch_uncertainty=False
    ).states
    lam = state.quantities["lam_pole"].value
    assert 4 * (1 / lam - 1 / lam**7) == pytest.approx(0.002, rel=1e-7)
