"""The verb that writes decks for other codes: deck."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from weakforms.cli.app import app, examples
from weakforms.errors import InputError
from weakforms.terminal import console, once, pairs, plain, progress_bar, rank


@app.command(
    epilog=examples(
        "weakforms deck tube delta1=1.1 --at p=1.5 --for calculix --out deck",
        "weakforms deck circular beta=1.1 --at p=2 --for febio --out deck",
        "weakforms deck sphere --at P=2 --for febio --out deck",
        "weakforms deck wrinkled_tube M=0.5 load=gas --at p=0.3 --for ngsolve --out deck",
    )
)
def deck(
    problem: Annotated[
        str,
        typer.Argument(
            help="tube, circular, sphere or wrinkled_tube.",
            autocompletion=lambda: ["tube", "circular", "sphere", "wrinkled_tube"],
        ),
    ],
    code: Annotated[str, typer.Option("--for", help="calculix, febio, ngsolve, sfepy or gmsh.")],
    at: Annotated[list[str], typer.Option(metavar="LOAD=VALUE", help="The load and its last value.")],
    out: Annotated[Path, typer.Option(help="Folder for the deck.")],
    words: Annotated[list[str] | None, typer.Argument(metavar="[NAME=VALUE]...", help="Parameters.")] = None,
    cells: Annotated[int, typer.Option(help="Cells along the meridian; default: a tenth of a radius.")] = 0,
) -> None:
    """Write a body as a deck for another code: mesh, boundary, material, load, and the numbers to expect.

    The folder receives a mesh and an input file or a script, expected.json with the solution, and README.txt
    with the command that runs the deck, the number to expect with its uncertainty, the errors to expect of
    this mesh, and the command that gives a verdict.
    """
    from weakforms.api import state_value
    from weakforms.decks import write_deck

    loads = [(name, state_value(name, value)) for name, value in pairs("--at", at)]
    if len(loads) != 1:
        raise InputError(f"--at: a deck has one load, not {len(loads)}")
    with progress_bar() as progress:
        found = write_deck(problem, code, loads[0], out, once("parameter", words), cells, progress)
    if rank() == 0:
        body = found.body
        console().print(
            f"deck: {plain(out)}: expect {body.over} = {found.values[-1]:.12g} at {body.load} = "
            f"{found.loads[-1]:.6g}; README.txt says how to run it, and what accuracy to claim",
            soft_wrap=True,
        )
