"""The tube in contact: conditions at the front, history, limits, and errors that must be noticed."""

import re
from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

import weakforms.problems.tube.model as tube_module
from weakforms import ConvergenceError, InputError, reference, solve
from weakforms.forms import loads
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.tube.contact import ContactData
from weakforms.problems.tube.model import TubeMesh, TubeModel, free_branch
from weakforms.problems.tube.parameters import TubeNumerics, resolving
from weakforms.problems.tube.phases import TubePhases
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.support.sampling import Sampler

pytestmark = pytest.mark.paper2
MESH = {"cells": 48, "levels": 2}
LONG_STEPS = MESH | {"step": 0.3}
"""For states and ends, which do not depend on how many points the trace has."""


def data(**changes):
    given = {"alpha": 0.1, "delta1": 1.0, "lf": 6.0, "k": 20.0, "s": 1.3} | changes
    return ContactData(mooney_rivlin_of(given.pop("alpha")), **given, cells=12, degree=4, grading=0.6)


@pytest.fixture(scope="module")
def run():
    return TubePhases(MPI.COMM_SELF, data(), p_end=3.0, step=0.08, terms=14)


def test_front_is_where_the_membrane_touches(run):
    for branch in (run.frictionless, run.adhesive):
        for point in branch.points:
            assert abs(point.monitors["gap"]) < 1e-11
            assert 0 < point.state.loads["front"] < 3


def test_contact_begins_where_free_inflation_touches(run):
    assert run.free.points[-1].monitors["u_max"] == pytest.approx(0.3, abs=1e-12)
    assert run.frictionless.points[0].state.loads["p"] == pytest.approx(run.onset.values["p"], abs=2e-6)


def test_frictionless_contact_keeps_both_first_integrals():
    numerics = {"cells": 96, "step": 0.3}
    result = solve("tube", contact="frictionless", p_end=2.6, at={"p": 2.5}, numerics=numerics)
    field = result.states[0].fields[0]
    for name in ("F_axial", "H"):
        values = field.columns[name]
        assert np.ptp(values) <= 4 * field.uncertainty[name]
        assert field.uncertainty[name] < 1e-5


def test_stuck_points_keep_stretch_at_the_mid_plane_and_no_line_force_while_the_patch_grows(run):
    first = run.onset.values["lam1_mid"]
    for point in run.adhesive.points[1:]:
        assert point.monitors["lam1_mid"] == pytest.approx(first, abs=1e-9)
        assert point.monitors["line_force"] < 1e-4


def test_deflation_begins_where_inflation_ends(run):
    start, end = run.deflation.points[0], run.adhesive.at("p", 3.0)
    assert start.state.loads["p"] == pytest.approx(3.0, abs=1e-12)
    assert start.monitors["u_max"] == pytest.approx(end.values["u_max"], abs=1e-12)
    assert start.monitors["line_force"] < 1e-4


def test_a_hard_substrate_holds_the_tube_at_its_radius():
    run = TubePhases(MPI.COMM_SELF, data(k=5000.0), p_end=2.0, step=0.08)
    for branch in (run.frictionless, run.adhesive):
        assert branch.at("p", 2.0).values["u_max"] == pytest.approx(0.3, abs=1e-3)
    assert run.adhesive.at("p", 2.0).values["line_force"] < 1e-4


@pytest.mark.parametrize("phase", ["inflation", "deflation"])
def test_a_tube_that_does_not_reach_its_substrate_stays_free_and_says_so(phase):
    given = {"contact": "adhesive", "phase": phase, "delta1": 1.5, "numerics": MESH}
    result = solve("tube", **given, p_end=0.4, at={"p": 0.3})
    assert result.failures == []
    assert [item.what for item in result.absent] == ["contact"]
    assert "p_end = 0.4 is below first contact at p = " in result.absent[0].reason
    free = solve("tube", delta1=1.5, u_end=0.3, at={"p": 0.3}, numerics=MESH)
    columns = result.branch().columns
    ends = (0.4, 0.0) if phase == "deflation" else (0.0, 0.4)
    assert columns["p"][0] == pytest.approx(ends[0], abs=1e-9)
    assert columns["p"][-1] == pytest.approx(ends[1], abs=0.1)
    assert not columns["contact_length"].any()
    alone, both = free.states[0].quantities["u_max"], result.states[0].quantities["u_max"]
    assert abs(alone.value - both.value) <= 2 * (alone.uncertainty + both.uncertainty)


