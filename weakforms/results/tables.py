"""Results as tables with one row for each special point, state and end of a branch, for CSV files."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from weakforms.results.model import Field
from weakforms.results.result import Result

SPREAD = "_uncertainty"
"""Ending of the name of a column with uncertainties."""

Row = dict[str, Any]


def point_rows(result: Result) -> list[Row]:
    """A row for each special point: ``what`` (its kind), ``number`` of this kind, ``branch``, its columns."""
    seen: Counter[tuple[str, str]] = Counter()
    out = []
    for point in result.special_points:
        seen[point.kind, point.branch] += 1
        head = {"what": point.kind, "number": seen[point.kind, point.branch], "branch": point.branch}
        out.append(head | _with_spread(point.values, point.uncertainty))
    return out


def state_rows(result: Result) -> list[Row]:
    """A row for each requested state, ``what`` names where it lies, ``number`` is its crossing."""
    out = []
    for state in result.states:
        at = ", ".join(f"{name} = {value:.12g}" for name, value in state.at.items())
        values = {name: q.value for name, q in state.quantities.items()}
        spread = {name: q.uncertainty for name, q in state.quantities.items()}
        head = {"what": f"state at {at}", "number": state.crossing, "branch": state.branch}
        out.append(head | _with_spread(values, spread))
    return out


def other_rows(result: Result) -> list[Row]:
    """Rows for the quantities, the end of each branch, what is not there, and what failed."""
    out: list[Row] = []
    if result.quantities:
        values = {name: q.value for name, q in result.quantities.items()}
        spread = {name: q.uncertainty for name, q in result.quantities.items()}
        out.append({"what": "quantities"} | _with_spread(values, spread))
    for branch in result.branches:
        last = {name: branch.columns[name][-1] for name in branch.columns if len(branch)}
        last = {name: v for name, v in last.items() if name not in ("residual", "iterations")}
        out.append({"what": "end", "branch": branch.name, **last, "reason": str(branch.ended or "")})
    out += [{"what": "not there", "reason": f"{item.what}: {item.reason}"} for item in result.absent]
    return out + [{"what": "failed", "reason": f"{item.what}: {item.reason}"} for item in result.failures]


def field_rows(field: Field) -> list[Row]:
    """A row for each sample point of a profile."""
    return [dict(zip(field.columns, row, strict=True)) for row in zip(*field.columns.values(), strict=True)]


def _with_spread(values: Mapping[str, float], spread: Mapping[str, float | None]) -> Row:
    out: Row = {}
    for name, value in values.items():
        out[name] = value
        if spread.get(name) is not None:
            out[name + SPREAD] = spread[name]
    return out


def header(rows: Iterable[Row]) -> list[str]:
    """All names of the rows, ``reason`` last."""
    names = dict.fromkeys(name for row in rows for name in row)
    return sorted(names, key=lambda name: name == "reason")


def csv_text(rows: list[Row]) -> str:
    """Rows as CSV; numbers keep all their digits, and what a row does not have stays empty."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, header(rows), lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow({name: _cell(value) for name, value in row.items()})
    return stream.getvalue()


def _cell(value: Any) -> Any:
    if isinstance(value, float | np.floating):
        return repr(float(value)) if np.isfinite(value) else ""
    return value
