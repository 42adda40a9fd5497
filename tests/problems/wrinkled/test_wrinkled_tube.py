"""The wrinkled cylinder: tangent, exact states, fitted and plain meshes, general bodies, planted errors."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

import weakforms.problems.meridian.model as model_module
from weakforms import At, Axis, Case, Curve, InputError, Panel, solve, wrinkled_tube
from weakforms.forms import loads
from weakforms.forms.materials import neo_hookean
from weakforms.forms.wrinkling import natural_width
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.model import BY_STATE, TAUT, WRINKLED
from weakforms.problems.wrinkled import model as wrinkled_module
from weakforms.problems.wrinkled import state as wrinkled_state
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.critical import critical_radii
from weakforms.problems.wrinkled.fields import Zones
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.problem import PAPER_GAMMA
from weakforms.problems.wrinkled.state import BLOCKS, Layout
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.run.runner import verify

pytestmark = pytest.mark.paper4
COARSE = {"cells": 6, "levels": 2}
VALUES = {"M": 1.5, "delta": 2.0, "c2": 0.01, "L": 8.0, "gamma": PAPER_GAMMA}
CELLS = (3, 6)


@pytest.fixture(autouse=True)
def fresh_models():
    """Models are kept between solves: no test may see a form that another test has changed."""
    wrinkled_state.model_on.cache_clear()
    yield
    wrinkled_state.model_on.cache_clear()


def membrane(liquid=True, radius=0.5, energy="relaxed", **values):
    return Membrane(MPI.COMM_SELF, CYLINDER, {**VALUES, "Af": radius, **values}, liquid, CELLS, 6, energy)


@pytest.fixture
def critical():
    return critical_radii(MPI.COMM_SELF, VALUES, CELLS, 6)[-1]


def fitted(tube, load):
    state, _ = tube.by_homotopy(load)
    return tube.fitted(tube.plain(state), Held(tube.control, load))


@pytest.mark.parametrize("energy", ["relaxed", "modified_gradient", "standard"])
def test_tangent_is_symmetric_and_the_residuals_derivative(energy):
    held = fitted(membrane(radius=0.5568, energy=energy), 7.44)[-1]
    with held.lent():
        system = held.model.system
        rng = np.random.default_rng(1)
        a, b = rng.standard_normal((2, system.size))
        a[system.bc_dofs] = b[system.bc_dofs] = 0.0
        tangent = system.tangent()
        assert system.dot(a, system.multiply(tangent, b)) == pytest.approx(
            system.dot(b, system.multiply(tangent, a)), rel=1e-11
        )
        product, h, slopes = system.multiply(tangent, a), 1e-7, []
        for sign in (1, -1):
            with system.at(replace(held.state, u=held.state.u + sign * h * a)):
                slopes.append(system.residual())
        numeric = (slopes[0] - slopes[1]) / (2 * h)
        assert np.abs(numeric - product).max() < 1e-6 * np.abs(product).max()


def test_residual_is_the_potentials_gradient():
    """The residual of Pi as printed, with -P r^2 z'/2; the form uses another potential of the liquid."""
    held = fitted(membrane(radius=0.5568), 7.44)[-1]
    with held.lent():
        system = held.model.system
        direction = np.random.default_rng(2).standard_normal(system.size)
        direction[system.bc_dofs] = 0.0
        shifted = held.state.u + 1e-3 * direction
        h, values = 1e-6, []
        for sign in (1, -1):
            with system.at(replace(held.state, u=shifted + sign * h * direction)):
                values.append(system.monitor("Pi"))
        with system.at(replace(held.state, u=shifted)):
            slope = system.dot(system.residual(), direction)
            assert (values[0] - values[1]) / (2 * h) == pytest.approx(slope, rel=1e-5)


