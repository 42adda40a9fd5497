"""Branches, states and profiles of the half tube by finite differences, with extrapolation.

A branch is traced on a coarse grid by pseudo-arclength, the predictor being the cubic through
the last four points (the paper's device); every requested state is then solved for, at exactly the requested
u_max, volume or pressure, on three grids n, 2n, 4n, and extrapolated to h = 0.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Estimate
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences.equations import Array, Grid

GRIDS = (200, 400, 800)
State = tuple[Array, float]


def richardson(coarse: Array, middle: Array, fine: Array, amplified: float | Array = 1.0) -> Estimate:
    """Eliminate h^2 and h^4 from values on grids n, 2n, 4n.

    The uncertainty is the change made by the h^4 term, that is the error estimate of the
    two-grid value and an upper bound for the error of the three-grid value, plus rounding: a slope
    is known to eps/h, the flux to w_11 ~ 8 times that. (Tables on 400 to 1600 cells scatter
    by about half of it.)

    Args:
        coarse: Values on n cells.
        middle: Values on 2n cells.
        fine: Values on 4n cells.
        amplified: Factor of the rounding error made by further processing.
    """
    coarse, middle, fine = (np.asarray(f, dtype=float) for f in (coarse, middle, fine))
    value = (64 * fine - 20 * middle + coarse) / 45
    two = (4 * fine - middle) / 3
    rounding = 8 * np.finfo(float).eps * GRIDS[-1] * np.maximum(1.0, np.abs(value)) * amplified
    with np.errstate(divide="ignore", invalid="ignore"):
        order = np.log2(np.abs((coarse - middle) / (middle - fine)))
    return Estimate(value, np.abs(value - two) + rounding, order)


def lagrange_at(nodes: Array, x: float) -> Array:
    """Weights of the polynomial through ``nodes`` evaluated at x."""
    gaps = nodes[:, None] - nodes[None, :]
    np.fill_diagonal(gaps, 1.0)
    others = x - nodes[None, :] + np.zeros_like(gaps)
    np.fill_diagonal(others, 1.0)
    return np.prod(others / gaps, axis=1)


def quantities(tube: Tube, grid: Grid, state: State) -> dict[str, float]:
    """Columns of a branch at one state; differences central at the mid-plane."""
    y, p = state
    lam1 = y[3] / (grid.node[0] * tube.length)
    t1, _ = mat.resultants(lam1, y[0] / tube.r0, tube.alpha)
    return {"u_max": y[0] - 1, "p": p, "lam1_mid": lam1, "t1_mid": t1, "V": fd.volume(y)}


class Trace:
    """A branch traced by pseudo-arclength from a small bulge on."""

    def __init__(self, tube: Tube, grid: Grid, first: float = 0.04) -> None:
        self.tube, self.grid = tube, grid
        state = fd.newton(tube, grid, fd.first_guess(tube, grid, 0.3), fd.at_control("u", 0.3))
        self.points: list[Array] = []
        for u in (first, 1.2 * first):
            y, p = fd.newton(tube, grid, state, fd.at_control("u", u))
            self.points.append(np.append(y, p))
            state = y, p
        self.weight = np.append(np.full(len(y), 1 / (grid.n + 1)), 1.0)
        self.s = [0.0, self._norm(self.points[1] - self.points[0])]

    def _norm(self, step: Array) -> float:
        return float(np.sqrt(np.sum(self.weight * step * step)))

    def at(self, s: float, last: int) -> Array:
        """Cubic through the points last-3 .. last (fewer at the start), at arclength s."""
        low = max(0, last - 3)
        rows = lagrange_at(np.array(self.s[low : last + 1]), s)
        return np.tensordot(rows, np.array(self.points[low : last + 1]), axes=1)

    def advance(self, ds: float) -> None:
        """One corrector solve on the plane normal to the predicted direction."""
        last = len(self.s) - 1
        guess = self.at(self.s[-1] + ds, last)
        normal = self.weight * (guess - self.points[-1])
        normal /= self._norm(guess - self.points[-1])

        def condition(y: Array, p: float) -> tuple[float, Array]:
            return float(normal @ (np.append(y, p) - guess)), normal

        y, p = fd.newton(self.tube, self.grid, (guess[:-1], guess[-1]), condition, max_iter=7)
        point = np.append(y, p)
        self.s.append(self.s[-1] + self._norm(point - self.points[-1]))
        self.points.append(point)

    def run(self, u_stop: float, v_stop: float = np.inf, ds: float = 0.06) -> Trace:
        """Trace until u_max or V exceeds its bound; the step is halved where Newton fails."""
        step = 0.01
        while self.points[-1][0] - 1 < u_stop and fd.volume(self.points[-1][:-1]) < v_stop:
            try:
                self.advance(step)
                step = min(1.3 * step, ds)
            except RuntimeError:
                step /= 2
                if step < 1e-5:
                    raise
        return self

    def column(self, name: str) -> Array:
        """One column (see :func:`quantities`) along the traced points."""
        states = [(q[:-1], float(q[-1])) for q in self.points]
        return np.array([quantities(self.tube, self.grid, s)[name] for s in states])

    def turning_points(self) -> Iterator[State]:
        """Points next to which p stops rising or falling, in the order met."""
        p = self.column("p")
        for i in range(1, len(p) - 1):
            if (p[i] - p[i - 1]) * (p[i + 1] - p[i]) < 0:
                yield self.points[i][:-1], float(p[i])

    def near(self, name: str, target: float) -> State:
        """Interpolated guess at the first crossing of ``target`` by a column."""
        gap = self.column(name) - target
        crossing = np.nonzero(gap[:-1] * gap[1:] <= 0)[0]
        if not len(crossing):
            raise ValueError(f"branch of {self.tube} never meets {name} = {target:g}")
        i = int(crossing[0])
        s = self.s[i] + (self.s[i + 1] - self.s[i]) * gap[i] / (gap[i] - gap[i + 1])
        point = self.at(s, min(i + 2, len(self.s) - 1))
        return point[:-1], float(point[-1])


def refined(state: State, grid: Grid, finer: Grid) -> State:
    """A state carried to a finer grid by splines in the uniform coordinate."""
    y, p = state
    out = np.empty(2 * finer.n + 2)
    for i in range(2):
        out[i::2] = CubicSpline(grid.x, y[i::2])(finer.x)
    return out, p


def pressure_condition(target: float) -> fd.Condition:
    """The condition 'p equals target'."""

    def condition(y: Array, p: float) -> tuple[float, Array]:
        return p - target, np.append(np.zeros(len(y)), 1.0)

    return condition


def condition_for(name: str, target: float) -> fd.Condition:
    """Condition that fixes u_max, V or p."""
    return pressure_condition(target) if name == "p" else fd.at_control(name, target)


def on_three_grids(tube: Tube, guess: State, condition: fd.Condition) -> list[State]:
    """The state picked by ``condition`` on the three grids, coarse to fine."""
    grids = [Grid(n) for n in GRIDS]
    states = [fd.newton(tube, grids[0], guess, condition)]
    for grid, finer in pairwise(grids):
        states.append(fd.newton(tube, finer, refined(states[-1], grid, finer), condition))
    return states


def curve(tube: Tube, control: str, targets: Array) -> dict[str, Estimate]:
    """All columns of a branch at the given values of the control."""
    margin = 1.01 * float(targets[-1]) + 0.01
    trace = Trace(tube, Grid(GRIDS[0]), first=min(0.04, 0.5 * float(targets[0])))
    trace.run(margin) if control != "V" else trace.run(np.inf, margin)
    rows: list[list[dict[str, float]]] = []
    for target in targets:
        guess = trace.near("V" if control == "V" else "u_max", float(target))
        states = on_three_grids(tube, guess, fd.at_control(control, float(target)))
        pairs = zip(GRIDS, states, strict=True)
        rows.append([quantities(tube, Grid(n), state) for n, state in pairs])
    return {
        name: richardson(*(np.array([row[g][name] for row in rows]) for g in range(3))) for name in rows[0][0]
    }


def sampling(positions: Array, at: Array, width: int = 8) -> Array:
    """Matrix of local interpolation of degree width-1, high enough to keep the series in h^2."""
    rows = np.zeros((len(at), len(positions)))
    for i, x in enumerate(at):
        low = int(np.clip(np.searchsorted(positions, x) - width // 2, 0, len(positions) - width))
        rows[i, low : low + width] = lagrange_at(positions[low : low + width], x)
    return rows


def middles(grid: Grid) -> Array:
    """Half points, mirrored at the mid-plane."""
    half = (grid.x[1:] + grid.x[:-1]) / 2
    return np.concatenate([-half[::-1], half])


def profile(tube: Tube, grid: Grid, state: State, z_plot: Array) -> dict[str, Array]:
    """Columns over Z = delta1 z; lambda1 (even in z) comes from the half points."""
    y, _ = state
    at = grid.inverse(z_plot / (tube.lf / 2))
    l1 = fd.half_points(tube, grid, y).l1
    nodal = sampling(grid.x, at)
    rho, eta = nodal @ y[0::2], nodal @ y[1::2]
    lam1 = sampling(middles(grid), at) @ np.concatenate([l1[::-1], l1])
    lam2 = rho / tube.r0
    t1, t2 = mat.resultants(lam1, lam2, tube.alpha)
    return {"rho": rho, "eta": eta, "lam1": lam1, "lam2": lam2, "t1": t1, "t2": t2}


def profiles(tube: Tube, states: list[State], z_plot: Array) -> dict[str, Estimate]:
    """Estimate profile of a state given on the three grids."""
    raw = [profile(tube, Grid(n), s, z_plot) for n, s in zip(GRIDS, states, strict=True)]
    fine = Grid(GRIDS[-1])
    at = fine.inverse(z_plot / (tube.lf / 2))
    # at the disk lambda1 is extrapolated over half a cell, which multiplies its rounding error
    spread = np.abs(sampling(middles(fine), at)).sum(axis=1) / (fine.density(at) * tube.length)
    return {name: richardson(*(r[name] for r in raw), amplified=np.maximum(1.0, spread)) for name in raw[0]}
