"""The history of the benchmark: a line of JSON for each run, and what has become slower since.

Runs are compared by the ratio of each problem's time to the floor, its bare assemblies and factorisations in
the same run. A faster machine changes both.
"""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from weakforms.errors import InputError

KEPT = ("ratio", "ratio_spread", "run_seconds", "floor_seconds", "eigenvalues_seconds", "peak_memory_mib")
"""What a line of the history tells of each problem."""


def append(path: Path, table: dict[str, Any]) -> None:
    """Add a run to a history.

    Raises:
        InputError: If the file cannot be written.
    """
    about = {name: table[name] for name in ("ranks", "cores", "load", "machine", "versions")}
    problems = {row["name"]: {name: row[name] for name in KEPT} for row in table["problems"]}
    when = datetime.now(UTC).isoformat(timespec="seconds")
    line = {"schema": "weakforms.bench-history/1", "when": when, **about, "problems": problems}
    try:
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")
    except OSError as error:
        raise InputError(f"cannot write the history {path}: {error.strerror}") from error


def last(path: Path) -> dict[str, dict[str, float]]:
    """The problems of the last run in a history.

    Raises:
        InputError: If the file cannot be read, or is no history.
    """
    try:
        lines = path.read_text("utf-8").splitlines()
        problems = json.loads(lines[-1])["problems"]
        return {name: {key: float(row[key]) for key in KEPT[:2]} for name, row in problems.items()}
    except OSError as error:
        raise InputError(f"cannot read the history {path}: {error.strerror}") from error
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise InputError(f"{path} is no history of the benchmark: {type(error).__name__}") from error


def slower(table: dict[str, Any], before: dict[str, dict[str, float]]) -> tuple[list[str], list[str]]:
    """A sentence for each problem of both runs, and the names of those that have become slower.

    A problem has become slower if its ratio has grown by more than the ratios of the repetitions within the
    two runs differ.
    """
    lines, found = [], []
    for row in table["problems"]:
        if row["name"] not in before:
            continue
        old = before[row["name"]]
        change = row["ratio"] / old["ratio"] - 1
        noise = row["ratio_spread"] + old["ratio_spread"]
        if change > noise:
            found.append(row["name"])
        word = "slower" if change > noise else "faster" if change < -noise else "as before"
        lines.append(
            f"{row['name']}: run / floor {old['ratio']:.3g} before, {row['ratio']:.3g} now: {word} "
            f"({change:+.0%}; repetitions differ by {noise:.0%})"
        )
    return lines, found
