"""Results and curves in and out: JSON validated against the shipped schema, CSV, files that appear whole."""

from __future__ import annotations

import csv
import io
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
    try:
        error = min(validator.iter_errors(data), key=lambda e: list(map(str, e.path)), default=None)
    except RecursionError:
        raise InputError("not a weakforms.result/1 object: nested too deeply") from None
    if error is not None:
        place = "/".join(map(str, error.absolute_path)) or "top level"
        raise InputError(f"not a weakforms.result/1 object: at {place}: {error.message[:200]}")


def write_atomically(path: Path, text: str) -> None:
    """Write a file that appears under its name only when complete.

    A link is followed; a device or pipe is written to, never replaced.

    Raises:
        InputError: When the place cannot be written to.
    """
    path = Path(path)
    temporary = None
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            path.write_text(text, "utf-8")
            return
        path = Path(os.path.realpath(path))
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        if temporary is not None:
            Path(temporary).unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def require_writable(folder: Path, name: str = "") -> None:
    """Make sure results can be put into a folder, and under a name, before anything is solved.

    Raises:
        InputError: When they cannot.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder, prefix=f".{name}."):
            pass
    except OSError as error:
        place = f"{folder / name}" if name else f"to folder {folder}"
        raise InputError(f"cannot write {place}: {error.strerror or error}") from error


def require_place_for(path: Path) -> None:
    """Make sure a file can be written before anything is solved.

    Raises:
        InputError: When it cannot, or when the path is a folder.
    """
    if os.path.isdir(path):
        raise InputError(f"cannot write {path}: it is a folder, a file name is wanted")
    if not os.path.exists(path) or os.path.isfile(path):  # Path.exists raises for a name that is too long
        require_writable(path.parent, path.name)


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
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is a ValueError
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
            if not data["branches"]:
                raise InputError(f"curve file {path} is a result without a branch")
            data = data["branches"][0]
        columns = data.get("columns", data)
        if not isinstance(columns, dict):
            raise InputError(f"curve file {path}: 'columns' must be an object of lists")
    else:
        columns = _read_csv(path)
    return _numbers(path, columns)


def _text(path: Path, what: str) -> str:
    try:
        with Path(path).open("rb") as stream:
            raw = stream.read(MAX_CURVE_BYTES + 1)  # a pipe or device does not tell its size
    except OSError as error:
        raise InputError(f"cannot read {what} {path}: {error.strerror or error}") from error
    if len(raw) > MAX_CURVE_BYTES:
        raise InputError(f"{what} {path} is larger than {MAX_CURVE_BYTES >> 20} MiB")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{what} {path} is not UTF-8 text (byte {error.start})") from error


def _read_csv(path: Path) -> dict[str, list[str]]:
    text = _text(path, "curve file")
    try:
        reader = csv.reader(io.StringIO(text))
        rows = [(reader.line_num, row) for row in reader if row]
    except csv.Error as error:
        raise InputError(f"curve file {path} is not CSV: {error}") from error
    if len(rows) < 2:
        raise InputError(f"curve file {path} needs a header row and at least one row of numbers")
    header = [name.strip() for name in rows[0][1]]
    if len(set(header)) != len(header):
        raise InputError(f"curve file {path}: a column name stands twice in {header}")
    for line, row in rows[1:]:
        if len(row) != len(header):
            raise InputError(
                f"curve file {path}, line {line}: {len(row)} cells under {len(header)} column names"
            )
    return {name: [row[j] for _, row in rows[1:]] for j, name in enumerate(header)}


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
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        shown = str(value)[:40]
        raise InputError(f"curve file {path}, column {name!r}, row {row}: {shown!r} is not a finite number")
    return number
