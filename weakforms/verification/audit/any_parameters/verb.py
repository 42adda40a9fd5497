"""The body of ``weakforms audit``."""

from __future__ import annotations

import sys
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

from weakforms.terminal import plain, print_json, progress_bar, require_one_rank
from weakforms.verification.audit.any_parameters.outcome import NAME, print_audit


def audit_verb(
    problems: list[str],
    count: int,
    seed: int | None,
    limit: float,
    out: Path,
    resume: bool,
    as_json: bool,
    screen: Console,
) -> int:
    """Solve problems at random sets of parameters; return 0 if all are answered, else 1.

    Raises:
        InputError: For an unknown problem, or in a run on several ranks.
    """
    require_one_rank("audit")
    from weakforms import api

    registry = api.require_environment()
    from weakforms.verification.audit.any_parameters.runner import run_audit

    names = list(dict.fromkeys(problems)) or list(registry.abouts())
    chosen = int(datetime.now(UTC).strftime("%Y%m%d")) if seed is None else seed
    sys.stderr.write(f"weakforms: audit with seed {chosen}\n")
    with progress_bar() as progress:

        def report(done: int, total: int, what: str) -> None:
            progress(what, done, total)
            if not sys.stderr.isatty():  # without a bar, one line for each set
                sys.stderr.write(f"weakforms: {done}/{total} {plain(what)}\n")
                sys.stderr.flush()

        run = run_audit(names, count, chosen, limit, out, resume, report)
    if as_json:
        print_json(run.to_json())
    else:
        print_audit(run, screen)
        screen.print(f"outcome: {out / NAME}", soft_wrap=True)
    return 1 if run.missed else 0
