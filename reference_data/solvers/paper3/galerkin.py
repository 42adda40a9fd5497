r"""Galerkin method for the fluid-loaded tube: axisymmetric states and their Fourier perturbations.

r(Z) and z(Z) are continuous piecewise polynomials (Gauss-Lobatto-Legendre nodes) on elements fitted
to the free surface, and meet the weak form F(x; v) = 0 of :mod:`paper3.weak` at Theta = 0, in the
frame (e_r, e_theta, e_z). The matrix of the second variation for wave number n comes from the same
point-wise tangent D: a perturbation has a part c that varies as cos(n Theta) and a part s that varies
as sin(n Theta), and the average over Theta is c.D c + s.D s, because D does not depend on Theta. No
formula of the Fourier decomposition is expanded by hand.

Newton's iteration keeps the elements in place; afterwards the free surface is sought, the elements are
fitted to it and the state is interpolated. A misplaced surface changes the load only to second order,
hence the whole iteration still converges quadratically.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.core.newton import newton
from reference_data.solvers.paper3 import weak
from reference_data.solvers.paper3.data import FluidTube

Array = np.ndarray
EXTRA = 4  # quadrature points per element beyond the degree


def lobatto(degree: int) -> Array:
    """Gauss-Lobatto-Legendre nodes on [0, 1]."""
    inner = np.polynomial.legendre.Legendre.basis(degree).deriv().roots().real
    return (np.concatenate([[-1.0], np.sort(inner), [1.0]]) + 1) / 2


@dataclass(frozen=True)
class Elements:
    """Elements of the wet region, finer at the lower ring, and of the dry one.

    Attributes:
        wet: Elements below the free surface.
        dry: Elements above it; 0 when over-filled.
        degree: Polynomial degree.
        grading: Exponent q of the break points s^q of the wet region.
    """

    wet: int
    dry: int
    degree: int
    grading: float = 1.5
    nodes: Array = field(init=False, compare=False)
    points: Array = field(init=False, compare=False)
    weights: Array = field(init=False, compare=False)
    value: Array = field(init=False, compare=False)
    deriv: Array = field(init=False, compare=False)
    breaks: Array = field(init=False, compare=False)

    def __post_init__(self) -> None:
        put = lambda name, x: object.__setattr__(self, name, x)  # noqa: E731
        nodes = lobatto(self.degree)
        gauss, weights = np.polynomial.legendre.leggauss(self.degree + EXTRA)
        put("nodes", nodes)
        put("points", (gauss + 1) / 2)
        put("weights", weights / 2)
        put("value", lagrange(nodes, self.points))
        put("deriv", self.value @ differentiation(nodes))
        wet = np.linspace(0, 1, self.wet + 1) ** self.grading
        put("breaks", np.concatenate([wet, 1 + np.linspace(0, 1, self.dry + 1)[1:]]))

    @property
    def count(self) -> int:
        """Number of elements."""
        return self.wet + self.dry

    @property
    def joined(self) -> Array:
        """Global node of each element's nodes, shape (elements, degree + 1)."""
        return self.degree * np.arange(self.count)[:, None] + np.arange(self.degree + 1)

    def place(self, tube: FluidTube, front: float, s: Array) -> Array:
        """Material coordinate of s (0..1 wet, 1..2 dry)."""
        return np.where(s <= 1, s * front, front + (s - 1) * (tube.length - front))

    def edges(self, tube: FluidTube, front: float) -> Array:
        """Material coordinates of the element ends."""
        return self.place(tube, front, self.breaks)

    def positions(self, tube: FluidTube, front: float) -> Array:
        """Material coordinates of the global nodes."""
        s = self.breaks[:-1, None] + np.diff(self.breaks)[:, None] * self.nodes
        flat = np.concatenate([s[:, :-1].ravel(), [self.breaks[-1]]])
        return self.place(tube, front, flat)


