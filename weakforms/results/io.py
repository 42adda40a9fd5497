"""Results and curves in and out: JSON validated against the shipped schema, CSV, files that appear whole."""

from __future__ import annotations

import csv
import json
import math
import os
import tempfile
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np

from weakforms.errors import InputError
from weakforms.results.model import Result

MAX_CURVE_BYTES = 64 * 2**20
"""Size up to which a curve file is read."""


@cache
def schema() -> dict[str, Any]:
    """JSON Schema of ``weakforms.result/1``."""
    text = resources.files("weakforms.results").joinpath("result.schema.json").read_text("utf-8")
    return json.loads(text)


def validate(data: dict[str, Any]) -> None:
    """Hold a JSON object against the result schema.

    Raises:
        InputError: Naming the first place that does not fit.
    """
    validator = jsonschema.Draft202012Validator(schema())
    error = next(iter(sorted(validator.iter_errors(data), key=lambda e: list(map(str, e.path)))), None)
    if error is not None:
        place = "/".join(map(str, error.absolute_path)) or "top level"
        raise InputError(f"not a weakforms.result/1 object: at {place}: {error.message[:200]}")


def write_atomically(path: Path, text: str) -> None:
    """Write a file that appears under its name only when complete.

    Raises:
        InputError: When the place cannot be written to.
    """
    path = Path(path)
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, path)
    except OSError as error:
        if temporary is not None:
            Path(temporary).unlink(missing_ok=True)
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def require_writable(folder: Path) -> None:
    """Make sure results can be put into a folder before anything is solved.

    Raises:
        InputError: When they cannot.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"cannot write to folder {folder}: {error.strerror or error}") from error


def dumps(data: dict[str, Any]) -> str:
    """JSON text: no NaN, keys in their order, one newline at the end."""
    return json.dumps(data, indent=1, allow_nan=False, ensure_ascii=False) + "\n"


def load_json(path: Path, what: str) -> dict[str, Any]:
    """A JSON object from a file.

    Raises:
        InputError: When it is missing, too large, not UTF-8, not JSON or not an object.
    """
    try:
        data = json.loads(_text(path, what))
    except (json.JSONDecodeError, RecursionError) as error:
        raise InputError(f"{what} {path} is not JSON: {str(error).splitlines()[0]}") from error
    if not isinstance(data, dict):
        raise InputError(f"{what} {path} must hold a JSON object, not {type(data).__name__}")
    return data


def load_result(path: Path) -> Result:
    """A result from a file, validated.

    Raises:
        InputError: When it cannot be read or does not fit the schema.
    """
    data = load_json(path, "result")
    validate(data)
    return Result.from_json(data)


def branch_csv(result: Result) -> str:
    """All branches as one CSV table; the first column names the branch."""
    keys = list(dict.fromkeys(key for b in result.branches for key in b.columns))
    lines = [",".join(["branch", *keys])]
    for branch in result.branches:
        for i in range(len(branch)):
            cells = [f"{branch.columns[k][i]:.12g}" if k in branch.columns else "" for k in keys]
            lines.append(",".join([branch.name, *cells]))
    return "\n".join(lines) + "\n"


def read_curve(path: Path) -> dict[str, np.ndarray]:
    """Columns of somebody's curve: a CSV with a header row, a JSON ``{"column": [...]}``, or a result.

    Raises:
        InputError: When the file cannot be read, is no table, or holds something that is not a finite number.
    """
    path = Path(path)
    if path.suffix.lower() == ".json":
        data = load_json(path, "curve file")
        if data.get("schema") == "weakforms.result/1":
            validate(data)
            branch = Result.from_json(data).branches[0]
            return {key: np.asarray(values, float) for key, values in branch.columns.items()}
        columns = data.get("columns", data)
        if not isinstance(columns, dict):
            raise InputError(f"curve file {path}: 'columns' must be an object of lists")
    else:
        columns = _read_csv(path)
    return _numbers(path, columns)


def _text(path: Path, what: str) -> str:
    try:
        if Path(path).stat().st_size > MAX_CURVE_BYTES:
            raise InputError(f"{what} {path} is larger than {MAX_CURVE_BYTES >> 20} MiB")
        return Path(path).read_text("utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot read {what} {path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{what} {path} is not UTF-8 text (byte {error.start})") from error


def _read_csv(path: Path) -> dict[str, list[str]]:
    text = _text(path, "curve file")
    try:
        rows = [row for row in csv.reader(text.splitlines()) if row]
    except csv.Error as error:
        raise InputError(f"curve file {path} is not CSV: {error}") from error
    if len(rows) < 2:
        raise InputError(f"curve file {path} needs a header row and at least one row of numbers")
    header = [name.strip() for name in rows[0]]
    if len(set(header)) != len(header):
        raise InputError(f"curve file {path}: a column name stands twice in {header}")
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise InputError(
                f"curve file {path}, row {number}: {len(row)} cells under {len(header)} column names"
            )
    return {name: [row[j] for row in rows[1:]] for j, name in enumerate(header)}


def _numbers(path: Path, columns: dict[str, Any]) -> dict[str, np.ndarray]:
    out: dict[str, np.ndarray] = {}
    for name, values in columns.items():
        if not isinstance(values, list) or not values:
            raise InputError(f"curve file {path}: column {name!r} must be a list of numbers")
        out[str(name)] = np.array([_number(path, name, i, v) for i, v in enumerate(values, start=1)])
    if not out:
        raise InputError(f"curve file {path} holds no columns")
    if len({len(values) for values in out.values()}) > 1:
        lengths = {name: len(values) for name, values in out.items()}
        raise InputError(f"curve file {path}: columns differ in length: {lengths}")
    return out


def _number(path: Path, name: str, row: int, value: object) -> float:
    try:
        number = float(value) if not isinstance(value, bool) else math.nan
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        shown = str(value)[:40]
        raise InputError(f"curve file {path}, column {name!r}, row {row}: {shown!r} is not a number")
    return number