def test_derivatives_in_break_points_share_a_form_and_are_right():
    held = fitted(membrane(radius=0.5568), 7.44)[-1]
    with held.lent():
        system, h = held.model.system, 1e-6
        names = [name for name in held.scalars if name[0] == "b"]
        assert len(names) >= 2
        for name in names:
            exact = system.load_derivative(name)
            sides = []
            for sign in (1, -1):
                moved = {**held.state.loads, name: held.state.loads[name] + sign * h}
                with system.at(replace(held.state, loads=moved)):
                    sides.append(system.residual())
            numeric = (sides[0] - sides[1]) / (2 * h)
            assert np.abs(numeric - exact).max() < 1e-6 * np.abs(exact).max()


def test_unloaded_membrane_on_small_disks_is_a_cylinder_of_constant_tension():
    held = membrane(radius=0.5).unloaded(1, WRINKLED)
    found = held.sampled(np.linspace(0, 8, 41))
    assert found["r"] == pytest.approx(0.5, abs=1e-13)
    assert np.ptp(found["tension"]) < 1e-9
    assert found["gw"].max() < 1


def test_each_mesh_has_the_radius_that_it_finds_critical():
    radii = critical_radii(MPI.COMM_SELF, VALUES, CELLS, 6)
    tube = membrane(radius=radii[-1])
    tube.on_meshes = [{"Af": radius} for radius in radii]
    levels = fitted(tube, 6.0)
    assert [held.state.loads["Af"] for held in levels] == radii
    assert len(set(radii)) == len(levels)


def test_critical_radius_puts_the_thin_end_on_the_verge(critical):
    ends = membrane(radius=critical).unloaded(1, WRINKLED).sampled(np.array([0.0, 8.0]))["gw"]
    assert ends[1] == pytest.approx(1, abs=1e-12)
    assert ends[0] < 1


def test_homotopy_ends_where_continuation_does(critical):
    tube = membrane(radius=critical)
    by_homotopy = tube.by_homotopy(7.44)[0]
    stepwise = tube.by_homotopy(1.0)[0]
    solver = wrinkled_state.solver_of(tube.plain_model, ())
    for level in [*np.arange(1.5, 7.5, 0.5).tolist(), 7.44]:
        stepwise.loads["zw"] = level
        stepwise, _ = solver.solve(stepwise)
    assert np.abs(stepwise.u - by_homotopy.u).max() < 1e-9
    assert by_homotopy.loads["residual_stiffness"] == 0.0


def test_fitted_fronts_converge_at_high_order_and_plain_ones_do_not(critical):
    tube = Membrane(MPI.COMM_SELF, CYLINDER, {**VALUES, "Af": critical}, True, (2, 4, 8), 4, "relaxed")
    state, _ = tube.by_homotopy(7.44)
    plain = tube.plain(state)
    fronts = [held.zones.fronts for held in tube.fitted(plain, Held("zw", 7.44))]
    exact = np.array([1.511572660117, 5.069224906584, 7.595374980714])
    errors = [np.abs(np.array(found) - exact).max() for found in fronts]
    assert errors[0] / errors[1] > 2**3.5
    assert errors[1] / errors[2] > 2**3.5
    assert np.abs(np.array(plain.zones.fronts) - exact).max() > 100 * errors[2]


def test_every_block_is_in_the_state_it_is_marked_with(critical):
    held = fitted(membrane(radius=critical), 7.44)[-1]
    breaks = held.model.breaks_of(held.state.loads)
    middles = (breaks[1:] + breaks[:-1]) / 2
    gw = held.sampled(middles)["gw"]
    assert np.all((gw > 1) == (held.state.marks.taut == TAUT))
    assert BY_STATE not in held.state.marks.taut


