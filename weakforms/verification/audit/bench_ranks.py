"""Time of large surfaces by their size and by the number of ranks: what ``bench --surface`` measured.

A file has a line of JSON for each run. Strong scaling compares ranks on one mesh. Weak scaling gives each
rank as many unknowns; a direct solver's work grows faster than they do.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from weakforms.errors import InputError

NAME = "scaling.jsonl"
"""File in the folder of a report that holds such runs."""

SHIPPED = Path(__file__).parent / NAME
"""Runs before the release, which the package brings."""

STAGES = {"states_s": "three states", "inertia_s": "inertia", "lowest_s": "lowest eigenvalues"}
"""What is timed, and what it is called."""

SMALLEST = 4e4
"""Unknowns below which a run is too short to tell how ranks share it."""

AS_MANY = 0.1
"""Largest relative difference of unknowns on each rank that counts as equal."""


@dataclass(frozen=True)
class Row:
    """One mesh."""

    mesh: str
    unknowns: int
    states_s: float
    inertia_s: float
    lowest_s: float
    peak_mib: float

    @property
    def seconds(self) -> float:
        """Of all stages."""
        return self.states_s + self.inertia_s + self.lowest_s


@dataclass(frozen=True)
class Refinement:
    """One run: meshes of one surface on some ranks."""

    title: str
    ranks: int
    when: str
    machine: dict[str, Any]
    rows: tuple[Row, ...]
    load: float = 0.0
    """Load average of the machine at the end."""


@dataclass(frozen=True)
class Scaling:
    """One mesh on several ranks, and the mesh on one rank that it is compared with."""

    ranks: int
    one: Row
    row: Row

    @property
    def times(self) -> dict[str, float]:
        """Time on one rank over that on several, by stage and of all."""
        ratios = {stage: getattr(self.one, stage) / getattr(self.row, stage) for stage in STAGES}
        return ratios | {"seconds": self.one.seconds / self.row.seconds}


@dataclass(frozen=True)
class Scaled:
    """What a report knows of time and ranks."""

    runs: tuple[Refinement, ...] = ()
    problem: str = ""
    shipped: bool = False

    @classmethod
    def beside(cls, folder: Path) -> Scaled:
        """From a report's own folder, or what the package brings; a damaged file is a problem to be shown."""
        path = folder / NAME
        try:
            return cls(load(path)) if path.exists() else cls(load(SHIPPED), shipped=True)
        except InputError as error:
            return cls(problem=str(error))

    @property
    def titles(self) -> tuple[str, ...]:
        """The surfaces."""
        return tuple(dict.fromkeys(run.title for run in self.runs))

    @property
    def largest(self) -> int:
        """Unknowns of the largest mesh."""
        return max((row.unknowns for run in self.runs for row in run.rows), default=0)

    @property
    def ranks(self) -> list[int]:
        """Numbers of ranks."""
        return sorted({run.ranks for run in self.runs})

    def of(self, title: str) -> list[Refinement]:
        """The last run of a surface on each number of ranks."""
        last = {run.ranks: run for run in self.runs if run.title == title}
        return [last[ranks] for ranks in sorted(last)]

    def strong(self, title: str) -> list[Scaling]:
        """Meshes that were solved on one rank and on several."""
        return list(_pairs(self.of(title), lambda one, row, _: one.unknowns == row.unknowns))

    def weak(self, title: str) -> list[Scaling]:
        """Meshes on several ranks, and those on one rank with as many unknowns as each of the ranks has."""

        def alike(one: Row, row: Row, ranks: int) -> bool:
            return abs(row.unknowns / (ranks * one.unknowns) - 1) < AS_MANY

        return list(_pairs(self.of(title), alike))


def _pairs(runs: list[Refinement], belong: Callable[[Row, Row, int], bool]) -> Iterator[Scaling]:
    """Meshes on several ranks with those on one rank that belong to them."""
    ones = [run for run in runs if run.ranks == 1]
    for run in runs:
        for row in run.rows if run.ranks > 1 else ():
            for one in (one for first in ones for one in first.rows):
                if one.unknowns >= SMALLEST and belong(one, row, run.ranks):
                    yield Scaling(run.ranks, one, row)


def append(path: Path, table: dict[str, Any]) -> None:
    """Add a run of ``bench --surface`` to a file.

    Raises:
        InputError: If the file cannot be written.
    """
    when = datetime.now(UTC).isoformat(timespec="seconds")
    line = {"schema": "weakforms.bench-surface/1", "when": when, **table}
    try:
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from error


def load(path: Path) -> tuple[Refinement, ...]:
    """The runs of a file.

    Raises:
        InputError: If it cannot be read, or a line is no such run.
    """
    try:
        lines = [json.loads(line) for line in path.read_text("utf-8").splitlines() if line.strip()]
        return _MANY.validate_python(lines)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    except ValidationError as error:
        first = error.errors()[0]
        raise InputError(f"{path}: {'.'.join(map(str, first['loc']))}: {first['msg']}") from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: a line is no JSON: {error}") from error


_MANY = TypeAdapter(tuple[Refinement, ...])
