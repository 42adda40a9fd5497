"""Comparison of a column of a curve with the same column of a table, row by row."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from weakforms.errors import InputError
from weakforms.verification.cases.references import Reference
from weakforms.verification.judging.outcome import Verdict

PASSED, FAILED, NOT_JUDGED = "passed", "failed", "not judged"
EXIT_STATUS = {PASSED: 0, FAILED: 1, NOT_JUDGED: 5}
"""Exit status of a command by verdict."""

FLOOR = 0.01
"""Errors are divided at least by this fraction of the column's largest value over the range of the curve."""

FEWEST_ROWS = 3
"""Smallest number of judged rows for a verdict: two points are not a curve."""

ROUNDING = 4 * np.finfo(float).eps
"""Largest rounding error of an abscissa, relative to its size."""

NEAR = 32
"""The interpolation error grows from zero at a row to its bound within 1/32 of the interval."""


@dataclass
class ColumnVerdict(Verdict):
    """The verdict on one column of a curve.

    ``error`` and ``bound`` belong to the row with the largest ratio of error to bound. The row with the
    largest error, ``largest``, may be another one.
    """

    column: str = ""
    status: str = NOT_JUDGED
    """The verdict: passed, failed, or not judged."""
    rows: int = 0
    """Rows of the curve within the table's range."""
    judged_rows: int = 0
    signed_error: float | None = None
    """``error`` with its sign: positive if the curve lies above the table."""
    row: int | None = None
    """Row of the curve, from 1, to which ``error``, ``bound`` and ``where`` belong."""
    largest: dict[str, Any] | None = None
    """``error`` (signed), ``bound``, ``where`` and ``row`` of the largest error."""
    scale: str = ""
    """The value by which errors and bounds are divided."""
    scale_floor: float | None = None
    """The smallest value by which errors are divided, in the column's own scaling."""
    units: str = ""
    """The meaning of a constant ratio between curve and table, if there is one."""
    reached: float | None = None
    """The smallest accuracy that the curve could claim: with it every row is judged and within its bound."""
    claim: str = ""
    """What accuracy the curve may claim and how, if it claims none and does not pass without."""
    trend: str = ""
    """How the errors go along the curve, if the column is out of bounds."""
    causes: tuple[str, ...] = ()
    """Changes of the problem that explain the errors, if they were looked for and found."""
    rows_judged: dict[str, list[float]] = field(default_factory=dict)
    """Abscissa, signed error and bound of every row."""

    @property
    def unjudged_rows(self) -> int:
        """Number of rows at which the table is too uncertain for the accuracy asked."""
        return self.rows - self.judged_rows


@dataclass(frozen=True)
class JudgedColumn:
    """A verdict and the rows on which it is based."""

    verdict: ColumnVerdict
    x: np.ndarray = field(default_factory=lambda: np.zeros(0))
    expected: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """Values of the table at the curve's rows."""
    error: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """Signed errors, each divided by the scale of its row."""
    bound: np.ndarray = field(default_factory=lambda: np.zeros(0))
    known: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """Uncertainty of the table at each row, relative to the scale of the row."""

    @property
    def difference(self) -> np.ndarray:
        """Curve minus table at each row, in the column's own scaling."""
        size = np.maximum(np.abs(self.expected), self.verdict.scale_floor or 0.0)
        return self.error * size


def tolerance(rows: np.ndarray) -> float:
    """Largest rounding error of an abscissa of the size of the table's."""
    return ROUNDING * float(np.max(np.abs(rows)))


