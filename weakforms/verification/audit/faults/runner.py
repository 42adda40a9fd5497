"""Runs the catalogue: a baseline first, then one fault at a time in a scratch copy, several side by side."""

from __future__ import annotations

import hashlib
import shutil
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import Any

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.results.io import dumps, load_json, require_writable, write_atomically
from weakforms.verification.audit.faults.catalogue import Expectation, Fault, catalogue, require_sound
from weakforms.verification.audit.faults.children import Children
from weakforms.verification.audit.faults.findings import baseline_of, finding
from weakforms.verification.audit.faults.outcome import (
    NAME,
    Baseline,
    FaultOutcome,
    FaultsRun,
    Finding,
    outcome_from_json,
    validate,
)
from weakforms.verification.audit.faults.scratch import copy_tree, scratch_folder, tree_digest
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.cases.references import ROOT
from weakforms.verification.run.machine import environment

Report = Callable[[float, float, str], None]
"""Progress: seconds of work done, seconds in all as far as is known, what is being done."""

USUAL = 15.0
"""Seconds that an expectation is taken to need before it was ever run."""

PATIENCE, LONGER = 300.0, 10.0
"""A fault's run is ended after so many seconds beyond so many times what it takes without the fault."""

WHOLE_PROFILE = 7200.0
"""Seconds for the whole quick profile with a fault that what was expected to notice it did not."""


class Campaign:
    """The faults chosen, on one unchanged copy and a copy each.

    Args:
        faults: Which.
        out: Output folder; every outcome is stored below it at once.
        scratch: Folder of the copies.
        jobs: Processes side by side.
        resume: Take over what is stored for the same source.
        report: Told about the progress.
    """

    def __init__(
        self, faults: Sequence[Fault], out: Path, scratch: Path, jobs: int, resume: bool, report: Report
    ) -> None:
        self.faults, self.store, self.scratch = list(faults), out / "faults", scratch
        self.jobs, self.resume, self._report = jobs, resume, report
        self.tree = tree_digest()
        self.children = Children()
        self.baseline: dict[str, Baseline] = {}
        self._lock, self._done = Lock(), 0.0
        self._quick = {found.id for found in find_cases() if found.case.quick}

    @cached_property
    def _unchanged(self) -> Path:
        return copy_tree(self.scratch / "unchanged")

    def run(self) -> list[FaultOutcome]:
        """Baseline, then all faults; outcomes in the catalogue's order."""
        self._unchanged  # noqa: B018  (made here, before threads share it)
        with ThreadPoolExecutor(self.jobs) as pool:
            try:
                self._run_baseline(pool)
                futures = {pool.submit(self._outcome, fault): fault for fault in self.faults}
                found = {futures[f].name: self._finished(f, futures[f]) for f in as_completed(futures)}
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                self.children.end()
                raise
        return [found[fault.name] for fault in self.faults]

    # -- without a fault -------------------------------------------------------------------------

    def _run_baseline(self, pool: ThreadPoolExecutor) -> None:
        wanted = list(dict.fromkeys(e.text for fault in self.faults for e in fault.expected))
        self._take_baseline(wanted)
        left = [text for text in wanted if text not in self.baseline]
        self._tell("without a fault")
        # A few processes for all of them: each one's start takes seconds.
        chunks = [left[k :: 4 * self.jobs] for k in range(4 * self.jobs)]
        running = [pool.submit(self._without_fault, chunk) for chunk in chunks if chunk]
        for future in as_completed(running):
            for found in future.result():
                self.baseline[found.expectation] = found
                self._done += found.seconds
            self._keep_baseline()
            self._tell("without a fault")

    def _without_fault(self, texts: list[str]) -> list[Baseline]:
        """Every expectation once on the unchanged copy."""
        answers, failure = self.children.run(self._unchanged, texts, WHOLE_PROFILE, go_on=True)
        known = {answer.expectation: answer for answer in answers}
        return [baseline_of(text, known.get(text), failure) for text in texts]

    def passes_without(self, text: str) -> bool:
        """Whether an expectation holds on the unchanged copy; run when first asked for."""
        with self._lock:
            if text not in self.baseline:
                (self.baseline[text],) = self._without_fault([text])
                self._keep_baseline()
            return self.baseline[text].passed

    # -- with one --------------------------------------------------------------------------------

    def _outcome(self, fault: Fault) -> FaultOutcome:
        stored = self._stored(fault)
        if stored is not None:
            return stored
        begun, folder = time.perf_counter(), self.scratch / fault.name
        expected = [e.text for e in fault.expected]
        if not all(self.passes_without(text) for text in expected):
            return self._ended(fault, "void", None, (), begun)
        try:
            # Of the copy, not of the tree: somebody may be working on that.
            return self._searched(fault, copy_tree(folder, fault, self._unchanged), begun)
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def _searched(self, fault: Fault, root: Path, begun: float) -> FaultOutcome:
        """Look for a fault in its copy: where it is expected, then everywhere."""
        expected = [e.text for e in fault.expected]
        limit = PATIENCE + LONGER * sum(self.baseline[text].seconds for text in expected)
        found, searched = self._noticed(root, expected, limit)
        if found is None and not fault.reason:
            rest = sorted(self._quick - {e.case for e in fault.expected if not e.part})
            found, more = self._noticed(root, rest, WHOLE_PROFILE)
            searched += more
        status = "caught" if found else "equivalent" if fault.reason else "survived"
        outcome = self._ended(fault, status, found, tuple(searched), begun)
        write_atomically(self._file(fault), dumps(record(self._key(fault), outcome)))
        return outcome

    def _noticed(self, root: Path, texts: list[str], limit: float) -> tuple[Finding | None, list[str]]:
        """What notices the fault first, and what was run; a check that fails without it notices nothing."""
        searched: list[str] = []
        while texts:
            answers, failure = self.children.run(root, texts, limit)
            searched += [answer.expectation for answer in answers]
            bad = next((answer for answer in answers if answer.status != "passed"), None)
            if bad is not None and self.passes_without(bad.expectation):
                return finding(bad, self._is_quick(bad.expectation)), searched
            texts = texts[len(answers) :]
            if bad is None and not failure:
                break
            if bad is None:  # it broke down in the next one
                searched.append(texts[0])
                if self.passes_without(texts[0]):
                    wanted = Expectation(texts[0])
                    quick = self._is_quick(wanted.text)
                    return Finding("stopped", wanted.case, "", quick, failure), searched
                texts = texts[1:]
        return None, searched

    def _is_quick(self, text: str) -> bool:
        return Expectation(text).case in self._quick

    def _ended(
        self, fault: Fault, status: str, found: Finding | None, searched: tuple[str, ...], begun: float
    ) -> FaultOutcome:
        texts = ("name", "area", "subject", "description", "file", "find", "replace", "reason")
        given = {key: getattr(fault, key) for key in texts}
        seconds = round(time.perf_counter() - begun, 3)
        return FaultOutcome(**given, status=status, caught_by=found, searched=searched, seconds=seconds)

    # -- progress and what is stored -------------------------------------------------------------

    def _finished(self, future: Future, fault: Fault) -> FaultOutcome:
        outcome = future.result()
        self._done += self._usual(fault)
        self._tell(f"{fault.name}: {outcome.status}")
        return outcome

    def _usual(self, fault: Fault) -> float:
        """Seconds a fault is taken to need: its first expectation notices it, mostly."""
        first = self.baseline.get(fault.expected[0].text)
        return 3.0 + (first.seconds if first else USUAL)

    def _tell(self, what: str) -> None:
        wanted = {e.text for fault in self.faults for e in fault.expected}
        before = sum(self.baseline[t].seconds if t in self.baseline else USUAL for t in wanted)
        self._report(self._done, before + sum(map(self._usual, self.faults)), what)

    def _key(self, fault: Fault) -> str:
        return hashlib.sha256(f"{self.tree} {fault!r}".encode()).hexdigest()[:16]

    def _file(self, fault: Fault) -> Path:
        return self.store / f"{fault.name}.json"

    def _stored(self, fault: Fault) -> FaultOutcome | None:
        data = _read(self._file(fault)) if self.resume else {}
        if data.get("key") != self._key(fault):
            return None
        return outcome_from_json(data["outcome"])

    def _take_baseline(self, wanted: list[str] | None) -> None:
        data = _read(self.store / "baseline" / NAME) if self.resume else {}
        if data.get("tree") == self.tree:
            kept = [
                Baseline(**item) for item in data["found"] if wanted is None or item["expectation"] in wanted
            ]
            self.baseline |= {found.expectation: found for found in kept if found.passed}
            self._done += sum(found.seconds for found in self.baseline.values())

    def _keep_baseline(self) -> None:
        found = [asdict(item) for item in self.baseline.values()]
        write_atomically(self.store / "baseline" / NAME, dumps({"tree": self.tree, "found": found}))


