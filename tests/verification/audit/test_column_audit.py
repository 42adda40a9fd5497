"""Every column of a stored solution is judged: if one is falsified, a check fails."""

import os
from pathlib import Path

import pytest

from weakforms import infinite_tube, tube
from weakforms.verification.audit.columns import audit, columns_of, falsified
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.judging.consistency.exempt import EXEMPT, EXEMPT_SIZE, KNOWN
from weakforms.verification.judging.consistency.identities import Identities
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.solving import Solver, solution_key, solve_spec

SPECS = [tube(alpha=0.1, delta1=1.1, u_end=1.0), infinite_tube(model="mooney_rivlin")]


@pytest.fixture(scope="module")
def solved():
    return {spec: solve_spec(spec, []) for spec in SPECS}


def test_no_column_is_missed_without_any_table(solved):
    """Traces and identities judge all of these solutions without a case."""
    assert [(m.problem, m.column, m.factor) for m in audit([], solved)] == []


def test_what_nothing_judges_is_missed(solved, monkeypatch):
    monkeypatch.setattr(Identities, "judge", lambda *_: [])
    missed = {m.column for m in audit([], {SPECS[0]: solved[SPECS[0]]})}
    assert {"Pi", "V", "p", "lam1_mid", "t1_mid"} <= missed


def test_a_column_is_falsified_wherever_a_solution_has_it(solved):
    result = solved[SPECS[0]]
    wrong = falsified(result, "V", -1.0)
    assert (wrong.branches[0].columns["V"] == -result.branches[0].columns["V"]).all()
    assert wrong.states[0].quantities["V"].value == -result.states[0].quantities["V"].value
    assert wrong.states[0].quantities["p"] == result.states[0].quantities["p"]
    profile = falsified(result, "profile:lam1", 1.01)
    old, new = (item.states[0].fields[0].columns["lam1"] for item in (result, profile))
    assert (new == 1.01 * old).all()
    assert falsified(result, "n_negative", -1.0) is None
    assert {"V", "eigenvalue_1", "profile:t1", "residual"} <= set(columns_of(result))


def test_what_is_exempt_has_a_reason():
    assert all(len(reason) > 20 for reason in (*EXEMPT.values(), *EXEMPT_SIZE.values(), *KNOWN.values()))


@pytest.mark.slow
def test_no_column_of_any_stored_solution_is_missed(tmp_path_factory):
    """On the run named by ``WEAKFORMS_RUN``, or on one of the quick cases, solved here."""
    stored = os.environ.get("WEAKFORMS_RUN")
    cases = [found for found in find_cases() if stored or found.case.quick]
    plan = Plan.of(cases)
    solver = Solver(Path(stored or tmp_path_factory.mktemp("run")) / "solutions", resume=True)
    if stored:  # no more than what is there, and nothing is solved
        kept = {p.stem for p in solver.folder.glob("*.json")}
        plan.states = {spec: at for spec, at in plan.states.items() if solution_key(spec, at) in kept}
    solver.run(plan, lambda *_: None)
    assert not solver.failures
    missed = {f"{m.problem}: {m.column}" for m in audit(cases, solver.results)}
    assert sorted(missed - set(KNOWN)) == []
    if stored and len(plan.states) == len(Plan.of(cases).states):
        assert sorted(set(KNOWN) - missed) == [], "a known gap is closed: remove it from the list"
