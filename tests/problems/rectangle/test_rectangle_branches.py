"""Branches of rectangular membranes: limit loads, folds of the volume, counts by class, refusals."""

import numpy as np
import pytest
from mpi4py import MPI
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from weakforms import InputError, solve
from weakforms.errors import ConvergenceError
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.rectangle.branch import RectangleModes, traced
from weakforms.problems.rectangle.model import RectangleModel, Sheet
from weakforms.solvers.equilibrium.state import State

COARSE = {"cells": 8, "levels": 2}


@pytest.fixture(scope="module")
def gas():
    return solve("rectangle", load="gas", alpha=0.0, numerics=COARSE)


@pytest.fixture(scope="module")
def liquid():
    return solve("rectangle", gamma=5.0, at={"w_c": 0.5}, numerics=COARSE)


def test_gas_has_one_limit_pressure_and_no_broken_symmetry(gas):
    (limit,) = gas.special_points
    assert limit.kind == "limit_point"
    assert limit.values["p"] == pytest.approx(3.2775, abs=1e-3)
    branch = gas.branch()
    past = branch["w_c"] > limit.values["w_c"] + 1e-9
    assert (branch["n_all"] == past).all()
    assert not branch["n_held"].any()  # gas of a given volume stays stable


def test_a_heavy_liquid_has_a_lower_and_an_upper_limit_level(liquid):
    lower, upper = liquid.points("limit_point")
    assert lower.values["zw"] < 0 < upper.values["zw"]
    branch = liquid.branch()
    assert branch["zw"][0] < 0
    between = (branch["w_c"] > lower.values["w_c"]) & (branch["w_c"] < upper.values["w_c"] - 1e-9)
    assert (branch["n_all"] == ~between).all() or (np.diff(branch["n_all"]) != 0).sum() == 2


@pytest.mark.parametrize("cells", [8, 16])
def test_the_edge_of_a_wet_part_is_in_the_uncertainties_of_the_lower_limit_level(cells):
    result = solve("rectangle", gamma=5.0, w_end=0.4, numerics={"cells": cells})
    lower = result.points("limit_point")[0]
    # From 40 cells. Errors change their signs from mesh to mesh: two differences may be small by chance.
    on_fine = {"zw": -0.0175672021, "w_c": 0.218522, "V_f": 0.345857, "U": 0.577798}
    for name, value in on_fine.items():
        assert abs(lower.values[name] - value) < lower.uncertainty[name] < 5e-3, name


def test_a_liquid_far_heavier_than_the_critical_one_is_begun_by_way_of_lighter_ones():
    """It wets the middle only: Newton's method fails from a guess that is wet all over."""
    law = {"model": "beda_chevalier", "k1": 2.584, "k2": 0.4161, "k3": 0.0001458, "power": 13.69}
    sheet = {"delta": 2.108, "c": 2.614, "gamma": 24.68, "energy": "full"}
    found = solve("rectangle", **law, **sheet, w_end=0.31, numerics=COARSE | {"cells": 4})
    assert found.failures == []
    branch = found.branch()
    assert branch["w_c"][0] == pytest.approx(0.02, rel=1e-9)
    assert branch["zw"][0] < 0


def test_the_amount_folds_where_its_rate_vanishes():
    """Neo-Hookean under a light liquid: the level has a limit first, then the liquid itself."""
    found = solve("rectangle", alpha=0.0, gamma=1.0, w_end=2.2, numerics=COARSE)
    level, amount = found.special_points
    assert (level.kind, amount.kind) == ("limit_point", "volume_fold")
    branch = found.branch()
    assert branch["V_f"].max() <= amount.values["V_f"] * (1 + 1e-9)
    unstable = branch["w_c"] > amount.values["w_c"]
    assert unstable.any()
    assert (branch["n_held"] == unstable).all()


