"""Somebody else's curve held against a reference table: the cross-check that other packages call."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline

from weakforms.errors import InputError
from weakforms.verification import references
from weakforms.verification.case import LABELS, Curve, Panel
from weakforms.verification.curves import asked_of
from weakforms.verification.discovery import FoundCase, get_case
from weakforms.verification.foreign import CurveLike, foreign_columns
from weakforms.verification.outcome import CurveOutcome, PanelOutcome, Verdict
from weakforms.verification.references import Reference

SCHEMA = "weakforms.verdicts/1"
STATED = (
    *("check", "kind", "passed", "statement", "detail", "error", "bound", "asked"),
    *("reference_uncertainty", "where", "reference"),
)
"""What the JSON of a verdict on a curve says: of the curve's own uncertainty nothing is known."""


@dataclass(frozen=True)
class Verdicts:
    """Verdicts on a foreign curve, one a column, and the part of the table it covers."""

    case: str
    curve: str
    abscissa: str
    covered: tuple[float, float]
    """Range of the abscissa that was judged."""
    table: tuple[float, float]
    """Range of the abscissa that the table has."""
    rows: int
    ignored_rows: int
    """Rows of the curve outside the table's range."""
    unjudged_rows: dict[str, int]
    """Per column: rows between the table's, where it is too coarse to judge to the accuracy asked."""
    verdicts: tuple[Verdict, ...]
    pictures: tuple[PanelOutcome, ...]
    """One a verdict: the curve, the table, and the error of every row with its bound."""

    @property
    def passed(self) -> bool:
        """Whether every column is within its bound."""
        return bool(self.verdicts) and all(v.passed for v in self.verdicts)

    @property
    def partial(self) -> bool:
        """Whether the curve leaves part of the table unjudged."""
        return self.covered != self.table or any(self.unjudged_rows.values())

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.verdicts/1``, without the pictures."""
        shown = {
            f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("pictures", "verdicts")
        }
        verdicts = [{name: getattr(verdict, name) for name in STATED} for verdict in self.verdicts]
        head = {"schema": SCHEMA, "passed": self.passed, "partial": self.partial}
        return json.loads(json.dumps({**head, **shown, "verdicts": verdicts}))


def compare(
    case: str,
    curve: CurveLike,
    name: str | None = None,
    accuracy: float | None = None,
    columns: Mapping[str, str] | None = None,
    constants: Mapping[str, float] | None = None,
) -> Verdicts:
    """Hold a curve against the reference table of a case.

    The table is interpolated at the curve's abscissa by a spline, the error of which (:func:`interpolated`)
    widens the bound. A wide bound never passes for agreement: rows at
    which it would exceed twice the accuracy asked are not judged, and counted. A curve that covers part of
    the table is judged there.

    Args:
        case: Id of a case, such as ``paper2.fig03``.
        curve: A CSV or JSON file, or columns by name; must hold the table's abscissa, monotone.
        name: Which table of the case, where it has several.
        accuracy: Relative accuracy the curve claims; by default what the case asks of our own.
        columns: The curve's own names by the table's, such as ``{"p": "pressure"}``.
        constants: Where the curve has units: radius, modulus and thickness that the paper scales with,
            such as ``{"R_f": 0.02, "C1": 2e5, "h_o": 1e-4}``.

    Raises:
        InputError: For an unknown case or curve, a wrong column, an abscissa that is not monotone.
    """
    found = get_case(case)
    chosen = choose(found, name)
    table = references.load_curve(found.paper, chosen)
    if accuracy is not None and not 0 < accuracy < 1:
        raise InputError(f"accuracy = {accuracy!r}: must lie between 0 and 1")
    drawn = _drawn(found, chosen)
    asked = _accuracies(found, table, drawn[0][1], accuracy)
    own = foreign_columns(curve, list(table.columns), columns, constants, drawn[0][1].of.problem)
    x, keep, shared = _aligned(table, own, asked)
    judged = [_judge(table, column, x, own[column][keep], asked[column]) for column in shared]
    rows, whole = table.columns[table.abscissa], own[table.abscissa]
    low, high = float(rows.min()), float(rows.max())
    return Verdicts(
        case=found.id,
        curve=table.name,
        abscissa=table.abscissa,
        covered=(max(float(whole.min()), low), min(float(whole.max()), high)),
        table=(low, high),
        rows=len(x),
        ignored_rows=int(np.sum(~keep)),
        unjudged_rows={column: j.unjudged for column, j in zip(shared, judged, strict=True)},
        verdicts=tuple(j.verdict for j in judged),
        pictures=tuple(
            _picture(table, column, own, j, [panel for panel, _ in drawn])
            for column, j in zip(shared, judged, strict=True)
        ),
    )


def _drawn(found: FoundCase, reference: str) -> list[tuple[Panel, Curve]]:
    """Where the case draws that table."""
    panels = found.case.panels
    return [(panel, curve) for panel in panels for curve in panel.curves if curve.reference == reference]


def _accuracies(
    found: FoundCase, table: Reference, curve: Curve, accuracy: float | None
) -> Mapping[str, float]:
    """Accuracy wanted of each column: what was claimed, or what the case asks of its own curve."""
    if accuracy is not None:
        return dict.fromkeys(table.ordinates, accuracy)
    return asked_of(curve, found.case)


def choose(found: FoundCase, name: str | None) -> str:
    """The table of a case, by name where there are several.

    Raises:
        InputError: When the choice is not clear.
    """
    names = [
        curve.reference
        for panel in found.case.panels
        for curve in panel.curves
        if curve.reference is not None
    ]
    names = list(dict.fromkeys(names))
    if name is None and len(names) == 1:
        return names[0]
    if name not in names:
        problem = f"unknown curve {name!r}" if name else "which curve?"
        raise InputError(f"{found.id}: {problem}; it has {', '.join(names) or 'none'}")
    return name


def _aligned(
    table: Reference, columns: Mapping[str, np.ndarray], asked: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Abscissa within the table's range, which rows those are, and the columns to judge."""
    if table.abscissa not in columns:
        raise InputError(
            f"the curve has no column {table.abscissa!r}, over which table {table.name} is compared; "
            f"it has {', '.join(columns)}"
        )
    judged = [name for name in table.ordinates if name in asked]
    shared = [name for name in judged if name in columns]
    if not shared:
        raise InputError(
            f"the curve has none of the columns of table {table.name} that are judged: "
            f"{', '.join(judged)}; it has {', '.join(columns)}"
        )
    x = columns[table.abscissa]
    steps = np.diff(x)
    if not (np.all(steps > 0) or np.all(steps < 0)):
        raise InputError(f"the curve's {table.abscissa} must rise, or fall, from row to row")
    rows = table.columns[table.abscissa]
    keep = (x >= rows.min()) & (x <= rows.max())
    if not np.any(keep):
        raise InputError(
            f"the curve's {table.abscissa} lies in [{x.min():g}, {x.max():g}], "
            f"the table's in [{rows.min():g}, {rows.max():g}]: nothing to compare"
        )
    return x[keep], keep, shared


