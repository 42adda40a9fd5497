"""What a run of the catalogue leaves: its JSON, and the table on a terminal."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import jsonschema
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from weakforms.errors import InputError
from weakforms.results.io import load_json, write_atomically
from weakforms.verification.report.junit import clean
from weakforms.verification.report.wording import duration, plural, scientific

SCHEMA = "weakforms.faults/1"

NAME = "faults.json"
"""File in an output folder that holds a run of the catalogue."""

RANDOM = "mutants.json"
"""The same for a run of random mutants."""

SHIPPED = Path(__file__).parent / "last_run.json"
"""The last run of the whole catalogue before the release, shipped with the package."""

KINDS = {
    "comparison": "a number or a count outside its bound",
    "test": "a test of the suite",
    "not judged": "a check that could not cope with the solution",
    "not solved": "a solve that did not converge",
    "stopped": "a run that broke down or did not end",
}
"""How a fault was noticed, the best way first."""

WORDS = {
    "caught": "caught",
    "survived": "SURVIVED",
    "equivalent": "no change",
    "harmless": "no harm",
    "void": "void",
}
"""What the statuses are called on a terminal."""


@dataclass(frozen=True)
class Finding:
    """The first thing that noticed a fault."""

    kind: str
    where: str
    """Id of the case, or file of the test."""
    check: str
    """Name of its verdict, or of the test."""
    in_quick: bool
    """Whether that is part of the quick profile."""
    detail: str = ""
    error: float | None = None
    bound: float | None = None
    asked: float | None = None


@dataclass(frozen=True)
class FaultOutcome:
    """One fault and what became of it."""

    name: str
    area: str
    subject: str
    description: str
    file: str
    find: str
    replace: str
    status: str
    """``caught``; ``survived``; ``equivalent`` (nothing can notice it, for the reason given); ``harmless``
    (of a random mutant: no number or statement changes, for the reason given); ``void`` (what should notice
    it does not pass without the fault)."""
    reason: str = ""
    caught_by: Finding | None = None
    searched: tuple[str, ...] = ()
    """What was run, up to what noticed it."""
    seconds: float = 0.0
    watching: int = 0
    """Of a random mutant: how many cases and tests may see its line; fewer are run where time is short."""


@dataclass(frozen=True)
class Baseline:
    """What was run without any fault."""

    expectation: str
    passed: bool
    checks: int
    seconds: float
    detail: str = ""


@dataclass
class FaultsRun:
    """A run of the catalogue, or of part of it."""

    selection: str
    started: str
    """ISO 8601, UTC."""
    seconds: float
    tree: str
    """Digest of the source it ran on."""
    catalogue: int
    """Number of faults there are."""
    environment: dict[str, str]
    baseline: list[Baseline] = field(default_factory=list)
    faults: list[FaultOutcome] = field(default_factory=list)
    random: bool = False
    """Whether nobody chose them: what fails without a mutant is then not used, and voids nothing."""

    @property
    def status(self) -> str:
        """``void`` if anything fails without a fault, ``survived`` if a fault does, else ``caught``."""
        failing = not self.random and not all(found.passed for found in self.baseline)
        if failing or any(f.status == "void" for f in self.faults):
            return "void"
        return "survived" if any(fault.status == "survived" for fault in self.faults) else "caught"

    def count(self, status: str) -> int:
        """Faults of a status."""
        return sum(fault.status == status for fault in self.faults)

    @property
    def kinds(self) -> dict[str, int]:
        """How many were caught by each of :data:`KINDS`."""
        found = [fault.caught_by.kind for fault in self.faults if fault.caught_by]
        return {kind: found.count(kind) for kind in KINDS}

    @property
    def headline(self) -> str:
        """One sentence about the whole."""
        what = "random mutant" if self.random else "seeded fault"
        text = f"{self.count('caught')} of {plural(len(self.faults), what)} caught"
        if self.random:
            kinds = self.kinds
            crashed = sum(kinds.values()) - kinds["comparison"] - kinds["test"]
            text += f" ({kinds['comparison']} by a verdict, {kinds['test']} by a test, {crashed} by a crash, "
            text += "a hang or a solve that did not converge)"
        if self.count("equivalent"):
            text += f", {self.count('equivalent')} proven to change nothing"
        if self.count("harmless"):
            text += f", {self.count('harmless')} shown to do no harm"
        if self.count("survived"):
            text += f", {self.count('survived')} SURVIVED"
        failing = sum(not found.passed for found in self.baseline)
        if failing and self.random:
            text += f"; {plural(failing, 'check')} that fail without a mutant were not used"
        elif failing:
            text += f"; void: {plural(failing, 'check')} used do not pass without a fault"
        return text + (f" (of {self.catalogue} there are)" if len(self.faults) < self.catalogue else "")

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.faults/1``."""
        return _finite({"schema": SCHEMA, "status": self.status, **asdict(self)})

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> FaultsRun:
        """Inverse of :meth:`to_json`; the object fits the schema."""
        values = {key: value for key, value in data.items() if key not in ("schema", "status")}
        values["baseline"] = [Baseline(**item) for item in data["baseline"]]
        values["faults"] = [outcome_from_json(item) for item in data["faults"]]
        return cls(**values)


