"""Check of the observed order of convergence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from weakforms.verification.cases import references
from weakforms.verification.cases.references import Reference
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging import decide
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.numbers import Number, stack
from weakforms.verification.judging.outcome import Convergence, Verdict
from weakforms.verification.run.solutions import Solutions


@dataclass(frozen=True)
class Order(Check):
    """Observed order of convergence of a quantity with the mesh, one verdict for each degree."""

    quantity: str
    of: Spec
    expected: Mapping[int, float]
    """Order by polynomial degree."""
    cells: tuple[int, ...]
    at: At | None = None
    kind: str = ""
    """Special point whose value it is, if there is no ``at``."""
    reference: str = ""
    """Table with the exact value."""
    row: int = 0
    """Row of the table, and index of the point, if there is no ``at``."""
    column: str = ""
    """Column of the profile or of the point; ``quantity`` is its readable name."""

    verdict_kind: ClassVar[str] = "order"

    def wants(self, paper: int | str) -> list[Wanted]:
        """A solution on each mesh, for each degree."""
        at = self._sampled_at(paper)
        return [(self._on(degree, cells), at) for degree in self.expected for cells in self.cells]

    def names(self, paper: int | str) -> list[str]:
        """One name for each degree."""
        return [f"order:{self.quantity}:P{degree}" for degree in self.expected]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict | Convergence]:
        """Judge whether errors relative to the table decrease at the expected order or faster."""
        table, at = references.load(paper, self.reference), self._sampled_at(paper)
        for called, (degree, expected) in zip(self.names(paper), self.expected.items(), strict=True):
            errors = stack(self._error(table, self._on(degree, n), at, solutions) for n in self.cells)
            what = f"{self.quantity}, P{degree}"
            found = decide.order(what, self.cells, errors, expected)
            statement = f"{what} converges at order {expected:g} or better"
            yield self.verdict(called, found.holds, statement, found.detail, reference=table.name)
            coarse, fine = errors.value[-2:]
            yield Convergence(
                quantity=self.quantity,
                degree=degree,
                cells=list(self.cells),
                errors=[float(e) for e in errors.value],
                observed_order=float(np.log(coarse / fine) / np.log(self.cells[-1] / self.cells[-2])),
                expected_order=expected,
                against=f"reference table {table.name}",
            )

    def _on(self, degree: int, cells: int) -> Spec:
        return self.of.on(degree=degree, cells=cells, levels=2)

    def _sampled_at(self, paper: int | str) -> At | None:
        """The state with its profile sampled at the rows of the table."""
        if self.at is None:
            return None
        table = references.load(paper, self.reference)
        return replace(self.at, profile=tuple(float(v) for v in table.columns[table.abscissa]))

    def _error(self, table: Reference, spec: Spec, at: At | None, solutions: Solutions) -> Number:
        """Relative error on one mesh, at a point or the largest in a profile; as uncertain as the table."""
        exact = table.number(self.column)
        if at is None:
            value = solutions.points(spec, self.kind)[self.row].values[self.column]
            return abs(value - exact[self.row]) * (1 / abs(exact.value[self.row]))
        values, _ = solutions.sampled(spec, at, self.column)
        return abs(values - exact).largest() * (1 / np.max(np.abs(exact.value)))
