"""What all checks have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, ClassVar

from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.outcome import Convergence, Printed, Verdict
from weakforms.verification.run.solutions import Solutions

Wanted = tuple[Spec, At | None]
"""A solution, and a state of it where one is needed."""

Judged = Iterable[Verdict | Printed | Convergence]
"""What a check leaves: verdicts, entries of the ledger, refinement histories."""


class Check(ABC):
    """A statement that solutions can contradict."""

    verdict_kind: ClassVar[str]
    """Kind of its verdicts."""

    @abstractmethod
    def wants(self, paper: int | str) -> list[Wanted]:
        """Solutions and states that must be there before it judges."""

    @abstractmethod
    def names(self, paper: int | str) -> list[str]:
        """What its verdicts will be called; known before anything is solved."""

    @abstractmethod
    def judge(self, paper: int | str, solutions: Solutions) -> Judged:
        """Judge it by solutions.

        Args:
            paper: Whose tables it is held against.
            solutions: That have all it wants.
        """

    def verdict(self, name: str, passed: bool, statement: str, detail: str = "", **numbers: Any) -> Verdict:
        """A verdict of this check's kind."""
        return Verdict(name, self.verdict_kind, bool(passed), statement, detail, **numbers)
