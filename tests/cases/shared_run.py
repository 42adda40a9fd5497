"""One run of the suite, whose cases are solved and judged by several processes."""

import fcntl
import os
from pathlib import Path

import pytest

from weakforms.verification.discovery import FoundCase
from weakforms.verification.outcome import CaseOutcome
from weakforms.verification.runner import Plan, Solver, judge_case, solution_key
from weakforms.verification.specs import Spec


class SharedRun:
    """Solutions of the cases selected, and what the cases make of them.

    A solution goes into a folder that all workers share, under a lock: whoever needs it first solves it.

    Args:
        cases: The cases selected; together they say which states are wanted of a solution.
        folder: Where solutions are stored.
    """

    def __init__(self, cases: list[FoundCase], folder: Path) -> None:
        self.cases = {found.id: found for found in cases}
        self.plan, self.folder = Plan.of(cases), folder
        self.outcomes: dict[str, CaseOutcome] = {}
        folder.mkdir(exist_ok=True)

    def outcome(self, case: str) -> CaseOutcome:
        """Verdicts of a case; its solutions that another worker is solving come last."""
        if case not in self.outcomes:
            solver = Solver(self.folder / "solutions", resume=True)
            for spec in [s for s in self.plan.by_case[case] if not self.solve(s, solver, wait=False)]:
                self.solve(spec, solver, wait=True)
            self.outcomes[case] = judge_case(self.cases[case], self.plan, solver)
        return self.outcomes[case]

    def solve(self, spec: Spec, solver: Solver, wait: bool) -> bool:
        """Solve, or take what is stored; False where another worker is at it."""
        states = self.plan.states[spec]
        with (self.folder / f"{solution_key(spec, states)}.lock").open("a") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
            except BlockingIOError:
                return False
            if os.fstat(lock.fileno()).st_size:  # or every check of the case would crash a worker
                pytest.fail(f"{spec}: its solve began and never ended; see what failed first", pytrace=False)
            lock.write("begun")
            lock.flush()
            solver.run(Plan({spec: states}, {}))
            lock.truncate(0)
        return True
