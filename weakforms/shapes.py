"""Deformed shapes as files for other tools, by meshio: VTU or XDMF with fields, or STL."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.results import Field, Result
from weakforms.results.model import State

if TYPE_CHECKING:
    import meshio

SUFFIXES = (".vtu", ".xdmf", ".stl")

TRIANGLES = "triangles"
"""Name of the field that lists the corners of triangles, as points of the field before it."""

TURNS = 73
"""Number of meridians of a surface of revolution; the first and the last are the same."""


def require_shape_name(path: Path) -> None:
    """Make sure that the ending of a file name is one of the known formats.

    Raises:
        InputError: If it is not.
    """
    if Path(path).suffix.lower() not in SUFFIXES:
        raise InputError(f"cannot write a shape to {path}: the name must end in {', '.join(SUFFIXES)}")


def shown_state(result: Result, branch: str = "", number: int = 1) -> State:
    """The ``number``-th state with a profile, on one branch or on any.

    Raises:
        InputError: If there are fewer.
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
    """The surface in space that a profile describes.

    A field with ``x, y, z`` over ``Z, Theta`` that covers half the circumference is mirrored in the plane
    ``y = 0``; a meridian ``r, z`` or ``rho, eta`` is rotated about the axis. So is the radius ``r, turn`` of
    a flat sheet in the plane ``z = 0``, after each of its points was turned by the angle ``turn``.

    Returns:
        Points of shape ``(rows, meridians, 3)``, and every other column over ``(rows, meridians)``.

    Raises:
        InputError: If the field is neither.
    """
    columns = field.columns
    if {"x", "y", "z", "Theta"} <= set(columns):
        return _mirrored(columns)
    for radius, height in (("r", "z"), ("rho", "eta")):
        if {radius, height} <= set(columns):
            return _revolved(columns, radius, height)
    if {"r", "turn"} <= set(columns):
        flat = columns | {"z": np.zeros_like(columns["r"])}
        return _revolved(flat, "r", "z", columns["turn"])
    raise InputError(f"a profile with the columns {', '.join(columns)} is not a surface in space")


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
    columns: dict[str, np.ndarray], radius: str, height: str, turn: np.ndarray | float = 0.0
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    theta = np.linspace(0, 2 * np.pi, TURNS)
    r = columns[radius][:, None]
    z = np.broadcast_to(columns[height][:, None], (len(r), TURNS))
    angle = theta + np.reshape(turn, (-1, 1))
    points = np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)
    rest = {k: np.tile(v[:, None], (1, TURNS)) for k, v in columns.items() if k not in (radius, height)}
    return points, rest | {"Theta": np.tile(theta, (len(r), 1))}


def shape_mesh(field: Field, *more: Field) -> meshio.Mesh:
    """The surface as a mesh with outward normals and the profile's columns at its points.

    The mesh consists of triangles if a field of that name lists them (corners ``a, b, c``; its other columns
    are values on the triangles), else of quadrilaterals.
    """
    meshio = _meshio()
    cells = next((f.columns for f in more if f.name == TRIANGLES), None)
    if cells is not None:
        points = np.column_stack([field.columns[name] for name in "xyz"])
        data = {name: values for name, values in field.columns.items() if name not in "xyz"}
        corners = np.column_stack([cells[name] for name in "abc"]).astype(int)
        if not len(corners) or corners.min() < 0 or corners.max() >= len(points):
            raise InputError(f"a triangle's corner is none of the {len(points)} points")
        rest = {name: [np.asarray(v, float)] for name, v in cells.items() if name not in ("a", "b", "c")}
        return meshio.Mesh(points, [("triangle", corners)], data, rest)
    points, data = surface(field)
    rows, meridians = points.shape[:2]
    index = np.arange(rows * meridians).reshape(rows, meridians)
    corners = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    quads = np.stack([corner.ravel() for corner in corners], axis=1)
    return meshio.Mesh(
        points.reshape(-1, 3), [("quad", quads)], {name: values.ravel() for name, values in data.items()}
    )


def write_shape(path: Path, field: Field, *more: Field) -> None:
    """Write a deformed shape: ``.vtu`` or ``.xdmf`` with its fields, ``.stl`` as triangles.

    The file appears under its name only when complete.

    Raises:
        InputError: If the ending is another, the profile is not a surface, or the file cannot be written.
    """
    path = Path(path)
    require_shape_name(path)
    meshio = _meshio()
    try:
        mesh = shape_mesh(field, *more)
    except (KeyError, ValueError, IndexError, TypeError) as error:  # the result file may come from anywhere
        raise InputError(f"the profile is not a surface in space: {type(error).__name__}: {error}") from error
    mesh.point_data, mesh.cell_data = _named(mesh.point_data), _named(mesh.cell_data)
    suffix = path.suffix.lower()
    if suffix == ".stl":
        quads = mesh.cells_dict.get("quad", np.empty((0, 4), dtype=int))
        whole = mesh.cells_dict.get("triangle", np.empty((0, 3), dtype=int))
        triangles = np.vstack([whole, quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        mesh = meshio.Mesh(mesh.points, [("triangle", triangles)])
    try:
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}.") as folder:
            written = Path(folder) / f"shape{suffix}"
            if suffix == ".xdmf":
                written.write_text(xdmf(mesh), encoding="utf-8")
            else:
                mesh.write(written, binary=True)
            os.replace(written, path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error


def _named(data: dict[str, Any]) -> dict[str, Any]:
    """The same columns under names that every format allows."""
    return {re.sub(r"[^\w .:()/*^+-]", "?", name): values for name, values in data.items()}


def xdmf(mesh: meshio.Mesh) -> str:
    """A mesh with one kind of cell as XDMF, with its numbers in the text: one file, without HDF5."""
    (block,) = mesh.cells
    count = len(block.data)
    shape = {"triangle": "Triangle", "quad": "Quadrilateral"}[block.type]

    def item(values: np.ndarray) -> str:
        kind = 'Int" Precision="8' if values.dtype.kind in "iu" else 'Float" Precision="8'
        rows = "\n".join(" ".join(repr(v) for v in row) for row in values.reshape(len(values), -1).tolist())
        size = " ".join(str(n) for n in values.shape)
        return f'<DataItem Format="XML" NumberType="{kind}" Dimensions="{size}">\n{rows}\n</DataItem>'

    def attribute(name: str, values: np.ndarray, centre: str) -> str:
        head = f'<Attribute Name={quoteattr(name)} AttributeType="Scalar" Center="{centre}">'
        return f"{head}{item(values)}</Attribute>"

    parts = [
        '<?xml version="1.0"?>\n<Xdmf Version="3.0"><Domain><Grid Name="surface" GridType="Uniform">',
        f'<Geometry GeometryType="XYZ">{item(np.asarray(mesh.points, float))}</Geometry>',
        f'<Topology TopologyType="{shape}" NumberOfElements="{count}">{item(block.data)}</Topology>',
        *(attribute(name, np.asarray(v, float), "Node") for name, v in mesh.point_data.items()),
        *(attribute(name, np.asarray(v[0], float), "Cell") for name, v in mesh.cell_data.items()),
    ]
    return "\n".join([*parts, "</Grid></Domain></Xdmf>\n"])
