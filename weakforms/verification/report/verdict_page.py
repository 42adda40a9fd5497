"""The verdict on a curve of another code as files: JSON, a page with its pictures, and each picture."""

from __future__ import annotations

from pathlib import Path

from markupsafe import Markup

from weakforms.results.io import dumps, require_writable, write_atomically
from weakforms.verification.crosscheck.rows import FAILED
from weakforms.verification.crosscheck.verdicts import Verdicts
from weakforms.verification.report.figures.panel import panel_figure
from weakforms.verification.report.figures.svg import standalone
from weakforms.verification.report.look import LOOK
from weakforms.verification.report.pages import template


def write_verdicts(verdicts: Verdicts, folder: Path) -> Path:
    """Write ``verdicts.json``, ``COLUMN.svg`` for every column judged, and ``index.html`` with all of it.

    Args:
        verdicts: What :func:`weakforms.compare` returned.
        folder: Folder for the files; created if missing.

    Returns:
        The path of ``index.html``.

    Raises:
        InputError: If the folder cannot be written to.
    """
    require_writable(folder)
    failed = {verdict.column: (verdict,) for verdict in verdicts.verdicts if verdict.status == FAILED}
    pictures = {
        picture.name: panel_figure(picture, f"verdict-{picture.name}", failed.get(picture.name, ()))
        for picture in verdicts.pictures
    }
    for name, svg in pictures.items():
        write_atomically(folder / f"{name}.svg", standalone(svg))
    write_atomically(folder / "verdicts.json", dumps(verdicts.to_json()))
    page = template("verdicts.html").render(
        verdicts=verdicts, pictures={name: Markup(svg) for name, svg in pictures.items()}, look=LOOK
    )
    write_atomically(folder / "index.html", page)
    return folder / "index.html"
