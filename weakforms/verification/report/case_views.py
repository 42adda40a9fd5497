"""The data of one case for the templates: figures, sorted checks, histories of refinement."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from io import StringIO
from operator import call
from pathlib import Path
from typing import Any

from markupsafe import Markup

from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.judging.outcome import (
    CaseOutcome,
    Convergence,
    PanelOutcome,
    SurfaceOutcome,
    Verdict,
)
from weakforms.verification.report import summary, wording
from weakforms.verification.report.figures.canvas import Picture
from weakforms.verification.report.figures.convergence import convergence_figure
from weakforms.verification.report.figures.panel import panel_picture
from weakforms.verification.report.figures.surfaces import surface_picture
from weakforms.verification.report.figures.svg import standalone
from weakforms.verification.report.junit import clean
from weakforms.verification.report.manual import manual, references
from weakforms.verification.report.wording import anchor, file_name, unused
from weakforms.verification.run.workers import in_this_process, workers

FOLDED = 30
"""If a case has more passed checks than this, they are folded under their summary."""


def draw(shown: Sequence[dict[str, Any]], jobs: int) -> None:
    """Replace calls by the pictures that they draw."""
    calls = [entry["svg"] for entry in shown]
    if in_this_process(jobs):
        drawn = map(call, calls)
    else:
        with workers(jobs) as pool:
            drawn = list(pool.map(call, calls, chunksize=4))
    for entry, picture in zip(shown, drawn, strict=True):
        if isinstance(picture, Picture):
            entry["pdf"] = picture.pdf
        entry["svg"] = Markup(picture.svg if isinstance(picture, Picture) else picture)


def case_view(case: CaseOutcome, taken: set[str], shapes: Mapping[int, str]) -> dict[str, Any]:
    """The data of one case for the template: figures, sorted checks, anchors."""
    top = anchor(case.id, taken)
    rows = [
        {
            "verdict": verdict,
            "anchor": anchor(f"{top}:{verdict.check}", taken),
            "numbers": _numbers(verdict),
            "sentence": "" if verdict.passed else what_differs(verdict),
        }
        for verdict in case.verdicts
    ]
    passing = [row for row in rows if row["verdict"].passed]
    histories = []
    for records in _by_quantity(case.convergence):
        drawing = partial(convergence_figure, records, anchor("f", taken))
        histories.append({"records": records, "svg": drawing})
    return {
        "case": case,
        "anchor": top,
        "status": summary.case_status(case),
        "file": _file_of(case.id) if case.errors or len(passing) < len(rows) else "",
        "manual": manual(case),
        "references": references(case),
        "rows": rows,
        "failing": [row for row in rows if not row["verdict"].passed],
        "passing": passing,
        "folded": len(passing) > FOLDED,
        "figures": _figures(case, top, taken, shapes),
        "histories": histories,
        "shared": _shared([solution.get("provenance") or {} for solution in case.solutions]),
    }


def _file_of(case: str) -> str:
    """The file of a case, as a path in the tree, also of an installed package; empty without such a case."""
    path = next((found.path for found in find_cases() if found.id == case), Path())
    folder = next((above for above in path.parents if above.name in ("cases", "_cases")), None)
    return f"cases/{path.relative_to(folder)}" if folder else path.name


def _figures(case: CaseOutcome, top: str, taken: set[str], shapes: Mapping[int, str]) -> list[dict[str, Any]]:
    """The pictures of a case: its panels, then its surfaces with their files for ParaView."""
    figures = []
    for panel in (*case.panels, *case.surfaces):
        surface = isinstance(panel, SurfaceOutcome)
        ident = anchor(f"{top}:{'surface' if surface else 'panel'}-{panel.name}", taken)
        place = anchor("f", taken)
        drawing = (
            partial(surface_picture, panel, place)
            if surface
            else partial(panel_picture, panel, place, case.verdicts)
        )
        stem = unused(f"figures/{file_name(f'{case.id}-{panel.name}')}", taken)
        files = [f"{stem}.csv", f"{stem}.svg", f"{stem}.pdf"]
        shape = shapes.get(id(panel))
        figures.append({"panel": panel, "anchor": ident, "svg": drawing, "shape": shape, "files": files})
    return figures


def figure_files(views: Iterable[dict[str, Any]]) -> dict[str, str | bytes]:
    """Every panel as files by name: its numbers as CSV, its picture as SVG and as PDF."""
    files: dict[str, str | bytes] = {}
    for item in (item for view in views for item in view["figures"]):
        numbers, drawing, printed = item["files"]
        write = surface_csv if item["shape"] else panel_csv
        files |= {numbers: write(item["panel"]), drawing: standalone(item["svg"]), printed: item["pdf"]}
    return files


def surface_csv(surface: SurfaceOutcome) -> str:
    """The numbers of a surface, one row for each of its points."""
    columns = dict(zip("xyz", surface.position, strict=True)) | surface.fields
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for rows in zip(*columns.values(), strict=True):
        writer.writerows(zip(*rows, strict=True))
    return clean(text.getvalue())


def panel_csv(panel: PanelOutcome) -> str:
    """The numbers of a panel, one row for each point: of weak form, reference and errors."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["curve", "what", panel.x, panel.y, "relative error", "bound"])
    for curve in panel.curves:
        name = curve.name or curve.label
        writer.writerows([name, "weak form", x, y] for x, y in zip(curve.x, curve.y, strict=False))
        rows = zip(curve.reference_x, curve.reference_y, strict=False)
        writer.writerows([name, "reference", x, y] for x, y in rows)
        bounds = curve.residual_bound or [""] * len(curve.residual)
        errors = zip(curve.residual_x, curve.residual, bounds, strict=False)
        over = f"error over {curve.residual_abscissa}"
        writer.writerows([name, over, x, "", error, bound] for x, error, bound in errors)
    return clean(text.getvalue())


