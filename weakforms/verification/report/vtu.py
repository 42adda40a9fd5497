"""Surfaces of the report as VTU, the XML format of ParaView, from the numbers of the report."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree import ElementTree as ET

import numpy as np

from weakforms.verification.judging.outcome import SurfaceOutcome
from weakforms.verification.report.junit import clean

QUAD = 9
"""VTK's number of a quadrilateral."""


def vtu(surface: SurfaceOutcome) -> str:
    """A surface with its fields as an unstructured grid of quadrilaterals.

    Args:
        surface: Position of shape ``(rows, columns)`` in each of ``x, y, z``; every field likewise.

    Returns:
        An XML document in plain text, the same bytes for the same numbers.
    """
    x, y, z = (np.asarray(part, float) for part in surface.position)
    index = np.arange(x.size).reshape(x.shape)
    corners = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]  # normals outwards
    quads = np.stack([corner.ravel() for corner in corners], axis=1)
    root = ET.Element("VTKFile", type="UnstructuredGrid", version="0.1", byte_order="LittleEndian")
    grid = ET.SubElement(root, "UnstructuredGrid")
    piece = ET.SubElement(grid, "Piece", NumberOfPoints=str(x.size), NumberOfCells=str(len(quads)))
    points = ET.SubElement(piece, "Points")
    _array(points, "position", np.stack([x, y, z], axis=-1).ravel(), components=3)
    cells = ET.SubElement(piece, "Cells")
    _array(cells, "connectivity", quads.ravel(), "Int64")
    _array(cells, "offsets", 4 * np.arange(1, len(quads) + 1), "Int64")
    _array(cells, "types", np.full(len(quads), QUAD), "UInt8")
    data = ET.SubElement(piece, "PointData")
    for name, values in surface.fields.items():
        _array(data, name, np.asarray(values, float).ravel())
    ET.indent(root)
    return f'<?xml version="1.0"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _array(
    parent: ET.Element, name: str, values: Iterable[float], kind: str = "Float64", components: int = 1
) -> None:
    array = ET.SubElement(parent, "DataArray", type=kind, Name=clean(name), format="ascii")
    if components > 1:
        array.set("NumberOfComponents", str(components))
    array.text = " ".join(f"{value:.12g}" for value in values)
