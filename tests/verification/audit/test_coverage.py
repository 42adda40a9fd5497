"""Uncertainties against true errors: sets that are held out, what is kept of them, and how they are shown."""

import json
import math
from dataclasses import replace
from io import StringIO
from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import BaseModel
from rich.console import Console

from weakforms import api
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems import registry
from weakforms.problems.about import Family
from weakforms.problems.problem import Requests, StateRequest, validated
from weakforms.results import Branch, Quantity, Result
from weakforms.verification.audit.coverage import hold_out, judged, verb
from weakforms.verification.audit.coverage.families import FAMILIES, SEED
from weakforms.verification.audit.coverage.judged import Judged
from weakforms.verification.audit.coverage.outcome import (
    NAME,
    Coverage,
    Covered,
    Missed,
    Part,
    load_coverage,
    markdown,
    outcome,
    print_part,
)
from weakforms.verification.audit.same import Number
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render, render_whole

GOOD = Judged("tube", (("alpha", 0.1),), "quantity p", "quantity", "p", 1e-6, 2e-6, 0.0, 1e-10)
BAD = replace(GOOD, error=5e-6)
WIDE = replace(GOOD, error=1e-8)


# -- what is held out ------------------------------------------------------------------------------


def test_every_problem_is_held_out_or_it_is_said_why_not():
    covered = {family.problem for family in hold_out.held_out()}
    assert covered | set(hold_out.WITHOUT) == set(registry.abouts())
    assert not covered & set(hold_out.WITHOUT)
    assert any(family.branch == "secondary" for family in hold_out.FURTHER)
    assert len({family.name for family in hold_out.held_out()}) == len(hold_out.held_out())


def test_nothing_of_the_tuned_sets_is_drawn_again():
    assert hold_out.SEED != SEED
    for family in FAMILIES:
        tuned, held = (
            {tuple(given[name] for name in family.ranges) for given in one.sets(16, seed)}
            for one, seed in ((family, SEED), (hold_out.widened(family), hold_out.SEED))
        )
        assert not tuned & held
        assert len(held) == 16


def test_ranges_are_wider_as_far_as_the_problem_allows():
    by_name = {family.name: hold_out.widened(family).ranges for family in FAMILIES}
    assert by_name["tube"]["lf"] == pytest.approx((3.0, 9.0))
    assert by_name["tube"]["delta1"] == pytest.approx((1.0, 1.75)), "1 is the least that it takes"
    assert by_name["tube"]["alpha"] == pytest.approx((0.0, 0.37))
    assert by_name["hemisphere"]["gamma"] == pytest.approx((1.0, 4.625))
    for family in FAMILIES:
        for name, (low, high) in family.ranges.items():
            least, most = by_name[family.name][name]
            assert least <= low < high < most


def test_a_range_that_the_problem_does_not_limit_grows_on_both_sides(monkeypatch):
    class Free(BaseModel):
        x: float = 1.0

    monkeypatch.setattr(hold_out, "get", lambda _: SimpleNamespace(parameters=Free))
    family = replace(FAMILIES[0], ranges={"x": (4.0, 6.0)})
    assert hold_out.widened(family).ranges["x"] == pytest.approx((3.5, 6.5))


@pytest.mark.parametrize("family", hold_out.held_out(), ids=lambda family: family.name)
def test_what_is_drawn_and_asked_for_is_allowed(family):
    problem = registry.get(family.problem)
    requests = tuple(StateRequest(n, v, branch=family.branch, profile=()) for n, v in family.at)
    for numerics in (family.coarse, family.fine):
        validated(problem.numerics, dict(numerics), family.name)
    for given in family.sets(4, hold_out.SEED):
        problem.check(validated(problem.parameters, given, family.name), Requests(requests))


# -- what is kept ----------------------------------------------------------------------------------


def part(*families):
    return Part(7, 2, "2026-11-23T00:00:00+00:00", 3.0, "digest", {}, list(families))


def test_a_claim_that_does_not_hold_is_said():
    good = outcome("tube", [GOOD] * 4, 1, [])
    assert good.broken == []
    assert good.within == 1.0
    bad = outcome("tube", [GOOD] * 9 + [BAD], 1, [])
    assert bad.broken == ["1 number beyond 2u", "90.0% within u, 95% claimed"]
    assert bad.outside[0].parameters == {"alpha": 0.1}
    assert outcome("tube", [WIDE], 1, []).broken == ["200 times too wide, 30 claimed"]


def test_a_family_of_which_nothing_was_judged_keeps_no_claim():
    none = outcome("tube", [], 0, [Missed({"alpha": 0.1}, "no convergence")])
    assert math.isnan(none.within)
    assert none.broken == ["no number was judged"]
    assert part(none).headline == "no numbers judged"


def families(*names):
    return [Family({"alpha": (0.0, 1.0)}, {}, {}, problem=name) for name in names]


def test_parts_and_families_are_stored_at_once_and_taken_over(tmp_path, monkeypatch):
    calls = []

    def solved(family, given):
        calls.append(family.name)
        if family.name == "hard" and len(calls) % 2:
            raise ConvergenceError("SNES ended with X")
        if family.name == "broken":
            raise KeyboardInterrupt
        return [replace(GOOD, family=family.name)]

    monkeypatch.setattr(verb, "judged", solved)
    monkeypatch.setattr(verb, "tree_digest", lambda: "t")
    file, stored = tmp_path / NAME, Coverage({"tuned": part(outcome("tube", [GOOD], 1, []))})
    with pytest.raises(KeyboardInterrupt):
        verb.run_part(families("hard", "broken"), 2, 7, "hold_out", stored, file, resume=False)
    found = load_coverage(file)
    assert set(found.parts) == {"tuned", "hold_out"}
    (hard,) = found.parts["hold_out"].families
    assert (hard.solved, hard.missed[0].reason) == (1, "SNES ended with X")
    assert hard.count == 1
    calls.clear()
    again = verb.run_part(families("hard", "easy"), 2, 7, "hold_out", found, file, resume=True)
    assert calls == ["easy", "easy"]
    assert [family.name for family in again.families] == ["hard", "easy"]
    calls.clear()
    verb.run_part(families("easy"), 3, 7, "hold_out", load_coverage(file), file, resume=True)
    assert len(calls) == 3, "another number of sets is another question"


