r"""Adhesive states with the front on a node at a given pressure, and deflation from there.

``fitted`` adjusts the grid until a node touches at exactly p_end (secant over whole inflations).
Deflation keeps eta at all nodes up to the front and solves the radial equations everywhere.
Bilateral: the spring acts at every stuck node, with half weight at the front, whose cell is
half outside. Unilateral: it acts where rho > s; in the cell in which rho crosses s the force follows from the
mean of (rho - s)+ over the cell, where rho varies linearly. Source: Patil, Nordmark & Eriksson, Proc. R. Soc.
A 470 (2014) 20140282.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2.differences import contact as cfd
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences import history as his
from reference_data.solvers.paper2.differences.branch import sampling
from reference_data.solvers.paper2.differences.contact import PARTS, Fitted
from reference_data.solvers.paper2.differences.equations import Array
from reference_data.solvers.paper2.differences.history import Glued, Inflation
from reference_data.solvers.paper2.substrate import Substrate

GRIDS = (100, 200, 400, 800, 1600)
POWERS = (1, 2, 3, 4)


@dataclass
class Stuck:
    """A state with eta frozen up to a front at a node.

    Attributes:
        glued: Tube, substrate and grid.
        y: Nodal values.
        p: Pressure.
        front: Node of the front.
        spring: Where the spring acts: "bilateral" or "unilateral".
    """

    glued: Glued
    y: Array
    p: float
    front: int
    spring: str = "bilateral"

    @property
    def gap(self) -> Array:
        """What the spring is compressed by, at the nodes before the disk."""
        gap = self.y[0:-2:2] - self.glued.substrate.s
        weight = np.zeros(len(gap))
        weight[: self.front] = 1
        weight[self.front] = 0.5
        return weight * (gap if self.spring == "bilateral" else positive(gap, cell_change(self.y)))


def plain(j: int) -> float:
    """z/L at x = j/25 on the undistorted grid."""
    return float(np.tanh(cfd.STRETCH * j / PARTS) / np.tanh(cfd.STRETCH))


@lru_cache(maxsize=8)
def followed(tube: Tube, substrate: Substrate, n: int, p_end: float) -> Inflation:
    """Inflation on the undistorted grid, to a little beyond p_end."""
    return Inflation(Glued(tube, substrate, Fitted(n, 10, plain(10))), p_end)


@lru_cache(maxsize=64)
def fitted(tube: Tube, substrate: Substrate, n: int, p_end: float, known: float = 3.0) -> Stuck:
    """State of the inflation with a node touching at p_end.

    The first guess is read from an inflation up to the pressure ``known``, or p_end if that is larger.

    Raises:
        RuntimeError: If the grid cannot be adjusted.
    """
    first = followed(tube, substrate, n, max(p_end, known))
    x, _ = first.position(p_end)
    where = float(first.glued.grid.fraction(x / n))
    j = cfd.numerator(where)
    for _ in range(8):
        grid = Fitted(n, j, where)
        run = Inflation(Glued(tube, substrate, grid), p_end, beyond=2)
        f, p = grid.front, run.p
        if f >= len(p):
            raise RuntimeError(f"front of {tube} at p = {p_end:g} is beyond the computed ones, n = {n}")
        if abs(p[f] - p_end) < 2e-12:
            return Stuck(run.glued, run.states[f][0], float(p[f]), f)
        rate = (p[f + 1] - p[f - 1]) / float(grid.fraction((f + 1) / n) - grid.fraction((f - 1) / n))
        where += (p_end - p[f]) / rate
    raise RuntimeError(f"no node of {tube} touches at p = {p_end:g}, n = {n}: off by {p[f] - p_end:.1e}")


def cell_change(y: Array) -> Array:
    """Change of rho over half a cell, at the nodes before the disk."""
    rho = np.concatenate([y[2:3], y[0::2]])
    return np.abs(rho[2:] - rho[:-2]) / 4


def positive(gap: Array, d: Array) -> Array:
    """Mean of the positive part of a linear function, gap -+ d over a cell."""
    d = np.maximum(d, 1e-300)
    mean = (gap + d) ** 2 / (4 * d)
    return np.where(np.real(gap) >= d, gap, np.where(np.real(gap) <= -d, 0.0 * gap, mean))


def one_sided(substrate: Substrate, front: int, d: Array) -> fd.Pressure:
    """P_eff of the unilateral spring, the change d of rho over half a cell being given."""

    def pressure(rho: Any, p: Any) -> Any:
        gap = positive(rho - substrate.s, d[: len(rho)])
        weight = np.zeros(len(rho))
        weight[:front] = 1
        weight[front : front + 1] = 0.5
        return p - weight * substrate.k * (gap + gap * gap / (2 * rho))

    return pressure


def deflated(start: Stuck, p: float, spring: str) -> Stuck:
    """State at another pressure, the patch glued."""
    glued, f = start.glued, start.front
    frozen = start.y[1 : 2 * f + 2 : 2].copy()
    if spring == "bilateral":
        pressure = cfd.spring_up_to(glued.substrate, f, edge=0.5)
        y, _ = glued.solve((start.y, p), frozen, pressure)
        return Stuck(glued, y, p, f, spring)
    y = start.y
    for _ in range(60):
        d = cell_change(y)
        y, _ = glued.solve((y, p), frozen, one_sided(glued.substrate, f, d), max_iter=60)
        if np.abs(cell_change(y) - d).max() < 1e-12:
            return Stuck(glued, y, p, f, spring)
    raise RuntimeError(f"unilateral spring: no convergence at p = {p:g}")


def deflation(start: Stuck, p: Array, spring: str, step: float = 0.05) -> list[Stuck]:
    """States at falling pressures, by steps of at most ``step``; ends early where none is found."""
    out, state = [], start
    for target in p:
        count = max(1, int(np.ceil((state.p - target) / step - 1e-9)))
        try:
            for now in state.p + (float(target) - state.p) * np.arange(1, count + 1) / count:
                state = deflated(state, float(now), spring)
        except RuntimeError:
            return out
        out.append(state)
    return out


def tractions(state: Stuck) -> tuple[Array, Array]:
    """f_t and f_k at the nodes of the patch, at the front its inner side."""
    glued, y, f = state.glued, state.y, state.front
    gap, rho = state.gap, y[0:-2:2]
    gap[f] = rho[f] - glued.substrate.s
    if state.spring == "unilateral":
        gap[f] = max(gap[f], 0.0)
    force = glued.substrate.k * (gap + gap**2 / (2 * rho))
    f_t = his.tractions(glued, y, state.p - force, f)
    a, b = fd.node_slopes(glued.tube, glued.grid, y)
    f_k = (-force * b / np.hypot(a, b))[: f + 1]
    a, b, _ = his.inner_slopes(glued, y, f)
    f_k[f] = -force[f] * b / np.hypot(a, b)
    return f_t, f_k


def lowest_t2(state: Stuck) -> float:
    """Smallest circumferential stress: at the nodes, at the disk, and at the front from each side."""
    glued, y, f = state.glued, state.y, state.front
    tube, grid = glued.tube, glued.grid
    at = fd.half_points(tube, grid, y)
    four = np.array([35.0, -35.0, 21.0, -5.0]) / 16  # from half, 3/2, 5/2, 7/2 cells away
    rho, last = y[0::2], np.arange(4)
    ends = [(four @ at.l1[-1 - last], rho[-1])]
    ends += [(four @ at.l1[f - 1 - last], rho[f]), (four @ at.l1[f + last], rho[f])]
    t2 = [mat.resultants(l1, r / tube.r0, tube.alpha)[1] for l1, r in ends]
    a, b = fd.node_slopes(tube, grid, y)
    nodes = mat.resultants(np.hypot(a, b), rho[:-1] / tube.r0, tube.alpha)[1]
    nodes = np.delete(nodes, f)
    return float(min(nodes.min(), *t2))


def summary(state: Stuck) -> dict[str, float]:
    """Columns of the deflation at one state."""
    glued, y = state.glued, state.y
    f_t, f_k = tractions(state)
    base = his.summary(glued, (y, state.p), state.front)
    attached = state.spring == "bilateral" or y[2 * state.front] > glued.substrate.s
    return {k: base[k] for k in ("u_max", "t1_mid", "lam1_mid")} | {
        **his.at_edge(glued, (y, state.p), state.front, attached),
        "traction_max": float(np.abs(f_t).max()),
        "spring_max": cfd.peak(np.abs(f_k)),
        "t2_min": lowest_t2(state),
    }


def profile(state: Stuck, z: Array) -> dict[str, Array]:
    """Profile columns; in the patch also f_t and f_k (elsewhere zero)."""
    glued, f = state.glued, state.front
    out = cfd.profile(glued.tube, glued.grid, state.y, f, z)
    at = glued.grid.inverse(z / glued.tube.length)
    inside = at < glued.grid.x[f]
    rows = sampling(glued.grid.x[:f], at[inside])
    for name, values in zip(("f_t", "f_k"), tractions(state), strict=True):
        out[name] = np.zeros(len(z))
        out[name][inside] = rows @ values[:f]
    return out
