r"""Finite differences for the half tube in frictionless contact, the front on a node.

The difference equations of ``tube_fd`` are used. The grid is z/L = tanh(a X)/tanh(a),
X = x + c x (1 - x^2), x uniform, c such that the front z_1 is at node f = n j/25, j fixed: the
kink of P_eff (slope -k on the inner side, 0 on the outer) sits on a node of every grid. With p
given, z_1 (hence c and the grid) is the unknown that makes rho_f = s; the derivative of the
equations by z_1 is complex-step. Central differences of a solution whose third derivatives jump
at a node err as h^2, h^3, h^4, ...: four grids n, 2n, 4n, 8n eliminate those three.
Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton
from reference_data.solvers.core.tables import Estimate
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences.equations import STEP, Array
from reference_data.solvers.paper2.substrate import Substrate

GRIDS = (200, 400, 800, 1600)
PARTS = 25  # fronts sit at multiples of 1/25 of the uniform coordinate
STRETCH = 1.5


@dataclass(frozen=True)
class Fitted:
    """Grid of n cells with z/L = where at x = j/25; ``node`` and ``half`` as in ``tube_fd.Grid``."""

    n: int
    j: int
    where: Any
    x: Array = field(init=False)
    node: Array = field(init=False)
    half: Array = field(init=False)
    bend: Any = field(init=False)

    def __post_init__(self) -> None:
        put = lambda name, x: object.__setattr__(self, name, x)  # noqa: E731
        at = self.j / PARTS
        goal = np.arctanh(self.where * np.tanh(STRETCH)) / STRETCH
        put("bend", (goal - at) / (at * (1 - at * at)))
        put("x", np.arange(self.n + 1) / self.n)
        put("node", self.density(self.x) / self.n)
        put("half", self.density((self.x[1:] + self.x[:-1]) / 2) / self.n)

    @property
    def front(self) -> int:
        """Node of the front."""
        return self.n * self.j // PARTS

    def density(self, x: Array) -> Array:
        """Derivative of the mapping."""
        inner = x + self.bend * x * (1 - x * x)
        slope = 1 + self.bend * (1 - 3 * x * x)
        return slope * STRETCH / np.tanh(STRETCH) / np.cosh(STRETCH * inner) ** 2

    def fraction(self, x: Array) -> Array:
        """The mapping z/L itself."""
        return np.tanh(STRETCH * (x + self.bend * x * (1 - x * x))) / np.tanh(STRETCH)

    def inverse(self, fraction: Array) -> Array:
        """Grid coordinate x of a fraction z/L (Newton; the mapping rises)."""
        goal = np.asarray(fraction, dtype=float)
        x = goal.copy()
        for _ in range(60):
            x = np.clip(x - (self.fraction(x) - goal) / self.density(x), 0.0, 1.0)
        return x


def numerator(where: float) -> int:
    """The j for which the grid is least distorted."""
    plain = np.arctanh(where * np.tanh(STRETCH)) / STRETCH
    return int(np.clip(round(PARTS * plain), 1, PARTS - 1))


def spring_up_to(substrate: Substrate, front: int, edge: float = 0.0) -> fd.Pressure:
    """P_eff with the spring at nodes before ``front``; with weight ``edge`` at the front itself."""

    def pressure(rho: Any, p: Any) -> Any:
        weight = np.zeros(len(rho))
        weight[:front] = 1.0
        weight[front : front + 1] = edge
        return p + weight * (substrate.push(rho, p) - p)

    return pressure


@dataclass
class Contact:
    """A frictionless state on one grid."""

    tube: Tube
    substrate: Substrate
    grid: Fitted
    y: Array
    p: float

    @property
    def z(self) -> float:
        """Front position."""
        return float(self.grid.where) * self.tube.length


def solve(start: Contact, p: float | None = None) -> Contact:
    """State at pressure p with the front unknown, or (None) at the grid's front with p unknown.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    tube, n, j, f = start.tube, start.grid.n, start.grid.j, start.grid.front
    pressure = spring_up_to(start.substrate, f)
    row = np.zeros(2 * n + 3)
    row[2 * f] = 1.0
    given = lambda c: (start.grid, c) if p is None else (Fitted(n, j, c), p)  # noqa: E731

    def correct(found: tuple[Array, float]) -> tuple[float, Callable[[float], tuple[Array, float]]]:
        (y, c), residual = found, lambda grid, load: fd.residual(tube, grid, y, load, pressure)
        grid, load = given(c)
        rhs = -np.append(residual(grid, load), y[2 * f] - start.substrate.s)
        column = np.imag(residual(*given(c + 1j * STEP))) / STEP
        step = fd.bordered_solve(fd.jacobian(tube, grid, y, load, pressure), [column], [row], rhs)
        last = float(step[-1])
        room = np.inf if p is None else 0.2 * min(c, 1 - c) / max(abs(last), 1e-300)

        def advance(share: float) -> tuple[Array, float]:
            share = min(float(share), room)
            return y + share * step[:-1], c + share * last

        return float(np.abs(step).max()), advance

    c = start.p if p is None else float(start.grid.where)
    what = f"finite differences in contact for {tube}, n = {n}, p = {p}"
    y, c = newton((start.y, c), correct, what, close=fd.SMALL)
    grid, now = given(c)
    return Contact(tube, start.substrate, grid, y, float(now))


