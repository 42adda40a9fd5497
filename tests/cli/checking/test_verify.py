"""Verify, check and report: solve cases, continue after an interruption, write again without solving."""

import json
import os
import re
import shutil
import time
from io import StringIO
from types import SimpleNamespace

import pytest
from rich.console import Console
from rich.progress import Progress, TextColumn, TimeRemainingColumn

from weakforms import api, terminal
from weakforms.errors import ConvergenceError
from weakforms.verification.audit.any_parameters.outcome import NAME as AUDIT
from weakforms.verification.audit.coverage.outcome import NAME as COVERAGE
from weakforms.verification.audit.faults.outcome import RANDOM
from weakforms.verification.cases import catalogue, discovery
from weakforms.verification.run import runner, solving

PAGES = {
    "figures",
    "audit.html",
    "coverage.html",
    "faults.html",
    "scaling.html",
    "thesis.html",
    "index.html",
    "junit.xml",
    "paper2.html",
    "paper2-checks.html",
    "report.json",
}
TINY = '''"""Two short branches."""
from weakforms import At, Axis, Case, Claim, Curve, Panel, tube

ONE, TWO = (tube(delta1=d, u_end=0.3).on(cells=16, levels=2) for d in (1.5, 2))

def wider(solutions):
    u = [solutions.value(spec, At("p", 0.5), "u_max") for spec in (ONE, TWO)]
    return u[0] < u[1], f"{u}"

CASE = Case(
    title="tiny",
    quick=True,
    source="tests",
    panels=(Panel("a", x=Axis("p", 0, 2), y=Axis("u_max", 0, 1), curves=(Curve(ONE, "1.5"),)),),
    checks=(Claim("wider", "is wider", ((ONE, At("p", 0.5)), (TWO, At("p", 0.5))), wider),),
)
'''


@pytest.fixture
def tiny(tmp_path, monkeypatch):
    """A tree whose only case is solved in a tenth of a second; returns a function that changes the case."""
    path = tmp_path / "cases" / "paper2" / "tiny.py"
    path.parent.mkdir(parents=True)
    find = discovery.find_cases

    def write(old: str = "", new: str = "") -> None:
        assert old in TINY
        path.write_text(TINY.replace(old, new) if old else TINY)
        find.cache_clear()

    write()
    for module in (discovery, catalogue):
        monkeypatch.setattr(module, "find_cases", lambda: find(tmp_path))
    yield write
    find.cache_clear()


@pytest.fixture
def solved(monkeypatch):
    """Problems that are solved in this process."""
    seen, right = [], solving.solve_spec

    def counted(spec: object, states: list) -> object:
        seen.append(str(spec))
        return right(spec, states)

    monkeypatch.setattr(solving, "solve_spec", counted)
    return seen


def die(*_: object) -> None:
    """Make a solving process fail as it does when the machine has no memory left."""
    os._exit(9)


def test_verify_writes_the_report_and_resume_solves_nothing(weakforms, tiny, solved, tmp_path):
    out = tmp_path / "out"
    called = weakforms("verify", "-k", "tiny and not fig", "--out", out)
    assert called.status == 0
    assert "PASSED: the only check holds" in called.out
    assert len(solved) == 2
    assert {p.name for p in (out / "report").iterdir()} == PAGES
    before = {p: p.read_bytes() for p in (out / "solutions").iterdir()}
    assert len(before) == 2

    solved.clear()
    assert weakforms("verify", "-k", "tiny", "--resume", "--out", out).status == 0
    assert solved == []

    cut, whole = sorted(before)
    cut.write_bytes(before[cut][:400])
    assert weakforms("check", "paper2.tiny", "paper2.tiny", "--resume", "--out", out).status == 0
    assert len(solved) == 1
    assert whole.read_bytes() == before[whole]
    assert json.loads(cut.read_text())["branches"] == json.loads(before[cut])["branches"]

    solved.clear()
    assert weakforms("verify", "--profile", "quick", "--out", out).status == 0
    assert len(solved) == 2  # without --resume everything is solved again

    solved.clear()
    runner.verify(discovery.select(None, "tiny"), out, "full", "")
    assert len(solved) == 2  # nor does Python take over anything that was not asked for


def test_report_is_rebuilt_without_solving(weakforms, tiny, tmp_path, monkeypatch):
    out = tmp_path / "out"
    weakforms("check", "paper2.tiny", "--out", out)
    page = (out / "report" / "index.html").read_bytes()
    shutil.rmtree(out / "solutions")
    for module, name in ((api, "solve_requests"), (runner, "verify"), (discovery, "find_cases")):
        monkeypatch.delattr(module, name)
    called = weakforms("report", out, "--out", tmp_path / "again")
    assert called.status == 0
    assert "PASSED" in called.out
    assert (tmp_path / "again" / "index.html").read_bytes() == page
    assert weakforms("report", out / "report").status == 0


@pytest.mark.parametrize("name", [RANDOM, AUDIT, COVERAGE])
def test_a_report_elsewhere_has_the_audits_of_the_run(weakforms, tiny, tmp_path, name):
    out, again = tmp_path / "out", tmp_path / "again"
    weakforms("check", "paper2.tiny", "--out", out)
    (out / name).write_text("{}")
    weakforms("report", out, "--out", again)
    assert (again / name).read_text() == "{}"


