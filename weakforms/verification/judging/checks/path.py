"""Check of the paths of material points over a series of states, compared with a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from weakforms.verification.cases import references
from weakforms.verification.cases.references import Reference
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.bounds import compare
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions


@dataclass(frozen=True)
class Path(Check):
    """Paths of material points of a body over the states at the rows of a table; drawn dotted.

    The table has a column ``NAME_X`` for each coordinate of each point, such as ``rho_0.1`` for the radius
    of the point ``X = 0.1``.
    """

    of: Spec
    reference: str
    points: tuple[float, ...]
    """Material coordinates of the points that are drawn and compared."""
    asked: Mapping[str, float] | None = None
    """Relative accuracy asked of each coordinate (``None``: of the case)."""

    verdict_kind: ClassVar[str] = "curve"

    def wants(self, paper: int | str) -> list[Wanted]:
        """The state of each row, sampled at the points."""
        return [(self.of, at) for at in self.states(paper)]

    def names(self, paper: int | str) -> list[str]:
        """One for each point and coordinate."""
        return [f"{self.reference}:{column}" for column, _, _ in self._judged(self._table(paper))]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Judge whether every row of every path agrees with the table."""
        table, places = self._table(paper), self.states(paper)
        for column, name, point in self._judged(table):
            ours = [solutions.samples(self.of, at, name)[self.points.index(point)] for at in places]
            values, spread = (np.array([getattr(x, k) for x in ours]) for k in ("value", "uncertainty"))
            found = compare(values, spread, table.columns[column], table.uncertainty[column])
            i = found.worst
            yield self.verdict(
                f"{table.name}:{column}",
                found.passed(self.asked[name]),
                f"{name} of the point X = {point:g} over {table.abscissa} for {self.of}",
                f"{len(table)} rows; scale {found.scale:.6g}",
                error=float(found.error[i]),
                bound=float(found.bound[i]),
                asked=self.asked[name],
                widest=float(np.max(found.bound)),
                uncertainty=float(found.uncertainty[i]),
                reference_uncertainty=found.reference_uncertainty,
                where=str(places[i]),
                reference=table.name,
            )

    def states(self, paper: int | str) -> list[At]:
        """The states of the table, in its order."""
        table = self._table(paper)
        return [At(table.abscissa, float(v), profile=self.points) for v in table.columns[table.abscissa]]

    def _table(self, paper: int | str) -> Reference:
        return references.load_curve(paper, self.reference, self.of)

    def _judged(self, table: Reference) -> list[tuple[str, str, float]]:
        """Column, coordinate and point of each path of the table that is compared."""
        split = [(column, *column.rpartition("_")[::2]) for column in table.ordinates]
        return [(column, name, float(x)) for column, name, x in split if float(x) in self.points]
