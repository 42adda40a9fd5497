"""The verb that follows critical points in a plane of two parameters: diagram."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, get_args

import typer

from weakforms.cli.app import app, examples
from weakforms.cli.solving import end_of, solved
from weakforms.errors import InputError
from weakforms.terminal import complain, console, plain, rank, request


def _bodies() -> list[str]:
    from weakforms.problems.diagram.about import Body

    return list(get_args(Body))


@app.command(
    epilog=examples(
        "weakforms diagram tube --plane delta1 p --set alpha=0.1 --kind fold",
        "weakforms diagram tube --plane alpha p --out d.json --picture d.svg",
        "weakforms diagram tube --plane lf p --set alpha=0.05 --set low=5 --set high=9",
        "weakforms diagram tube --plane lf p --kind fold,n1 --set alpha=0 --set u_end=2.5",
        "weakforms diagram circular --plane alpha p",
        "weakforms diagram hemisphere --plane angle p --set alpha=0 --kind fold",
        "weakforms diagram sphere --plane mu2 p model=ogden low=0.0005 high=0.02 --kind fold,n1",
        "weakforms diagram infinite_tube --plane lam1 p ends=held --kind localisation,n1",
        "weakforms diagram fluid_tube --plane delta zw alpha=0 low=3.2 high=9 --kind fold,n1,n2,n3",
    )
)
def diagram(
    problem: Annotated[
        str,
        typer.Argument(
            help="tube, circular, hemisphere, sphere, infinite_tube or fluid_tube.", autocompletion=_bodies
        ),
    ],
    plane: Annotated[
        tuple[str, str],
        typer.Option(metavar="X Y", help="The two parameters; one of them is p (zw of fluid_tube)."),
    ],
    words: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME=VALUE]...", help="Parameters, as with --set.")
    ] = None,
    kind: Annotated[
        str,
        typer.Option(
            metavar="KIND,...",
            help="fold, mirror, localisation, n1, n2, n3, wrinkling, contact; default: all but n1 to n3.",
        ),
    ] = "all",
    sets: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="NAME=VALUE", help="A parameter: of the membrane, or low and high of the plane."
        ),
    ] = None,
    mesh: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="A numerical setting: degree, cells, levels."),
    ] = None,
    out: Annotated[Path | None, typer.Option(help="File for the result.")] = None,
    picture: Annotated[Path, typer.Option(help="Picture: .png, .svg or .pdf.")] = Path("diagram.png"),
) -> None:
    """Follow limit points, broken symmetry, first wrinkling and first contact in a plane, and draw them.

    Of a sphere and a long tube the lines are those of any law: limit points, pears (n1), long waves.

    It solves the problem diagram, and writes the same result. Points at which two conditions hold are
    located: cusps, tips, coincidences. Regions of the picture are labelled with the numbers of negative
    eigenvalues of their states.
    """
    from weakforms import api
    from weakforms.cli.screen import print_result
    from weakforms.results.diagram import draw_diagram
    from weakforms.results.io import dumps, write_atomically
    from weakforms.results.plot import require_picture_name, save
    from weakforms.results.wording import notes

    x, y = plane
    given = request(None, [*(words or []), *(sets or [])], None, mesh)
    own = {"body": problem, "x": x, "y": y, "kind": kind}
    twice = sorted(own.keys() & given["parameters"].keys())
    if twice:
        raise InputError(f"--set {twice[0]}: the verb's argument or option of this name gives it")
    given["parameters"] |= own
    solve_it = api.prepare("diagram", **given)
    require_picture_name(picture)
    result, data = solved(solve_it, out)
    if rank() == 0:
        if out is not None:
            write_atomically(out, dumps(data))
        print_result(result, console(), str(out or ""))
        if result.branches:
            save(draw_diagram(result, x, y), picture)
            console().print(f"picture: {plain(picture)}", soft_wrap=True)
        for note in notes(result):
            complain(note)
    end_of(result)
