"""A run of the suite: the solutions of the cases are computed once, stored, then judged."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from datetime import UTC, datetime
from pathlib import Path

from weakforms.errors import InputError, WeakformsError
from weakforms.results.io import require_writable, sole_use
from weakforms.terminal import WorkProgress
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging import surfaces
from weakforms.verification.judging.checks.check import Judged
from weakforms.verification.judging.consistency import marks
from weakforms.verification.judging.outcome import CaseOutcome, Convergence, RunOutcome, Verdict
from weakforms.verification.judging.panels import draw_panel
from weakforms.verification.report.summary import case_line
from weakforms.verification.report.wording import duration, plural
from weakforms.verification.run.effort import TIMES, Effort
from weakforms.verification.run.machine import environment
from weakforms.verification.run.plan import Plan, checks_of
from weakforms.verification.run.solutions import Solutions
from weakforms.verification.run.solving import Solver
from weakforms.verification.run.usual import usual_megabytes, usual_times
from weakforms.verification.run.workers import at_once
from weakforms.world import world


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
    """Add the outcome of a check; a table that two panels draw is judged once."""
    judged = {verdict.check for verdict in outcome.verdicts}
    for item in list(left):  # all or nothing: a check that fails half-way is missing as a whole
        if isinstance(item, Convergence):
            outcome.convergence.append(item)
        elif not isinstance(item, Verdict):
            outcome.printed.append(item)
        elif item.check not in judged:
            outcome.verdicts.append(item)


@contextmanager
def _missed(outcome: CaseOutcome, expected: list[str], kind: str) -> Iterator[None]:
    """A check without numbers fails; it is never left out.

    If a check cannot be evaluated for a wrong solution (for example, if there is no limit point), it fails.
    Only a missing solution is an error of the case.
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
    # A case without verdicts has verified nothing.
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
    """Lock the output folder of a run; bad input is reported before the folder is created.

    Raises:
        InputError: On every rank, if a case is invalid or another run uses the folder.
    """
    Plan.of(cases)
    with sole_writer(out, writes):
        yield


@contextmanager
def sole_writer(out: Path, writes: bool) -> Iterator[None]:
    """Lock a folder from the rank that writes to it.

    Raises:
        InputError: On every rank, if another run uses the folder.
    """
    with ExitStack() as held:
        refused = None
        if writes:
            try:
                held.enter_context(sole_use(out))
            except InputError as error:
                refused = error
        refused = world().bcast(refused)
        if refused is not None:
            raise refused
        yield


def expectation(effort: Effort, specs: Sequence[Spec], count: int) -> str:
    """How long solutions will take, so many at a time, and how large their files are, as text."""
    seconds = effort.expected(count)
    if seconds is None:
        return ""
    whose = "the last run" if effort.is_of_this_machine else "a machine with two cores"
    size = max(1, round(usual_megabytes(specs)))
    return f", about {duration(seconds)} by the times of {whose}, {size} MB"


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
        InputError: Before anything is solved, if a case or a reference table is invalid.
    """
    begun, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    plan = Plan.of(cases)
    require_writable(out / "solutions")
    require_writable(out / "report")
    progress = progress or WorkProgress()
    count = at_once(jobs)
    together = f", {count} at a time" if count > 1 else ""
    # What a resumed run keeps takes no time again.
    long = (
        "" if resume else expectation(Effort(out / TIMES, plan.states, usual_times()), [*plan.states], count)
    )
    progress.plan(
        f"{plural(len(cases), 'case')}: {plural(len(plan.states), 'solution')} to solve{together}{long}"
    )
    solver = Solver(out / "solutions", jobs, resume, writes)
    outcomes: dict[str, CaseOutcome] = {}
    missing = {found.id: set(plan.by_case[found.id]) for found in cases}

    def settle(spec: Spec | None) -> None:
        """Judge the cases whose last solution this is."""
        for found in cases:
            missing[found.id].discard(spec)
            if not missing[found.id] and found.id not in outcomes:
                outcomes[found.id] = judge_case(found, plan, solver)
                progress.line(case_line(outcomes[found.id], len(outcomes), len(cases)))

    settle(None)
    solver.run(plan, progress, settle)
    return RunOutcome(
        profile=profile,
        selection=selection,
        started=started,
        seconds=time.perf_counter() - begun,
        environment=environment(),
        cases=[outcomes[found.id] for found in cases],
    )
