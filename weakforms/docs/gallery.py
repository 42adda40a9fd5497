"""The scripts of ``examples/gallery`` as a page: the text, the picture and the source of each."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from markupsafe import Markup

from weakforms.docs.prose import docstring
from weakforms.terminal import WorkProgress
from weakforms.verification.cases.references import ROOT
from weakforms.verification.report.figures.svg import inline_svg

FOLDER = ROOT / "examples" / "gallery"
ORDER = ("shapes", "balloon", "tube", "contact", "bending", "wrinkling", "own_law")
"""Scripts in the order of the page; others follow by name."""


@dataclass(frozen=True)
class Shown:
    """A script with its picture."""

    name: str
    title: str
    text: Markup
    source: str
    picture: Markup | None = None
    failure: str = ""
    """Why there is no picture, if the script was run."""


def scripts() -> list[str]:
    """Names of the scripts; none in an installed package."""
    found = {path.stem for path in FOLDER.glob("*.py")}
    return [name for name in ORDER if name in found] + sorted(found - set(ORDER))


def gallery(out: Path, names: Iterable[str], progress: WorkProgress | None = None) -> list[Shown]:
    """Every script, with the pictures of some of them.

    Args:
        out: Folder for the pictures; created if missing.
        names: Scripts that are run for their pictures.
        progress: Called with the script that runs.
    """
    wanted, shown = list(names), []
    for name in scripts():
        source = (FOLDER / f"{name}.py").read_text("utf-8")
        title, _, text = (ast.get_docstring(ast.parse(source)) or name).partition("\n")
        picture, failure = None, ""
        if name in wanted:
            if progress is not None:
                progress(f"gallery: {name}", wanted.index(name), len(wanted))
            picture, failure = _drawn(out, name, title)
        shown.append(Shown(name, title, docstring(text), source, picture, failure))
    return shown


def _drawn(out: Path, name: str, title: str) -> tuple[Markup | None, str]:
    """The picture that a script draws, or the reason why there is none."""
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"{name}.svg"
    command = [sys.executable, str(FOLDER / f"{name}.py"), str(path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode or not path.exists():
        return None, (done.stderr.strip().splitlines() or ["it drew nothing"])[-1]
    return Markup(inline_svg(path.read_text("utf-8"), f"gallery-{name}", title, title, {})), ""
