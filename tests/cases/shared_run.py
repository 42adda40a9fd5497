"""One run of the suite: several processes solve and judge its cases."""

import fcntl
from pathlib import Path

import pytest

from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging.outcome import CaseOutcome
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.runner import judge_case
from weakforms.verification.run.solving import Solver, solution_key


class SharedRun:
    """Solutions of the selected cases and the verdicts on them.

    Solutions are stored in a folder that all workers share. Under a lock, the first worker that needs a
    solution computes it.

    Args:
        cases: The selected cases; together they determine which states a solution must have.
        folder: Where solutions are stored.
    """

    def __init__(self, cases: list[FoundCase], folder: Path) -> None:
        self.cases = {found.id: found for found in cases}
        self.plan, self.folder = Plan.of(cases), folder
        self.outcomes: dict[str, CaseOutcome] = {}
        (folder / "solutions").mkdir(parents=True, exist_ok=True)

    def outcome(self, case: str) -> CaseOutcome:
        """Verdicts of a case; while others solve its problems, this worker solves those needed later."""
        if case not in self.outcomes:
            solver = Solver(self.folder / "solutions", resume=True)
            left = self.plan.by_case[case]
            for later in [None, *self.plan.states]:
                if later and not (self.path(later).exists() or self.begun(later)):
                    self.solve(later, solver, wait=False)
                left = [spec for spec in left if not self.solve(spec, solver, wait=False)]
                if not left:
                    break
            for spec in left:
                self.solve(spec, solver, wait=True)
            self.outcomes[case] = judge_case(self.cases[case], self.plan, solver)
        return self.outcomes[case]

    def path(self, spec: Spec, ending: str = "json") -> Path:
        """Where a solution is stored; a file beside it names the worker that solves it."""
        return self.folder / "solutions" / f"{solution_key(spec, self.plan.states[spec])}.{ending}"

    def begun(self, spec: Spec) -> bool:
        """Whether a worker is solving this, or died while solving it."""
        lock = self.path(spec, "lock")
        return lock.exists() and lock.stat().st_size > 0

    def solve(self, spec: Spec, solver: Solver, wait: bool) -> bool:
        """Solve, or use the stored solution; False if another worker is solving it."""
        states = self.plan.states[spec]
        with self.path(spec, "lock").open("a") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
            except BlockingIOError:
                return False
            if self.begun(spec):  # or every check of the case would crash a worker
                pytest.fail(f"{spec}: its solve began and never ended; see what failed first", pytrace=False)
            lock.write("begun")
            lock.flush()
            solver.run(Plan({spec: states}, {}))
            lock.truncate(0)
        return True
