"""Comparison with other runs of the same cases, on more ranks or on another release, for the report."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from weakforms.errors import InputError
from weakforms.results.io import dumps, load_json, write_atomically
from weakforms.verification.audit.same import CaseRow, Run, rows

NAME = "elsewhere.json"
SCHEMA = "weakforms.elsewhere/1"
ENVIRONMENT = ("dolfinx", "ufl", "petsc", "slepc", "python", "system", "ranks")
"""Facts of the environment that may differ between two runs."""


@dataclass(frozen=True)
class Elsewhere:
    """Another run, and the differences of its numbers from this run's numbers."""

    environment: dict[str, str]
    """Facts of its environment that differ from this run's environment."""
    rows: tuple[CaseRow, ...]


_MANY = TypeAdapter(tuple[Elsewhere, ...])


def elsewhere(own: Path, other: Path) -> Elsewhere:
    """Compare the stored solutions of two output folders of ``verify``, case by case.

    Raises:
        InputError: If one of them has no report, a stored file is damaged, or they share no case.
    """
    first, second = Run(own), Run(other)
    found = tuple(row for row in rows(first, second) if row.case in second.specs)
    if not found:
        raise InputError(f"{other}: has no case that {own} has")
    facts = {name: second.environment[name] for name in ENVIRONMENT if name in second.environment}
    return Elsewhere({k: v for k, v in facts.items() if first.environment.get(k) != v}, found)


def write_elsewhere(runs: Iterable[Elsewhere], folder: Path) -> None:
    """Store comparisons in the folder of a report.

    Raises:
        InputError: If the folder cannot be written.
    """
    data = {"schema": SCHEMA, "runs": [asdict(run) for run in runs]}
    write_atomically(Path(folder) / NAME, dumps(data))


def load_elsewhere(folder: Path) -> tuple[Elsewhere, ...]:
    """Read the comparisons in the folder of a report; none if there is no such file.

    Raises:
        InputError: If it is damaged.
    """
    path = Path(folder) / NAME
    if not path.exists():
        return ()
    data = load_json(path, "comparison with other runs")
    try:
        return _MANY.validate_python(data.get("runs"))
    except ValidationError as error:
        raise InputError(f"{path}: {error.errors()[0]['msg']}; rebuild it with report --other") from error
