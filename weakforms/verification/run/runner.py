"""A run of the suite: what the cases need is collected, solved once, stored, then judged."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import as_completed
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

from weakforms.errors import InputError, WeakformsError
from weakforms.results import Result, load_result, write_atomically
from weakforms.results.io import dumps, require_writable, sole_use
from weakforms.terminal import WorkProgress
from weakforms.verification.cases.case import Case
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging import surfaces
from weakforms.verification.judging.checks.check import Check, Judged
from weakforms.verification.judging.consistency import marks, traces
from weakforms.verification.judging.consistency.identities import Identities
from weakforms.verification.judging.consistency.table_traces import TableTrace
from weakforms.verification.judging.outcome import CaseOutcome, Convergence, RunOutcome, Verdict
from weakforms.verification.judging.panels import draw_panel, path_wants
from weakforms.verification.report.summary import case_line, plural
from weakforms.verification.run.effort import Effort
from weakforms.verification.run.machine import environment
from weakforms.verification.run.solutions import Solutions
from weakforms.verification.run.workers import workers


@dataclass
class Plan:
    """Every solution a set of cases needs, each once, with all the states wanted of it."""

    states: dict[Spec, list[At]]
    by_case: dict[str, list[Spec]]

    @classmethod
    def of(cls, cases: Iterable[FoundCase]) -> Plan:
        """Collect what the cases want; reference tables are read and checked here, before any solve.

        The slow cases come first: side by side, no solution of minutes is left to be waited for alone.
        """
        states: dict[Spec, list[At]] = {}
        by_case: dict[str, list[Spec]] = {}
        for found in sorted(cases, key=lambda found: not found.case.slow):
            check_ids(found)
            needed = []
            for spec, at in case_wants(found):
                listed = states.setdefault(spec, [])
                if at is not None and at not in listed:
                    listed.append(at)
                if spec not in needed:
                    needed.append(spec)
            by_case[found.id] = needed
        return cls({spec: _merge(ats) for spec, ats in states.items()}, by_case)


def case_wants(found: FoundCase) -> list[tuple[Spec, At | None]]:
    """All solutions and states of one case."""
    case = found.case
    out = [want for check in _written(case) for want in check.wants(found.paper)]
    out += [want for panel in case.panels for path in panel.paths for want in path_wants(path)]
    return out + [want for surface in case.surfaces for want in surfaces.surface_wants(surface)]


def checks_of(found: FoundCase) -> list[Check]:
    """All that judges a case: what its file says, then what must hold for every solution."""
    drawn = [TableTrace(curve) for panel in found.case.panels for curve in panel.curves]
    specs = dict.fromkeys(spec for spec, _ in case_wants(found))
    return [*_written(found.case), *drawn, *(of(spec) for spec in specs for of in (traces.Trace, Identities))]


def _written(case: Case) -> list[Check]:
    """The checks in the case's file."""
    return [*(curve for panel in case.panels for curve in panel.curves), *case.checks]


def check_ids(found: FoundCase) -> list[str]:
    """What the verdicts of a case will be called, known before anything is solved."""
    stated = [name for check in checks_of(found) for name in check.names(found.paper)]
    pictures = [name for panel in found.case.panels for name in marks.names(found.paper, panel)]
    return list(dict.fromkeys([*stated, *pictures]))


def _merge(ats: list[At]) -> list[At]:
    """One request a state, sampled at the union of the points wanted of it."""
    merged: dict[tuple[str, float, int, str], tuple[float, ...] | None] = {}
    for at in ats:
        key = (at.name, at.value, at.crossing, at.branch)
        points = merged.get(key)
        if at.profile is not None:
            # An empty tuple asks for the problem's own points: they are added wherever a picture is drawn.
            points = tuple(sorted({*(points or ()), *at.profile}))
        merged[key] = points
    return [At(*key[:3], profile=points, branch=key[3]) for key, points in merged.items()]


# -- solving -------------------------------------------------------------------------------------


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


PACKAGE = Path(__file__).resolve().parents[2]

ASIDE = (
    "_cases",
    "_reference_data",
    "verification",
    "docs",
    "cli.py",
    "terminal.py",
    "pytest_plugin.py",
    "__main__.py",
)
"""The parts of the package that no number comes from: judging, drawing and telling may change ..."""

