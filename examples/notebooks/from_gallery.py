"""Writes the scripts of ``examples/gallery`` as notebooks: ``python3 from_gallery.py FOLDER``.

A line ``# %%`` in a script begins a cell. The docstring becomes text, and the picture is shown instead of
stored. Notebooks that are there already stay as they are. ``./run notebook`` does this and opens Jupyter.
"""

import ast
import json
import re
import sys
from pathlib import Path

SCRIPTS = ("balloon", "tube", "contact", "bending", "wrinkling", "own_law")
CELL = "# %%"
GALLERY = Path(__file__).resolve().parents[1] / "gallery"


def _cell(kind: str, text: str, number: int) -> dict:
    """A cell of a notebook."""
    cell = {
        "cell_type": kind,
        "id": f"cell-{number}",
        "metadata": {},
        "source": text.splitlines(keepends=True),
    }
    return cell | ({"execution_count": None, "outputs": []} if kind == "code" else {})


def cells(source: str) -> list[tuple[str, str]]:
    """Kinds and texts of the cells of a script."""
    title, _, rest = (ast.get_docstring(ast.parse(source)) or "").partition("\n\n")
    rest = re.sub(r"\s*Run: ``.*", "", rest, flags=re.DOTALL)
    code = source.split('"""', 2)[2]
    # In a notebook a picture is shown where it is the value of a cell, and there are no words after a script.
    code = re.sub(r"^figure\.savefig\(.*\n", "figure\n", code, flags=re.MULTILINE)
    code = re.sub(r"^import sys\n", "", code, flags=re.MULTILINE)
    code = re.sub(r"^bent = .*$", "bent = True", code, flags=re.MULTILINE)
    parts = [part.strip("\n") for part in code.split(CELL + "\n")]
    return [
        ("markdown", f"# {title.rstrip('.')}\n\n{rest}"),
        *(("code", part) for part in parts if part.strip()),
    ]


def notebook(source: str) -> dict:
    """A script as a notebook of format 4.5."""
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    found = [_cell(kind, text, k) for k, (kind, text) in enumerate(cells(source))]
    inline = _cell("code", "%matplotlib inline", len(found))
    return {
        "cells": [found[0], inline, *found[1:]],
        "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }


def write(folder: Path) -> list[Path]:
    """Write the notebooks that a folder does not have."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name in SCRIPTS:
        path = folder / f"{name}.ipynb"
        if not path.exists():
            source = (GALLERY / f"{name}.py").read_text(encoding="utf-8")
            path.write_text(json.dumps(notebook(source), indent=1) + "\n", encoding="utf-8")
            written.append(path)
    return written


if __name__ == "__main__":
    for path in write(Path(sys.argv[1] if len(sys.argv) > 1 else "notebooks")):
        print(path)
