"""Reading curves of other codes: CSV with a header row, JSON lists, or a result."""

from __future__ import annotations

import csv
import io
import math
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from weakforms.errors import InputError
from weakforms.results.io import BRANCH, load_json, read_text, validate

MAX_CURVE_BYTES = 64 * 2**20
"""Largest size of a curve file, in bytes."""

MAX_ROWS, MAX_COLUMNS = 1_000_000, 1000
"""Largest number of rows and columns of a table."""


@dataclass(frozen=True)
class CurveFile:
    """A curve that was read from a file, with its problem and parameters if the file is a result."""

    columns: dict[str, np.ndarray]
    """Columns of numbers; in a result, NaN where a column has no meaning, as before contact."""
    problem: str = ""
    """Problem of a result; empty for any other curve."""
    parameters: dict[str, Any] = field(default_factory=dict)


def read_curve(path: Path, branch: str = "") -> CurveFile:
    """Read a curve: a CSV with a header row, a JSON ``{"column": [...]}``, or a result.

    Args:
        path: The file; it is JSON if its suffix says so.
        branch: Branch of a result, or of a CSV with a column ``branch``; by default ``primary``, or the only
            one.

    Raises:
        InputError: If the file cannot be read, is not a table, contains something that is not a finite
            number, or has no such branch.
    """
    path = Path(path)
    if path.suffix.lower() != ".json":
        return CurveFile(_read_csv(path, branch))
    data = load_json(path, "curve file")
    if data.get("schema") != "weakforms.result/1":
        columns = data.get("columns", data)
        if not isinstance(columns, dict):
            raise InputError(f"curve file {path}: 'columns' must be an object of lists")
        return CurveFile(_numbers(path, columns))
    validate(data)
    if not data["branches"]:
        raise InputError(f"curve file {path} is a result without a branch")
    branches = {found["name"]: found["columns"] for found in data["branches"]}
    columns = branches[_chosen(path, list(branches), branch)]
    return CurveFile(_numbers(path, columns, ours=True), data["problem"], data["parameters"])


def _chosen(path: Path, names: list[str], branch: str) -> str:
    """The requested one of a file's branches."""
    if not branch and len(names) == 1:
        return names[0]
    if (branch or "primary") not in names:
        raise InputError(
            f"curve file {path} has no branch {(branch or 'primary')!r}; it has {', '.join(names)}"[:400]
        )
    return branch or "primary"


def _read_csv(path: Path, branch: str) -> dict[str, np.ndarray]:
    text = read_text(path, "curve file", MAX_CURVE_BYTES)
    try:
        rows = csv.reader(_lines(path, text))
        header = [name.strip() for name in next((row for row in rows if row), [])]
        if BRANCH not in header:
            return _columns(path, header, rows, None)
        again = csv.reader(_lines(path, text))
        place = header.index(BRANCH)
        names = [row[place].strip() for row in again if len(row) == len(header)][1:]
        chosen = _chosen(path, list(dict.fromkeys(names)), branch)
        return _columns(path, header, rows, chosen)
    except csv.Error as error:
        raise InputError(f"curve file {path} is not CSV: {error}") from error


def _lines(path: Path, text: str) -> Iterator[str]:
    """The lines of a file; a line with too many cells for a table is an error."""
    for line in io.StringIO(text):
        if line.count(",") >= MAX_COLUMNS:
            raise InputError(f"curve file {path} has more than {MAX_COLUMNS} columns")
        yield line


def _columns(path: Path, header: list[str], reader: Any, branch: str | None) -> dict[str, np.ndarray]:
    """Columns of numbers; if the table has several branches, only one branch, without its empty columns."""
    if len(set(header)) != len(header):
        raise InputError(f"curve file {path}: a column name is repeated in {header}")
    columns = {name: array("d") for name in header}
    absent: set[str] = set()
    count = 0
    for count, row in enumerate((row for row in reader if row), start=1):
        if len(row) != len(header):
            raise InputError(
                f"curve file {path}, line {reader.line_num}: "
                f"{len(row)} cells under {len(header)} column names"
            )
        if count > MAX_ROWS:
            raise InputError(f"curve file {path} has more than {MAX_ROWS} rows")
        cells = dict(zip(header, row, strict=True))
        if branch is not None:
            if cells[BRANCH].strip() != branch:
                continue
            absent = absent or {BRANCH, *(name for name, cell in cells.items() if not cell.strip())}
        for name, cell in cells.items():
            if name not in absent:
                columns[name].append(_number(path, name, count, cell, branch is not None))
            elif name != BRANCH and cell.strip():
                raise InputError(f"curve file {path}, column {name!r}, row {count}: rows before are empty")
    if not columns or not count:
        raise InputError(f"curve file {path} needs a header row and at least one row of numbers")
    return {name: np.array(column) for name, column in columns.items() if name not in absent}


def _numbers(path: Path, columns: dict[str, Any], ours: bool = False) -> dict[str, np.ndarray]:
    out: dict[str, np.ndarray] = {}
    for name, values in columns.items():
        if not isinstance(values, list) or not values:
            raise InputError(f"curve file {path}: column {name!r} must be a list of numbers")
        if len(values) > MAX_ROWS:
            raise InputError(f"curve file {path} has more than {MAX_ROWS} rows")
        out[str(name)] = np.array([_number(path, name, i, v, ours) for i, v in enumerate(values, start=1)])
    if not out:
        raise InputError(f"curve file {path} has no columns")
    if len({len(values) for values in out.values()}) > 1:
        lengths = {name: len(values) for name, values in out.items()}
        raise InputError(f"curve file {path}: columns differ in length: {lengths}")
    return out


def _number(path: Path, name: str, row: int, value: object, ours: bool = False) -> float:
    if ours and value in (None, "nan"):
        return math.nan
    try:
        number = float(value) if not isinstance(value, bool) else math.nan
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        shown = str(value)[:40]
        raise InputError(f"curve file {path}, column {name!r}, row {row}: {shown!r} is not a finite number")
    return number
