"""The tube's weak form: exact states, invariants, and errors that must be noticed."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

import weakforms.problems.meridian.model as meridian_module
from weakforms import Axis, Case, ConvergenceError, Curve, InputError, Panel, Points, solve, tube
from weakforms.forms import loads, materials
from weakforms.problems import registry
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.problem import Requests, validated
from weakforms.problems.tube.model import TubeMesh, TubeModel, free_branch
from weakforms.results import Result, validate
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.spectra import Stability
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.run.runner import verify

pytestmark = pytest.mark.paper2
COARSE = {"cells": 32}


@pytest.fixture(scope="module")
def branch():
    system = TubeModel.free(MPI.COMM_SELF, mooney_rivlin_of(0.1), 1.2, 6.0, TubeMesh(24, 3, 0.6)).system
    return free_branch(system, 1.2, 5.0, 0.08)


def test_residual_is_the_potentials_gradient_and_tangent_the_residuals(branch):
    system, point = branch.system, branch.points[40]
    rng = np.random.default_rng(0)
    direction = rng.standard_normal(system.size)
    direction[system.bc_dofs] = 0.0
    h = 1e-7

    def at(shift, what):
        with system.at(State(point.state.u + shift * direction, point.state.loads)):
            return what()

    slope = (at(h, lambda: system.monitor("Pi")) - at(-h, lambda: system.monitor("Pi"))) / (2 * h)
    shifted = point.state.copy()
    shifted.u += 1e-4 * direction
    with system.at(shifted):
        gradient = system.dot(system.residual(), direction)
        numeric = []
        for sign in (1, -1):
            with system.at(State(shifted.u + sign * h * direction, shifted.loads)):
                numeric.append((system.monitor("Pi"), system.residual()))
        assert (numeric[0][0] - numeric[1][0]) / (2 * h) == pytest.approx(gradient, rel=1e-6)
        with system.at(shifted):
            product = system.multiply(system.tangent(), direction)
            assert (numeric[0][1] - numeric[1][1]) / (2 * h) == pytest.approx(product, rel=1e-5, abs=1e-5)
            assert abs(slope) < 1e-5  # the point itself is stationary


def test_clamps_hold_along_the_whole_branch(branch):
    values = np.array([p.state.u[branch.system.bc_dofs] for p in branch.points])
    assert np.ptp(values, axis=0).max() < 1e-12


def test_pressure_is_the_energys_derivative_by_volume(branch):
    # Along equilibria d(Pi + p V) = p dV: the strain energy's change is the gas's work.
    columns = branch.columns()
    strain = columns["Pi"] + columns["p"] * columns["V"]
    volume = columns["V"]
    work = np.cumsum(np.diff(volume) * (columns["p"][1:] + columns["p"][:-1]) / 2)
    assert strain[1:] - strain[0] == pytest.approx(work, abs=3e-3)


def test_a_taut_tube_without_pressure_is_a_cylinder():
    result = solve("tube", delta1=1.3, u_end=0.5, at={"p": 0.0}, numerics=COARSE)
    field = result.states[0].fields[0]
    columns = field.columns
    assert field.uncertainty["Z"] == 0.0, "places are given, not computed"
    assert columns["rho"] == pytest.approx(1.0, abs=1e-13)
    assert columns["eta"] == pytest.approx(columns["Z"], abs=1e-13)
    assert columns["t2"] == pytest.approx(0.0, abs=1e-11)


def test_a_state_has_its_value_exactly_and_agrees_with_its_branch():
    result = solve("tube", delta1=1.1, at=[("u_max", 1.25), ("V", 9.0)], numerics=COARSE)
    by_displacement, by_volume = result.states
    assert by_displacement.quantities["u_max"].value == pytest.approx(1.25, abs=1e-12)
    assert by_volume.quantities["V"].value == pytest.approx(9.0, abs=1e-11)
    columns = result.branch().columns
    p = np.interp(1.25, columns["u_max"], columns["p"])
    assert by_displacement.quantities["p"].value == pytest.approx(p, abs=1e-3)


def test_the_whole_tube_meets_a_symmetry_breaking_point_the_half_does_not_see():
    whole = solve("tube", alpha=0, extent="full", numerics=COARSE, u_end=2.0)
    half = solve("tube", alpha=0, numerics=COARSE, u_end=2.0)
    assert [p.kind for p in whole.special_points] == ["limit_point", "bifurcation_point"]
    assert [p.kind for p in half.special_points] == ["limit_point"]
    assert whole.branch().columns["n_negative"].max() == 2
    assert half.branch().columns["n_negative"].max() == 1


def test_a_symmetry_breaking_point_is_a_state_of_the_half_tube_and_has_a_null_vector():
    """The branch is solved for there to round-off, although another one crosses it."""
    mesh = TubeMesh(32, 4, 0.6, full=True)
    tube = TubeModel.free(MPI.COMM_SELF, mooney_rivlin_of(0.0), 1.0, 6.0, mesh)
    whole = free_branch(tube.system, 1.0, 2.0, 0.3)
    _, found = whole.special()
    half = solve("tube", alpha=0, numerics=COARSE, u_end=2.0, at={"u_max": found.values["u_max"]})
    for name in ("p", "lam1_mid"):
        assert half.states[0].quantities[name].value == pytest.approx(found.values[name], abs=1e-8)
    system = whole.system
    with system.at(found.state):
        assert np.abs(system.residual()).max() < 1e-11  # round-off reaches 1.3e-12 on some processors
    nearest = Stability(system).modes(found.state, 1)[0]
    assert abs(nearest.eigenvalue) < 1e-9
    rho = np.argsort(whole.system.unknown.function_space.tabulate_dof_coordinates()[:, 0])
    outwards = nearest.vector[::2][rho]
    assert outwards == pytest.approx(-outwards[::-1], abs=1e-8)


def test_a_state_is_solved_for_at_the_value_of_its_lowest_eigenvalue():
    """It is zero at a limit point; elsewhere the state is that at its pressure."""
    result = solve("tube", delta1=1.1, at={"eigenvalue_1": 0.0}, crossing=2, numerics=COARSE)
    limit, (state,) = result.points("limit_point")[1], result.states
    assert state.quantities["p"].value == pytest.approx(limit.values["p"], abs=1e-10)
    assert state.quantities["u_max"].value == pytest.approx(limit.values["u_max"], abs=1e-6)
    given = {"contact": "frictionless", "delta1": 1.2, "p_end": 1.5, "numerics": COARSE}
    (state,) = solve("tube", at={"eigenvalue_1": 4.0}, **given).states
    found = state.quantities["p"]
    assert 0 < found.uncertainty < 1e-6
    (same,) = solve("tube", at={"p": found.value}, **given).states
    assert same.quantities["eigenvalue_1"].value == pytest.approx(4.0, abs=1e-9)


def test_a_limit_point_that_is_a_point_of_the_branch_is_found_by_its_eigenvalue():
    """The eigenvalue there has the sign of round-off: it may change its sign in no interval beside it."""
    given = {"alpha": 0, "u_end": 1.3, "n": [1], "numerics": {"cells": 12, "levels": 2, "step": 0.5}}
    result = solve("tube", at={"eigenvalue_1": 0.0}, **given)
    (limit,), (state,) = result.points("limit_point"), result.states
    assert state.quantities["p"].value == pytest.approx(limit.values["p"], abs=1e-10)
    assert state.quantities["u_max"].value == pytest.approx(limit.values["u_max"], abs=1e-6)


# -- laws that give way, laws that lock, and fold lines that begin elsewhere --------------------------


def test_a_law_that_gives_way_has_the_same_limit_points_on_all_meshes():
    """Varga's energy grows linearly: past u_max = 1.9 the mid-plane's stretch is unbounded on any mesh."""
    result = solve("tube", model="varga", delta1=1.011, lf=6.72, numerics={"cells": 96})
    (point,) = result.points("limit_point")
    assert point.uncertainty["p"] < 1e-9
    assert result.failures == []
    (rest,) = result.absent
    assert "hardly resists meridional stretch" in rest.reason
    columns, spread = result.branch().columns, result.branch().uncertainty
    assert 1.85 < columns["u_max"][-1] < 1.95
    assert np.all(spread["p"] < 1e-4)


def test_a_pre_stretch_beyond_the_largest_of_its_law_is_refused():
    with pytest.raises(InputError, match=r"delta1 = 4\.28 alone stretches .* lower delta1"):
        solve("tube", model="gent", jm=8.97, delta1=4.28, lf=16.0, numerics=COARSE)
    law = {"model": "harmonic", "shear": 0.6961, "f2": 3.658}
    problem = registry.get("tube_scheme")
    wanted = validated(problem.parameters, law | {"delta1": 4.13}, "tube_scheme")
    with pytest.raises(InputError, match=r"delta1 = 4\.13 alone .* 'harmonic' .* constants that allow more"):
        problem.check(wanted, Requests())


def test_stresses_beyond_the_largest_stretch_are_no_numbers():
    """The energies would be finite, but of the wrong sign, and Newton's method could converge there."""
    gent = Chosen("gent", (("shear", 2.0), ("jm", 8.97)))
    system = TubeModel.free(MPI.COMM_SELF, gent, 4.28, 6.0, TubeMesh(8, 2, 0.0)).system
    with system.at(system.initial):
        assert not np.any(np.isfinite(np.delete(system.residual(), system.bc_dofs)))


