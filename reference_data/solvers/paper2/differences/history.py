r"""Adhesive contact by finite differences: the front followed node by node.

The difference equations of ``tube_fd`` are used on a grid as in ``tube_contact_fd``. Inflation:
node f touches when rho_f = s; that equation determines p, all equations of the free nodes hold
(at f too), eta_i is frozen for i < f; then eta_f is frozen and the front goes to f + 1. The
node at the front is treated as free, half of its cell being stuck in the limit, so that every
quantity errs as h, h^2, h^3, ...: four grids eliminate three powers. Values at a given p are
interpolated over the front position. Deflation starts from the front at a node at p = p_end,
which the grid's one parameter is adjusted for; the spring has half weight at the front node.
Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_banded

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import contact as cfd
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences.contact import Fitted
from reference_data.solvers.paper2.differences.equations import Array
from reference_data.solvers.paper2.substrate import Substrate, turning

BAND = 3


def banded(blocks: Array, frozen: Array) -> Array:
    """Block-tridiagonal matrix in band storage; rows of frozen eta become unit rows."""
    n = len(blocks)
    blocks = blocks.copy()
    blocks[frozen, 1] = 0
    blocks[frozen, 1, 1, 1] = 1
    out = np.zeros((2 * BAND + 1, 2 * n + 2))
    for eq in range(2):
        for unknown in range(2):
            for nb in range(3):
                shift = 2 * (nb - 1) + unknown
                cols = 2 * np.arange(n) + shift
                keep = cols >= 0
                out[BAND + eq - shift, cols[keep]] = blocks[keep, eq, unknown, nb]
    out[BAND, -2:] = 1
    return out


@dataclass
class Glued:
    """Equations of a tube whose first nodes cannot slide."""

    tube: Tube
    substrate: Substrate
    grid: Fitted

    def solve(
        self,
        guess: tuple[Array, float],
        frozen: Array,
        pressure: fd.Pressure,
        touching: int | None = None,
        max_iter: int = 30,
    ) -> tuple[Array, float]:
        """State with eta frozen at nodes 0 .. len(frozen)-1.

        Args:
            guess: First guess (y, p).
            frozen: The frozen values.
            pressure: Effective pressure by node.
            touching: Node with rho = s, p being unknown; None: p is as in the guess.
            max_iter: Iterations allowed.

        Raises:
            RuntimeError: If the iteration does not converge.
        """
        count = np.arange(len(frozen))

        def correct(state: tuple[Array, float]) -> tuple[float, Callable[[float], tuple[Array, float]]]:
            y, p = state
            f = fd.residual(self.tube, self.grid, y, p, pressure)
            f[2 * count + 1] = y[2 * count + 1] - frozen
            matrix = banded(fd.jacobian_blocks(self.tube, self.grid, y, p, pressure), count)
            if touching is None:
                dy, dp = -solve_banded((BAND, BAND), matrix, f), 0.0
            else:
                column = np.imag(fd.residual(self.tube, self.grid, y, p + 1j * fd.STEP, pressure)) / fd.STEP
                column[2 * count + 1] = 0
                both = solve_banded((BAND, BAND), matrix, np.stack([f, column], axis=1))
                at = 2 * touching
                dp = float((self.substrate.s - y[at] + both[at, 0]) / -both[at, 1])
                dy = -both[:, 0] - dp * both[:, 1]
            size = max(float(np.abs(dy).max()), abs(dp))
            return size, lambda share: (y + share * dy, p + share * dp)

        what = f"finite differences of {self.tube}, {len(frozen)} nodes stuck"
        return newton(guess, correct, what, longest=0.3, close=1e-9, most=max_iter, more=0)


class Inflation:
    """States with the front at node 0, 1, 2, ... until p exceeds p_end."""

    def __init__(self, glued: Glued, p_end: float, beyond: int = 4) -> None:
        self.glued, self.fronts = glued, []
        y, p = cfd.touching(glued.tube, glued.substrate, glued.grid)
        self.states = [(y, p)]
        eta = [0.0]
        while beyond:
            f = len(self.states)
            if f >= glued.grid.n - 2:
                raise RuntimeError(f"front of {glued.tube} meets the disk below p = {p_end:g}")
            pressure = cfd.spring_up_to(glued.substrate, f)
            state = glued.solve(self._guess(), np.array(eta), pressure, f)
            self.states.append(state)
            eta.append(float(state[0][2 * f + 1]))
            beyond -= state[1] > p_end

    def _guess(self) -> tuple[Array, float]:
        """Extrapolation from the last states."""
        last = self.states[-3:]
        weights = {1: [1.0], 2: [-1.0, 2.0], 3: [1.0, -3.0, 3.0]}[len(last)]
        y = sum(w * s[0] for w, s in zip(weights, last, strict=True))
        return y, float(sum(w * s[1] for w, s in zip(weights, last, strict=True)))

    @property
    def p(self) -> Array:
        """Pressures at which the nodes touch."""
        return np.array([p for _, p in self.states])

    def position(self, p: float, width: int = 6) -> tuple[float, int]:
        """Front position (in nodes, not an integer) at a pressure, and the first node of a stencil."""
        line = self.p
        k = int(np.searchsorted(line, p))
        low = int(np.clip(k - width // 2, 0, len(line) - width))
        nodes = np.arange(low, low + width, dtype=float)
        x = float(np.interp(p, line[k - 1 : k + 1], [k - 1, k]))
        for _ in range(50):
            value = fdb.lagrange_at(nodes, x) @ line[low : low + width]
            ahead = fdb.lagrange_at(nodes, x + 1e-4) @ line[low : low + width]
            step = (p - value) / ((ahead - value) / 1e-4)
            x += step
            if abs(step) < 1e-12:
                break
        return x, low


def inner_slopes(glued: Glued, y: Array, front: int) -> tuple[float, float, float]:
    """rho', eta' and eta'' at the inner side of the front, from the four half points before it."""
    tube, grid = glued.tube, glued.grid
    at = fd.half_points(tube, grid, y)
    before = front - 1 - np.arange(4)
    value = np.array([35.0, -35.0, 21.0, -5.0]) / 16
    slope = np.array([71.0, -141.0, 93.0, -23.0]) / 24  # times (value there)/h
    width = float(grid.density(grid.x[front])) / grid.n * tube.length
    return float(value @ at.a[before]), float(value @ at.b[before]), float(slope @ at.b[before]) / width


def traction_at_front(glued: Glued, y: Array, push: float, front: int) -> float:
    """f_t at the inner side of the front.

    rho'' follows from the radial equation, eta'' from the frozen eta; with both the derivative
    of the axial force is known. ``push`` is P_eff there.
    """
    tube, rho = glued.tube, float(y[2 * front])
    a, e, bend = inner_slopes(glued, y, front)
    l1, l2 = float(np.hypot(a, e)), rho / tube.r0
    s, c, t = a / l1, e / l1, mat.slope(l1, l2, tube.alpha) / l1
    w11, w12 = mat.curvature(l1, l2, tube.alpha), mat.mixed(l1, l2, tube.alpha)
    aa, ae, ee = (tube.r0 * x for x in (w11 * s * s + t * c * c, (w11 - t) * s * c, w11 * c * c + t * s * s))
    second = (mat.slope(l2, l1, tube.alpha) - push * rho * e - w12 * s * a - ae * bend) / aa
    return -(w12 * c * a + ae * second + ee * bend - push * rho * a) / (rho * l1)


def tractions(glued: Glued, y: Array, push: Array, front: int) -> Array:
    """f_t at nodes 0 .. front, from the balance of each cell; ``push`` is P_eff at the nodes."""
    tube, grid = glued.tube, glued.grid
    at = fd.half_points(tube, grid, y)
    axial = tube.r0 * at.w1 * at.b / at.l1
    a, b = fd.node_slopes(tube, grid, y)
    rho, dz = y[0:-2:2], grid.node[:-1] * tube.length
    out = np.zeros(front + 1)
    i = slice(1, front)
    out[i] = -((axial[1:front] - axial[: front - 1]) / dz[i] - push[i] * rho[i] * a[i])
    out[i] /= rho[i] * np.hypot(a, b)[i]
    out[front] = traction_at_front(glued, y, float(push[front]), front)
    return out


def summary(glued: Glued, state: tuple[Array, float], front: int) -> dict[str, float]:
    """Columns of a curve at a state with the front at a node."""
    tube, grid, (y, p) = glued.tube, glued.grid, state
    lam1, lam2 = y[3] / (grid.node[0] * tube.length), y[0] / tube.r0
    return {
        "p": p,
        "u_max": y[0] - 1,
        "contact_length": 2 * y[2 * front + 1],
        "lam1_mid": lam1,
        "t1_mid": mat.resultants(lam1, lam2, tube.alpha)[0],
        "lam2_mid": lam2,
        "Z_front": tube.delta1 * float(grid.fraction(grid.x[front])) * tube.length,
        "V": fd.volume(y),
        "traction_front": abs(traction_at_front(glued, y, p, front)) if front > 3 else 0.0,
    }


def at_edge(glued: Glued, state: tuple[Array, float], front: int, spring: bool) -> dict[str, float]:
    """Line force and curvature at the front, from fluxes extrapolated to it from each side."""
    tube, grid, (y, p) = glued.tube, glued.grid, state
    at = fd.half_points(tube, grid, y)
    axial = tube.r0 * at.w1 * at.b / at.l1
    rho = y[2 * front]
    three = np.array([15.0, -10.0, 3.0]) / 8  # values half, one and a half, two and a half cells away
    before, after = front - 1 - np.arange(3), front + np.arange(3)
    inner, outer = three @ axial[before], three @ axial[after]
    a, b = three @ at.a[after], three @ at.b[after]
    bound = glued.substrate.potential(rho, p, spring)
    bare = glued.substrate.potential(rho, p, False)
    l1 = np.hypot(a, b)
    return {
        "line_force": abs((inner - bound) - (outer - bare)) / rho,
        "line_force_membrane": abs(inner - outer) / rho,
        "kappa": float(turning(tube, rho, l1, b / l1, p)),
    }
