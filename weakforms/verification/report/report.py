"""The report of a ``RunOutcome``, from it alone: pages, ``report.json``, ``junit.xml``, shapes for ParaView.

Pages are self-contained, without scripts and fonts. Everything is drawn from ``report.json``, so that the
report can be rebuilt later with the same bytes.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.results.io import MAX_REPORT_BYTES, load_json
from weakforms.verification.audit.elsewhere import NAME as ELSEWHERE
from weakforms.verification.judging.outcome import SCHEMA, RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.junit import junit_xml
from weakforms.verification.report.pages import render_with_files, shape_files
from weakforms.verification.report.vtu import vtu

OURS = '<meta name="generator" content="weakforms">'
"""Mark of a page of a report, which distinguishes it from other files."""
_LISTS = ("x", "y", "reference_x", "reference_y", "residual_x", "residual", "residual_bound")


def write_report(run: RunOutcome, folder: Path, stored: bool = False, jobs: int = 1) -> Path:
    """Write the files of the report, each complete or not at all, ``index.html`` last.

    If the folder has a ``faults.json``, an ``audit.json``, a ``coverage.json``, a ``scaling.jsonl`` or an
    ``elsewhere.json``, the report shows the seeded faults, the audit, the test of uncertainties, the time of
    large surfaces, or the comparison with other runs (until the cases are run again). Without the first or
    the fourth it shows what the package brings.

    Args:
        run: Outcome of ``verify``.
        folder: Folder of the report; created if missing. Pages and shapes of an earlier report are deleted.
        stored: Whether it was read by :func:`load_run`; then nothing is written before everything is drawn.
        jobs: Number of parallel processes for drawing.

    Returns:
        The path of ``index.html``.

    Raises:
        InputError: If the folder cannot be written, or the stored run cannot be drawn.
    """
    data = _plain(run.to_json())
    text = json.dumps(data, indent=1, allow_nan=False) + "\n"
    run = run if stored else _decoded(data)  # drawn as it would be from its file
    numbers = {"report.json": text, "junit.xml": junit_xml(run)}
    folder = Path(folder)
    beside = Beside.read(folder, others=stored)
    drawn = _redrawn(run, beside, jobs) if stored else {}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not stored:
            (folder / ELSEWHERE).unlink(missing_ok=True)  # it compares the numbers of an earlier run
        _write(folder, numbers)  # before anything is drawn: `report` can draw it later
        drawn = drawn or _drawn(run, beside, jobs)
        _write(folder, drawn)
        _sweep(folder, set(drawn))
    except OSError as error:
        raise InputError(f"cannot write the report to {folder}: {error.strerror}") from error
    return folder / "index.html"


def _drawn(run: RunOutcome, beside: Beside, jobs: int) -> dict[str, str | bytes]:
    """Shapes and pages by name, ``index.html`` last."""
    shapes = {name: vtu(surface) for name, surface in shape_files(run)}
    pages, files = render_with_files(run, beside, jobs)
    return shapes | files | pages


def _redrawn(run: RunOutcome, beside: Beside, jobs: int) -> dict[str, str | bytes]:
    """The same for a stored run, whose numbers may come from anywhere."""
    try:
        return _drawn(run, beside, jobs)
    except EnvironmentLackError:
        raise
    except Exception as error:
        raise InputError(f"the stored run cannot be drawn: {type(error).__name__}: {error}") from error


def _write(folder: Path, contents: Mapping[str, str | bytes]) -> None:
    """Write files, each under its name only when complete."""
    for name, content in contents.items():
        (folder / name).parent.mkdir(exist_ok=True)
        _replace(folder / name, content)


def _sweep(folder: Path, kept: set[str]) -> None:
    """Remove files of an earlier report that this one does not have: pages, shapes, PDF."""
    for path in folder.glob("*.html"):
        if path.name not in kept and path.is_file() and OURS in path.read_text("utf-8", "replace")[:2000]:
            path.unlink(missing_ok=True)
    pictures = (path for kind in ("csv", "svg", "pdf") for path in folder.glob(f"figures/*.{kind}"))
    for path in (*folder.glob("shapes/*.vtu"), *pictures):
        if f"{path.parent.name}/{path.name}" not in kept:
            path.unlink(missing_ok=True)
    (folder / "report.pdf").unlink(missing_ok=True)


def load_run(folder: Path) -> RunOutcome:
    """Read the run from ``report.json`` in a folder.

    Args:
        folder: A folder :func:`write_report` wrote to, or the JSON file itself.

    Returns:
        The run; numbers that were not finite come back as NaN in columns and ``None`` elsewhere.

    Raises:
        InputError: If the file is missing, cut short, not JSON, or of another schema.
    """
    path = Path(folder)
    path = path / "report.json" if path.suffix != ".json" else path
    data = load_json(path, "report", MAX_REPORT_BYTES)
    schema = data.get("schema")
    if schema != SCHEMA:
        raise InputError(f"{path}: schema is {schema!r}, expected {SCHEMA!r}")
    try:
        return _decoded(data)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        reason = f"{type(error).__name__}: {error}"
        if isinstance(error, ValidationError):
            first = error.errors()[0]
            reason = f"{'.'.join(map(str, first['loc']))}: {first['msg']}"
        raise InputError(f"{path}: not a {SCHEMA} document: {reason}") from error


def _decoded(data: dict[str, Any]) -> RunOutcome:
    """The run of a JSON object, with every type checked; each ``null`` in a column of it becomes NaN."""
    for case in data["cases"]:
        columns = [(curve, key) for p in case["panels"] for curve in p["curves"] for key in _LISTS]
        columns += [(record, "errors") for record in case["convergence"]]
        for record, key in columns:
            record[key] = [math.nan if value is None else value for value in record[key]]
    TypeAdapter(RunOutcome).validate_python(data)
    return RunOutcome.from_json(data)


def _plain(value: Any) -> Any:
    """The value as strict JSON: no NumPy, no paths, and ``null`` for numbers that are not finite."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, (str, int)) else str(value)


def _replace(path: Path, content: str | bytes) -> None:
    """Write a file under its final name only when it is complete."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with partial.open("wb") as stream:
            stream.write(content.encode() if isinstance(content, str) else content)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)