def interpolated(rows: np.ndarray, values: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Quintic spline through a table at ``x``, and a bound of its error (zero at the rows themselves).

    Where the table resolves the curve at all, the quintic spline is nearer to it than the cubic one. At the
    ends and in steep parts it may be worse: four times the largest distance between the two, in the interval
    and its neighbours, held for every function it was tried on.
    """
    if len(rows) < 6:
        raise InputError(f"a table of {len(rows)} rows is too short to interpolate")
    order = np.argsort(rows)
    rows, values = rows[order], values[order]
    quintic, cubic = (make_interp_spline(rows, values, k=k) for k in (5, 3))
    inside = rows[:-1, None] + np.diff(rows)[:, None] * np.arange(1, 8) / 8
    apart = np.pad(np.abs(quintic(inside) - cubic(inside)).max(axis=1), 1)
    bound = 4 * np.maximum.reduce([apart[:-2], apart[1:-1], apart[2:]])
    interval = np.clip(np.searchsorted(rows, x) - 1, 0, len(rows) - 2)
    return quintic(x), np.where(np.isin(x, rows), 0.0, bound[interval])


@dataclass(frozen=True)
class _Judged:
    """What comes of one column."""

    verdict: Verdict
    unjudged: int
    """Rows the table is too coarse to judge."""
    x: np.ndarray
    error: np.ndarray
    bound: np.ndarray


def _judge(table: Reference, column: str, x: np.ndarray, values: np.ndarray, asked: float) -> _Judged:
    """Verdict on a column, with the error and the bound of every row."""
    expected, slack = interpolated(table.columns[table.abscissa], table.columns[column], x)
    scale = float(np.max(np.abs(table.columns[column]))) or 1.0
    known = np.hypot(table.uncertainty[column], slack)
    error = np.abs(values - expected) / scale
    bound = asked + 2 * known / scale
    # A row beyond even the wide bound is wrong whatever the table's coarseness.
    judged = (bound <= 2 * asked) | (error > bound)
    unjudged = int(np.sum(~judged))
    detail = f"{len(x)} rows; scale {scale:.6g}"
    if unjudged:
        detail += f"; {unjudged} lie where the table is too coarse to judge to {asked:g}"
    if not np.any(judged):
        detail += f": give the curve at the table's own {table.abscissa}, or claim a lesser accuracy"
        judged[:] = True
    i = int(np.argmax(np.where(judged, error / bound, -1)))
    verdict = Verdict(
        check=f"{table.name}:{column}",
        kind="curve",
        passed=unjudged < len(x) and bool(np.all(error[judged] <= bound[judged])),
        statement=f"{column} over {table.abscissa} against {table.source}",
        detail=detail,
        error=float(error[i]),
        bound=float(bound[i]),
        asked=float(asked),
        reference_uncertainty=float(known[i] / scale),
        where=f"{table.abscissa} = {x[i]:g}",
        reference=table.name,
    )
    return _Judged(verdict, unjudged, x, error, bound)


def _picture(
    table: Reference, column: str, own: Mapping[str, np.ndarray], judged: _Judged, panels: Sequence[Panel]
) -> PanelOutcome:
    """The column over the table's abscissa; on the paper's axes, where the case draws just that."""
    over = table.abscissa
    paper = next((p for p in panels if (p.x.name, p.y.name) == (over, column)), None)
    labels = [LABELS.get(name, name.replace("_", " ")) for name in (over, column)]
    ranges = [_range(table.columns[name], own[name]) for name in (over, column)]
    if paper is not None:
        ranges = [(axis.low, axis.high) for axis in (paper.x, paper.y)]
    return PanelOutcome(
        name=column,
        title=f"{column} of the curve against {table.name}",
        x=over,
        y=column,
        x_label=labels[0],
        y_label=labels[1],
        x_range=ranges[0],
        y_range=ranges[1],
        drawn="the curve",
        curves=[
            CurveOutcome(
                name=table.name,
                label=table.name,
                x=own[over].tolist(),
                y=own[column].tolist(),
                reference_name=table.name,
                reference_kind=table.kind,
                reference_x=table.columns[over].tolist(),
                reference_y=table.columns[column].tolist(),
                residual_abscissa=over,
                residual_x=judged.x.tolist(),
                residual=judged.error.tolist(),
                residual_bound=judged.bound.tolist(),
            )
        ],
    )


def _range(*columns: np.ndarray) -> tuple[float, float]:
    values = np.concatenate(columns)
    margin = 0.03 * float(np.ptp(values))
    return float(values.min()) - margin, float(values.max()) + margin
