"""Checks of statements: claims of a paper on its solutions, and first integrals of the exact equations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging import decide
from weakforms.verification.judging.bounds import FACTOR
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.decide import Finding
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions


@dataclass(frozen=True)
class Claim(Check):
    """A statement of the paper that is true or false of some solutions.

    ``holds`` evaluates the solutions listed in ``needs`` and returns whether the claim is true, and the
    numbers.
    """

    name: str
    statement: str
    needs: tuple[Wanted, ...]
    holds: Callable[[Solutions], Finding]
    differs: str = ""
    """The different statement of the paper, if there is one, and why it is not true."""

    verdict_kind: ClassVar[str] = "claim"

    def wants(self, paper: int | str) -> list[Wanted]:
        """The listed solutions."""
        return list(self.needs)

    def names(self, paper: int | str) -> list[str]:
        """The name of the claim."""
        return [f"claim:{self.name}"]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Judge whether it is true, by the rules of :mod:`weakforms.verification.judging.decide`."""
        holds, detail = self.holds(solutions)
        (name,) = self.names(paper)
        yield self.verdict(name, holds, self.statement, detail, differs=self.differs)


@dataclass(frozen=True)
class Constant(Check):
    """A column of a profile that is constant in the exact solution (a first integral)."""

    column: str
    of: Spec
    at: At
    asked: float
    statement: str

    verdict_kind: ClassVar[str] = "exact"

    def wants(self, paper: int | str) -> list[Wanted]:
        """The state of the profile."""
        return [(self.of, self.at)]

    def names(self, paper: int | str) -> list[str]:
        """A name from column and state."""
        return [f"constant:{self.column}:{self.of}:{self.at}"]

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Judge whether the spread over the profile is within its uncertainty."""
        found = solutions.column(self.of, self.at, self.column)
        scale = float(np.max(np.abs(found.value)))
        uncertainty = float(np.max(found.uncertainty)) / scale
        (name,) = self.names(paper)
        yield self.verdict(
            name,
            decide.constant(self.column, found, self.asked).holds,
            self.statement,
            f"spread over {len(found)} points, relative to {scale:.6g}",
            error=float(np.ptp(found.value)) / scale,
            bound=FACTOR * uncertainty,
            asked=self.asked,
            uncertainty=uncertainty,
            reference_uncertainty=0.0,
            reference="exact first integral",
        )
