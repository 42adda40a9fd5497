"""The process that runs in a scratch copy: cases, tests and tables, up to the first that does not pass.

``python -m weakforms.verification.audit.faults.probe ANSWERS [--all | --lines] EXPECTATION...`` in the
copy's folder. Cases go the way of ``weakforms check``, through
:func:`weakforms.verification.run.runner.verify`. What it found is appended to ANSWERS as one JSON line an
expectation; only the parent, in which no fault is, reads anything into them.
"""

from __future__ import annotations

import json
import os
import sys
import time
import traceback
from dataclasses import replace
from pathlib import Path
from threading import Thread
from typing import Any

from weakforms.errors import ConvergenceError, WeakformsError
from weakforms.verification.audit.faults.catalogue import Expectation
from weakforms.verification.audit.faults.lines import Lines, Monitor
from weakforms.verification.audit.faults.tables import run_table
from weakforms.verification.cases.case import Case
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.judging.checks.check import Check
from weakforms.verification.judging.checks.points import Count


def narrowed(found: FoundCase, part: str) -> FoundCase:
    """The case with those curves and checks only that give a verdict whose name contains a text."""
    if not part:
        return found
    case: Case = found.case

    def wanted(labels: list[str]) -> bool:
        return any(part in label for label in labels)

    panels = [
        replace(panel, paths=(), curves=tuple(kept))
        for panel in case.panels
        if (kept := [c for c in panel.curves if wanted(c.names(found.paper))])
    ]
    checks = [_fewer(check, part) for check in case.checks if wanted(check.names(found.paper))]
    return replace(found, case=replace(case, panels=tuple(panels), checks=tuple(checks), surfaces=()))


def _fewer(check: Check, part: str) -> Check:
    """Of counts on several solutions those that are looked at."""
    if not isinstance(check, Count):
        return check
    kept = {spec: n for spec, n in check.expected.items() if part in f"count_{check.kind}:{spec}"}
    return replace(check, expected=kept)


def run_case(expectation: Expectation, folder: Path) -> dict[str, Any]:
    """Verdicts of a case, or of the part of it that is looked at."""
    from weakforms.verification.cases.discovery import get_case
    from weakforms.verification.run import runner

    found = narrowed(get_case(expectation.case), expectation.part)
    run = runner.verify([found], folder, "quick", expectation.text)
    (outcome,) = run.cases
    keys = ("check", "kind", "passed", "error", "bound", "asked", "detail", "where")
    verdicts = [{key: getattr(verdict, key) for key in keys} for verdict in outcome.verdicts]
    return {"status": outcome.status, "verdicts": verdicts, "errors": outcome.errors}


class Recorder:
    """What became of each test, as pytest reports it.

    Args:
        monitor: Notes the lines that each test function runs.
    """

    def __init__(self, monitor: Monitor | None = None) -> None:
        self.verdicts: list[dict[str, Any]] = []
        self.seconds: dict[str, float] = {}
        self.lines: dict[str, Lines] = {}
        self._monitor, self._raised = monitor, ""

    def pytest_runtest_makereport(self, call: Any) -> None:
        """What a test failed with: an assertion of its own, or a break-down of what it calls."""
        import pytest

        if call.excinfo is None:
            return
        error = call.excinfo.value
        own = isinstance(error, AssertionError | pytest.fail.Exception)
        self._raised = "" if own else "not solved" if isinstance(error, ConvergenceError) else "stopped"

    def pytest_runtest_logstart(self) -> None:
        """What ran before belongs to no test: imports, and fixtures that several share."""
        self._raised = ""
        self._note("")

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        """What ran since belongs to this test."""
        self._note(nodeid.partition("[")[0])

    def _note(self, name: str) -> None:
        if self._monitor is None:
            return
        known = self.lines.setdefault(name, {})
        for file, lines in self._monitor.taken().items():
            known[file] = sorted({*known.get(file, ()), *lines})

    def pytest_runtest_logreport(self, report: Any) -> None:
        """One line a test, and one for a fixture that failed."""
        name = report.nodeid.partition("[")[0]
        self.seconds[name] = round(self.seconds.get(name, 0.0) + report.duration, 6)
        if report.when != "call" and report.passed:
            return
        crash = getattr(report.longrepr, "reprcrash", None)
        message = str(getattr(crash, "message", report.longrepr or "")).splitlines()
        self.verdicts.append(
            {
                "check": report.nodeid,
                "kind": "test",
                "passed": bool(report.passed),
                "error": None,
                "bound": None,
                "asked": None,
                "detail": message[0][:300] if message else "",
                "where": "",
                "raised": "" if report.passed else self._raised,
            }
        )


def run_tests(expectation: Expectation, monitor: Monitor | None = None) -> dict[str, Any]:
    """Outcome of the tests of one node id; with a monitor all of them but the slow ones, whatever fails."""
    import pytest

    recorder = Recorder(monitor)
    chosen = ["-m", "not slow"] if monitor else ["-x", "-m", ""]
    words = ["-q", "-n", "0", "-p", "no:cacheprovider", *chosen, expectation.text]
    status = int(pytest.main(words, plugins=[recorder]))
    verdicts = recorder.verdicts
    good = status == 0 and bool(verdicts) and all(verdict["passed"] for verdict in verdicts)
    errors = [] if status in (0, 1) else [f"pytest ended with status {status}"]
    found = {"status": "passed" if good else "failed", "verdicts": verdicts, "errors": errors}
    return found | ({"times": recorder.seconds, "lines": recorder.lines} if monitor else {})


def _watched(expectation: Expectation, folder: Path, monitor: Monitor) -> dict[str, Any]:
    """Outcome of a test file or a case, with the lines it runs."""
    if expectation.is_test:
        return run_tests(expectation, monitor)
    begun = time.perf_counter()
    found = run_case(expectation, folder)
    seconds = round(time.perf_counter() - begun, 6)
    return found | {"times": {expectation.text: seconds}, "lines": {expectation.text: monitor.taken()}}


def _end_with_parent() -> None:
    """End when the process that started this one is gone, even by a kill: its end of the pipe closes."""
    pipe = os.dup(0)  # pytest puts something else in the place of standard input

    def wait() -> None:
        while os.read(pipe, 1):
            pass
        os._exit(1)

    Thread(target=wait, daemon=True).start()


def main(answers: Path, words: list[str]) -> None:
    """Run expectations one after the other, up to the first that does not pass; after ``--all``, all.

    After ``--lines`` all of them too, and the lines that are run are noted.
    """
    _end_with_parent()
    go_on = words[0] in ("--all", "--lines")
    monitor = Monitor(Path.cwd()) if words[0] == "--lines" else None
    for number, text in enumerate(words[go_on:]):
        wanted, begun = Expectation(text), time.perf_counter()
        out = answers.with_name(f"run-{number}")
        try:
            if monitor:
                found = _watched(wanted, out, monitor)
            elif wanted.table:
                found = run_table(wanted.table, out)
            else:
                found = run_tests(wanted) if wanted.is_test else run_case(wanted, out)
        except Exception as error:
            if not isinstance(error, WeakformsError):
                traceback.print_exc()
            found = {"status": "error", "verdicts": [], "errors": [f"{type(error).__name__}: {error}"]}
        found |= {"expectation": text, "seconds": time.perf_counter() - begun}
        with answers.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(found, default=str) + "\n")
        if found["status"] != "passed" and not go_on:
            return


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
    sys.stdout.flush()
    os._exit(0)  # what PETSc or MPI make of a fault at their end is no finding
