"""The processes that run in scratch copies: started, waited for, and ended with the run."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from threading import Lock
from typing import Any

from weakforms.verification.cases.references import ROOT

WAITING = 20.0
"""A process that waits instead of computing is ended after this many times the limit of processor time."""

LOOK = 1.0
"""Seconds between two looks at the processor time of a process."""


@dataclass(frozen=True)
class Answer:
    """What a probe says about one expectation."""

    expectation: str
    status: str
    seconds: float
    verdicts: list[dict[str, Any]]
    errors: list[str]
    times: dict[str, float] = field(default_factory=dict)
    """Seconds by case or test function, where lines are noted ..."""
    lines: dict[str, dict[str, list[int]]] = field(default_factory=dict)
    """... and what each ran."""


class Children:
    """Probes that are running; all of them end when the run is interrupted."""

    def __init__(self) -> None:
        self._running: set[subprocess.Popen] = set()
        self._numbers, self._lock, self._ended = count(), Lock(), False

    def run(
        self,
        root: Path,
        expectations: list[str],
        limit: float,
        go_on: bool = False,
        lines: Path | None = None,
    ) -> tuple[list[Answer], str]:
        """Run a probe in a copy of the tree.

        Args:
            root: The copy.
            expectations: What it runs, up to the first that does not pass.
            limit: Seconds of processor time after which it is ended; a busy machine ends no run.
            go_on: Run all of them, whatever does not pass.
            lines: Folder to work in where the lines that are run are noted; by default one beside the copy.

        Returns:
            Its answers, and why it broke down before the last (empty if it did not).
        """
        beside = lines / "running" if lines else root
        folder = beside.with_name(f"{beside.name}-{next(self._numbers)}")
        shutil.rmtree(folder, ignore_errors=True)  # of a run that was killed
        folder.mkdir()
        answers, log = folder / "answers", folder / "log"
        words = [sys.executable, "-m", "weakforms.verification.audit.faults.probe", str(answers)]
        words += ["--lines"] if lines else ["--all"] if go_on else []
        with log.open("wb") as stream:
            child = self._start([*words, *expectations], root, stream)
            failure = self._wait(child, limit)
        found = _answers(answers)
        if not failure and (len(found) < len(expectations) and all(a.status == "passed" for a in found)):
            failure = "the process ended early"
        if failure:
            failure += _last_line(log)
        shutil.rmtree(folder, ignore_errors=True)
        return found, failure

    def _start(self, words: list[str], root: Path, stream: Any) -> subprocess.Popen:
        with self._lock:
            if self._ended:
                raise KeyboardInterrupt
            child = subprocess.Popen(
                words,
                cwd=root,
                env=_environment(root),
                stdin=subprocess.PIPE,  # closes when this process ends, however it does
                stdout=stream,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            self._running.add(child)
            return child

    def _wait(self, child: subprocess.Popen, limit: float) -> str:
        failure = ""
        last = time.monotonic() + WAITING * limit
        try:
            while (status := _ended(child)) is None:
                if _processor_time(child.pid) > limit or time.monotonic() > last:
                    failure = f"it did not end within {limit:.0f} s of processor time"
                    _kill(child)
                    break
            else:
                failure = f"the process ended with status {status}" if status else ""
        finally:
            with self._lock:
                self._running.discard(child)
            child.stdin.close()
        return failure

    def end(self) -> None:
        """End all of them, and start no more."""
        with self._lock:
            self._ended = True
            running = list(self._running)
        for child in running:
            _kill(child)


def _ended(child: subprocess.Popen) -> int | None:
    """Exit status of a process; none if it is still running after a short while."""
    try:
        return child.wait(LOOK)
    except subprocess.TimeoutExpired:
        return None


def _processor_time(pid: int) -> float:
    """Seconds of processor time of a process and those it has waited for; zero where none is known."""
    try:
        after_name = Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(map(int, after_name[11:15])) / os.sysconf("SC_CLK_TCK")


def _kill(child: subprocess.Popen) -> None:
    """End a process and those it started."""
    with suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()


def _environment(root: Path) -> dict[str, str]:
    """This process's, with the copy in the place of the tree."""
    paths = [p for p in os.environ.get("PYTHONPATH", "").split(os.pathsep) if p]
    others = [p for p in paths if Path(p).resolve() != ROOT]
    changed = {"PYTHONPATH": os.pathsep.join([str(root), *others]), "OMP_NUM_THREADS": "1"}
    return {**os.environ, **changed}


def _answers(path: Path) -> list[Answer]:
    try:
        lines = path.read_text("utf-8").splitlines()
    except OSError:
        return []
    return [Answer(**json.loads(line)) for line in lines]


def _last_line(log: Path) -> str:
    lines = [line for line in log.read_text("utf-8", "replace").splitlines() if line.strip()]
    return f": {lines[-1].strip()[:200]}" if lines else ""
