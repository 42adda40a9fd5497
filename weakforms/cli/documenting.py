"""The verbs that write what is published: docs, archive."""

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


@app.command(epilog=examples("weakforms archive --out weakforms-0.1.0.zip"))
def archive(
    out: Annotated[Path, typer.Option("--out", help="The zip file.")] = Path("out/weakforms.zip"),
) -> None:
    """Write the committed tree as a zip file for a data repository that gives it a DOI.

    It contains the checksum of every file (SHA256SUMS), the metadata of a repository (.zenodo.json,
    from CITATION.cff), and the licences of code and data. The same commit gives the same file.
    """
    from weakforms.archive import write_archive
    from weakforms.verification.cases.references import ROOT

    digest = write_archive(ROOT, out)
    console().print(f"archive: {plain(out)}\nsha256: {digest}", soft_wrap=True)
