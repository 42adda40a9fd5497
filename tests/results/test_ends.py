"""Every branch says why it ends, idle parameters are named; states beyond an end move it or are refused."""

import numpy as np
import pytest

from weakforms import InputError, api, solve
from weakforms.problems import registry
from weakforms.problems.problem import End, ended
from weakforms.results import Absence, Branch, Ended, Failure, Result

FEW = {"cells": 16, "levels": 2, "step": 0.3}
SPHERE = {"step": 0.08}
TOUCHING = {"contact": "frictionless", "p_end": 2.5}
ADHESIVE = {"contact": "adhesive"}


def end_of(problem: str, branch: str = "primary", **given: object) -> Ended | None:
    numerics = given.pop("numerics", {})
    return solve(problem, numerics=numerics, **given).branch(branch).ended


@pytest.mark.parametrize(
    ("problem", "given", "by", "column", "value"),
    [
        ("tube", {"u_end": 1.5, "numerics": FEW}, "u_end", "u_max", 1.5),
        ("tube", TOUCHING | {"numerics": FEW}, "p_end", "p", 2.5),
        ("tube_fold", {"numerics": FEW}, "unstretched", "delta1", 1.0),
        ("circular", {"t_end": 0.8, "numerics": FEW}, "t_end", "t0", 0.8),
        (
            "circular",
            {"phase": "peeling", "p": 3, "numerics": FEW | {"cells": 48}},
            "inflation",
            "X_contact",
            pytest.approx(0.37, abs=0.05),
        ),
        ("wrinkled_patch", {"e_end": 0.03}, "e_end", "e", 0.03),
        ("sphere", {"lam_end": 3.0, "numerics": SPHERE}, "lam_end", "lam", 3.0),
        ("infinite_tube", {"lam_end": 3.0, "numerics": SPHERE}, "lam_end", "lam2", 3.0),
        ("homogeneous", {"lam_end": 0.5, "numerics": SPHERE}, "lam_end", "lam", 0.5),
    ],
)
def test_a_branch_names_the_parameter_that_ends_it(problem, given, by, column, value):
    found = end_of(problem, **given)
    assert (found.by, found.column, found.value) == (by, column, value)


def test_a_fold_line_that_returns_says_so():
    assert end_of("sphere", "fold", vary="alpha", vary_end=0.3, numerics=SPHERE).by == "start"


@pytest.mark.parametrize("name", [name for name, about in registry.abouts().items() if about.columns])
def test_every_problem_with_branches_declares_its_ends(name):
    problem = registry.get(name)
    for branch in problem.about.branches:
        if (name, branch) == ("sphere", "fold"):
            continue  # needs a constant
        ends = problem.ends(problem.parameters(), branch)
        assert ends
        assert {end.column for end in ends} <= {column.name for column in problem.about.columns}


ENDS = [End("u_end", "u", 5.0), End("part", "p", lambda columns: 0.5 * max(columns["p"]))]


def result_of(u: list[float], p: list[float], **more: list) -> tuple[Branch, Result]:
    branch = Branch("primary", "p", {"u": np.array(u), "p": np.array(p)})
    return branch, Result("x", {}, {}, {}, {}, [branch], **more)


@pytest.mark.parametrize(
    ("u", "p", "more", "by"),
    [
        ([0, 4, 5], [0, 1, 2], {}, "u_end"),
        ([0, 4, 5.1], [0, 1, 2], {}, "u_end"),
        ([0, 4, 4.9], [0, 8, 3.9], {}, "part"),
        ([0, 6, 7], [0, 1, 2], {}, None),  # passed long before: not why it ends
        ([0, 1, 2], [0, 1, 2], {"failures": [Failure("branch primary", "stalled")]}, "failure"),
        ([0, 1, 2], [0, 1, 2], {"failures": [Failure("branch secondary", "stalled")]}, None),
        ([0, 1, 2], [0, 1, 2], {"absent": [Absence("rest of branch primary", "gives way")]}, "absent"),
        ([0, 4, 5], [0, 1, 2], {"failures": [Failure("branch primary", "coarse")]}, "u_end"),
    ],
)
def test_only_what_the_last_step_meets_ends_a_branch(u, p, more, by):
    found = ended(*(result_of(u, p, **more)[:1]), ENDS, result_of(u, p, **more)[1])
    assert (found and found.by) == by
    if by in ("failure", "absent"):
        assert (found.column, found.value, bool(found.reason)) == ("p", 2.0, True)


