"""Reading of reference tables, with a check of their checksums."""

from __future__ import annotations

import hashlib
import math
import tomllib
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from weakforms.errors import InputError
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging.numbers import Number

ROOT = Path(__file__).resolve().parents[3]
"""The folder that contains ``weakforms``, ``cases`` and ``reference_data``."""

KINDS = ("exact", "independent", "printed", "other-code")


@dataclass(frozen=True)
class Reference:
    """A table of reference numbers with their uncertainties."""

    name: str
    kind: str
    source: str
    method: str
    abscissa: str | None
    columns: dict[str, np.ndarray]
    uncertainty: dict[str, float]
    parameters: dict[str, Any]
    meridian: float | None = None
    """``Theta`` of all rows, if they belong to one meridian of a table over a surface."""

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def number(self, name: str) -> Number:
        """A column with its uncertainty."""
        return Number(self.columns[name], self.uncertainty[name])

    @property
    def ordinates(self) -> list[str]:
        """Columns other than the abscissa."""
        return [name for name in self.columns if name != self.abscissa]


def part(name: str, root: Path = ROOT) -> Path:
    """A folder of the tree; in an installed package it has another name inside the package."""
    inside = Path(__file__).resolve().parents[2] / f"_{name}"
    return inside if root == ROOT and inside.is_dir() else root / name


def folder_of(paper: int | str) -> str:
    """Name of the folder of a paper's cases and tables; a group has its own name."""
    return f"paper{paper}" if isinstance(paper, int) else paper


@cache
def load(paper: int | str, name: str, root: Path = ROOT) -> Reference:
    """Read the table ``reference_data/paperN/NAME``; ``NAME@DEGREES`` is one meridian of a surface.

    Raises:
        InputError: If it is missing, incomplete, altered (by its checksum) or not a table.
    """
    whole, separator, degrees = name.partition("@")
    if separator:
        return _meridian(load(paper, whole, root), name, degrees)
    path = part("reference_data", root) / folder_of(paper) / f"{name}.csv"
    about, raw = _bytes(path.with_suffix(".toml")), _bytes(path)
    facts = _facts(path.with_suffix(".toml").name, about)
    if checksum(raw, about) != facts.get("sha256"):
        raise InputError(
            f"reference table {path}, or its description {name}.toml, is truncated or altered: the checksum "
            "there is another one; restore both, or regenerate them: "
            f"{facts.get('regenerate', 'python -m reference_data.solvers')}"
        )
    columns = _columns(path.name, raw)
    kind, abscissa = facts.get("type"), facts.get("abscissa")
    if kind not in KINDS:
        raise InputError(f"reference table {name}.toml: type = {kind!r}; allowed are {', '.join(KINDS)}")
    if abscissa is not None and abscissa not in columns:
        raise InputError(f"reference table {name}: abscissa {abscissa!r} is not one of {', '.join(columns)}")
    if not isinstance(facts.get("parameters", {}), dict):
        raise InputError(f"reference table {name}.toml: parameters must be a table of names and values")
    return Reference(
        name=name,
        kind=kind,
        source=str(facts.get("source", "")),
        method=str(facts.get("method", "")),
        abscissa=abscissa,
        columns=columns,
        uncertainty={column: _uncertainty(name, facts, column) for column in columns},
        parameters=dict(facts.get("parameters", {})),
    )


def _meridian(table: Reference, name: str, degrees: str) -> Reference:
    """The rows of a table at one ``Theta``, without that column."""
    try:
        theta = math.radians(float(degrees))
    except ValueError:
        raise InputError(f"reference table {name}: {degrees!r} is not a number of degrees") from None
    if "Theta" not in table.columns:
        raise InputError(f"reference table {table.name} has no column Theta, and thus no {name}")
    rows = np.isclose(table.columns["Theta"], theta, rtol=0, atol=1e-9)
    if not rows.any():
        raise InputError(f"reference table {table.name} has no rows at Theta = {theta:g}")
    columns = {k: values[rows] for k, values in table.columns.items() if k != "Theta"}
    return replace(table, name=name, columns=columns, meridian=theta)


def _uncertainty(name: str, facts: dict[str, Any], column: str) -> float:
    try:
        value = facts["columns"][column]["uncertainty"]
    except (KeyError, TypeError):
        value = None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
        raise InputError(
            f"reference table {name}.toml: uncertainty of {column} = {value!r}; must be a number from 0"
        )
    return float(value)


def load_curve(paper: int | str, name: str, of: Spec | None = None) -> Reference:
    """Read a table whose abscissa rises, or falls, from row to row, for a solution if it is given.

    Raises:
        InputError: As :func:`load`, and if it is not such a table, or has other parameters than the solution.
    """
    table = load(paper, name)
    steps = np.diff(table.columns[table.abscissa]) if table.abscissa else np.zeros(1)
    if not (np.all(steps > 0) or np.all(steps < 0)):
        raise InputError(
            f"reference table {name} is not a curve: its abscissa must rise, or fall, from row to row"
        )
    for parameter, value in table.parameters.items():
        given = None if of is None else dict(of.parameters).get(parameter)
        # A solution may have several values that are solved for together.
        if given is not None and given != value and not (isinstance(given, tuple) and value in given):
            raise InputError(
                f"table {name} is for {parameter} = {value}, the case compares {parameter} = {given} with it"
            )
    return table


def checksum(numbers: bytes, about: bytes) -> str:
    """SHA-256 of a table's CSV followed by its TOML, of which the line with the checksum is left out."""
    lines = about.splitlines(keepends=True)
    return hashlib.sha256(numbers + b"".join(x for x in lines if not x.startswith(b"sha256 = "))).hexdigest()


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"reference table {path.name}: {error.strerror}") from error


def _facts(name: str, raw: bytes) -> dict[str, Any]:
    try:
        return tomllib.loads(raw.decode("utf-8"))
    except (ValueError, RecursionError) as error:  # not TOML, not UTF-8, nested without end
        raise InputError(f"reference table {name} is not TOML: {error}") from error


def _columns(name: str, raw: bytes) -> dict[str, np.ndarray]:
    try:
        lines = raw.decode("ascii").splitlines()
        header = lines[0].split(",") if lines else []
        rows = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    except ValueError as error:  # ragged rows and non-ASCII text raise ValueErrors too
        raise InputError(f"reference table {name}: {error}") from error
    if rows.ndim != 2 or rows.shape[1] != len(set(header)) or not np.all(np.isfinite(rows)):
        raise InputError(
            f"reference table {name}: it must have rows of finite numbers under the header {header}"
        )
    return dict(zip(header, rows.T, strict=True))