def test_states_before_and_after_contact_are_told_apart():
    result = solve("tube", contact="frictionless", at=[("p", 1.2), ("p", 2.0)], numerics=MESH)
    free, touching = (state.quantities["u_max"].value for state in result.states)
    assert free < 0.3 < touching
    (onset,) = result.points("contact_onset")
    assert onset.values["u_max"] == pytest.approx(0.3, abs=1e-12)
    columns = result.branch().columns
    assert np.all(np.diff(columns["p"]) > 0)
    assert np.all((columns["contact_length"] > 0) == (columns["Z_front"] > 0))


# -- far from the tube, long patches, laws that give way ---------------------------------------------


@pytest.mark.parametrize(
    "changes", [{"delta1": 1.5, "k": 100.0, "s": 1.6}, {"lf": 5.0, "delta1": 1.2, "k": 5.0, "s": 1.8}]
)
def test_a_patch_that_is_still_short_at_p_end_has_its_history(changes):
    """The first edges of the history come before the first point of the frictionless trace."""
    run = TubePhases(MPI.COMM_SELF, data(**changes), p_end=3.0, step=0.08, terms=22)
    (edge,) = {run.frictionless.points[0].state.loads["front"]}
    before = run._slipped(edge / 2)
    assert before.state.loads["front"] == pytest.approx(edge / 2, rel=1e-12)
    assert run.onset.values["p"] < before.values["p"] < run.frictionless.points[0].state.loads["p"]
    assert run.adhesive.points[-1].state.loads["p"] > 3.0
    for point in run.adhesive.points[1:]:
        assert point.monitors["lam1_mid"] == pytest.approx(run.onset.values["lam1_mid"], abs=1e-9)
        assert point.monitors["line_force"] < 1e-4


@pytest.mark.parametrize(
    ("changes", "p_end"),
    [
        ({"alpha": 0.0, "s": 2.6, "k": 100.0}, 3.0),
        pytest.param({"alpha": 0.0, "s": 2.2, "k": 100.0}, 3.0, marks=pytest.mark.slow),
        ({"alpha": 0.08653, "delta1": 1.426, "lf": 10.78, "k": 110.9, "s": 1.199}, 12.0),
    ],
)
def test_a_patch_that_grows_far_beyond_the_frictionless_one_has_its_history(changes, p_end):
    """It was looked for with frictionless states, which are not there, or far away."""
    run = TubePhases(MPI.COMM_SELF, data(**changes), p_end=p_end, step=0.08, terms=22)
    slipping = run._slipping_span()
    last = run.adhesive.at("p", p_end).state.loads["front"]
    assert slipping < last <= run.history.span * (1 + 1e-6)
    assert run.history.span < 1.3 * last
    for point in run.adhesive.points[1:]:
        assert point.monitors["lam1_mid"] == pytest.approx(run.onset.values["lam1_mid"], abs=1e-9)
        assert point.monitors["line_force"] < 1e-3


def test_the_first_patch_against_a_stiff_spring_is_found_by_way_of_soft_ones():
    """Newton's method led from the free membrane to stretches beyond the longest chain."""
    law = Chosen("three_chain", (("nkt", 0.3411), ("links", 368.7)))
    far = replace(data(delta1=1.507, lf=39.8, k=1778.0, s=14.81), law=law, cells=48)
    run = TubePhases(MPI.COMM_SELF, far, p_end=11.0, step=0.08)
    solver = ExtendedNewton(run.slip.system, ["p", "front"])
    conditions = [Held("gap", 0.0), Held("front", run.first_front * far.length)]
    with pytest.raises(ConvergenceError):
        solver.solve(run.small_patch(), conditions)
    found = run._stiffened(solver, run.small_patch(), conditions)
    assert found.loads["k"] == 1778.0
    again, record = solver.solve(found, conditions)
    assert record.iterations <= 2
    assert again.loads["p"] == pytest.approx(run.onset.values["p"], rel=1e-2)


