"""The bodies of ``weakforms verify``, ``check`` and ``report``."""

from __future__ import annotations

import os
from pathlib import Path

import typer

from weakforms.terminal import complain, console, plain, progress_bar, rank
from weakforms.verification.audit.any_parameters.outcome import NAME as AUDIT
from weakforms.verification.audit.bench_ranks import NAME as SCALING
from weakforms.verification.audit.coverage.outcome import NAME as COVERAGE
from weakforms.verification.audit.elsewhere import elsewhere, write_elsewhere
from weakforms.verification.audit.faults.outcome import NAME as FAULTS
from weakforms.verification.audit.faults.outcome import RANDOM, keep_beside, load_faults
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.report.report import load_run, write_report
from weakforms.verification.report.summary import print_summary, run_status

DRAWING = "drawing the report"
"""What a log says in the meantime."""


def verify(cases: list[FoundCase], out: Path, profile: str, selection: str, jobs: int, resume: bool) -> None:
    """Solve and judge cases, then write the report and print a summary.

    Raises:
        InputError: If a case is invalid, or another run uses the folder, or it cannot be written.
        EnvironmentLackError: If dolfinx is missing.
        typer.Exit: With the exit status, unless all checks pass.
    """
    from weakforms import api
    from weakforms.verification.run import runner

    api.require_environment()
    first = rank() == 0
    with runner.alone(cases, out, first):
        try:
            with progress_bar() as progress:
                run = runner.verify(
                    cases,
                    out,
                    profile,
                    selection,
                    jobs=jobs,
                    resume=resume,
                    writes=first,
                    progress=progress,
                )
                if first:
                    progress(DRAWING, 1, 1)
                    for name in (FAULTS, RANDOM, AUDIT, COVERAGE, SCALING):
                        keep_beside(out / name, out / "report", name)
                    page = write_report(run, out / "report", jobs=jobs)
        except KeyboardInterrupt:
            complain("interrupted; the same command with --resume continues")
            raise typer.Exit(130) from None
        if first:
            print_summary(run, console())
            console().print(f"report: {plain(page)}", soft_wrap=True)
    status = run_status(run)
    if status != "passed":
        raise typer.Exit(3 if status == "error" else 1)


def report(
    folder: Path, out: Path | None, as_pdf: bool, seeded: Path | None, others: tuple[Path, ...], jobs: int
) -> None:
    """Draw the report of a stored run again, with the other outcomes in its folder.

    Args:
        folder: Output folder of the run, or of its report.
        out: Folder for the report; by default where it was.
        as_pdf: Whether to write a PDF too.
        seeded: File with the outcome of ``faults``, if it is not in the folder.
        others: Output folders of other runs, whose numbers are compared with this run's numbers.
        jobs: Number of parallel processes for drawing.

    Raises:
        InputError: If a stored file cannot be read or drawn, or the folder cannot be written.
        EnvironmentLackError: If a PDF is requested and there is no browser.
    """
    from weakforms.verification.report import pdf

    if as_pdf:
        pdf.browser()
    stored = folder / "report" if os.path.isdir(folder / "report") else folder
    run = load_run(stored)
    if seeded is not None:
        load_faults(seeded)
    known = (seeded, folder / FAULTS, stored / FAULTS)
    keep_beside(next((path for path in known if path and path.is_file()), None), out or stored)
    for name in (RANDOM, AUDIT, COVERAGE, SCALING):
        there = (folder / name, stored / name)
        keep_beside(next((path for path in there if path.is_file()), None), out or stored, name)
    with progress_bar() as progress:
        if others:
            progress("comparing numbers with another run", 0, 1)
            write_elsewhere([elsewhere(folder, other) for other in others], out or stored)
        progress(DRAWING, 0, 1)
        written = [write_report(run, out or stored, stored=True, jobs=jobs)]
        if as_pdf:
            written.append(pdf.write_pdf(run, written[0].with_name(pdf.NAME)))
    print_summary(run, console())
    for path in written:
        console().print(f"report: {plain(path)}", soft_wrap=True)
