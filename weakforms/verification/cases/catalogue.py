"""Lists and descriptions of problems and cases, as text and as JSON."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.table import Column, Table
from rich.text import Text

from weakforms.api import require_environment
from weakforms.errors import EnvironmentLackError, InputError
from weakforms.problems.registry import abouts
from weakforms.verification.cases import examples, references
from weakforms.verification.cases.discovery import FoundCase, among, find_cases
from weakforms.verification.crosscheck.rows import FAILED, NOT_JUDGED, PASSED, scale_text
from weakforms.verification.crosscheck.targets import tables_of
from weakforms.verification.crosscheck.verdicts import Verdicts
from weakforms.verification.report.wording import plain_tex, plural, scientific, signed


def listing(paper: int | None = None) -> list[dict[str, Any]]:
    """One entry for each problem and case; without dolfinx, problems are left out."""
    entries = []
    try:
        require_environment()
        known = abouts().values()
    except EnvironmentLackError:
        known = ()
    for about in known:
        if paper in (None, about.paper):
            entries.append({"kind": "problem", "id": about.name, "paper": about.paper, "title": about.title})
    for found in find_cases():
        if paper in (None, found.paper):
            entry = {"kind": "case", "id": found.id, "paper": found.paper, "title": found.case.title}
            entries.append(entry | {"curves": tables_of(found)})
    if not entries:
        raise InputError(f"there is no problem or case of paper {paper}")
    return entries


def print_listing(entries: list[dict[str, Any]], console: Console) -> None:
    """Print one line for each entry."""
    width = max(len(entry["id"]) for entry in entries)
    for entry in entries:
        console.print(f"{entry['kind']:8} {entry['id']:{width}}  {entry['title']}", soft_wrap=True)


def describe(name: str) -> dict[str, Any]:
    """Facts about a problem or a case.

    Raises:
        InputError: If there is neither of that name.
    """
    for found in find_cases():
        if found.id == name:
            return _case_facts(found)
    registry = require_environment()
    if name in abouts():
        return _problem_facts(registry.get(name))
    known = [*abouts(), *(found.id for found in find_cases())]
    raise InputError(f"unknown problem or case {name!r}; {among(name, known)}")


def _problem_facts(problem: Any) -> dict[str, Any]:
    about = problem.about
    return {
        "kind": "problem",
        "id": about.name,
        "title": about.title,
        "source": about.source,
        "energy": about.energy,
        "weak_form": examples.weak_form(about),
        "example": examples.code(about),
        "command": examples.command(about),
        "control": about.control,
        "parameters": _fields(problem.parameters),
        "numerics": _fields(problem.numerics),
        "columns": [column.name for column in about.columns],
        "special_points": list(about.special_points),
        "branches": list(about.branches),
        "scales": problem.scales,
        "constants": list(about.units.constants),
        **_law_facts(getattr(problem, "materials", {})),
    }


def _law_facts(materials: dict[str, Any]) -> dict[str, Any]:
    """The laws that a problem lists, with constants and sources."""
    if not materials:
        return {}
    laws = [
        {
            "name": m.name,
            "title": m.title,
            "kind": m.kind,
            "energy": m.text,
            "source": m.source,
            "stress": m.scale,
            "incompressible": m.incompressible,
            "constants": [
                {"name": n, "default": c.default, "allowed": c.allowed, "description": c.meaning}
                for n, c in m.constants.items()
            ],
        }
        for m in materials.values()
    ]
    return {"materials": laws}


def _fields(model: Any) -> list[dict[str, Any]]:
    properties = model.model_json_schema()["properties"]
    signs = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<=", "exclusiveMaximum": "<"}
    out = []
    for name, facts in properties.items():
        allowed = " and ".join(f"{sign} {facts[key]:g}" for key, sign in signs.items() if key in facts)
        if "enum" in facts:
            allowed = ", ".join(map(str, facts["enum"]))
        out.append(
            {
                "name": name,
                "default": facts.get("default"),
                "allowed": allowed,
                "description": facts.get("description", ""),
                **({"needs": model.needed_by(name)} if model.needed_by(name) else {}),
            }
        )
    return out


def _case_facts(found: FoundCase) -> dict[str, Any]:
    case = found.case
    tables = [d.reference for p in case.panels for d in (*p.curves, *p.paths) if d.reference]
    tables += [check.reference for check in case.checks if getattr(check, "reference", "")]
    return {
        "kind": "case",
        "id": found.id,
        "title": case.title,
        "source": case.source,
        "description": found.description,
        "panels": [
            {"name": p.name, "x": p.x.name, "y": p.y.name, "curves": [str(c.of) for c in p.curves]}
            for p in case.panels
        ],
        "checks": [
            getattr(check, "statement", None)
            or f"{type(check).__name__} {getattr(check, 'reference', '') or getattr(check, 'what', '')}"
            for check in case.checks
        ],
        "asked": dict(case.asked),
        "curves": tables_of(found),
        "references": [
            {
                "name": n,
                "type": t.kind,
                "abscissa": t.abscissa,
                "rows": len(t),
                "uncertainty": t.uncertainty,
                "method": t.method,
            }
            for n in dict.fromkeys(tables)
            for t in [references.load(found.paper, n)]
        ],
    }


def print_description(facts: dict[str, Any], console: Console) -> None:
    """Print the facts as text."""
    console.print(Text.assemble((facts["id"], "bold"), f"  {facts['title']}"), soft_wrap=True)
    console.print(facts["source"], soft_wrap=True)
    if facts["kind"] == "case":
        _print_case(facts, console)
        return
    console.print(f"\n{facts['energy']}\n", markup=False)
    console.print(f"weak form: {facts['weak_form']}\n", markup=False)
    console.print("example:\n  " + "\n  ".join(facts["example"]) + "\n", markup=False, soft_wrap=True)
    for title in ("parameters", "numerics"):
        table = Table("name", "default", "allowed", "meaning", title=title, title_justify="left")
        for row in facts[title]:
            needs = f"; needs {row['needs']}" if "needs" in row else ""
            table.add_row(row["name"], str(row["default"]), row["allowed"], row["description"] + needs)
        console.print(table)
    console.print(f"control: {facts['control']}")
    console.print(f"columns: {', '.join(facts['columns'])}")
    console.print(f"special points: {', '.join(facts['special_points'])}")
    _print_laws(facts.get("materials", []), console)
    scales = Table("name", "scaling", title="scales", title_justify="left")
    for name, text in facts["scales"].items():
        scales.add_row(name, text)
    console.print(scales)
    if facts["constants"]:
        console.print(f"constants of a curve with units (--constant): {', '.join(facts['constants'])}")


def _print_laws(laws: list[dict[str, Any]], console: Console) -> None:
    for law in laws:
        console.print(
            f"\nmodel = {law['name']}: {law['title']} ({law['kind']})", markup=False, soft_wrap=True
        )
        for name in ("energy", "source", "stress"):
            console.print(f"  {name}: {law[name]}", markup=False, soft_wrap=True)
        for c in law["constants"]:
            text = f"    {c['name']} = {c['default']:g}, allowed {c['allowed']}: {c['description']}"
            console.print(text, markup=False, soft_wrap=True)


def _print_case(facts: dict[str, Any], console: Console) -> None:
    console.print(f"\n{facts['description']}\n", markup=False)
    for panel in facts["panels"]:
        console.print(f"panel {panel['name']}: {panel['y']} over {panel['x']}")
        for curve in panel["curves"]:
            console.print(f"  {curve}", markup=False)
    console.print("checks:")
    for check in facts["checks"]:
        console.print(f"  {plain_tex(check)}", markup=False)
    asked = ", ".join(f"{name} {value:g}" for name, value in facts["asked"].items()) or OF_EACH
    console.print(f"accuracy asked (relative): {asked}")
    curves = ", ".join(facts["curves"]) or "none (no table over an abscissa)"
    console.print(f"curves to compare with: {curves}", markup=False, soft_wrap=True)
    for table in facts["references"]:
        largest = max(table["uncertainty"].values())
        console.print(
            f"reference {table['name']}: {table['type']}, {table['rows']} rows of "
            f"{', '.join(table['uncertainty'])}, uncertainty up to {largest:.1e}",
            soft_wrap=True,
        )


def print_verdicts(verdicts: Verdicts, console: Console) -> None:
    """Print the verdicts on a curve of another code as a table."""

    def line(text: str) -> None:
        console.print(text, markup=False, soft_wrap=True)

    line(
        f"{verdicts.case}, {verdicts.curve}: {plural(verdicts.rows, 'row')} over {verdicts.abscissa} in "
        f"[{verdicts.covered[0]:g}, {verdicts.covered[1]:g}]; the table has "
        f"[{verdicts.table[0]:g}, {verdicts.table[1]:g}]: {verdicts.extent}"
        + (f", {plural(verdicts.ignored_rows, 'row')} outside of it" if verdicts.ignored_rows else "")
    )
    table = Table("column", *(Column(h, no_wrap=True) for h in ("verdict", "error", "bound")), "at", "row")
    for v in verdicts.verdicts:
        found = [(v.signed_error, v.bound, v.where, v.row)] if v.largest else []
        if v.largest and abs(v.largest["error"]) > v.error:
            found.append(tuple(v.largest.values()))
        cells = [(signed(error), scientific(bound), at, str(row)) for error, bound, at, row in found]
        for k, numbers in enumerate(cells or [("–", "–", "missing", "–")]):
            table.add_row(*((v.column, WORDS[v.status]) if k == 0 else ("", "largest error")), *numbers)
    console.print(table)
    for v in verdicts.verdicts:
        reached = v.claim
        if v.status == FAILED:  # of a forgotten unit, how far off the curve is says nothing
            missed = f"the curve reaches {scientific(v.reached)}, not {scientific(v.asked)}"
            reached = "" if v.units else v.claim or missed
        for text in filter(None, (reached, v.units, v.trend, *v.causes)):
            line(f"{v.check}: {text}")
        if v.judged_rows < v.rows:
            line(f"{v.check}: {v.detail}")
    for found in verdicts.convergence:
        line(f"{found.column}: {WORDS[found.status]}: {found.text}")
    line(f"errors are relative to {scale_text(verdicts.abscissa)}")
    if verdicts.left_out:
        line(f"left out: {', '.join(verdicts.left_out)}")
    line(f"verdict: {verdicts.status}")


OF_EACH = "each check has its own"

WORDS = {PASSED: "within", FAILED: "OUT OF BOUNDS", NOT_JUDGED: "NOT JUDGED"}
"""Texts of the table for the status of a column."""
