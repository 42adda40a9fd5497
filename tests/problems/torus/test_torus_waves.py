"""Waves around the inflated torus: rigid motions, held at the outer equator; lost symmetries."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import InputError, solve
from weakforms.problems.branch_problem import from_rest
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.meridian.families import EVEN, ODD, Wave
from weakforms.problems.meridian.waves import HOOP
from weakforms.problems.torus.model import TorusModel
from weakforms.problems.torus.waves import AT_EQUATORS, TorusModes
from weakforms.results import validate
from weakforms.solvers.continuation.continuation import Continuation
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

COARSE = {"cells": 16, "levels": 2}
RIGID = {
    Wave(0, ODD): lambda r, z: (0 * r, 0 * r, 0 * r + 1),
    Wave(1, EVEN): lambda r, z: (0 * r + 1, 0 * r - 1, 0 * r),
    Wave(1, ODD): lambda r, z: (z, -z, -r),
}
"""A shift along the axis, one across it, and a tilt about a line across it: ``(u, q, w)``."""


@pytest.fixture(scope="module")
def state():
    """A model lent to a state under gas, with its modes."""
    model = TorusModel(MPI.COMM_SELF, mooney_rivlin_of(0.1), 0.4, 24, 5)
    solver = ExtendedNewton(model.system, ["p"])
    begin = State(model.system.initial.u, {"p": 0.3})
    start = Continuation(solver).start(begin, Held("p", 0.3), towards={"p": 1.0})
    return TorusModes(model, (0, 1, 2, 3)), start.state


def free(modes, wave):
    """The operator of a torus that may move as a rigid body."""
    mirror = AT_EQUATORS[wave.parity]
    return modes.waves.operator(wave.n, mirror, mirror, () if wave.n else (HOOP,))


def dense(matrix):
    """All entries."""
    rows, columns, values = matrix.getValuesCSR()
    out = np.zeros(matrix.getSize())
    for i in range(len(out)):
        out[i, columns[rows[i] : rows[i + 1]]] = values[rows[i] : rows[i + 1]]
    return out


@pytest.mark.parametrize("wave", RIGID, ids=str)
def test_a_rigid_motion_is_in_equilibrium_and_the_held_torus_cannot_move_so(state, wave):
    modes, at = state
    model = modes.model
    t = np.pi * model.space.tabulate_dof_coordinates()[:, 0]
    u, w = at.u.reshape(-1, 2).T
    motion = np.column_stack(RIGID[wave]((1 + 0.4 * np.cos(t)) * (1 + u), 0.4 * np.sin(t) + w)).ravel()
    with model.system.at(at):
        operator = free(modes, wave)
        matrix = dense(operator.tangent())
        nearest = operator.nearest()
        held = modes.variation(wave).spectrum(2).eigenvalues
    assert np.abs(matrix @ motion).max() < 1e-9 * np.abs(matrix).max()
    assert abs(nearest.eigenvalue) < 1e-9
    assert held[0] > 0.1


@pytest.mark.parametrize("wave", RIGID, ids=str)
def test_the_held_torus_has_the_negative_eigenvalues_of_the_free_one(wave):
    """Far beyond the first bifurcation, where one of even waves of n = 1 is negative."""
    model = TorusModel(MPI.COMM_SELF, mooney_rivlin_of(0.0), 0.4, 16, 5)
    begin = State(model.system.initial.u, {"p": 0.3})
    at = from_rest(model.system, "p", "v", 4.0, 0.4, begin=begin, usual_load=10.0).points[-1].state
    modes = TorusModes(model, (0, 1))
    with model.system.at(at):
        count = modes.variation(wave).negative_count()
        assert free(modes, wave).negative_count(1e-6) == count
    assert count == int(wave == Wave(1, EVEN))


@pytest.fixture(scope="module")
def inflated():
    at = [("V", 10.0), ("bifurcation_n1", 1)]
    return solve("torus", b=0.4, alpha=0.0, v_end=4.0, n=(0, 1, 2), at=at, numerics=COARSE)


def test_it_swells_to_one_side_after_its_limit_point(inflated):
    kinds = [point.kind for point in inflated.special_points]
    assert kinds == ["limit_point", "bifurcation_n1", "bifurcation_n2"]
    values = inflated.special_points[1].values
    assert (values["n"], values["parity"], values["direction"]) == (1, 1, 1)
    assert abs(inflated.states[1].quantities["Lambda_n1_1"].value) < 1e-8
    validate(inflated.to_json())


def test_numbers_of_its_special_points_are_described(inflated):
    named = {name for point in inflated.special_points for name in point.values}
    assert named - inflated.scales.keys() <= {"n_negative"}


def test_counts_agree_with_eigenvalues_and_a_held_volume_removes_one(inflated):
    columns = inflated.branch().columns
    for n in (0, 1, 2):
        lowest = np.array([columns[f"Lambda_n{n}_{k}"] for k in (1, 2, 3)])
        clear = np.abs(lowest).min(axis=0) > 1e-9
        assert ((lowest < 0).sum(axis=0) == columns[f"n_negative_n{n}"])[clear].all()
    assert set(columns["n_negative_n0"]) == {0, 1}
    assert set(columns["n_negative_volume"]) == {0}


def test_the_branch_is_that_without_waves(inflated):
    plain = solve("torus", b=0.4, alpha=0.0, v_end=4.0, at={"V": 10.0}, numerics=COARSE)
    for name, quantity in plain.states[0].quantities.items():
        assert inflated.states[0].quantities[name].value == pytest.approx(quantity.value, rel=1e-9, abs=1e-9)


def test_points_beyond_the_end_are_not_listed():
    found = solve("torus", b=0.4, alpha=0.0, v_end=3.33, n=1, numerics=COARSE | {"step": 0.4})
    assert [point.kind for point in found.special_points] == ["limit_point"]


def test_eigenvalues_of_other_wave_numbers_are_refused():
    with pytest.raises(InputError, match="Lambda_n2_1"):
        solve("torus", n=(0, 1), at={"Lambda_n2_1": 0.0})