def test_a_largest_value_is_found_between_the_nodes():
    """At p = 3 the spring's largest force is inside the patch: its nodal values have errors of 1e-7."""
    table = reference(2, "off_contact_deflation_bilateral_alpha_0.1_delta1_1.5_lf_6")
    finer = replace(data(delta1=1.5, k=100.0, s=1.6), cells=24)
    run = TubePhases(MPI.COMM_SELF, finer, p_end=3.0, step=0.08, terms=18)
    assert table.columns["p"][-1] == 3.0
    found = run.adhesive.at("p", 3.0).values["spring_max"]
    assert found == pytest.approx(table.columns["spring_max"][-1], rel=1e-8)


def test_contact_is_followed_until_the_patch_holds_nearly_all_of_the_tube():
    given = {"alpha": 0.035, "lf": 1.5, "delta1": 1.5, "s": 1.015, "k": 15.0}
    end = TubePhases(MPI.COMM_SELF, data(**given), p_end=10.0, step=0.08).frictionless.points[-1]
    assert end.state.loads["p"] > 10.0
    assert 0.97 < end.state.loads["front"] / 0.75 < 1.0


def test_a_pressure_at_once_after_contact_is_refused_with_the_least_one(run):
    close = run.onset.values["p"] + 1e-9
    with pytest.raises(InputError, match=r"p_end = .* too close above first contact at p = 1\.43859"):
        TubePhases(MPI.COMM_SELF, data(), p_end=close, step=0.08).frictionless  # noqa: B018


def test_a_substrate_that_is_never_touched_is_told_with_the_largest_radius_that_is():
    given = {"model": "varga", "lf": 2.6, "delta1": 1.2, "s": 2.9, "contact": "adhesive", "numerics": MESH}
    result = solve("tube", **given)
    assert result.failures == []
    (contact, rest) = result.absent
    assert re.search(r"s = 2\.9 is not touched.*lower s to less than 2\.5", contact.reason)
    assert "hardly resists" in rest.reason
    assert 1.5 < result.branch().columns["u_max"][-1] < 1.6
    with pytest.raises(InputError, match=r"s = 2\.9 is not touched"):
        solve("tube", **given, phase="deflation")


def test_a_pressure_that_is_not_reached_is_told():
    given = {"model": "varga", "lf": 20.0, "delta1": 1.4, "s": 1.4, "k": 8.0, "p_end": 10.0}
    given["numerics"] = LONG_STEPS
    told = r"followed up to p = .*, not p_end = 10.*lower p_end"
    result = solve("tube", **given, contact="frictionless")
    assert result.failures == []
    assert re.search(told, result.absent[0].reason)
    adhesive = solve("tube", **given, contact="adhesive")
    assert adhesive.failures == []
    assert re.search(told, adhesive.absent[0].reason)
    assert adhesive.branch().columns["u_max"].max() == pytest.approx(0.4, abs=1e-9)


def test_default_meshes_resolve_the_edge_of_a_bulge_in_a_long_tube():
    """On 24 cells a half the pressure of a bulge that spreads wavers: three limit points, where one is."""
    gent = Chosen("gent", (("shear", 1.0), ("jm", 97.2)))
    coarsest = resolving(26.0, TubeNumerics()).meshes[0]
    assert (coarsest, resolving(6.0, TubeNumerics()), resolving(26.0, TubeNumerics(cells=24)).cells) == (
        48,
        TubeNumerics(),
        24,
    )
    system = TubeModel.free(MPI.COMM_SELF, gent, 1.0, 26.0, TubeMesh(coarsest, 4, 0.6)).system
    assert len(free_branch(system, 1.0, 4.57, 0.08).turns()) == 1


def test_a_whole_tube_too_long_to_hold_its_bulge_is_refused():
    with pytest.raises(InputError, match="allowed: lf up to 30, or extent = 'half'"):
        solve("tube", extent="full", lf=45.24)


# -- seeded faults ---------------------------------------------------------------------------------

right = loads.substrate_potential


def reference_area(rho, slope, k, s, touching):
    return k * touching * s * (rho - s) ** 2 * slope / 2


def half_stiffness(rho, slope, k, s, touching):
    return right(rho, slope, k / 2, s, touching)


def outside_instead(rho, slope, k, s, touching):
    return right(rho, slope, k, s, 1.0 - touching)


def u_max_at_2():
    return (
        solve("tube", contact="frictionless", at={"p": 2.0}, numerics=LONG_STEPS, p_end=2.5)
        .states[0]
        .quantities["u_max"]
    )


