"""The command line: one verb for each use of the suite."""

from __future__ import annotations

import logging
import os
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from weakforms.errors import InputError
from weakforms.terminal import (
    complain,
    console,
    free_cores,
    guarded,
    once,
    plain,
    print_json,
    progress_bar,
    rank,
    request,
)

app = typer.Typer(
    name="weakforms",
    help="FEniCSx weak-form verification suite of inflation and instabilities of hyperelastic membranes.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Out = Annotated[Path, typer.Option("--out", help="Folder for solutions and report.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Jobs = Annotated[
    int,
    typer.Option(
        "-j",
        "--jobs",
        min=1,
        max=64,
        envvar="WEAKFORMS_JOBS",
        default_factory=free_cores,
        show_default="number of cores; 1 under mpirun",
        help="Number of parallel processes.",
    ),
]
Resume = Annotated[bool, typer.Option("--resume", help="Keep what an interrupted run stored.")]


@app.callback()
def _options(
    debug: Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")] = False,
) -> None:
    """Define the options before the verb."""


@app.command("list")
def list_(
    paper: Annotated[int | None, typer.Option(min=1, max=5, help="Only this paper.")] = None,
    as_json: Json = False,
) -> None:
    """List every problem and every case, one line each."""
    from weakforms.verification.cases.catalogue import listing, print_listing

    entries = listing(paper)
    if as_json:
        print_json(entries)
    else:
        print_listing(entries, console())


@app.command()
def show(name: Annotated[str, typer.Argument(help="A problem or a case.")], as_json: Json = False) -> None:
    """Show a problem's parameters, ranges and energy, or a case's source, checks and references."""
    from weakforms.verification.cases.catalogue import describe, print_description

    facts = describe(name)
    if as_json:
        print_json(facts)
    else:
        print_description(facts, console())


@app.command()
def solve(
    problem: Annotated[str, typer.Argument(help="Name of the problem; see: weakforms list.")],
    sets: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A parameter.")
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="Also solve for a state: a column and its value, or a kind of special point and its number.",
        ),
    ] = None,
    crossing: Annotated[int, typer.Option(help="Which crossing of that value along the branch.")] = 1,
    branch: Annotated[str, typer.Option(help="Branch on which the state lies.")] = "primary",
    mesh: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="A numerical setting: degree, cells, levels."),
    ] = None,
    spec: Annotated[
        Path | None,
        typer.Option(metavar="FILE.json", help="Request file with parameters, at, numerics."),
    ] = None,
    out: Annotated[Path | None, typer.Option(help="File for the result; default: standard output.")] = None,
    form: Annotated[str, typer.Option("--format", help="json or csv (csv: the branches only).")] = "json",
) -> None:
    """Solve one problem at any parameters and write the result as JSON."""
    from weakforms import api
    from weakforms.results.io import branch_csv, dumps, require_place_for, validate, write_atomically

    if form not in ("json", "csv"):
        raise InputError(f"--format {form!r}: allowed are json and csv")
    solve_it = api.prepare(problem, **request(spec, sets, at, mesh), crossing=crossing, branch=branch)
    if out is not None:
        require_place_for(out)
    with progress_bar() as progress:
        result = solve_it(progress)
    data = result.to_json()
    validate(data)
    if rank() == 0:
        text = branch_csv(result) if form == "csv" else dumps(data)
        if out is None:
            sys.stdout.write(text)
        else:
            write_atomically(out, text)
        for absence in result.absent:
            complain(f"not there: {absence.what}: {absence.reason}")
        for failure in result.failures:
            complain(f"not converged: {failure.what}: {failure.reason}")
    if result.failures:
        raise typer.Exit(3)


@app.command()
def shape(
    result: Annotated[Path, typer.Argument(metavar="RESULT.json", help="Result that solve --out wrote.")],
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File to write: .vtu or .xdmf (with fields), or .stl.")
    ],
    branch: Annotated[str, typer.Option(help="Branch of the state; default: any.")] = "",
    state: Annotated[int, typer.Option(min=1, help="Number of the state, from 1.")] = 1,
) -> None:
    """Write the deformed shape of a state of a result, for other tools."""
    from weakforms.results import load_result
    from weakforms.results.io import require_place_for
    from weakforms.shapes import require_shape_name, shown_state, write_shape

    require_shape_name(file)
    shown = shown_state(load_result(result), branch, state)
    require_place_for(file)
    write_shape(file, *shown.fields)


@app.command()
def check(
    names: Annotated[list[str], typer.Argument(metavar="CASE...", help="Ids of cases.")],
    jobs: Jobs,
    out: Out = Path("out"),
    resume: Resume = False,
) -> None:
    """Solve and check single cases."""
    from weakforms.verification.cases.discovery import get_case
    from weakforms.verification.run import verbs

    names = list(dict.fromkeys(names))
    verbs.verify([get_case(name) for name in names], out, "full", " ".join(names), jobs, resume)


