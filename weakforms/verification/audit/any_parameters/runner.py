"""Solves the sets of an audit, each by the command line in a separate process."""

from __future__ import annotations

import hashlib
import math
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from weakforms.errors import InputError
from weakforms.problems import registry
from weakforms.results.io import dumps, load_json, require_writable, write_atomically
from weakforms.verification.audit.any_parameters.draw import sets
from weakforms.verification.audit.any_parameters.outcome import ANSWERS, NAME, AuditRun, Draw, words
from weakforms.verification.audit.faults.scratch import tree_digest
from weakforms.verification.run.machine import environment

Report = Callable[[int, int, str], None]
"""Progress callback: number of finished sets, number of sets, outcome of the last one."""

SHOWN = 3
"""Number of lines of standard error that are stored."""

SIGN_OF_LIFE = re.compile(r"\[\d+:\d\d\] ")
"""How a line begins that says how far a long solve is."""

NEARLY = 0.99
"""Share of the limit from which a killed process counts as ended there: the kernel counts in ticks."""

WAITING = 20.0
"""A solve that waits instead of computing is ended after this many times the limit of processor time."""


def run_audit(
    problems: list[str],
    count: int,
    seed: int,
    limit: float,
    out: Path,
    resume: bool = False,
    report: Report = lambda *_: None,
) -> AuditRun:
    """Draw and solve, and write ``audit.json`` into the output folder.

    Args:
        problems: Their names.
        count: Number of sets for each problem.
        seed: Seed of the draws.
        limit: Seconds of processor time after which a solve is ended; a busy machine changes no outcome.
        out: Output folder; every outcome is stored below it at once.
        resume: Keep stored outcomes for the same source, set and limit.
        report: Called with the progress.

    Raises:
        InputError: For an unknown problem or a folder that cannot be written, before anything is solved.
    """
    begun, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    drawn = {name: sets(registry.get(name), seed, count) for name in problems}
    store = out / "audit"
    require_writable(store)
    tree = tree_digest()
    run = AuditRun(seed, count, limit, started, 0.0, tree, environment())
    run.contradictions = {name: refused for name, (_, refused) in drawn.items() if refused}
    todo = [(name, k, given) for name, (found, _) in drawn.items() for k, given in enumerate(found, 1)]
    for name, k, given in todo:
        meshes = dict(registry.get(name).about.audit_numerics)
        call = words(name, given, meshes)
        key = hashlib.sha256(f"{tree} {limit} {call!r}".encode()).hexdigest()[:16]
        file = store / f"{name}-{seed}-{k}.json"
        draw = _stored(file, key) if resume else None
        if draw is None:
            draw = solved_set(name, k, given, meshes, limit)
            write_atomically(file, dumps({"key": key, "draw": asdict(draw)}))
        run.draws.append(draw)
        report(len(run.draws), len(todo), f"{name} {k} of {count}: {draw.status}, {draw.seconds:.0f} s")
    run.seconds = round(time.perf_counter() - begun, 3)
    write_atomically(out / NAME, dumps(run.to_json()))
    return run


def solved_set(name: str, number: int, given: dict[str, Any], meshes: dict[str, Any], limit: float) -> Draw:
    """Solve a set on an audit's coarse meshes and, where these do not answer, on the default ones.

    A user who names no meshes has the default ones, so that their outcome is the one that counts.
    """
    spent = 0.0
    for numerics in [meshes, {}] if meshes else [{}]:
        status, messages, seconds = solved(words(name, given, numerics), limit)
        spent += seconds
        draw = Draw(name, number, given, numerics, status, messages, round(spent, 2))
        if status in ANSWERS:
            break
    return draw


def solved(call: list[str], limit: float) -> tuple[str, tuple[str, ...], float]:
    """Solve by the command line in a process that is ended at the limit.

    Returns:
        Status, messages, seconds of processor time (with those of the compiler).
    """
    begun = _processor_time()
    with tempfile.TemporaryDirectory(prefix="weakforms-audit-") as folder:
        file = Path(folder) / "result.json"
        code, complaint = _process([sys.executable, "-m", "weakforms", *call, "--out", str(file)], limit)
        seconds = round(_processor_time() - begun, 2)
        return *classified(code, complaint, _read(file), limit), seconds


def classified(
    code: int | None, complaint: str, result: dict[str, Any], limit: float
) -> tuple[str, tuple[str, ...]]:
    """The outcome of a solve, and its messages.

    Args:
        code: Exit status of its process; ``None`` when it was ended at the limit.
        complaint: Its standard error.
        result: Its result; empty if there is none.
        limit: Limit in seconds of processor time.
    """
    lines = [line for line in complaint.splitlines() if line.strip() and not SIGN_OF_LIFE.match(line)]
    said = [line.removeprefix("weakforms: ") for line in lines]
    last = tuple(said[-SHOWN:])
    if code is None:
        return "too slow", (f"it did not end within {limit:g} s of processor time",)
    failures = tuple(f"{item['what']}: {item['reason']}" for item in result.get("failures", []))
    if code == 0 and result and not failures:
        absent = tuple(f"{item['what']}: {item['reason']}" for item in result.get("absent", []))
        return ("not there" if absent else "answered"), absent
    if code == 3 and failures:
        return "in part", failures
    if code in (2, 3) and not result:
        return {2: "refused", 3: "not converged"}[code], last
    return "broke down", (f"exit status {code}", *last)


def _process(call: list[str], limit: float) -> tuple[int | None, str]:
    """Exit status and standard error of a process; no status when it was ended at the limit."""
    surroundings, begun = os.environ | {"OMP_NUM_THREADS": "1"}, _processor_time()
    most = math.ceil(limit)
    child = subprocess.Popen(
        call,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env=surroundings,
        start_new_session=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (most, most)),  # noqa: PLW1509  (no threads)
        text=True,
        errors="replace",
    )
    try:
        complaint = child.communicate(timeout=WAITING * limit)[1]
    except subprocess.TimeoutExpired:
        return None, ""
    finally:
        with suppress(ProcessLookupError):
            os.killpg(child.pid, signal.SIGKILL)  # and its child processes
        child.wait()
    spent = child.returncode < 0 and _processor_time() - begun >= NEARLY * limit
    return None if spent else child.returncode, complaint


def _processor_time() -> float:
    """Seconds of processor time of all child processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _read(file: Path) -> dict[str, Any]:
    """A stored object; empty if there is none or it is incomplete."""
    try:
        return load_json(file, "stored outcome")
    except InputError:
        return {}


def _stored(file: Path, key: str) -> Draw | None:
    data = _read(file)
    if data.get("key") != key:
        return None
    return Draw(**{**data["draw"], "messages": tuple(data["draw"]["messages"])})
