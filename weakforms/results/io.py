"""Results and curves in and out: JSON validated against the shipped schema, CSV, files that appear whole."""

from __future__ import annotations

import fcntl
import json
import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib import resources
from itertools import islice
from pathlib import Path
from typing import Any

import jsonschema

from weakforms.errors import InputError
from weakforms.results.model import Result

MAX_JSON_BYTES = 32 * 2**20
"""Size up to which JSON is read, which takes up to thirty times that of memory; but for ..."""

MAX_REPORT_BYTES = 256 * 2**20
"""... a report of our own."""

BRANCH = "branch"
"""Column of names, not of numbers, in the table that :func:`branch_csv` writes."""


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
        error = first_error(validator, data)
    except RecursionError:
        raise InputError("not a weakforms.result/1 object: nested too deeply") from None
    if error is not None:
        place = "/".join(map(str, error.absolute_path)) or "top level"
        raise InputError(f"not a weakforms.result/1 object: at {place}: {error.message[:200]}")
    tables = [*data["branches"], *(field for state in data["states"] for field in state["fields"])]
    for table in tables:
        lengths = {name: len(values) for name, values in table["columns"].items()}
        if len(set(lengths.values())) > 1:
            raise InputError(
                f"not a weakforms.result/1 object: columns differ in length: {str(lengths)[:200]}"
            )


def first_error(validator: jsonschema.Validator, data: Any) -> jsonschema.ValidationError | None:
    """What does not fit a schema, of the first few errors the one that stands first; ``None`` if all does."""
    return min(islice(validator.iter_errors(data), 100), key=lambda e: list(map(str, e.path)), default=None)


def write_atomically(path: Path, text: str, follow: bool = True) -> None:
    """Write a file that appears under its name only when complete.

    A link is followed; a device or pipe is written to, never replaced.

    Args:
        path: The file; folders above it are made.
        text: What it holds; what UTF-8 has no code for becomes ``?``.
        follow: Whether a link is followed; otherwise, in a folder of somebody else's, it is replaced.

    Raises:
        InputError: When the place cannot be written to.
    """
    path = Path(path)
    temporary = None
    try:
        if follow and os.path.exists(path) and not os.path.isfile(path):
            path.write_text(text, "utf-8", "replace")
            return
        path = Path(os.path.realpath(path)) if follow else path
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with os.fdopen(handle, "w", encoding="utf-8", errors="replace", newline="\n") as stream:
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


@contextmanager
def sole_use(folder: Path) -> Iterator[None]:
    """Keep a folder to oneself while results are put into it; what a killed run left half-written goes.

    The lock is the system's, on the folder itself: it ends with the process, and leaves no file. Where a
    file system has no locks, nothing is kept from anybody.

    Raises:
        InputError: When another process has it.
    """
    require_writable(folder)
    handle = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(
                f"another run is writing to folder {folder}; wait for its end, or name another folder"
            ) from None
        except OSError:
            pass
        else:
            for path in folder.glob("*/.*"):
                if _HALF.fullmatch(path.name) and path.is_file():
                    path.unlink(missing_ok=True)
        yield
    finally:
        os.close(handle)


_HALF = re.compile(r"\..+\.(json|html|xml|vtu|svg)\.([a-z0-9_]{8}|[0-9]+\.part)")
"""Names that files have while they are written."""


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


def load_json(path: Path, what: str, limit: int = MAX_JSON_BYTES) -> dict[str, Any]:
    """A JSON object from a file of up to ``limit`` bytes.

    Raises:
        InputError: When it is missing, too large, not UTF-8, not JSON or not an object.
    """
    try:
        data = json.loads(read_text(path, what, limit))
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is a ValueError
        raise InputError(f"{what} {path}: not JSON: {str(error).splitlines()[0]}") from error
    if not isinstance(data, dict):
        raise InputError(f"{what} {path}: must hold a JSON object, not {type(data).__name__}")
    return data


def load_result(path: Path) -> Result:
    """A result from a file, validated.

    Raises:
        InputError: When it cannot be read or does not fit the schema.
    """
    data = load_json(path, "result")
    validate(data)
    try:
        return Result.from_json(data)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"result {path}: {error}") from error


def branch_csv(result: Result) -> str:
    """All branches as one CSV table; the first column names the branch."""
    keys = list(dict.fromkeys(key for b in result.branches for key in b.columns))
    lines = [",".join([BRANCH, *keys])]
    for branch in result.branches:
        for i in range(len(branch)):
            cells = [f"{branch.columns[k][i]:.12g}" if k in branch.columns else "" for k in keys]
            lines.append(",".join([branch.name, *cells]))
    return "\n".join(lines) + "\n"


def read_text(path: Path, what: str, limit: int) -> str:
    """UTF-8 text from a file of up to ``limit`` bytes.

    Raises:
        InputError: When it is missing, too large or not UTF-8.
    """
    try:
        with Path(path).open("rb") as stream:
            raw = stream.read(limit + 1)  # a pipe or device does not tell its size
    except OSError as error:
        raise InputError(f"cannot read {what} {path}: {error.strerror or error}") from error
    if len(raw) > limit:
        raise InputError(f"{what} {path} is larger than {limit >> 20} MiB")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{what} {path} is not UTF-8 text (byte {error.start})") from error
