"""Random mutants: which are drawn, what kills one, and how their outcome is reported."""

import ast
import sys
from collections import Counter
from dataclasses import replace

import pytest

from weakforms.cli import app
from weakforms.errors import InputError
from weakforms.terminal import guarded
from weakforms.verification.audit.faults import children, random_runner, runner
from weakforms.verification.audit.faults.catalogue import REASONS
from weakforms.verification.audit.faults.children import Answer, Children
from weakforms.verification.audit.faults.findings import finding
from weakforms.verification.audit.faults.lines import Watchers
from weakforms.verification.audit.faults.mutations import mutations
from weakforms.verification.audit.faults.outcome import RANDOM, Seeded, keep_beside, load_faults
from weakforms.verification.audit.faults.random_faults import (
    GROUPS,
    WITHOUT,
    Mutant,
    describe,
    draw,
    looked_at,
    sources,
)
from weakforms.verification.audit.faults.random_runner import run_random
from weakforms.verification.cases.references import ROOT
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render

# -- the changes -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "changed"),
    [
        ("a + b", {"a - b", "a ", "b"}),
        ("a - b", {"a + b", "a ", "- b"}),
        ("a * b", {"a / b"}),
        ("a ** 2", {"a * 2", "a ** 2.02"}),
        ("f(2)", {"f(3)"}),
        ("0.5", {"0.505"}),
        ("True", {"False"}),
        ("-a", {"a"}),
        ("a < b", {"a <= b", "a > b"}),
        ("a is not b", {"a is b"}),
        ("a not in b", {"a in b"}),
        ("a and b", {"a or b"}),
        ("a and not b", {"a or not b", "a and b"}),
        ("x = a if b else c", {"x = a if not (b) else c"}),
        ("if a:\n    b", {"if not (a):\n    b"}),
        ("f(a, k=b)", {"pass", "f(a)"}),
        ("x = f(k=b, m=c)", {"x = f(m=c)", "x = f(k=b)"}),
        ("x = zip(a, strict=True)", set()),
        ("if TYPE_CHECKING:\n    b = 1", set()),
        ("'über' + a", set()),
        ("x = f('über') * b", {"x = f('über') / b"}),
        ("x = (a) \\\n  + (b)", {"x = (a) \\\n  - (b)", "x = (a) \\\n  ", "x = (b)"}),
        (
            "x = (a  # why + or -\n + b)",
            {"x = (a  # why + or -\n - b)", "x = (a  # why + or -\n )", "x = (b)"},
        ),
        ("a + b + c", {"a - b + c", "a + b - c", "a + b ", "a  + c", "b + c"}),
        ("raise E(a + 1)", set()),
        ("x: T[1] = a", set()),
        ("@d(1)\ndef f(a: T[1]) -> T[2]: ...", set()),
        ("x = f'{a + 1}'", set()),
    ],
)
def test_the_changes_of_a_text_are_these(text, changed):
    sound = [m for m in mutations(text) if m.is_sound(text)]
    found = {m.applied(text) for m in sound if not (text.startswith("f(") and m.kind == "statement")}
    found |= {m.applied(text) for m in sound if "pass" in changed}
    assert found == changed
    assert all(text.split("\n")[m.line - 1] for m in sound)


def test_a_statement_can_be_left_out():
    text = "def f():\n    '''Says.'''\n    g(1)\n"
    assert "def f():\n    '''Says.'''\n    pass\n" in {m.applied(text) for m in mutations(text)}


# -- the draw ----------------------------------------------------------------------------------------


@pytest.fixture
def tree(tmp_path):
    """A tree with a file for each group, and one file that is never changed."""
    for paths in GROUPS.values():
        path = tmp_path / paths[0] / "a.py" if not paths[0].endswith(".py") else tmp_path / paths[0]
        path.parent.mkdir(parents=True)
        path.write_text("def f(a, b):\n    return a * b + 2 * a < 1\n")
    (tmp_path / WITHOUT).mkdir(parents=True)
    (tmp_path / WITHOUT / "b.py").write_text("c = 1 + 1\n")
    return tmp_path


def test_a_draw_depends_on_number_seed_and_tree(tree):
    drawn, there_are = draw(12, 7, tree)
    assert (drawn, there_are) == draw(12, 7, tree)
    assert draw(5, 7, tree)[0] == drawn[:5], "a longer draw begins as the shorter one"
    assert draw(12, 8, tree)[0] != drawn
    assert len({(m.file, m.at, m.replace) for m in drawn}) == 12
    assert Counter(m.subject for m in drawn) == dict.fromkeys(GROUPS, 2)
    for mutant in drawn:
        text = (tree / mutant.file).read_text()
        assert ast.dump(ast.parse(mutant.applied(text))) != ast.dump(ast.parse(text))
        with pytest.raises(InputError, match="changed since it was drawn"):
            mutant.applied("# one line more\n" + text)
    for number, said in ((0, "allowed are 1 to"), (-1, "allowed are 1 to"), (300, "no more mutants")):
        with pytest.raises(InputError, match=said):
            draw(number, 7, tree)


