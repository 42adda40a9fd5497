"""Processes that share a run solve each problem only once."""

import fcntl
import multiprocessing
import os
from pathlib import Path

import pytest
from shared_run import SharedRun

from weakforms import At, Case, Claim, tube
from weakforms.errors import ConvergenceError
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.run import solving

SPECS = [tube(delta1=d, u_end=0.3).on(cells=16, levels=2) for d in (1.5, 2)]


def case(name: str, specs: list) -> FoundCase:
    def positive(solutions):
        found = [solutions.value(spec, At("p", 0.5), "u_max") for spec in specs]
        return min(found) > 0, f"{found}"

    claim = Claim("positive", "bulges", tuple((spec, At("p", 0.5)) for spec in specs), positive)
    return FoundCase(f"paper2.{name}", 2, Path(name), Case(title=name, source="tests", checks=(claim,)), "")


CASES = [case("one", SPECS[:1]), case("both", SPECS)]


@pytest.fixture
def solved(monkeypatch):
    """Problems solved in this process, in the order of requests."""
    right, seen = solving.solve_spec, []
    monkeypatch.setattr(solving, "solve_spec", lambda spec, at: seen.append(spec) or right(spec, at))
    return seen


def test_what_another_process_solved_is_taken(solved, tmp_path):
    first, second = (SharedRun(CASES, tmp_path / "run") for _ in range(2))
    assert first.outcome("paper2.one").status == "passed"
    assert solved == SPECS[:1]
    both = second.outcome("paper2.both")
    assert (both.status, len(both.solutions)) == ("passed", 2)
    assert solved == SPECS
    assert second.outcome("paper2.both") is both


def test_what_does_not_converge_is_told_by_every_case_that_needs_it(tmp_path, monkeypatch):
    def fails(*_):
        raise ConvergenceError("stalled at p = 0.1")

    monkeypatch.setattr(solving, "solve_spec", fails)
    shared = SharedRun(CASES, tmp_path / "run")
    for name in ("paper2.one", "paper2.both"):
        assert shared.outcome(name).status == "error"
        assert "stalled at p = 0.1" in shared.outcome(name).errors[0]


def test_while_another_process_solves_this_one_solves_what_is_needed_later(tmp_path, monkeypatch):
    shared, seen, right = SharedRun(CASES, tmp_path / "run"), [], solving.solve_spec
    other = shared.path(SPECS[0], "lock").open("a")
    fcntl.flock(other, fcntl.LOCK_EX)

    def solve(spec, at):
        seen.append(spec)
        other.close()
        return right(spec, at)

    monkeypatch.setattr(solving, "solve_spec", solve)
    assert shared.outcome("paper2.one").status == "passed"
    assert seen == SPECS[::-1]


def end_while_solving(folder: Path) -> None:
    solving.solve_spec = lambda *_: os._exit(1)
    SharedRun(CASES, folder).outcome("paper2.one")


def test_what_a_process_died_of_is_not_solved_again(solved, tmp_path):
    dying = multiprocessing.get_context("spawn").Process(target=end_while_solving, args=[tmp_path / "run"])
    dying.start()
    dying.join(60)
    assert dying.exitcode == 1
    with pytest.raises(pytest.fail.Exception, match=r"delta1=1\.5.* began and never ended"):
        SharedRun(CASES, tmp_path / "run").outcome("paper2.one")
    assert solved == []
