"""Runs random mutants: each meets the cases and tests that can see its line, the fastest first."""

from __future__ import annotations

import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from weakforms.results.io import dumps, require_writable, write_atomically
from weakforms.verification.audit.faults.catalogue import Fault
from weakforms.verification.audit.faults.lines import Watchers
from weakforms.verification.audit.faults.outcome import RANDOM, FaultOutcome, FaultsRun, validate
from weakforms.verification.audit.faults.random_faults import Mutant, draw
from weakforms.verification.audit.faults.runner import LONGER, Campaign, Report, record
from weakforms.verification.audit.faults.scratch import scratch_folder
from weakforms.verification.run.machine import environment

BUDGET = 300.0
"""Seconds of cases and tests that a mutant meets, unless another number is asked for."""

AT_ONCE = 20.0
"""Seconds of cases and tests that one process is given, before it is seen whether the budget is spent."""

SAYING = ("comparison", "test")
"""Kinds of findings that say what is wrong; all others are crashes."""

MOST = 60
"""Expectations that one process is given."""

AFTER_CRASH = 0.2
"""Fraction of the budget for which a verdict or an assertion is looked for after a crash."""

PATIENCE = 60.0
"""A mutant's process is ended after so many seconds beyond :data:`LONGER` times what its tests take without
the mutant: less than for a seeded fault, because many mutants make a loop endless."""


class RandomCampaign(Campaign):
    """Mutants of a draw, on one unchanged copy and a copy each.

    Args:
        mutants: Which.
        out: Output folder; every outcome is stored below it at once, measured lines are read from there.
        scratch: Folder of the copies.
        jobs: Processes side by side.
        resume: Take over what is stored for the same source.
        report: Told about the progress.
        budget: Seconds after which no more cases and tests are begun on a mutant.
    """

    def __init__(
        self,
        mutants: list[Mutant],
        out: Path,
        scratch: Path,
        jobs: int,
        resume: bool,
        report: Report,
        budget: float = BUDGET,
    ) -> None:
        super().__init__(mutants, out, scratch, jobs, resume, report)
        self.store, self.budget = out / "faults" / "random", budget
        self._watchers = Watchers(out)

    def _run_baseline(self, _pool: ThreadPoolExecutor) -> None:
        """Nothing beforehand: what notices a mutant is run without it then."""
        self._take_baseline(None)

    def _outcome(self, fault: Fault) -> FaultOutcome:
        if not fault.reason:
            return super()._outcome(fault)
        return replace(self._ended(fault, "equivalent", None, (), time.perf_counter()), status=fault.verdict)

    def _searched(self, fault: Fault, root: Path, begun: float) -> FaultOutcome:
        found, searched, last = None, [], begun + self.budget
        seeing = self._watchers.of(fault.file, fault.line)
        for texts, seconds in _portions(seeing):
            left = texts
            while left and time.perf_counter() < last and not (found and found.kind in SAYING):
                noticed, more = self._noticed(root, left, PATIENCE + LONGER * seconds)
                searched += more
                left = left[len(more) :] if noticed else []
                if noticed and found is None:
                    last = min(last, time.perf_counter() + AFTER_CRASH * self.budget)
                if noticed and (found is None or noticed.kind in SAYING):
                    found = noticed
        outcome = self._ended(fault, "caught" if found else "survived", found, tuple(searched), begun)
        outcome = replace(outcome, watching=len(seeing))
        write_atomically(self._file(fault), dumps(record(self._key(fault), outcome)))
        return outcome

    def _usual(self, _fault: Fault) -> float:
        return self.budget / 4


def _portions(seeing: list[tuple[str, float]]) -> Iterator[tuple[list[str], float]]:
    """Expectations in their order, as many at once as one process runs in a short time."""
    texts: list[str] = []
    seconds = 0.0
    for text, takes in seeing:
        if texts and (seconds + takes > AT_ONCE or len(texts) == MOST):
            yield texts, seconds
            texts, seconds = [], 0.0
        texts, seconds = [*texts, text], seconds + takes
    if texts:
        yield texts, seconds


def run_random(
    number: int,
    seed: int,
    out: Path,
    jobs: int = 1,
    resume: bool = False,
    budget: float = BUDGET,
    report: Report = lambda *_: None,
) -> FaultsRun:
    """Draw mutants, run them, and write ``mutants.json`` into the output folder.

    Args:
        number: How many.
        seed: What the draw depends on, besides the tree.
        out: Output folder, that of ``verify``: its report then carries the table.
        jobs: Mutants side by side.
        resume: Take over outcomes stored there for the same source.
        budget: Seconds after which no more cases and tests are begun on a mutant.
        report: Told about the progress.

    Raises:
        InputError: Before anything runs, for a number that is too large.
    """
    begun, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    mutants, there_are = draw(number, seed)
    require_writable(out / "faults" / "random")
    with scratch_folder() as scratch:
        campaign = RandomCampaign(mutants, out, scratch, jobs, resume, report, budget)
        outcomes = campaign.run()
    run = FaultsRun(
        selection=f"{number} random mutants, seed {seed}, {budget:g} s each",
        started=started,
        seconds=round(time.perf_counter() - begun, 3),
        tree=campaign.tree,
        catalogue=there_are,
        environment=environment(),
        baseline=[campaign.baseline[text] for text in sorted(campaign.baseline)],
        faults=outcomes,
        random=True,
    )
    data = run.to_json()
    validate(data)
    write_atomically(out / RANDOM, dumps(data))
    return run