SOLVING = ("verification/cases/specs.py", "verification/run/runner.py")
"""... but for what says which solutions and states are asked for."""


@cache
def source_digest(folder: Path = PACKAGE) -> str:
    """Digest of the source that solves: a stored solution is reused only by the code that made it."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        name = path.relative_to(folder).as_posix()
        if name in SOLVING or name.split("/")[0] not in ASIDE:
            digest.update(f"{name}\n{path.stat().st_size}\n".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def solution_key(spec: Spec, states: list[At]) -> str:
    """Name under which a solution is stored."""
    from weakforms.solvers.support.provenance import versions

    text = json.dumps([str(spec), sorted(map(repr, states)), source_digest(), versions()])
    return f"{spec.problem}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"


class Solver:
    """Solves a plan into a folder, with what an earlier run left there if that is wanted.

    Args:
        folder: Where solutions are stored, one JSON file each.
        jobs: Processes side by side.
        resume: Take over what is stored there already.
        writes: Whether this process writes (rank 0 of several).
    """

    def __init__(self, folder: Path, jobs: int = 1, resume: bool = False, writes: bool = True) -> None:
        self.folder, self.jobs, self.resume, self.writes = folder, jobs, resume, writes
        self.failures: dict[Spec, WeakformsError] = {}
        self.results: dict[Spec, Result] = {}
        self.files: dict[Spec, str] = {}

    def run(
        self,
        plan: Plan,
        progress: WorkProgress | None = None,
        settled: Callable[[Spec], None] = lambda _: None,
    ) -> None:
        """Solve everything; a spec that fails is noted and the others go on.

        Args:
            plan: What to solve.
            progress: Is told what is being solved, and the seconds of work done and to do.
            settled: Called with each spec once its result is there or is known to fail.
        """
        progress = progress or WorkProgress()
        effort = Effort(self.folder.parent / "times.json", plan.states)
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
            return False  # cut short by whatever ended that run: solve it again
        return True

    def _store(self, spec: Spec, text: str) -> None:
        if self.writes:
            write_atomically(self.folder / self.files[spec], text)
        self.results[spec] = Result.from_json(json.loads(text))

    def _outcomes(self, todo: list, begin: Callable[[Spec], None]) -> Iterable[tuple[Spec, object]]:
        if self.jobs == 1:
            for spec, states, _ in todo:
                begin(spec)
                try:
                    yield spec, _task(spec, states)
                except WeakformsError as error:
                    yield spec, error
            return
        with workers(self.jobs) as pool:
            futures = {pool.submit(_task, spec, states): spec for spec, states, _ in todo}
            for future in as_completed(futures):
                error = future.exception()
                if error is not None and not isinstance(error, WeakformsError):
                    raise error
                yield futures[future], error or future.result()


# -- judging -------------------------------------------------------------------------------------


def judge_case(found: FoundCase, plan: Plan, solver: Solver) -> CaseOutcome:
    """Verdicts and pictures of one case from stored solutions."""
    begun = time.perf_counter()
    solutions = Solutions(solver.results)
    outcome = CaseOutcome(
        id=found.id,
        title=found.case.title,
        source=found.case.source,
        description=found.description,
        status="passed",
        solutions=[_solution(spec, solver) for spec in plan.by_case[found.id]],
    )
    for spec in plan.by_case[found.id]:
        if spec in solver.failures:
            outcome.errors.append(f"{spec}: {solver.failures[spec]}")
    for check in checks_of(found):
        with _missed(outcome, check.names(found.paper), check.verdict_kind):
            _add(outcome, check.judge(found.paper, solutions))
    for panel in found.case.panels:
        with _missed(outcome, [f"panel {panel.name}"], "curve"):
            outcome.panels.append(draw_panel(found.paper, panel, solutions))
            _add(outcome, marks.judge(outcome.panels[-1]))
    for surface in found.case.surfaces:
        with _missed(outcome, [f"surface {surface.name}"], "field"):
            outcome.surfaces.append(surfaces.draw_surface(surface, solutions))
    outcome.status = _status(outcome)
    outcome.seconds = (
        time.perf_counter() - begun + sum(s["provenance"].get("wall_s", 0.0) for s in outcome.solutions)
    )
    return outcome


def _add(outcome: CaseOutcome, left: Judged) -> None:
    """Put what a check leaves where it belongs; two panels may draw one table, which is judged once."""
    judged = {verdict.check for verdict in outcome.verdicts}
    for item in list(left):  # all of it or nothing: a check that breaks down half-way is missed as a whole
        if isinstance(item, Convergence):
            outcome.convergence.append(item)
        elif not isinstance(item, Verdict):
            outcome.printed.append(item)
        elif item.check not in judged:
            outcome.verdicts.append(item)


@contextmanager
def _missed(outcome: CaseOutcome, expected: list[str], kind: str) -> Iterator[None]:
    """A check without numbers to judge is a failed one, never a missing one.

    A wrong solution may be one the check cannot cope with (no limit point where it takes the first): that
    is a failure of the check. Only what was not solved is an error of the case.
    """
    try:
        yield
    except WeakformsError as error:
        if str(error) not in outcome.errors:
            outcome.errors.append(str(error))
        reason = f"not solved: {error}"
    except Exception as error:
        reason = f"could not be judged: {type(error).__name__}: {error}"
    else:
        return
    _add(outcome, [Verdict(name, kind, False, "is to be judged", detail=reason) for name in expected])


def _status(outcome: CaseOutcome) -> str:
    if outcome.errors:
        return "error"
    # A case that judged nothing has verified nothing.
    good = bool(outcome.verdicts) and all(v.passed for v in outcome.verdicts)
    return "passed" if good else "failed"


def _solution(spec: Spec, solver: Solver) -> dict:
    result = solver.results.get(spec)
    return {
        "spec": str(spec),
        "problem": spec.problem,
        "parameters": result.parameters if result else dict(spec.parameters),
        "numerics": result.numerics if result else dict(spec.numerics),
        "provenance": result.provenance if result else {},
        "failures": [f"{f.what}: {f.reason}" for f in result.failures] if result else [],
        "file": f"solutions/{solver.files[spec]}",
    }


@contextmanager
def alone(cases: list[FoundCase], out: Path, writes: bool) -> Iterator[None]:
    """Keep the output folder of a run to it; bad input is named before there is a folder.

    Raises:
        InputError: On every rank, when a case is not sound or another run has the folder.
    """
    from mpi4py import MPI

    Plan.of(cases)
    with ExitStack() as held:
        refused = None
        if writes:
            try:
                held.enter_context(sole_use(out))
            except InputError as error:
                refused = error
        refused = MPI.COMM_WORLD.bcast(refused)
        if refused is not None:
            raise refused
        yield


def verify(
    cases: list[FoundCase],
    out: Path,
    profile: str,
    selection: str,
    jobs: int = 1,
    resume: bool = False,
    writes: bool = True,
    progress: WorkProgress | None = None,
) -> RunOutcome:
    """Solve and judge cases; the caller writes the report.

    Raises:
        InputError: Before anything is solved, when a case or a reference table is not sound.
    """
    begun, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    plan = Plan.of(cases)
    require_writable(out / "solutions")
    require_writable(out / "report")
    progress = progress or WorkProgress()
    at_once = f", {jobs} at a time" if jobs > 1 else ""
    progress.line(f"{plural(len(cases), 'case')}: {plural(len(plan.states), 'solution')} to solve{at_once}")
    solver = Solver(out / "solutions", jobs, resume, writes)
    outcomes: dict[str, CaseOutcome] = {}
    missing = {found.id: set(plan.by_case[found.id]) for found in cases}

    def settle(spec: Spec | None) -> None:
        """Judge the cases that waited for this solution only."""
        for found in cases:
            missing[found.id].discard(spec)
            if not missing[found.id] and found.id not in outcomes:
                outcomes[found.id] = judge_case(found, plan, solver)
                progress.line(case_line(outcomes[found.id], len(outcomes), len(cases)))

    settle(None)
    solver.run(plan, progress, settle)
    progress("drawing the report", 1, 1)
    return RunOutcome(
        profile=profile,
        selection=selection,
        started=started,
        seconds=time.perf_counter() - begun,
        environment=environment(),
        cases=[outcomes[found.id] for found in cases],
    )