def test_an_unknown_family_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"no family 'tubes'; there are .*; circular; "):
        verb.coverage_verb(["tubes"], 1, False, tmp_path, False, False, Console(file=StringIO()))


@pytest.mark.parametrize(
    "data",
    ["{", '{"schema": "x"}', '{"schema": "weakforms.coverage/1", "parts": {"other": 1}}'],
)
def test_a_damaged_file_is_shown_as_such(tmp_path, data):
    assert Covered.beside(tmp_path) == Covered()
    (tmp_path / NAME).write_text(data)
    with pytest.raises(InputError):
        load_coverage(tmp_path / NAME)
    found = Covered.beside(tmp_path)
    assert found.run is None
    assert found.problem
    empty = RunOutcome("quick", "all", "", 0.0, {})
    assert "No test of the uncertainties lies beside" in render(empty, Beside(covered=found))["coverage.html"]


def test_both_parts_stand_side_by_side_in_the_report(tmp_path):
    tuned, held = part(outcome("tube", [GOOD], 2, [])), part(outcome("tube <i>", [GOOD, BAD], 1, []))
    held.families[0].missed.append(Missed({"alpha": 0.3}, "SNES ended with <X>"))
    (tmp_path / NAME).write_text(json.dumps(Coverage({"tuned": tuned, "hold_out": held}).to_json()))
    empty, covered = RunOutcome("quick", "all", "", 0.0, {}), Covered.beside(tmp_path)
    page = render(empty, Beside(covered=covered))["coverage.html"]
    for text in ("Tuned sets: 100.0% of 1 number", "Hold-out: 50.0% of 2 numbers", "1 beyond twice it"):
        assert text in page
    for text in ("Claim broken: 1 number beyond 2u", "SNES ended with &lt;X&gt;", "tube &lt;i&gt;"):
        assert text in page
    assert 'id="coverage-hold_out"' in render_whole(empty, Beside(covered=covered))


def test_the_terminal_shows_the_same():
    found = part(outcome("tube", [GOOD, BAD], 1, [Missed({"alpha": 0.3}, "no")]))
    screen = Console(file=StringIO(), width=200)
    print_part(found, "hold-out", screen)
    said = screen.file.getvalue()
    for text in ("50.0%", "not solved: tube at {'alpha': 0.3}: no", "beyond 2u: tube", "claim broken: tube"):
        assert text in said
    assert "| tube | quantity | 2 | 50.0% | 50.0% |" in markdown(found.families[0].rows)


def test_a_field_with_uncertainties_by_row_is_judged_where_it_is_worst():
    """Not where the error is largest, nor with the largest uncertainty."""
    spread, errors = np.array([1e-5, 1e-9, 1e-9]), np.array([1e-6, 5e-9, 1e-9])
    fine = Number("state, profile x", "x", np.ones(3), np.full(3, 1e-12))
    item = judged._judged("tube", (), Number(fine.place, "x", 1 + errors, spread), fine)
    assert (item.error, item.uncertainty, item.truth) == pytest.approx((5e-9, 1e-9, 1e-12), rel=1e-6)
    assert not item.bounded


@pytest.mark.parametrize(("size", "floor"), [(100.0, 1e-8), (0.01, 1e-10)])
def test_round_off_is_allowed_in_proportion_to_numbers_above_one(size, floor):
    fine = Number("quantity p", "p", np.array([size]), np.array([1e-12]))
    assert judged._judged("tube", (), fine, fine).floor == pytest.approx(floor)


def test_a_coarse_solution_is_judged_by_a_fine_one_where_it_states_an_uncertainty(monkeypatch):
    """Not the trace, nor what only one of the two has, nor exact numbers."""
    asked = []

    def solve_requests(problem, parameters, numerics, states, branch_uncertainty=True):
        asked.append(
            (problem, parameters, numerics, [(s.name, s.value, s.branch, s.profile) for s in states])
        )
        off = 0.0 if numerics["cells"] == 9 else 0.25
        numbers = {"p": Quantity(2.0 + off, 0.125), "n": Quantity(3.0)} | (
            {"q": Quantity(1.0, 1.0)} if off else {}
        )
        branch = Branch("primary", "p", {"p": np.array([1.0])}, {"p": np.array([1.0])})
        assert branch_uncertainty is False, "of the trace nothing is judged"
        return Result(problem, {}, {}, {}, {}, [branch], quantities=numbers)

    monkeypatch.setattr(api, "solve_requests", solve_requests)
    family = Family({"alpha": (0, 1)}, {"cells": 3}, {"cells": 9}, problem="tube", at=(("p", 1.5),))
    (item,) = judged.judged(family, {"alpha": 0.5})
    assert (item.place, item.error, item.uncertainty, item.truth) == ("quantity p", 0.25, 0.125, 0.125)
    state = [("p", 1.5, family.branch, ())]
    assert asked == [("tube", {"alpha": 0.5}, {"cells": cells}, state) for cells in (3, 9)]
    assert replace(item, error=0.25, truth=0.1).within is False
    assert replace(item, error=0.2, truth=0.1).within is True
    assert replace(item, error=0.36, truth=0.1).bounded is False
    assert replace(item, error=0.34, truth=0.1).bounded is True
