"""The audit draws allowed parameters, reports each outcome, and survives a solve that hangs."""

import json
import sys
import time
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime
from io import StringIO
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from markupsafe import escape
from pydantic import Field
from rich.console import Console

from weakforms.errors import InputError
from weakforms.problems import registry
from weakforms.problems.about import About
from weakforms.problems.problem import Parameters
from weakforms.verification.audit.any_parameters import runner
from weakforms.verification.audit.any_parameters.draw import drawn, sets
from weakforms.verification.audit.any_parameters.outcome import (
    NAME,
    STATUSES,
    Audited,
    AuditRun,
    Draw,
    load_audit,
    print_audit,
)
from weakforms.verification.audit.any_parameters.runner import classified, run_audit, solved, solved_set
from weakforms.verification.audit.any_parameters.verb import audit_verb
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render

NO_CONTACT = {"failures": [], "absent": [{"what": "contact", "reason": "p_end is below first contact"}]}
FAILED = {"failures": [{"what": "special points", "reason": "several eigenvalues change sign"}]}


@pytest.mark.parametrize(
    ("code", "said", "result", "status", "message"),
    [
        (0, "", {"failures": []}, "answered", None),
        (0, "", NO_CONTACT, "not there", "contact: p_end is below first contact"),
        (3, "weakforms: not converged: ...", FAILED, "in part", "special points: several eigenvalues"),
        (2, "weakforms: tube: s = 9 is out of reach", {}, "refused", "tube: s = 9 is out of reach"),
        (3, "weakforms: SNES ended with X", {}, "not converged", "SNES ended with X"),
        (1, "weakforms: internal error", {}, "broke down", "internal error"),
        (-11, "", {}, "broke down", "exit status -11"),
        (4, "weakforms: not enough memory", {}, "broke down", "not enough memory"),
        (None, "", {}, "too slow", "it did not end within 7 s"),
        # An inconsistent result does not count as an answer.
        (0, "", {}, "broke down", "exit status 0"),
        (0, "", FAILED, "broke down", "exit status 0"),
        (3, "", {"failures": []}, "broke down", "exit status 3"),
    ],
)
def test_every_way_a_solve_may_end_has_its_name(code, said, result, status, message):
    found, messages = classified(code, said, result, 7)
    assert found == status
    assert found in STATUSES
    assert message is None or message in " ".join(messages)


# -- draws -----------------------------------------------------------------------------------------


class Ranges(Parameters):
    """One parameter of every kind."""

    a: float = Field(1.0, gt=0, le=2)
    wide: float = Field(1.0, gt=0, le=1e4)
    ratio: float = Field(1.0, ge=1, le=60)
    count: int = Field(3, ge=1, le=6)
    law: Literal["x", "y"] = "x"
    flag: bool = False
    maybe: float | None = Field(None, ge=-3, le=-1)
    free: float = 0.0


class Canned:
    """A problem that refuses contradictory parameters."""

    name = "canned"
    about = About(name, "Canned", 1, "", "", "")
    parameters = Ranges

    def check(self, parameters, _requests):  # noqa: D102
        if parameters.law == "y" and parameters.flag:
            raise InputError("canned: flag = True needs law = 'x'")


def test_draws_fill_the_ranges_that_the_parameters_state():
    rows = [next(draws) for draws in [drawn(Canned(), 1)] for _ in range(400)]
    for name, low, high in (("a", 0, 2), ("wide", 10, 1e4), ("ratio", 1, 60), ("count", 1, 6)):
        values = np.array([row[name] for row in rows])
        assert low <= values.min() < low + 0.1 * (high - low)
        assert high - 0.2 * (high - low) < values.max() <= high
    assert {row["law"] for row in rows} == {"x", "y"}
    assert {row["flag"] for row in rows} == {True, False}
    assert {"maybe" in row for row in rows} == {True, False}
    assert all(-3 <= row["maybe"] <= -1 for row in rows if "maybe" in row)
    assert not any("free" in row for row in rows), "nothing says what it may be"


def test_contradictions_are_drawn_again_and_counted():
    found, refused = sets(Canned(), 1, 40)
    assert len(found) == 40
    assert not any(row["law"] == "y" and row["flag"] for row in found)
    assert list(refused) == ["canned: flag = True needs law = 'x'"]
    assert sets(Canned(), 1, 7)[0] == found[:7], "the same however many are wanted"
    assert sets(Canned(), 2, 7)[0] != found[:7]


