"""Lines of critical points of tube and disk: against the problems of one parameter, and each other."""

import re

import numpy as np
import pytest

from weakforms import solve
from weakforms.api import solve_requests
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems import registry
from weakforms.problems.diagram.lines import LinesOnMesh
from weakforms.problems.diagram.parameters import DiagramParameters
from weakforms.problems.problem import StateRequest

COARSE = {"cells": 24, "levels": 2}
MESH = {"cells": 48, "levels": 2}
LONG_STEPS = MESH | {"step": 0.2}
AT = 0.07
"""A value of ``alpha`` at which a line of mirror breaking has states."""


@pytest.fixture(scope="module")
def alpha_plane():
    wanted = [StateRequest("alpha", AT, "all", "mirror"), StateRequest("alpha", AT, 1, "fold")]
    return solve_requests("diagram", {"x": "alpha", "kind": "fold,mirror"}, MESH, wanted)


@pytest.fixture(scope="module")
def onsets():
    wanted = [
        StateRequest("u_max", 2.0, 1, "wrinkling", profile=()),
        StateRequest("delta1", 1.2, 1, "contact"),
    ]
    given = {"alpha": 0.0, "kind": "wrinkling,contact", "high": 1.6}
    return solve_requests("diagram", given, MESH, wanted)


def on(result, branch):
    """The states of a branch that were asked for."""
    return [state for state in result.states if state.branch == branch]


def near(a, b, uncertainty):
    return abs(a - b) <= 2 * uncertainty + 1e-9


def test_folds_over_the_pre_stretch_are_those_of_tube_fold():
    line = solve("diagram", alpha=0.1, kind="fold", high=3.0, numerics=LONG_STEPS)
    own = solve("tube_fold", alpha=0.1, numerics=LONG_STEPS)
    (cusp,), (other,) = line.points("cusp_point"), own.points("cusp_point")
    for name in ("delta1", "p", "u_max", "V"):
        both = np.hypot(cusp.uncertainty[name], other.uncertainty[name])
        assert near(cusp.values[name], other.values[name], both), name
    assert line.failures == []


def test_both_lines_have_the_same_coincidence(alpha_plane):
    one, two = (p for p in alpha_plane.special_points if p.kind == "fold_mirror")
    assert {one.branch, two.branch} == {"fold", "mirror"}
    for name in ("alpha", "p", "u_max"):
        assert near(one.values[name], two.values[name], one.uncertainty[name] + two.uncertainty[name]), name


def test_limit_points_and_mirror_breaking_are_those_of_a_single_tube(alpha_plane):
    """The whole tube finds where its mirror symmetry breaks by itself, in the space of both symmetries."""
    tube = solve("tube", alpha=AT, extent="full", u_end=2.6, numerics=LONG_STEPS)
    (limit,), breaking = tube.points("limit_point")[:1], tube.points("bifurcation_point")
    found = sorted(s.quantities["p"].value for s in on(alpha_plane, "mirror"))
    for point in breaking:
        gap = min(abs(p - point.values["p"]) for p in found)
        assert gap <= 1e-7
    assert len(breaking) >= 1
    (fold,) = on(alpha_plane, "fold")
    assert fold.quantities["p"].value == pytest.approx(limit.values["p"], abs=1e-8)


def test_states_on_a_line_of_limit_points_have_a_zero_eigenvalue():
    given = {"x": "alpha", "kind": "fold", "u_end": 1.4, "numerics": COARSE}
    (state,) = solve("diagram", **given, at={"u_max": 1.2}, branch="fold").states
    assert abs(state.quantities["eigenvalue_1"].value) < 1e-8
    assert state.quantities["n_negative"].value == 0


def test_a_state_on_a_line_of_another_kind_is_refused():
    said = "diagram at these parameters has no branch 'mirror'; it has fold, end"
    with pytest.raises(InputError, match=said):
        solve("diagram", x="alpha", kind="fold", u_end=1.4, numerics=COARSE, at={"p": 1.5}, branch="mirror")