def test_all_of_the_source_is_drawn_from_but_what_judges():
    drawn_from = {p.relative_to(ROOT).as_posix() for group in GROUPS for p in sources(group)}
    assert {"weakforms/forms/fluid.py", "weakforms/scaling.py", "weakforms/api.py"} < drawn_from
    assert {
        "weakforms/verification/judging/checks/points.py",
        "reference_data/solvers/paper2/differences/equations.py",
    } < drawn_from
    assert not any(name.startswith(WITHOUT) for name in drawn_from)


def test_what_was_looked_at_by_hand_is_still_there():
    for entry in looked_at():
        text = (ROOT / entry.file).read_text("utf-8")
        numbers = [k for k, line in enumerate(text.split("\n"), 1) if line.strip() == entry.line]
        assert numbers, f"{entry.file}: {entry.line} is gone"
        said = {describe(text, m) for m in mutations(text) if m.line in numbers}
        assert entry.mutation in said, entry


@pytest.mark.parametrize(
    "entry", ['verdict = "equivalent"\nreason = ""', 'verdict = "fine"\nreason = "so"', ""]
)
def test_what_was_looked_at_needs_a_reason(entry, tmp_path):
    text = f'[[mutant]]\nfile = "a"\nline = "b"\nmutation = "c"\n{entry}\n'
    (tmp_path / REASONS).write_text(text)
    with pytest.raises(InputError, match=REASONS):
        looked_at(tmp_path)


# -- what becomes of one -----------------------------------------------------------------------------

TESTS = ("passes", "asserts", "breaks", "stalls", "lets_pass")
MODULE = """
import pytest
from weakforms.errors import ConvergenceError, InputError
def test_passes(): assert True
def test_asserts(): assert 1 == 2
def test_breaks(): [][1]
def test_stalls(): raise ConvergenceError("stalled")
def test_lets_pass():
    with pytest.raises(InputError):
        pass
"""


def test_an_assertion_a_break_down_and_a_stall_are_told_apart(tmp_path):
    root = tmp_path / "copy"
    (root / "tests").mkdir(parents=True)
    (root / "weakforms").symlink_to(ROOT / "weakforms")
    (root / "tests" / "test_a.py").write_text(MODULE)
    words = [f"tests/test_a.py::test_{name}" for name in TESTS]
    answers, failure = Children().run(root, words, 120.0, go_on=True)
    assert failure == ""
    assert [answer.status for answer in answers] == ["passed", *["failed"] * 4]
    kinds = [finding(answer, False).kind for answer in answers[1:]]
    assert kinds == ["test", "stopped", "not solved", "test"]


@pytest.mark.parametrize(
    ("work", "ended"),
    [("time.sleep(2.5)", False), ("time.sleep(30)", True), ("[0 for _ in iter(int, 1)]", True)],
)
def test_a_run_is_ended_by_its_processor_time(work, ended, tmp_path, monkeypatch):
    """A busy machine makes no test kill a mutant; an endless loop kills it, and so does a deadlock."""
    monkeypatch.setattr(children, "WAITING", 2.0)
    monkeypatch.setattr(children, "LOOK", 0.1)
    words = [sys.executable, "-c", f"import time; {work}"]
    with (tmp_path / "log").open("wb") as log:
        started = Children()._start(words, tmp_path, log)
        failure = Children()._wait(started, 2.0)
    assert failure == ("it did not end within 2 s of processor time" if ended else "")
    assert started.poll() is not None


MUTANT = Mutant(
    name="x-1-abc",
    area="arithmetic",
    subject="forms",
    description="line 1, arithmetic: `+` -> `-` in column 3: a + b",
    file="weakforms/x.py",
    find="+",
    replace="-",
    expected=(),
    at=2,
    line=1,
)
SEEING = [("tests/a.py::one", 1.0), ("tests/a.py::two", 2.0), ("paper2.fig03", 60.0)]