@pytest.mark.parametrize(
    ("problem", "given", "at", "said"),
    [
        ("tube", {"u_end": 3}, {"u_max": 5}, r"tube: u_max = 5 lies beyond u_end = 3; raise u_end"),
        ("tube", TOUCHING, {"p": 5}, r"tube: p = 5 lies beyond p_end = 2.5; raise p_end"),
        ("circular", {"t_end": 1}, {"t0": 1.5}, "t0 = 1.5 lies beyond t_end = 1; raise t_end"),
        ("sphere", {"lam_end": 3}, {"lam": 3.5}, "lam = 3.5 lies beyond lam_end = 3; raise lam_end"),
    ],
)
def test_a_state_beyond_the_end_is_refused_before_anything_is_solved(problem, given, at, said, monkeypatch):
    monkeypatch.setattr(type(registry.get(problem)), "solve", lambda *_: pytest.fail("it was solved"))
    with pytest.raises(InputError, match=said):
        solve(problem, at=at, **given)


@pytest.mark.parametrize(
    ("problem", "given", "at", "end"),
    [
        ("tube", {"lf": 3}, {"u_max": 5.5}, {"u_end": 5.5}),
        ("tube", {"alpha": 0.05}, {"limit_point": 2}, {"u_end": 10}),
        ("tube", {"contact": "frictionless"}, {"p": 3.2}, {"p_end": 3.2}),
        ("circular", {}, {"t0": 2.3}, {"t_end": 2.3}),
        ("sphere", {}, {"lam": 9}, {"lam_end": 9}),
        ("sphere", {"model": "gent"}, {"limit_point": 2}, {"lam_end": 6}),
    ],
)
def test_a_branch_with_its_default_end_is_followed_to_a_state_beyond_it(problem, given, at, end):
    numerics = SPHERE if problem == "sphere" else FEW
    with pytest.warns(UserWarning, match="the branch was followed further"):
        result = solve(problem, at=at, numerics=numerics, **given)
    ((name, value),) = end.items()
    assert (result.parameters[name], len(result.states), result.failures) == (value, 1, [])
    assert result.branches[0].ended.by == name
    assert len(result.warnings) == 1
    assert result.warnings[0].startswith(f"{name} = {value:g} instead of the default")


@pytest.mark.parametrize(
    ("problem", "given", "at", "said"),
    [
        ("tube", {}, {"u_max": 12}, r"lies beyond u_end = 5; raise u_end \(allowed: up to 10\)"),
        ("tube", {"lf": 3}, {"p": 30}, "ends at u_max = 10 .u_end., the end of its range"),
        ("tube", ADHESIVE | {"phase": "deflation"}, {"p": 4}, "p = 4 lies beyond p_end = 3; raise p_end$"),
        ("sphere", {"lam_end": 3.5, "model": "gent"}, {"limit_point": 2}, "ends at lam = 3.5"),
    ],
)
def test_a_branch_is_not_followed_beyond_a_range_or_an_end_that_was_set(problem, given, at, said):
    """Deflation begins at ``p_end``: from a higher pressure it would be another history."""
    with pytest.raises(InputError, match=said):
        solve(problem, at=at, numerics=SPHERE if problem == "sphere" else FEW, **given)


@pytest.mark.parametrize(
    ("problem", "given", "reason"),
    [
        ("tube", {"alpha": 0.05}, "before a limit point at u_max = 6.004; raise u_end"),
        ("tube", {"alpha": 0.1}, ""),
        ("sphere", {"model": "gent"}, "before a limit point at lam = 4.085; raise lam_end"),
    ],
)
def test_a_branch_that_ends_before_a_limit_point_says_so(problem, given, reason):
    result = solve(problem, numerics=SPHERE if problem == "sphere" else FEW, **given)
    assert result.branches[0].ended.reason == reason


@pytest.mark.parametrize(
    ("problem", "given", "at", "said"),
    [
        ("tube", {"u_end": 1.5}, {"p": 2.5}, "p = 2.5 is not taken .* the branch ends at u_max = 1.5"),
        ("tube", {"model": "ogden", "u_end": 0.5}, {"p": 2.5}, "ends at u_max = 0.5 .u_end."),
        ("tube", TOUCHING, {"u_max": 4.0}, "u_max = 4 is not taken .* the branch ends at p = 2.5 .p_end."),
        (
            "sphere",
            {"lam_end": 1.2},
            {"limit_point": 1},
            "this branch has none; the branch ends at lam = 1.2 .lam_end.",
        ),
    ],
)
def test_a_state_that_is_not_on_the_branch_is_answered_with_its_end(problem, given, at, said):
    with pytest.raises(InputError, match=said):
        solve(problem, at=at, numerics=FEW if problem == "tube" else SPHERE, **given)


