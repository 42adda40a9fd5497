"""The hemisphere that holds a liquid: the numbers of one state are consistent."""

import numpy as np
import pytest

from weakforms.api import solve_requests
from weakforms.problems.problem import StateRequest

COARSE = {"cells": 8, "degree": 3}


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
        coarse = {"cells": 4, "degree": 4, "levels": 2}
        (state,) = solve_requests("hemisphere", given, coarse, wanted, branch_uncertainty=False).states
        found[energy] = {name: q.value for name, q in state.quantities.items()}
    assert found["modified_gradient"] == pytest.approx(found["relaxed"], rel=1e-9)
    assert found["standard"]["V"] > 1.05 * found["relaxed"]["V"]
    assert found["standard"]["Lambda_n10_1"] < 0 < found["relaxed"]["Lambda_n10_1"]