def regridded(state: Contact, grid: Fitted) -> Contact:
    """Guess on another grid, by local interpolation in z."""
    rows = fdb.sampling(state.grid.fraction(state.grid.x), grid.fraction(grid.x), width=4)
    y = np.empty(2 * grid.n + 2)
    y[0::2], y[1::2] = rows @ state.y[0::2], rows @ state.y[1::2]
    return Contact(state.tube, state.substrate, grid, y, state.p)


def touching(tube: Tube, substrate: Substrate, grid: Any) -> tuple[Array, float]:
    """Free state with rho(0) = s."""
    guess = fd.first_guess(tube, grid, substrate.s - 1)
    return fd.newton(tube, grid, guess, fd.at_control("u_max", substrate.s - 1))


def walk(tube: Tube, substrate: Substrate, p: Array, n: int = GRIDS[0]) -> list[Contact]:
    """States at rising pressures on one grid size, reached over the front position."""
    grid = Fitted(n, numerator(0.04), 0.04)
    first = touching(tube, substrate, grid)
    behind, state = (0.0, first[1]), solve(Contact(tube, substrate, grid, *first))
    out = []
    for target in p:
        while state.p < target:
            where = float(state.grid.where)
            behind = where, state.p
            where = where + min(0.04, 0.2 * (1 - where))
            state = solve(regridded(state, Fitted(n, numerator(where), where)))
        near, low = state, behind[0]
        for _ in range(5):  # bisection: near first touch the front is a steep function of p
            where = (low + float(near.grid.where)) / 2
            middle = solve(regridded(near, Fitted(n, numerator(where), where)))
            near, low = (near, where) if middle.p < target else (middle, low)
        out.append(solve(near, float(target)))
    return out


def on_grids(state: Contact, grids: Sequence[int] = GRIDS) -> list[Contact]:
    """The same state on all grids, coarse to fine."""
    out = [state]
    for n in grids[1:]:
        guess = regridded(out[-1], Fitted(n, state.grid.j, out[-1].grid.where))
        out.append(solve(guess, state.p))
    return out


def summary(state: Contact) -> dict[str, float]:
    """Columns of a curve at one state; differences central at the mid-plane."""
    tube, grid, y = state.tube, state.grid, state.y
    lam1 = y[3] / (grid.node[0] * tube.length)
    lam2 = y[0] / tube.r0
    return {
        "p": state.p,
        "u_max": y[0] - 1,
        "contact_length": 2 * y[2 * grid.front + 1],
        "lam1_mid": lam1,
        "t1_mid": mat.resultants(lam1, lam2, tube.alpha)[0],
        "lam2_mid": lam2,
        "Z_front": tube.delta1 * state.z,
        "V": fd.volume(y),
    }


