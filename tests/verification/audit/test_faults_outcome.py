"""What catches a seeded fault, what survives, what voids a run, and how this is stored and shown."""

from dataclasses import replace
from pathlib import Path

import pytest

from weakforms.cli import app
from weakforms.errors import InputError
from weakforms.terminal import guarded
from weakforms.verification.audit.faults import runner
from weakforms.verification.audit.faults.catalogue import Expectation, Fault, catalogue
from weakforms.verification.audit.faults.children import Answer
from weakforms.verification.audit.faults.outcome import (
    NAME,
    SHIPPED,
    Seeded,
    keep_beside,
    load_faults,
    schema,
    validate,
)
from weakforms.verification.audit.faults.runner import run_faults
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render, render_whole

FAULTS = catalogue()
KNOWN = {fault.name: fault for fault in FAULTS}
QUICK = {found.id for found in find_cases() if found.case.quick}


# -- the runner, with answers given ------------------------------------------------------------------

A, B = "closed_form.sphere::sphere_gent", "paper2.fig03::fig03b"
OTHER = min(QUICK - {"closed_form.sphere", "paper2.fig03"})
"""A case of the quick profile that the fault does not name."""


def verdict(passed, detail="", kind="curve"):
    sizes = {"error": 2e-3, "bound": 1e-9, "asked": 1e-6}
    return {"check": "t:p", "kind": kind, "passed": passed, "detail": detail, "where": "", **sizes}


def answer(text, *verdicts, status=None):
    given = list(verdicts) or [verdict(True)]
    good = all(v["passed"] for v in given)
    return Answer(text, status or ("passed" if good else "failed"), 1.0, given, [])


class Given:
    """Prepared answers for the unchanged copy and for one with a fault."""

    def __init__(self, faulty, unchanged=()):
        self.faulty, self.unchanged, self.calls = faulty, dict(unchanged), []

    def __call__(self):
        """Return itself, in place of an instance."""
        return self

    def run(self, root, texts, _limit, go_on=False):
        """Return the answer of the processes."""
        self.calls.append((root.name, tuple(texts)))
        known = self.unchanged if root.name == "unchanged" else self.faulty
        out = []
        for text in texts:
            if isinstance(known.get(text), str):
                return out, known[text]
            out.append(known.get(text) or answer(text))
            if not go_on and out[-1].status != "passed":
                break
        return out, ""

    def end(self):
        """Do nothing, since no process runs."""


@pytest.fixture
def run_with(tmp_path, monkeypatch):
    """Run one fault with prepared answers on a tree of one file."""
    monkeypatch.setattr(runner, "tree_digest", lambda: "tree")
    monkeypatch.setattr(runner, "copy_tree", lambda to, *_: to)

    def run(given, reason="", resume=False, expected=(A, B)):
        monkeypatch.setattr(runner, "Children", given)
        fault = replace(FAULTS[0], expected=tuple(map(Expectation, expected)), reason=reason)
        return run_faults([fault], tmp_path, resume=resume)

    return run


def test_the_first_check_that_fails_is_named(run_with, tmp_path):
    run = run_with(Given({A: answer(A, verdict(True), verdict(False, "computed 1"))}))
    (fault,) = run.faults
    found = fault.caught_by
    assert (run.status, fault.status, fault.searched) == ("caught", "caught", (A,))
    assert (found.kind, found.where, found.check) == ("comparison", "closed_form.sphere", "t:p")
    assert (found.error, found.bound, found.in_quick) == (2e-3, 1e-9, "closed_form.sphere" in QUICK)
    assert load_faults(tmp_path / NAME) == run


@pytest.mark.parametrize(
    ("detail", "kind"),
    [("not solved: stalled", "not solved"), ("could not be judged: IndexError: x", "not judged")],
)
def test_what_was_not_compared_is_told_apart_and_a_comparison_comes_first(detail, kind, run_with):
    only = run_with(Given({A: answer(A, verdict(False, detail))}))
    assert only.faults[0].caught_by.kind == kind
    both = run_with(Given({A: answer(A, verdict(False, detail), verdict(False))}))
    assert both.faults[0].caught_by.kind == "comparison"


def test_what_survives_meets_the_whole_quick_profile(run_with):
    given = Given({})
    run = run_with(given)
    (fault,) = run.faults
    assert (run.status, fault.status, fault.caught_by) == ("survived", "survived", None)
    assert set(fault.searched) == {A, B, *QUICK}
    assert "SURVIVED" in run.headline
    elsewhere = run_with(Given({OTHER: answer(OTHER, verdict(False))}))
    assert elsewhere.faults[0].caught_by.where == OTHER


def test_a_written_reason_makes_it_no_survivor(run_with):
    run = run_with(Given({}), reason="adds zero")
    assert (run.status, run.faults[0].status) == ("caught", "equivalent")


def test_a_check_that_fails_without_a_fault_voids_the_run(run_with):
    broken = answer(A, verdict(False, "computed 3"))
    run = run_with(Given({A: answer(A, verdict(False))}, {A: broken}))
    assert (run.status, run.faults[0].status) == ("void", "void")
    assert "void" in run.headline
    assert [found.detail for found in run.baseline if not found.passed] == ["t:p: computed 3"]
    silent = Answer(A, "passed", 1.0, [], [])
    assert run_with(Given({}, {A: silent})).status == "void", "what judges nothing vouches for nothing"


