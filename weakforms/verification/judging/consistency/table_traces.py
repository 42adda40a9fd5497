"""Is the trace that a user takes away right: its own points against a table, between the table's rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from weakforms.results import Branch
from weakforms.verification.cases.references import Reference
from weakforms.verification.crosscheck.rows import interpolated
from weakforms.verification.judging.bounds import compare
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.checks.curve import Curve
from weakforms.verification.judging.consistency.traces import SHARP, is_judged, worst
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions

ENDS = 2
"""Intervals at either end of a table in which its interpolation is not relied on."""

SAFETY = 3.0
"""Factor of what interpolating a table may add: that is told for smooth columns, and these have kinks."""

RESOLVED = SHARP / 20
"""Error of a table's interpolation, as two splines show it, below which the table counts as dense. Where they
show more, they are no longer near enough to the curve for their difference to be an error bound."""

DENSE = 0.5
"""Part of a table's intervals that must be resolved for a column to be interpolated at all: the few that are
in a coarse table may lie between two points of a trace, and may look resolved by accident."""

EXTREMES = ("gw_min", "gw_max", "t_min", "t2_min", "T_min", "z_min", "r_max", "spring_max", "traction_max")
"""Columns that have a kink wherever their place on the body jumps or reaches an end, which a spline through a
table does not know: they are held against states only."""

LEAST_ROWS = 9
"""Rows of a table that is interpolated."""


@dataclass(frozen=True)
class TableTrace(Check):
    """The trace a curve is drawn from, where its table is dense enough to tell an error of one percent."""

    curve: Curve

    verdict_kind: ClassVar[str] = "trace"

    def wants(self, paper: int | str) -> list[Wanted]:
        """The solution that has the trace."""
        return [(self.curve.of, None)]

    def names(self, paper: int | str) -> list[str]:
        """One, or none where there is no table or it is too coarse."""
        if self.curve.at is not None or not is_judged(self.curve.of):
            return []
        table = self.curve.table(paper)
        return [] if table is None else table_names(table, self._columns(table))

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Points of the trace lie on the table's interpolation."""
        if not self.names(paper):
            return
        table = self.curve.table(paper)
        columns = [table.abscissa, *self._columns(table)]
        called = {name: self.curve.columns.get(name, name) for name in columns}
        branch = solutions.branch(self.curve.of, self.curve.branch)
        yield from against_table(branch, table, called)

    def _columns(self, table: Reference) -> list[str]:
        """Columns that a trace has, too: fronts of zones belong to states."""
        return [name for name in self.curve.judged_columns(table) if "_front_" not in name]


def table_names(table: Reference, columns: Iterable[str]) -> list[str]:
    """What the verdict on a trace against a table will be called; none where the table is too coarse."""
    return [f"trace:{table.name}"] if any(len(_dense(table, name)) for name in columns) else []


def _dense(table: Reference, name: str) -> np.ndarray:
    """Rows, in rising order of the abscissa, after which the table interpolates a column sharply.

    None where fewer than the part :data:`DENSE` of them does.
    """
    rows, values = np.sort(table.columns[table.abscissa]), table.columns[name]
    if len(rows) < LEAST_ROWS or name in EXTREMES:
        return np.array([], int)
    _, slack = interpolated(table.columns[table.abscissa], values, (rows[:-1] + rows[1:]) / 2)
    known = 2 * np.hypot(SAFETY * slack, table.uncertainty[name])
    known[:ENDS] = known[-ENDS:] = np.inf
    resolved = np.flatnonzero(known <= RESOLVED * np.max(np.abs(values)))
    return resolved if len(resolved) >= DENSE * len(known) else resolved[:0]


def against_table(branch: Branch, table: Reference, called: Mapping[str, str]) -> list[Verdict]:
    """Verdict on points of a trace where a table is dense and the abscissa is met for the first time.

    Args:
        branch: The trace.
        table: Over one of its columns.
        called: The trace's column for each of the table's that are judged, and for its abscissa.
    """
    judged = [name for name in table.ordinates if name in called]
    if not table_names(table, judged):
        return []
    rows = np.sort(table.columns[table.abscissa])
    along = np.asarray(branch.columns[called[table.abscissa]], float)
    highest, lowest = np.maximum.accumulate(along), np.minimum.accumulate(along)
    first = np.r_[True, (along[1:] > highest[:-1]) | (along[1:] < lowest[:-1])]
    inside = first & (along >= rows[0]) & (along < rows[-1])
    interval = np.where(inside, np.searchsorted(rows, along, "right") - 1, -1)
    found = []
    for name in judged:
        here = np.flatnonzero(np.isin(interval, _dense(table, name)))
        expected, slack = interpolated(table.columns[table.abscissa], table.columns[name], along[here])
        values, own = _with_spread(branch, called[name], called[table.abscissa], here)
        known = np.hypot(SAFETY * slack, table.uncertainty[name])
        size = float(np.max(np.abs(table.columns[name])))
        for i, *numbers in zip(here, values, own, expected, known, strict=True):
            place = f"{table.abscissa} = {along[i]:.6g}"
            found.append((f"{name} ({branch.name})", place, compare(*numbers, size or 1.0)))
    statement = f"points of the trace between the rows of the table, over {table.abscissa}"
    return [worst(f"trace:{table.name}", statement, found, table.name)]


def _with_spread(branch: Branch, name: str, over: str, here: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A column at some points, and its uncertainty at a fixed value of the column it is looked at over."""
    y, x = np.asarray(branch.columns[name], float), np.asarray(branch.columns[over], float)
    none = np.full(len(y), np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):  # a point that stands twice, which is not looked at
        slope = np.gradient(y, x, edge_order=1)
        spread = np.hypot(branch.uncertainty.get(name, none), slope * branch.uncertainty.get(over, none))
    return y[here], spread[here]
