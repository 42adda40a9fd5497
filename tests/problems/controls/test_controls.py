"""Inflation under given pressure, mass of gas and volume: closed forms of the sphere, and eigenvalues."""

import numpy as np
import pytest
from mpi4py import MPI
from scipy.sparse import csr_matrix

from weakforms import solve
from weakforms.api import solve_requests
from weakforms.errors import InputError
from weakforms.problems.controls.branch import ControlledBranch
from weakforms.problems.controls.problem import ControlsParameters
from weakforms.problems.diagram.bodies.varied import VariedDisk, VariedTube
from weakforms.problems.gas import Gas
from weakforms.problems.tube.problem import order_at_middle
from weakforms.solvers.stability.spectra import Stability

MESH = {"cells": 48, "levels": 2}


def largest_reservoir(kappa, p_atm, lam_end):
    """``min of kappa (p + p_atm) (-dV/dp) - V`` of a neo-Hookean sphere where the pressure falls."""
    lam = np.linspace(7 ** (1 / 6) + 1e-6, lam_end, 400_001)
    p, slope = 4 * (1 / lam - 1 / lam**7), 4 * (-1 / lam**2 + 7 / lam**8)
    volume, rate = 2 * lam**3 / 3, 2 * lam**2
    return float((kappa * (p + p_atm) * (-rate / slope) - volume).min())


@pytest.mark.parametrize(
    ("kappa", "p_atm"),
    [(1.0, 1.0), (1.0, 0.0), pytest.param(1.4, 1.0, marks=pytest.mark.slow), (1.4, 30.0)],
)
def test_a_sphere_is_stable_at_given_mass_up_to_the_closed_form_of_the_reservoir(kappa, p_atm):
    critical = largest_reservoir(kappa, p_atm, 4.0)
    gas = {"body": "sphere", "alpha": 0.0, "kappa": kappa, "p_atm": p_atm}
    below, above = (
        solve_requests("controls", gas | {"V_r": share * critical}, {}, [], branch_uncertainty=False)
        for share in (0.99, 1.02)
    )
    assert below.points("mass_fold") == []
    assert not below.branch().columns["n_fixed_m"].any()
    assert len(above.points("mass_fold")) >= 1
    assert above.branch().columns["n_fixed_m"].max() == 1
    for result in (below, above):  # the pressure falls past 7^(1/6), and the volume never does
        columns = result.branch().columns
        assert np.all((columns["n_negative"] == 1) == (columns["lam"] > 7 ** (1 / 6)))
        assert not columns["n_fixed_V"].any()


def test_extrema_of_the_mass_are_those_of_the_closed_form():
    found = solve("controls", body="sphere", alpha=0.0, V_r=20.0).points("mass_fold")
    for point in found:
        lam = point.values["lam"]
        p, slope = 4 * (1 / lam - 1 / lam**7), 4 * (-1 / lam**2 + 7 / lam**8)
        assert (p + 1) * 2 * lam**2 + (2 * lam**3 / 3 + 20) * slope == pytest.approx(0.0, abs=1e-9)
        assert point.values["m"] == pytest.approx((p + 1) * (2 * lam**3 / 3 + 20), rel=1e-12)
    assert len(found) == 2


def test_steps_grow_with_the_pressure_of_a_sphere_that_stiffens():
    """With steps of one length the branch did not end within 3000 points."""
    law = {"model": "beda_chevalier", "k1": 0.1724, "k2": 0.5025, "k3": 0.001816, "power": 9.244}
    given = {"body": "sphere", **law, "lam_end": 6.2}
    result = solve_requests("controls", given, {}, [], branch_uncertainty=False)
    assert result.failures == []
    assert result.branch().ended.by == "lam_end"
    assert result.branch().columns["p"][-1] > 300


def branch_of(body, gas, lf=6.0):
    given = ControlsParameters(alpha=0.0)
    if body == "tube":
        model = VariedTube(MPI.COMM_WORLD, given.material, {"delta1": 1.0, "lf": lf}, 16, 3, 0.6)
    else:
        model = VariedDisk(MPI.COMM_WORLD, given.material, {"beta": 1.0}, 16, 3, 0.0)
    end, along = (2.0, "u_max") if body == "tube" else (1.5, "t0")
    return model.primary(end, 0.2, lambda *args: ControlledBranch(*args, gas, along))


