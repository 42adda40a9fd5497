"""The verb that writes the documentation: docs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from weakforms.cli.app import Jobs, app, examples
from weakforms.terminal import console, plain, progress_bar


@app.command(epilog=examples("weakforms docs --out out/docs", "weakforms docs --no-pictures"))
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
