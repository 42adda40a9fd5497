"""Checks of the ledger: numbers printed in the papers, reproduced to all digits or explained otherwise."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.checks.readings import Reading, decoding, rounds_to
from weakforms.verification.judging.outcome import Printed as Entry
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions


class LedgerCheck(Check):
    """A printed number, with one verdict and one entry in the ledger."""

    what: str
    printed: str
    source: str
    """Place in the paper."""

    verdict_kind: ClassVar[str] = "printed"

    def names(self, paper: int | str) -> list[str]:
        """The name of the printed number."""
        return [f"printed:{self.what}"]

    def _entry(self, value: float, uncertainty: float, status: str, evidence: str) -> Entry:
        return Entry(self.what, self.printed, value, uncertainty, status, evidence, self.source)

    def _digits(
        self, value: float, uncertainty: float, reading: Reading | None, evidence: str
    ) -> Iterator[Verdict | Entry]:
        """Verdict and entry of a printed number, compared with a computed one."""
        status = "reproduced" if rounds_to(value, uncertainty, self.printed) else "not reproduced"
        wanted, said = "reproduced", f"{self.what} is printed as {self.printed} ({self.source})"
        if reading is not None:
            proven = status != "reproduced" and reading.proven(value, uncertainty, self.printed)
            status = reading.status if proven else f"{reading.status}, not proven"
            wanted, said = reading.status, f"{said}: {reading.status}"
            evidence = "; ".join(filter(None, (evidence, reading.explained())))
        (name,) = self.names(0)
        yield self.verdict(name, status == wanted, said, evidence)
        yield self._entry(value, uncertainty, status, evidence)


@dataclass(frozen=True)
class Printed(LedgerCheck):
    """A number printed in the paper: reproduced to all its digits, or explained otherwise with a proof."""

    what: str
    printed: str
    of: Spec
    kind: str
    """Kind of special point it belongs to."""
    column: str
    source: str
    index: int = 0
    reading: Reading | None = None
    """The explanation, if it is not the number rounded to its digits."""

    def wants(self, paper: int | str) -> list[Wanted]:
        """The solution that has the point."""
        return [(self.of, None)]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict | Entry]:
        """Judge whether the number of the point is the printed one."""
        points = solutions.points(self.of, self.kind)
        if self.index >= len(points):
            (name,) = self.names(paper)
            said = f"{self.what} is printed as {self.printed}"
            yield self.verdict(name, False, said, f"there is no such {self.kind}")
            return
        point = points[self.index]
        value, spread = point.values[self.column], point.uncertainty[self.column]
        evidence = f"computed {value:.10g} with uncertainty {spread:.1e}"
        yield from self._digits(value, spread, self.reading, evidence)


@dataclass(frozen=True)
class PrintedExact(LedgerCheck):
    """A printed number with a closed form: reproduced to all its digits, or explained otherwise."""

    what: str
    printed: str
    exact: float
    evidence: str
    source: str
    reading: Reading | None = None

    def wants(self, paper: int | str) -> list[Wanted]:
        """Nothing, because no solution is needed."""
        return []

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict | Entry]:
        """Judge whether the value of the closed form is the printed one."""
        yield from self._digits(self.exact, 0.0, self.reading, self.evidence)


@dataclass(frozen=True)
class PrintedInput(LedgerCheck):
    """A printed number that is an input of a figure: the value that it implies, and whether this is round."""

    what: str
    printed: str
    of: Spec
    at: At
    column: str
    searched: tuple[float, ...]
    """Ascending round values that ``column`` may have if the printed number comes from a computation."""
    within: float
    """Relative distance from a round value within which the column counts as this value."""
    source: str
    decoded: bool = True
    """Whether the case states that it is decoded, or that it lies between two of the values and is
    neither."""

    def wants(self, paper: int | str) -> list[Wanted]:
        """The state for the input."""
        return [(self.of, self.at)]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict | Entry]:
        """Judge whether the state's ``column`` is one of the round values, or is shown to be none of them."""
        found = solutions.quantity(self.of, self.at, self.column)
        near = min(self.searched, key=lambda value: abs(found.value - value))
        low, high = self.searched[0], self.searched[-1]
        where = f"{low:g}" if low == high else f"{len(self.searched)} round values from {low:g} to {high:g}"
        evidence = (
            f"implies {self.column} = {found.value:.6g}, "
            f"{100 * (found.value / near - 1):+.2g} % from {near:g}; "
            f"searched: {where}, each within {100 * self.within:g} %"
        )
        status = decoding(found.value, found.uncertainty, self.searched, self.within)
        passed = status == ("input, decoded" if self.decoded else "input, not decoded")
        is_one = "is" if self.decoded else "is not"
        said = f"{self.what}, printed as {self.printed} ({self.source}), {is_one} "
        (name,) = self.names(paper)
        yield self.verdict(name, passed, f"{said}the value at a round {self.column}", evidence)
        yield self._entry(found.value, found.uncertainty, status, evidence)


@dataclass(frozen=True)
class PrintedState(LedgerCheck):
    """A printed number at which a figure shows a state: the state exists on the branch of the paper."""

    what: str
    printed: str
    of: Spec
    at: At
    column: str
    """The column whose value is printed; the state is requested at this value."""
    shown: tuple[str, ...]
    """Columns that identify the state in the ledger."""
    n_negative: int
    """Number of negative eigenvalues in the symmetric space, which distinguishes parts of the branch."""
    source: str

    def wants(self, paper: int | str) -> list[Wanted]:
        """The state of the figure."""
        return [(self.of, self.at)]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict | Entry]:
        """Judge whether the state exists, with the stated number of negative eigenvalues."""
        values = solutions.state(self.of, self.at).quantities
        found, negative = values[self.column], values["n_negative"].value
        placed = rounds_to(found.value, found.uncertainty, self.printed) and negative == self.n_negative
        numbers = ", ".join(f"{name} = {values[name].value:.6g}" for name in self.shown)
        evidence = f"on the {self.at.branch} branch with {negative:g} negative eigenvalues: {numbers}"
        said = (
            f"there is a state with {self.what} {self.printed} ({self.source}) on the {self.at.branch} "
            f"branch with {self.n_negative} negative eigenvalues"
        )
        (name,) = self.names(paper)
        yield self.verdict(name, placed, said, evidence)
        status = "input, placed" if placed else "input, not placed"
        yield self._entry(found.value, found.uncertainty, status, evidence)