def test_another_body_solves_too():
    """A tube of uniform thickness and radius 2 is the unit tube scaled: r and L by 2, pressure by 1/2."""
    wide = Body(
        name="wide",
        parameters=("M", "delta", "L", "Af"),
        length=lambda q: 2 * q["L"],
        radius=lambda _s, _q: 2.0,
        thickness=lambda s, q: q["M"] + (1 - q["M"]) * s / q["L"],
        shape=lambda s, q: (q["Af"], q["delta"] * s * (1 + 0.05 * (1 - s / (2 * q["L"])))),
        easy=(("M", 1.0),),
    )
    values = {**VALUES, "Af": 0.5, "M": 0.7}
    states = []
    for body, p in ((CYLINDER, 0.2), (wide, 0.1)):
        tube = Membrane(MPI.COMM_SELF, body, values, False, CELLS, 6, "relaxed")
        states.append(fitted(tube, p)[-1])
    s = np.linspace(0, 8, 33)
    one, two = states[0].sampled(s), states[1].sampled(2 * s)
    assert two["r"] == pytest.approx(2 * one["r"], rel=1e-9)
    assert two["gw"] == pytest.approx(one["gw"], rel=1e-8)
    assert states[1].zones.fronts == pytest.approx([2 * z for z in states[0].zones.fronts], rel=1e-8)


# -- the problem -----------------------------------------------------------------------------------


def test_the_papers_state_has_three_fronts():
    result = solve("wrinkled_tube", M=1.5, delta=2, load="fluid", at={"zw": 7.44}, numerics=COARSE)
    fronts = [p for p in result.special_points if p.kind == "front"]
    assert [p.values["Z"] for p in fronts] == pytest.approx([1.5115727, 5.0692249, 7.5953750], abs=1e-6)
    assert all(p.values["zw"] == 7.44 for p in fronts)
    assert [p.kind for p in result.special_points[:2]] == ["zone_opening", "zone_closing"]
    assert result.failures == []
    assert result.quantities["Af_critical"].value == pytest.approx(0.55686917, abs=1e-8)


def test_a_state_by_volume_is_the_state_by_level():
    given = {"M": 0.5, "load_end": 6.5, "numerics": COARSE}
    by_level = solve("wrinkled_tube", at={"zw": 6.0}, **given).states[0]
    volume = by_level.quantities["V"].value
    by_volume = solve("wrinkled_tube", at={"V": volume}, **given).states[0]
    assert by_volume.quantities["zw"].value == pytest.approx(6.0, abs=1e-8)


def test_a_limit_load_is_a_state_one_can_ask_for():
    result = solve("wrinkled_tube", M=0.5, delta=3, load="gas", at=[("limit_point", 1)], numerics=COARSE)
    (limit,) = [p for p in result.special_points if p.kind == "limit_point"]
    assert limit.values["p"] == pytest.approx(0.5554979, abs=1e-6)
    assert result.states[0].quantities["V"].value == pytest.approx(limit.values["V"], rel=1e-6)
    columns = result.branch().columns
    below = columns["V"] < limit.values["V"]
    assert set(columns["n_negative"][below]) == {0}
    assert set(columns["n_negative"][~below]) == {1}


def test_uniform_membrane_is_taut_on_the_verge():
    state = solve("wrinkled_tube", M=1, delta=2, at={"zw": 4.5}, numerics=COARSE).states[0]
    assert state.quantities["wrinkled_fraction"].value == 0
    assert state.quantities["gw_min"].value > 1 - 1e-7


def test_a_level_beyond_the_default_end_extends_the_branch():
    state = solve("wrinkled_tube", M=1.5, at={"zw": 18.0}, numerics=COARSE).states[0]
    assert state.quantities["zw"].value == pytest.approx(18.0)


def test_a_pressure_above_the_limit_is_refused():
    with pytest.raises(InputError, match="p ranges over"):
        solve("wrinkled_tube", M=0.5, delta=3, load="gas", at={"p": 0.58}, numerics=COARSE)


# -- seeded faults ---------------------------------------------------------------------------------

SENTINEL = Case(
    title="sentinel",
    source="tests",
    panels=(
        Panel(
            "a",
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.6, 1.4),
            curves=(
                Curve(
                    wrinkled_tube(M=1.5, delta=2).on(cells=8, levels=2),
                    "7.44",
                    reference="fig02_M_1.5_zw_7.44",
                    at=At("zw", 7.44, profile=()),
                ),
            ),
        ),
    ),
    asked={"r": 1e-6, "z": 1e-6, "gw": 1e-6},
)


