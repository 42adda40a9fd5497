"""The verbs that work on stored results: plot, diff, export, shape."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from weakforms.cli.app import Json, app, examples
from weakforms.errors import InputError
from weakforms.terminal import complain, console, plain, print_json, progress_bar, rank

Stored = Annotated[Path, typer.Argument(metavar="RESULT.json", help="Result that solve --out wrote.")]


@app.command(
    epilog=examples(
        "weakforms plot r.json",
        "weakforms plot a.json b.json --x V --y p --out both.pdf",
        "weakforms plot r.json --x Z --y rho --out profiles.svg",
    )
)
def plot(
    files: Annotated[list[Path], typer.Argument(metavar="RESULT.json...", help="Results of solve --out.")],
    x: Annotated[str, typer.Option(metavar="NAME", help="Column of the abscissa.")] = "",
    y: Annotated[
        str, typer.Option(metavar="NAME", help="Column of the ordinate; default: the control.")
    ] = "",
    out: Annotated[Path, typer.Option(help="Picture: .png, .svg or .pdf.")] = Path("plot.png"),
) -> None:
    """Draw branches with their special points, stability and ends, or profiles of states.

    Unstable parts are dashed. If both columns belong to profiles, such as Z and rho, the profiles are drawn.
    A diagram is drawn in its plane.
    """
    from weakforms.results import load_result
    from weakforms.results.diagram import draw
    from weakforms.results.plot import require_picture_name, save

    require_picture_name(out)
    names = [file.stem for file in files]
    keys = names if len(set(names)) == len(names) else [str(file) for file in files]
    results = {key: load_result(file) for key, file in zip(keys, files, strict=True)}
    save(draw(results if len(results) > 1 else {"": results[keys[0]]}, x, y), out)
    console().print(f"picture: {plain(out)}", soft_wrap=True)


@app.command(epilog=examples("weakforms diff a.json b.json", "weakforms diff a.json b.json --json"))
def diff(
    first: Stored,
    second: Stored,
    as_json: Json = False,
) -> None:
    """Compare two results number by number, with their uncertainties.

    Two numbers agree within twice their combined uncertainty. Exit status: 0 all agree, 1 some do not, 2 the
    files cannot be compared.
    """
    from weakforms.cli.screen import print_diff
    from weakforms.results import load_result
    from weakforms.verification.audit.diff import diff as compared

    found = compared(load_result(first), load_result(second))
    if as_json:
        print_json(found.to_json())
    else:
        print_diff(found, console(), str(first), str(second))
    if not found.same:
        raise typer.Exit(1)


@app.command(epilog=examples("weakforms export r.json out/r", "weakforms export r.json out/r --frames 40"))
def export(
    file: Stored,
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder for the files.")],
    frames: Annotated[
        int, typer.Option(min=0, max=1000, help="Solve for this number of states along the branch.")
    ] = 0,
    branch: Annotated[str, typer.Option(help="Branch of the shapes; default: all, or primary.")] = "",
) -> None:
    """Write a result as CSV tables, and its shapes as a series for ParaView (shapes.pvd).

    The shapes are those of the states of the result, or with --frames of states along a whole branch, which
    the tables have after the states of the result.
    """
    from weakforms.export import along
    from weakforms.export import export as write
    from weakforms.results import load_result
    from weakforms.results.io import require_writable

    result = load_result(file)
    if frames == 1:
        raise InputError("--frames 1: two states or more make a series")
    require_writable(folder)
    states, failures = [], [*result.failures]
    if frames:
        with progress_bar() as progress:
            solved = along(result, branch or "primary", frames, progress)
        states = solved.states
        failures += solved.failures
    if rank() == 0:
        for path in write(result, folder, branch, states):
            console().print(plain(path), soft_wrap=True)
        for failure in failures:
            complain(f"not converged: {failure.what}: {failure.reason}")
    if frames and failures:
        raise typer.Exit(3)


@app.command(epilog=examples("weakforms shape r.json tube.vtu", "weakforms shape r.json tube.stl --state 2"))
def shape(
    result: Stored,
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