def test_a_law_that_locks_ends_its_branch_with_the_reason():
    numerics = {"cells": 16, "levels": 2, "step": 0.4}
    result = solve("tube", model="gent", jm=10.0, delta1=2.0, lf=6.0, u_end=9.0, numerics=numerics)
    assert result.failures == []
    (rest,) = result.absent
    assert re.match(r"tube: free inflation was followed up to u_max = [12]\..*lower u_end", rest.reason)


def test_a_fold_line_that_does_not_reach_the_unstretched_tube_begins_at_the_other_end():
    given = {"alpha": 0.1, "lf": 3.4}
    line = solve("tube_fold", **given, delta1_end=4.9, numerics=COARSE)
    (cusp,) = line.points("cusp_point")
    columns = line.branch().columns
    assert 3.0 < cusp.values["delta1"] < columns["delta1"][0] == pytest.approx(4.9, abs=1e-12)
    first, second = solve("tube", **given, delta1=4.9, numerics=COARSE).points("limit_point")
    assert columns["p"][0] == pytest.approx(first.values["p"], abs=1e-9)
    assert columns["u_max"][0] == pytest.approx(first.values["u_max"], abs=1e-8)
    assert columns["u_max"][-1] > second.values["u_max"]


def test_a_tube_without_limit_points_says_where_they_were_looked_for():
    searched = r"no limit point of alpha = 0\.8, lf = 6 up to u_max = 2 at any of 17 .* from 1 to .* = 1\.5"
    given = {"alpha": 0.8, "u_end": 2.0, "delta1_end": 1.5, "numerics": COARSE}
    result = solve("tube_fold", **given)
    assert (result.branches, result.failures) == ([], [])
    assert re.search(searched, result.absent[0].reason)
    assert Result.from_json(result.to_json()).absent == result.absent
    validate(result.to_json())
    with pytest.raises(InputError, match=searched):
        solve("tube_fold", **given, at={"delta1": 1.2})