def extrapolated(
    values: Sequence[Array], powers: Sequence[int], irregular: bool = False, amplified: float = 1.0
) -> Estimate:
    """Limit h -> 0 of values on grids n, 2n, 4n, ... eliminating one power of h per refinement.

    The uncertainty is the change made by the last elimination (the error of the value from the
    finer grids with one power less), an eighth of the one before, and rounding. ``irregular``:
    part of the error depends on the position of a kink between the nodes, which differences between grids do
    not show, but differences between rows do. The difference to the limit without the finest grid is added,
    and ten times the largest value of this row and its three neighbours on each side is used. ``amplified``
    multiplies the rounding error of a slope (extrapolation to an end of a zone does so).
    """
    v = [np.asarray(x, dtype=float) for x in values]

    def limit(v: list[Array], powers: Sequence[int]) -> Array:
        h = 0.5 ** np.arange(len(v))
        matrix = np.stack([np.ones(len(v)), *(h**q for q in powers)], axis=1)
        return np.tensordot(np.linalg.inv(matrix)[0], np.array(v), axes=1)

    value, less, least = (limit(v[i:], powers[: len(powers) - i]) for i in range(3))
    with np.errstate(divide="ignore", invalid="ignore"):
        order = np.log2(np.abs((v[-3] - v[-2]) / (v[-2] - v[-1])))
    floor = amplified * 8 * np.finfo(float).eps * GRIDS[-1] * np.maximum(1.0, np.abs(value))
    change = np.abs(value - less) + np.abs(less - least) / 8
    if irregular:
        change = change + np.abs(value - limit(v[:-1], powers[:-1]))
        change = 10 * np.array([change[max(0, i - 3) : i + 4].max() for i in range(len(change))])
    return Estimate(value, change + floor, order)


def peak(values: Array) -> float:
    """Largest value of smooth samples: the vertex of a parabola unless it is at an end."""
    i = int(np.argmax(values))
    if i in (0, len(values) - 1):
        return float(values[i])
    left, middle, right = values[i - 1 : i + 2]
    bend = left - 2 * middle + right
    return float(middle - (right - left) ** 2 / (8 * bend)) if bend < 0 else float(middle)


def one_sided(grid: Any, front: int, at: Array, inner: Array, halves: bool = False) -> Array:
    """Interpolation from the nodes (or half points, mirrored at 0) of the zone each point lies in."""
    places = (grid.x[1:] + grid.x[:-1]) / 2 if halves else grid.x
    cut = front if halves else front + 1
    rows = np.zeros((len(at), len(places)))
    if halves:
        matrix = fdb.sampling(np.concatenate([-places[:cut][::-1], places[:cut]]), at[inner])
        matrix = matrix[:, cut:] + matrix[:, :cut][:, ::-1]
    else:
        matrix = fdb.sampling(places[:cut], at[inner])
    rows[np.ix_(inner, np.arange(cut))] = matrix
    rows[np.ix_(~inner, np.arange(front, len(places)))] = fdb.sampling(places[front:], at[~inner])
    return rows


def profile(tube: Tube, grid: Any, y: Array, front: int, z: Array) -> dict[str, Array]:
    """Columns over z, each zone interpolated from its own nodes; lambda1 from half points."""
    at = grid.inverse(z / tube.length)
    inner = at < grid.x[front]
    nodal, halves = (one_sided(grid, front, at, inner, h) for h in (False, True))
    rho, eta = nodal @ y[0::2], nodal @ y[1::2]
    lam1 = halves @ fd.half_points(tube, grid, y).l1
    lam2 = rho / tube.r0
    t1, t2 = mat.resultants(lam1, lam2, tube.alpha)
    return {"rho": rho, "eta": eta, "lam1": lam1, "lam2": lam2, "t1": t1, "t2": t2}