def table_value():
    table = reference(2, "fig06a_alpha_0.1_delta1_1")
    row = int(np.argmin(np.abs(table.columns["p"] - 2.0)))
    return table.columns["u_max"][row]


def test_without_a_fault_the_value_is_the_references():
    found = u_max_at_2()
    assert abs(found.value - table_value()) <= 2 * found.uncertainty + 1e-10


@pytest.mark.parametrize("fault", [reference_area, half_stiffness, outside_instead])
def test_a_fault_in_the_foundation_is_noticed(fault, monkeypatch):
    monkeypatch.setattr(tube_module, "substrate_potential", fault)
    found = u_max_at_2()
    assert abs(found.value - table_value()) > 1e4 * found.uncertainty


def test_eigenvalues_do_not_depend_on_the_mesh_that_follows_the_front():
    """With almost no stiffness the foundation leaves the free tube's state unchanged, on any mesh."""
    numerics, at = {"cells": 96, "levels": 2, "step": 0.3}, {"Z_front": 0.5}
    contact = solve("tube", contact="frictionless", k=1e-8, at=at, numerics=numerics).states[0].quantities
    depth = contact["u_max"].value
    free = solve("tube", u_end=depth + 0.1, at={"u_max": depth}, numerics=numerics).states[0].quantities
    assert contact["eigenvalue_1"].value == pytest.approx(free["eigenvalue_1"].value, rel=1e-8)


# -- a spring that only pushes ----------------------------------------------------------------------


@pytest.fixture(scope="module")
def unilateral():
    given = replace(data(delta1=2.0), unilateral=True)
    return TubePhases(MPI.COMM_SELF, given, p_end=3.0, step=0.08, terms=19)


def test_the_mesh_follows_the_place_where_the_spring_lets_go(unilateral):
    pressed, going, released = (getattr(unilateral, part) for part in unilateral.deflations)
    front, places = pressed.points[0].state.loads["front"], going.over_points("let_go")
    assert places[0] == pytest.approx(front, rel=1e-4)
    assert np.all(np.diff(places) < 0)
    assert places[-1] == pytest.approx(0.012, abs=1e-12)
    for point in going.points:
        assert abs(point.monitors["let_go_gap"]) < 1e-11
        assert point.state.loads["front"] == front
    u = [branch.over_points("u_max") for branch in (pressed, going, released)]
    assert u[0][-1] == pytest.approx(u[1][0], abs=1e-10)
    assert u[2][0] == pytest.approx(0.3, abs=1e-12)
    assert u[1][-1] == pytest.approx(0.3, abs=1e-5)
    assert np.all(np.diff(np.concatenate(u)) < 1e-9)