@pytest.mark.parametrize("body", ["tube", "circular"])
@pytest.mark.parametrize("gas", [Gas(1.0, 1.0, 5.0), Gas(1.4, 0.0, 40.0), Gas(1.0, 2.0, 1000.0)])
def test_counts_are_those_of_the_eigenvalues_of_the_second_variation_at_given_mass(body, gas):
    branch = branch_of(body, gas)
    seen = set()
    for point in branch.points[2::2]:
        with branch.system.at(point.state):
            force, volume = branch.system.load_derivative("p"), branch.system.monitor("V")
        stiffness = gas.kappa * (point.state.loads["p"] + gas.p_atm) / (volume + gas.reservoir)
        spectrum = Stability(branch.system).bordered(point.state, force, 1 / stiffness)
        count = branch.counts(point.state)
        assert sum(value < 0 for value in spectrum.eigenvalues) == count["n_fixed_m"]
        assert count["n_fixed_V"] <= count["n_fixed_m"] <= point.n_negative
        seen.add(count["n_fixed_m"])
    assert seen == ({0, 1} if gas.reservoir == 1000.0 else seen)


def negatives(matrix):
    return int(np.sum(np.linalg.eigvalsh(matrix) < 0))


@pytest.mark.parametrize(("body", "lf"), [("tube", 6.0), ("tube", 20.0), ("circular", 6.0)])
def test_counts_are_those_of_full_matrices(body, lf):
    """``K``, ``K`` on the displacements that keep the volume, and ``K + s d d^T``, as dense matrices."""
    gas, seen = Gas(1.3, 0.7, 3.0), set()
    branch = branch_of(body, gas, lf)
    system = branch.system
    free = np.setdiff1d(np.arange(system.size), system.bc_dofs)
    for point in branch.points[1::2]:
        with system.at(point.state):
            rows, columns, values = system.tangent().getValuesCSR()
            stiffness = csr_matrix((values, columns, rows)).toarray()[np.ix_(free, free)]
            d, volume = -system.load_derivative("p")[free], system.monitor("V")
        keeping = np.linalg.svd(d[None])[2][1:].T
        rate = gas.kappa * (point.state.loads["p"] + gas.p_atm) / (volume + gas.reservoir)
        counts = branch.counts(point.state)
        assert counts["n_fixed_V"] == negatives(keeping.T @ stiffness @ keeping)
        assert counts["n_fixed_m"] == negatives(stiffness + rate * np.outer(d, d))
        assert point.n_negative == negatives(stiffness)
        seen.add(counts["n_fixed_V"])
    assert seen == ({0, 1} if lf == 20.0 else {0})


def test_a_long_tube_is_unstable_at_given_volume_between_two_extrema_of_the_volume():
    gas = Gas(1.0, 1.0, 5.0)
    branch = branch_of("tube", gas, lf=20.0)
    first, second = (at for at in branch.special() if at.kind == "volume_fold")
    volumes = np.array([point.monitors["V"] for point in branch.points])
    places = np.array([point.monitors["u_max"] for point in branch.points])
    between = (places > first.values["u_max"]) & (places < second.values["u_max"])
    counts = [branch.counts(point.state)["n_fixed_V"] for point in branch.points]
    assert np.array_equal(counts, between)
    assert np.all(np.diff(volumes[between]) < 0)
    assert first.values["V"] > volumes[between].max()
    assert second.values["V"] < volumes[between].min()
    for at in (first, second):  # the eigenvalue that is zero there does not count
        assert branch.counts(at.state)["n_fixed_V"] == 0


def test_a_state_at_the_limit_point_of_a_sphere_is_answered():
    """Its second variation is zero to the last digit."""
    found = solve("controls", body="sphere", alpha=0.0, V_r=20.0, at={"limit_point": 1})
    assert found.failures == []
    counts = found.states[0].quantities
    assert [counts[name].value for name in ("n_negative", "n_fixed_m", "n_fixed_V")] == [0, 0, 0]


