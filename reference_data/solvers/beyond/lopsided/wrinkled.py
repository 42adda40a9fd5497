r"""Lopsided states of a tube that bears no compression, by collocation between its fronts (method a).

The zones of ``strong`` lead from the middle to both disks. On the side with a wrinkled part there are three
of them, which meet at the fronts z_1 < z_2, where l1 l2^2 = 1; the one between the fronts has the equations
of ``relaxed.strong``: no hoop stress, and a tension that is constant along the meridian. All of y is
continuous at a front.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from reference_data.solvers.beyond.lopsided import strong
from reference_data.solvers.beyond.relaxed.strong import PLACES, wrinkled
from reference_data.solvers.core.collocation import Array, Ends, Mesh, Problem, joined
from reference_data.solvers.core.collocation import Zone as Part
from reference_data.solvers.core.mooney_rivlin import Tube, plain_pressure
from reference_data.solvers.paper2.collocation import equations as symmetric

MESHES = Mesh.graded(8, 10, 2.0), Mesh.graded(12, 12, 2.0)
STEP = 0.1
"""Largest step of the volume between two guesses."""


@dataclass(frozen=True)
class State(strong.Middle):
    """One state: nodal values of the zones with the fronts, outwards, and of the other side; p, z_1, z_2."""

    tube: Tube
    side: float
    """1 if the wrinkled part is on the upper side, else -1."""
    mesh: Mesh
    y: tuple[Array, ...]
    c: Array

    @property
    def volume(self) -> float:
        """Volume of the whole tube per 2 pi."""
        return self.side * float(self.y[2][-1, -1, 4] - self.y[3][-1, -1, 4])

    @property
    def fronts(self) -> tuple[float, float]:
        """Z of both ends of the wrinkled part, on the pre-stretched tube."""
        return tuple(self.side * self.tube.delta1 * float(z) for z in self.c[1:])

    @property
    def fraction(self) -> float:
        """Part of the length that is wrinkled."""
        return abs(self.fronts[1] - self.fronts[0]) / self.tube.lf

    def excess(self) -> tuple[float, float]:
        """Smallest l1 l2^2 - 1 at nodes of taut zones, and the largest one in the wrinkled zone."""
        gaps = [y[..., 2] * (y[..., 0] / self.tube.r0) ** 2 - 1 for y in self.y]
        return min(float(gaps[d].min()) for d in (0, 2, 3)), float(gaps[1].max())


def problem(state: State, volume: float) -> Problem:
    """The equations with the volume given."""
    tube, side = state.tube, state.side
    base = symmetric.State(tube, (), (), np.zeros(1))

    def rates(d: int, y: list[Any], _s: Array, c: list[Any]) -> list[Any]:
        edges = [0.0, *c[1:], tube.length]
        along = -side * tube.length if d == len(edges) - 1 else side * (edges[d + 1] - edges[d])
        if d == 1:
            found = wrinkled(tube, y, c[0])
        else:
            found = symmetric.free(base, y, None, lambda rho: plain_pressure(rho, c[0]))
        return [along * f for f in found]

    def conditions(left: Ends, right: Ends, _c: list[Any]) -> list[Any]:
        first, other, near, far = left[0], left[3], right[2], right[3]
        middle = [a - b for a, b in zip(first[:4], other[:4], strict=True)]
        half = side * tube.lf / 2
        disks = [near[0] - 1, near[1] - half, far[0] - 1, far[1] + half]
        at_fronts = [y[2] * (y[0] / tube.r0) ** 2 - 1 for y in left[1:3]]
        given = side * (near[4] - far[4]) - volume
        return [*middle, first[4], other[4], *joined(left[:3], right[:3]), *disks, *at_fronts, given]

    return Problem(tuple(Part(state.mesh, partial(rates, d)) for d in range(4)), conditions)


def solve(guess: State, volume: float) -> State:
    """The state with a given volume.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    what = f"lopsided wrinkled states of {guess.tube} by collocation"
    y, c = problem(guess, volume).solve(guess.y, guess.c, what, close=1e-7)
    return replace(guess, y=y, c=c)


def first(ordinary: strong.State, mesh: Mesh) -> State:
    """The state with the volume of one that bears compression, in one part of one side.

    Raises:
        RuntimeError: If it is compressed on both sides, or on none.
    """
    tube, s = ordinary.tube, np.linspace(0, 1, PLACES)
    found = {}
    for k, side in enumerate(strong.SIDES):
        y = ordinary.mesh.evaluate(ordinary.y[k], s)
        compressed = s[y[:, 2] * (y[:, 0] / tube.r0) ** 2 < 1]
        if len(compressed):
            found[k, side] = compressed[[0, -1]]
    if len(found) != 1:
        raise RuntimeError(f"{tube} at V = {ordinary.volume}: compressed on {len(found)} sides")
    (((k, side), fronts),) = found.items()

    def on(part: int, low: float, high: float) -> Array:
        return ordinary.mesh.evaluate(ordinary.y[part], low + (high - low) * mesh.x)

    guess = [on(k, low, high) for low, high in pairwise([0.0, *fronts, 1.0])]
    c = np.array([ordinary.p, *(fronts * tube.length)])
    return solve(State(tube, side, mesh, (*guess, on(1 - k, 0.0, 1.0)), c), ordinary.volume)


def follow(begin: State, volumes: Array) -> list[State]:
    """States at volumes in turn, by steps."""
    state, out = begin, []
    for volume in map(float, volumes):
        for v in np.linspace(state.volume, volume, 2 + int(abs(volume - state.volume) / STEP))[1:]:
            state = solve(state, float(v))
        out.append(state)
    return out


def again(state: State, mesh: Mesh) -> State:
    """The state on another mesh."""
    y = tuple(state.mesh.evaluate(part, mesh.x) for part in state.y)
    return solve(replace(state, mesh=mesh, y=y), state.volume)
