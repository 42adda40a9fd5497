"""The pages of the report: an overview, two pages for each group of cases, and one page for printing.

The first page of a group has its figures and what did not hold, the second one the long tables: checks that
hold, and solutions.

A group is the part of a case's id before the dot: a paper, or a folder of cases such as ``materials``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from statistics import quantiles
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup

from weakforms.verification.audit.any_parameters.outcome import STATUSES
from weakforms.verification.audit.bench_ranks import STAGES
from weakforms.verification.audit.coverage.outcome import COLUMNS, PARTS, cells
from weakforms.verification.audit.faults.outcome import FaultOutcome
from weakforms.verification.judging.consistency import exempt
from weakforms.verification.judging.outcome import (
    RunOutcome,
    SurfaceOutcome,
    Verdict,
)
from weakforms.verification.report import summary, thesis, wording
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.case_views import case_view, draw, figure_files
from weakforms.verification.report.figures.scaling import scaling_views
from weakforms.verification.report.figures.svg import share_letters
from weakforms.verification.report.formulas import html_formula, svg_formula
from weakforms.verification.report.junit import clean
from weakforms.verification.report.look import LOOK, TEMPLATES
from weakforms.verification.report.wording import file_name, unused

RESERVED = (
    "top",
    "main",
    "summary",
    "how-well",
    "differs",
    "cases",
    "broken",
    "reading",
    "environment",
    "faults",
    "elsewhere",
    "audit",
    "coverage",
    "scaling",
    "exempt",
    "thesis",
    "panels",
    "statements",
)
"""Identifiers that the templates use."""
GROUPS = {
    "paper1": (
        "Paper 1",
        "Contact mechanics of a circular membrane inflated against a deformable substrate",
        "Patil, DasGupta & Eriksson, International Journal of Solids and Structures 67–68 (2015) 250–262",
    ),
    "paper2": (
        "Paper 2",
        "Free and constrained inflation of a pre-stretched cylindrical membrane",
        "Patil, Nordmark & Eriksson, Proceedings of the Royal Society A 470 (2014) 20140282",
    ),
    "paper3": (
        "Paper 3",
        "Instability investigation on fluid-loaded pre-stretched cylindrical membranes",
        "Patil, Nordmark & Eriksson, Proceedings of the Royal Society A 471 (2015) 20150016",
    ),
    "paper4": (
        "Paper 4",
        "Wrinkling of cylindrical membranes with non-uniform thickness",
        "Patil, Nordmark & Eriksson, European Journal of Mechanics A/Solids 54 (2015) 1–10",
    ),
    "paper5": (
        "Paper 5",
        "Instabilities of wrinkled membranes with pressure loadings",
        "Patil, Nordmark & Eriksson, Journal of the Mechanics and Physics of Solids 94 (2016) 298–315",
    ),
    "materials": ("Materials", "Material laws and what they must satisfy", ""),
    "closed_form": ("Closed forms", "Problems with exact solutions", ""),
    "beyond": ("Beyond the papers", "Bifurcations and bodies that the papers did not ask about", ""),
}
"""Short name, title and source of known groups; any other has the name of its folder."""


def render(run: RunOutcome, beside: Beside | None = None, jobs: int = 1) -> dict[str, str]:
    """Every page of the report.

    Args:
        run: Outcome of ``verify``.
        beside: Outcomes of other verbs.
        jobs: Number of parallel processes for drawing.

    Returns:
        HTML by file name; the first page is ``index.html``. Pages load no other files.
    """
    return render_with_files(run, beside, jobs)[0]


def render_with_files(
    run: RunOutcome, beside: Beside | None = None, jobs: int = 1
) -> tuple[dict[str, str], dict[str, str | bytes]]:
    """The pages of :func:`render`, and the files that they offer: every panel as CSV and as SVG."""
    facts = _facts(run, beside, jobs)
    pages = {
        group["page"]: share_letters(template("group.html").render(facts, group=group, here=group["page"]))
        for group in facts["groups"]
    }
    for group in (group for group in facts["groups"] if group["long"]):
        page = template("group_checks.html").render(facts, group=group, here=group["checks"])
        pages[group["checks"]] = share_letters(page)
    for name in ("thesis.html", "faults.html", "audit.html", "coverage.html", "scaling.html"):
        pages[name] = template(name).render(facts, here=name)
    pages["index.html"] = template("index.html").render(facts, here="index.html")
    return pages, figure_files(facts["cases"])


def render_whole(run: RunOutcome, beside: Beside | None = None) -> str:
    """All pages as one, for printing, with links inside the page only."""
    facts = _facts(run, beside)
    return share_letters(template("whole.html").render(facts, here=None))


def shape_files(run: RunOutcome) -> list[tuple[str, SurfaceOutcome]]:
    """The surfaces of a run, each with its file for ParaView."""
    taken: set[str] = set()
    return [
        (f"shapes/{unused(file_name(f'{case.id}-{surface.name}'), taken)}.vtu", surface)
        for case in run.cases
        for surface in case.surfaces
    ]


def template(name: str) -> Template:
    """The template of a page, with filters for numbers and TeX."""
    return _environment().get_template(name)


@cache
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
        **{name: getattr(summary, name) for name in ("ratio", "worst")},
        **{
            name: getattr(wording, name)
            for name in ("scientific", "signed", "fraction", "duration", "order", "plural")
        },
    }
    environment.filters |= filters | {
        "tex": lambda text: Markup(wording.html_tex(text)),
        "formula": lambda text: Markup(html_formula(text)),
        "drawn_formula": lambda text: Markup(svg_formula(text)),
        "plain_tex": wording.plain_tex,
        "typeset": wording.typeset,
        "symbol": wording.symbol,
        "value": wording.with_uncertainty,
        "coverage_cells": cells,
        "flat": lambda value: list(_flat(value)),
        "label": lambda status: summary.LABELS.get(status, status),
        "when": lambda text: re.sub(r"^(\d{4}-\d\d-\d\d)T(\d\d:\d\d).*$", r"\1, \2 UTC", text),
    }
    return environment


# -- data for the templates ---------------------------------------------------------------------


def _facts(run: RunOutcome, beside: Beside | None = None, jobs: int = 1) -> dict[str, Any]:
    """All variables of the templates, from the run and the other outcomes in its folder."""
    beside = beside or Beside()
    seeded, taken = beside.seeded, set(RESERVED)
    shapes = {id(surface): name for name, surface in shape_files(run)}
    views = [case_view(case, taken, shapes) for case in run.cases]
    draw([shown for view in views for shown in (*view["figures"], *view["histories"])], jobs)
    groups = _groups(views)
    checks = [(view, row) for view in views for row in view["rows"]]
    verdicts = [row["verdict"] for _, row in checks]
    places = {id(row["verdict"]): (view, row) for view, row in checks}
    tops = {name: getattr(summary, name)(verdicts) for name in ("worst", "sharpest", "bluntest")}
    return {
        "run": run,
        "status": summary.run_status(run),
        "headline": summary.headline(run),
        "verdicts": verdicts,
        "total": len(verdicts),
        "passed": sum(verdict.passed for verdict in verdicts),
        "cases": views,
        "ordered": sorted(views, key=lambda view: summary.ORDER.get(view["status"], 0)),
        "broken": [view for view in views if view["failing"] or view["case"].errors],
        "marks": {name: places[id(top)] for name, top in tops.items() if top is not None},
        "spread": _spread(verdicts),
        "loose": [a for a in summary.accuracies(run) if a.ratio > summary.LOOSE],
        "groups": groups,
        "ledger": summary.ledger_counts(run.cases),
        "meanings": summary.MEANINGS,
        "differing": _differing(views),
        "panels": thesis.panels(run),
        "statements": thesis.statements(run),
        "seeded": seeded,
        "others": beside.others,
        "audited": beside.audited,
        "audit_statuses": STATUSES,
        "covered": beside.covered,
        "coverage_parts": PARTS,
        "coverage_columns": COLUMNS,
        "surfaces": scaling_views(beside.scaled),
        "scaled": beside.scaled,
        "stages": STAGES,
        "areas": _areas(seeded.run.faults if seeded.run else ()),
        "mutants": _areas(seeded.random.faults if seeded.random else (), "subject"),
        "look": LOOK,
        "exempt": {
            "not judged": exempt.EXEMPT,
            "judged by sign": exempt.EXEMPT_SIZE,
            "not judged in every solution": exempt.KNOWN,
            "a problem without identities": exempt.UNSTATED,
        },
    }


def _groups(views: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """The cases in groups, each group with its page."""
    found: dict[str, list[dict[str, Any]]] = {}
    for view in views:
        found.setdefault(view["case"].id.partition(".")[0], []).append(view)
    taken = {"index", "thesis", "faults", "audit", "coverage", "scaling"}
    out = []
    for key, members in found.items():
        name, title, source = GROUPS.get(key, (key.replace("_", " ").capitalize(), "", ""))
        stem = unused(file_name(key), taken)
        cases = [view["case"] for view in members]
        rows = [row["verdict"] for view in members for row in view["rows"]]
        group = {
            "page": f"{stem}.html",
            "checks": f"{unused(f'{stem}-checks', taken)}.html",
            "anchor": f"group-{stem}",
            "name": name,
            "title": title,
            "source": source,
            "views": members,
            "long": [view for view in members if view["case"].solutions or view["folded"]],
            "verdicts": rows,
            "passed": sum(verdict.passed for verdict in rows),
            "status": min((v["status"] for v in members), key=lambda status: summary.ORDER.get(status, 0)),
            "figures": sum(len(view["figures"]) for view in members),
            "ledger": summary.ledger_counts(cases),
        }
        for view in members:
            view["group"] = group
        out.append(group)
    return out


def _areas(faults: Iterable[FaultOutcome], by: str = "area") -> dict[str, list[FaultOutcome]]:
    """Faults by area."""
    found: dict[str, list[FaultOutcome]] = {}
    for fault in faults:
        found.setdefault(getattr(fault, by), []).append(fault)
    return found


def _spread(verdicts: Iterable[Verdict]) -> dict[str, Any] | None:
    """Statistics of all bounds: median, ninth decile, and their number."""
    bounds = sorted(v.bound for v in verdicts if v.passed and v.bound)
    if len(bounds) < 10:
        return None
    tenths = quantiles(bounds, n=10, method="inclusive")
    return {"count": len(bounds), "median": tenths[4], "ninety": tenths[8]}


def _differing(views: Iterable[dict[str, Any]]) -> dict[str, list[tuple[dict[str, Any], Any]]]:
    """Disagreements with the thesis: printed numbers that are not reproduced, statements that are not true.

    Also numbers that cannot be decided, because the thesis does not give enough data.
    """
    views = list(views)
    entries = [(view, entry) for view in views for entry in view["case"].printed]
    claims = [(view, row) for view in views for row in view["rows"]]
    return {
        "numbers": [pair for pair in entries if pair[1].status in ("misprint", "cut off", "grid of a scan")],
        "statements": [pair for pair in claims if pair[1]["verdict"].differs and pair[1]["verdict"].passed],
        "lost": [pair for pair in entries if summary.LABELS.get(pair[1].status) == summary.LOST],
    }


def _flat(value: Any, prefix: str = "") -> Iterable[tuple[str, str]]:
    """Names and values of nested mappings, one pair for each leaf."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _flat(item, f"{prefix}.{key}" if prefix else str(key))
    elif isinstance(value, float):
        yield prefix, f"{value:.12g}"
    elif isinstance(value, (list, tuple)):
        yield prefix, ", ".join(f"{i:.12g}" if isinstance(i, float) else str(i) for i in value)
    else:
        yield prefix, "–" if value is None else str(value)
