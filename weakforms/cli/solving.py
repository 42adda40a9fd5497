"""The verbs that solve problems or show what there is: list, show, solve, sweep."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from weakforms.cli.app import Engine, Jobs, Json, Resume, all_names, app, examples, problem_names
from weakforms.errors import InputError
from weakforms.results import Result
from weakforms.terminal import (
    complain,
    console,
    once,
    pairs,
    print_json,
    progress_bar,
    rank,
    request,
)


@app.command("list", epilog=examples("weakforms list", "weakforms list --paper 2 --json"))
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


@app.command(epilog=examples("weakforms show tube", "weakforms show paper2.fig03", "weakforms show r.json"))
def show(
    name: Annotated[
        str,
        typer.Argument(help="A problem, a case, or a file with a result.", autocompletion=all_names),
    ],
    as_json: Json = False,
) -> None:
    """Show a problem's parameters, ranges and energy, a case's source, checks and references, or a result."""
    from weakforms.verification.cases.catalogue import describe, print_description

    if name.lower().endswith(".json"):
        from weakforms.cli.screen import print_result
        from weakforms.results import load_result

        result = load_result(Path(name))
        print_json(result.to_json()) if as_json else print_result(result, console(), name)
        return

    facts = describe(name)
    if as_json:
        print_json(facts)
    else:
        print_description(facts, console())


@app.command(
    epilog=examples(
        "weakforms solve tube delta1=1.1 alpha=0.1",
        "weakforms solve tube delta1=1.1 --at p=1.9 --crossing all --out r.json",
        "weakforms solve circular contact=adhesive k=50 --at p=2 --json > r.json",
        "weakforms solve sphere model=ogden --format csv --out branch.csv",
        "weakforms solve tube alpha=0.2 --accuracy 1e-6",
    )
)
def solve(  # noqa: PLR0913, PLR0917  (one an option)
    problem: Annotated[
        str,
        typer.Argument(help="Name of the problem; see: weakforms list.", autocompletion=problem_names),
    ],
    words: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME=VALUE]...", help="Parameters, as with --set.")
    ] = None,
    sets: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A parameter.")
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="Also solve for a state: a column and its value, or a kind of special point and its number; "
            "NAME=@FILE solves at every value of that column in a CSV file.",
        ),
    ] = None,
    crossing: Annotated[
        str, typer.Option(metavar="K|all", help="Which crossing of that value along the branch.")
    ] = "1",
    branch: Annotated[str, typer.Option(help="Branch on which the state lies.")] = "primary",
    mesh: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="A numerical setting: degree, cells, levels."),
    ] = None,
    spec: Annotated[
        Path | None,
        typer.Option(metavar="FILE.json", help="Request file with parameters, at, numerics."),
    ] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(
            metavar="A", help="Choose meshes on which the bound of every number is at most a tenth of A."
        ),
    ] = None,
    out: Annotated[Path | None, typer.Option(help="File for the result.")] = None,
    form: Annotated[
        str | None, typer.Option("--format", help="json or csv (csv: the branches only).")
    ] = None,
    as_json: Json = False,
) -> None:
    """Solve one problem at any parameters, show a summary and write the result as JSON.

    On a terminal the result is summed up, and --out keeps it. Where standard output is a file or a pipe, and
    without --out, it receives the result itself; --json and --format do so on a terminal too.
    """
    from weakforms import api
    from weakforms.cli.screen import print_result
    from weakforms.results.io import branch_csv, dumps, write_atomically
    from weakforms.results.wording import notes

    if form not in (None, "json", "csv"):
        raise InputError(f"--format {form!r}: allowed are json and csv")
    if as_json and form == "csv":
        raise InputError("--json and --format csv exclude each other")
    given = request(spec, [*(words or []), *(sets or [])], at, mesh)
    solve_it = api.prepare(problem, **given, crossing=_crossing(crossing), branch=branch, accuracy=accuracy)
    result, data = solved(solve_it, out)
    if rank() == 0:
        text = branch_csv(result) if form == "csv" else dumps(data)
        if out is not None:
            write_atomically(out, text)
        terminal = sys.stdout.isatty()
        if as_json or (out is None and (form or not terminal)):
            sys.stdout.write(text)
        elif terminal:
            print_result(result, console(), str(out or ""))
            end_of(result)
            return
        for note in notes(result):
            complain(note)
    end_of(result)


def solved(solve_it: Callable[[Any], Result], out: Path | None) -> tuple[Result, dict[str, Any]]:
    """Solve with a progress bar; the result, and its data as JSON, which follow the schema.

    Raises:
        InputError: If the result cannot be written to its place; nothing was solved then.
    """
    from weakforms.results.io import require_place_for, validate

    if out is not None:
        require_place_for(out)
    with progress_bar() as progress:
        result = solve_it(progress)
    data = result.to_json()
    validate(data)
    return result, data


def end_of(result: Result) -> None:
    """End with status 3 if something did not converge."""
    if result.failures:
        raise typer.Exit(3)


def _crossing(text: str) -> int | Literal["all"]:
    """The option ``--crossing``.

    Raises:
        InputError: If it is neither a whole number nor ``all``.
    """
    if text == "all":
        return "all"
    try:
        return int(text)
    except ValueError:
        raise InputError(f"--crossing {text!r}: a whole number from 1, or all, is wanted") from None


@app.command(
    epilog=examples(
        "weakforms sweep tube delta1=1:1.2:0.02 --out out/delta1 -j 2",
        "weakforms sweep tube delta1=1:1.2:0.1 alpha=0.1:0.3:0.1 lf=8 --at u_max=1 --resume",
    )
)
def sweep(  # noqa: PLR0913, PLR0917  (one an option)
    problem: Annotated[
        str, typer.Argument(help="Name of the problem; see: weakforms list.", autocompletion=problem_names)
    ],
    words: Annotated[
        list[str],
        typer.Argument(metavar="NAME=FIRST:LAST:STEP...", help="Parameters to vary; NAME=VALUE for others."),
    ],
    jobs: Jobs,
    at: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="Also solve for a state of each; as for solve."),
    ] = None,
    crossing: Annotated[
        str, typer.Option(metavar="K|all", help="Which crossing of that value along the branch.")
    ] = "1",
    branch: Annotated[str, typer.Option(help="Branch on which these states lie.")] = "primary",
    mesh: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="A numerical setting: degree, cells, levels."),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the table and all solutions.")] = Path("out/sweep"),
    resume: Resume = False,
    engine: Engine = "processes",
) -> None:
    """Solve a problem at all combinations of parameters; a table of special points and chosen states.

    The folder receives sweep.csv with a row for each special point, state, end of a branch and failure (and
    sweep.parquet, if pandas and pyarrow are installed), and every solution as JSON.
    """
    from weakforms.api import state_value
    from weakforms.cli.screen import print_sweep
    from weakforms.verification.cases.specs import At
    from weakforms.verification.run import sweep as sweeps
    from weakforms.verification.run.executors import executor

    given = once("parameter", words)
    ranges = {name: sweeps.span(value) for name, value in given.items()}
    parameters = {name: ranges[name] or value for name, value in given.items()}
    states = [At(n, state_value(n, v), _crossing(crossing), branch=branch) for n, v in pairs("--at", at)]
    try:
        with executor(engine) as first, progress_bar() as progress:
            if not first:
                return
            done = sweeps.sweep(
                problem,
                out,
                at=states,
                numerics=once("--mesh", mesh),
                jobs=jobs,
                resume=resume,
                progress=progress,
                **parameters,
            )
    except KeyboardInterrupt:
        complain("interrupted; the same command with --resume continues")
        raise typer.Exit(130) from None
    if rank() == 0:
        print_sweep(done, console(), out / sweeps.TABLE)
    if not done.complete:
        raise typer.Exit(3)