@dataclass(frozen=True)
class Shape:
    """An axisymmetric state: r and z at the global nodes, shape (nodes, 2), level and front."""

    tube: FluidTube
    elements: Elements
    x: Array
    zw: float
    front: float

    @property
    def widths(self) -> Array:
        """Element widths, shape (elements, 1)."""
        return np.diff(self.elements.edges(self.tube, self.front))[:, None]

    @property
    def wet(self) -> Array:
        """1 in wet elements, 0 in dry ones, shape (elements, 1)."""
        return (np.arange(self.elements.count) < self.elements.wet).astype(float)[:, None]

    def at_points(self) -> tuple[Array, Array, Array]:
        """Tangents a, b (elements, points, 3) at Theta = 0 and the height z, at quadrature points."""
        el = self.elements
        x = self.x[el.joined]
        now, slope = el.value @ x, el.deriv @ x / self.widths[..., None]
        return *tangents(now, slope), now[..., 1]

    def evaluate(self, z_material: Array) -> tuple[Array, Array]:
        """(r, z) and their slopes at material coordinates."""
        el, edges = self.elements, self.elements.edges(self.tube, self.front)
        z_material = np.atleast_1d(np.asarray(z_material, dtype=float))
        e = np.clip(np.searchsorted(edges, z_material, side="right") - 1, 0, el.count - 1)
        rows = lagrange(el.nodes, (z_material - edges[e]) / self.widths[e, 0])
        local = self.x[el.joined[e]]
        slopes = (rows @ differentiation(el.nodes)) / self.widths[e]
        return np.einsum("im,imc->ic", rows, local), np.einsum("im,imc->ic", slopes, local)

    @property
    def surface_radius(self) -> float:
        """Radius of the free surface, 0 when over-filled."""
        el = self.elements
        return float(self.x[el.wet * el.degree, 0]) if el.dry else 0.0

    def volume(self) -> float:
        """Fluid volume."""
        a, b, _ = self.at_points()
        weight = self.elements.weights * self.widths * self.wet
        return float(np.pi * np.sum(weight * b[..., 1] ** 2 * a[..., 2]))

    def potential(self) -> float:
        """Total potential energy Pi."""
        a, b, z = self.at_points()
        x = np.stack([b[..., 1], 0 * z, z], axis=-1)
        fluid = self.tube.gamma * (self.zw - z) * self.wet * weak.flux_of_radius(x, a, b)
        density = weak.energy_density(a, b, self.tube.law) - fluid
        return float(2 * np.pi * np.sum(self.elements.weights * self.widths * density))


def tangents(x: Array, slope: Array) -> tuple[Array, Array]:
    """Tangents x_,Z and x_,Theta (..., 3) at Theta = 0 from (r, z) and its slope."""
    nil = np.zeros_like(x[..., 0])
    return np.stack([slope[..., 0], nil, slope[..., 1]], -1), np.stack([nil, x[..., 0], nil], -1)


def parts(n: int) -> tuple[Array, Array]:
    """Maps (9, 6) of (u', beta', w', u, beta, w) to the cosine and the sine part of a perturbation."""
    c, s = np.zeros((9, 6)), np.zeros((9, 6))
    c[0, 0] = c[2, 2] = c[4, 3] = c[6, 3] = c[8, 5] = 1
    c[4, 4] = n
    s[1, 1] = s[7, 4] = 1
    s[3, 3], s[3, 4], s[5, 5] = -n, -1, -n
    return c, s


class Matrices:
    """Stiffness, mass and volume gradient of one wave number about a state, per 2 pi (n = 0) or pi."""

    def __init__(self, shape: Shape, n: int, fields: tuple[int, ...]) -> None:
        el, tube = shape.elements, shape.tube
        a, b, z = shape.at_points()
        pressure = tube.gamma * (shape.zw - z) * shape.wet
        slope = -tube.gamma * shape.wet + 0 * z
        d = weak.tangent(a, b, pressure, slope, tube.law)
        cos, sin = parts(n)
        if n == 0 and fields != (1,):
            sin = np.zeros_like(sin)
        q = cos.T @ d @ cos + sin.T @ d @ sin
        weight = el.weights * shape.widths
        tables = np.stack([el.deriv / shape.widths[..., None], np.tile(el.value, (el.count, 1, 1))], axis=1)
        q = q.reshape(*z.shape, 2, 3, 2, 3)[:, :, :, fields][..., fields]
        local = np.einsum("eq,etqa,eqticj,ecqb->eaibj", weight, tables, q, tables, optimize=True)
        mass = np.einsum("eq,qa,qb->eab", weight, el.value, el.value)
        m, size = len(fields), el.count * el.degree + 1
        self.stiffness = np.zeros((size, m, size, m))
        self.mass = np.zeros((size, m, size, m))
        self.volume = np.zeros((size, m))
        load = -weak.residual(a, b, shape.wet + 0 * z)[..., 6:]  # N where wet: gradient of the volume
        for e, at in enumerate(el.joined):
            self.stiffness[at[:, None], :, at[None], :] += np.moveaxis(local[e], 1, 2)
            for i in range(m):
                self.mass[at[:, None], i, at[None], i] += mass[e]
            self.volume[at] += np.einsum("q,qa,qi->ai", weight[e], el.value, load[e][:, fields])
        keep = np.arange(m, (size - 1) * m)
        flat = size * m
        self.stiffness = self.stiffness.reshape(flat, flat)[np.ix_(keep, keep)]
        self.stiffness = (self.stiffness + self.stiffness.T) / 2
        self.mass = self.mass.reshape(flat, flat)[np.ix_(keep, keep)]
        self.volume = self.volume.reshape(flat)[keep]

    def volume_controlled(self, shape: Shape) -> tuple[Array, Array, Array]:
        """Stiffness and mass at given volume, with the basis they refer to."""
        radius = shape.surface_radius
        if radius > 0:
            extra = 2 * shape.tube.gamma / radius**2 * np.outer(self.volume, self.volume)
            return self.stiffness + extra, self.mass, np.eye(len(self.mass))
        basis = scipy.linalg.qr(self.volume[:, None])[0][:, 1:]
        return basis.T @ self.stiffness @ basis, basis.T @ self.mass @ basis, basis


