"""The body of ``weakforms faults``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from weakforms.errors import InputError
from weakforms.terminal import print_json, progress_bar, require_one_rank
from weakforms.verification.audit.faults.catalogue import Fault, select
from weakforms.verification.audit.faults.outcome import NAME, RANDOM, FaultsRun, print_faults
from weakforms.verification.cases.discovery import Expression
from weakforms.verification.report.wording import plural


def faults_verb(
    only: list[str],
    expression: str | None,
    listed: bool,
    out: Path,
    jobs: int,
    resume: bool,
    as_json: bool,
    screen: Console,
) -> int:
    """Run faults and say what caught them; the exit status.

    Raises:
        InputError: For an unknown name, or in a run on several ranks.
    """
    faults = select(only, expression)
    if listed:
        _list(faults, as_json, screen)
        return 0
    require_one_rank("faults")
    from weakforms import api
    from weakforms.verification.audit.faults.runner import run_faults

    api.require_environment()
    words = list(only) + ([f"-k {expression!r}"] if expression else [])
    with progress_bar() as progress:
        run = run_faults(
            faults,
            out,
            jobs,
            resume,
            " ".join(words) or "all faults",
            lambda done, total, what: progress(what, done, total),
        )
    return _shown(run, out / NAME, as_json, screen)


def random_verb(
    number: int,
    seed: int,
    budget: float,
    out: Path,
    jobs: int,
    resume: bool,
    as_json: bool,
    screen: Console,
    listed: bool,
) -> int:
    """Draw random mutants, run them and say what caught them; the exit status.

    Raises:
        InputError: For a number or a budget out of range, or in a run on several ranks.
    """
    from weakforms.verification.audit.faults.random_faults import draw

    if not 0 < budget < math.inf:
        raise InputError(f"--budget {budget:g}: a positive number of seconds is wanted")
    if listed:
        _list(draw(number, seed)[0], as_json, screen)
        return 0
    require_one_rank("faults")
    from weakforms import api
    from weakforms.verification.audit.faults.random_runner import run_random

    api.require_environment()
    with progress_bar() as progress:
        run = run_random(
            number,
            seed,
            out,
            jobs,
            resume,
            budget,
            lambda done, total, what: progress(what, done, total),
        )
    return _shown(run, out / RANDOM, as_json, screen)


def measure_verb(expression: str | None, out: Path, jobs: int, resume: bool, screen: Console) -> int:
    """Note which lines tests and cases run; the exit status.

    Raises:
        InputError: For a malformed expression, or in a run on several ranks.
        EnvironmentLackError: When this Python is too old for it.
    """
    require_one_rank("faults")
    from weakforms import api
    from weakforms.verification.audit.faults.lines import measure, require_monitoring, units

    api.require_environment()
    require_monitoring()
    chosen = Expression(expression) if expression else None
    wanted = [unit for unit in units() if chosen is None or chosen.matches(unit.lower())]
    with progress_bar() as progress:
        failing = measure(wanted, out, resume, lambda done, total, what: progress(what, done, total), jobs)
    screen.print(f"lines: {out / 'faults' / 'lines'}", soft_wrap=True)
    if failing:
        screen.print(f"{plural(failing, 'file')} of tests or cases did not pass or did not end")
    return 1 if failing else 0


def _shown(run: FaultsRun, file: Path, as_json: bool, screen: Console) -> int:
    if as_json:
        print_json(run.to_json())
    else:
        print_faults(run, screen)
        screen.print(f"outcome: {file}", soft_wrap=True)
    return 0 if run.status == "caught" else 1


def _list(faults: Sequence[Fault], as_json: bool, screen: Console) -> None:
    if as_json:
        keys = ("name", "area", "subject", "description", "file")
        print_json([{key: getattr(fault, key) for key in keys} for fault in faults])
        return
    for fault in faults:
        screen.print(f"{fault.name}  [{fault.area}] {fault.description}", markup=False, soft_wrap=True)
