"""The catalogue of seeded faults fits the code; its runner separates caught, surviving and void faults."""

import ast
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from weakforms.cli import app
from weakforms.errors import EnvironmentLackError, InputError
from weakforms.terminal import guarded
from weakforms.verification.audit.faults import runner, scratch
from weakforms.verification.audit.faults.catalogue import (
    AREAS,
    SUBJECTS,
    TOPICS,
    Expectation,
    Fault,
    catalogue,
    require_sound,
    select,
)
from weakforms.verification.audit.faults.children import Answer
from weakforms.verification.audit.faults.outcome import (
    NAME,
    SHIPPED,
    Seeded,
    keep_beside,
    load_faults,
    print_faults,
    schema,
    validate,
)
from weakforms.verification.audit.faults.probe import narrowed
from weakforms.verification.audit.faults.runner import run_faults
from weakforms.verification.cases.discovery import find_cases, get_case
from weakforms.verification.cases.references import ROOT
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render, render_whole

FAULTS = catalogue()
KNOWN = {fault.name: fault for fault in FAULTS}
QUICK = {found.id for found in find_cases() if found.case.quick}


# -- the catalogue ---------------------------------------------------------------------------------


def test_there_are_enough_of_every_kind():
    assert len(FAULTS) >= 60
    assert len(KNOWN) == len(FAULTS)
    assert {fault.area for fault in FAULTS} == set(AREAS)
    subjects = {fault.subject for fault in FAULTS}
    assert {*TOPICS, "circular", "tube", "fluid_tube", "wrinkled_tube", "hemisphere", "surface"} < subjects
    assert subjects <= set(SUBJECTS)
    assert all(re.fullmatch("[a-z0-9]+(-[a-z0-9]+)*", name) for name in KNOWN)
    assert len({fault.description for fault in FAULTS}) == len(FAULTS)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_is_one_change_of_source_that_still_parses(fault):
    text = (ROOT / fault.file).read_text("utf-8")
    changed = fault.applied(text)
    assert text.count(fault.find) == 1
    assert changed != text
    assert ast.dump(ast.parse(changed)) != ast.dump(ast.parse(text)), "not a comment, not white space"
    assert fault.file.startswith(("weakforms/", "reference_data/solvers/"))


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_what_is_expected_to_notice_it_is_there(fault):
    for wanted in fault.expected:
        if wanted.is_test:
            tree = ast.parse((ROOT / wanted.case).read_text("utf-8"))
            assert wanted.part in {n.name for n in tree.body if isinstance(n, ast.FunctionDef)}, wanted.text
        else:
            found = narrowed(get_case(wanted.case), wanted.part)
            assert found.case.checks or found.case.panels, f"{wanted.text} names no check"


def test_most_are_noticed_by_the_quick_profile_or_a_test():
    full = {f.name for f in FAULTS if not any(e.is_test or e.case in QUICK for e in f.expected)}
    assert len(full) < len(FAULTS) / 2, full


def test_a_part_of_a_case_keeps_the_names_of_its_checks():
    whole, part = get_case("closed_form.sphere"), narrowed(get_case("closed_form.sphere"), "limits_gent")
    assert not part.case.surfaces
    assert 0 < len(part.case.checks) < len(whole.case.checks)
    assert {n for c in part.case.checks for n in c.names(part.paper)} < {
        n for c in whole.case.checks for n in c.names(whole.paper)
    }


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ('area = "load"', "wanted are"),
        ('[x]\narea = "weather"', "wanted are"),
        ("= 3", "Invalid"),
    ],
)
def test_a_damaged_catalogue_is_refused(entry, said, tmp_path):
    (tmp_path / "a.toml").write_text(f"[x]\n{entry}\n" if "[x]" not in entry else entry)
    with pytest.raises(InputError, match=said):
        catalogue(tmp_path)