def test_the_parameter_falls_like_a_square_root_of_the_distance_from_a_tip(alpha_plane):
    tip = alpha_plane.points("tip_mirror")[0].values
    line = alpha_plane.branch("mirror").columns
    beside = line["u_max"] - tip["u_max"]
    chosen = np.abs(beside) < 0.3
    *_, curvature, slope, gap = np.polyfit(beside[chosen], line["alpha"][chosen] - tip["alpha"], 5)
    assert curvature < -0.01
    assert abs(slope) < 0.01 * abs(curvature)
    assert abs(gap) < 1e-6


def test_first_wrinkling_is_at_the_disk_for_pre_stretched_tubes_and_inside_otherwise(onsets):
    line = onsets.branch("wrinkling").columns
    at_disk = line["at_end"] == 1
    before = np.arange(len(at_disk)) <= np.argmax(line["delta1"])  # the tube is taut again after the rest
    assert np.all(at_disk[before & (line["delta1"] > 1.04)])
    assert not np.any(at_disk[line["delta1"] < 1.02])
    assert np.abs(line["t_min"]).max() < 1e-6


def test_the_least_resultant_of_a_profile_on_the_line_is_zero(onsets):
    """At a disk ``lam2 = delta1^-1/2``, so that ``T2 = 0`` if and only if ``lam1 = delta1`` there."""
    (state,) = on(onsets, "wrinkling")
    assert state.quantities["S_least"].value == 1.0
    assert state.quantities["at_end"].value == 1
    fields = state.fields[0].columns
    assert fields["t2"].min() == pytest.approx(0.0, abs=1e-6)
    assert fields["lam1"][-1] == pytest.approx(state.quantities["delta1"].value, abs=1e-6)


def test_first_contact_is_that_of_the_tube_against_its_substrate(onsets):
    (state,) = on(onsets, "contact")
    tube = solve("tube", alpha=0.0, delta1=1.2, contact="frictionless", p_end=2.0, numerics=LONG_STEPS)
    (onset,) = tube.points("contact_onset")
    assert state.quantities["p"].value == pytest.approx(onset.values["p"], abs=1e-8)
    assert np.all(onsets.branch("contact").columns["u_max"] == pytest.approx(0.3))


def test_lines_of_the_disk_are_those_of_the_single_disk():
    lines = solve(
        "diagram",
        body="circular",
        x="alpha",
        kind="fold",
        numerics=LONG_STEPS,
        at={"alpha": 0.02},
        branch="fold",
    )
    disk = solve("circular", alpha=0.02, t_end=2.5, numerics=LONG_STEPS)
    limits = disk.points("limit_point")
    assert lines.states[0].quantities["p"].value == pytest.approx(limits[0].values["p"], abs=1e-8)
    assert len(lines.points("cusp_point")) == 1


def test_a_line_over_the_length_is_that_of_tubes_of_that_length():
    given = {"alpha": 0.05, "x": "lf", "kind": "fold", "low": 6.0, "high": 7.0, "u_end": 1.2}
    (state,) = solve("diagram", **given, numerics=LONG_STEPS, at={"lf": 6.5}, branch="fold").states
    (limit,) = solve("tube", alpha=0.05, lf=6.5, u_end=1.2, numerics=LONG_STEPS).points("limit_point")
    assert state.quantities["p"].value == pytest.approx(limit.values["p"], abs=1e-8)


def test_a_constant_of_another_law_may_be_an_axis():
    law = {"model": "gent", "jm": 40.0}
    line = solve("diagram", **law, x="jm", low=39.0, high=41.0, u_end=1.2, kind="fold", numerics=COARSE)
    (limit,) = solve("tube", **law, u_end=1.2, numerics=COARSE).points("limit_point")
    column = line.branch("fold").columns
    assert column["jm"][[0, -1]] == pytest.approx([39.0, 41.0])
    assert np.interp(40.0, column["jm"], column["p"]) == pytest.approx(limit.values["p"], abs=1e-5)


