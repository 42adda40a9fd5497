"""The disk's weak form: exact states, balances, energy release rate, and errors that must be noticed."""

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from scipy.special import jn_zeros

import weakforms.problems.meridian.model as meridian_module
from weakforms import Axis, Case, Curve, InputError, Panel, circular, solve
from weakforms.forms import loads
from weakforms.problems.disk.family import STRETCHES, rounded
from weakforms.problems.disk.model import DiskData
from weakforms.problems.disk.peeling import PeelingBranch
from weakforms.problems.disk.phases import DiskHistory, DiskPhases
from weakforms.problems.disk.problem import inflation
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.solvers.equilibrium.state import State
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.run.runner import verify

pytestmark = pytest.mark.paper1
COARSE = {"cells": 24, "levels": 2}


@pytest.fixture(scope="module")
def run():
    return DiskPhases(
        MPI.COMM_SELF, DiskData(mooney_rivlin_of(0.1), 1.0, 50.0, 0.5, 12, 3), "locked", 3.477, 0.08, 10
    )


def perturbed(system, state, seed=0):
    """A state out of equilibrium, and a direction that satisfies the boundary conditions."""
    rng = np.random.default_rng(seed)
    direction = rng.standard_normal(system.size) * 1e-2
    direction[system.bc_dofs] = 0.0
    out = state.copy()
    out.u += direction
    return out, direction / 1e-2


def gap_to_difference(system, state, direction, value, derivative, h=2e-7):
    """Compare a derivative with the central difference of ``value`` along a direction."""
    found = []
    for sign in (1, -1):
        with system.at(State(state.u + sign * h * direction, state.loads)):
            found.append(value())
    with system.at(state):
        return (found[0] - found[1]) / (2 * h), derivative()


def test_residual_is_the_gradient_of_the_potential_in_contact(run):
    system = run.slip.system
    state, direction = perturbed(system, run.frictionless.at("p", 3.0).state)
    numeric, exact = gap_to_difference(
        system,
        state,
        direction,
        lambda: system.monitor("Pi"),
        lambda: system.dot(system.residual(), direction),
    )
    assert numeric == pytest.approx(exact, rel=1e-6)


