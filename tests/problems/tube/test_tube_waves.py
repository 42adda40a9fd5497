"""The free tube's stability against waves: operators, special points, counts, refusals."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import InputError, solve
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.tube.model import TubeMesh, TubeModel, free_branch
from weakforms.problems.tube.stability import TubeBranch
from weakforms.problems.tube.waves import EVEN, ODD, TubeModes, Wave
from weakforms.results import validate
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import rated
from weakforms.solvers.stability.spectra import Stability

pytestmark = pytest.mark.paper2
MESH = {"cells": 48, "levels": 2}
LONG_STEPS = MESH | {"step": 0.2}
NEO = {"alpha": 0.0, "delta1": 1.0, "lf": 6.0}


@pytest.fixture(scope="module")
def neo():
    return solve(
        "tube", **NEO, n=(0, 1, 2), u_end=2.0, at=[("u_max", 1.2), ("bifurcation_n1", 1)], numerics=MESH
    )


@pytest.fixture(scope="module")
def branch():
    model = TubeModel.free(MPI.COMM_SELF, mooney_rivlin_of(0.0), 1.0, 6.0, TubeMesh(24, 4, 0.6))
    modes = TubeModes(model, (0, 1, 2), full=False)
    return free_branch(model.system, 1.0, 1.8, 0.1, lambda *given: TubeBranch(*given, modes))


def test_the_neo_hookean_tube_bends_after_its_limit_point(neo):
    kinds = [point.kind for point in neo.special_points]
    assert kinds == ["limit_point", "bifurcation_n1", "mirror_breaking", "wrinkling_onset", "bifurcation_n1"]
    assert neo.special_points[2].values["p"] == pytest.approx(1.5636, abs=5e-5)  # known before
    volumes = [point.values["V"] for point in neo.special_points]
    assert volumes == sorted(volumes)
    bends, straight = (neo.points("bifurcation_n1")[k].values for k in (0, 1))
    assert (bends["n"], bends["parity"], bends["direction"], bends["wrinkled"]) == (1, 1, 1, 0)
    assert (straight["direction"], straight["wrinkled"]) == (-1, 1)
    validate(neo.to_json())


def test_numbers_of_its_special_points_are_described(neo):
    named = {name for point in neo.special_points for name in point.values}
    assert {"n", "parity", "direction"} <= named
    assert named - neo.scales.keys() <= {"n_negative"}


def test_the_eigenvalue_is_zero_at_the_bifurcation_point(neo):
    state = neo.states[1].quantities
    assert abs(state["Lambda_n1_1"].value) < 1e-8
    assert state["Lambda_n2_1"].value > 0.1


def test_counts_agree_with_eigenvalues_along_the_branch(neo):
    columns = neo.branch().columns
    for n in (0, 1, 2):
        lowest = np.array([columns[f"Lambda_n{n}_{k}"] for k in (1, 2, 3)])
        clear = np.abs(lowest).min(axis=0) > 1e-9  # at the limit point one is zero
        assert ((lowest < 0).sum(axis=0) == columns[f"n_negative_n{n}"])[clear].all()


def test_a_held_volume_removes_the_limit_points_eigenvalue(neo):
    columns, limit = neo.branch().columns, neo.points("limit_point")[0].values["V"]
    beyond = columns["V"] > limit + 1e-9
    away = np.abs(columns["V"] - limit) > 1e-9
    removed = columns["n_negative_n0"] - columns["n_negative_volume"]
    assert (removed == beyond)[away].all()


def test_inertia_at_fixed_volume_is_that_of_the_bordered_operator(branch):
    for point in branch.points[::6]:
        system = branch.system
        with system.at(point.state):
            counted = rated(system, Factorization(system), "p").count_at_fixed
            border = system.load_derivative("p")
            with system.weighed_here():
                bordered = Stability(system).bordered(system.state(), border, 0.0)
        assert counted == bordered.n_negative


def test_axisymmetric_waves_of_a_pre_stretched_tube_are_those_of_its_equations():
    """With ``n = 0`` the energy in space must give the second variation of the axisymmetric energy."""
    model = TubeModel.free(MPI.COMM_SELF, mooney_rivlin_of(0.1), 1.4, 6.0, TubeMesh(16, 4, 0.6))
    modes = TubeModes(model, (0,), full=False)
    branch = free_branch(model.system, 1.4, 1.2, 0.2, lambda *given: TubeBranch(*given, modes))
    with model.system.at(branch.points[-1].state):
        own = Stability(model.system).spectrum(model.system.state(), 4).eigenvalues
        waves = modes.variation(Wave(0, EVEN)).spectrum(4).eigenvalues
    assert waves == pytest.approx(own, rel=1e-8)


def test_compression_begins_inside(neo):
    onset = neo.points("wrinkling_onset")[0].values
    assert abs(onset["t_min"]) < 1e-9
    assert 2.9 < onset["Z_t_min"] < 2.99
    columns = neo.branch().columns
    assert (columns["wrinkled"] == (columns["V"] > onset["V"])).all()


def test_a_whole_tube_has_the_waves_of_both_parities(neo):
    whole = solve("tube", **NEO, n=(0, 1), extent="full", u_end=1.4, at={"u_max": 1.2}, numerics=LONG_STEPS)
    kinds = [point.kind for point in whole.special_points]
    assert kinds == ["limit_point", "bifurcation_n1", "bifurcation_point"]
    for kind, other in (("bifurcation_n1", "bifurcation_n1"), ("bifurcation_point", "mirror_breaking")):
        assert whole.points(kind)[0].values["p"] == pytest.approx(neo.points(other)[0].values["p"], abs=1e-7)
    here, there = whole.states[0].quantities, neo.states[0].quantities
    for name in (f"Lambda_n{n}_{k}" for n in (0, 1) for k in (1, 2, 3)):
        assert here[name].value == pytest.approx(there[name].value, abs=2e-6)
    for name in ("n_negative_n0", "n_negative_n1", "n_negative_volume"):
        assert here[name].value == there[name].value


@pytest.mark.parametrize("wave", [Wave(1, EVEN), Wave(2, ODD), Wave(0, ODD)], ids=str)
def test_operators_are_symmetric_with_exact_derivatives(branch, wave):
    """The row of a critical point is the derivative of ``v' K v`` with respect to the state and the load."""
    system, point = branch.system, branch.points[len(branch.points) // 2]
    rng = np.random.default_rng(2)

    def form(u, p, a, b):
        with system.at(State(u, point.state.loads | {"p": p})):
            variation = branch.modes.variation(wave)
            return variation.dot(a, variation.multiply(variation.tangent(), b))

    with system.at(point.state):
        variation = branch.modes.variation(wave)
        v, w = rng.standard_normal((2, variation.size))
        v[variation.bc_dofs] = w[variation.bc_dofs] = 0.0
        row, loads = variation.quadratic_gradient(v, ["p"])
    u, p = point.state.u, point.state.loads["p"]
    assert form(u, p, v, w) == pytest.approx(form(u, p, w, v), rel=1e-10)
    direction, h = rng.standard_normal(len(u)), 1e-6
    direction[system.bc_dofs] = 0.0
    slope = (form(u + h * direction, p, v, v) - form(u - h * direction, p, v, v)) / (2 * h)
    assert system.dot(row, direction) == pytest.approx(slope, rel=1e-5)
    slope = (form(u, p + 1e-3, v, v) - form(u, p - 1e-3, v, v)) / 2e-3
    assert loads["p"] == pytest.approx(slope, rel=1e-8)


@pytest.mark.parametrize(
    ("given", "first"),
    [
        ({"alpha": 0.0, "lf": 10.0, "u_end": 1.0}, "bifurcation_n1"),
        ({"alpha": 0.1, "lf": 10.0, "u_end": 1.2}, "bifurcation_n1"),
        ({"alpha": 0.1, "lf": 6.0, "u_end": 1.2}, "limit_point"),
    ],
    ids=str,
)
def test_long_tubes_bend_before_their_limit_point(given, first):
    result = solve("tube", **given, n=1, numerics=LONG_STEPS)
    assert result.special_points[0].kind == first
    assert result.failures == []


def test_without_wave_numbers_nothing_changes():
    plain = solve("tube", alpha=0.1, delta1=1.1, u_end=1.6, numerics=LONG_STEPS)
    waves = solve("tube", alpha=0.1, delta1=1.1, u_end=1.6, n=(1,), numerics=LONG_STEPS)
    assert set(plain.branch().columns) < set(waves.branch().columns)
    assert "t_min" not in plain.branch().columns
    one, other = (r.points("limit_point")[0].values for r in (plain, waves))
    assert one["p"] == pytest.approx(other["p"], abs=1e-10)


@pytest.mark.slow
def test_another_law_bends_too():
    result = solve("tube", model="ogden", lf=10.0, u_end=1.2, n=(1,), numerics=LONG_STEPS)
    assert result.special_points[0].kind in ("bifurcation_n1", "limit_point")
    assert result.points("bifurcation_n1")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"n": 1, "contact": "frictionless"}, "n = 1 with contact = 'frictionless': .* set contact = 'none'"),
        ({"n": 7}, "whole numbers from 0 to 6 are wanted"),
        ({"n": 1.5}, "whole numbers from 0 to 6 are wanted"),
        ({"n": -1}, "whole numbers from 0 to 6 are wanted"),
        ({"n": 1, "model": "three_chain"}, "waves around the axis: model = 'three_chain'; allowed: "),
        ({"n": 1, "at": {"Lambda_n2_1": 0.0}}, "Lambda_n2_1"),
        ({"n": 1, "at": {"n_negative_n1": 1}}, "n_negative_n1"),
        ({"n": 1, "at": {"bifurcation_n1": 1.5}}, "must be a whole number from 1"),
    ],
    ids=str,
)
def test_what_is_refused_before_anything_is_solved(given, words):
    with pytest.raises(InputError, match=words):
        solve("tube", **given)