def test_whole_mesh_has_the_states_and_the_counts_of_the_quarter():
    given = {"gamma": 5.0, "w_end": 0.5, "at": {"w_c": 0.4}, "numerics": {"cells": 4, "levels": 2}}
    (quarter,), (whole,) = (solve("rectangle", symmetry=s, **given).states for s in ("quarter", "full"))
    for name in ("zw", "V_f", "Pi", "U", "S_least", "lam1_c"):
        assert whole.quantities[name].value == pytest.approx(quarter.quantities[name].value, rel=1e-9)
    assert whole.quantities["n_all"].value == quarter.quantities["n_all"].value


def test_work_of_gas_is_the_change_of_strain_energy(gas):
    """DU = p dV along the branch, by splines over the height of the centre."""
    branch = gas.branch()
    w, p, volume, energy = (branch[name] for name in ("w_c", "p", "V", "U"))
    power = CubicSpline(w, p * CubicSpline(w, volume)(w, 1))
    assert power.integrate(w[0], w[-1]) == pytest.approx(energy[-1] - energy[0], rel=2e-4)


def test_the_level_of_a_liquid_derives_its_volume_along_the_branch(liquid):
    """DPi = -gamma (V_f - column over the frame) dzw, through both limit levels."""
    branch = liquid.branch()
    w, level, volume, potential = (branch[name] for name in ("w_c", "zw", "V_f", "Pi"))
    over = np.maximum(level, 0) * 4 * 1.1**2
    slope = CubicSpline(w, -5.0 * (volume - over) * CubicSpline(w, level)(w, 1))
    done = slope.integrate(w[0], w[-1])
    assert done == pytest.approx(potential[-1] - potential[0], rel=2e-2)


@pytest.mark.parametrize("alpha", [0.0, 0.1])
def test_a_gas_filled_strip_is_a_cylinder(alpha):
    """lam1 is uniform: W_1(lam1, delta) = p delta rho, lam1 = rho phi, delta = rho sin phi."""
    delta, height = 1.1, 0.6
    phi = brentq(lambda a: delta * (1 - np.cos(a)) / np.sin(a) - height, 0.1, 2.5)
    rho = delta / np.sin(phi)
    lam = rho * phi
    w1 = 2 * lam - 2 / (lam**3 * delta**2) + alpha * (2 * lam * delta**2 - 2 / lam**3)
    found = solve(
        "rectangle", load="gas", edges="strip", alpha=alpha, w_end=0.7, at={"w_c": height}, numerics=COARSE
    )
    (state,) = found.states
    volume = 2 * delta * rho**2 * (phi - np.sin(phi) * np.cos(phi))
    for name, exact, sharp in (("p", w1 / (delta * rho), 1e-3), ("V", volume, 1e-3), ("lam1_c", lam, 1e-2)):
        value = state.quantities[name]
        assert abs(value.value - exact) <= 2 * value.uncertainty
        assert value.uncertainty < sharp * exact


def test_a_whole_wave_along_a_strip_is_half_a_wave_of_half_of_it():
    """The first is found as a crossing in the states' own class, the second in the class odd in Y."""
    found = {}
    for c in (1.7, 0.85):
        law = mooney_rivlin_of(0.8)
        sheet = Sheet(law, c=c, delta=1.074, delta_y=1.074, gamma=8.0, strip=True)
        branch = traced(RectangleModel(MPI.COMM_SELF, sheet), 0.02, 0.3, 0.2)
        found[c] = [one.values for one in branch.special() if one.kind == "bifurcation_point"]
    (whole,) = (one for one in found[1.7] if one["n"] == 0)
    (half,) = (one for one in found[0.85] if one["n"] == 2)
    assert whole["zw"] == pytest.approx(half["zw"], rel=1e-8)
    assert whole["V_f"] == pytest.approx(2 * half["V_f"], rel=1e-8)


