"""The physics: every case of the suite, with a separate test for each check.

Each problem is solved once in a session, as ``weakforms verify`` solves it, in the worker that first needs
the solution.
"""

from collections.abc import Iterable
from pathlib import Path

import pytest
from shared_run import SharedRun

from weakforms.errors import InputError
from weakforms.verification.cases.discovery import FoundCase, find_cases
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.report.wording import scientific
from weakforms.verification.run.plan import check_ids

CASES = find_cases()
UNSOUND: dict[str, str] = {}
"""Cases whose reference tables are not in order: they fail, the others are judged."""


def checks_of(found: FoundCase) -> list[str]:
    try:
        return check_ids(found)
    except InputError as error:
        UNSOUND[found.id] = str(error)
        return []


def items(names: bool) -> Iterable[object]:
    for found in CASES:
        marks = [getattr(pytest.mark, found.group), *[pytest.mark.slow] * found.case.slow]
        for name in checks_of(found) if names else [""]:
            ident = f"{found.id}:{name}" if name else found.id
            yield pytest.param(found.id, *[name] * names, marks=marks, id=ident)


@pytest.fixture(scope="session")
def run(request, tmp_path_factory) -> SharedRun:
    """The run of all cases among the items selected."""
    shared = tmp_path_factory.getbasetemp()
    if hasattr(request.config, "workerinput"):
        shared = shared.parent
    wanted = {i.callspec.params["case"] for i in request.session.items if "case" in callspec(i)}
    return SharedRun([c for c in CASES if c.id in wanted - set(UNSOUND)], shared / "cases")


def callspec(item: pytest.Item) -> dict:
    return item.callspec.params if hasattr(item, "callspec") and item.path == Path(__file__) else {}


def explained(verdict: Verdict) -> str:
    sizes = ", ".join(f"{n} {scientific(getattr(verdict, n), 3)}" for n in ("error", "bound", "asked"))
    lines = [verdict.statement, verdict.detail, sizes if verdict.bound is not None else "", verdict.where]
    return "\n".join(line for line in lines if line)


@pytest.mark.parametrize(("case", "check"), items(names=True))
def test_check(run, case, check):
    verdict = next(v for v in run.outcome(case).verdicts if v.check == check)
    if not verdict.passed:
        pytest.fail(explained(verdict), pytrace=False)


@pytest.mark.parametrize("case", items(names=False))
def test_case_is_complete(run, case):
    assert case not in UNSOUND, UNSOUND[case]
    outcome = run.outcome(case)
    found = next(c for c in CASES if c.id == case)
    assert outcome.errors == []
    assert sorted(v.check for v in outcome.verdicts) == sorted(check_ids(found))
    assert outcome.status == ("passed" if all(v.passed for v in outcome.verdicts) else "failed")
    assert len(outcome.panels) == len(found.case.panels)
    # A check with a bound states both uncertainties it rests on, and a bound no wider than what was asked.
    for verdict in outcome.verdicts:
        if verdict.kind in ("curve", "field", "point", "exact"):
            assert verdict.uncertainty > 0
            assert verdict.reference_uncertainty is not None
            if verdict.passed:
                assert verdict.error <= verdict.bound <= verdict.asked
