"""The outcome of an audit: its JSON, and its table for a terminal."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
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
from weakforms.verification.report.junit import clean
from weakforms.verification.report.wording import duration, plural

SCHEMA = "weakforms.audit/1"

NAME = "audit.json"
"""File in an output folder that holds an audit."""

STATUSES = {
    "answered": "everything was solved for",
    "not there": "everything was solved for, and a part of what was asked for is shown not to be there",
    "in part": "a result that lists failures",
    "refused": "refused with a message while it was solved",
    "not converged": "no result: a solve did not converge",
    "broke down": "an internal error, or a process that ended otherwise",
    "too slow": "ended at the limit of time",
}
"""Outcomes of a set of parameters, the best first."""

ANSWERS = ("answered", "not there")
"""Those that are answers in whole."""


@dataclass(frozen=True)
class Draw:
    """One set of parameters and its outcome."""

    problem: str
    number: int
    """Number of the set within its problem, from 1."""
    parameters: dict[str, Any]
    numerics: dict[str, Any]
    status: str
    messages: tuple[str, ...] = ()
    """Messages of the solve: the listed failures, or the last lines of standard error."""
    seconds: float = 0.0
    """Processor time."""

    @property
    def command(self) -> str:
        """A command that repeats the solve."""
        return shlex.join(["weakforms", *words(self.problem, self.parameters, self.numerics)])


def words(problem: str, parameters: Mapping[str, Any], numerics: Mapping[str, Any]) -> list[str]:
    """Arguments of ``weakforms`` that solve a problem at a set of parameters."""
    found = ["solve", problem]
    for option, values in (("--set", parameters), ("--mesh", numerics)):
        for name, value in values.items():
            found += [option, f"{name}={str(value).lower() if isinstance(value, bool) else value}"]
    return found


@dataclass(frozen=True)
class Row:
    """A problem's line of the table."""

    problem: str
    counts: dict[str, int]
    """Sets by status."""

    @property
    def total(self) -> int:
        """Number of sets."""
        return sum(self.counts.values())

    @property
    def share(self) -> float:
        """Of sets answered in whole."""
        return sum(self.counts[status] for status in ANSWERS) / self.total


@dataclass
class AuditRun:
    """An audit of some problems."""

    seed: int
    count: int
    """Number of sets for each problem."""
    limit: float
    """Limit of a solve in seconds of processor time."""
    started: str
    """ISO 8601, UTC."""
    seconds: float
    tree: str
    """Digest of the source code."""
    environment: dict[str, str]
    contradictions: dict[str, dict[str, int]] = field(default_factory=dict)
    """For each problem, the number of refused draws for each message; these were drawn again."""
    draws: list[Draw] = field(default_factory=list)

    @property
    def rows(self) -> list[Row]:
        """The table, problems in the order in which they were solved."""
        names = dict.fromkeys(draw.problem for draw in self.draws)
        return [row(name, (draw for draw in self.draws if draw.problem == name)) for name in names]

    @property
    def missed(self) -> list[Draw]:
        """Sets that were not answered in whole."""
        return [draw for draw in self.draws if draw.status not in ANSWERS]

    @property
    def headline(self) -> str:
        """One sentence about the whole audit."""
        good, total = len(self.draws) - len(self.missed), len(self.draws)
        share = f" ({good / total:.1%})" if total else ""
        bare = sum(draw.status == "not there" for draw in self.draws)
        without = f", {bare} of them by what is not there" if bare else ""
        return f"{good} of {plural(total, 'set')} of parameters answered{share}{without}, seed {self.seed}"

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.audit/1``."""
        draws = [{**asdict(draw), "command": draw.command} for draw in self.draws]
        return {"schema": SCHEMA, "headline": self.headline, **asdict(self), "draws": draws}


def row(problem: str, draws: Iterable[Draw]) -> Row:
    """The line of one problem."""
    found = [draw.status for draw in draws]
    return Row(problem, {status: found.count(status) for status in STATUSES})


def load_audit(path: Path) -> AuditRun:
    """Read an audit from its file.

    Raises:
        InputError: If the file cannot be read, or is not an audit.
    """
    data = load_json(path, "audit")
    if data.get("schema") != SCHEMA:
        raise InputError(f"{path}: schema is {data.get('schema')!r}, expected {SCHEMA!r}")
    try:
        run = TypeAdapter(AuditRun).validate_python(data)
    except ValidationError as error:
        first = error.errors()[0]
        place = "/".join(map(str, first["loc"])) or "the object"
        raise InputError(f"{path}: {place}: {first['msg']}") from error
    unknown = next((draw.status for draw in run.draws if draw.status not in STATUSES), None)
    if unknown is not None:
        raise InputError(f"{path}: status {unknown!r}; known are {', '.join(STATUSES)}")
    return run


@dataclass(frozen=True)
class Audited:
    """The audit of a report, or the reason why there is none."""

    run: AuditRun | None = None
    problem: str = ""

    @classmethod
    def beside(cls, folder: Path) -> Audited:
        """Read the audit in a report's folder; if the file cannot be read, the report shows the reason."""
        if not (folder / NAME).exists():
            return cls()
        try:
            return cls(load_audit(folder / NAME))
        except InputError as error:
            return cls(None, str(error))


def print_audit(run: AuditRun, console: Console) -> None:
    """Print one line for each problem, then every set that was not answered, with its message and command."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, header_style="bold")
    table.add_column("Problem", overflow="fold")
    met = [status for status in STATUSES if any(draw.status == status for draw in run.draws)]
    for title in ("Sets", *(status.capitalize() for status in met), "Share"):
        table.add_column(title, justify="right", overflow="fold")
    for line in run.rows:
        counts = [str(line.counts[status] or "") for status in met]
        table.add_row(line.problem, str(line.total), *counts, f"{line.share:.0%}")
    console.print(table)
    for draw in run.missed:
        console.print(Text(f"{draw.status}: {clean(draw.command)}"), soft_wrap=True)
        for message in draw.messages:
            console.print(Text(f"    {clean(message)}"), soft_wrap=True)
    for problem, messages in run.contradictions.items():
        count = sum(messages.values())
        console.print(Text(f"{problem}: {plural(count, 'contradictory draw')} drawn again"), soft_wrap=True)
    console.print(Text(f"{run.headline}, {duration(run.seconds)}", "bold"))