def test_slack_frames_start_and_wrinkle_in_the_corners():
    found = solve("rectangle", load="gas", delta=1.0, w_end=0.8, at={"S_least": 0.0}, numerics=COARSE)
    branch, (first,) = found.branch(), found.states
    assert branch["f_w"][-1] > 0
    assert branch["S_least"][-1] < 0 < branch["S_least"][0]
    assert first.quantities["X_least"].value > 0.85
    assert first.quantities["Y_least"].value > 0.85


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"delta": 0.9}, "delta = 0.9: input should be greater than or equal to 1"),
        ({"gamma": 0.0}, "gamma = 0.0: input should be greater than 0"),
        ({"c": 0.5}, "c = 0.5"),
        ({"model": "harmonic"}, "model = 'harmonic'; allowed: "),
        (
            {"model": "saint_venant_kirchhoff", "energy": "full"},
            "model = 'saint_venant_kirchhoff'; allowed: ",
        ),
        ({"model": "varga", "gamma": 2.0}, "gamma = 2: the force of model = 'varga' is bounded"),
        ({"model": "varga", "delta_y": 2.5}, "delta_y = 2.5: the force of model = 'varga' is bounded"),
        ({"edges": "strip", "delta": 1.0}, "a slack strip has no first state"),
        ({"load": "gas", "at": {"zw": 0.1}}, "with load = 'gas' there is no zw; allowed: p, V"),
        ({"at": {"p": 0.1}}, "with load = 'liquid' there is no p; allowed: zw, V_f"),
        ({"at": {"f_w": 0.1}}, "cannot ask for a state at 'f_w'"),
        ({"numerics": {"degree": 3}}, "degree = 3: input should be less than or equal to 2"),
    ],
)
def test_bad_input_is_one_line(given, words):
    with pytest.raises(InputError) as refused:
        solve("rectangle", **given)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_load_beyond_the_limit_is_refused_with_the_range():
    with pytest.raises(InputError, match=r"p = 5 is not taken .* ranges over"):
        solve("rectangle", load="gas", alpha=0.0, at={"p": 5.0}, numerics={"cells": 4, "levels": 2})


def test_each_class_is_counted_by_its_own_operator():
    """A flat sheet under a liquid above three thresholds: unstable in three classes, stable in the fourth."""
    heavy = 0.97644944 * np.pi**2 / (2 * 1.1**2) * 2.6
    of = RectangleModel(MPI.COMM_SELF, Sheet(mooney_rivlin_of(0.1), gamma=heavy, cells=4))
    modes = RectangleModes(of)
    flat = State(0 * of.system.initial.u, of.system.initial.loads | {"zw": 1e-300})
    with of.system.at(flat):
        found = modes.observe()
    counts = [found[name] for name in ("n_odd_even", "n_even_odd", "n_odd_odd", "n_all")]
    assert counts == [1, 1, 0, 3]


def test_the_sheet_of_a_state_is_whole_and_faces_upwards():
    """Area of the stress-free sheet, orientation, height and stretches of the triangles of a picture."""
    found = solve(
        "rectangle", load="gas", c=1.5, w_end=0.5, at={"w_c": 0.4}, numerics={"cells": 4, "levels": 2}
    )
    (state,) = found.states
    sheet, triangles = (next(f for f in state.fields if f.name == n).columns for n in ("sheet", "triangles"))
    corners = np.column_stack([triangles[name] for name in "abc"]).astype(int)
    places = np.column_stack([sheet["X"], sheet["Y"]])[corners]
    sides = places[:, 1:] - places[:, :1]
    area = np.linalg.det(sides) / 2
    assert (area > 0).all()
    assert area.sum() == pytest.approx(4 * 1.5, rel=1e-12)
    assert sheet["z"].max() == pytest.approx(0.4, rel=1e-9)
    assert sheet["x"][np.isclose(sheet["X"], -1)] == pytest.approx(-1.1)
    assert (triangles["lam1"] >= triangles["lam2"]).all()
    assert sum(triangles[f"t_{name}"] ** 2 for name in "xyz") == pytest.approx(1.0)
    assert (triangles["state"] == 1).all()


@pytest.mark.slow
def test_a_law_without_stress_at_a_place_is_an_error_that_says_so():
    with pytest.raises(ConvergenceError, match="lower w_end"):
        solve(
            "rectangle", load="gas", model="gent", delta=1.02, w_end=3.9, numerics={"cells": 6, "levels": 2}
        )
