"""The report: ``index.html``, ``report.json`` and ``junit.xml`` of a ``RunOutcome``, from it alone.

The page is one file without scripts, fonts or anything else from elsewhere, and it is drawn from
what ``report.json`` holds, so that rebuilding it later gives the same bytes.
"""

from __future__ import annotations

import copy
import json
import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from itertools import chain, count
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from pydantic import TypeAdapter, ValidationError

from weakforms.errors import InputError
from weakforms.verification import summary
from weakforms.verification.figures import LOOK, convergence_figure, panel_figure
from weakforms.verification.junit import clean, junit_xml
from weakforms.verification.outcome import SCHEMA, CaseOutcome, Convergence, RunOutcome, Verdict
from weakforms.verification.surface_figures import surface_figure

TEMPLATES = Path(__file__).parent / "templates"
FOLDED = 30
"""More passed checks than this in one case stand folded under their summary."""
_LISTS = ("x", "y", "reference_x", "reference_y", "residual_x", "residual", "residual_bound")


def write_report(run: RunOutcome, folder: Path) -> Path:
    """Write the three files of the report, each complete or not at all.

    Args:
        run: What ``verify`` left.
        folder: Where to; made when missing.

    Returns:
        The path of ``index.html``.

    Raises:
        InputError: When the folder cannot be written.
    """
    data = _plain(run.to_json())
    run = _decoded(data)
    texts = {
        "report.json": json.dumps(data, indent=1, allow_nan=False) + "\n",
        "junit.xml": junit_xml(run),
        "index.html": render(run),
    }
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            _replace(folder / name, text)
    except OSError as error:
        raise InputError(f"cannot write the report to {folder}: {error.strerror}") from error
    return folder / "index.html"


def load_run(folder: Path) -> RunOutcome:
    """The run that ``report.json`` in a folder holds.

    Args:
        folder: A folder :func:`write_report` wrote to, or the JSON file itself.

    Returns:
        The run; numbers that were not finite come back as NaN in columns and ``None`` elsewhere.

    Raises:
        InputError: When the file is missing, cut short, not JSON, or of another schema.
    """
    path = Path(folder)
    path = path / "report.json" if path.suffix != ".json" else path
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not complete JSON ({str(error).splitlines()[0]})") from error
    schema = data.get("schema") if isinstance(data, dict) else None
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
    """The run of a JSON object, with every type checked and ``null`` in a column read as NaN."""
    data = copy.deepcopy(data)
    for case in data["cases"]:
        columns = [(curve, key) for p in case["panels"] for curve in p["curves"] for key in _LISTS]
        columns += [(record, "errors") for record in case["convergence"]]
        for record, key in columns:
            record[key] = [math.nan if value is None else value for value in record[key]]
    TypeAdapter(RunOutcome).validate_python(data)
    return RunOutcome.from_json(data)


def _plain(value: Any) -> Any:
    """The value as strict JSON has it: no NumPy, no paths, and ``null`` for what is not finite."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, (str, int)) else str(value)


def _replace(path: Path, text: str) -> None:
    """Write a file under its final name only when it is complete."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with partial.open("w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def render(run: RunOutcome) -> str:
    """The whole page.

    Args:
        run: What ``verify`` left.

    Returns:
        HTML of one file that loads nothing.
    """
    taken: set[str] = {"top", "main", "summary", "reading", "ledger", "environment", "cases"}
    order = sorted(run.cases, key=lambda case: summary.ORDER.get(summary.case_status(case), 0))
    views = {id(case): _case_view(case, taken) for case in run.cases}
    cases = [views[id(case)] for case in run.cases]
    anchors = {id(row["verdict"]): row["anchor"] for view in cases for row in view["rows"]}
    verdicts = [verdict for _, verdict in summary.verdicts_of(run)]
    marks = {name: getattr(summary, name)(verdicts) for name in ("worst", "sharpest", "bluntest")}
    owner = {id(verdict): case for case, verdict in summary.verdicts_of(run)}
    return (
        _environment()
        .get_template("report.html")
        .render(
            run=run,
            status=summary.run_status(run),
            headline=summary.headline(run),
            verdicts=verdicts,
            total=len(verdicts),
            passed=sum(verdict.passed for verdict in verdicts),
            cases=cases,
            ordered=[views[id(case)] for case in order],
            broken=[view for view in cases if view["failing"] or view["case"].errors],
            marks={
                name: {"verdict": v, "anchor": anchors[id(v)], "case": owner[id(v)]}
                for name, v in marks.items()
                if v is not None
            },
            papers=_papers(cases),
            ledger=summary.ledger_counts(run.cases),
            look=LOOK,
        )
    )


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=lambda value: clean(value) if type(value) is str else value,
    )
    filters: dict[str, Callable[..., Any]] = {
        name: getattr(summary, name)
        for name in ("scientific", "fraction", "ratio", "duration", "order", "plural", "worst")
    }
    environment.filters |= filters | {
        "tex": lambda text: Markup(summary.html_tex(text)),
        "plain_tex": summary.plain_tex,
        "value": summary.with_uncertainty,
        "flat": lambda value: list(_flat(value)),
        "when": lambda text: re.sub(r"^(\d{4}-\d\d-\d\d)T(\d\d:\d\d).*$", r"\1, \2 UTC", text),
    }
    return environment