def test_report_as_pdf_needs_a_browser(weakforms, tiny, tmp_path, monkeypatch):
    out = tmp_path / "out"
    weakforms("check", "paper2.tiny", "--out", out)
    before = {path: path.stat().st_mtime_ns for path in (out / "report").iterdir()}
    monkeypatch.setattr(shutil, "which", lambda name: None)
    called = weakforms("report", out, "--pdf")
    assert (called.status, called.err.count("\n")) == (4, 1)
    assert "apt install chromium" in called.err
    assert {path: path.stat().st_mtime_ns for path in (out / "report").iterdir()} == before


def test_a_log_says_what_is_planned_and_how_each_case_went(weakforms, tiny, tmp_path, monkeypatch):
    monkeypatch.setattr(terminal, "PULSE", 0.001)
    lines = weakforms("verify", "--out", tmp_path / "out").err.splitlines()
    assert all(re.match(r"\[\d+:\d\d\] ", line) for line in lines)
    said = [text for line in lines if (text := line.partition("] ")[2]) != "starting"]
    assert said[0] == "1 case: 2 solutions to solve"
    again = weakforms("verify", "--out", tmp_path / "out").err
    assert re.search(r"(?m)2 solutions to solve, about .+ s by the times of the last run, \d+ MB$", again)
    assert sum(line.startswith("1 of 1 case: paper2.tiny passed, 1 check, ") for line in said) == 1
    assert any(line.startswith("0 of 2 solved; tube(") for line in said)  # where the work is, meanwhile
    assert said[-1] == "drawing the report"
    assert "] drawing the report\n" in weakforms("report", tmp_path / "out").err


def test_a_log_tells_the_time_that_is_left_at_the_speed_of_this_run(monkeypatch):
    """What an earlier run did took no time now."""
    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    log = terminal._Log()
    for second, share, text in (
        (0, 0.5, ""),
        (30, 0.51, ""),
        (60, 0.6, "; about 4 min left"),
        (120, 0.9, "; about 30 s left"),
        (150, 1.0, ""),
    ):
        now[0] = second
        log("solving", share, 1.0)
        assert log._left() == text


def test_a_terminal_shows_the_plan_and_the_time_that_is_left_while_estimates_change():
    now = [0.0]
    screen = Console(file=StringIO(), force_terminal=True, width=100, highlight=False)
    columns = (TextColumn("{task.description}"), TimeRemainingColumn())
    with Progress(*columns, console=screen, get_time=lambda: now[0], auto_refresh=False) as shown:
        bar = terminal._Bar(shown)
        bar.plan("3 cases: 40 solutions to solve")
        for second, done, total in ((0, 0.0, 30.0), (10, 10.0, 55.0), (20, 20.0, 60.0), (30, 30.0, 58.0)):
            now[0] = second
            bar("solving", done, total)
        assert shown.tasks[0].time_remaining == pytest.approx(28, abs=2)
    assert "3 cases: 40 solutions to solve" in screen.file.getvalue()


def test_work_is_shared_by_all_cores_unless_ranks_share_it(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(6)))
    assert terminal.free_cores() == 6
    monkeypatch.setattr("mpi4py.MPI.COMM_WORLD", SimpleNamespace(size=2))
    assert terminal.free_cores() == 1


def test_jobs_give_the_same_numbers(weakforms, tiny, tmp_path):
    def numbers(*options: str) -> list[str]:
        out = tmp_path / f"out{len(options)}"
        assert weakforms("verify", *options, "--out", out).status == 0
        data = json.loads((out / "report" / "report.json").read_text())
        return [v["detail"] for case in data["cases"] for v in case["verdicts"]]

    assert numbers() == numbers("-j", "2")


@pytest.mark.parametrize(
    ("old", "new", "status", "said"),
    [
        ("u[0] < u[1]", "u[1] < u[0]", 1, "failed"),
        ("u[0] < u[1]", "u[2] > 0", 1, "could not be judged: IndexError"),
        ('Axis("p", 0', 'Axis("nope", 0', 1, "could not be judged: KeyError"),
        ("checks=(Cl", "checks=() and (Cl", 1, "failed without a failed check"),
        ('At("p", 0.5)), (T', 'At("p", 7)), (T', 3, "p = 7 is not taken on this branch"),
    ],
)
def test_a_case_that_does_not_hold(weakforms, tiny, tmp_path, old, new, status, said):
    tiny(old, new)
    called = weakforms("verify", "--out", tmp_path / "out")
    assert (called.status, called.complaints) == (status, [])
    assert said in " ".join(called.out.split())
    assert (tmp_path / "out" / "report" / "index.html").exists()


def test_a_solve_that_fails_leaves_the_others(weakforms, tiny, tmp_path, monkeypatch):
    right = solving.solve_spec

    def first_fails(spec: object, states: list) -> object:
        if dict(spec.parameters)["delta1"] == 1.5:
            raise ConvergenceError("stalled at p = 0.1")
        return right(spec, states)

    monkeypatch.setattr(solving, "solve_spec", first_fails)
    called = weakforms("verify", "--out", tmp_path / "out")
    assert called.status == 3
    assert "stalled at p = 0.1" in called.out
    data = json.loads((tmp_path / "out" / "report" / "report.json").read_text())
    assert [(v["check"], v["passed"]) for v in data["cases"][0]["verdicts"]] == [("claim:wider", False)]
    assert len(list((tmp_path / "out" / "solutions").iterdir())) == 1


def test_a_worker_that_dies_is_one_clear_line(weakforms, tiny, tmp_path, monkeypatch):
    monkeypatch.setattr(solving, "_task", die)
    called = weakforms("verify", "-j", "2", "--out", tmp_path / "out")
    assert (called.status, len(called.complaints)) == (4, 1)
    assert "a worker process ended unexpectedly" in called.complaints[0]