@pytest.mark.parametrize("name", list(registry.abouts()))
def test_every_problem_can_be_drawn_and_its_laws_are(name):
    found, _ = sets(registry.get(name), 5, 40)
    fields = registry.get(name).parameters.model_fields
    for field in (field for field, of in fields.items() if of.annotation is float):
        given = {row[field] for row in found if field in row}
        assert len(given) > 10 or field in registry.abouts()[name].audit_held, field
    if "model" in fields:
        assert len({row["model"] for row in found}) > 3


def test_what_is_held_is_known_to_the_problems():
    for problem in registry.problems().values():
        assert set(problem.about.audit_held) <= set(problem.parameters.model_fields)
        problem.numerics(**problem.about.audit_numerics)


# -- runs ------------------------------------------------------------------------------------------


def test_a_real_draw_is_solved_stored_and_taken_over(tmp_path, monkeypatch):
    told = []
    run = run_audit(["wrinkled_material"], 1, 3, 100.0, tmp_path, report=lambda *a: told.append(a))
    (draw,) = run.draws
    assert (draw.status, draw.messages) == ("answered", ())
    assert told[0][:2] == (1, 1)
    assert load_audit(tmp_path / NAME) == run
    monkeypatch.setattr(runner, "solved", lambda *_: pytest.fail("it is stored"))
    assert run_audit(["wrinkled_material"], 1, 3, 100.0, tmp_path, resume=True).draws == run.draws
    with pytest.raises(pytest.fail.Exception):
        run_audit(["wrinkled_material"], 1, 3, 99.0, tmp_path, resume=True)


@pytest.mark.parametrize(
    ("coarse", "default", "numerics", "seconds"),
    [
        ("answered", None, {"cells": 8}, 2.0),
        ("not there", None, {"cells": 8}, 2.0),
        ("in part", "answered", {}, 5.0),
        ("too slow", "not converged", {}, 5.0),
    ],
)
def test_default_meshes_decide_where_coarse_ones_do_not_answer(
    monkeypatch, coarse, default, numerics, seconds
):
    calls = {"cells=8": (coarse, (), 2.0), "p_end=4": (default, ("on default meshes",), 3.0)}
    monkeypatch.setattr(runner, "solved", lambda call, _: calls[call[-1]])
    draw = solved_set("rectangle", 3, {"p_end": 4}, {"cells": 8}, 7)
    assert (draw.numerics, draw.seconds) == (numerics, seconds)
    assert draw.status == (default or coarse)


def test_a_solve_that_hangs_is_ended():
    status, messages, seconds = solved(["solve", "tube"], 0.2)
    assert (status, messages) == ("too slow", ("it did not end within 0.2 s of processor time",))
    assert 0.2 <= seconds < 10


@pytest.mark.slow
def test_time_spent_waiting_for_the_processor_does_not_count(monkeypatch):
    """A process that only waits is ended late, one that computes at the limit."""
    monkeypatch.setattr(runner, "WAITING", 15.0)  # a busy machine makes all of it slow
    for work, ended in (
        ("time.sleep(1)", False),
        ("time.sleep(30)", True),
        ("[0 for _ in iter(int, 1)]", True),
    ):
        code, _ = runner._process([sys.executable, "-c", f"import time; {work}"], 0.5)
        assert code == (None if ended else 0), work


@pytest.mark.parametrize(("used", "ended"), [(0.98, False), (0.995, True)])
def test_a_killed_process_was_too_slow_only_if_it_used_its_time(used, ended, monkeypatch):
    """Something else may kill it, such as a lack of memory; the kernel counts processor time in ticks."""
    times = iter([10.0, 10.0 + used])
    monkeypatch.setattr(runner, "_processor_time", lambda: next(times))
    code, _ = runner._process([sys.executable, "-c", "import os; os.kill(os.getpid(), 9)"], 1.0)
    assert code == (None if ended else -9)


def test_a_refusal_is_kept_word_for_word():
    status, messages, _ = solved(["solve", "tube", "--set", "delta1=0.5"], 100)
    assert status == "refused"
    assert "delta1 = '0.5'" in messages[0]