def test_a_case_of_the_profile_that_fails_anyhow_catches_nothing(run_with):
    broken = answer(OTHER, verdict(False))
    run = run_with(Given({OTHER: broken}, {OTHER: broken}))
    assert run.faults[0].status == "survived"


def test_a_run_that_breaks_down_is_caught_as_such(run_with):
    run = run_with(Given({A: "it did not end within 300 s"}))
    found = run.faults[0].caught_by
    assert (run.status, found.kind, found.where) == ("caught", "stopped", "closed_form.sphere")
    assert "did not end" in found.detail
    gone_before = run_with(Given({A: "killed"}, {A: "killed"}))
    assert gone_before.status == "void"


def test_resume_takes_over_outcomes_of_the_same_source(run_with, monkeypatch):
    run_with(Given({A: answer(A, verdict(False))}))
    again = Given({})
    assert run_with(again, resume=True).faults[0].status == "caught"
    assert again.calls == []
    monkeypatch.setattr(runner, "tree_digest", lambda: "another tree")
    assert run_with(again, resume=True).faults[0].status == "survived"


# -- what is shown -----------------------------------------------------------------------------------


def shown(run_with):
    return run_with(Given({A: answer(A, verdict(False, "<b>far off</b>"))}))


def test_the_file_fits_its_schema_and_nothing_else_does(run_with, tmp_path):
    data = shown(run_with).to_json()
    validate(data)
    for key in schema()["required"]:
        with pytest.raises(InputError, match=NAME):
            validate({name: value for name, value in data.items() if name != key})
    with pytest.raises(InputError, match="faults/0/status"):
        validate({**data, "faults": [{**data["faults"][0], "status": "probably"}]})
    (tmp_path / NAME).write_text("{")
    with pytest.raises(InputError, match="not JSON"):
        load_faults(tmp_path / NAME)


def test_the_report_carries_the_table(run_with, tmp_path):
    run, empty = shown(run_with), RunOutcome("quick", "", "2026-01-01T00:00:00+00:00", 1.0, {})
    pages = render(empty, Beside(Seeded(run)))
    assert FAULTS[0].name in pages["faults.html"]
    assert "caught" in pages["faults.html"]
    assert "closed_form.sphere: t:p" in pages["faults.html"]
    assert 'href="faults.html"' in pages["index.html"]
    assert 'id="faults"' in render_whole(empty, Beside(Seeded(run)))
    without = render(empty)["faults.html"]
    assert "were not run" in without
    assert "weakforms faults --out OUT" in without
    keep_beside(tmp_path / NAME, tmp_path / "report")
    assert Seeded.beside(tmp_path / "report") == Seeded(run)
    (tmp_path / "report" / NAME).write_text('{"schema": "<script>"}')
    damaged = Seeded.beside(tmp_path / "report")
    assert damaged.run is None
    assert not damaged.shipped
    assert "<script>" not in render(empty, Beside(damaged))["faults.html"]


def test_a_report_without_a_run_shows_the_one_that_the_package_brings(run_with, tmp_path):
    empty = RunOutcome("quick", "", "2026-01-01T00:00:00+00:00", 1.0, {})
    pages = render(empty, Beside(Seeded.beside(tmp_path)))
    assert load_faults(SHIPPED).headline in pages["faults.html"]
    assert "The package brings this table" in pages["faults.html"]
    whole = render_whole(empty, Beside(Seeded.beside(tmp_path)))
    assert load_faults(SHIPPED).headline in whole
    assert "this print leaves it out" in whole
    assert FAULTS[0].description not in whole
    own = render(empty, Beside(Seeded(shown(run_with))))
    assert "The package brings" not in own["faults.html"]


def test_the_shipped_run_is_of_this_catalogue_and_without_a_survivor():
    run = load_faults(SHIPPED)
    assert run.status == "caught"
    assert len(run.faults) == run.catalogue
    gone = {fault.name for fault in run.faults} - set(KNOWN)
    assert not gone, "run the catalogue again: it does not have these faults any more"
    assert len(run.faults) >= 0.9 * len(FAULTS), "run the catalogue again: a tenth of its faults is newer"


@pytest.mark.parametrize(
    ("words", "status"),
    [
        (["--only", "no-such-fault"], 2),
        (["-k", "a and"], 2),
        (["-k", "no_such_word"], 2),
        (["-j", "0"], 2),
        (["--list"], 0),
        (["--list", "--json", "-k", "peeling"], 0),
    ],
)
def test_the_verb(words, status, tmp_path, capsys):
    found = guarded(lambda: app(["faults", *words, "--out", str(tmp_path / "out")], standalone_mode=False))
    said = capsys.readouterr()
    assert found == status
    assert (len(said.err.splitlines()) == 1) == (status == 2)
    assert ("pull-off" in said.out) == (status == 0)
    assert not (tmp_path / "out").exists()


def test_a_fault_says_what_it_is():
    for fault in FAULTS:
        assert isinstance(fault, Fault)
        assert 10 < len(fault.description) < 140
        assert not fault.reason, "a fault that nothing can notice is none"
        assert Path(fault.file).suffix == ".py"
