"""Reading and writing results and curves: JSON validated against the shipped schema, CSV, atomic writes."""

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
from typing import TYPE_CHECKING, Any

from weakforms.errors import InputError
from weakforms.results.result import Result

if TYPE_CHECKING:
    import jsonschema

MAX_JSON_BYTES = 32 * 2**20
"""Largest size of a JSON file, which needs up to thirty times as much memory."""

MAX_REPORT_BYTES = 256 * 2**20
"""Largest size of a ``report.json``."""

BRANCH = "branch"
"""The column with names instead of numbers in the table that :func:`branch_csv` writes."""


@cache
def schema() -> dict[str, Any]:
    """JSON Schema of ``weakforms.result/1``."""
    text = resources.files("weakforms.results").joinpath("result.schema.json").read_text("utf-8")
    return json.loads(text)


def validate(data: dict[str, Any]) -> None:
    """Validate a JSON object against the result schema.

    Raises:
        InputError: If it does not fit; the message names the first place.
    """
    import jsonschema

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
        spread = table.get("uncertainty", {})
        lengths |= {f"uncertainty of {k}": len(v) for k, v in spread.items() if isinstance(v, list)}
        if len(set(lengths.values())) > 1:
            raise InputError(
                f"not a weakforms.result/1 object: columns differ in length: {str(lengths)[:200]}"
            )


def first_error(validator: jsonschema.Validator, data: Any) -> jsonschema.ValidationError | None:
    """The first of a few places that do not fit a schema; ``None`` if there is none."""
    return min(islice(validator.iter_errors(data), 100), key=lambda e: list(map(str, e.path)), default=None)


def write_atomically(path: Path, text: str, follow: bool = True) -> None:
    """Write a file so that it appears under its name only when it is complete.

    A link is followed; a device or pipe is written to, never replaced.

    Args:
        path: The file; missing folders are created.
        text: The content; characters without a UTF-8 code become ``?``.
        follow: Whether a link is followed; if not, the file replaces the link.

    Raises:
        InputError: If the file cannot be written.
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
    """Lock a folder while results are written to it, and delete incomplete files of a killed run.

    The operating system locks the folder itself. The lock ends with the process and leaves no file. On a file
    system without locks, nothing is locked.

    Raises:
        InputError: If another process has locked it.
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
"""Pattern of the names that files have while they are written."""


def require_writable(folder: Path, name: str = "") -> None:
    """Make sure, before anything is solved, that results can be written into a folder and under a name.

    Raises:
        InputError: If they cannot.
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
    """Make sure, before anything is solved, that a file can be written.

    Raises:
        InputError: If it cannot, or if the path is a folder.
    """
    if os.path.isdir(path):
        raise InputError(f"cannot write {path}: it is a folder, not a file")
    if not os.path.exists(path) or os.path.isfile(path):  # Path.exists raises for a name that is too long
        require_writable(path.parent, path.name)


def dumps(data: dict[str, Any]) -> str:
    """JSON text without NaN, with keys in their order and one newline at the end."""
    return json.dumps(data, indent=1, allow_nan=False, ensure_ascii=False) + "\n"


def load_json(path: Path, what: str, limit: int = MAX_JSON_BYTES) -> dict[str, Any]:
    """Read a JSON object from a file of up to ``limit`` bytes.

    Raises:
        InputError: If the file is missing, too large, not UTF-8, not JSON or not an object.
    """
    try:
        data = json.loads(read_text(path, what, limit))
    except (ValueError, RecursionError) as error:  # a number with thousands of digits raises a ValueError
        raise InputError(f"{what} {path}: not JSON: {str(error).splitlines()[0]}") from error
    if not isinstance(data, dict):
        raise InputError(f"{what} {path}: must hold a JSON object, not {type(data).__name__}")
    return data


def load_result(path: Path) -> Result:
    """Read a result from a file and validate it.

    Raises:
        InputError: If it cannot be read or does not fit the schema.
    """
    data = load_json(path, "result")
    validate(data)
    try:
        return Result.from_json(data)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"result {path}: {error}") from error


def save_result(result: Result, path: Path) -> None:
    """Write a result as JSON; the file appears under its name only when complete.

    Raises:
        InputError: If it does not fit the schema, or cannot be written.
    """
    data = result.to_json()
    validate(data)
    write_atomically(Path(path), dumps(data))


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
    """Read UTF-8 text from a file of up to ``limit`` bytes.

    Raises:
        InputError: If the file is missing, too large or not UTF-8.
    """
    try:
        with Path(path).open("rb") as stream:
            raw = stream.read(limit + 1)  # the size of a pipe or device is unknown
    except OSError as error:
        raise InputError(f"cannot read {what} {path}: {error.strerror or error}") from error
    if len(raw) > limit:
        raise InputError(f"{what} {path} is larger than {limit >> 20} MiB")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{what} {path} is not UTF-8 text (byte {error.start})") from error