def canned_run() -> AuditRun:
    def draw(number, status, *messages):
        return Draw("tube", number, {"s": 1.5, "flag": True}, {"cells": 8}, status, messages, 1.0)

    draws = [draw(1, "answered"), draw(2, "refused", "s = 1.5 is out of reach"), draw(3, "answered")]
    return AuditRun(7, 3, 60.0, "2026-01-01T00:00:00+00:00", 3.0, "abc", {}, {"tube": {"no": 2}}, draws)


def test_the_table_names_every_set_that_is_not_answered_and_repeats_it():
    written = StringIO()
    print_audit(canned_run(), Console(width=200, file=written))
    text = written.getvalue()
    assert "weakforms solve tube --set s=1.5 --set flag=true --mesh cells=8" in text
    assert "s = 1.5 is out of reach" in text
    assert "67%" in text
    assert "2 of 3 sets of parameters answered (66.7%), seed 7" in text


def test_an_audit_without_draws_states_no_share():
    assert replace(canned_run(), draws=[]).headline == "0 of 0 sets of parameters answered, seed 7"


def test_a_file_that_is_no_audit_is_a_problem_to_be_shown(tmp_path):
    assert Audited.beside(tmp_path) == Audited()
    data = canned_run().to_json()
    for wrong in ({}, {**data, "schema": "x"}, {**data, "seed": "y"}, {**data, "draws": [{}]}):
        (tmp_path / NAME).write_text(json.dumps(wrong))
        assert Audited.beside(tmp_path).run is None
        assert Audited.beside(tmp_path).problem
    assert "draws/0/" in Audited.beside(tmp_path).problem, "the place in the file"
    data["draws"][0]["status"] = "fine"
    (tmp_path / NAME).write_text(json.dumps(data))
    assert "status 'fine'" in Audited.beside(tmp_path).problem


@pytest.mark.parametrize("seed", [None, 7])
def test_the_seed_is_that_of_the_day_unless_one_is_given(seed, tmp_path, monkeypatch):
    asked = []

    def run(names, count, chosen, *_rest):
        asked.append((names, count, chosen))
        return AuditRun(chosen, count, 60.0, "2026-01-01T00:00:00+00:00", 3.0, "abc", {})

    monkeypatch.setattr(runner, "run_audit", run)
    days = [datetime.now(UTC)]
    audit_verb(["tube", "tube"], 3, seed, 300.0, tmp_path, False, True, Console(file=StringIO()))
    days.append(datetime.now(UTC))
    seeds = [7] if seed else [int(day.strftime("%Y%m%d")) for day in days]
    ((names, count, chosen),) = asked
    assert (names, count) == (["tube"], 3)
    assert chosen in seeds


def test_the_folder_is_tried_before_anything_is_solved(monkeypatch):
    monkeypatch.setattr(runner, "solved", lambda *_: pytest.fail("nothing is to be solved"))
    with pytest.raises(InputError):
        run_audit(["material"], 1, 3, 9.0, Path("/proc/nowhere"))
    with pytest.raises(InputError, match="unknown problem"):
        run_audit(["nothing"], 1, 3, 9.0, Path("/proc/nowhere"))


def test_the_report_shows_it_when_it_lies_beside_the_results():
    run = canned_run()
    page = render(RunOutcome("quick", "all", "", 0.0, {}), Beside(audited=Audited(run)))["audit.html"]
    for text in (run.headline, "s = 1.5 is out of reach", run.missed[0].command, "67 %"):
        assert escape(text) in page
    assert "There is no audit in the folder" in render(RunOutcome("quick", "all", "", 0.0, {}))["audit.html"]


def test_a_process_that_waits_too_long_is_ended_with_its_children(monkeypatch):
    monkeypatch.setattr(runner, "WAITING", 1.0)
    begun = time.perf_counter()
    assert runner._process(["sh", "-c", "sleep 61 & sleep 61"], 1.0) == (None, "")
    assert time.perf_counter() - begun < 30
    while time.perf_counter() - begun < 40 and b"sleep\x0061\x00" in running():  # the kernel needs a moment
        time.sleep(0.1)
    assert b"sleep\x0061\x00" not in running()


def running():
    """Command lines of all processes."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):  # it ended meanwhile
            found.append(path.read_bytes())
    return found


def test_signs_of_life_are_no_messages():
    said = "[0:15] starting\n[1:30] branch; about 2 min left\nweakforms: no first state\n"
    assert classified(3, said, {}, 7.0) == ("not converged", ("no first state",))