# -- seeded faults ---------------------------------------------------------------------------------

ENOUGH = {"levels": 2, "step": 0.2}
SENTINEL = Case(
    title="sentinel",
    source="tests",
    panels=(
        Panel(
            "a",
            x=Axis("p", 0, 3),
            y=Axis("u_max", 0, 5),
            curves=(Curve(tube(alpha=0.1, delta1=1.5).on(**ENOUGH), "1.5", reference="fig02b_delta1_1.5"),),
        ),
    ),
    checks=(
        Points(
            "limit_point",
            reference="limit_points_off",
            base=tube().on(**ENOUGH),
            parameters=("alpha", "delta1", "lf"),
            asked={"p": 1e-8},
        ),
    ),
    asked={"p": 1e-7},
)


def wrong_pressure_sign(monkeypatch):
    right = loads.gas_potential
    monkeypatch.setattr(meridian_module, "gas_potential", lambda *given: -right(*given))


def wrong_sign_in_second_invariant(monkeypatch):
    def law(lam1, lam2, alpha):
        second = 1 / lam1**2 - 1 / lam2**2 + (lam1 * lam2) ** 2 - 1
        return materials.neo_hookean(lam1, lam2) + alpha * second

    wrong = replace(materials.MATERIALS["mooney_rivlin"], law=law)
    monkeypatch.setitem(materials.MATERIALS, "mooney_rivlin", wrong)