def test_every_line_says_where_it_begins_and_why_it_ends(alpha_plane):
    for branch in alpha_plane.branches:
        begins = alpha_plane.numerics["begins"][branch.name]
        assert begins["p"] == branch.columns["p"][0]
        assert branch.ended.by in ("low", "high", "u_end")


def test_a_line_at_large_pressures_is_followed_in_few_steps_and_not_taken_for_closed():
    """With steps of one length it has more than 500 points. Longer ones are no return to the start."""
    disk = {"body": "circular", "alpha": 0.9, "kind": "contact", "beta": 2.3, "l": 3.0, "t_end": 3.1}
    result = solve("diagram", **disk, low=2.0, numerics={"cells": 8, "levels": 2, "step": 0.2})
    assert result.failures == []
    (line,) = result.branches
    assert line.columns["beta"][0] == pytest.approx(2.0)
    assert line.ended.by == "high"
    assert line.columns["p"][-1] > line.columns["p"][0] + 100
    assert len(line) < 100


def test_a_line_ends_where_the_law_gives_way_and_says_so():
    """``w,11 = 2 mu lam2 (2 - lam2/f2)`` is zero at a pole stretch of 3.332; meshes differ beyond it."""
    disk = {"body": "circular", "model": "harmonic", "f2": 1.666, "beta": 2.378, "t_end": 0.1728}
    coarse = {"cells": 8, "levels": 2, "step": 0.2}
    result = solve("diagram", **disk, kind="fold", numerics=coarse)
    assert result.failures == []
    line = result.branch("end")
    assert re.search(r"followed up to beta = 2\.98.*hardly resists.*; change low or high", line.ended.reason)
    assert 3.3 < line.columns["lam_pole"].max() < 3.332
    assert [item.what for item in result.absent] == ["rest of branch end"]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"x": "p", "y": "p"}, "x = y = 'p': a plane has two different parameters"),
        ({"x": "radius"}, "x = 'radius' is no parameter of tube"),
        ({"x": "alpha", "y": "delta1"}, "one of both must be p"),
        ({"x": "beta"}, "x = 'beta' is no parameter of tube"),
        ({"kind": "n4"}, "kind = 'n4'"),
        ({"kind": "fold,n0"}, "kind = 'n0'"),
        ({"body": "circular", "kind": "n1"}, "body = 'circular' has no lines of waves around its axis"),
        ({"model": "three_chain", "kind": "n1"}, "waves around the axis: model = 'three_chain'"),
        ({"body": "circular", "kind": "mirror"}, "body = 'circular' has no mirror"),
        ({"low": 2.0, "high": 1.5}, "the range of delta1 must be increasing"),
        ({"low": 0.5}, "between 1 and 5"),
        ({"delta1": 2.5}, "delta1 = 2.5, where lines start, is outside of low = 1, high = 2"),
        ({"model": "gent", "x": "jm"}, "set low and high, the range of jm"),
        ({"p_low": 2.0, "p_high": 1.0}, "p_low = 2 must be less than p_high = 1"),
        ({"lf": -1.0}, "lf = -1.0"),
        ({"lf": 12.5, "kind": "fold,mirror"}, "allowed with lines of kind mirror: lf up to 12"),
        ({"x": "lf", "low": 5.0, "high": 14.0, "kind": "mirror"}, "lines of kind mirror: high up to 12"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_anything_is_solved(given, message):
    with pytest.raises(InputError, match="diagram") as refused:
        solve("diagram", **given)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("given", "ends"),
    [
        ({"x": "delta1"}, (1.0, 2.0)),
        ({"x": "lf"}, (4.0, 12.0)),
        ({"x": "alpha"}, (0.0, 0.3)),
        ({"x": "beta", "body": "circular"}, (1.0, 3.0)),
        ({"x": "force", "body": "infinite_tube"}, (0.0, 3.0)),
        ({"x": "lam1", "body": "infinite_tube", "ends": "held"}, (1.05, 3.0)),
        ({"x": "lf", "low": 5.0}, (5.0, 12.0)),
    ],
)
def test_a_plane_has_a_usual_range_of_each_parameter(given, ends):
    window = DiagramParameters(**given).window
    assert (window.low, window.high) == ends


