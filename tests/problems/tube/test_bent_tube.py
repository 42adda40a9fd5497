"""Bent states of the free tube: the surface, its crossing, the expansion there, branch, refusals."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import InputError, solve
from weakforms.problems.problem import Requests, Task
from weakforms.problems.tube.parameters import SecondaryNumerics, TubeParameters
from weakforms.problems.tube.problem import Tube
from weakforms.problems.tube.secondary.bent import AMPLITUDE
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

pytestmark = pytest.mark.paper2
SURFACE = {"secondary_cells": 8, "secondary_around": 4, "secondary_degree": 4}
COARSE = {"cells": 32, "levels": 2, "step": 0.2, **SURFACE}
BENDING = {"alpha": 0.0, "lf": 10.0, "u_end": 0.8, "secondary": True, "secondary_n": 1}


@pytest.fixture(scope="module")
def families():
    given, numerics = TubeParameters(**BENDING), SecondaryNumerics(**COARSE)
    return Tube().families(Task(given, numerics, Requests(), MPI.COMM_SELF, lambda *_: None))


@pytest.fixture(scope="module")
def branch(families):
    return families["secondary"].fine


def quadratic(system, state, phi):
    """``φᵀ K φ`` at a state."""
    with system.at(state):
        return system.dot(phi, system.multiply(system.tangent(), phi))


def test_an_axisymmetric_state_is_that_of_the_meridian(families, branch):
    meridian = families["primary"].fine.at("u_max", 0.5)
    state, _ = ExtendedNewton(branch.system, ["p"]).solve(branch.crossed[0].state, [Held("u_max", 0.5)])
    surface = branch.solved(state)
    for name in ("p", "V", "Pi"):
        assert surface.values[name] == pytest.approx(meridian.values[name], rel=1e-5)
    assert abs(surface.values[AMPLITUDE]) < 1e-12


def test_the_surface_is_neutral_where_a_wave_of_the_meridian_is(families):
    there = [same[-1] for same in families["primary"].located("bifurcation_n1")]
    crossing = families["secondary"].special_points()[0]
    assert crossing.kind == "bifurcation_n1"
    for name in ("p", "V", "u_max"):
        assert abs(crossing.values[name] - there[0].values[name]) < crossing.uncertainty[name]


def test_the_gas_does_work_on_the_volume(branch):
    state, system, h = branch.points[-1].state, branch.system, 1e-4
    more, less = (State(state.u, {"p": state.loads["p"] + s * h}) for s in (1, -1))
    found = []
    for moved in (more, less):
        with system.at(moved):
            found.append(system.monitor("Pi"))
    assert (found[0] - found[1]) / (2 * h) == pytest.approx(-branch.points[-1].monitors["V"], rel=1e-9)


def test_the_potential_falls_along_the_branch_by_the_volume_times_the_pressure(branch):
    p, v, potential = (branch.over_points(name) for name in ("p", "V", "Pi"))
    work = np.diff(p) * (v[1:] + v[:-1]) / 2
    assert np.diff(potential) == pytest.approx(-work, rel=1e-2)


def test_the_coefficients_are_those_of_differences_of_the_second_variation(branch):
    system, e, h = branch.system, branch.expansion, 1e-2
    moved = [State(e.state.u + s * h * e.mode, e.state.loads) for s in (-1, 0, 1)]
    less, here, more = (quadratic(system, state, e.mode) for state in moved)
    with system.at(e.state):
        fourth = system.quartic(e.mode)
    assert fourth == pytest.approx((less - 2 * here + more) / h**2, rel=1e-3)
    assert abs(e.quadratic) < 1e-8 * abs(e.cubic)


def test_solved_states_leave_the_expansion_with_the_fourth_power(branch):
    e, solver = branch.expansion, ExtendedNewton(branch.system, ["p"])
    left = []
    for amplitude in (0.1, 0.2):
        state, _ = solver.solve(e.predicted(amplitude), [Held(AMPLITUDE, amplitude)])
        left.append(state.loads["p"] - e.predicted(amplitude).loads["p"])
    assert left[1] / left[0] == pytest.approx(16, abs=0.5)


def test_bent_states_are_stable_if_the_volume_is_held(families):
    columns = families["secondary"].branch().columns
    assert set(columns["n_negative"]) == {1}
    assert set(columns["n_negative_volume"]) == {0}


def test_a_profile_has_both_meridians_of_the_plane_of_bending(families):
    state = families["secondary"].state("V", 6.2, profile=np.linspace(0, 5, 11))
    columns = state.fields[0].columns
    assert columns["Z"].tolist() == [*np.linspace(0, 5, 11)] * 2
    outer, inner = columns["rho"][:11], columns["rho"][11:]
    assert outer[0] - inner[0] == pytest.approx(2 * state.quantities[AMPLITUDE].value, rel=0.05)
    assert (outer[-1], inner[-1]) == pytest.approx((1.0, 1.0), abs=1e-12)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"extent": "full"}, "set extent = 'half', or secondary_n = 0"),
        ({"contact": "frictionless"}, "set contact = 'none'"),
    ],
)
def test_bent_states_of_other_tubes_are_refused(given, message):
    with pytest.raises(InputError, match=message):
        solve("tube", **BENDING | given)


def test_a_wave_number_without_a_point_is_absent():
    found = solve("tube", **BENDING | {"secondary_n": 2}, numerics=COARSE)
    assert [branch.name for branch in found.branches] == ["primary"]
    assert "no point at which even waves of n = 2 are neutral" in found.absent[0].reason


def test_the_stability_that_comes_with_it():
    assert TubeParameters(**BENDING).stability == (1,)
    assert TubeParameters(**BENDING, n=(0, 2)).stability == (1, 0, 2)
