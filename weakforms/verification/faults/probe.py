"""The process that runs in a scratch copy: cases and tests, up to the first that does not pass.

``python -m weakforms.verification.faults.probe ANSWERS [--all] EXPECTATION...`` in the copy's folder. Cases
go the way of ``weakforms check``, through :func:`weakforms.verification.runner.verify`. What it found is
appended to ANSWERS as one JSON line an expectation; only the parent, in which no fault is, reads anything
into them.
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

from weakforms.errors import WeakformsError
from weakforms.verification.case import Case, Check, Count
from weakforms.verification.discovery import FoundCase
from weakforms.verification.faults.catalogue import Expectation


def narrowed(found: FoundCase, part: str) -> FoundCase:
    """The case with those curves and checks only that give a verdict whose name contains a text."""
    from weakforms.verification import curves, ledger, runner  # noqa: F401  (registers its checks)
    from weakforms.verification.judge import names

    if not part:
        return found
    case: Case = found.case

    def wanted(labels: list[str]) -> bool:
        return any(part in label for label in labels)

    panels = [
        replace(panel, paths=(), curves=tuple(kept))
        for panel in case.panels
        if (kept := [c for c in panel.curves if wanted(curves.names(found.paper, c, case))])
    ]
    checks = [_fewer(check, part) for check in case.checks if wanted(names(check, found.paper))]
    return replace(found, case=replace(case, panels=tuple(panels), checks=tuple(checks), surfaces=()))


def _fewer(check: Check, part: str) -> Check:
    """Of counts on several solutions those that are looked at."""
    if not isinstance(check, Count):
        return check
    kept = {spec: n for spec, n in check.expected.items() if part in f"count_{check.kind}:{spec}"}
    return replace(check, expected=kept)


def run_case(expectation: Expectation, folder: Path) -> dict[str, Any]:
    """Verdicts of a case, or of the part of it that is looked at."""
    from weakforms.verification import runner
    from weakforms.verification.discovery import get_case

    found = narrowed(get_case(expectation.case), expectation.part)
    run = runner.verify([found], folder, "quick", expectation.text)
    (outcome,) = run.cases
    keys = ("check", "kind", "passed", "error", "bound", "asked", "detail", "where")
    verdicts = [{key: getattr(verdict, key) for key in keys} for verdict in outcome.verdicts]
    return {"status": outcome.status, "verdicts": verdicts, "errors": outcome.errors}


class Recorder:
    """What became of each test, as pytest reports it."""

    def __init__(self) -> None:
        self.verdicts: list[dict[str, Any]] = []

    def pytest_runtest_logreport(self, report: Any) -> None:
        """One line a test, and one for a fixture that failed."""
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
            }
        )


def run_tests(expectation: Expectation) -> dict[str, Any]:
    """Outcome of the tests of one node id."""
    import pytest

    recorder = Recorder()
    words = ["-q", "-x", "-n", "0", "-p", "no:cacheprovider", "-m", "", expectation.text]
    status = int(pytest.main(words, plugins=[recorder]))
    verdicts = recorder.verdicts
    good = status == 0 and bool(verdicts) and all(verdict["passed"] for verdict in verdicts)
    errors = [] if status in (0, 1) else [f"pytest ended with status {status}"]
    return {"status": "passed" if good else "failed", "verdicts": verdicts, "errors": errors}


def _end_with_parent() -> None:
    """End when the process that started this one is gone, even by a kill: its end of the pipe closes."""
    pipe = os.dup(0)  # pytest puts something else in the place of standard input

    def wait() -> None:
        while os.read(pipe, 1):
            pass
        os._exit(1)

    Thread(target=wait, daemon=True).start()


def main(answers: Path, words: list[str]) -> None:
    """Run expectations one after the other, up to the first that does not pass; after ``--all``, all."""
    _end_with_parent()
    go_on = words[0] == "--all"
    for number, text in enumerate(words[go_on:]):
        wanted, begun = Expectation(text), time.perf_counter()
        out = answers.with_name(f"run-{number}")
        try:
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
