"""Input files for FEBio (format 4.0): the wall in space, of hexahedra of 20 nodes."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree as Xml

import numpy as np

from weakforms.decks.bodies import Body
from weakforms.decks.calculix import symmetries
from weakforms.decks.expected import BULK, WALL
from weakforms.decks.meshes import Wall
from weakforms.decks.stages import Stage, clamped

STEPS = 20
"""Time steps of each stage."""


def _add(parent: Xml.Element, tag: str, text: object = "", **attributes: str) -> Xml.Element:
    child = Xml.SubElement(parent, tag, attributes)
    if text != "":
        child.text = f"{text:.12g}" if isinstance(text, float) else str(text)
    return child


def _row(values: np.ndarray) -> str:
    return ",".join(f"{v:.12g}" for v in values)


def _curve(parent: Xml.Element, number: int, values: Sequence[float]) -> None:
    """A load curve with a value at the end of each stage."""
    curve = _add(parent, "load_controller", id=str(number), name=f"curve{number}", type="loadcurve")
    _add(curve, "interpolate", "LINEAR")
    _add(curve, "extend", "CONSTANT")
    points = _add(curve, "points")
    for time, value in enumerate([0.0, *values]):
        _add(points, "pt", f"{time},{value:.12g}")


def _clamp(boundary: Xml.Element, data: Xml.Element, axis: str, moved: np.ndarray) -> None:
    """A prescribed displacement in one direction."""
    bc = _add(boundary, "bc", name=f"clamp_{axis}", node_set="clamp", type="prescribed displacement")
    _add(bc, "dof", axis)
    _add(bc, "value", f"clamp_{axis}", lc="2", type="map")
    _add(bc, "relative", 0)
    column = _add(data, "NodeData", name=f"clamp_{axis}", node_set="clamp", data_type="scalar")
    for n, value in enumerate(moved, 1):
        _add(column, "node", float(value), lid=str(n))


def input_file(body: Body, wall: Wall, stages: Sequence[Stage], about: str) -> str:
    """The text of an input file. The time counts the stages."""
    root = Xml.Element("febio_spec", version="4.0")
    root.append(Xml.Comment(f" {about.replace('--', '- -')} "))
    _add(root, "Module", type="solid")
    control = _add(root, "Control")
    _add(control, "analysis", "STATIC")
    _add(control, "time_steps", STEPS * len(stages))
    _add(control, "step_size", 1 / STEPS)
    solver = _add(control, "solver", type="solid")
    _add(solver, "max_refs", 50)
    material = _add(_add(root, "Material"), "material", id="1", name="rubber", type="Mooney-Rivlin")
    for name, value in (("density", 1.0), ("c1", 1 / WALL), ("c2", body.ratio / WALL), ("k", BULK / WALL)):
        _add(material, name, value)
    mesh = _add(root, "Mesh")
    nodes = _add(mesh, "Nodes", name="nodes")
    for n, place in enumerate(wall.points, 1):
        _add(nodes, "node", _row(place), id=str(n))
    cells = _add(mesh, "Elements", type="hex20", name="wall")
    surface = _add(mesh, "Surface", name="gas")
    for n, cell in enumerate(wall.cells + 1, 1):
        _add(cells, "elem", ",".join(map(str, cell)), id=str(n))
        # Its normal points into the gas, so that a positive pressure inflates.
        inner = cell[[0, 3, 2, 1, 11, 10, 9, 8]]
        _add(surface, "quad8", ",".join(map(str, inner)), id=str(n))
    planes = symmetries(body, wall)
    held, moved = clamped(body, wall)
    sets = {name.lower(): found for name, (_, found) in planes.items()}
    sets |= {"watch": np.unique(wall.stations)} | ({"clamp": held} if len(held) else {})
    for name, found in sets.items():
        _add(mesh, "NodeSet", ",".join(map(str, found + 1)), name=name)
    _add(_add(root, "MeshDomains"), "SolidDomain", name="wall", mat="rubber")
    boundary = _add(root, "Boundary")
    for name, (axis, _) in planes.items():
        zero = _add(boundary, "bc", name=name.lower(), node_set=name.lower(), type="zero displacement")
        for k in (1, 2, 3):
            _add(zero, f"{'xyz'[k - 1]}_dof", int(k == axis))
    curves = Xml.Element("LoadData")
    _curve(curves, 1, [stage.load for stage in stages])
    if len(held):
        data = _add(root, "MeshData")
        _curve(curves, 2, [1.0] * len(stages))
        for k, axis in enumerate("xyz"):
            _clamp(boundary, data, axis, moved[:, k])
    load = _add(_add(root, "Loads"), "surface_load", name="gas", surface="gas", type="pressure")
    _add(load, "pressure", 1.0, lc="1")
    _add(load, "linear", 0)
    root.append(curves)
    log = _add(_add(root, "Output"), "logfile")
    _add(log, "node_data", data="x;y;z", delim=",", file="watch.csv", node_set="watch")
    Xml.indent(root, " ")
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"
