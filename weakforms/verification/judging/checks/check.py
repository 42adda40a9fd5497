"""Base class of all checks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, ClassVar

from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.outcome import Convergence, Printed, Verdict
from weakforms.verification.run.solutions import Solutions

Wanted = tuple[Spec, At | None]
"""A solution, and a state of it if needed."""

Judged = Iterable[Verdict | Printed | Convergence]
"""The outcome of a check: verdicts, entries of the ledger, refinement histories."""


class Check(ABC):
    """A statement about solutions that can be false."""

    verdict_kind: ClassVar[str]
    """Kind of the verdicts."""

    @abstractmethod
    def wants(self, paper: int | str) -> list[Wanted]:
        """Solutions and states that the check needs."""

    @abstractmethod
    def names(self, paper: int | str) -> list[str]:
        """Names of the verdicts, which are known before anything is solved."""

    @abstractmethod
    def judge(self, paper: int | str, solutions: Solutions) -> Judged:
        """Judge the statement.

        Args:
            paper: Paper with the tables.
            solutions: Solutions, including all that the check needs.
        """

    def verdict(self, name: str, passed: bool, statement: str, detail: str = "", **numbers: Any) -> Verdict:
        """A verdict of this check's kind."""
        return Verdict(name, self.verdict_kind, bool(passed), statement, detail, **numbers)