def _case_view(case: CaseOutcome, taken: set[str]) -> dict[str, Any]:
    """What the template shows of one case: figures drawn, checks sorted, anchors made."""
    anchor = _anchor(case.id, taken)
    rows = [
        {
            "verdict": verdict,
            "anchor": _anchor(f"{anchor}:{verdict.check}", taken),
            "numbers": _numbers(verdict),
        }
        for verdict in case.verdicts
    ]
    passing = [row for row in rows if row["verdict"].passed]
    figures = []
    for panel in case.panels:
        ident = _anchor(f"{anchor}:panel-{panel.name}", taken)
        drawing = Markup(panel_figure(panel, _anchor("f", taken), case.verdicts))
        figures.append({"panel": panel, "anchor": ident, "svg": drawing})
    for surface in case.surfaces:
        ident = _anchor(f"{anchor}:surface-{surface.name}", taken)
        picture = Markup(surface_figure(surface, _anchor("f", taken)))
        figures.append({"panel": surface, "anchor": ident, "svg": picture})
    histories = []
    for records in _by_quantity(case.convergence):
        drawing = Markup(convergence_figure(records, _anchor("f", taken)))
        histories.append({"records": records, "svg": drawing})
    shared = _shared([solution.get("provenance") or {} for solution in case.solutions])
    return {
        "case": case,
        "anchor": anchor,
        "status": summary.case_status(case),
        "rows": rows,
        "failing": [row for row in rows if not row["verdict"].passed],
        "passing": passing,
        "folded": len(passing) > FOLDED,
        "figures": figures,
        "histories": histories,
        "shared": shared,
    }


def _numbers(verdict: Verdict) -> dict[str, str]:
    """Error, bound and asked accuracy with as many digits as it takes to tell them apart."""
    values = {name: getattr(verdict, name) for name in ("error", "bound", "asked")}
    known = [value for value in values.values() if value is not None]
    for digits in range(2, 7):
        texts = {name: summary.scientific(value, digits) for name, value in values.items()}
        if len({texts[n] for n, v in values.items() if v is not None}) == len(set(known)):
            break
    return texts


def _by_quantity(records: Iterable[Convergence]) -> list[list[Convergence]]:
    groups: dict[str, list[Convergence]] = {}
    for record in records:
        groups.setdefault(record.quantity, []).append(record)
    return list(groups.values())


def _papers(cases: Iterable[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """The cases by the paper they belong to, for the contents."""
    papers: dict[str, list[dict[str, Any]]] = {}
    for view in cases:
        paper = view["case"].id.partition(".")[0]
        papers.setdefault(re.sub(r"^paper(\d+)$", r"Paper \1", paper), []).append(view)
    return papers


def _shared(records: list[Mapping[str, Any]]) -> dict[str, Any]:
    """The entries that all of several mappings have in common."""
    first = records[0] if len(records) > 1 else {}
    return {k: v for k, v in first.items() if all(other.get(k) == v for other in records)}


def _flat(value: Any, prefix: str = "") -> Iterable[tuple[str, str]]:
    """Names and values of nested mappings, one pair a leaf."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _flat(item, f"{prefix}.{key}" if prefix else str(key))
    elif isinstance(value, float):
        yield prefix, f"{value:.12g}"
    elif isinstance(value, (list, tuple)):
        yield prefix, ", ".join(f"{i:.12g}" if isinstance(i, float) else str(i) for i in value)
    else:
        yield prefix, "–" if value is None else str(value)


def _anchor(text: str, taken: set[str]) -> str:
    """An identifier made of the text that no other element of the page has."""
    stem = re.sub(r"[^\w.:-]+", "-", clean(text), flags=re.ASCII).strip("-") or "item"
    name = next(n for n in chain([stem], (f"{stem}-{k}" for k in count(2))) if n not in taken)
    taken.add(name)
    return name
