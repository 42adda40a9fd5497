"""The verbs that hold the suite's own numbers against the references: check, verify, report."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from weakforms.cli.app import Engine, Jobs, Out, Resume, app, case_names, examples
from weakforms.errors import InputError


@app.command(
    epilog=examples("weakforms check paper2.fig03", "weakforms check paper2.fig03 paper2.fig04 --out out/two")
)
def check(
    names: Annotated[
        list[str], typer.Argument(metavar="CASE...", help="Ids of cases.", autocompletion=case_names)
    ],
    jobs: Jobs,
    out: Out = Path("out"),
    resume: Resume = False,
    engine: Engine = "processes",
) -> None:
    """Solve and check single cases."""
    from weakforms.verification.cases.discovery import get_case
    from weakforms.verification.run import verbs
    from weakforms.verification.run.executors import executor

    names = list(dict.fromkeys(names))
    with executor(engine) as first:
        if first:
            verbs.verify([get_case(name) for name in names], out, "full", " ".join(names), jobs, resume)


@app.command(
    epilog=examples(
        "weakforms verify --profile quick",
        "weakforms verify --paper 2 -j 2",
        "weakforms verify -k 'fig03 or fig04' --resume",
        "weakforms verify --executor dask:tcp://localhost:8786",
    )
)
def verify(
    jobs: Jobs,
    paper: Annotated[int | None, typer.Option(min=1, max=5, help="Only this paper.")] = None,
    expression: Annotated[
        str | None, typer.Option("-k", metavar="EXPR", help="Select cases by name, with and, or, not.")
    ] = None,
    profile: Annotated[str, typer.Option(help="quick or full.")] = "full",
    resume: Resume = False,
    out: Out = Path("out"),
    engine: Engine = "processes",
) -> None:
    """Solve and check all cases, then write the report."""
    from weakforms.verification.cases.discovery import select
    from weakforms.verification.run import verbs
    from weakforms.verification.run.executors import executor

    if profile not in ("quick", "full"):
        raise InputError(f"--profile {profile!r}: allowed are quick and full")
    cases = select(paper, expression)
    if profile == "quick":
        cases = [found for found in cases if found.case.quick]
        if not cases:
            raise InputError("none of the selected cases is in the quick profile")
    words = [f"paper {paper}"] if paper else []
    words += [f"-k {expression!r}"] if expression else []
    with executor(engine) as first:
        if first:
            verbs.verify(cases, out, profile, ", ".join(words) or "all cases", jobs, resume)


@app.command(epilog=examples("weakforms report out", "weakforms report out --pdf --other out/elsewhere"))
def report(
    folder: Annotated[Path, typer.Argument(help="Output folder of a run.")],
    jobs: Jobs,
    out: Annotated[Path | None, typer.Option(help="Folder for the report; default: where it was.")] = None,
    as_pdf: Annotated[bool, typer.Option("--pdf", help="Also write report.pdf; needs a browser.")] = False,
    seeded: Annotated[
        Path | None,
        typer.Option(
            "--faults", metavar="FILE", help="Outcome of weakforms faults; default: DIR/faults.json."
        ),
    ] = None,
    others: Annotated[
        list[Path] | None,
        typer.Option(
            "--other",
            metavar="OUT",
            help="Output folder of another run; the report compares all numbers with it.",
        ),
    ] = None,
) -> None:
    """Rebuild the report from stored results, without solving."""
    from weakforms.verification.run import verbs

    verbs.report(folder, out, as_pdf, seeded, tuple(others or ()), jobs)
