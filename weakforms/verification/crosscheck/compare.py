"""Comparison of a curve of another code with a reference table: the cross-check that other packages call."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from weakforms.errors import InputError
from weakforms.results import CurveFile
from weakforms.verification.cases import references
from weakforms.verification.cases.discovery import FoundCase, find_cases, get_case
from weakforms.verification.cases.panels import Panel
from weakforms.verification.cases.references import Reference
from weakforms.verification.crosscheck.columns import CurveLike, our_columns, read, require_same_parameters
from weakforms.verification.crosscheck.pictures import picture
from weakforms.verification.crosscheck.rows import (
    EXIT_STATUS,
    FAILED,
    NOT_JUDGED,
    PASSED,
    ColumnVerdict,
    absent,
    judge_column,
    met,
    reached,
    tolerance,
)
from weakforms.verification.crosscheck.units import abscissa_hint, forgotten
from weakforms.verification.judging.checks.curve import Curve
from weakforms.verification.judging.outcome import PanelOutcome

SCHEMA = "weakforms.verdicts/1"
STATED = (
    *("check", "kind", "passed", "statement", "detail", "error", "bound", "asked"),
    *("reference_uncertainty", "where", "reference"),
    *("status", "column", "judged_rows", "signed_error", "row", "largest", "scale", "scale_floor", "units"),
)
"""Entry of the JSON of a verdict: the uncertainty of the curve is unknown."""

LARGEST_ACCURACY = 0.1
"""Largest accuracy that a curve may claim; with a larger one nearly every curve would pass."""


@dataclass(frozen=True)
class Verdicts:
    """Verdicts on a curve of another code, one for each column, and the part of the table that it covers."""

    case: str
    curve: str
    abscissa: str
    covered: tuple[float, float]
    """Range of the abscissa that was judged."""
    table: tuple[float, float]
    """Range of the abscissa in the table."""
    rows: int
    ignored_rows: int
    """Number of rows of the curve outside the table's range."""
    unjudged_rows: dict[str, int]
    """For each column, the number of rows where the table is too coarse for the accuracy asked."""
    table_rows: int
    met_rows: int
    """Number of rows of the table that the curve covers."""
    missing: tuple[str, ...]
    """Columns to be judged that the curve does not have."""
    left_out: tuple[str, ...]
    """Columns of the table that were not to be judged."""
    verdicts: tuple[ColumnVerdict, ...]
    pictures: tuple[PanelOutcome, ...]
    """For each judged column the curve, the table, and the error of every row with its bound."""

    @property
    def status(self) -> str:
        """``failed`` if any column is out of bounds, ``passed`` if all are within, else ``not judged``."""
        kinds = {verdict.status for verdict in self.verdicts}
        if FAILED in kinds:
            return FAILED
        return PASSED if kinds == {PASSED} else NOT_JUDGED

    @property
    def exit_status(self) -> int:
        """Exit status of a command with this verdict: 0 passed, 1 failed, 5 not judged."""
        return EXIT_STATUS[self.status]

    @property
    def passed(self) -> bool:
        """Whether every column is judged and within its bound."""
        return self.status == PASSED

    @property
    def extent(self) -> str:
        """The judged part of the table, in words."""
        if not self.partial:
            return "all of it is judged"
        return f"part of it is judged, {self.met_rows} of {self.table_rows} rows are covered"

    @property
    def partial(self) -> bool:
        """Whether the curve leaves part of the table unjudged."""
        return (
            self.covered != self.table or self.met_rows < self.table_rows or any(self.unjudged_rows.values())
        )

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.verdicts/1``, without the pictures."""
        shown = {
            f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("pictures", "verdicts")
        }
        verdicts = [{name: getattr(verdict, name) for name in STATED} for verdict in self.verdicts]
        head = {"schema": SCHEMA, "passed": self.passed, "status": self.status, "partial": self.partial}
        return json.loads(json.dumps({**head, **shown, "verdicts": verdicts}))


def compare(
    case: str,
    curve: CurveLike,
    name: str | None = None,
    accuracy: float | None = None,
    columns: Mapping[str, str] | None = None,
    constants: Mapping[str, float] | None = None,
    only: Sequence[str] | None = None,
    branch: str | None = None,
) -> Verdicts:
    """Compare a curve with the reference table of a case.

    The table is interpolated at the curve's abscissa by a spline. The error estimate of the spline
    (:func:`~weakforms.verification.crosscheck.rows.interpolated`) widens the bound. A row is not judged if
    its bound exceeds twice the accuracy asked. A column is not judged if at most half of its rows are, or if
    the curve does not have it and ``only`` does not leave it out. A curve that covers part of the table is
    judged on that part.

    Args:
        case: Id of a case, such as ``paper2.fig03``.
        curve: A CSV or JSON file, or columns by name, with the table's abscissa, which must be monotone.
        name: Name of the table, if the case has several.
        accuracy: Relative accuracy that the curve claims, up to 0.1; by default what the case asks of our own
            code.
        columns: Names in the curve by names in the table, such as ``{"p": "pressure"}``.
        constants: If the curve has units, the radius, modulus and thickness with which the paper scales, such
            as ``{"R_f": 0.02, "C1": 2e5, "h_o": 1e-4}``.
        only: Columns of the table to be judged; by default all that the case judges.
        branch: Branch of a file that has several; by default the one that the case draws.

    Raises:
        InputError: If the case or curve is unknown, a column is wrong, the abscissa is not monotone, or a
            result is for other parameters than the table's.
    """
    found = get_case(case)
    chosen = choose(found, name)
    table = references.load_curve(found.paper, chosen)
    if accuracy is not None and not 0 < accuracy <= LARGEST_ACCURACY:
        raise InputError(f"accuracy = {accuracy!r}: must lie between 0 and {LARGEST_ACCURACY:g}")
    drawn = _drawn(found, chosen)
    first = drawn[0][1]
    given = _read(curve, branch, first)
    require_same_parameters(given, table, first)
    curves = [curve for _, curve in drawn]
    names = _names(given.columns, curves, columns)
    own = our_columns(given.columns, list(table.columns), names, constants, first.of.problem)
    by_case = _asked_by(found, curves)
    asked = by_case if accuracy is None else dict.fromkeys(table.ordinates, accuracy)
    wanted = _wanted(table, own, by_case, asked, only)
    hint = abscissa_hint(first.of.problem, table.abscissa, constants or {})
    x, keep = _aligned(table, own, hint)
    judged = []
    for column in wanted:
        if column not in own:
            judged.append(absent(table, column, asked[column], len(x)))
            continue
        numbers, values = np.flatnonzero(keep) + 1, own[column][keep]
        if not np.all(np.isfinite(values)):
            raise InputError(f"column {column!r} has no number in row {numbers[~np.isfinite(values)][0]}")
        judged.append(judge_column(table, column, x, values, asked[column], numbers))
        verdict = judged[-1].verdict
        verdict.units = forgotten(judged[-1], first.of.problem, constants or {}, table.parameters)
        if verdict.status == FAILED and not verdict.units and 2 * len(x) < len(keep) and hint:
            verdict.units = f"most rows lie outside of the table: {hint}"
    rows = table.columns[table.abscissa]
    return Verdicts(
        case=found.id,
        curve=table.name,
        abscissa=table.abscissa,
        covered=reached(x, rows),
        table=(float(rows.min()), float(rows.max())),
        rows=len(x),
        ignored_rows=int(np.sum(~keep)),
        unjudged_rows={j.verdict.column: j.verdict.unjudged_rows for j in judged},
        table_rows=len(table),
        met_rows=met(rows, x),
        missing=tuple(column for column in wanted if column not in own),
        left_out=tuple(column for column in table.ordinates if column not in wanted),
        verdicts=tuple(j.verdict for j in judged),
        pictures=tuple(
            picture(table, own, j, [panel for panel, _ in drawn]) for j in judged if j.verdict.column in own
        ),
    )


def _read(curve: CurveLike, branch: str | None, drawn: Curve) -> CurveFile:
    """Read the curve; of a file, by default, the branch that the case draws."""
    if branch is None and isinstance(curve, str | Path) and drawn.branch != "primary":
        branch = drawn.branch
    return read(curve, branch or "")


def _drawn(found: FoundCase, reference: str) -> list[tuple[Panel, Curve]]:
    """The curve of the case that belongs to a table."""
    panels = found.case.panels
    return [(panel, curve) for panel in panels for curve in panel.curves if curve.reference == reference]


def _asked_by(found: FoundCase, curves: Sequence[Curve]) -> dict[str, float]:
    """The smallest accuracy that a case asks of each column of a table."""
    asked: dict[str, float] = {}
    for curve in curves:
        for name, value in curve.asked.items():
            asked[name] = min(value, asked.get(name, value))
    return asked


def _names(
    columns: Mapping[str, np.ndarray], curves: Sequence[Curve], names: Mapping[str, str] | None
) -> dict[str, str]:
    """Names in the curve by names in the table: those given, and those that our own solutions use."""
    known = {ours: theirs for curve in curves for ours, theirs in curve.columns.items()}
    own = {ours: theirs for ours, theirs in known.items() if ours not in columns and theirs in columns}
    return own | dict(names or {})


def tables_of(found: FoundCase) -> list[str]:
    """Tables of a case that a curve can be compared with."""
    curves = [curve for panel in found.case.panels for curve in panel.curves]
    return list(dict.fromkeys(curve.reference for curve in curves if curve.reference is not None))


def comparable(group: str) -> list[str]:
    """Cases of a paper, or of another group, that have such a table."""
    return [found.id for found in find_cases() if found.group == group and tables_of(found)]


def choose(found: FoundCase, name: str | None) -> str:
    """The table of a case, by name if there are several.

    Raises:
        InputError: If the name is unknown, or missing where there are several.
    """
    names = tables_of(found)
    if not names:
        raise InputError(
            f"{found.id} has no table of a curve to compare with; cases that have one: "
            f"{', '.join(comparable(found.group)) or 'see weakforms list'}"
        )
    if name is None and len(names) == 1:
        return names[0]
    if name not in names:
        problem = f"unknown curve {name!r}" if name else "which curve?"
        raise InputError(f"{found.id}: {problem}; it has {', '.join(names)}")
    return name


def _wanted(
    table: Reference,
    own: Mapping[str, np.ndarray],
    by_case: Mapping[str, float],
    asked: Mapping[str, float],
    only: Sequence[str] | None,
) -> list[str]:
    """Columns to be judged.

    These are the columns requested by name; else those that the case judges, and, if an accuracy is claimed,
    all others that both table and curve have.
    """
    if only:
        only = [only] if isinstance(only, str) else list(only)
        for column in only:
            if column not in table.ordinates:
                raise InputError(
                    f"--column {column}: table {table.name} has no such column; "
                    f"it has {', '.join(table.ordinates)}"
                )
            if column not in asked:
                raise InputError(f"--column {column}: the case asks no accuracy of it; state --accuracy")
        wanted = [column for column in table.ordinates if column in only]
    else:
        wanted = [c for c in table.ordinates if c in by_case or (c in asked and c in own)]
    if table.abscissa not in own:
        raise InputError(
            f"the curve has no column {table.abscissa!r}, over which table {table.name} is compared; "
            f"it has {', '.join(own)}"
        )
    if not any(column in own for column in wanted):
        raise InputError(
            f"the curve has none of the columns of table {table.name} that are judged: "
            f"{', '.join(wanted)}; it has {', '.join(own)}"
        )
    return wanted


def _aligned(table: Reference, columns: Mapping[str, np.ndarray], hint: str) -> tuple[np.ndarray, np.ndarray]:
    """The abscissa within the table's range, up to rounding, and the rows it belongs to."""
    x = columns[table.abscissa]
    rows = table.columns[table.abscissa]
    blur = tolerance(rows)
    keep = (x >= rows.min() - blur) & (x <= rows.max() + blur)
    if not np.any(keep):
        raise InputError(
            f"the curve's {table.abscissa} lies in [{np.nanmin(x):g}, {np.nanmax(x):g}], "
            f"the table's in [{rows.min():g}, {rows.max():g}]: nothing to compare"
            + (f"; {hint}" if hint else "")
        )
    steps = np.diff(x[keep])
    if not (np.all(steps > 0) or np.all(steps < 0)):
        raise InputError(f"the curve's {table.abscissa} must rise, or fall, from row to row")
    return x[keep], keep
