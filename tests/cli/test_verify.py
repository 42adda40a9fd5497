"""Verify, check and report: solve cases, continue after an interruption, write again without solving."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console
from rich.progress import Progress, TextColumn, TimeRemainingColumn

from weakforms import api, terminal, tube
from weakforms.errors import ConvergenceError
from weakforms.verification.audit.any_parameters.outcome import NAME as AUDIT
from weakforms.verification.audit.coverage.outcome import NAME as COVERAGE
from weakforms.verification.audit.faults.outcome import RANDOM
from weakforms.verification.cases import catalogue, discovery
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.run import runner, solving
from weakforms.verification.run.effort import Effort
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.runner import expectation
from weakforms.verification.run.usual import usual_megabytes, usual_times

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


# -- an interrupted run --------------------------------------------------------------------------

MANY = '''"""Many short branches."""
from weakforms import At, Case, Claim, tube

TUBES = [tube(delta1=1.5 + i / 16, u_end=0.3).on(cells=16, levels=2) for i in range(16)]

def wider(solutions):
    u = [solutions.value(spec, At("p", 0.5), "u_max") for spec in TUBES]
    return min(u) > 0, f"{u}"

CASE = Case(
    title="many",
    source="tests",
    checks=(Claim("wider", "bulges", tuple((spec, At("p", 0.5)) for spec in TUBES), wider),),
)
'''


def starter(tree):
    """How to start ``verify`` in a separate process on a tree whose only case has many branches."""
    path = tree / "cases" / "paper2" / "many.py"
    path.parent.mkdir(parents=True)
    path.write_text(MANY)
    code = (
        "import sys; from pathlib import Path; from weakforms.verification.cases import discovery\n"
        f"find = discovery.find_cases; discovery.find_cases = lambda: find(Path({str(tree)!r}))\n"
        "sys.argv[0] = 'weakforms'; from weakforms.cli import main; main()"
    )

    def start(*words: object) -> subprocess.Popen:
        command = [sys.executable, "-c", code, "verify", *map(str, words)]
        return subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
        )

    return start


@pytest.fixture
def many(tmp_path, monkeypatch):
    """That tree's cases for runs in this process."""
    find = discovery.find_cases
    for module in (discovery, catalogue):
        monkeypatch.setattr(module, "find_cases", lambda: find(tmp_path))
    yield
    find.cache_clear()


undisturbed: list[str] = []
"""The results of an uninterrupted run."""


def details(out) -> list[str]:
    """The results of the checks with all digits."""
    data = json.loads((out / "report" / "report.json").read_text())
    return [v["detail"] for case in data["cases"] for v in case["verdicts"]]


@pytest.mark.parametrize(
    ("ending", "jobs", "status"),
    [(signal.SIGINT, 1, 130), (signal.SIGKILL, 1, -signal.SIGKILL), (signal.SIGKILL, 2, -signal.SIGKILL)],
)
def test_an_interrupted_run_goes_on_where_it_was(weakforms, many, tmp_path, ending, jobs, status):
    start, out = starter(tmp_path), tmp_path / "out"
    running = start("-j", jobs, "--out", out)
    stored, end = out / "solutions", time.monotonic() + 300
    while len(list(stored.glob("tube-*.json"))) < 2 and time.monotonic() < end:
        time.sleep(0.002)
    os.killpg(running.pid, ending) if jobs == 1 else running.send_signal(ending)
    _, said = running.communicate(timeout=120)
    assert running.returncode == status, said
    assert ("--resume" in said) == (ending == signal.SIGINT)
    assert said.count("weakforms:") <= 1  # Python may say something about a killed process of its own
    kept = {p: p.read_bytes() for p in stored.glob("tube-*.json")}
    assert 2 <= len(kept) < 16, "the run was over before it could be interrupted"
    assert not (out / "report" / "index.html").exists()

    assert weakforms("verify", "--out", out, "--resume").status == 0
    assert {p: p.read_bytes() for p in kept} == kept, "what was stored is not solved again"
    assert len(list(stored.glob("tube-*.json"))) == 16
    if not undisturbed:
        assert weakforms("verify", "--out", tmp_path / "undisturbed").status == 0
        undisturbed.extend(details(tmp_path / "undisturbed"))
    assert details(out) == undisturbed


def test_a_first_run_is_estimated_by_the_shipped_times_at_the_pace_of_this_machine(tmp_path):
    specs = [tube(alpha=a) for a in (0, 0.1, 0.2)]
    usual = {str(spec): seconds for spec, seconds in zip(specs, (10.0, 20.0, 30.0), strict=True)}
    effort = Effort(tmp_path / "times.json", specs, usual)
    assert (effort.expected(2), effort.is_of_this_machine) == (30.0, False)
    effort.finish(specs[0], 5.0)
    assert effort.share() == (5.0, 30.0), "this machine is twice as fast"
    effort.finish(specs[1], 25.0)
    effort.finish(specs[2], 30.0)
    assert effort.is_of_this_machine


def test_times_of_most_solutions_are_shipped():
    states, shipped = Plan.of(find_cases()).states, usual_times()
    known = [spec for spec in states if str(spec) in shipped]
    assert len(known) >= 0.9 * len(states), "write them again: see weakforms/verification/run/usual.py"
    assert usual_megabytes(known[:10]) == pytest.approx(
        usual_megabytes([*known[:10], tube(alpha=0.77)]) / 1.1
    )
    text = expectation(Effort(Path("nowhere"), states, shipped), [*states], 2)
    assert re.fullmatch(r", about .+ min( .+ s)? by the times of a machine with two cores, \d+ MB", text)


def test_progress_counts_seconds_not_solutions(tmp_path):
    specs = [tube(alpha=a) for a in (0, 0.1, 0.2)]
    first = Effort(tmp_path / "times.json", specs)
    assert first.share() == (0, 3.0)
    first.finish(specs[0], 30.0)
    assert first.share() == (30.0, 90.0), "those not seen yet count as their like"
    first.finish(specs[1], 1.0)
    first.finish(specs[2], 2.0)
    first.keep()
    again = Effort(tmp_path / "times.json", specs)
    again.finish(specs[1])
    assert again.share() == (1.0, 33.0)
    assert again.count == "1 of 3"
    assert again.expected(2) == 16.0
    assert first.expected(1) == 0
    assert Effort(tmp_path / "times.json", [*specs, tube(alpha=0.3)]).expected(1) == 44.0
    new = [tube(alpha=a) for a in (0.3, 0.4, 0.5, 0.6)]
    assert Effort(tmp_path / "times.json", [*specs, *new]).expected(1) is None, "fewer than half are known"
    (tmp_path / "times.json").write_text("[1")
    assert Effort(tmp_path / "times.json", specs).share() == (0, 3.0)