def liquid_pushes_inwards(monkeypatch):
    right = loads.liquid_potential
    monkeypatch.setattr(model_module, "liquid_potential", lambda *given: -right(*given))


def level_counted_double(monkeypatch):
    right = loads.liquid_potential
    monkeypatch.setattr(
        model_module, "liquid_potential", lambda r, s, z, zw, g, wet: right(r, s, z, zw, 2 * g, wet)
    )


def uniform_thickness(monkeypatch):
    monkeypatch.setattr(
        "weakforms.problems.wrinkled.body.CYLINDER", replace(CYLINDER, thickness=lambda s, q: 1.0 + 0 * s)
    )


def second_invariant_forgotten_in_folds(monkeypatch):
    monkeypatch.setattr(model_module, "relaxed", lambda _law: lambda a: neo_hookean(a, natural_width(a)))


def wrong_switch(monkeypatch):
    """In the first of these modules alone it spoils first guesses only, and the states are right."""
    for module in (model_module, wrinkled_module):
        monkeypatch.setattr(module, "wrinkling_function", lambda a, b: b * a)


@pytest.mark.parametrize(
    "fault",
    [
        pytest.param(liquid_pushes_inwards, marks=pytest.mark.slow),
        pytest.param(level_counted_double, marks=pytest.mark.slow),
        uniform_thickness,
    ],
)
def test_a_fault_in_the_weak_form_fails_named_checks(fault, monkeypatch, tmp_path):
    fault(monkeypatch)
    found = FoundCase("paper4.sentinel", 4, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    beyond = [v.check for v in outcome.verdicts if not v.passed and v.error is not None]
    assert outcome.status == "failed", outcome.errors
    assert any(name.startswith("fig02_M_1.5_zw_7.44") for name in beyond), "beyond its bound, not a stall"


@pytest.mark.parametrize(
    "fault", [second_invariant_forgotten_in_folds, pytest.param(wrong_switch, marks=pytest.mark.slow)]
)
def test_a_fault_in_the_folds_leaves_a_branch_that_ends_too_low(fault, monkeypatch, tmp_path):
    """The branch turns at half the level of the profile: the message says that no state can be compared."""
    fault(monkeypatch)
    found = FoundCase("paper4.sentinel", 4, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    assert outcome.status == "error"
    assert "zw = 7.44" in outcome.errors[0]
    assert "zw ranges over [0, " in outcome.errors[0]


def test_without_a_fault_the_same_checks_hold(tmp_path):
    found = FoundCase("paper4.sentinel", 4, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    assert outcome.status == "passed"
    of_every_case = ("trace", "identities", "marks")
    assert len([v for v in outcome.verdicts if v.check.partition(":")[0] not in of_every_case]) == 3


@pytest.mark.parametrize("shift", [4e-15, -4e-15])
def test_which_blocks_are_halved_does_not_hang_on_round_off(shift):
    """Four of equal length, two to be halved: the same two on any number of ranks."""
    breaks = Layout.of(Zones(TAUT, (2.5, 4.0, 5.5)), 8.0).breaks
    moved = Layout.of(Zones(TAUT, (2.5, 4.0 + shift, 5.5)), 8.0).breaks
    assert len(breaks) == BLOCKS + 1
    assert moved == pytest.approx(breaks, abs=1e-12)


def test_blocks_end_on_both_sides_of_a_front_where_cells_are_graded_towards_it():
    breaks = np.array(Layout.of(Zones(TAUT, (4.0,)), 8.0, near_fronts=(0.05, 0.4)).breaks)
    for point in (3.6, 3.95, 4.0, 4.05, 4.4):
        assert np.abs(breaks - point).min() < 1e-12, point
    at_the_end = Layout.of(Zones(TAUT, (0.03,)), 8.0, near_fronts=(0.05,)).breaks
    assert at_the_end[:3] == pytest.approx([0.0, 0.03, 0.08]), "none beyond the end, none on the end"
