"""Requests of other programs: one JSON file for each, answered by a file of the same name.

A request asks for a solution (``problem``) or for a verdict on a curve (``case``); both are described by
``request.schema.json``. The answer is a result, verdicts, or an error with its exit status.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import as_completed
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import jsonschema

from weakforms.errors import InputError, WeakformsError
from weakforms.results.io import dumps, first_error, load_json, require_writable, write_atomically
from weakforms.verification.crosscheck.convergence import RATIO
from weakforms.verification.crosscheck.rows import EXIT_STATUS, FAILED, PASSED
from weakforms.verification.run.workers import in_this_process, workers

SCHEMA = "weakforms.request/1"
ERROR_SCHEMA = "weakforms.error/1"
OUTPUT = "results"
"""Default folder for answers, inside the folder of the requests."""


@cache
def schema(name: str) -> dict[str, Any]:
    """A JSON Schema of this package: ``request``, ``verdicts`` or ``error``."""
    text = resources.files("weakforms.verification").joinpath(f"{name}.schema.json").read_text("utf-8")
    return json.loads(text)


@dataclass(frozen=True)
class Answer:
    """The outcome of one request."""

    name: str
    status: int
    """Exit status of the same request on the command line."""
    message: str = ""


def read_request(path: Path) -> dict[str, Any]:
    """Read a request from a file.

    Raises:
        InputError: If it is not JSON, or does not fit the schema.
    """
    data = load_json(path, "request")
    validator = jsonschema.Draft202012Validator(schema("request"))
    try:
        error = first_error(validator, data)
    except RecursionError:
        raise InputError(f"request {path}: nested too deeply") from None
    if error is not None:
        place = "/".join(map(str, error.absolute_path)) or "top level"
        message = error.message[:200]
        if error.validator == "oneOf" and not error.absolute_path:
            message = "it must have either a problem, or a case and a curve"
        raise InputError(f"request {path}: at {place}: {message}")
    return data


def answer(data: Mapping[str, Any], folder: Path, progress: Any = None) -> tuple[int, dict[str, Any]]:
    """Exit status and JSON answer of one request.

    Args:
        data: A request that fits the schema.
        folder: Folder of the curve files, whose paths may not leave it.
        progress: Progress callback of a solve.

    Raises:
        WeakformsError: For bad input, or a solve without a result.
    """
    if "curve" in data:
        from weakforms.verification.crosscheck.compare import compare

        given = data["curve"]
        several = given if isinstance(given, list) else [given]
        found = [c if isinstance(c, dict) else _inside(folder, c) for c in several]
        against = _inside(folder, data["result"]) if "result" in data else data.get("parameters", {})
        verdicts = compare(
            data.get("case") or data["problem"],
            found if isinstance(given, list) else found[0],
            data.get("name"),
            data.get("accuracy"),
            data.get("map"),
            data.get("constants"),
            data.get("columns"),
            data.get("branch"),
            against=None if "case" in data else against,
            over=data.get("over"),
            crossing=data.get("crossing", 1),
            ratio=data.get("ratio", RATIO),
            cause=data.get("cause", False),
        )
        return verdicts.exit_status, verdicts.to_json()
    from weakforms import api

    solve = api.prepare(
        data["problem"],
        data.get("parameters", {}),
        data.get("numerics", {}),
        data.get("at", {}),
        data.get("crossing", 1),
        data.get("branch", "primary"),
    )
    result = solve(progress)
    return (3 if result.failures else 0), result.to_json()


def _inside(folder: Path, name: str) -> Path:
    try:
        path = (folder / name).resolve()
        inside = path.is_relative_to(folder.resolve())
        regular = path.is_file()
    except (OSError, ValueError, RuntimeError) as error:  # a NUL in the name, or a loop of links
        raise InputError(f"curve {name!r} is not a file: {error}") from None
    if not inside:
        raise InputError(f"curve {name!r} lies outside of the folder of the request")
    if not regular:  # reading a pipe may never end
        raise InputError(f"curve {name!r} is not a file in the folder of the request")
    return path


def run_batch(
    folder: Path,
    out: Path | None = None,
    resume: bool = False,
    writes: bool = True,
    report: Callable[[str, int, int], None] = lambda *_: None,
) -> list[Answer]:
    """Answer every ``*.json`` in a folder, each by a file of the same name in the output folder.

    The answer to a request that fails is an error object; the other requests continue.

    Args:
        folder: Folder with the requests and their curves.
        out: Folder for the answers; by default ``results`` inside it.
        resume: Keep earlier answers that are newer than their request.
        writes: Whether this process writes (rank 0 of several).
        report: Progress callback: current request, number done, number of requests.

    Raises:
        InputError: If there is no request, or the output folder cannot be written to.
    """
    folder = Path(folder)
    if out is None and (folder / OUTPUT).is_symlink():  # anybody may have written the folder
        raise InputError(f"{folder / OUTPUT} is a link; name the folder for the answers with --out")
    out = folder / OUTPUT if out is None else Path(out)
    try:
        requests = sorted(path for path in folder.iterdir() if path.suffix == ".json" and path.is_file())
    except OSError as error:
        raise InputError(f"cannot read folder {folder}: {error.strerror}") from error
    if not requests:
        raise InputError(f"folder {folder} has no request: no file that ends in .json")
    if out.resolve() == folder.resolve():
        raise InputError(f"answers have the names of their requests: {out} must be another folder")
    require_writable(out)
    answers = {path: _kept(path, out / path.name) if resume else None for path in requests}
    todo = [path for path in requests if answers[path] is None]
    done = len(requests) - len(todo)
    report(todo[0].name if todo else "done", done, len(requests))
    for path, found, text in _outcomes(todo):
        if writes:
            write_atomically(out / path.name, text, follow=False)
        answers[path], done = found, done + 1
        report(f"after {path.name}", done, len(requests))
    return list(answers.values())


def _outcomes(paths: list[Path]) -> Iterator[tuple[Path, Answer, str]]:
    """Each request with its answer, as they come, from this process or from an engine."""
    if in_this_process(1):
        yield from ((path, *_answered(path)) for path in paths)
        return
    with workers(1) as pool:
        running = {pool.submit(_answered, path): path for path in paths}
        for future in as_completed(running):
            yield running[future], *future.result()


def _answered(path: Path) -> tuple[Answer, str]:
    """The answer to a request, and its file's text."""
    try:
        status, data = answer(read_request(path), path.parent)
        message = {0: "", 1: "out of bounds", 3: "not all converged", 5: "not judged"}[status]
    except WeakformsError as error:
        status, message = error.exit_status, str(error)
        data = {"schema": ERROR_SCHEMA, "exit_status": status, "message": message}
    return Answer(path.stem, status, message), dumps(data)


def _kept(path: Path, target: Path) -> Answer | None:
    """An earlier answer that is complete and newer than its request; errors are tried again."""
    try:
        if target.stat().st_mtime < path.stat().st_mtime:
            return None
        data = load_json(target, "answer")
    except (OSError, InputError):
        return None
    if data.get("schema") == "weakforms.verdicts/1":
        status = data.get("status") or (PASSED if data["passed"] else FAILED)
        return Answer(path.stem, EXIT_STATUS[str(status)], "kept") if str(status) in EXIT_STATUS else None
    if data.get("schema") == "weakforms.result/1" and not data["failures"]:
        return Answer(path.stem, 0, "kept")
    return None
