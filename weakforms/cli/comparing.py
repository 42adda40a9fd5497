"""The verbs for other programs: compare a curve, answer a folder of requests."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from weakforms.cli.app import Engine, Json, Resume, all_names, app, examples
from weakforms.errors import InputError
from weakforms.terminal import console, once, plain, print_json, progress_bar, rank


@app.command(
    epilog=examples(
        "weakforms compare paper2.fig02 mine.csv --name fig02b_delta1_1 --column p",
        "weakforms compare paper2.fig02 si.csv --map p=pressure --constant R_f=0.02 --out verdict",
        "weakforms compare paper2.fig02 n10.csv n20.csv n40.csv --name fig02b_delta1_1",
        "weakforms compare tube mine.csv alpha=0.2 delta1=1.05 --with solve --accuracy 1e-4",
        "weakforms compare tube mine.csv --with r.json --over u_max",
    )
)
def compare(  # noqa: PLR0913, PLR0917  (one an option)
    case: Annotated[
        str, typer.Argument(help="Id of a case; with --with the name of a problem.", autocompletion=all_names)
    ],
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="FILE... [NAME=VALUE]...",
            help="CSV or JSON with the curve; several files, from a coarse mesh to a fine one, are judged by "
            "their limit. With --with solve also parameters of the problem.",
        ),
    ],
    name: Annotated[
        str | None,
        typer.Option("--name", "--curve", help="Which curve of the case, as show CASE lists them."),
    ] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(help="Relative accuracy that the curve claims, up to 0.1; default: none."),
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
    against: Annotated[
        str | None,
        typer.Option(
            "--with",
            metavar="solve|RESULT.json",
            help="Compare with a solution at the parameters given and at the curve's own abscissae, or with "
            "a stored result.",
        ),
    ] = None,
    over: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="With --with: column over which the curve is compared."),
    ] = None,
    crossing: Annotated[
        int, typer.Option(min=1, help="With --with solve: which crossing of each abscissa along the branch.")
    ] = 1,
    ratio: Annotated[
        float, typer.Option(help="Size of the cells of a mesh over the size on the next one.")
    ] = 2.0,
    cause: Annotated[
        bool,
        typer.Option(
            "--cause",
            help="Solve for what explains the errors; needs DOLFINx.",
        ),
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="Folder for verdicts.json, pictures and a page that shows both.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Compare a curve of another code with the reference table of a case, a solution or a stored result.

    The curve must have every column that the case judges, unless --column selects some. Exit status: 0 within
    bounds, 1 out of bounds, 2 bad input (also a result for other parameters), 5 not judged (a column is
    missing, or claims no accuracy and needs one, or the table is too coarse for it in most of its rows).

    Without --accuracy a curve passes within what the case asks of our own code. Otherwise the verdict says
    which accuracy the curve reaches, and how to claim it; one that reaches none up to 0.1 is out of bounds.
    """
    from weakforms.verification.cases.catalogue import print_verdicts
    from weakforms.verification.crosscheck.compare import compare as compare_curve

    if out is not None:  # before anything is compared: pictures need an extra
        from weakforms.verification.report.verdict_page import write_verdicts
    files = [Path(word) for word in words if "=" not in word or Path(word).exists()]
    parameters = once("parameter", [word for word in words if Path(word) not in files])
    if parameters and against != "solve":
        raise InputError(f"{next(iter(parameters))}: parameters are given with --with solve only")
    if not files:
        raise InputError("no curve is given: name its file after the case or the problem")
    verdicts = compare_curve(
        case,
        files if len(files) > 1 else files[0],
        name,
        accuracy,
        once("--map", names),
        once("--constant", constants),
        only,
        branch,
        against=parameters if against == "solve" else against,
        over=over,
        crossing=crossing,
        ratio=ratio,
        cause=cause,
    )
    if out is not None:
        write_verdicts(verdicts, out)
    if as_json:
        print_json(verdicts.to_json())
    else:
        print_verdicts(verdicts, console())
    if not verdicts.passed:
        raise typer.Exit(verdicts.exit_status)


@app.command(epilog=examples("weakforms batch requests", "weakforms batch requests --out answers --resume"))
def batch(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of request files, *.json.")],
    out: Annotated[Path | None, typer.Option(help="Folder for the answers; default: DIR/results.")] = None,
    resume: Resume = False,
    engine: Engine = "processes",
) -> None:
    """Answer a folder of requests: solutions and verdicts, one file each.

    The exit status is the largest of all requests (0 within bounds, 1 out of bounds, 2 bad input, 3 a solve
    did not converge, 4 something is not installed, 5 not judged).
    """
    from weakforms.verification.run.executors import executor
    from weakforms.verification.run.requests import run_batch

    with executor(engine) as first, progress_bar() as progress:
        if not first:
            return
        answers = run_batch(folder, out, resume, rank() == 0, progress)
    for found in answers if rank() == 0 else ():
        console().print(plain(f"{found.name}: {found.status} {found.message}".rstrip()), soft_wrap=True)
    worst = max(found.status for found in answers)
    if worst:
        raise typer.Exit(worst)