def test_the_spring_pushes_up_to_where_it_lets_go_and_not_beyond(unilateral):
    going = unilateral.letting_go
    system, point = going.system, going.points[len(going.points) // 2]
    places = np.array([0.5, 0.99, 1.01, 1.1]) * point.state.loads["let_go"]
    with system.at(point.state):
        at = system.formulation.locate(places, point.state.loads)
        f_k = Sampler(system.unknown, system.formulation.profile, at)()["f_k"]
    assert np.all(f_k[:2] < 0)
    assert np.all(f_k[2:] == 0)


def lets_go(alpha, at=()):
    given = {"contact": "adhesive", "phase": "deflation", "spring": "unilateral", "delta1": 2.0}
    return solve("tube", alpha=alpha, **given, at=at, numerics=LONG_STEPS)


@pytest.fixture(scope="module")
def of_the_table():
    """Deflation with some of the rows of a table, and these rows."""
    table = reference(2, "fig06b_deflation_unilateral_alpha_0.1_delta1_2")
    rows = [list(table.columns["p"]).index(p) for p in (2.8, 1.2, 0.0)]
    return lets_go(0.1, [("p", float(table.columns["p"][row])) for row in rows]), table, rows


@pytest.mark.parametrize("alpha", [0.0, 0.1])
def test_tractions_where_a_spring_just_lets_go_have_the_uncertainty_of_round_off(alpha, of_the_table):
    """The state at which the mesh begins to follow that place is there twice, on both meshes."""
    (branch,) = (of_the_table[0] if alpha else lets_go(alpha)).branches
    (i,) = np.flatnonzero(np.diff(branch.columns["p"]) == 0)[:1]
    for name in ("traction_max", "traction_front", "line_force", "V"):
        values, uncertainty = branch.columns[name][i : i + 2], branch.uncertainty[name][i : i + 2]
        assert abs(values[1] - values[0]) <= 2 * np.hypot(*uncertainty), name
        assert 2 * uncertainty.max() < 1e-3, "sharp enough to be judged"


def test_tractions_of_a_unilateral_spring_are_those_of_the_table(of_the_table):
    result, table, rows = of_the_table
    for row, state in zip(rows, result.states, strict=True):
        for name in ("traction_max", "line_force", "u_max"):
            found, theirs = state.quantities[name], table.columns[name][row]
            bound = 2 * np.hypot(found.uncertainty, table.uncertainty[name])
            assert abs(found.value - theirs) <= bound < 1e-4


# -- the whole tube ----------------------------------------------------------------------------------

PHASES = (
    {"contact": "frictionless"},
    {"contact": "adhesive"},
    {"contact": "adhesive", "phase": "deflation"},
    {"contact": "adhesive", "phase": "deflation", "spring": "unilateral"},
)


@pytest.mark.parametrize("phase", PHASES, ids=lambda phase: "_".join(phase.values()))
def test_the_whole_tube_has_the_states_of_the_half_one(phase):
    given = {**phase, "delta1": 1.2, "p_end": 2.2, "at": {"p": 2.0}, "numerics": LONG_STEPS}
    half, whole = (solve("tube", extent=extent, **given) for extent in ("half", "full"))
    assert whole.failures == []
    assert [point.kind for point in whole.special_points] == [point.kind for point in half.special_points]
    doubled = {"V", "Pi"}
    modal = {"eigenvalue_1", "n_negative"}
    of_half, of_whole = (found.states[0].quantities for found in (half, whole))
    assert of_half.keys() == of_whole.keys()
    for name in of_half.keys() - modal:
        factor = 2 if name in doubled else 1
        allowed = factor * of_half[name].uncertainty + of_whole[name].uncertainty
        assert abs(factor * of_half[name].value - of_whole[name].value) <= allowed
    assert of_whole["eigenvalue_1"].value <= of_half["eigenvalue_1"].value + 1e-9
    upper, profile = half.states[0].fields[0].columns, whole.states[0].fields[0].columns
    middle = len(profile["Z"]) // 2
    for name, parity in {"rho": 1, "eta": -1, "lam1": 1, "t2": 1, "f_k": 1}.items():
        values = profile[name]
        assert values[middle:][::2] == pytest.approx(upper[name][::4], abs=1e-8)
        assert values == pytest.approx(parity * values[::-1], abs=1e-8)


def test_both_fronts_of_the_whole_tube_touch():
    run = TubePhases(MPI.COMM_SELF, replace(data(), full=True), p_end=1.8, step=0.08, terms=14)
    for branch in (run.frictionless, run.adhesive):
        for point in branch.points:
            assert abs(point.monitors["gap"]) + abs(point.monitors["gap_lower"]) < 1e-11
            # The slope at the edge of the first, tiny patch is 2e-5: a gap of round-off moves it by 1e-7.
            fronts = point.state.loads["front"], point.state.loads["front_lower"]
            assert fronts[0] == pytest.approx(-fronts[1], abs=1e-6 if point is branch.points[0] else 1e-9)


def test_a_substrate_behind_the_limit_point_breaks_the_symmetry_in_contact():
    given = {"alpha": 0.0, "contact": "frictionless", "s": 2.2, "p_end": 1.8, "numerics": LONG_STEPS}
    whole = solve("tube", extent="full", **given)
    (point,) = whole.points("bifurcation_point")
    half = solve("tube", extent="half", **given, at={"u_max": point.values["u_max"]})
    kinds = ["limit_point", "contact_onset", "limit_point"]
    assert [point.kind for point in half.special_points] == kinds
    assert [point.kind for point in whole.special_points] == [*kinds, "bifurcation_point"]
    assert half.branch().columns["n_negative"][-1] == 0
    assert whole.branch().columns["n_negative"][-1] == 1
    assert point.values["Z_front"] > 0
    allowed = 2 * point.uncertainty["p"]
    (same,) = half.states
    assert same.quantities["p"].value == pytest.approx(point.values["p"], abs=allowed)
