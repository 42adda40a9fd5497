r"""Piecewise Chebyshev collocation for the fluid-loaded tube (first-order strong form).

Unknowns over the material coordinate Z in [0, l]: radius r, height z, meridional stretch l1, slope
angle psi (r' = l1 cos psi, z' = l1 sin psi) and the fluid volume v below Z. With l2 = r,
s_1 = l1 - l1^{-3} r^{-2}, s_2 = r - l1^{-2} r^{-3}, P = gamma (z_w - z) below the level and 0 above,

.. math::
   s_1' = s_2 \cos\psi,\qquad s_1 \psi' = -s_2 \sin\psi + P\, r\, l_1,\qquad v' = \pi r^2 z'

(the Euler-Lagrange equations of paper 3 for axisymmetric states). The material position Zf of the
free surface is an unknown between a wet and a dry region, z(Zf) = z_w, so that the solution is smooth
in each; an over-filled tube has one region. r = 1 at both ends, z = 0 and L, v = 0 and V: the level
is an unknown, the volume is given.

:class:`System` solves any such first-order boundary value problem with parameters; further
components (perturbations, :mod:`paper3.canonical`) join the same way. Derivatives are
complex-step, hence exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.paper3.data import FluidTube

Array = np.ndarray
STEP = 1e-30  # complex-step increment: no subtraction, so as small as one likes
BASE = 5  # components r, z, l1, psi, v


@dataclass(frozen=True)
class Mesh:
    """Elements of the wet region, finer at the lower ring, and of the dry one.

    Attributes:
        wet: Elements below the free surface.
        dry: Elements above it; 0 when over-filled.
        degree: Polynomial degree, also the number of collocation points per element.
        grading: Exponent q of the break points s^q of the wet region.
    """

    wet: int
    dry: int
    degree: int
    grading: float = 1.5
    nodes: Array = field(init=False, compare=False)
    weights: Array = field(init=False, compare=False)
    value: Array = field(init=False, compare=False)
    deriv: Array = field(init=False, compare=False)
    breaks: Array = field(init=False, compare=False)
    dampness: Array = field(init=False, compare=False)

    def __post_init__(self) -> None:
        put = lambda name, x: object.__setattr__(self, name, x)  # noqa: E731
        nodes = (1 - np.cos(np.pi * np.arange(self.degree + 1) / self.degree)) / 2
        gauss, weights = np.polynomial.legendre.leggauss(self.degree)
        put("nodes", nodes)
        put("weights", weights / 2)
        put("value", lagrange(nodes, (gauss + 1) / 2))
        put("deriv", self.value @ differentiation(nodes))
        wet = np.linspace(0, 1, self.wet + 1) ** self.grading
        put("breaks", np.concatenate([wet, 1 + np.linspace(0, 1, self.dry + 1)[1:]]))
        put("dampness", (np.arange(self.elements) < self.wet).astype(float)[:, None])

    @property
    def elements(self) -> int:
        """Number of elements."""
        return self.wet + self.dry

    @property
    def widths(self) -> Array:
        """Element widths, each region having length 1."""
        return np.diff(self.breaks)[:, None]

    @property
    def s(self) -> Array:
        """Nodes, shape (elements, degree + 1): 0..1 is the wet region, 1..2 the dry one."""
        return self.breaks[:-1, None] + self.widths * self.nodes

    def lengths(self, tube: FluidTube, front: Any) -> Any:
        """Material length of the region of each element, shape (elements, 1)."""
        return self.dampness * front + (1 - self.dampness) * (tube.length - front)

    def position(self, tube: FluidTube, front: float) -> Array:
        """Material coordinate Z of every node."""
        return np.where(self.s <= 1, self.s * front, front + (self.s - 1) * (tube.length - front))


Rates = Callable[[list[Any], list[Any], Mesh], list[Any]]
Conditions = Callable[[list[Any], list[Any], list[Any], list[Any]], list[Any]]


@dataclass
class System:
    """Equations dy/ds = rates(y, parameters) on a mesh, with conditions at start, front and end.

    Attributes:
        mesh: Elements.
        rates: Derivatives with respect to s; lists of arrays (elements, points).
        conditions: As many values, to vanish, as components and parameters together.
    """

    mesh: Mesh
    rates: Rates
    conditions: Conditions

    def _linearised(self, y: Array, par: Array) -> tuple[Array, Array, Array]:
        """Defects (k, m, n) at Gauss points, and rates' derivatives by (components, parameters)."""
        mesh, n, count = self.mesh, y.shape[-1], len(par)
        at, p = list(np.moveaxis(mesh.value @ y, -1, 0)), list(par)
        f = np.stack(np.broadcast_arrays(*self.rates(at, p, mesh)), axis=-1)
        jac = np.empty((*f.shape, n + count))
        for j in range(n + count):
            args = [a + 1j * STEP if i == j else a for i, a in enumerate(at)]
            pars = [a + 1j * STEP if n + i == j else a for i, a in enumerate(p)]
            bump = np.broadcast_arrays(*self.rates(args, pars, mesh), at[0])[:n]
            jac[..., j] = np.imag(np.stack(bump, axis=-1)) / STEP
        h = mesh.widths[..., None]
        return mesh.deriv @ y - h * f, -h[..., None] * jac[..., :n], -h[..., None] * jac[..., n:]

    def _ends(self, y: Array, par: Array) -> tuple[Array, Array]:
        """Conditions and their derivatives by (start, front, end, parameters)."""
        n, mesh = y.shape[-1], self.mesh
        flat = np.concatenate([y[0, 0], y[mesh.wet - 1, -1], y[-1, -1], par]).astype(complex)

        def call(x: Array) -> Array:
            parts = x[:n], x[n : 2 * n], x[2 * n : 3 * n], x[3 * n :]
            return np.array(self.conditions(*[list(part) for part in parts]))

        jac = [np.imag(call(flat + 1j * STEP * e)) / STEP for e in np.eye(len(flat))]
        return call(flat).real, np.array(jac).T

    def step(self, y: Array, par: Array) -> tuple[Array, Array]:
        """Newton's correction, reduced element by element to the element ends."""
        mesh, n, count = self.mesh, y.shape[-1], len(par)
        k, m = mesh.elements, mesh.degree
        defect, by_y, by_par = self._linearised(y, par)
        block = np.einsum("mq,ij->miqj", mesh.deriv, np.eye(n))[None]
        block = (block + np.einsum("kmij,mq->kmiqj", by_y, mesh.value)).reshape(k, n * m, -1)
        right = np.concatenate(
            [-block[:, :, :n], -by_par.reshape(k, n * m, count), -defect.reshape(k, n * m, 1)], axis=2
        )
        x = np.linalg.solve(block[:, :, n:], right)  # all but the left node, per element
        value, by_ends = self._ends(y, par)
        size = n * (k + 1) + count
        a, b = np.zeros((size, size)), np.zeros(size)
        for e in range(k):
            rows = slice(n * e, n * (e + 1))
            a[rows, n * (e + 1) : n * (e + 2)] = np.eye(n)
            a[rows, rows] = -x[e, -n:, :n]
            a[rows, n * (k + 1) :], b[rows] = -x[e, -n:, n:-1], x[e, -n:, -1]
        last = slice(n * k, size)
        for i, place in enumerate((0, mesh.wet, k)):
            a[last, n * place : n * (place + 1)] += by_ends[:, i * n : (i + 1) * n]
        a[last, n * (k + 1) :], b[last] = by_ends[:, 3 * n :], -value
        found = np.linalg.solve(a, b)
        ends, dpar = found[: n * (k + 1)].reshape(k + 1, n), found[n * (k + 1) :]
        factors = np.concatenate([ends[:-1], np.tile(dpar, (k, 1)), np.ones((k, 1))], axis=1)
        inner = np.einsum("kij,kj->ki", x, factors).reshape(k, m, n)
        return np.concatenate([ends[:-1, None], inner], axis=1), dpar

    def newton(self, y: Array, par: Array, what: str, max_iter: int = 30) -> tuple[Array, Array]:
        """Solve; after the first step below 1e-7 one more is taken, which leaves rounding only.

        Raises:
            RuntimeError: If the iteration does not converge.
        """
        small = 0
        for _ in range(max_iter):
            try:
                dy, dpar = self.step(y, par)
            except np.linalg.LinAlgError:
                break
            size = max(float(np.abs(dy).max()), float(np.abs(dpar).max()))
            if not np.isfinite(size):
                break
            scale = min(1.0, 0.5 / size)
            y, par = y + scale * dy, par + scale * dpar
            small += size < 1e-7
            if small == 2:
                return y, par
        raise RuntimeError(f"collocation: no convergence for {what}")


