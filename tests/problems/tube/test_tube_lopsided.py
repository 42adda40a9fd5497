"""Lopsided states of the free tube: expansion at the crossing, branch, ends, stability, refusals."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import ConvergenceError, InputError, solve
from weakforms.problems.problem import Requests, Task
from weakforms.problems.tube.parameters import TubeNumerics, TubeParameters
from weakforms.problems.tube.problem import Tube
from weakforms.problems.tube.secondary.lopsided import AMPLITUDE
from weakforms.solvers.continuation.expansion import Expansion
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

pytestmark = pytest.mark.paper2
COARSE = {"cells": 16, "levels": 2, "step": 0.2}
WHOLE = {"extent": "full", "secondary": True}


@pytest.fixture(scope="module")
def joining():
    """A tube whose lopsided branch begins and ends on free inflation."""
    return solve("tube", alpha=0.07, u_end=3.0, **WHOLE, numerics=COARSE, at=[("u_max", 2.3)])


@pytest.fixture(scope="module")
def families():
    given = TubeParameters(alpha=0.05, u_end=1.8, **WHOLE)
    numerics = TubeNumerics(**COARSE)
    return Tube().families(Task(given, numerics, Requests(), MPI.COMM_SELF, lambda *_: None))


@pytest.fixture(scope="module")
def branch(families):
    return families["secondary"].fine


def quadratic(system, state, phi):
    """``φᵀ K φ`` at a state."""
    with system.at(state):
        return system.dot(phi, system.multiply(system.tangent(), phi))


def test_the_coefficients_are_those_of_differences_of_the_second_variation(branch):
    system, e, h = branch.system, branch.expansion, 1e-3
    moved = [State(e.state.u + s * h * e.mode, e.state.loads) for s in (-1, 0, 1)]
    less, here, more = (quadratic(system, state, e.mode) for state in moved)
    with system.at(e.state):
        third, _ = system.quadratic_gradient(e.mode, ("p",))
        fourth = system.quartic(e.mode)
    assert fourth == pytest.approx((less - 2 * here + more) / h**2, rel=1e-4)
    assert e.cubic == pytest.approx(fourth / 6 + system.dot(third, e.curvature), rel=1e-12)
    h = 1e-4  # the state moves far with the pressure
    along = [
        State(e.state.u + s * h * e.along, e.state.loads | {"p": e.state.loads["p"] + s * h}) for s in (-1, 1)
    ]
    below, above = (quadratic(system, state, e.mode) for state in along)
    assert e.linear == pytest.approx((above - below) / (2 * h), rel=1e-4)
    assert abs(e.quadratic) < 1e-8 * e.cubic


def test_the_expansion_does_not_depend_on_the_sense_of_the_mode(branch):
    e, far = branch.expansion, 0.02
    here, mirrored = (e.predicted(amplitude) for amplitude in (far, -far))
    assert here.loads["p"] == mirrored.loads["p"] == e.state.loads["p"] + e.load_2 * far**2


def test_solved_states_leave_the_expansion_with_the_fourth_power(branch):
    e, solver = branch.expansion, ExtendedNewton(branch.system, ["p"])
    left = []
    for amplitude in (0.02, 0.04):
        state, _ = solver.solve(e.predicted(amplitude), [Held(AMPLITUDE, amplitude)])
        left.append(state.loads["p"] - e.predicted(amplitude).loads["p"])
    assert left[1] / left[0] == pytest.approx(16, abs=0.5)


def test_the_expansion_is_refused_where_a_mode_breaks_no_symmetry(families):
    primary = families["primary"]
    limit = primary.located("limit_point")[0][-1]
    with pytest.raises(ConvergenceError, match="no symmetry"):
        Expansion.at(primary.fine.solver, limit.state, "p", "u_max")


def test_the_branch_begins_at_the_crossing_and_moves_to_one_end(families):
    primary, secondary = families["primary"], families["secondary"]
    crossing = primary.located("bifurcation_point")[0][-1]
    first, *others = secondary.fine.points
    assert first.state is crossing.state
    assert abs(first.monitors[AMPLITUDE]) < 1e-9
    assert min(point.monitors[AMPLITUDE] for point in others) > 0
    assert AMPLITUDE not in primary.fine.shown
    assert AMPLITUDE in secondary.fine.shown


def test_its_states_are_stable_if_the_volume_is_held(joining):
    columns = joining.branch("secondary").columns
    assert set(columns["n_negative"]) == {1}
    assert set(columns["n_negative_volume"]) == {0}


def test_a_branch_that_becomes_symmetric_again_ends_on_free_inflation(joining):
    branch, points = joining.branch("secondary"), joining.points("mirror_breaking")
    crossings = joining.points("bifurcation_point")
    assert branch.ended.by == "primary"
    assert [p.branch for p in points] == ["secondary", "secondary"]
    for name in ("p", "V", "u_max"):
        assert [p.values[name] for p in points] == [p.values[name] for p in crossings]
    assert not [p for p in joining.points("limit_point") if p.branch == "secondary"]
    assert points[0].values["p_2"] == pytest.approx(-points[0].values["A3"] / points[0].values["A1"])
    assert "p_2" not in points[1].values
    assert np.abs(branch.columns[AMPLITUDE][[0, -1]]).max() < 1e-8


def test_a_crossing_that_is_not_there_is_absent_and_one_line_if_it_is_asked_for():
    given = {"alpha": 0.0, "u_end": 0.6, **WHOLE, "numerics": COARSE}
    found = solve("tube", **given)
    assert [branch.name for branch in found.branches] == ["primary"]
    assert "no point at which the mirror symmetry breaks" in found.absent[0].reason
    with pytest.raises(InputError, match="secondary_from = 1: free inflation up to u_max"):
        solve("tube", **given, at={"w_mid": 0.1}, branch="secondary")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"secondary": True}, "set extent = 'full'"),
        ({"secondary": True, "extent": "full", "contact": "frictionless"}, "set contact = 'none'"),
        ({"secondary": True, "contact": "adhesive", "phase": "deflation"}, "set contact = 'none'"),
    ],
)
def test_lopsided_states_of_other_tubes_are_refused(given, message):
    with pytest.raises(InputError, match=message):
        solve("tube", **given)


def test_a_state_of_the_branch_needs_the_branch():
    with pytest.raises(InputError, match="only with secondary = true"):
        solve("tube", at={"p": 1.5}, branch="secondary")


def test_the_stability_that_comes_with_it():
    assert TubeParameters(**WHOLE).stability == (0,)
    assert TubeParameters(**WHOLE, n=(1, 2)).stability == (0, 1, 2)
    assert TubeParameters(n=(1,)).stability == (1,)
