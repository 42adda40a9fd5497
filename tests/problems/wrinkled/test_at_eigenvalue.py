"""States asked for by the value of an eigenvalue of waves."""

import pytest

from weakforms import InputError, solve
from weakforms.api import solve_requests
from weakforms.problems.problem import StateRequest

pytestmark = pytest.mark.paper4
TUBE = {"M": 1.5, "delta": 2.0, "Af": 0.6, "load_end": 5.3, "numerics": {"cells": 6, "levels": 2}}


def with_states(problem, given, *wanted):
    """A solve that leaves out the uncertainties of the branch, which take most of its time."""
    rest = {name: value for name, value in given.items() if name != "numerics"}
    requests = [StateRequest(*one) for one in wanted]
    return solve_requests(problem, rest, given["numerics"], requests, branch_uncertainty=False)


@pytest.mark.slow
def test_a_state_is_solved_for_at_the_value_of_an_eigenvalue():
    result = with_states("wrinkled_tube", TUBE | {"n": [2]}, ("Lambda_n2_2", 0.3))
    (state,) = result.states
    found = state.quantities["Lambda_n2_2"]
    assert found.value == pytest.approx(0.3, abs=1e-9)
    load = state.quantities["zw"]
    assert 0 < load.uncertainty < 1e-7
    assert "Z_front_1" in state.quantities
    same = with_states("wrinkled_tube", TUBE | {"n": [2]}, ("zw", load.value)).states[0].quantities
    assert same["Lambda_n2_2"].value == pytest.approx(0.3, abs=1e-9)
    assert same["V"].value == pytest.approx(state.quantities["V"].value, rel=1e-9)


@pytest.mark.slow
def test_an_eigenvalue_that_jumps_over_a_value_has_no_state_there():
    """Where the taut zone opens at ``zw = 5.079``, the lowest eigenvalue jumps from 0.185 to 0.264."""
    result = with_states("wrinkled_tube", TUBE | {"n": [2]}, ("Lambda_n2_1", 0.22, "all"))
    (state,), (failure,) = result.states, result.failures
    assert state.quantities["zw"].value < 5.0
    assert "Lambda_n2_1 jumps over 0.22 at zw = 5.079" in failure.reason


@pytest.mark.parametrize(("n", "listed"), [([3], "Lambda_n3_1, Lambda_n3_2, Lambda_n3_3"), ([], "none")])
@pytest.mark.parametrize("problem", ["wrinkled_tube", "hemisphere"])
def test_an_eigenvalue_that_is_not_computed_is_refused_with_those_that_are(problem, n, listed):
    with pytest.raises(InputError, match=rf"'Lambda_n2_1'; allowed eigenvalues: {listed} \(n = "):
        solve(problem, n=n, at={"Lambda_n2_1": 0.0})


def test_a_value_that_an_eigenvalue_never_has_is_refused_with_its_range():
    with pytest.raises(InputError, match=r"Lambda_n2_1 = 9 is not taken .* ranges over \[0\.18"):
        with_states("wrinkled_tube", TUBE | {"n": [2]}, ("Lambda_n2_1", 9.0))


def test_a_hemisphere_at_the_value_of_an_eigenvalue_is_that_at_its_level():
    given = {"n": [2], "low_end": -0.85, "numerics": {"cells": 4, "levels": 2, "step": 0.2}}
    (level,) = with_states("hemisphere", given, ("zw", -0.6)).states
    eigenvalue = level.quantities["Lambda_n2_1"].value
    (state,) = with_states("hemisphere", given, ("Lambda_n2_1", eigenvalue)).states
    assert state.quantities["zw"].value == pytest.approx(-0.6, abs=1e-7)
    assert state.quantities["zw"].uncertainty < 1e-5
