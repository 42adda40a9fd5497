"""Check of a curve: a branch or a profile, compared with its table at the rows of the table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from weakforms.errors import InputError
from weakforms.verification.cases import references
from weakforms.verification.cases.references import Reference
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.bounds import Comparison, compare
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions


@dataclass(frozen=True)
class Curve(Check):
    """A branch over two of its columns, or with ``at`` a profile of one of its states."""

    of: Spec
    label: str
    reference: str | None = None
    at: At | None = None
    y: str | None = None
    """Drawn column, if a panel shows several (``None``: the column of the panel)."""
    branch: str = "primary"
    """Branch of the curve; a profile belongs to the branch of its state."""
    asked: Mapping[str, float] | None = None
    """Relative accuracy asked of the columns of its table, if it differs from the case's accuracy."""
    columns: Mapping[str, str] = field(default_factory=dict)
    """Column of the solution by column of the table, if the names differ."""

    @property
    def verdict_kind(self) -> str:
        """The kind of the verdicts; a profile is a field."""
        return "curve" if self.at is None else "field"

    def wants(self, paper: int | str) -> list[Wanted]:
        """A state at each row of its table, or one state with its profile there."""
        table = self.table(paper)
        if self.at is not None:
            return [(self.of, self.shown_at(table))]
        if table is None:
            return [(self.of, None)]
        rows = table.columns[table.abscissa]
        return [(self.of, None), *((self.of, self.row_at(table, float(v))) for v in rows)]

    def names(self, paper: int | str) -> list[str]:
        """One for each column of the table with an accuracy.

        Raises:
            InputError: If no column has an accuracy.
        """
        table = self.table(paper)
        judged = [] if table is None else self.judged_columns(table)
        if table is not None and not judged:
            raise InputError(f"table {table.name}: the case states no accuracy for any of its columns")
        return [f"{table.name}:{column}" for column in judged]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Judge whether every row of every column agrees with the table."""
        table = self.table(paper)
        for column, found in self.comparisons(paper, solutions).items():
            i, places = found.worst, table.columns[table.abscissa]
            at = "" if self.at is None else f" at {self.at}"
            yield self.verdict(
                f"{table.name}:{column}",
                found.passed(self.asked[column]),
                f"{column} over {table.abscissa} for {self.of}{at}",
                f"{len(table)} rows; scale {found.scale:.6g}",
                error=float(found.error[i]),
                bound=float(found.bound[i]),
                asked=self.asked[column],
                widest=float(np.max(found.bound)),
                uncertainty=float(found.uncertainty[i]),
                reference_uncertainty=found.reference_uncertainty,
                where=f"{table.abscissa} = {places[i]:g}",
                reference=table.name,
            )

    def table(self, paper: int | str) -> Reference | None:
        """The table of the curve, after a check of its parameters."""
        return None if self.reference is None else references.load_curve(paper, self.reference, self.of)

    def judged_columns(self, table: Reference) -> list[str]:
        """Columns of the table with an accuracy."""
        return [name for name in table.ordinates if name in (self.asked or {})]

    def comparisons(self, paper: int | str, solutions: Solutions) -> dict[str, Comparison]:
        """Comparison of each column with the table, row by row."""
        table = self.table(paper)
        found = {}
        for name in [] if table is None else self.judged_columns(table):
            values, uncertainty = self._values(table, name, solutions)
            found[name] = compare(values, uncertainty, table.columns[name], table.uncertainty[name])
        return found

    def _values(
        self, table: Reference, name: str, solutions: Solutions
    ) -> tuple[np.ndarray, np.ndarray | float]:
        name = self.columns.get(name, name)
        if self.at is not None:
            return solutions.sampled(self.of, self.shown_at(table), name)
        places = [self.row_at(table, float(v)) for v in table.columns[table.abscissa]]
        rows = [solutions.quantity(self.of, place, name) for place in places]
        return np.array([q.value for q in rows]), np.array([q.uncertainty for q in rows])

    def row_at(self, table: Reference, value: float) -> At:
        """The state at a row of the table."""
        return At(table.abscissa, value, branch=self.branch)

    def shown_at(self, table: Reference | None) -> At:
        """The state of a profile, sampled at the rows of its table."""
        points = () if table is None else tuple(float(v) for v in table.columns[table.abscissa])
        if table is not None and table.meridian is not None:
            return replace(self.at, profile=points, theta=table.meridian)
        return replace(self.at, profile=points)