@pytest.mark.parametrize(
    ("problem", "given", "idle", "needed"),
    [
        ("tube", {"k": 3, "u_end": 0.3}, {"k": 30}, "contact = frictionless or adhesive"),
        ("tube", {"s": 3, "u_end": 0.3}, {"s": 4}, "contact = frictionless or adhesive"),
        ("tube", {"p_end": 3, "u_end": 0.3}, {"p_end": 1}, "contact = frictionless or adhesive"),
        ("tube", {"spring": "unilateral", "u_end": 0.3}, {"spring": "bilateral"}, "phase = deflation"),
        ("tube", TOUCHING | {"u_end": 1}, {"u_end": 4}, "contact = none"),
        ("circular", {"k": 3, "t_end": 0.6}, {"k": 30}, "adhesive or phase = peeling"),
        ("circular", {"l": 3, "t_end": 0.6}, {"l": 0.4}, "adhesive or phase = peeling"),
        ("circular", {"p_end": 3, "t_end": 0.6}, {"p_end": 0.4}, "adhesive or phase = peeling"),
        ("circular", {"adhesion": "radial", "t_end": 0.6}, {"adhesion": "locked"}, "contact = adhesive or"),
        ("circular", TOUCHING | {"t_end": 1}, {"t_end": 3}, "contact = none and phase = inflation"),
        ("sphere", {"vary_end": 3.0}, {"vary_end": 1.0}, "vary"),
    ],
)
def test_a_parameter_without_effect_is_a_warning_and_changes_no_number(problem, given, idle, needed):
    few = SPHERE if problem == "sphere" else FEW
    name = next(iter(idle))
    with pytest.warns(UserWarning, match=rf"{problem}: {name} = .* has no effect here; it needs .*{needed}"):
        first = solve(problem, numerics=few, **given)
    with pytest.warns(UserWarning, match="no effect"):
        second = solve(problem, numerics=few, **given | idle)
    assert len(first.warnings) == 1
    kept = [
        {k: v for k, v in r.to_json().items() if k not in ("parameters", "provenance", "warnings")}
        for r in (first, second)
    ]
    assert kept[0] == kept[1]


@pytest.mark.parametrize(
    ("problem", "given"),
    [
        ("tube", TOUCHING | {"k": 3, "s": 1.2}),
        ("tube", {"contact": "adhesive", "phase": "deflation", "spring": "unilateral"}),
        ("circular", {"phase": "peeling", "p": 2, "adhesion": "locked", "k": 10, "l": 0.4}),
        ("wrinkled_tube", {"n": (20,), "beta": 0.1}),
        ("surface", {"geometry": "hemisphere", "size": 0.2}),
        ("sphere", {"vary": "alpha", "vary_end": 0.3}),
    ],
)
def test_a_parameter_with_an_effect_is_no_warning(problem, given):
    assert registry.get(problem).parameters(**given).without_effect() == []


@pytest.mark.parametrize("given", [{"unit": 2.0}, {"mesh": "square", "held": "rim"}, {"mirror": "left"}])
def test_what_describes_a_file_has_no_effect_on_a_membrane_without_one(given):
    (said,) = registry.get("membrane").parameters(**given).without_effect()
    assert said.endswith("has no effect here; it needs mesh = FILE")
    assert registry.get("membrane").parameters(**given | {"mesh": "part.msh"}).without_effect() == []


def test_parameters_left_at_their_defaults_are_no_warning():
    for problem in registry.problems().values():
        assert problem.parameters().without_effect() == []
        assert set(problem.parameters.needs) <= set(problem.parameters.model_fields)


def test_every_crossing_of_a_value_is_solved_for_when_asked():
    found = solve("tube", delta1=1.1, at={"p": 1.9}, crossing="all", numerics=FEW)
    assert [(s.crossing, s.crossings) for s in found.states] == [(1, 3), (2, 3), (3, 3)]
    heights = [s.quantities["u_max"].value for s in found.states]
    assert heights == sorted(heights)
    assert len({round(u, 6) for u in heights}) == 3


def test_a_single_crossing_says_how_many_there_are():
    found = solve("tube", delta1=1.1, at={"p": 1.9}, numerics=FEW)
    assert [(s.crossing, s.crossings) for s in found.states] == [(1, 3)]
    at_point = solve("tube", delta1=1.1, at={"limit_point": 1}, numerics=FEW)
    assert at_point.states[0].crossings is None


def test_a_crossing_below_one_is_refused():
    with pytest.raises(InputError, match="crossing = 0 must be 1 or more, or 'all'"):
        api.prepare("tube", {}, {}, {"p": 1}, 0)


def test_the_last_points_of_a_branch_are_compared_with_their_neighbours_on_coarser_meshes():
    """A coarser mesh's branch ends just before; the plane there cuts it again far away, where p is 9."""
    given = {"alpha": 0.0, "beta": 1.5, "t_end": 2.0}
    branch = solve("circular", **given, numerics={"cells": 32, "levels": 2}).branch()
    assert branch["t0"][-1] > 2.0
    assert max(branch.uncertainty["p"][-2:] / branch["p"][-2:]) < 1e-3
