"""The tube in contact: conditions at the front, history, limits, and errors that must be noticed."""

import re
from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI
from tube_data import LONG_STEPS, MESH, data

import weakforms.problems.tube.model as tube_module
from weakforms import ConvergenceError, InputError, reference, solve
from weakforms.forms import loads
from weakforms.problems.material_choice import Chosen
from weakforms.problems.tube.model import TubeMesh, TubeModel, free_branch
from weakforms.problems.tube.parameters import TubeNumerics, resolving
from weakforms.problems.tube.phases import TubePhases
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton

pytestmark = pytest.mark.paper2


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
    assert run.adhesive.points[-1].state.loads["p"] == pytest.approx(3.0, rel=1e-12)
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


@pytest.mark.slow
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