def interpolated(rows: np.ndarray, values: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Quintic spline through a table at ``x``, and a bound of its error (zero at the rows).

    Where the table resolves the curve, the quintic spline is more accurate than the cubic one. At the ends
    and in steep parts it may be less accurate. The bound is four times the largest distance between the two
    splines in the interval and its neighbours; it held for every function that was tried. Close to a row the
    error is proportional to the distance from the row, so that rounding of the abscissa adds little. The
    slope times that rounding is part of the bound.

    Raises:
        InputError: If the table has fewer than six rows, and ``x`` is not one of them.
    """
    order = np.argsort(rows)
    rows, values = rows[order], values[order]
    blur = tolerance(rows)
    if len(rows) < 6 or np.isin(x, rows).all():
        return _exact(rows, values, x, blur)
    from scipy.interpolate import make_interp_spline  # above, it would slow the start of every command

    quintic, cubic = (make_interp_spline(rows, values, k=k) for k in (5, 3))
    widths = np.diff(rows)
    inside = rows[:-1, None] + widths[:, None] * np.arange(1, 8) / 8
    apart = np.pad(np.abs(quintic(inside) - cubic(inside)).max(axis=1), 1)
    bound = 4 * np.maximum.reduce([apart[:-2], apart[1:-1], apart[2:]])
    interval = np.clip(np.searchsorted(rows, x) - 1, 0, len(rows) - 2)
    off = np.minimum(np.abs(x - rows[interval]), np.abs(x - rows[interval + 1]))
    slack = bound[interval] * np.minimum(1.0, NEAR * off / widths[interval])
    slack += np.where(off > 0, blur * np.abs(quintic.derivative()(x)), 0.0)
    return quintic(x), slack


def _exact(rows: np.ndarray, values: np.ndarray, x: np.ndarray, blur: float) -> tuple[np.ndarray, np.ndarray]:
    """Values of a table at its own rows, without interpolation; needed for a short table."""
    after = np.clip(np.searchsorted(rows, x), 1, len(rows) - 1)
    nearest = np.where(x - rows[after - 1] < rows[after] - x, after - 1, after)
    if np.any(np.abs(x - rows[nearest]) > blur):
        listed = ", ".join(f"{row:.12g}" for row in rows)
        raise InputError(
            f"a table of {len(rows)} rows is too short to interpolate: give the curve at its own, {listed}"
        )
    return values[nearest], np.zeros(len(x))


def scale_of(column: np.ndarray, covered: np.ndarray, expected: np.ndarray) -> tuple[np.ndarray, float]:
    """The value by which the error of each row is divided, and the smallest such value.

    This is the table's value at the row, but at least :data:`FLOOR` times its largest value over the range
    covered (or in the whole table, if the column is zero all over that range).

    Args:
        column: The whole column of the table.
        covered: The part of the column over the range that the curve covers.
        expected: The column at the curve's rows.
    """
    size = max(float(np.max(np.abs(part), initial=0.0)) for part in (covered, expected))
    floor = FLOOR * (size or float(np.max(np.abs(column)))) or 1.0
    return np.maximum(np.abs(expected), floor), floor


def judge_column(
    table: Reference, column: str, x: np.ndarray, values: np.ndarray, asked: float | None, numbers: np.ndarray
) -> JudgedColumn:
    """Judge a column, with the error and the bound of every row.

    A row is judged if its bound is at most twice the accuracy asked, or if its error exceeds even a wider
    bound. The column fails if any judged row does. It passes if more than half of its rows, and at least
    :data:`FEWEST_ROWS`, are judged. Otherwise it is not judged.

    Args:
        table: The reference.
        column: Name of the column.
        x: The curve's abscissa, within the table's range.
        values: The curve's column there.
        asked: Relative accuracy; ``None`` if none is claimed: then there is no verdict, and the accuracy that
            the curve reaches takes its place in the bounds.
        numbers: Number of each row in the curve, from 1.
    """
    rows = table.columns[table.abscissa]
    expected, slack = interpolated(rows, table.columns[column], x)
    covered = table.columns[column][(rows >= x.min()) & (rows <= x.max())]
    scale, floor = scale_of(table.columns[column], covered, expected)
    known = np.hypot(table.uncertainty[column], slack) / scale
    with np.errstate(over="ignore"):
        error = np.nan_to_num((values - expected) / scale)
    reached = float(np.max(np.maximum(np.abs(error) - 2 * known, 2 * known)))
    claim = reached if asked is None else asked
    bound = claim + 2 * known
    # A row beyond even the wide bound is wrong, however coarse the table is.
    judged = (bound <= 2 * claim) | (np.abs(error) > bound)
    count = int(np.sum(judged))
    if asked is None:
        status = NOT_JUDGED
    elif not np.all(np.abs(error[judged]) <= bound[judged]):
        status = FAILED
    elif count >= fewest(table) and 2 * count > len(x):
        status = PASSED
    else:
        status = NOT_JUDGED
    looked_at = judged if count else np.ones(len(x), dtype=bool)
    with np.errstate(over="ignore"):
        worst = int(np.argmax(np.where(looked_at, np.abs(error) / bound, -1.0)))
    largest = int(np.argmax(np.where(looked_at, np.abs(error), -1.0)))

    def described(i: int) -> dict[str, Any]:
        return {
            "error": float(error[i]),
            "bound": float(bound[i]),
            "where": f"{table.abscissa} = {x[i]:g}",
            "row": int(numbers[i]),
        }

    at = described(worst)
    verdict = ColumnVerdict(
        check=f"{table.name}:{column}",
        kind="curve",
        passed=status == PASSED,
        statement=f"{column} over {table.abscissa} against {table.source}",
        detail=_detail(table, status, len(x), count, asked, floor),
        error=abs(at["error"]),
        bound=at["bound"],
        asked=asked,
        reference_uncertainty=float(known[worst]),
        where=at["where"],
        reference=table.name,
        column=column,
        status=status,
        rows=len(x),
        judged_rows=count,
        signed_error=at["error"],
        row=at["row"],
        largest=described(largest),
        scale=scale_text(table.abscissa),
        scale_floor=floor,
        reached=reached,
        rows_judged={name: v.tolist() for name, v in (("x", x), ("error", error), ("bound", bound))},
    )
    return JudgedColumn(verdict, x, expected, error, bound, known)


def fewest(table: Reference) -> int:
    """Rows that must be judged for a verdict."""
    return min(FEWEST_ROWS, len(table))


def scale_text(abscissa: str) -> str:
    """The value by which errors are divided, in words."""
    return (
        f"the table's value at the row, but no less than {FLOOR:g} of its largest over the {abscissa} covered"
    )


def _detail(table: Reference, status: str, rows: int, judged: int, asked: float | None, floor: float) -> str:
    text = f"{rows} rows; errors are divided by {floor:.6g} at least"
    if asked is None:
        return text
    if judged < rows:
        text += f"; {rows - judged} lie where the table is too coarse to judge to {asked:g}"
    if status != NOT_JUDGED:
        return text
    if rows < fewest(table):
        return f"{text}: a verdict needs {fewest(table)} rows"
    return (
        f"{text}, and a verdict needs more than half of the rows, {fewest(table)} at least: "
        f"give the curve at the table's own {table.abscissa}, or claim a lower accuracy"
    )


def absent(table: Reference, column: str, asked: float | None, rows: int) -> JudgedColumn:
    """The verdict on a column that the table has and the curve does not have."""
    return JudgedColumn(
        ColumnVerdict(
            check=f"{table.name}:{column}",
            kind="curve",
            passed=False,
            statement=f"{column} over {table.abscissa} against {table.source}",
            detail=f"the curve has no column {column}: add it, or name the columns to judge with --column",
            asked=asked,
            reference=table.name,
            column=column,
            rows=rows,
            scale=scale_text(table.abscissa),
        )
    )


def met(rows: np.ndarray, x: np.ndarray) -> int:
    """Number of rows of a table that a curve covers: it has a row between their neighbours.

    Args:
        rows: The table's abscissa.
        x: The curve's.
    """
    rows, blur = np.sort(rows), tolerance(rows)
    before = np.r_[rows[0], rows[:-1]] - blur
    after = np.r_[rows[1:], rows[-1]] + blur
    x = np.sort(x)
    return int(np.sum(np.searchsorted(x, before, "left") < np.searchsorted(x, after, "right")))


def reached(x: np.ndarray, rows: np.ndarray) -> tuple[float, float]:
    """Ends of the part of the table between the first and the last row of the curve, up to rounding."""
    blur = tolerance(rows)
    ends = []
    for own, end in ((float(x.min()), float(rows.min())), (float(x.max()), float(rows.max()))):
        ends.append(end if math.isclose(own, end, rel_tol=0.0, abs_tol=blur) else own)
    return ends[0], ends[1]
