"""Tables computed again: what notices a change of the reference solvers that no test or case runs.

The expectation ``table NAME`` computes one table in the copy, as ``python -m reference_data.solvers NAME``
does, and compares it with the committed one within the uncertainties that this one states. The command itself
ends with a message if its two methods disagree.
"""

from __future__ import annotations

import importlib
import inspect
import math
import os
import resource
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import zip_longest
from pathlib import Path
from types import CodeType
from typing import Any

import numpy as np

from weakforms.verification.audit.faults.children import WAITING
from weakforms.verification.cases.references import ROOT, folder_of

SOLVERS = "reference_data/solvers/"
"""Folder of the files whose changes are looked for in this way."""

LONGEST = 60
"""Seconds of processor time after which the computation of a table is given up; it then shows nothing."""

MOST = 12
"""Number of tables computed for one change."""

TEXTS = ("title", "source", "type", "method", "grid", "tolerance", "abscissa", "notes", "parameters")
"""What a table says of itself that must not change either."""

SOLVED = 1e-6
"""Largest difference of two numbers in such texts, relative to those above one; some are solutions."""

WIDER = 3.0
"""Factor by which an uncertainty may differ from the committed one. It contains differences of rounding,
which other libraries change by less; a change of what is added to them is much larger."""

DISAGREE = "combined uncertainty"
"""Part of the message by which a table is refused because its two methods disagree."""


@dataclass(frozen=True)
class Source:
    """Where a table comes from."""

    name: str
    file: str
    """File of the function that computes it, relative to the tree."""
    first: int
    last: int
    """Lines of this function."""
    size: int
    """Of the committed table in bytes; a small one is computed fast."""


@cache
def sources() -> tuple[Source, ...]:
    """Every table, the smallest first.

    The registry is looked up by its name, because no module here imports the reference solvers.
    """
    registry = importlib.import_module("reference_data.solvers.registry")
    found = []
    for name, (group, builder) in registry.tables().items():
        code = inspect.unwrap(getattr(builder, "func", builder)).__code__
        file = Path(code.co_filename).resolve().relative_to(ROOT).as_posix()
        size = (ROOT / "reference_data" / folder_of(group) / f"{name}.csv").stat().st_size
        found.append(Source(name, file, code.co_firstlineno, _last_line(code), size))
    return tuple(sorted(found, key=lambda source: (source.size, source.name)))


def _last_line(code: CodeType) -> int:
    inner = (_last_line(constant) for constant in code.co_consts if isinstance(constant, CodeType))
    return max([line for *_, line in code.co_lines() if line is not None] + [*inner])


def watching(
    file: str, line: int, reach: Mapping[str, int], known: Iterable[Source] | None = None
) -> list[str]:
    """Expectations for a changed line: small tables of every function that may run it, the nearest first.

    Args:
        file: The changed file, relative to the tree.
        line: Number of its changed line.
        reach: Files that import it, with the length of the shortest way.
        known: The tables, the smallest first; by default all.
    """
    if not file.startswith(SOLVERS):
        return []
    by_function: dict[tuple[int, str, int], list[str]] = {}
    for source in sources() if known is None else known:
        if source.file in reach:
            inside = source.file == file and source.first <= line <= source.last
            key = (-1 if inside else reach[source.file], source.file, source.first)
            by_function.setdefault(key, []).append(f"table {source.name}")
    in_turn = zip_longest(*(by_function[key] for key in sorted(by_function)))
    return [text for row in in_turn for text in row if text is not None][:MOST]


def run_table(name: str, folder: Path, root: Path | None = None) -> dict[str, Any]:
    """Compute a table and compare it with the committed one; no verdict if it takes too long.

    Args:
        name: The table.
        folder: Where to write it.
        root: The tree; by default the current folder.
    """
    root, folder = root or Path.cwd(), folder.resolve()
    call = [sys.executable, "-m", "reference_data.solvers", name, "--out", str(folder)]
    surroundings = os.environ | {"PYTHONPATH": str(root)}
    try:
        done = subprocess.run(
            call,
            cwd=root,
            env=surroundings,
            capture_output=True,
            text=True,
            timeout=WAITING * LONGEST,
            check=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST)),
        )
    except subprocess.TimeoutExpired:
        return {"status": "passed", "verdicts": [], "errors": []}
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return {"status": "passed", "verdicts": [], "errors": []}
    said = " ".join(done.stderr.split()[-40:])
    if done.returncode in (2, 3):
        judged = done.returncode == 2 or DISAGREE in said
        verdicts = [_verdict("the table", False, said if judged else f"not solved: {said}")]
    elif done.returncode:
        return {"status": "failed", "verdicts": [], "errors": [said or f"exit status {done.returncode}"]}
    else:
        (new,) = folder.glob(f"*/{name}.csv")
        verdicts = compared(new, root / "reference_data" / new.parent.name / f"{name}.csv")
    good = all(verdict["passed"] for verdict in verdicts)
    return {"status": "passed" if good else "failed", "verdicts": verdicts, "errors": []}


def _alike(ours: Any, theirs: Any) -> bool:
    """Whether two entries of a table say the same; numbers in them may be solutions, with round-off."""
    if isinstance(ours, dict) and isinstance(theirs, dict):
        return ours.keys() == theirs.keys() and all(_alike(ours[key], theirs[key]) for key in ours)
    if isinstance(ours, float) and isinstance(theirs, float):
        return math.isclose(ours, theirs, rel_tol=SOLVED, abs_tol=SOLVED)
    return bool(ours == theirs)


def compared(new: Path, committed: Path) -> list[dict[str, Any]]:
    """One verdict for each column: equal within the stated uncertainty and the last digit of the table.

    Texts of the table that changed are one failing verdict, because a table must not name another method. So
    are uncertainties of another size (:data:`WIDER`): a wide one would hide a wrong number.
    """
    ours, theirs = _columns(new), _columns(committed)
    said, known = (tomllib.loads(path.with_suffix(".toml").read_text("utf-8")) for path in (new, committed))
    about, stated = known["columns"], said["columns"]
    others = [key for key in TEXTS if not _alike(said.get(key), known.get(key))]
    if others:
        return [_verdict("the table", False, f"it says something else of its {', '.join(others)}")]
    if list(ours) != list(theirs) or {len(v) for v in ours.values()} != {len(v) for v in theirs.values()}:
        return [_verdict("the table", False, "other columns, or another number of rows")]
    out = []
    for column, values in theirs.items():
        new_size, size = stated[column]["uncertainty"], about[column]["uncertainty"]
        if not size / WIDER <= new_size <= size * WIDER:
            detail = f"uncertainty of another size than the committed {size:.1e}"
            out.append(_verdict(column, False, detail, new_size, size))
        error = float(np.abs(ours[column] - values).max(initial=0.0))
        bound = about[column]["uncertainty"] + 1e-11 * float(np.abs(values).max(initial=0.0))
        out.append(_verdict(column, error <= bound, "", error, bound))
    return out


def _columns(path: Path) -> dict[str, np.ndarray]:
    head, *rows = path.read_text("utf-8").splitlines()
    numbers = np.array([[float(x) for x in row.split(",")] for row in rows])
    return dict(zip(head.split(","), numbers.T, strict=True))


def _verdict(
    check: str, passed: bool, detail: str, error: float | None = None, bound: float | None = None
) -> dict[str, Any]:
    given = {"check": check, "kind": "table", "passed": passed, "error": error, "bound": bound}
    return given | {"asked": None, "detail": detail[:300], "where": ""}
