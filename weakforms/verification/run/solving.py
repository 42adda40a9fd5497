"""Solves a plan in parallel, and keeps solutions of the same code."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable
from concurrent.futures import as_completed
from functools import cache
from pathlib import Path
from typing import Any

from weakforms.errors import InputError, WeakformsError
from weakforms.results import Result, load_result, write_atomically
from weakforms.results.io import dumps
from weakforms.terminal import WorkProgress
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.consistency import traces
from weakforms.verification.run.effort import TIMES, Effort
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.usual import usual_times
from weakforms.verification.run.workers import in_this_process, workers


def solve_spec(spec: Spec, states: list[At]) -> Result:
    """Solve one spec with all its states (on all ranks of the world, if there are several)."""
    from weakforms import api
    from weakforms.problems.problem import StateRequest

    requests = [StateRequest(at.name, at.value, at.crossing, at.branch, at.profile) for at in states]
    judged = traces.is_judged(spec)
    return api.solve_requests(
        spec.problem,
        dict(spec.parameters),
        dict(spec.numerics),
        requests,
        branch_uncertainty=judged,
        drawn=traces.DRAWN if judged else 0,
    )


def _task(spec: Spec, states: list[At]) -> str:
    return dumps(solve_spec(spec, states).to_json())


def _ready() -> None:
    """Load everything that solves, and leave it out of later garbage collections."""
    from weakforms import api

    api.require_environment()
    from weakforms.solvers.support.memory import set_aside

    set_aside()


PACKAGE = Path(__file__).resolve().parents[2]

ASIDE = (
    "_cases",
    "_reference_data",
    "verification",
    "docs",
    "cli",
    "terminal.py",
    "pytest_plugin.py",
    "__main__.py",
    "world.py",
)
"""Parts of the package that do not change solutions: judging, drawing and messages."""

SOLVING = ("verification/cases/specs.py", "verification/run/plan.py", "verification/run/solving.py")
"""Modules in these parts that do change solutions: they define the requested solutions and states."""


@cache
def source_digest(folder: Path = PACKAGE) -> str:
    """Digest of the source code for solutions; a stored solution is used only by the same code."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        name = path.relative_to(folder).as_posix()
        if name in SOLVING or name.split("/")[0] not in ASIDE:
            digest.update(f"{name}\n{path.stat().st_size}\n".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def solution_key(spec: Spec, states: list[At]) -> str:
    """Name of the stored solution."""
    from weakforms.solvers.support.provenance import versions

    given = _as_compared([spec.problem, spec.parameters, spec.numerics])
    text = json.dumps([given, sorted(map(repr, states)), source_digest(), versions()])
    return f"{spec.problem}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"


def _as_compared(value: Any) -> Any:
    """Parameters in a form that compares equal for ``L=8`` and ``L=8.0``: both belong to one solution."""
    if isinstance(value, tuple | list):
        return [_as_compared(item) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


class Solver:
    """Solves a plan into a folder, using the solutions of an earlier run if requested.

    Args:
        folder: Where solutions are stored, one JSON file each.
        jobs: Number of parallel processes.
        resume: Keep the stored solutions.
        writes: Whether this process writes (rank 0 of several).
        task: Solves one spec with its states, and returns the result as JSON; by default what a case needs.
    """

    def __init__(
        self,
        folder: Path,
        jobs: int = 1,
        resume: bool = False,
        writes: bool = True,
        task: Callable[[Spec, list[At]], str] | None = None,
    ) -> None:
        self.folder, self.jobs, self.resume, self.writes = folder, jobs, resume, writes
        self.task = task or _task
        self.failures: dict[Spec, WeakformsError] = {}
        self.results: dict[Spec, Result] = {}
        self.files: dict[Spec, str] = {}

    def run(
        self,
        plan: Plan,
        progress: WorkProgress | None = None,
        settled: Callable[[Spec], None] = lambda _: None,
    ) -> None:
        """Solve everything; a failure is recorded and the other solves continue.

        Args:
            plan: What to solve.
            progress: Called with the current solution, and the seconds of work done and in total.
            settled: Called with each spec when its result is available or has failed.
        """
        progress = progress or WorkProgress()
        effort = Effort(self.folder.parent / TIMES, plan.states, usual_times())
        todo = []
        for spec, states in plan.states.items():
            path = self.folder / f"{solution_key(spec, states)}.json"
            self.files[spec] = path.name
            if self.resume and self._take(spec, path):
                effort.finish(spec)
                settled(spec)
                continue
            todo.append((spec, states, path))

        def tell(spec: Spec) -> None:
            progress(f"{effort.count} solved; {str(spec)[:48]}", *effort.share())

        for spec, outcome in self._outcomes(todo, tell):
            if isinstance(outcome, WeakformsError):
                self.failures[spec] = outcome
                effort.finish(spec)
            else:
                self._store(spec, outcome)
                effort.finish(spec, self.results[spec].provenance.get("wall_s"))
            if self.writes:
                effort.keep()
            tell(spec)
            settled(spec)

    def _take(self, spec: Spec, path: Path) -> bool:
        if not path.exists():
            return False
        try:
            self.results[spec] = load_result(path)
        except InputError:
            return False  # incomplete, because that run was ended: solve it again
        return True

    def _store(self, spec: Spec, text: str) -> None:
        if self.writes:
            write_atomically(self.folder / self.files[spec], text)
        self.results[spec] = Result.from_json(json.loads(text))

    def _outcomes(self, todo: list, begin: Callable[[Spec], None]) -> Iterable[tuple[Spec, object]]:
        if in_this_process(self.jobs):
            for spec, states, _ in todo:
                begin(spec)
                try:
                    yield spec, self.task(spec, states)
                except WeakformsError as error:
                    yield spec, error
            return
        with workers(self.jobs, _ready) as pool:
            futures = {pool.submit(self.task, spec, states): spec for spec, states, _ in todo}
            for future in as_completed(futures):
                error = future.exception()
                if error is not None and not isinstance(error, WeakformsError):
                    raise error
                yield futures[future], error or future.result()