@pytest.fixture
def run_one(tmp_path, monkeypatch):
    """Run one mutant with prepared failures on a tree of one file."""
    calls = []

    def run(failing=(), mutant=MUTANT, anyhow=(), crashing=(), **options):
        def answers(_self, root, texts, _limit, go_on=False, lines=None):
            calls.append((root.name, tuple(texts)))
            out = []
            for text in texts:
                bad = text in (anyhow if root.name == "unchanged" else {*failing, *anyhow})
                kind = "test" if text.startswith("tests/") else "curve"
                verdict = {"check": text, "kind": kind, "passed": not bad, "detail": "off"}
                verdict |= {"raised": "stopped"} if text in crashing else {}
                verdict |= {"where": "", "error": None, "bound": None, "asked": None}
                out.append(Answer(text, "failed" if bad else "passed", 1.0, [verdict], []))
                if bad and not go_on:
                    break
            return out, ""

        monkeypatch.setattr(runner, "tree_digest", lambda: "tree")
        monkeypatch.setattr(runner, "copy_tree", lambda to, *_: to)
        monkeypatch.setattr(Children, "run", answers)
        monkeypatch.setattr(random_runner, "draw", lambda *_: ([mutant], 100))
        monkeypatch.setattr(Watchers, "of", lambda *_: SEEING)
        return run_random(1, 5, tmp_path, **options)

    run.calls = calls
    return run


def test_a_mutant_is_killed_by_the_first_that_notices(run_one, tmp_path):
    run = run_one({"tests/a.py::two", "paper2.fig03"})
    (mutant,) = run.faults
    assert (run.status, mutant.status, mutant.caught_by.check) == ("caught", "caught", "tests/a.py::two")
    assert (mutant.searched, mutant.watching) == (("tests/a.py::one", "tests/a.py::two"), 3)
    assert run.headline.startswith("1 of 1 random mutant caught (0 by a verdict, 1 by a test, 0 by a crash")
    assert load_faults(tmp_path / RANDOM) == run
    case = run_one({"paper2.fig03"})
    assert case.kinds["comparison"] == 1


def test_a_survivor_says_what_it_met_and_time_may_be_short(run_one):
    run = run_one()
    assert (run.status, run.faults[0].status, len(run.faults[0].searched)) == ("survived", "survived", 3)
    assert "1 SURVIVED" in run.headline
    short = run_one(budget=1e-9)
    assert (short.faults[0].status, short.faults[0].searched) == ("survived", ())


def test_after_a_crash_a_verdict_is_looked_for(run_one):
    """A mutant that breaks its fastest test is killed by the test that says what is wrong, if one does."""
    run = run_one({"tests/a.py::one", "tests/a.py::two"}, crashing={"tests/a.py::one"})
    assert (run.faults[0].caught_by.kind, run.faults[0].caught_by.check) == ("test", "tests/a.py::two")
    case = run_one({"tests/a.py::one", "paper2.fig03"}, crashing={"tests/a.py::one"})
    assert (case.faults[0].caught_by.kind, case.faults[0].searched) == ("comparison", tuple(dict(SEEING)))
    only = run_one({"tests/a.py::one", "tests/a.py::two"}, crashing={"tests/a.py::one", "tests/a.py::two"})
    assert (only.faults[0].caught_by.kind, only.faults[0].caught_by.check) == ("stopped", "tests/a.py::one")
    assert only.faults[0].searched == tuple(dict(SEEING))


def test_what_fails_without_the_mutant_kills_nothing(run_one):
    run = run_one(anyhow={"tests/a.py::one"})
    assert (run.status, run.faults[0].status) == ("survived", "survived")
    assert "1 check that fail without a mutant were not used" in run.headline


@pytest.mark.parametrize("verdict", ["equivalent", "harmless"])
def test_one_that_was_looked_at_is_not_run(run_one, verdict):
    run = run_one({"paper2.fig03"}, replace(MUTANT, reason="a + 0", verdict=verdict))
    assert (run.status, run.faults[0].status, run.faults[0].reason) == ("caught", verdict, "a + 0")
    assert run_one.calls == []


def test_what_is_known_is_not_run_again(run_one):
    run_one({"tests/a.py::one"})
    del run_one.calls[:]
    assert run_one(resume=True).faults[0].status == "caught"
    assert run_one.calls == []


def test_the_report_shows_them(run_one, tmp_path):
    run = run_one()
    empty = RunOutcome("quick", "", "2026-01-01T00:00:00+00:00", 1.0, {})
    keep_beside(tmp_path / RANDOM, tmp_path / "report", RANDOM)
    beside = Seeded.beside(tmp_path / "report")
    assert (beside.shipped, beside.random) == (True, run)
    page = render(empty, Beside(beside))["faults.html"]
    assert "Random faults" in page
    assert 'id="mutant-x-1-abc"' in page
    assert "3 cases or tests run of 3 that may see it" in page
    assert "Random faults" not in render(empty)["faults.html"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--random", "0"], "--random 0: allowed are 1 to"),
        (["--random", "3", "--budget", "0"], "--budget 0"),
        (["--random", "3", "--measure"], "exclude each other"),
        (["--random", "3", "--only", "follower-load-sign"], "exclude each other"),
        (["--measure", "-k", "a and"], "a and"),
    ],
)
def test_the_verb_refuses(words, said, tmp_path, capsys):
    status = guarded(lambda: app(["faults", *words, "--out", str(tmp_path / "out")], standalone_mode=False))
    assert status == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