def residual(shape: Shape) -> Array:
    """Weak form at the interior nodes, for (v_r, v_z), per 2 pi."""
    el = shape.elements
    a, b, z = shape.at_points()
    f = weak.residual(a, b, shape.tube.gamma * (shape.zw - z) * shape.wet, shape.tube.law) @ parts(0)[0]
    weight = el.weights * shape.widths
    tables = np.stack([el.deriv / shape.widths[..., None], np.tile(el.value, (el.count, 1, 1))], axis=1)
    f = f.reshape(*z.shape, 2, 3)[..., (0, 2)]
    local = np.einsum("eq,etqa,eqti->eai", weight, tables, f)
    out = np.zeros_like(shape.x)
    np.add.at(out, el.joined, local)
    return out[1:-1].ravel()


def fitted(shape: Shape) -> tuple[Shape, float]:
    """The state on elements fitted to its free surface, and how far that moved."""
    if not shape.elements.dry:
        return shape, 0.0
    at, slope = shape.evaluate(shape.front)
    move = float((shape.zw - at[0, 1]) / slope[0, 1])
    room = 0.5 * min(shape.front, shape.tube.length - shape.front)
    front = shape.front + min(max(move, -room), room)
    x = shape.evaluate(shape.elements.positions(shape.tube, front))[0]
    x[0], x[-1] = (1, 0), (1, shape.tube.L)
    return replace(shape, x=x, front=front), abs(move)


def solve(guess: Shape, volume: float) -> Shape:
    """Equilibrium that holds the given fluid volume.

    Raises:
        RuntimeError: If the iteration does not converge.
    """

    def correct(shape: Shape) -> tuple[float, Callable[[float], Shape]]:
        shape, move = fitted(shape)
        matrices = Matrices(shape, 0, (0, 2))
        core, d = matrices.stiffness, matrices.volume
        area = np.pi * shape.surface_radius**2
        full = np.block([[core, -shape.tube.gamma * d[:, None]], [2 * np.pi * d[None], np.array([[area]])]])
        step = np.linalg.solve(full, -np.append(residual(shape), shape.volume() - volume))

        def advance(share: float) -> Shape:
            x = shape.x.copy()
            x[1:-1] += share * step[:-1].reshape(-1, 2)
            return replace(shape, x=x, zw=shape.zw + share * float(step[-1]))

        return max(float(np.abs(step).max()), move), advance

    what = f"Galerkin's method for {guess.tube} at V = {volume:g}"
    return fitted(newton(guess, correct, what, longest=0.3, most=30))[0]


def lowest(stiffness: Array, mass: Array) -> tuple[float, Array]:
    """Lowest eigenpair of a full matrix: dense solution, then inverse iteration."""
    value, vector = scipy.linalg.eigh(stiffness, mass, subset_by_index=[0, 0])
    return _polished(stiffness, mass, float(value[0]), vector[:, 0])


def lowest_banded(stiffness: Array, mass: Array) -> tuple[float, Array]:
    """Lowest eigenpair of a banded matrix: Lanczos from below the spectrum, then inverse iteration."""
    k, m, shift = sp.csc_matrix(stiffness), sp.csc_matrix(mass), -1.0
    while (_lu(k - shift * m).U.diagonal() < 0).any():  # pivots count the eigenvalues below the shift
        shift *= 2
    factor = sla.LinearOperator(k.shape, _lu(k - shift * m).solve)
    start = factor.matvec(np.ones(len(stiffness)))
    value, vector = sla.eigsh(k, 1, m, sigma=shift, OPinv=factor, v0=start, tol=1e-10)
    return _polished(k, m, float(value[0]), vector[:, 0])


def _lu(k: sp.csc_matrix) -> sla.SuperLU:
    """Factors without pivoting, so that the signs of the pivots are the matrix' inertia."""
    return sla.splu(k, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def _polished(stiffness: Any, mass: Any, value: float, v: Array) -> tuple[float, Array]:
    """Two inverse iterations and the Rayleigh quotient."""
    shifted = sp.csc_matrix(stiffness - (value - 1e-7) * mass)
    factor = sla.splu(shifted)
    for _ in range(2):
        v = factor.solve(mass @ v)
        v = v / np.sqrt(v @ (mass @ v))
    return float(v @ (stiffness @ v)), v