def test_residual_of_the_rigid_patch_is_the_gradient_of_its_full_potential(run):
    # The springs under the patch enter by two integrals of the history; the potential sums over the patch.
    system = run.stick.system
    state, direction = perturbed(system, run.deflation.at("p", 2.0).state, seed=1)
    s = np.repeat(run.stick.space.tabulate_dof_coordinates()[: system.size // 2, 0], 2)
    height = np.arange(system.size) % 2 == 1
    patch = height & (s <= 1 + 1e-12)
    state.u[patch], direction[patch] = state.u[patch].mean(), 0.7  # it moves as a whole
    numeric, exact = gap_to_difference(
        system,
        state,
        direction,
        lambda: system.monitor("Pi"),
        lambda: system.dot(system.residual(), direction),
    )
    assert numeric == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("bonded", [False, True])
def test_tangent_is_the_derivative_of_the_residual_and_symmetric(run, bonded):
    branch = run.deflation if bonded else run.frictionless
    system = branch.system
    state, direction = perturbed(system, branch.at("p", 2.5).state, seed=2)
    numeric, exact = gap_to_difference(
        system,
        state,
        direction,
        system.residual,
        lambda: system.multiply(system.tangent(), direction),
    )
    assert numeric == pytest.approx(exact, rel=1e-5, abs=1e-6)
    other = np.random.default_rng(3).standard_normal(system.size)
    forth, back = system.multiply(system.matrix, direction) @ other, system.multiply(system.matrix, other)
    assert forth == pytest.approx(back @ direction, rel=1e-12)


def test_the_volume_is_what_the_potential_falls_by_with_pressure(run):
    # dPi/dp = -V along equilibria, also in deflation (the front is fixed) and in frictionless contact.
    for branch in (run.frictionless, run.deflation):
        columns = branch.columns()
        p, volume = columns["p"], columns["V"]
        fall = np.cumsum(np.diff(p) * (volume[1:] + volume[:-1]) / 2)
        assert columns["Pi"][1:] - columns["Pi"][0] == pytest.approx(-fall, abs=2e-4)


def test_the_free_cap_is_in_vertical_balance():
    x = np.linspace(0.1, 0.95, 120)
    result = solve("circular", t_end=0.9, at={"t0": 0.8}, numerics={"cells": 48, "levels": 2})
    p = result.states[0].quantities["p"].value
    columns = result.states[0].fields[0].columns
    inside = (columns["X"] > 0.05) & (columns["X"] < 0.99)
    fit = np.polynomial.Chebyshev.fit(columns["X"], columns["eta"], 24)
    sine = -fit.deriv()(x) / np.interp(x, columns["X"], columns["lam1"])
    t1, rho = (np.interp(x, columns["X"][inside], columns[name][inside]) for name in ("t1", "rho"))
    # 2 pi rho t1 sin(theta) carries the pressure on the cap's projection, pi rho^2 p
    assert t1 * sine == pytest.approx(p * rho / 2, rel=5e-4)


def test_a_kept_run_begins_where_a_new_one_does():
    """Both solves share the discrete disk, which the first solve leaves inflated."""
    mesh = {"cells": 16, "levels": 2}
    far, near = (solve("circular", alpha=0, beta=1.2, t_end=t, numerics=mesh) for t in (3.1, 2.0))
    assert far.failures == near.failures == []
    a, b = (found.points("limit_point")[0].values["p"] for found in (far, near))
    assert a == pytest.approx(b, rel=1e-10)


def test_published_limit_point_of_the_neo_hookean_disk():
    result = solve("circular", alpha=0, t_end=1.5)
    (limit,) = result.points("limit_point")
    # p R/(2 C1 h) = 1.879173469 at a pole stretch of 2.195944
    assert limit.values["p"] / 2 == pytest.approx(1.879173469, abs=1e-9)
    assert limit.values["lam_pole"] == pytest.approx(2.195944, abs=1e-6)


def test_nothing_is_released_while_the_patch_grows_and_its_stretches_keep(run):
    points = [run.adhesive.at("p", p) for p in (2.3, 2.8, 3.3)]
    assert max(abs(s.values["G"]) for s in points) < 1e-8
    poles = [s.values["lam_pole"] for s in points]
    assert np.ptp(poles) == 0.0
    assert poles[0] == pytest.approx(run.onset.values["lam_pole"], abs=1e-5)


@pytest.fixture(scope="module")
def peeling(run):
    return PeelingBranch(run, 1.4)


def test_energy_release_three_ways(run, peeling):
    state = peeling.at("front", 0.3).state
    system = peeling.system
    with system.at(state):
        values = system.monitors()
        # The potential is stationary in the unknowns, so its derivative in the front is a partial one.
        rate = system.monitor_gradient("Pi")[1]["front"]
        by_derivative = rate / (values["rho_contact"] * values["lam1_contact"])
        assert values["G"] == pytest.approx(by_derivative, rel=1e-4)  # on this mesh
        assert peeling.difference(state) == pytest.approx(values["G"], rel=1e-4)


def test_differences_of_potentials_converge_to_the_release_rate(peeling):
    state = peeling.at("front", 0.3).state
    exact = peeling.difference(state, step=2e-3)
    errors = [abs(peeling.difference(state, step=step) - exact) for step in (0.08, 0.04)]
    assert np.log2(errors[0] / errors[1]) > 3.5


def test_pull_off_is_the_minimum_of_the_release_rate(peeling):
    (point,) = peeling.special()
    columns = peeling.columns()
    assert point.kind == "pull_off"
    assert point.values["G"] <= columns["G"].min()
    outer = columns["rho_contact"] > point.values["rho_contact"]
    assert set(columns["n_negative"][outer]) == {0}
    assert set(columns["n_negative"][~outer]) == {1}


@pytest.mark.parametrize(
    ("parameters", "at", "said"),
    [
        ({"phase": "deflation"}, {}, "contact = 'adhesive'"),
        ({"phase": "peeling"}, {}, "one pressure"),
        ({"phase": "peeling"}, [("p", 1.0), ("p", 2.0)], "1, 2"),
        ({"phase": "peeling"}, {"p": 4.0}, "p_end = 3.477"),
        ({"phase": "peeling", "adhesion": "radial"}, {"p": 1.0}, "locked"),
        ({"phase": "peeling", "contact": "frictionless"}, {"p": 1.0}, "a patch that sticks"),
        ({"phase": "peeling", "p_end": 1.5}, {"p": 1.0}, "first contact at p = 2.028"),
        ({"contact": "adhesive", "p": 1.5}, {}, "phase = 'peeling'"),
        ({"l": 0}, {}, "l = 0"),
        ({"beta": 0.9}, {}, "beta = 0.9"),
        ({"contact": "frictionless"}, {"p": 60.0}, "p = 60 lies beyond p_end = 3.477; raise p_end"),
        ({}, {"G_difference": 0.1}, "G_difference"),
    ],
)
def test_refusals_name_the_value_and_what_is_allowed(parameters, at, said):
    with pytest.raises(InputError, match=said):
        solve("circular", at=at, numerics=COARSE, **parameters)


# -- seeded faults ---------------------------------------------------------------------------------

SENTINEL = Case(
    title="sentinel",
    source="tests",
    panels=(
        Panel(
            "a",
            x=Axis("p", 0, 4),
            y=Axis("t0", 0, 1),
            curves=(
                Curve(
                    circular(alpha=0.1, beta=1, contact="adhesive", phase="deflation").on(
                        cells=48, levels=2, step=0.3
                    ),
                    "deflation",
                    reference="deflation_alpha_0.1_beta_1",
                ),
            ),
        ),
    ),
    asked={"t0": 1e-6, "rho_contact": 1e-6, "lam1_contact_outer": 1e-5},
)


def wrong_pressure_sign(monkeypatch):
    monkeypatch.setattr(meridian_module, "gas_potential", lambda *given: -loads.gas_potential(*given))


def sum_of_springs_forgotten(monkeypatch):
    right = DiskHistory.write

    def write(self, *given):
        right(self, *given)
        self.model.series["moment"].set(np.zeros(1))

    monkeypatch.setattr(DiskHistory, "write", write)


def lam1_not_continued(monkeypatch):
    right = DiskHistory._outside

    def outside(self):
        radial, axial = np.split(right(self), 2)
        return np.append(1.01 * radial, axial)

    monkeypatch.setattr(DiskHistory, "_outside", outside)


@pytest.mark.parametrize("fault", [sum_of_springs_forgotten, lam1_not_continued])
def test_a_fault_in_the_weak_form_fails_named_checks(fault, monkeypatch, tmp_path):
    inflation.cache_clear()
    fault(monkeypatch)
    found = FoundCase("paper1.sentinel", 1, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    inflation.cache_clear()
    beyond = [v.check for v in outcome.verdicts if not v.passed and v.error is not None]
    assert outcome.status == "failed", outcome.errors
    assert any(name.startswith("deflation_alpha_0.1_beta_1") for name in beyond), "not a stall"


def test_with_the_wrong_sign_of_the_pressure_there_is_no_such_inflation(monkeypatch, tmp_path):
    """The membrane is inflated by suction: no state has the pressure at which deflation starts."""
    inflation.cache_clear()
    wrong_pressure_sign(monkeypatch)
    found = FoundCase("paper1.sentinel", 1, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    inflation.cache_clear()
    assert outcome.status == "error"
    assert "p = 3.477" in outcome.errors[0]
    assert "p ranges over [-" in outcome.errors[0]


def test_without_a_fault_the_same_checks_hold(tmp_path):
    found = FoundCase("paper1.sentinel", 1, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    assert outcome.status == "passed"
    of_every_case = ("trace", "identities", "marks")
    assert len([v for v in outcome.verdicts if v.check.partition(":")[0] not in of_every_case]) == 3


def test_states_before_contact_have_no_patch():
    result = solve("circular", contact="frictionless", at={"p": 1.0}, numerics=COARSE)
    quantities = result.states[0].quantities
    assert quantities["rho_contact"].value == 0.0
    assert "lam1_contact" not in quantities


@pytest.mark.parametrize(("beta", "alpha"), [(1.3, 0.1), (2.0, 0.0)])
def test_the_flat_disk_vibrates_as_a_drum(beta, alpha):
    r"""As the pressure vanishes, :math:`\mu = t (j_{0,1} \beta)^2` with the tension of the flat disk."""
    tension = 2 * (1 - beta**-6) * (1 + alpha * beta**2)
    given = {"beta": beta, "alpha": alpha, "t_end": 0.1}
    found = solve("circular", **given, at={"p": 1e-4}).states[0].quantities["eigenvalue_1"]
    assert found.value == pytest.approx(tension * (jn_zeros(0, 1)[0] * beta) ** 2, rel=1e-9)


def test_eigenvalues_do_not_depend_on_the_mesh_that_follows_the_front():
    """With almost no stiffness the springs leave the free disk's state unchanged, on any mesh."""
    numerics, at = {"levels": 2, "step": 0.3}, {"p": 3.0}
    contact, free = (
        solve("circular", **given, at=at, numerics=numerics).states[0].quantities
        for given in ({"contact": "frictionless", "k": 1e-8, "p_end": 3.2}, {"t_end": 1.2})
    )
    assert contact["X_contact"].value > 0.4
    assert contact["eigenvalue_1"].value == pytest.approx(free["eigenvalue_1"].value, rel=5e-9)


def test_where_stretches_begin_to_differ_has_their_round_off_over_their_slope():
    """Of a nearly slack disk the slope is 8e-4, and the place has errors of 1e-10 on any mesh."""
    found = solve("circular", t_end=0.1, at={"t0": 0.05})
    (state,), branch = found.states, found.branch()
    profile, place = state.fields[0].columns, state.quantities["X_iso"]
    slopes = np.gradient(profile["lam1"] - profile["lam2"], profile["X"])
    slope = np.interp(place.value, profile["X"], slopes)
    assert STRETCHES / slope == pytest.approx(rounded(place.value), rel=0.1)
    assert place.uncertainty >= rounded(place.value) > 1e-10
    assert (branch.uncertainty["X_iso"] >= rounded(branch["X_iso"])).all()