def test_a_disk_with_a_large_pre_stretch_is_followed_although_its_pressures_are_large():
    given = ControlsParameters(body="circular", alpha=0.4, beta=4.7)
    model = VariedDisk(MPI.COMM_WORLD, given.material, {"beta": 4.7}, 8, 3, 0.0)
    branch = model.primary(4.0, 0.1)
    assert branch.stalled is None
    assert branch.points[-1].monitors["t0"] > 4.0
    assert branch.points[-1].state.loads["p"] > 200


def test_the_mass_is_largest_between_the_neighbours_of_its_extremum():
    result = solve("controls", body="tube", alpha=0.0, V_r=20.0, u_end=2.0, numerics=MESH | {"step": 0.02})
    point = result.points("mass_fold")[0].values
    columns = result.branch().columns
    near = np.abs(columns["V"] - point["V"]) < 0.5
    fit = np.polyfit(columns["V"][near] - point["V"], columns["m"][near] - point["m"], 4)
    assert abs(fit[-2]) < 0.01 * abs(fit[-3])  # so that the extremum is 0.005 away at most, of 5.26
    beyond = columns["V"] > point["V"]
    assert columns["n_fixed_m"][beyond][0] == 1
    assert columns["n_fixed_m"][~beyond][-1] == 0


def test_a_gas_of_given_mass_is_between_given_volume_and_given_pressure():
    """With a small reservoir it acts like a given volume, with a large one like a given pressure."""
    rows = [
        solve("controls", body="circular", alpha=0.0, V_r=V_r, numerics=MESH).branch().columns
        for V_r in (0.0, 1e6)
    ]
    assert rows[0]["n_negative"].max() == 1
    assert np.array_equal(rows[0]["n_fixed_m"], rows[0]["n_fixed_V"])
    assert np.array_equal(rows[1]["n_fixed_m"], rows[1]["n_negative"])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"kappa": 0.9}, "kappa = 0.9"),
        ({"p_atm": -1.0}, "p_atm = -1"),
        ({"V_r": -1.0}, "V_r = -1"),
        ({"body": "hemisphere"}, "body = 'hemisphere'"),
        ({"lf": 31.0}, "lf = 31"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_anything_is_solved(given, message):
    with pytest.raises(InputError) as refused:
        solve("controls", **given)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


UNRESOLVED = {"alpha": 0.14759186785668132, "V_r": 31.065158532001078, "u_end": 2.5}
"""Four cells of degree 3 do not resolve this tube at its limit points, and at the second one the stretch at
the mid-plane has nearly no error on eight."""


def test_special_points_on_coarse_meshes_are_as_good_as_they_say():
    given = {"numerics": {"degree": 3, "cells": 16}}
    coarse = solve("controls", **UNRESOLVED, **given, at={"limit_point": 2})
    fine = solve("controls", **UNRESOLVED, numerics={"degree": 6, "cells": 48, "levels": 2})
    for point, truth in zip(coarse.special_points, fine.special_points, strict=True):
        for name, u in point.uncertainty.items():
            assert abs(point.values[name] - truth.values[name]) <= u + truth.uncertainty[name], name
    (state,), point = coarse.states, coarse.points("limit_point")[1]
    for name, u in point.uncertainty.items():
        assert state.quantities[name].uncertainty == u, name


@pytest.mark.parametrize(("degree", "order"), [(2, 2), (3, 4), (4, 4), (5, 6)])
def test_the_order_of_stretches_at_the_mid_plane(degree, order):
    """Not twice the degree, as that of the pressure is."""

    def stretch(cells, degree):
        law = ControlsParameters().material
        branch = VariedTube(MPI.COMM_WORLD, law, {"delta1": 1.0, "lf": 6.0}, cells, degree, 0.6)
        return branch.primary(1.2, 0.3).at("u_max", 1.0).values["lam1_mid"]

    exact = stretch(48, 6)
    coarse, fine = (abs(stretch(cells, degree) - exact) for cells in (16, 32))
    assert order_at_middle(degree) == order
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.4)
