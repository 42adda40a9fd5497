"""The application, and the options that several verbs declare alike."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from typer.core import TyperGroup

from weakforms.errors import InputError, not_among
from weakforms.terminal import free_cores


class Verbs(TyperGroup):
    """The verbs; an unknown one is refused with the name of a similar one."""

    def get_command(self, ctx: typer.Context, cmd_name: str) -> typer.core.TyperCommand | None:
        """As typer does; help shows no default where there is none."""
        found = super().get_command(ctx, cmd_name)
        for parameter in found.params if found else ():
            if parameter.default is None and not isinstance(parameter.show_default, str):
                parameter.show_default = False
        return found

    def resolve_command(self, ctx: typer.Context, args: list[str]) -> tuple:
        """As click does.

        Raises:
            InputError: If there is no such verb.
        """
        if self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            verbs = [name for name in self.list_commands(ctx) if not self.commands[name].hidden]
            raise InputError(f"there is no verb {args[0]!r}{not_among(args[0], verbs, 'the verbs are')}")
        return super().resolve_command(ctx, args)


app = typer.Typer(
    name="weakforms",
    cls=Verbs,
    help="FEniCSx weak-form verification suite of inflation and instabilities of hyperelastic membranes.",
    epilog="weakforms VERB --help explains a verb and shows examples.",
    no_args_is_help=True,
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
Engine = Annotated[
    str,
    typer.Option(
        "--executor",
        metavar="processes|mpi|dask:ADDRESS",
        help="What solves: processes of this machine (-j), the other ranks of mpirun, a Dask cluster.",
    ),
]
Resume = Annotated[bool, typer.Option("--resume", help="Keep what an interrupted run stored.")]


def examples(*lines: str) -> str:
    """The end of a verb's help: commands to copy, one a line."""
    # Typer joins lines within a paragraph, so that each command is a paragraph.
    return "\n\n".join(["Examples:", *(f"  {line}" for line in lines)])


def problem_names() -> list[str]:
    """Names of the problems, without importing dolfinx: for the completion of a shell."""
    from weakforms.problems.registry import abouts

    return list(abouts())


def case_names() -> list[str]:
    """Ids of the cases, for the completion of a shell."""
    from weakforms.verification.cases.discovery import case_ids

    return case_ids()


def all_names() -> list[str]:
    """Names of the problems and ids of the cases, for the completion of a shell."""
    return [*problem_names(), *case_names()]


def _version(wanted: bool) -> None:
    if wanted:
        from weakforms import __version__

        typer.echo(f"weakforms {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    debug: Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")] = False,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Define the options before the verb."""
