"""The body of ``weakforms faults``."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from weakforms.errors import InputError
from weakforms.terminal import print_json, progress_bar
from weakforms.verification.faults.catalogue import Fault, select
from weakforms.verification.faults.outcome import NAME, print_faults


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
    _require_one_rank()
    from weakforms import api
    from weakforms.verification.faults.runner import run_faults

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
    if as_json:
        print_json(run.to_json())
    else:
        print_faults(run, screen)
        screen.print(f"outcome: {out / NAME}", soft_wrap=True)
    return 0 if run.status == "caught" else 1


def _require_one_rank() -> None:
    from mpi4py import MPI

    if MPI.COMM_WORLD.size > 1:
        raise InputError("faults: runs on one rank; -j N puts N of them side by side")


def _list(faults: list[Fault], as_json: bool, screen: Console) -> None:
    if as_json:
        keys = ("name", "area", "subject", "description", "file")
        print_json([{key: getattr(fault, key) for key in keys} for fault in faults])
        return
    for fault in faults:
        screen.print(f"{fault.name}  [{fault.area}] {fault.description}", markup=False, soft_wrap=True)