def _numbers(verdict: Verdict) -> dict[str, str]:
    """Error, bound and asked accuracy with as many digits as needed to distinguish them."""
    values = {name: getattr(verdict, name) for name in ("error", "bound", "asked")}
    known = [value for value in values.values() if value is not None]
    for digits in range(2, 7):
        texts = {name: wording.scientific(value, digits) for name, value in values.items()}
        if len({texts[n] for n, v in values.items() if v is not None}) == len(set(known)):
            break
    return texts


def what_differs(verdict: Verdict) -> str:
    """A failed numerical check in one sentence; empty for others, whose statement and numbers say it."""
    if verdict.bound is None or verdict.error is None:
        return ""
    column, numbers = wording.typeset(verdict.check.rpartition(":")[2]), _numbers(verdict)
    if not verdict.error <= verdict.bound:
        against = f" from {verdict.reference}" if verdict.reference else ""
        where = f" at {wording.typeset(verdict.where)}" if verdict.where else ""
        times = wording.fraction(summary.ratio(verdict))
        return (
            f"{column} differs{against} by {numbers['error']} of its scale{where}; "
            f"this is {times} times the bound of {numbers['bound']}."
        )
    if verdict.asked is not None:
        return (
            f"{column} agrees within its bound, but the bound of {numbers['bound']} is wider than the "
            f"accuracy of {numbers['asked']} that the case asks for."
        )
    return ""


def _by_quantity(records: Iterable[Convergence]) -> list[list[Convergence]]:
    groups: dict[str, list[Convergence]] = {}
    for record in records:
        groups.setdefault(record.quantity, []).append(record)
    return list(groups.values())


def _shared(records: list[Mapping[str, Any]]) -> dict[str, Any]:
    """The entries that several mappings have in common."""
    first = records[0] if len(records) > 1 else {}
    return {k: v for k, v in first.items() if all(other.get(k) == v for other in records)}