def _read(path: Path) -> dict[str, Any]:
    """A stored file; nothing where there is none, or where it was cut short."""
    try:
        return load_json(path, "stored outcome")
    except InputError:
        return {}


def record(key: str, outcome: FaultOutcome) -> dict[str, Any]:
    """What is stored of an outcome, so that a later run can take it over."""
    run = FaultsRun("", "", 0.0, "", 0, {}, [], [outcome])
    return {"key": key, "outcome": run.to_json()["faults"][0]}


def require_tests(faults: list[Fault]) -> None:
    """Make sure the tests that faults name can be run.

    Raises:
        EnvironmentLackError: Without the tree's tests, or without pytest.
    """
    if not any(e.is_test for fault in faults for e in fault.expected):
        return
    if not (ROOT / "tests").is_dir():
        raise EnvironmentLackError(
            "some faults are noticed by the tree's tests, which are not here: use ./run faults in a checkout"
        )
    try:
        import pytest  # noqa: F401
    except ImportError as error:
        raise EnvironmentLackError("pytest is not installed here: pip install pytest") from error


def run_faults(
    faults: list[Fault],
    out: Path,
    jobs: int = 1,
    resume: bool = False,
    selection: str = "",
    report: Report = lambda *_: None,
) -> FaultsRun:
    """Run faults of the catalogue and write ``faults.json`` into the output folder.

    Args:
        faults: Which, from :func:`~weakforms.verification.audit.faults.catalogue.select`.
        out: Output folder, that of ``verify``: its report then carries the table.
        jobs: Faults side by side.
        resume: Take over outcomes stored there for the same source.
        selection: What was chosen, in words.
        report: Told about the progress.

    Raises:
        InputError: Before anything runs, when the catalogue does not fit the tree.
        EnvironmentLackError: When the tests that faults name are not here.
    """
    begun, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    require_sound(faults)
    require_tests(faults)
    require_writable(out / "faults")
    with scratch_folder() as scratch:
        campaign = Campaign(faults, out, scratch, jobs, resume, report)
        outcomes = campaign.run()
    run = FaultsRun(
        selection=selection,
        started=started,
        seconds=round(time.perf_counter() - begun, 3),
        tree=campaign.tree,
        catalogue=len(catalogue()),
        environment=environment(),
        baseline=[campaign.baseline[text] for text in sorted(campaign.baseline)],
        faults=outcomes,
    )
    data = run.to_json()
    validate(data)
    write_atomically(out / NAME, dumps(data))
    return run
