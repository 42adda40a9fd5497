"""Triangulations in files, read by meshio."""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from weakforms.errors import EnvironmentLackError, InputError

if TYPE_CHECKING:
    import meshio

SUFFIXES = (".msh", ".vtu", ".stl")
"""Suffixes of files for surfaces."""

IGNORED = ("line", "line3", "vertex")
"""Cells that may be in a file besides triangles."""

MAX_BYTES = 512 * 2**20
"""Largest size of such a file, in bytes."""


def read_mesh(path: Path, named: str, allowed: Sequence[str]) -> meshio.Mesh:
    """A file with triangles; lines and single nodes are allowed in it too.

    Args:
        path: A file that meshio reads.
        named: The parameter and the file, for messages.
        allowed: Names of the cells that may be in it, at least one of which must be.

    Raises:
        InputError: If it cannot be read, or has other cells.
        EnvironmentLackError: Without meshio.
    """
    try:
        import meshio
    except ImportError as error:
        raise EnvironmentLackError("meshio is not installed here: apt install python3-meshio") from error
    if not path.is_file():
        raise InputError(f"{named}: there is no such file")
    if not path.stat().st_size:
        raise InputError(f"{named} is an empty file")
    if path.stat().st_size > MAX_BYTES:
        raise InputError(f"{named} is larger than {MAX_BYTES >> 20} MiB")
    said = io.StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(said):  # warnings of meshio become one line, or none
            read = meshio.read(path)
    except (Exception, SystemExit) as error:  # readers raise any exception for a damaged file
        reason = " ".join((said.getvalue() if isinstance(error, SystemExit) else str(error)).split())
        reason = reason[:200] or type(error).__name__
        raise InputError(f"{named} cannot be read: {reason}") from None
    found = {block.type for block in read.cells}
    other = sorted(found - {*allowed, *IGNORED})
    if other:
        raise InputError(f"{named} has cells of type {other[0]}; allowed: {', '.join(allowed)}")
    count = len(read.points)
    for block in read.cells:
        wrong = block.data[(block.data < 0) | (block.data >= count)]
        if wrong.size:
            what = f"a {block.type} with node {wrong[0]}; its nodes are 0 to {count - 1}"
            raise InputError(f"{named} has {what}")
    if not sum(len(block.data) for block in read.cells if block.type in allowed):
        raise InputError(f"{named} has no triangles")
    return read


def compact(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The nodes that triangles use, and the triangles with renumbered nodes."""
    used, inverse = np.unique(triangles, return_inverse=True)
    return points[used], inverse.reshape(triangles.shape)
