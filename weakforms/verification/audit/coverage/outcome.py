"""What a test of uncertainties leaves: its JSON, and its table on a terminal and as Markdown."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from weakforms.errors import InputError
from weakforms.results.io import load_json
from weakforms.verification.audit.coverage.judged import Judged, Statistics, statistics
from weakforms.verification.report.junit import clean
from weakforms.verification.report.wording import duration, plural

SCHEMA = "weakforms.coverage/1"

NAME = "coverage.json"
"""File in an output folder that holds both parts."""

PARTS = {"tuned": "tuned sets", "hold_out": "hold-out"}
"""Which sets of parameters, and what they are called."""

RATE, MOST = 0.95, 30.0
"""Claimed: the share of a family's numbers within ``u`` at least, and the largest overestimate."""

COLUMNS = ("problem", "kind of number", "numbers", "within u", "within 2u", "overestimate, median", "largest")


@dataclass(frozen=True)
class Missed:
    """A set of parameters at which a solve failed, so that there was nothing to judge."""

    parameters: dict[str, Any]
    reason: str


@dataclass(frozen=True)
class Outside:
    """A number whose error is beyond the bound of verdicts."""

    place: str
    parameters: dict[str, Any]
    error: float
    uncertainty: float


@dataclass
class FamilyOutcome:
    """One family of a part."""

    name: str
    solved: int
    """Sets at which both solves succeeded."""
    rows: list[Statistics] = field(default_factory=list)
    missed: list[Missed] = field(default_factory=list)
    outside: list[Outside] = field(default_factory=list)

    @property
    def count(self) -> int:
        """Numbers judged."""
        return sum(row.count for row in self.rows)

    @property
    def within(self) -> float:
        """Share of them inside the uncertainty."""
        return sum(row.count * row.within for row in self.rows) / self.count if self.count else math.nan

    @property
    def broken(self) -> list[str]:
        """Claims that do not hold."""
        if not self.count:
            return ["no number was judged"]
        found = []
        if self.outside:
            found.append(f"{plural(len(self.outside), 'number')} beyond 2u")
        if self.within < RATE:
            found.append(f"{self.within:.1%} within u, {RATE:.0%} claimed")
        large = [row.largest for row in self.rows if row.largest is not None and row.largest > MOST]
        if large:
            found.append(f"{max(large):.0f} times too wide, {MOST:.0f} claimed")
        return found


@dataclass
class Part:
    """The families over the tuned sets, or over those held out."""

    seed: int
    sets: int
    """Of each family."""
    started: str
    """ISO 8601, UTC."""
    seconds: float
    tree: str
    """Digest of the source it ran on."""
    environment: dict[str, str]
    families: list[FamilyOutcome] = field(default_factory=list)

    @property
    def count(self) -> int:
        """Numbers judged."""
        return sum(family.count for family in self.families)

    @property
    def within(self) -> float:
        """Share of them inside the uncertainty."""
        return sum(f.count * f.within for f in self.families if f.count) / self.count

    @property
    def outside(self) -> int:
        """Numbers beyond the bound of verdicts."""
        return sum(len(family.outside) for family in self.families)

    @property
    def missed(self) -> int:
        """Sets with nothing to judge."""
        return sum(len(family.missed) for family in self.families)

    @property
    def headline(self) -> str:
        """One sentence about the whole."""
        if not self.count:
            return "no numbers judged"
        share = f"{self.within:.1%} of {plural(self.count, 'number')} within the uncertainty"
        return f"{share}, {self.outside} beyond twice it"


@dataclass
class Coverage:
    """Both parts, as far as they were solved."""

    parts: dict[str, Part] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.coverage/1``."""
        return {"schema": SCHEMA, **asdict(self)}


def outcome(name: str, found: list[Judged], solved: int, missed: list[Missed]) -> FamilyOutcome:
    """A family's statistics, and what is beyond the bound."""
    beyond = [
        Outside(item.place, dict(item.parameters), item.error, item.uncertainty)
        for item in found
        if not item.bounded
    ]
    return FamilyOutcome(name, solved, statistics(found), missed, beyond)


def load_coverage(path: Path) -> Coverage:
    """Both parts from their file.

    Raises:
        InputError: When it cannot be read, or is none.
    """
    data = load_json(path, "coverage")
    if data.get("schema") != SCHEMA:
        raise InputError(f"{path}: schema is {data.get('schema')!r}, expected {SCHEMA!r}")
    try:
        found = TypeAdapter(Coverage).validate_python(data)
    except ValidationError as error:
        first = error.errors()[0]
        place = "/".join(map(str, first["loc"])) or "the object"
        raise InputError(f"{path}: {place}: {first['msg']}") from error
    unknown = next((name for name in found.parts if name not in PARTS), None)
    if unknown is not None:
        raise InputError(f"{path}: part {unknown!r}; known are {', '.join(PARTS)}")
    return found


@dataclass(frozen=True)
class Covered:
    """What a report knows of the test of uncertainties."""

    run: Coverage | None = None
    problem: str = ""

    @classmethod
    def beside(cls, folder: Path) -> Covered:
        """From a report's own folder; a file that cannot be read is a problem to be shown, no failure."""
        if not (folder / NAME).exists():
            return cls()
        try:
            return cls(load_coverage(folder / NAME))
        except InputError as error:
            return cls(None, str(error))


def cells(row: Statistics) -> tuple[str, ...]:
    """A line of the table, as :data:`COLUMNS` says."""
    wide = ("at round-off" if r is None else f"{r:.1f}" for r in (row.median, row.largest))
    return row.family, row.kind, str(row.count), f"{row.within:.1%}", f"{row.bounded:.1%}", *wide


def markdown(rows: Iterable[Statistics]) -> str:
    """Table of statistics for the documentation."""
    lines = [COLUMNS, ("---",) * len(COLUMNS), *(cells(row) for row in rows)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def print_part(part: Part, title: str, console: Console) -> None:
    """One line a family and kind of number; then what was not solved, and what is beyond the bound."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, header_style="bold")
    for i, name in enumerate(COLUMNS):
        table.add_column(name.capitalize(), justify="left" if i < 2 else "right", overflow="fold")
    for family in part.families:
        for row in family.rows:
            table.add_row(*cells(row))
    console.print(table)
    for family in part.families:
        for missed in family.missed:
            text = f"not solved: {family.name} at {missed.parameters}: {missed.reason}"
            console.print(Text(clean(text)), soft_wrap=True)
        for item in family.outside:
            text = f"beyond 2u: {family.name}, {item.place} at {item.parameters}: "
            text += f"error {item.error:.1e}, u {item.uncertainty:.1e}"
            console.print(Text(clean(text)), soft_wrap=True)
        for text in family.broken:
            console.print(Text(f"claim broken: {family.name}: {text}"), soft_wrap=True)
    console.print(Text(f"{title}: {part.headline}, {duration(part.seconds)}", "bold"))