@app.command()
def verify(
    jobs: Jobs,
    paper: Annotated[int | None, typer.Option(min=1, max=5, help="Only this paper.")] = None,
    expression: Annotated[
        str | None, typer.Option("-k", metavar="EXPR", help="Select cases by name, with and, or, not.")
    ] = None,
    profile: Annotated[str, typer.Option(help="quick or full.")] = "full",
    resume: Resume = False,
    out: Out = Path("out"),
) -> None:
    """Solve and check all cases, then write the report."""
    from weakforms.verification.cases.discovery import select
    from weakforms.verification.run import verbs

    if profile not in ("quick", "full"):
        raise InputError(f"--profile {profile!r}: allowed are quick and full")
    cases = select(paper, expression)
    if profile == "quick":
        cases = [found for found in cases if found.case.quick]
        if not cases:
            raise InputError("none of the selected cases is in the quick profile")
    words = [f"paper {paper}"] if paper else []
    words += [f"-k {expression!r}"] if expression else []
    verbs.verify(cases, out, profile, ", ".join(words) or "all cases", jobs, resume)


@app.command()
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


@app.command()
def compare(  # noqa: PLR0913, PLR0917  (one an option)
    case: Annotated[str, typer.Argument(help="Id of a case.")],
    file: Annotated[Path, typer.Argument(help="CSV or JSON with the curve.")],
    curve: Annotated[str | None, typer.Option(help="Which curve of the case.")] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(help="Relative accuracy that the curve claims; default: what the case asks for."),
    ] = None,
    names: Annotated[
        list[str] | None,
        typer.Option(
            "--map", metavar="OURS=THEIRS", help="Name of a column in the file, if it is different."
        ),
    ] = None,
    constants: Annotated[
        list[str] | None,
        typer.Option(
            "--constant", metavar="NAME=VALUE", help="Radius, modulus or thickness, for a curve with units."
        ),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option("--column", metavar="NAME", help="Judge only this column; may be repeated."),
    ] = None,
    branch: Annotated[
        str | None, typer.Option(help="Branch of the file; default: the one that the case draws.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for verdicts.json, pictures and a page that shows both.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Compare a curve of another code with the reference table of a case.

    The curve must have every column that the case judges, unless --column selects some. Exit status: 0 within
    bounds, 1 out of bounds, 2 bad input (also a result for other parameters), 5 not judged (a column is
    missing, or the table is too coarse for the accuracy in most of its rows).
    """
    from weakforms.verification.cases.catalogue import print_verdicts
    from weakforms.verification.crosscheck.compare import compare as compare_curve

    given = (once("--map", names), once("--constant", constants))
    verdicts = compare_curve(case, file, curve, accuracy, *given, only, branch)
    if out is not None:
        from weakforms.verification.report.verdict_page import write_verdicts

        write_verdicts(verdicts, out)
    if as_json:
        print_json(verdicts.to_json())
    else:
        print_verdicts(verdicts, console())
    if not verdicts.passed:
        raise typer.Exit(verdicts.exit_status)


@app.command()
def batch(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of request files, *.json.")],
    out: Annotated[Path | None, typer.Option(help="Folder for the answers; default: DIR/results.")] = None,
    resume: Resume = False,
) -> None:
    """Answer a folder of requests: solutions and verdicts, one file each.

    The exit status is the largest of all requests (0 within bounds, 1 out of bounds, 2 bad input, 3 a solve
    did not converge, 4 something is not installed, 5 not judged).
    """
    from weakforms.verification.run.requests import run_batch

    with progress_bar() as progress:
        answers = run_batch(folder, out, resume, rank() == 0, progress)
    for found in answers if rank() == 0 else ():
        console().print(plain(f"{found.name}: {found.status} {found.message}".rstrip()), soft_wrap=True)
    worst = max(found.status for found in answers)
    if worst:
        raise typer.Exit(worst)


@app.command()
def bench(
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Only this problem; may be repeated.")
    ] = None,
    cold: Annotated[bool, typer.Option(help="Also start without compiled forms; takes minutes.")] = True,
    as_json: Json = False,
    surface: Annotated[
        int,
        typer.Option(
            min=0, max=2_000_000, help="Refine the triangulated tube up to this number of unknowns."
        ),
    ] = 0,
) -> None:
    """Measure time and memory by stage for fixed problems, with and without compiled forms."""
    from weakforms import api
    from weakforms.verification.audit.bench import print_bench, run_bench
    from weakforms.verification.audit.bench_surface import print_surface_bench, run_surface_bench

    api.require_environment()
    with progress_bar() as progress:
        if surface:
            table = run_surface_bench(surface, progress)
        else:
            table = run_bench(progress, tuple(only or ()), cold)
    if rank() != 0:
        return
    if as_json:
        print_json(table)
    elif surface:
        print_surface_bench(table, console())
    else:
        print_bench(table, console())


@app.command()
def faults(  # noqa: PLR0913, PLR0917  (one verb, its options)
    jobs: Jobs,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Only this fault; may be repeated.")
    ] = None,
    expression: Annotated[
        str | None,
        typer.Option(
            "-k",
            metavar="EXPR",
            help="Select faults by name, area, subject or file; with --measure, files of tests and cases.",
        ),
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List the faults without running them.")] = False,
    random: Annotated[
        int | None,
        typer.Option("--random", metavar="N", help="Run N random mutants instead of the catalogue."),
    ] = None,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the draw of --random.")] = 1,
    budget: Annotated[
        float,
        typer.Option(
            metavar="SECONDS", help="Time after which no further test of a random mutant is started."
        ),
    ] = 300.0,
    measured: Annotated[
        bool, typer.Option("--measure", help="Record which lines each test and case runs, for --random.")
    ] = False,
    out: Out = Path("out"),
    resume: Resume = False,
    as_json: Json = False,
) -> None:
    """Put faults into scratch copies of the tree and report which check catches each."""
    from weakforms.verification.audit.faults import verb

    chosen = only or (expression and not measured)
    if sum((bool(chosen), random is not None, measured)) > 1:
        raise InputError("faults: --random, --measure and a selection of seeded faults exclude each other")
    try:
        if measured:
            status = verb.measure_verb(expression, out, resume, console())
        elif random is not None:
            status = verb.random_verb(random, seed, budget, out, jobs, resume, as_json, console(), listed)
        else:
            status = verb.faults_verb(only or [], expression, listed, out, jobs, resume, as_json, console())
    except KeyboardInterrupt:
        complain("interrupted; the same command with --resume continues")
        raise typer.Exit(130) from None
    if status:
        raise typer.Exit(status)


@app.command()
def audit(
    problems: Annotated[
        list[str] | None,
        typer.Option("--problem", metavar="NAME", help="Only this problem; may be repeated."),
    ] = None,
    sets: Annotated[
        int, typer.Option(min=1, max=10_000, help="Number of parameter sets for each problem.")
    ] = 8,
    seed: Annotated[int | None, typer.Option(min=0, help="Seed of the draws; default: today's date.")] = None,
    limit: Annotated[float, typer.Option(min=1, help="Seconds after which a solve is ended.")] = 300.0,
    out: Out = Path("out"),
    resume: Resume = False,
    as_json: Json = False,
) -> None:
    """Solve at random parameters from all allowed ranges and report which sets fail, and why."""
    from weakforms.verification.audit.any_parameters.verb import audit_verb

    try:
        status = audit_verb(problems or [], sets, seed, limit, out, resume, as_json, console())
    except KeyboardInterrupt:
        complain("interrupted; the same command with --resume and the seed continues")
        raise typer.Exit(130) from None
    if status:
        raise typer.Exit(status)


@app.command()
def coverage(
    families: Annotated[
        list[str] | None,
        typer.Option("--family", metavar="NAME", help="Only this family; may be repeated."),
    ] = None,
    sets: Annotated[int, typer.Option(min=1, max=256, help="Sets of parameters a family.")] = 2,
    held: Annotated[
        bool, typer.Option("--hold-out", help="Other sets, over wider ranges, which no rule was tuned on.")
    ] = False,
    out: Out = Path("out"),
    resume: Resume = False,
    as_json: Json = False,
) -> None:
    """Hold stated uncertainties against true errors, over the tuned sets or those held out."""
    from weakforms.verification.audit.coverage.verb import coverage_verb

    try:
        status = coverage_verb(families or [], sets, held, out, resume, as_json, console())
    except KeyboardInterrupt:
        complain("interrupted; the same with --resume goes on from what is known")
        raise typer.Exit(130) from None
    if status:
        raise typer.Exit(status)


@app.command()
def docs(
    jobs: Jobs,
    out: Annotated[Path, typer.Option("--out", help="Folder for the pages.")] = Path("out/docs"),
    pictures: Annotated[bool, typer.Option(help="Solve the examples of the problems and draw them.")] = True,
) -> None:
    """Write the documentation as static pages: guides, problems, cases, API."""
    from weakforms import api

    api.require_environment()
    from weakforms.docs.site import write_docs

    with progress_bar() as progress:
        page = write_docs(out, jobs, pictures, progress)
    console().print(f"documentation: {plain(page)}", soft_wrap=True)


@app.command(hidden=True)
def warm() -> None:
    """Solve the problems of the benchmark once, so that the image holds their compiled forms."""
    import time

    from weakforms.verification.audit.bench import measure

    for name in ("tube", "bent", "surface-small"):
        measure(name, time.time(), only_start=True)


def main() -> None:
    """Run the command line."""
    # PETSc's own handlers turn a closed pipe or a termination into a crash report.
    os.environ["PETSC_OPTIONS"] = f"{os.environ.get('PETSC_OPTIONS', '')} -no_signal_handler".strip()
    with suppress(FileNotFoundError):
        os.environ["TMPDIR"] = tempfile.gettempdir()  # MPI fails if it cannot write to its folder
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it warns if it has no folder of its own
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:  # the caller may have closed it
            stream.reconfigure(errors="backslashreplace")
    words = sys.argv[1:]
    debug = "--debug" in words
    words = [word for word in words if word != "--debug"]
    sys.exit(guarded(lambda: app(words, standalone_mode=False), debug))


if __name__ == "__main__":
    main()
