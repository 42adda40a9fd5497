r"""Lopsided states of a tube that bears no compression, by shooting from the middle to both disks (method b).

Hamilton's equations of ``relaxed.shooting``, which switch between both states where they meet a front. The
side below the middle is the mirror image of one above it: eta and m have the opposite sign. Unknown at the
middle are its radius, eta, m and F + p rho^2/2, besides p; the disks and the volume are met.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reference_data.solvers.beyond.lopsided.wrinkled import State
from reference_data.solvers.beyond.relaxed import shooting
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube, slope
from reference_data.solvers.core.newton import Secants

TOLERANCES = shooting.TOLERANCES
SIDES = 1.0, -1.0


class Shot(NamedTuple):
    """One state."""

    p: float
    u_max: float
    w_mid: float
    volume: float
    fronts: tuple[float, ...]
    """Z of the fronts on the pre-stretched tube, of the upper side and then of the lower one."""
    lf: float

    @property
    def fraction(self) -> float:
        """Part of the length that is wrinkled, if there is one such part."""
        return abs(self.fronts[1] - self.fronts[0]) / self.lf


def both(tube: Tube, x: Array, rtol: float) -> list[tuple[Array, list[float]]]:
    """What is found at either disk, for (u_max, w, m, axial tension, p) at the middle."""
    u, w, m, tension, p = map(float, x)
    return [shooting.shoot(tube, u, tension, p, rtol, offset=(side * w, side * m)) for side in SIDES]


def solve(tube: Tube, volume: float, guess: Array, rtol: float) -> Shot:
    """The state with a volume.

    Raises:
        RuntimeError: If the disks are not met.
    """

    def missed(x: Array) -> Array:
        ends = [end for end, _ in both(tube, x, rtol)]
        disks = [gap for end in ends for gap in (end[0] - 1, end[1] - tube.lf / 2)]
        return np.array([*disks, ends[0][3] + ends[1][3] - volume])

    x = Secants(offset=1e-6).solve(missed, list(guess), f"shooting of lopsided {tube} at V = {volume}")
    found = both(tube, x, rtol)
    fronts = [side * tube.delta1 * z for side, (_, zs) in zip(SIDES, found, strict=True) for z in zs]
    return Shot(float(x[4]), float(x[0]), float(x[1]), volume, tuple(fronts), tube.lf)


def near(state: State, rtol: float) -> Shot:
    """The state near one of the other method, which is the guess."""
    tube = state.tube
    rho, eta, l1, b, _ = state.y[0][0, 0]
    force = tube.r0 * slope(l1, rho / tube.r0, tube.alpha)
    guess = np.array([rho - 1, eta, force * np.sin(b), force * np.cos(b), state.p])
    return solve(tube, state.volume, guess, rtol)