def tensions(l1: Any, r: Any, law: Any = None) -> tuple[Any, Any]:
    """s_1, s_2: forces on meridional and circumferential cuts per material length."""
    if law is not None:
        return law.slope(l1, r) / 2, law.slope(r, l1) / 2
    sq, rr = l1 * l1, r * r
    return l1 - 1 / (sq * l1 * rr), r - 1 / (sq * rr * r)


def resultants(l1: Any, r: Any, law: Any = None) -> tuple[Any, Any]:
    """Principal Cauchy stress resultants T1 = s_1/r, T2 = s_2/l1 (per current length)."""
    s1, s2 = tensions(l1, r, law)
    return s1 / r, s2 / l1


def base_rates(y: list[Any], zw: Any, front: Any, tube: FluidTube, mesh: Mesh) -> list[Any]:
    """Derivatives of (r, z, l1, psi, v) with respect to s."""
    r, z, l1, psi = y[:4]
    c, s, wet = np.cos(psi), np.sin(psi), mesh.dampness
    sq, rr = l1 * l1, r * r
    s1, s2 = tensions(l1, r, tube.law)
    if tube.law is None:
        stretch = c * (r - 3 / (sq * rr * r)) / (1 + 3 / (sq * sq * rr))
    else:
        stretch = c * (2 * s2 - tube.law.mixed(l1, r) * l1) / tube.law.curvature(l1, r)
    load = tube.gamma * (zw - z) * wet
    h = mesh.lengths(tube, front)
    bend = (load * r * l1 - s2 * s) / s1
    return [h * l1 * c, h * l1 * s, h * stretch, h * bend, h * np.pi * rr * l1 * s * wet]


