r"""Galerkin method in two dimensions for the fluid-loaded tube without axial symmetry.

Cartesian components of the position are trigonometric polynomials in Theta on [0, pi] (x and z even,
y odd: the mirror plane of the C1v states) times continuous piecewise polynomials (Gauss-Lobatto-Legendre
nodes) in the meridional direction, and meet F(x; v) = 0 of :mod:`paper3.weak`. The elements are fitted
to the free surface Z = Zf(Theta), itself a cosine polynomial:

.. math:: Z = s\, Z_f(\Theta),\ 0 \le s \le 1\ \text{(wet)},\qquad
          Z = Z_f + (s - 1)(l - Z_f),\ 1 \le s \le 2\ \text{(dry)},

so that the kink of the pressure lies on element edges and convergence is spectral. Newton's iteration
keeps the elements in place; afterwards they are fitted to the new surface and the state is interpolated.
A misplaced surface changes the load only to second order: the iteration converges quadratically.

Integrals are over half the circumference; :mod:`bent.states` doubles them.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.paper3 import weak
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.galerkin import Elements

Array = np.ndarray
EVEN, ODD = 0, 1
SYMMETRIC = (EVEN, ODD, EVEN)  # parities of x, y, z about Theta = 0 and pi
BREAKING = (ODD, EVEN, ODD)


@dataclass(frozen=True)
class Grid:
    """Meridional elements times trigonometric polynomials of degree ``modes``.

    Attributes:
        elements: Meridional elements, two regions or, over-filled, one.
        modes: Highest wave number.
        points: Quadrature points on [0, pi] (midpoint rule).
    """

    elements: Elements
    modes: int
    points: int
    theta: Array = field(init=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "theta", np.pi * (np.arange(self.points) + 0.5) / self.points)

    def table(self, parity: int, theta: Array, order: int = 0) -> Array:
        """Basis functions, or first derivatives, of one parity: shape (functions, points)."""
        m = np.arange(parity, self.modes + 1)[:, None]
        if order == 0:
            return np.sin(m * theta) if parity else np.cos(m * theta)
        return m * np.cos(m * theta) if parity else -m * np.sin(m * theta)

    def sizes(self, parities: tuple[int, ...] = SYMMETRIC) -> list[int]:
        """Numbers of basis functions of x, y and z."""
        return [self.modes + 1 - p for p in parities]

    def split(self, values: Array, parities: tuple[int, ...] = SYMMETRIC) -> list[Array]:
        """Coefficients of x, y, z from the joint last axis."""
        return np.split(values, np.cumsum(self.sizes(parities))[:-1], axis=-1)

    def project(self, values: Array, parity: int) -> Array:
        """Coefficients of a function from its values at the quadrature points (last axis)."""
        table = self.table(parity, self.theta)
        norm = np.full(len(table), 2.0)
        if not parity:
            norm[0] = 1.0
        return values @ table.T * norm / self.points


@dataclass(frozen=True)
class Surface:
    """A membrane: coefficients (nodes, functions), level, and coefficients of the front Zf."""

    tube: FluidTube
    grid: Grid
    x: Array
    zw: float
    front: Array

    @property
    def partial(self) -> bool:
        """True when part of the tube is dry."""
        return self.grid.elements.dry > 0

    def front_at(self, theta: Array) -> tuple[Array, Array]:
        """Zf and its derivative."""
        table = self.grid.table(EVEN, theta)
        return self.front @ table, self.front @ self.grid.table(EVEN, theta, 1)

    def nodal(self, theta: Array, order: int = 0) -> Array:
        """Position, or its derivative at fixed s, at the nodes: shape (nodes, angles, 3)."""
        parts = self.grid.split(self.x)
        tables = [self.grid.table(p, theta, order) for p in SYMMETRIC]
        return np.stack([c @ t for c, t in zip(parts, tables, strict=True)], axis=-1)

    def evaluate(self, z_material: Array, theta: Array) -> tuple[Array, Array, Array]:
        """Position and tangents x_,Z, x_,Theta at points (Z_i, Theta_j): shapes (i, j, 3).

        ``z_material`` has shape (i,) or (i, j).
        """
        el, length = self.grid.elements, self.tube.length
        theta = np.atleast_1d(np.asarray(theta, dtype=float))
        z_material = np.asarray(z_material, dtype=float)
        at = np.broadcast_to(
            z_material if z_material.ndim == 2 else z_material[:, None], (len(z_material), len(theta))
        )
        front, slope = self.front_at(theta)
        s = at / front
        if el.dry:
            s = np.where(s <= 1, s, 1 + (at - front) / (length - front))
        e = np.clip(np.searchsorted(el.breaks, s, side="right") - 1, 0, el.count - 1)
        width = np.diff(el.breaks)[e]
        rows = lagrange(el.nodes, ((s - el.breaks[e]) / width).ravel()).reshape(*s.shape, -1)
        rates = rows @ differentiation(el.nodes) / width[..., None]
        values, turns = self.nodal(theta), self.nodal(theta, 1)
        pick = el.joined[e], np.arange(len(theta))[None, :, None]
        x = np.einsum("ijm,ijmc->ijc", rows, values[pick])
        by_s = np.einsum("ijm,ijmc->ijc", rates, values[pick])
        by_theta = np.einsum("ijm,ijmc->ijc", rows, turns[pick])
        dry = e >= el.wet
        z_s = np.where(dry, length - front, front)[..., None]
        z_theta = (np.where(dry, 2 - s, s) * slope)[..., None]
        a = by_s / z_s
        return x, a, by_theta - a * z_theta

    def moved_to(self, grid: Grid, front: Array | None = None) -> Surface:
        """The same membrane on another grid, by interpolation; ends exactly at the rings."""
        if front is None:
            front = np.zeros(grid.modes + 1)
            count = min(len(front), len(self.front))
            front[:count] = self.front[:count]
        new = Surface(self.tube, grid, np.zeros((1, 1)), self.zw, front)
        values, _ = new.front_at(grid.theta)
        el = grid.elements
        at = np.stack([el.positions(self.tube, f) for f in values], axis=1)
        position, _, _ = self.evaluate(at, grid.theta)
        x = np.concatenate([grid.project(position[..., i], SYMMETRIC[i]) for i in range(3)], axis=-1)
        for end, height in ((0, 0.0), (-1, self.tube.L)):
            x[end] = clamped(grid, height)
        return replace(new, x=x)


def clamped(grid: Grid, height: float) -> Array:
    """Coefficients of the ring (cos Theta, sin Theta, height)."""
    parts = [np.zeros(n) for n in grid.sizes()]
    parts[0][1] = parts[1][0] = 1.0
    parts[2][0] = height
    return np.concatenate(parts)


@dataclass
class Points:
    """Quadrature data of one element, arrays (q, j): tangents, height, weights and the mapping."""

    a: Array
    b: Array
    x: Array
    weight: Array
    z_s: Array
    z_theta: Array
    wet: float

    def mapping(self) -> Array:
        """Matrix (q, j, 3, 3) from (v_s, v_Theta at fixed s, v) to (v_,Z, v_,Theta, v)."""
        out = np.zeros((*self.weight.shape, 3, 3))
        out[..., 0, 0], out[..., 1, 0] = 1 / self.z_s, -self.z_theta / self.z_s
        out[..., 1, 1] = out[..., 2, 2] = 1
        return out


def points(surface: Surface, e: int) -> Points:
    """Quadrature data of element e."""
    grid, el = surface.grid, surface.grid.elements
    width, wet = el.breaks[e + 1] - el.breaks[e], e < el.wet
    s = el.breaks[e] + width * el.points
    front, slope = surface.front_at(grid.theta)
    local = replace(surface, x=surface.x[el.joined[e]])
    values, turns = local.nodal(grid.theta), local.nodal(grid.theta, 1)
    x = np.einsum("qm,mjc->qjc", el.value, values)
    by_s = np.einsum("qm,mjc->qjc", el.deriv / width, values)
    by_theta = np.einsum("qm,mjc->qjc", el.value, turns)
    z_s = np.tile(front if wet else surface.tube.length - front, (len(s), 1))
    z_theta = np.outer(s if wet else 2 - s, slope)
    a = by_s / z_s[..., None]
    weight = (el.weights * width)[:, None] * z_s * np.pi / grid.points
    return Points(a, by_theta - a * z_theta[..., None], x, weight, z_s, z_theta, float(wet))


class Assembly:
    """Residual, matrices and gradients of a surface, element by element.

    Attributes:
        residual: F(x; v), shape (nodes, functions); for the symmetric family only.
        volume: Gradient of the fluid volume at given level, likewise.
        offset: Gradient of the centroid's offset in x, likewise.
        stiffness: Derivative of F, shape (elements, n, n), n = (degree + 1) functions.
        mass: Mass matrix, likewise.
    """

    def __init__(
        self,
        surface: Surface,
        parities: tuple[int, ...] = SYMMETRIC,
        tangent: bool = True,
        mass: bool = False,
    ) -> None:
        grid, el = surface.grid, surface.grid.elements
        self.surface, self.functions = surface, sum(grid.sizes(parities))
        self.tables = [grid.table(p, grid.theta) for p in parities]
        self.turns = [grid.table(p, grid.theta, 1) for p in parities]
        nodes = el.count * el.degree + 1
        self.residual, self.volume, self.offset = (np.zeros((nodes, self.functions)) for _ in range(3))
        n = (el.degree + 1) * self.functions
        self.stiffness = np.empty((el.count, n, n)) if tangent else None
        self.mass = np.empty((el.count, n, n)) if mass else None
        for e, at in enumerate(el.joined):
            data = points(surface, e)
            self._vectors(data, at, el.breaks[e + 1] - el.breaks[e])
            if tangent:
                self.stiffness[e] = self._tangent(data, el.breaks[e + 1] - el.breaks[e])
            if mass:
                self.mass[e] = self._mass(data)

    def _vectors(self, p: Points, at: Array, width: float) -> None:
        surface, el = self.surface, self.surface.grid.elements
        load = surface.tube.gamma * (surface.zw - p.x[..., 2]) * p.wet
        f = weak.residual(p.a, p.b, load, surface.tube.law).reshape(*load.shape, 3, 3)
        f = np.einsum("qj,qjat,qjac->qjtc", p.weight, p.mapping(), f)
        gradient = p.weight[..., None] * np.cross(p.b, p.a) * p.wet
        slopes, place = el.deriv / width, 0
        for c, (table, turn) in enumerate(zip(self.tables, self.turns, strict=True)):
            where = at[:, None], np.arange(place, place + len(table))
            self.residual[where] += slopes.T @ (f[..., 0, c] @ table.T)
            self.residual[where] += el.value.T @ (f[..., 1, c] @ turn.T + f[..., 2, c] @ table.T)
            self.volume[where] += el.value.T @ (gradient[..., c] @ table.T)
            if c == 0:
                self.offset[where] += el.value.T @ (p.weight @ table.T) / (np.pi * surface.tube.length)
            place += len(table)

    def _tangent(self, p: Points, width: float) -> Array:
        surface, el = self.surface, self.surface.grid.elements
        load = surface.tube.gamma * (surface.zw - p.x[..., 2]) * p.wet
        slope = np.full_like(load, -surface.tube.gamma * p.wet)
        d = weak.tangent(p.a, p.b, load, slope, surface.tube.law)
        m = p.mapping()
        d = d.reshape(*load.shape, 3, 3, 3, 3) * p.weight[..., None, None, None, None]
        d = np.einsum("qjat,qjacbd,qjbu->tucdqj", m, d, m, optimize=True)
        sums = np.empty((4, len(el.points), self.functions, self.functions))
        rows = np.cumsum([0, *(len(t) for t in self.tables)])
        for c in range(3):
            for k in range(3):
                sums[:, :, rows[c] : rows[c + 1], rows[k] : rows[k + 1]] = self._products(d[:, :, c, k], c, k)
        return self._contracted(sums, el.deriv / width)

    def _products(self, d: Array, c: int, k: int) -> Array:
        """Integrals over Theta for components c, k: meridional types ss, s0, 0s, 00 per point q."""
        one, turn = self.tables[c], self.turns[c]
        right, bend = self.tables[k].T, self.turns[k].T
        by = lambda t, w: t[None] * w[:, None, :]  # noqa: E731
        return np.stack(
            [
                by(one, d[0, 0]) @ right,
                by(one, d[0, 1]) @ bend + by(one, d[0, 2]) @ right,
                (by(turn, d[1, 0]) + by(one, d[2, 0])) @ right,
                (by(turn, d[1, 1]) + by(one, d[2, 1])) @ bend
                + (by(turn, d[1, 2]) + by(one, d[2, 2])) @ right,
            ]
        )

    def _contracted(self, sums: Array, slopes: Array) -> Array:
        """Sum over meridional points with the two polynomial factors."""
        value = self.surface.grid.elements.value
        pairs = ((slopes, slopes), (slopes, value), (value, slopes), (value, value))
        return sum(self._sandwiched(*pair, part) for pair, part in zip(pairs, sums, strict=True))

    def _sandwiched(self, left: Array, right: Array, part: Array) -> Array:
        """Sum over points q of left_qa part_q right_qb, with (a, row) and (b, column) joined."""
        count, size = left.shape[1], self.functions
        pairs = np.einsum("qa,qb->abq", left, right).reshape(count * count, -1)
        out = (pairs @ part.reshape(len(part), -1)).reshape(count, count, size, size)
        return np.moveaxis(out, 1, 2).reshape(count * size, count * size)

    def _mass(self, p: Points) -> Array:
        el, place = self.surface.grid.elements, 0
        part = np.zeros((len(el.points), self.functions, self.functions))
        for table in self.tables:
            at = slice(place, place + len(table))
            part[:, at, at] = (table[None] * p.weight[:, None, :]) @ table.T
            place += len(table)
        return self._sandwiched(el.value, el.value, part)
