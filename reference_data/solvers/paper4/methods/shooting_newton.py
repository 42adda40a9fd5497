"""Newton's method on the starting values of multiple shooting, and the load or the volume."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reference_data.solvers.paper4.material import Array, Membrane
from reference_data.solvers.paper4.methods.differences import Grid, stresses
from reference_data.solvers.paper4.methods.shooting import SEGMENTS, STEP, Shot


@dataclass
class Solution:
    """A converged shot, with its starting values (segments, 4), its load and Newton's matrix."""

    membrane: Membrane
    starts: Array
    load: float
    shot: Shot
    matrix: Array
    control: str

    @property
    def volume(self) -> float:
        """Enclosed volume per 2 pi."""
        return float(np.sum(np.real(self.shot.ends[:, 0, 4])))

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
    s = np.arange(SEGMENTS) * membrane.L / SEGMENTS
    nodes = np.linspace(0, membrane.L, grid.n + 1)
    forces = tension * np.sin(angle), tension * np.cos(angle)
    columns = (nodes, grid.r), (nodes, grid.z), (middle, forces[0]), (middle, forces[1])
    return np.stack([np.interp(s, *c) for c in columns], axis=-1)


def defects(membrane: Membrane, starts: Array, load: float, shot: Shot, control: str, target: float) -> Array:
    """The defects of continuity, r(0), z(0), r(L), z(L), then of the load or the volume."""
    end = np.real(shot.ends[:, 0])
    now = end[:, 4].sum() if control == "V" else load
    ends = [membrane.radius - starts[0, 0], -starts[0, 1]]
    ends += [membrane.radius - end[-1, 0], membrane.delta * membrane.L - end[-1, 1], target - now]
    return np.concatenate([(starts[1:] - end[:-1, :4]).ravel(), ends])


def matrix_of(shot: Shot, control: str) -> Array:
    """Derivative of minus the defects by the starting values and the load."""
    slope = np.imag(np.moveaxis(shot.ends[:, 1:], 1, 2)) / STEP  # (segment, value, derivative)
    k, last = len(slope), 4 * (len(slope) - 1)
    a = np.zeros((4 * k + 1, 4 * k + 1))
    for e in range(k - 1):
        rows = slice(4 * e, 4 * e + 4)
        a[rows, rows], a[rows, -1] = slope[e, :4, :4], slope[e, :4, 4]
        a[rows, 4 * e + 4 : 4 * e + 8] = -np.eye(4)
    a[last : last + 2, :2] = np.eye(2)
    a[last + 2 : last + 4, last : last + 4] = slope[-1, :2, :4]
    a[last + 2 : last + 4, -1] = slope[-1, :2, 4]
    a[-1, -1] = 1.0
    if control == "V":
        a[-1, :-1], a[-1, -1] = slope[:, 4, :4].ravel(), slope[:, 4, 4].sum()
    return a


def solve(
    membrane: Membrane, starts: Array, load: float, control: str, target: float, steps: int
) -> Solution:
    """Newton's method; control is "load" or, for the enclosed volume, "V".

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    done = False
    for _ in range(25):
        y = np.repeat(starts[:, None, :].astype(complex), 6, axis=1)
        y[:, 1:5] += 1j * STEP * np.eye(4)
        loads = load + 1j * STEP * (np.arange(6) == 5)
        shot = Shot(membrane, y, loads, steps)
        a = matrix_of(shot, control)
        if done:
            return Solution(membrane, starts, load, shot, a, control)
        step = np.linalg.solve(a, defects(membrane, starts, load, shot, control, target))
        largest = float(np.abs(step).max())
        if not np.isfinite(largest):
            break
        scale, done = min(1.0, 0.5 / largest), largest < 1e-8
        starts = starts + scale * step[:-1].reshape(-1, 4)
        load = load + scale * float(step[-1])
    raise RuntimeError(f"shooting: no convergence at {control} = {target:g} for {membrane}")


def refined(coarse: Solution, target: float, steps: int) -> Solution:
    """The same state with shorter steps, by Newton's method with the available matrix.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    membrane, starts, load, done = coarse.membrane, coarse.starts, coarse.load, False
    for _ in range(12):
        shot = Shot(membrane, starts[:, None, :], np.array([load]), steps)
        if done:
            return Solution(membrane, starts, load, shot, coarse.matrix, coarse.control)
        missing = defects(membrane, starts, load, shot, coarse.control, target)
        step = np.linalg.solve(coarse.matrix, missing)
        starts, load = starts + step[:-1].reshape(-1, 4), load + float(step[-1])
        done = float(np.abs(step).max()) < 1e-11
    raise RuntimeError(f"shooting: no convergence with {steps} steps for {membrane}")