def wrong_power_of_volume(monkeypatch):
    monkeypatch.setattr(meridian_module, "gas_potential", lambda rho, slope, p: -p * rho * slope / 2)


def pre_stretch_forgotten_in_hoop(monkeypatch):
    right = meridian_module.revolution_stretches
    monkeypatch.setattr(
        meridian_module,
        "revolution_stretches",
        lambda rho, *given: replace(right(rho, *given), lam2=rho),
    )


@pytest.mark.parametrize(
    "fault",
    [
        pytest.param(wrong_pressure_sign, marks=pytest.mark.slow),
        pytest.param(wrong_sign_in_second_invariant, marks=pytest.mark.slow),
        pytest.param(wrong_power_of_volume, marks=pytest.mark.slow),
        pre_stretch_forgotten_in_hoop,
    ],
)
def test_a_fault_in_the_weak_form_fails_named_checks(fault, monkeypatch, tmp_path):
    fault(monkeypatch)
    found = FoundCase("paper2.sentinel", 2, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    beyond = [v.check for v in outcome.verdicts if not v.passed and v.error is not None]
    assert outcome.status == "failed", outcome.errors
    assert any(name.startswith("fig02b_delta1_1.5") for name in beyond), "not a stall"


def test_without_a_fault_the_same_checks_hold(tmp_path):
    found = FoundCase("paper2.sentinel", 2, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    assert outcome.status == "passed"
    of_every_case = ("trace", "identities", "marks")
    assert len([v for v in outcome.verdicts if v.check.partition(":")[0] not in of_every_case]) == 6


def test_a_first_state_from_which_full_newton_steps_diverge_is_found_by_shorter_ones():
    """From the uniform tube, the first step leads to stretches at which the law is not defined."""
    law = Chosen("harmonic", (("shear", 0.6329), ("f2", 0.8175)))
    model = TubeModel.free(MPI.COMM_SELF, law, 3.253, 6.024, TubeMesh(24, 4, 0.6))
    with pytest.raises(ConvergenceError):
        ExtendedNewton(model.system, ["p"]).solve(model.system.initial.copy(), [Held("p", 0.0)])
    first = free_branch(model.system, 3.253, 0.2, 0.1).points[0]
    assert first.state.loads["p"] == pytest.approx(0.0, abs=1e-12)
    assert first.record.norms[-1] < 1e-9


def test_numbers_of_three_meshes_state_their_order_of_convergence():
    """Degree 2: loads and energies converge with order 4, stretches at a point with order 2."""
    mesh = {"cells": 64, "degree": 2, "levels": 3}
    (state,) = solve("tube", delta1=1.1, u_end=1.5, at={"u_max": 1.25}, numerics=mesh).states
    orders = {name: quantity.order for name, quantity in state.quantities.items()}
    assert orders["p"] == pytest.approx(4, abs=0.5)
    assert orders["Pi"] == pytest.approx(4, abs=0.5)
    assert orders["lam1_mid"] == pytest.approx(2, abs=0.5)
    assert orders["u_max"] is None