def test_a_plane_without_a_line_says_what_was_searched():
    plane = {"alpha": 0.25, "x": "alpha", "low": 0.2, "kind": "mirror", "numerics": COARSE | {"step": 0.2}}
    result = solve("diagram", **plane)
    assert result.branches == []
    (absence,) = result.absent
    assert "no point of kind mirror" in absence.reason
    assert "9 values of alpha from 0.2 to 0.3" in absence.reason
    with pytest.raises(InputError, match="no point of kind mirror"):
        solve("diagram", **plane, at={"alpha": 0.22}, branch="mirror")


def test_lines_of_mirror_breaking_are_looked_for_as_far_as_a_bulge_is_held():
    """On a longer tube all other lines are found, the result says what is not, and meshes are finer."""
    problem, usual = registry.get("diagram"), registry.get("diagram").numerics()
    longest, longer, long = (DiagramParameters(lf=lf) for lf in (12.0, 12.5, 16.5))
    assert longest.kinds == ("fold", "mirror", "wrinkling", "contact")
    assert longer.kinds == ("fold", "wrinkling", "contact")
    assert (longest.broken, longer.broken) == (("mirror",), ())
    assert problem.resolving(longer, usual).cells == usual.cells
    assert problem.resolving(long, usual).cells == 2 * usual.cells
    result = solve("diagram", lf=12.5, s=1.1, u_end=0.2, low=1.2, high=1.3, numerics=COARSE)
    assert [branch.name for branch in result.branches] == ["contact", "end"]
    said = {absence.what: absence.reason for absence in result.absent}
    assert "lf up to 12" in said["lines of kind mirror"]


def test_a_search_that_fails_costs_only_its_own_lines(monkeypatch):
    """Lines found elsewhere are followed, and the result says where nothing could be searched."""
    right, first = LinesOnMesh.starts, 1.0

    def starts(self, kind, at):
        if kind == "fold" and at == first:
            raise ConvergenceError("SNES ended")
        return right(self, kind, at)

    plane = {"alpha": 0.1, "kind": "fold,contact", "low": 1.0, "high": 1.4, "u_end": 1.6, "numerics": COARSE}
    whole = solve("diagram", **plane)
    monkeypatch.setattr(LinesOnMesh, "starts", starts)
    found = solve("diagram", **plane)
    assert {b.name for b in found.branches} == {b.name for b in whole.branches} >= {"fold", "contact"}
    assert [(f.what, f.reason) for f in found.failures] == [
        ("start of lines of kind fold at delta1 = 1", "SNES ended")
    ]
    monkeypatch.setattr(LinesOnMesh, "starts", lambda *_: starts(None, "fold", first))
    with pytest.raises(ConvergenceError, match="start of lines of kind fold at delta1 = 1: SNES ended"):
        solve("diagram", **plane)


def test_a_line_that_fails_costs_no_other_line(monkeypatch):
    """Its failure was that of the whole solve."""
    right = LinesOnMesh._both_ways

    def both_ways(self, kind, at):
        if kind == "contact":
            raise ConvergenceError("SNES ended")
        return right(self, kind, at)

    monkeypatch.setattr(LinesOnMesh, "_both_ways", both_ways)
    plane = {"alpha": 0.1, "kind": "fold,contact", "low": 1.0, "high": 1.4, "u_end": 1.6, "numerics": COARSE}
    found = solve("diagram", **plane)
    assert "fold" in {branch.name for branch in found.branches}
    assert "contact" not in {branch.name for branch in found.branches}
    assert found.failures[0].what == "start of lines of kind contact at delta1 = 1"
