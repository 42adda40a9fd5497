"""Input files for CalculiX: the section of the wall in the plane, or the wall in space."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from weakforms.decks.bodies import Body
from weakforms.decks.expected import BULK, WALL
from weakforms.decks.meshes import Wall
from weakforms.decks.stages import Stage, clamped

PER_LINE = 10


def _listed(numbers: Iterable[object]) -> str:
    """Numbers in lines that CalculiX accepts."""
    found = [str(n) for n in numbers]
    return ",\n".join(", ".join(found[k : k + PER_LINE]) for k in range(0, len(found), PER_LINE))


def _set(name: str, nodes: np.ndarray) -> str:
    return f"*NSET, NSET={name}\n{_listed(nodes + 1)}\n"


def symmetries(body: Body, wall: Wall) -> dict[str, tuple[int, np.ndarray]]:
    """Planes of symmetry, or the axis: the direction that is held, from 1, and the nodes."""
    planes = dict(zip(("AXIS",) if wall.points.shape[1] == 2 else ("X0", "Y0"), (0, 1), strict=False))
    if body.mirror:
        planes["Z0"] = wall.points.shape[1] - 1
    found = {
        name: (axis + 1, np.flatnonzero(np.isclose(wall.points[:, axis], 0, atol=1e-9)))
        for name, axis in planes.items()
    }
    return {name: entry for name, entry in found.items() if len(entry[1])}


def input_file(body: Body, wall: Wall, stages: Sequence[Stage], about: str) -> str:
    """The text of an input file. Each stage is a step."""
    plane = wall.points.shape[1] == 2
    held, moved = clamped(body, wall)
    parts = [f"** {line}\n" for line in about.splitlines()]
    parts.append("*NODE, NSET=ALL\n")
    for n, place in enumerate(wall.points, 1):
        x = (*place, 0.0) if plane else place
        parts.append(f"{n}, {', '.join(f'{v:.12g}' for v in x)}\n")
    parts.append(f"*ELEMENT, TYPE={'CAX8R' if plane else 'C3D20R'}, ELSET=WALL\n")
    parts += [f"{_listed([n, *(cell + 1)])}\n" for n, cell in enumerate(wall.cells, 1)]
    planes = symmetries(body, wall)
    parts += [_set(name, nodes) for name, (_, nodes) in planes.items()]
    parts.append(_set("WATCH", np.unique(wall.stations)))
    c10 = 1 / WALL
    parts.append(
        "*MATERIAL, NAME=RUBBER\n*HYPERELASTIC, MOONEY-RIVLIN\n"
        f"{c10:.12g}, {body.ratio * c10:.12g}, {2 / (BULK * c10):.6g}\n"
        "*SOLID SECTION, ELSET=WALL, MATERIAL=RUBBER\n"
    )
    parts.append("*BOUNDARY\n")
    parts += [f"{name}, {axis}, {axis}\n" for name, (axis, _) in planes.items()]
    for stage in stages:
        # A thin wall needs more iterations than CalculiX allows by default.
        parts.append("*STEP, NLGEOM, INC=1000\n*STATIC\n0.1, 1., 1e-7, 1.\n")
        parts.append("*CONTROLS, PARAMETERS=TIME INCREMENTATION\n20, 30, 9, 60, 10, 4, , 15, ,\n")
        if len(held):
            parts.append("*BOUNDARY\n")
            for node, displacement in zip(held + 1, moved, strict=True):
                parts += [f"{node}, {k}, {k}, {v:.12g}\n" for k, v in enumerate(displacement, 1)]
        if stage.load:
            parts.append(f"*DLOAD\nWALL, P1, {stage.load:.12g}\n")
        parts.append("*NODE PRINT, NSET=WATCH, FREQUENCY=1000\nU\n*END STEP\n")
    return "".join(parts)