def test_a_text_that_is_gone_or_there_twice_is_refused():
    fault = FAULTS[0]
    for text in ("nothing of it", 2 * (fault.find + "\n")):
        with pytest.raises(InputError, match="the catalogue is to follow the source"):
            fault.applied(text)
    with pytest.raises(InputError, match=r"there is no weakforms/gone\.py"):
        require_sound([replace(fault, file="weakforms/gone.py")])
    with pytest.raises(InputError, match="unknown case"):
        require_sound([replace(fault, expected=(Expectation("paper2.fig99"),))])


def test_selection():
    assert [f.name for f in select(["follower-load-sign"])] == ["follower-load-sign"]
    chosen = select(expression="load and fluid_tube")
    assert {"load-stiffness-dropped"} < {f.name for f in chosen}
    with pytest.raises(
        InputError, match="unknown fault 'follower-load-sing'; close to it: follower-load-sign"
    ):
        select(["follower-load-sing"])
    with pytest.raises(InputError, match="no fault matches"):
        select(expression="no_such_word")


# -- scratch copies --------------------------------------------------------------------------------


def test_a_copy_has_the_fault_and_the_tree_has_not(tmp_path):
    fault, before = KNOWN["bound-too-wide"], scratch.tree_digest()
    (tmp_path / "copy").mkdir()
    root = scratch.copy_tree(tmp_path / "copy", fault)
    assert fault.replace in (root / fault.file).read_text("utf-8")
    assert not list((root / fault.file).parent.glob("__pycache__/bounds.*.pyc"))
    assert scratch.tree_digest() == before
    assert scratch.tree_digest(root) != before


@pytest.mark.parametrize("error", [None, KeyboardInterrupt, RuntimeError])
def test_the_scratch_folder_always_goes(error):
    try:
        with scratch.scratch_folder() as folder:
            (folder / "deep").mkdir()
            (folder / "deep" / "file").write_text("x")
            if error:
                raise error
    except (KeyboardInterrupt, RuntimeError):
        pass
    assert not folder.exists()


def test_without_space_it_is_the_environments_fault(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(EnvironmentLackError, match="TMPDIR"):
        scratch.copy_tree(tmp_path / "file" / "copy")


@pytest.mark.parametrize("ending", [signal.SIGTERM, signal.SIGINT])
def test_a_run_that_is_ended_leaves_nothing_behind(ending, tmp_path):
    before, place = scratch.tree_digest(), tmp_path / "scratch"
    place.mkdir()
    words = ["faults", "--only", "follower-load-sign", "--out", str(tmp_path / "out")]
    run = subprocess.Popen(
        [sys.executable, "-m", "weakforms", *words],
        cwd=ROOT,
        env={**os.environ, "TMPDIR": str(place)},
        stderr=subprocess.PIPE,
        text=True,
    )
    until = time.monotonic() + 60
    while not list(place.glob(f"{scratch.PREFIX}*/*/log")) and time.monotonic() < until:
        time.sleep(0.05)
    run.send_signal(ending)
    _, said = run.communicate(timeout=60)
    assert run.returncode == 130, said
    assert "--resume" in said
    assert list(place.glob(f"{scratch.PREFIX}*")) == []
    assert scratch.tree_digest() == before


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


# -- for real ----------------------------------------------------------------------------------------


def test_two_faults_are_really_caught(tmp_path):
    """One fault is caught by a comparison of a case, one by a test, with processes and scratch copies."""
    before = scratch.tree_digest()
    run = run_faults(select(["thickness-stretch-cubed", "accuracy-not-asked-for"]), tmp_path, jobs=2)
    first, second = run.faults
    assert run.status == "caught", run.to_json()
    assert all(found.passed and found.checks for found in run.baseline)
    assert first.caught_by.check.startswith("law_neo_hookean:")
    assert first.caught_by.error > first.caught_by.bound
    assert (
        second.caught_by.check
        == "tests/verification/judging/test_bounds.py::test_one_wide_bar_among_many_fails"
    )
    assert scratch.tree_digest() == before
    screen = Console(width=160, file=open(os.devnull, "w"), record=True)  # noqa: SIM115
    print_faults(run, screen)
    text = screen.export_text()
    assert "2 of 2 seeded faults caught" in text
    assert "materials.laws" in text


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
    assert "<script>" not in render(empty, damaged)["faults.html"]


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
