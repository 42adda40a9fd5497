"""Newton's method on the starting values of multiple shooting, and the load or the volume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from reference_data.solvers.core.newton import newton
from reference_data.solvers.paper4.material import Array, Body
from reference_data.solvers.paper4.methods.differences import Grid, stresses
from reference_data.solvers.paper4.methods.shooting import SEGMENTS, STEP, Shot


@dataclass
class Solution:
    """A converged shot, with its starting values (segments, 4), its load and Newton's matrix."""

    membrane: Body
    starts: Array
    load: float
    shot: Shot
    matrix: Array
    control: str

    @property
    def volume(self) -> float:
        """Enclosed volume per 2 pi."""
        return float(np.sum(np.real(self.shot.ends[:, 0, 4])))

    def missing(self, target: float) -> Array:
        """The defects of continuity, of what is held at both ends, then of what is given."""
        end, starts = np.real(self.shot.ends[:, 0]), self.starts
        top = self.membrane.clamped([0.0] * 4, [*end[-1, :2], 0.0, 0.0])[2:]
        ends = [*self.membrane.free(starts[0]), *top]
        given = {"V": end[:, 4].sum(), "load": self.load, "z_pole": starts[0, 1]}[self.control]
        return np.concatenate([(starts[1:] - end[:-1, :4]).ravel(), -np.array([*ends, given - target])])

    @property
    def rate(self) -> float:
        """Derivative of the load by the control."""
        unit = np.zeros(len(self.matrix))
        unit[-1] = 1.0
        return float(np.linalg.solve(self.matrix, unit)[-1])


def from_grid(grid: Grid) -> Array:
    """Starting values from finite differences."""
    membrane = grid.membrane
    middle, r, l1, angle = grid.middle
    tension = membrane.eta(middle) * stresses(r, l1, membrane)[0]
    s = membrane.segments(SEGMENTS, 1)[:-1]
    nodes = np.linspace(0, membrane.L, grid.n + 1)
    forces = tension * np.sin(angle), tension * np.cos(angle)
    columns = (nodes, grid.r), (nodes, grid.z), (middle, forces[0]), (middle, forces[1])
    return np.stack([np.interp(s, *c) for c in columns], axis=-1)


def matrix_of(shot: Shot, control: str) -> Array:
    """Derivative of minus the defects by the starting values and the load."""
    slope = np.imag(np.moveaxis(shot.ends[:, 1:], 1, 2)) / STEP  # (segment, value, derivative)
    k, last = len(slope), 4 * (len(slope) - 1)
    a = np.zeros((4 * k + 1, 4 * k + 1))
    for e in range(k - 1):
        rows = slice(4 * e, 4 * e + 4)
        a[rows, rows], a[rows, -1] = slope[e, :4, :4], slope[e, :4, 4]
        a[rows, 4 * e + 4 : 4 * e + 8] = -np.eye(4)
    a[last : last + 2, :4] = np.transpose([shot.membrane.free(x) for x in np.eye(4)])
    a[last : last + 2, :4] -= np.transpose([shot.membrane.free(np.zeros(4))])
    a[last + 2 : last + 4, last : last + 4] = slope[-1, :2, :4]
    a[last + 2 : last + 4, -1] = slope[-1, :2, 4]
    a[-1, -1] = 1.0
    if control == "V":
        a[-1, :-1], a[-1, -1] = slope[:, 4, :4].ravel(), slope[:, 4, 4].sum()
    if control == "z_pole":
        a[-1, 1], a[-1, -1] = 1.0, 0.0
    return a


def solve(membrane: Body, starts: Array, load: float, control: str, target: float, steps: int) -> Solution:
    """Newton's method; control is "load" or, for the enclosed volume, "V".

    Raises:
        RuntimeError: If the iteration does not converge.
    """

    def correct(found: Solution) -> tuple[float, Callable[[float], Solution]]:
        step = np.linalg.solve(found.matrix, found.missing(target))
        return float(np.abs(step).max()), lambda share: shot(found, share * step)

    def shot(found: Solution, step: Array) -> Solution:
        starts, load = found.starts + step[:-1].reshape(-1, 4), found.load + float(step[-1])
        y = np.repeat(starts[:, None, :].astype(complex), 6, axis=1)
        y[:, 1:5] += 1j * STEP * np.eye(4)
        one = Shot(membrane, y, load + 1j * STEP * (np.arange(6) == 5), steps)
        return Solution(membrane, starts, load, one, matrix_of(one, control), control)

    guess = Solution(membrane, starts, load, None, np.zeros((0, 0)), control)
    what = f"shooting of {membrane} at {control} = {target:g}"
    first = shot(guess, np.zeros(starts.size + 1))
    return newton(first, correct, what, longest=0.5, close=1e-8, most=25, more=0)


def refined(coarse: Solution, target: float, steps: int) -> Solution:
    """The same state with shorter steps, by Newton's method with the available matrix.

    Raises:
        RuntimeError: If the iteration does not converge.
    """

    def shot(found: Solution, step: Array) -> Solution:
        starts, load = found.starts + step[:-1].reshape(-1, 4), found.load + float(step[-1])
        one = Shot(coarse.membrane, starts[:, None, :], np.array([load]), steps)
        return replace(found, starts=starts, load=load, shot=one)

    def correct(found: Solution) -> tuple[float, Callable[[float], Solution]]:
        step = np.linalg.solve(coarse.matrix, found.missing(target))
        return float(np.abs(step).max()), lambda _: shot(found, step)

    what = f"shooting of {coarse.membrane} with {steps} steps"
    first = shot(coarse, np.zeros(coarse.starts.size + 1))
    return newton(first, correct, what, close=1e-11, most=12, more=0)
