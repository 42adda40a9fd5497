"""The verbs that test the suite itself: audit, coverage, faults, bench."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from weakforms.cli.app import Jobs, Json, Out, Resume, app, examples
from weakforms.errors import InputError
from weakforms.terminal import complain, console, print_json, progress_bar, rank


class SurfaceBody(StrEnum):
    """Surfaces that ``bench --surface`` refines."""

    TUBE = "tube"
    SQUARE = "square"


def _ended(verb: Callable[[], int], again: str = "--resume") -> None:
    """Run a verb that stores its results as it goes, and end with its exit status if that is not zero."""
    try:
        status = verb()
    except KeyboardInterrupt:
        complain(f"interrupted; the same command with {again} continues")
        raise typer.Exit(130) from None
    if status:
        raise typer.Exit(status)


@app.command(epilog=examples("weakforms audit --problem tube --sets 4", "weakforms audit --seed 7 --resume"))
def audit(
    problems: Annotated[
        list[str] | None,
        typer.Option("--problem", metavar="NAME", help="Only this problem; may be repeated."),
    ] = None,
    sets: Annotated[
        int, typer.Option(min=1, max=10_000, help="Number of parameter sets for each problem.")
    ] = 8,
    seed: Annotated[int | None, typer.Option(min=0, help="Seed of the draws; default: today's date.")] = None,
    limit: Annotated[
        float, typer.Option(min=1, help="Seconds of processor time after which a solve is ended.")
    ] = 300.0,
    out: Out = Path("out"),
    resume: Resume = False,
    as_json: Json = False,
) -> None:
    """Solve at random parameters from all allowed ranges and report which sets fail, and why."""
    from weakforms.verification.audit.any_parameters.verb import audit_verb

    again = "--resume and the seed"
    _ended(lambda: audit_verb(problems or [], sets, seed, limit, out, resume, as_json, console()), again)


@app.command(epilog=examples("weakforms coverage --family tube", "weakforms coverage --sets 8 --hold-out"))
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

    _ended(lambda: coverage_verb(families or [], sets, held, out, resume, as_json, console()))


@app.command(
    epilog=examples(
        "weakforms faults --list", "weakforms faults -k tube", "weakforms faults --random 20 --seed 3"
    )
)
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
    shared = out, jobs, resume, as_json, console()
    if measured:
        _ended(lambda: verb.measure_verb(expression, out, jobs, resume, console()))
    elif random is not None:
        _ended(lambda: verb.random_verb(random, seed, budget, *shared, listed))
    else:
        _ended(lambda: verb.faults_verb(only or [], expression, listed, *shared))


@app.command(
    epilog=examples(
        "weakforms bench --only tube",
        "weakforms bench --history bench.jsonl",
        "weakforms bench --against bench.jsonl",
        "weakforms bench --surface 370000 --history out/scaling.jsonl",
    )
)
def bench(
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Only this problem; may be repeated.")
    ] = None,
    cold: Annotated[bool, typer.Option(help="Also start without compiled forms; takes minutes.")] = True,
    as_json: Json = False,
    surface: Annotated[
        int,
        typer.Option(
            min=0, max=2_000_000, help="Refine a triangulated surface up to this number of unknowns."
        ),
    ] = 0,
    body: Annotated[
        SurfaceBody, typer.Option(help="The surface: a tube under a liquid, or a square under gas.")
    ] = SurfaceBody.TUBE,
    history: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Add this run to a file of JSON lines; a report shows scaling.jsonl of its folder.",
        ),
    ] = None,
    against: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Say what is slower than in the last run of such a file, by ratios to the floor; exit "
            "status 1 if anything is.",
        ),
    ] = None,
) -> None:
    """Measure time and memory by stage for fixed problems, with and without compiled forms."""
    from weakforms import api
    from weakforms.verification.audit.bench import print_bench, run_bench
    from weakforms.verification.audit.bench_surface import print_surface_bench, run_surface_bench

    api.require_environment()
    from weakforms.verification.audit import bench_history, bench_ranks

    if surface and against:
        raise InputError("bench: --surface has no ratios; --against excludes it")
    before = bench_history.last(against) if against else {}
    with progress_bar() as progress:
        if surface:
            table = run_surface_bench(surface, progress, body.value)
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
    if history:
        (bench_ranks if surface else bench_history).append(history, table)
    lines, found = bench_history.slower(table, before) if not surface else ([], [])
    for line in lines:
        console(stderr=as_json).print(line, soft_wrap=True)
    if found:
        raise typer.Exit(1)


@app.command(hidden=True)
def warm() -> None:
    """Solve the problems of the benchmark once, so that the image holds their compiled forms."""
    import time

    from weakforms.verification.audit.bench import measure

    for name in ("tube", "bent", "surface-small"):
        measure(name, time.time(), only_start=True)
