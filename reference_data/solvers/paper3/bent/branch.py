"""The secondary branch: switching at the n = 1 bifurcation, and following it.

Near the bifurcation the centroid's offset in x is prescribed and the level is an unknown; level and
volume are even functions of it. Further on the level, which falls along the branch, is prescribed.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np

from reference_data.solvers.paper3 import canonical as can
from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3 import modes
from reference_data.solvers.paper3.bent.equations import SYMMETRIC, Array, Grid, Surface
from reference_data.solvers.paper3.bent.newton import newton

# Wet and dry elements, degree, highest wave number.
GRIDS = ((9, 4, 7, 16), (11, 4, 8, 22), (12, 5, 10, 26), (14, 5, 11, 30))
GRADING = 1.0


@cache
def grid(tube_is_partial: bool, level: int) -> Grid:
    """Grids of the secondary branch, by level of refinement."""
    wet, dry, degree, highest = GRIDS[level]
    elements = gal.Elements(wet, dry if tube_is_partial else 0, degree, GRADING)
    return Grid(elements, highest, 2 * highest + 16)


def axisymmetric(shape: gal.Shape, where: Grid) -> Surface:
    """An axisymmetric state on a two-dimensional grid."""
    return _rolled(shape, None, 0.0, where)


def injected(shape: gal.Shape, offset: float, where: Grid) -> Surface:
    """First guess on the secondary branch: the critical state plus its n = 1 mode.

    Args:
        shape: The state at the bifurcation.
        offset: Offset of the centroid in x that the mode is to have; positive: the bulge is at Theta = 0.
        where: The grid.
    """
    _, mode, _ = modes.galerkin_mode(shape, can.family(1))
    return _rolled(shape, mode, offset, where)


def _rolled(shape: gal.Shape, mode: Array | None, offset: float, where: Grid) -> Surface:
    tube, el = shape.tube, where.elements
    at = el.positions(tube, shape.front)
    r, z = shape.evaluate(at)[0].T
    u = beta = w = np.zeros_like(r)
    if mode is not None:
        nodal = np.zeros((len(shape.x), 3))
        nodal[1:-1] = mode
        full = replace(shape, x=nodal)
        fine = np.linspace(0, tube.length, 4001)
        values = full.evaluate(fine)[0]
        mean = np.trapezoid((values[:, 0] - values[:, 1]) / 2, fine) / tube.length
        u, beta, w = full.evaluate(at)[0].T * offset / mean
    c, s = np.cos(where.theta), np.sin(where.theta)
    x = np.outer(r, c) + np.outer(u, c * c) - np.outer(beta, s * s)
    y = np.outer(r, s) + np.outer(u + beta, c * s)
    height = z[:, None] + np.outer(w, c)
    parts = [where.project(v, p) for v, p in zip((x, y, height), SYMMETRIC, strict=True)]
    front = np.zeros(where.modes + 1)
    front[0] = shape.front
    return Surface(tube, where, np.concatenate(parts, axis=-1), shape.zw, front)


def offset_of(surface: Surface) -> float:
    """Offset of the (material) centroid in x."""
    values = surface.grid.elements
    total = 0.0
    parts = surface.grid.split(surface.x)[0]
    theta = surface.grid.theta
    front, _ = surface.front_at(theta)
    widths = np.diff(values.breaks)
    for e, at in enumerate(values.joined):
        z_s = front if e < values.wet else surface.tube.length - front
        inner = (values.weights * widths[e]) @ values.value @ parts[at] @ surface.grid.table(0, theta)
        total += float(np.sum(inner * z_s)) / (len(theta) * surface.tube.length)
    return total


def on_grid_for(surface: Surface, level: int) -> Surface:
    """The membrane as a guess on the grid for its level, partially or over-filled."""
    tube, wanted = surface.tube, surface.zw < surface.tube.L
    if wanted == surface.partial:
        return surface if surface.grid is grid(wanted, level) else surface.moved_to(grid(wanted, level))
    new = grid(wanted, level)
    if not wanted:
        front = np.zeros(new.modes + 1)
        front[0] = tube.length
        return surface.moved_to(new, front)
    theta = new.theta
    _, a, _ = surface.evaluate(np.array([tube.length]), theta)
    return surface.moved_to(new, new.project(tube.length - (tube.L - surface.zw) / a[0, :, 2], 0))


@dataclass
class Secondary:
    """States on the secondary branch by falling level, on one grid."""

    start: gal.Shape
    level: int
    states: list[Surface] = field(default_factory=list)

    def leave(self, offsets: Array) -> list[Surface]:
        """States at small offsets of the centroid, each from the bifurcation or its neighbours."""
        out: list[Surface] = []
        for offset in offsets:
            where = grid(self.start.surface_radius > 0, self.level)
            guess = injected(self.start, float(offset), where) if len(out) < 2 else self._ahead(out, offset)
            out.append(newton(guess, float(offset)))
        self.states += out
        return out

    @staticmethod
    def _ahead(states: list[Surface], offset: float) -> Surface:
        """Extrapolation over the offset from the last states (those on the last one's grid)."""
        last = states[-1]
        same = [s for s in states[-3:] if s.grid.elements.dry == last.grid.elements.dry]
        at = np.array([offset_of(s) for s in same])
        weights = [np.prod([(offset - b) / (a - b) for b in at if b != a]) for a in at]

        def mixed(name: str) -> Array:
            return sum(w * getattr(s, name) for w, s in zip(weights, same, strict=True))

        return replace(last, x=mixed("x"), zw=float(mixed("zw")), front=mixed("front"))

    def to_level(self, zw: float, step: float) -> Surface:
        """Follow the branch, by its offset, to a level.

        Raises:
            RuntimeError: If the steps become tiny.
        """
        h = step
        while self.states[-1].zw > zw:
            offset = offset_of(self.states[-1]) + h
            try:
                guess = on_grid_for(self._ahead(self.states, offset), self.level)
                state = newton(guess, offset)
                if (state.zw < state.tube.L) != state.partial:
                    state = newton(on_grid_for(state, self.level), offset)
            except (RuntimeError, np.linalg.LinAlgError):
                h /= 2
                if h < 1e-3:
                    raise
                continue
            if state.zw >= self.states[-1].zw:
                raise RuntimeError(f"surface: the level does not fall at offset {offset:g}")
            self.states.append(state)
            h = min(step, 1.5 * h)
        return self.states[-1]

    def at_level(self, zw: float) -> Surface:
        """State at a level that the branch has passed.

        Raises:
            RuntimeError: If Newton's iteration fails, or falls back to the axisymmetric branch.
        """
        order = np.argsort([abs(s.zw - zw) for s in self.states])[:4]
        near = [self.states[i] for i in sorted(order)]
        near = [s for s in near if s.partial == (zw < s.tube.L)] or near
        # the squared offset is a smooth function of the level, and zero at the bifurcation
        levels = np.array([self.start.zw, *(s.zw for s in near)])
        squares = np.array([0.0, *(offset_of(s) ** 2 for s in near)])
        target = float(np.sqrt(np.polyval(np.polyfit(levels - zw, squares, len(near)), 0.0)))
        guess = on_grid_for(replace(self._ahead(near, target), zw=zw), self.level)
        if (
            zw > self.states[0].zw
        ):  # close to the bifurcation the level alone does not tell the branches apart
            guess = replace(newton(guess, target), zw=zw)
        state = newton(guess)
        if offset_of(state) < 0.5 * target:
            raise RuntimeError(f"surface: not on the secondary branch at z_w = {zw:g}")
        return state
