"""`solve` at an accuracy: meshes as coarse as the bounds allow, and an answer that says which they were."""

from types import SimpleNamespace

import numpy as np
import pytest

import weakforms
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems import registry
from weakforms.problems.accuracy import at_accuracy, on_finer_meshes, widest_bound
from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.problem import validated
from weakforms.results import Absence, Branch, Failure, Quantity, Result, SpecialPoint

PROBLEM = SimpleNamespace(resolving=lambda _, numerics: numerics)


def result_with(spread, **more):
    found = Result("tube", {}, {}, {}, {}, **more)
    found.quantities["p"] = Quantity(2.0, spread)
    return found


def solving(order=4.0, at_default=1e-6, **more):
    """A problem with 96 cells by default, whose uncertainty falls with an order."""
    return lambda _, numerics: result_with(at_default * (96 / numerics.cells) ** order, **more)


def coarsest(accuracy, solve):
    return at_accuracy(accuracy, PROBLEM, MeshNumerics(), solve, None)


def test_the_meshes_are_as_coarse_as_the_bound_allows():
    found = coarsest(1e-2, solving())
    assert found.numerics["accuracy"]["meshes"] == [[6, 12, 24]]
    assert found.numerics["accuracy"]["bound"] == pytest.approx(2.56e-4)
    assert not found.failures


def test_a_bound_above_a_tenth_of_the_accuracy_is_refined():
    found = coarsest(2e-3, solving())
    assert found.numerics["accuracy"]["meshes"] == [[6, 12, 24], [12, 24, 48]]


def test_meshes_that_the_order_rules_out_are_skipped():
    found = coarsest(1e-6, solving())
    assert found.numerics["accuracy"]["meshes"] == [[6, 12, 24], [48, 96, 192]]
    assert not found.failures


def test_an_accuracy_that_is_not_reached_is_a_failure():
    found = coarsest(1e-9, solving())
    assert found.numerics["accuracy"]["meshes"][-1] == [96, 192, 384]
    assert [item.what for item in found.failures] == ["accuracy"]


def test_what_fails_or_is_absent_on_coarse_meshes_is_tried_on_finer_ones():
    def solve(_, numerics):
        if numerics.cells == 24:
            raise ConvergenceError("too coarse")
        absent = [Absence("branch", "none")] if numerics.cells == 48 else []
        return result_with(0.0, absent=absent)

    found = coarsest(1e-3, solve)
    assert found.numerics["accuracy"]["meshes"] == [[6, 12, 24], [12, 24, 48], [24, 48, 96]]


def answers(*given):
    """A solve that gives one answer for the default meshes and another for finer ones; errors are raised."""

    def solve(_, numerics):
        found = given[numerics is not None]
        if isinstance(found, ConvergenceError):
            raise found
        return found

    return solve


def once_more(solve, finer):
    return on_finer_meshes(SimpleNamespace(finer=lambda *_: finer), None, solve, None)


def test_what_does_not_converge_by_default_is_tried_on_finer_meshes_once():
    good, bad, worse = result_with(0.0), result_with(0.0), result_with(0.0)
    bad.failures = [Failure("special points", "differ")]
    worse.failures = [*bad.failures, Failure("branch", "stalled")]
    stalled, finer = ConvergenceError("stalled"), MeshNumerics(cells=192)
    assert once_more(answers(good, bad), finer) is good
    assert once_more(answers(bad, good), None) is bad
    assert once_more(answers(bad, worse), finer) is bad
    assert once_more(answers(bad, stalled), finer) is bad
    assert bad.warnings == worse.warnings == []
    assert once_more(answers(bad, good), finer) is good
    assert once_more(answers(stalled, worse), finer) is worse
    assert good.warnings == ["solved with cells = 192; on the default meshes: differ"]
    assert worse.warnings == ["solved with cells = 192; on the default meshes: stalled"]
    for second, finest in ((bad, None), (ConvergenceError("worse"), finer)):
        with pytest.raises(ConvergenceError, match=r"^stalled$"):
            once_more(answers(stalled, second), finest)


@pytest.mark.parametrize(
    ("name", "given", "chosen", "cells"),
    [
        ("tube", {}, {}, 192),
        ("tube", {"lf": 26.0}, {}, 384),
        ("tube", {}, {"cells": 24}, None),
        ("fluid_tube", {}, {}, 256),
        ("fluid_tube", {"secondary": True}, {}, None),
        ("wrinkled_patch", {}, {}, None),
        ("sphere", {}, {}, None),
    ],
)
def test_finer_meshes_are_those_along_a_line_that_nobody_chose(name, given, chosen, cells):
    problem = registry.get(name)
    parameters = validated(problem.parameters, given, name)
    finer = problem.finer(parameters, validated(problem.numerics, chosen, name))
    assert getattr(finer, "cells", None) == cells


def test_what_is_absent_on_the_default_meshes_is_absent():
    found = coarsest(1e-3, lambda *_: result_with(0.0, absent=[Absence("branch", "none")]))
    assert found.numerics["accuracy"]["meshes"][-1] == [24, 48, 96]


def test_a_bound_that_is_no_number_is_never_small_enough():
    found = coarsest(1e-3, lambda *_: result_with(float("nan")))
    assert [item.what for item in found.failures] == ["accuracy"]


def test_a_bound_is_relative_to_the_largest_value_of_its_column():
    branch = Branch("primary", "p", {"p": np.array([0.0, 4.0])}, {"p": np.array([1e-8, 1e-6])})
    point = SpecialPoint("limit_point", "primary", "p", {"p": 1e-3}, {"p": 2e-6})
    found = Result("tube", {}, {}, {}, {}, branches=[branch], special_points=[point])
    assert widest_bound(found) == (pytest.approx(1e-6), "p at a limit_point")


@pytest.mark.parametrize("accuracy", [0.0, 1e-10, 0.5, float("nan")])
def test_an_accuracy_out_of_range_is_refused(accuracy):
    with pytest.raises(InputError, match="must lie between"):
        weakforms.solve("tube", accuracy=accuracy)


def test_cells_and_an_accuracy_exclude_each_other():
    with pytest.raises(InputError, match="exclude each other"):
        weakforms.solve("tube", accuracy=1e-6, numerics={"cells": 48})


def test_a_problem_without_meshes_to_refine_refuses_an_accuracy():
    with pytest.raises(InputError, match="no accuracy can be asked"):
        weakforms.solve("material", accuracy=1e-6)


def test_a_tube_has_the_accuracy_that_is_asked_of_it():
    asked = 1e-3
    found = weakforms.solve("tube", alpha=0.1, delta1=1.1, accuracy=asked)
    usual = weakforms.solve("tube", alpha=0.1, delta1=1.1)
    assert found.numerics["meshes"][-1] < usual.numerics["meshes"][-1]
    assert not found.failures
    for near, exact in zip(found.special_points, usual.special_points, strict=True):
        for name, value in exact.values.items():
            assert near.values[name] == pytest.approx(value, rel=asked / 10, abs=1e-9)
