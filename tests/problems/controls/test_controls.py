"""Inflation under given pressure, mass of gas and volume: closed forms of the sphere, and eigenvalues."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.controls.branch import ControlledBranch, Gas
from weakforms.problems.controls.problem import ControlsParameters
from weakforms.problems.diagram.bodies import VariedDisk, VariedTube
from weakforms.solvers.stability.spectra import Stability

MESH = {"cells": 48, "degree": 4, "levels": 2}


def largest_reservoir(kappa, p_atm, lam_end):
    """``min of kappa (p + p_atm) (-dV/dp) - V`` of a neo-Hookean sphere where the pressure falls."""
    lam = np.linspace(7 ** (1 / 6) + 1e-6, lam_end, 400_001)
    p, slope = 4 * (1 / lam - 1 / lam**7), 4 * (-1 / lam**2 + 7 / lam**8)
    volume, rate = 2 * lam**3 / 3, 2 * lam**2
    return float((kappa * (p + p_atm) * (-rate / slope) - volume).min())


@pytest.mark.parametrize(("kappa", "p_atm"), [(1.0, 1.0), (1.0, 0.0), (1.4, 1.0), (1.4, 30.0)])
def test_a_sphere_is_stable_at_given_mass_up_to_the_closed_form_of_the_reservoir(kappa, p_atm):
    critical = largest_reservoir(kappa, p_atm, 4.0)
    gas = {"body": "sphere", "alpha": 0.0, "kappa": kappa, "p_atm": p_atm}
    below, above = (solve("controls", **gas, V_r=share * critical) for share in (0.99, 1.02))
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


def branch_of(body, gas):
    given = ControlsParameters(alpha=0.0)
    if body == "tube":
        model = VariedTube(MPI.COMM_WORLD, given.material, {"delta1": 1.0, "lf": 6.0}, 16, 3, 0.6)
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
        ({"lf": 20.0}, "lf = 20"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_anything_is_solved(given, message):
    with pytest.raises(InputError) as refused:
        solve("controls", **given)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
