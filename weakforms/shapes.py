"""Deformed shapes as files other tools read, by meshio: VTU with the fields on it, or STL."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.results import Field, Result
from weakforms.results.model import State

if TYPE_CHECKING:
    import meshio

SUFFIXES = (".vtu", ".stl")

TURNS = 73
"""Meridians of a surface of revolution, the first and last the same."""


def require_shape_name(path: Path) -> None:
    """Make sure a file name says which format is wanted.

    Raises:
        InputError: When it does not.
    """
    if Path(path).suffix.lower() not in SUFFIXES:
        raise InputError(f"cannot write a shape to {path}: the name must end in {' or '.join(SUFFIXES)}")


def shown_state(result: Result, branch: str = "", number: int = 1) -> State:
    """The ``number``-th state with a profile, of one branch or any.

    Raises:
        InputError: When there are fewer.
    """
    found = [s for s in result.states if s.fields and branch in ("", s.branch)]
    if number > len(found):
        where = f" on the {branch} branch" if branch else ""
        raise InputError(
            f"state = {number}: the result has {len(found)} states with a profile{where}; "
            "solve --at NAME=VALUE adds one"
        )
    return found[number - 1]


def _meshio():  # noqa: ANN202
    try:
        import meshio
    except ImportError as error:
        raise EnvironmentLackError(
            "meshio is not installed here; use ./run, or on Debian trixie: apt install python3-meshio"
        ) from error
    return meshio


def surface(field: Field) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """A profile as a surface in space.

    A field with ``x, y, z`` over ``Z, Theta`` covers half the circumference and is mirrored in the plane
    ``y = 0``; a meridian ``r, z`` or ``rho, eta`` is revolved about the axis.

    Returns:
        Points of shape ``(rows, meridians, 3)``, and every other column over ``(rows, meridians)``.

    Raises:
        InputError: When the field is neither.
    """
    columns = field.columns
    if {"x", "y", "z", "Theta"} <= set(columns):
        return _mirrored(columns)
    for radius, height in (("r", "z"), ("rho", "eta")):
        if {radius, height} <= set(columns):
            return _revolved(columns, radius, height)
    raise InputError(f"a profile with the columns {', '.join(columns)} is no surface in space")


def _mirrored(columns: dict[str, np.ndarray]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    shape = len(np.unique(columns["Z"])), len(np.unique(columns["Theta"]))
    half = {name: values.reshape(shape) for name, values in columns.items()}
    odd = {"y": 0.0, "Theta": 2 * np.pi}  # the mirrored angle is 2 pi - Theta, the mirrored y is -y
    whole = {
        name: np.hstack([v, odd[name] - v[:, -2::-1] if name in odd else v[:, -2::-1]])
        for name, v in half.items()
    }
    points = np.stack([whole.pop(name) for name in "xyz"], axis=-1)
    return points, whole


def _revolved(
    columns: dict[str, np.ndarray], radius: str, height: str
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    theta = np.linspace(0, 2 * np.pi, TURNS)
    r = columns[radius][:, None]
    z = np.broadcast_to(columns[height][:, None], (len(r), TURNS))
    points = np.stack([r * np.cos(theta), r * np.sin(theta), z], axis=-1)
    rest = {k: np.tile(v[:, None], (1, TURNS)) for k, v in columns.items() if k not in (radius, height)}
    return points, rest | {"Theta": np.tile(theta, (len(r), 1))}


def shape_mesh(field: Field) -> meshio.Mesh:
    """The surface as a mesh of quadrilaterals, normals outwards, with the profile's columns at its points."""
    meshio = _meshio()
    points, data = surface(field)
    rows, meridians = points.shape[:2]
    index = np.arange(rows * meridians).reshape(rows, meridians)
    corners = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    quads = np.stack([corner.ravel() for corner in corners], axis=1)
    return meshio.Mesh(
        points.reshape(-1, 3), [("quad", quads)], {name: values.ravel() for name, values in data.items()}
    )


def write_shape(path: Path, field: Field) -> None:
    """Write a deformed shape: ``.vtu`` with its fields, ``.stl`` as triangles.

    The file appears under its name only when complete.

    Raises:
        InputError: For another ending, a profile that is no surface, or a place that cannot be written to.
    """
    path = Path(path)
    require_shape_name(path)
    meshio, mesh = _meshio(), shape_mesh(field)
    if path.suffix.lower() == ".stl":
        quads = mesh.cells_dict["quad"]
        triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        mesh = meshio.Mesh(mesh.points, [("triangle", triangles)])
    try:
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}.") as folder:
            written = Path(folder) / f"shape{path.suffix.lower()}"
            mesh.write(written, binary=True)
            os.replace(written, path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error
