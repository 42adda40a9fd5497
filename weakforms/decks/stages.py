"""The order in which clamps are moved and loads are raised."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from weakforms.decks.bodies import Body
from weakforms.decks.meshes import Wall


@dataclass(frozen=True)
class Stage:
    """What holds at the end of a stage, in which everything changes linearly."""

    load: float
    curve: bool
    """Whether the state at its end is a row of the curve."""

    def row(self) -> dict[str, float | bool]:
        """As an entry of deck.json."""
        return asdict(self)


def stages_of(body: Body, loads: Sequence[float]) -> list[Stage]:
    """Pre-stretch, if there are clamps, then the loads."""
    stretched = [Stage(0.0, False)] if body.clamps else []
    return [*stretched, *(Stage(float(load), True) for load in loads)]


def clamped(body: Body, wall: Wall) -> tuple[np.ndarray, np.ndarray]:
    """The nodes of a wall, in space or in the plane, that are held, and their displacement."""
    nodes, moved = [], []
    for clamp in body.clamps:
        held = np.flatnonzero(np.isclose(wall.s, clamp.end, atol=1e-9))
        place = wall.points[held]
        mid = body.meridian(np.array([float(clamp.end)]))[1][0]
        target = place * clamp.radius
        target[:, -1] = clamp.height + (place[:, -1] - mid) / clamp.radius**2
        nodes.append(held)
        moved.append(target - place)
    if not nodes:
        return np.empty(0, int), np.empty((0, wall.points.shape[1]))
    return np.concatenate(nodes), np.concatenate(moved)