def outcome_from_json(item: dict[str, Any]) -> FaultOutcome:
    """One fault's outcome from its JSON object."""
    found = item["caught_by"]
    caught = None if found is None else Finding(**found)
    return FaultOutcome(**{**item, "caught_by": caught, "searched": tuple(item["searched"])})


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


@cache
def schema() -> dict[str, Any]:
    """JSON Schema of ``faults.json``, shipped with the package."""
    text = (
        resources.files("weakforms.verification.audit.faults")
        .joinpath("faults.schema.json")
        .read_text("utf-8")
    )
    return json.loads(text)


def validate(data: dict[str, Any]) -> None:
    """Hold a JSON object against the schema.

    Raises:
        InputError: When it does not fit; names the first entry that does not.
    """
    for error in jsonschema.Draft202012Validator(schema()).iter_errors(data):
        place = "/".join(map(str, error.absolute_path)) or "the object"
        raise InputError(f"{NAME}: {place}: {error.message[:200]}")


def load_faults(path: Path) -> FaultsRun:
    """A run of the catalogue from its file, validated.

    Raises:
        InputError: When it cannot be read or does not fit the schema.
    """
    data = load_json(path, "faults")
    validate(data)
    return FaultsRun.from_json(data)


@dataclass(frozen=True)
class Seeded:
    """What a report knows of the catalogue: a run of it, or why there is none."""

    run: FaultsRun | None = None
    problem: str = ""
    random: FaultsRun | None = None
    """A run of random mutants, where there is one."""
    shipped: bool = False
    """Whether ``run`` is the one that the package brings, because the report's folder has none."""

    @classmethod
    def beside(cls, folder: Path) -> Seeded:
        """From a report's own folder, or the run that the package brings where the folder has none.

        A file in the folder that cannot be read is a problem to be shown, no failure.
        """
        found: dict[str, FaultsRun | None] = {}
        problems = []
        for name in (NAME, RANDOM):
            try:
                found[name] = load_faults(folder / name) if (folder / name).exists() else None
            except InputError as error:
                problems.append(str(error))
        shipped = NAME in found and found[NAME] is None
        run = load_faults(SHIPPED) if shipped else found.get(NAME)
        return cls(run, "; ".join(problems), found.get(RANDOM), shipped)


def keep_beside(source: Path | None, folder: Path, name: str = NAME) -> None:
    """Put a run of the catalogue, or what has another name, into a report's folder, where there is one.

    Raises:
        InputError: When it cannot be written.
    """
    if source is None or not source.is_file():
        return
    write_atomically(folder / name, source.read_text("utf-8", "replace"))


def print_faults(run: FaultsRun, console: Console) -> None:
    """One row a fault: what caught it, and by how much; the survivors in full; last the sum."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, header_style="bold")
    for title in ("Fault", "Area", "Outcome", "Caught by", "Error / bound"):
        table.add_column(title, overflow="fold")
    for fault in run.faults:
        table.add_row(*map(_cell(fault), ("name", "area", "status", "check", "numbers")))
    console.print(table)
    for fault in run.faults if run.random else ():
        if fault.status == "survived":
            met = f"{len(fault.searched)} of {fault.watching} cases and tests that may see it"
            console.print(Text(clean(f"survived {met}: {fault.file}, {fault.description}"), "bold red"))
    for found in run.baseline:
        if not found.passed:
            console.print(Text(f"fails without a fault: {clean(found.expectation)}: {clean(found.detail)}"))
    console.print(Text(f"{run.headline}, {duration(run.seconds)}", "bold"))


def _cell(fault: FaultOutcome) -> Callable[[str], Text]:
    found = fault.caught_by

    def text(column: str) -> Text:
        if column == "status":
            style = {"caught": "green", "survived": "bold red", "void": "bold yellow"}.get(fault.status, "")
            return Text(WORDS[fault.status], style)
        if column == "check":
            if found is None:
                return Text(clean(fault.reason) or "nothing")
            kind = "" if found.kind in ("comparison", "test") else f" ({found.kind})"
            label = found.check if found.kind == "test" else f"{found.where}: {found.check}"
            return Text(clean(label) + kind + ("" if found.in_quick or found.kind == "test" else " (full)"))
        if column == "numbers":
            return Text(numbers(found))
        return Text(clean(getattr(fault, column)))

    return text


def numbers(found: Finding | None) -> str:
    """``error / bound`` of what noticed a fault; empty where it has none."""
    if found is None or found.bound is None:
        return ""
    return f"{scientific(found.error)} / {scientific(found.bound)}"
