"""Checks of special points and of single states: their count, and their numbers compared with tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from weakforms.results import SpecialPoint
from weakforms.verification.cases import references
from weakforms.verification.cases.references import Reference
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.bounds import compare
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions


@dataclass(frozen=True)
class Count(Check):
    """Number of special points of a kind on the primary branch."""

    kind: str
    expected: Mapping[Spec, int]
    statement: str

    verdict_kind: ClassVar[str] = "count"

    def wants(self, paper: int | str) -> list[Wanted]:
        """The solutions whose points are counted."""
        return [(spec, None) for spec in self.expected]

    def names(self, paper: int | str) -> list[str]:
        """One name for each solution."""
        return [f"count_{self.kind}:{spec}" for spec in self.expected]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Judge whether each solution has exactly the expected number."""
        for name, (spec, expected) in zip(self.names(paper), self.expected.items(), strict=True):
            found = len(solutions.points(spec, self.kind))
            statement, detail = f"{self.statement} ({spec})", f"expected {expected}, found {found}"
            yield self.verdict(name, found == expected, statement, detail)


class TableOfPoints(Check):
    """Numbers of some points, each compared with a row of a table."""

    verdict_kind: ClassVar[str] = "point"

    def _against(
        self, table: Reference, row: int, point: SpecialPoint, column: str, label: str, asked: float
    ) -> Verdict:
        """Verdict on one number of one point."""
        ours, theirs = point.values[column], table.columns[column][row]
        found = compare(ours, point.uncertainty[column], theirs, table.uncertainty[column])
        return self.verdict(
            _named(table.name, label, column),
            found.passed(asked),
            f"{column} of {point.kind} of {label}",
            f"computed {ours:.12g}, reference {theirs:.12g}",
            error=float(found.error[0]),
            bound=float(found.bound[0]),
            asked=asked,
            uncertainty=float(found.uncertainty[0]),
            reference_uncertainty=found.reference_uncertainty,
            reference=table.name,
        )


def _named(table: str, label: str, column: str) -> str:
    return f"{table}:{label}:{column}"


@dataclass(frozen=True)
class Points(TableOfPoints):
    """Special points, compared with a table with one row for each (``quantity``: quantities of the problem).

    The table's columns that are parameters of the problem select the solution, ``order`` the point on it.
    """

    kind: str
    reference: str
    base: Spec
    parameters: tuple[str, ...]
    asked: Mapping[str, float]
    where: Mapping[str, float] = field(default_factory=dict)
    """Values of columns of the table; only rows with these values are used."""
    branch: str = ""
    """Only points of this branch; empty for all."""

    def wants(self, paper: int | str) -> list[Wanted]:
        """The solution of each row."""
        return [(spec, None) for spec, _, _ in self._rows(paper)]

    def names(self, paper: int | str) -> list[str]:
        """One name for each row and column."""
        return [
            _named(self.reference, self._label(spec, index), column)
            for spec, _, index in self._rows(paper)
            for column in self.asked
        ]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Judge whether each point exists, with the numbers of its row."""
        table = references.load(paper, self.reference)
        for spec, row, index in self._rows(paper):
            points, label = self._selected(solutions.points(spec, self.kind)), self._label(spec, index)
            for column, asked in self.asked.items():
                if index < len(points):
                    yield self._against(table, row, points[index], column, label, asked)
                else:
                    yield self._missing(column, label, len(points))

    def _rows(self, paper: int | str) -> Iterator[tuple[Spec, int, int]]:
        """Spec, row of the table and index of the point for each row."""
        table = references.load(paper, self.reference)
        for row in range(len(table)):
            if any(table.columns[name][row] != value for name, value in self.where.items()):
                continue
            given = {name: float(table.columns[name][row]) for name in self.parameters}
            order = int(table.columns["order"][row]) if "order" in table.columns else 1
            yield self.base.at(**given), row, order - 1

    def _label(self, spec: Spec, index: int) -> str:
        chosen = [f"{name}={value:g}" for name, value in self.where.items()]
        return f"{spec}[{', '.join([*chosen, str(index + 1)])}]"

    def _selected(self, points: list[SpecialPoint]) -> list[SpecialPoint]:
        """The points with given values (such as a wave number)."""
        here = [p for p in points if self.branch in ("", p.branch)]
        return [p for p in here if all(p.values.get(k, v) == v for k, v in self.where.items())]

    def _missing(self, column: str, label: str, found: int) -> Verdict:
        name, statement = _named(self.reference, label, column), f"{column} of {self.kind} of {label}"
        missing = f"missing: the branch has {found}"
        return self.verdict(name, False, statement, missing, reference=self.reference)


@dataclass(frozen=True)
class States(TableOfPoints):
    """States, compared with a table with one row for each.

    The table's columns that are parameters of the problem select the solution, ``at`` the state of it.
    """

    reference: str
    base: Spec
    parameters: tuple[str, ...]
    at: At
    asked: Mapping[str, float]

    def wants(self, paper: int | str) -> list[Wanted]:
        """The state of each row."""
        return [(spec, self.at) for spec in self._rows(paper)]

    def names(self, paper: int | str) -> list[str]:
        """One name for each row and column."""
        return [_named(self.reference, str(spec), c) for spec in self._rows(paper) for c in self.asked]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Judge whether each state has the numbers of its row."""
        table = references.load(paper, self.reference)
        for row, spec in enumerate(self._rows(paper)):
            quantities = solutions.state(spec, self.at).quantities
            values = {name: quantities[name].value for name in self.asked}
            spread = {name: quantities[name].uncertainty for name in self.asked}
            point = SpecialPoint(f"state at {self.at}", self.at.branch, "", values, spread)
            for column, asked in self.asked.items():
                yield self._against(table, row, point, column, str(spec), asked)

    def _rows(self, paper: int | str) -> list[Spec]:
        table = references.load(paper, self.reference)
        given = [{name: float(table.columns[name][i]) for name in self.parameters} for i in range(len(table))]
        return [self.base.at(**parameters) for parameters in given]