def base_conditions(
    start: list[Any], front: list[Any], end: list[Any], zw: Any, volume: Any, tube: FluidTube, partial: bool
) -> list[Any]:
    """Clamped rings, fluid volume and, in a partially filled tube, the level at the front."""
    out = [start[0] - 1, start[1], start[4], end[0] - 1, end[1] - tube.L, end[4] - volume]
    return [*out, front[1] - zw] if partial else out


@dataclass
class State:
    """An axisymmetric equilibrium: y of shape (elements, degree + 1, 5), level and front."""

    tube: FluidTube
    mesh: Mesh
    y: Array
    zw: float
    front: float

    @property
    def partial(self) -> bool:
        """True when part of the tube is dry."""
        return self.mesh.dry > 0

    @property
    def volume(self) -> float:
        """Fluid volume."""
        return float(self.y[-1, -1, 4])

    def evaluate(self, z_material: Array, y: Array | None = None) -> Array:
        """Components at material coordinates Z; shape of Z, then components."""
        y = self.y if y is None else y
        z_material = np.asarray(z_material, dtype=float)
        flat, mesh = np.ravel(z_material), self.mesh
        s = flat / self.front
        if self.partial:
            s = np.where(s <= 1, s, 1 + (flat - self.front) / (self.tube.length - self.front))
        k = np.clip(np.searchsorted(mesh.breaks, s, side="right") - 1, 0, mesh.elements - 1)
        rows = lagrange(mesh.nodes, (s - mesh.breaks[k]) / mesh.widths[k, 0])
        return np.einsum("im,imc->ic", rows, y[k]).reshape(*z_material.shape, -1)

    def moved_to(self, mesh: Mesh, front: float | None = None) -> State:
        """The same state on another mesh, by interpolation."""
        front = (self.front if mesh.dry else self.tube.length) if front is None else front
        y = self.evaluate(mesh.position(self.tube, front))
        return State(self.tube, mesh, y, self.zw, front)


def solve(guess: State, volume: float) -> State:
    """Equilibrium that holds the given fluid volume, on the guess's mesh.

    Raises:
        RuntimeError: If Newton's iteration does not converge.
    """
    tube, mesh, partial = guess.tube, guess.mesh, guess.partial

    def rates(y: list[Any], par: list[Any], mesh: Mesh) -> list[Any]:
        return base_rates(y, par[0], par[1] if partial else tube.length, tube, mesh)

    def conditions(start: list[Any], front: list[Any], end: list[Any], par: list[Any]) -> list[Any]:
        return base_conditions(start, front, end, par[0], volume, tube, partial)

    par = np.array([guess.zw, guess.front] if partial else [guess.zw])
    y, par = System(mesh, rates, conditions).newton(guess.y, par, f"V = {volume:g} of {tube}")
    return State(tube, mesh, y, float(par[0]), float(par[1]) if partial else tube.length)
