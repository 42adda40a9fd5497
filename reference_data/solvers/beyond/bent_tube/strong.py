r"""Bent states by the balance of forces, point by point (method b).

With tangents :math:`a = x_{,z}` and :math:`b = x_{,\theta}/r_0` of the stress-free tube and
:math:`c = a\times b`, :math:`J = |c|^2`, :math:`t = |a|^2 + |b|^2`, the forces on cuts are

.. math:: f_a = 2(1 + \alpha/J)\,a + 2\,[\alpha - (1 + \alpha t)/J^2]\; b\times c, \qquad
          f_b = 2(1 + \alpha/J)\,b + 2\,[\alpha - (1 + \alpha t)/J^2]\; c\times a

and the balance :math:`(r_0 f_a)_{,z} + f_{b,\theta} + p\, x_{,\theta}\times a = 0` is collocated at the inner
nodes of elements along the tube and at midpoints of half a wave. Between elements ``f_a`` is continuous; at
mid-length its components across the mirror are zero. Vectors have components in the frame of the material
angle, which turns, and are trigonometric polynomials. Nothing is integrated but the volume.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np

from reference_data.solvers.core.collocation import (
    STEP,
    Array,
    Mesh,
    differentiation,
    lagrange,
    lobatto,
)
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton


class Known(Protocol):
    """A state of any code."""

    tube: Tube
    p: float

    def position(self, share: Array, theta: Array) -> Array:
        """(X, Y, Z) at fractions of the half length and at angles."""


def wedge(u: Array, v: Array) -> Array:
    """Vector product over the last axis, also of complex numbers."""
    (a, b, c), (d, e, f) = np.moveaxis(u, -1, 0), np.moveaxis(v, -1, 0)
    return np.stack([b * f - c * e, c * d - a * f, a * e - b * d], axis=-1)


def forces(tube: Tube, a: Array, b: Array) -> tuple[Array, Array]:
    """Forces on both cuts from the tangents."""
    c, alpha = wedge(a, b), tube.alpha
    j = np.sum(c * c, axis=-1, keepdims=True)
    t = np.sum(a * a + b * b, axis=-1, keepdims=True)
    along, aside = 2 * (1 + alpha / j), 2 * (alpha - (1 + alpha * t) / j**2)
    return along * a + aside * wedge(b, c), along * b + aside * wedge(c, a)


def jacobian(f: Callable[[Array], Array], x: Array) -> Array:
    """Derivative of a local function of the last axis, by complex steps, shape (..., out, in)."""
    columns = []
    for i in range(x.shape[-1]):
        moved = x.astype(complex)
        moved[..., i] += 1j * STEP
        columns.append(np.imag(f(moved)) / STEP)
    return np.stack(columns, axis=-1)


@dataclass(frozen=True)
class Net:
    """Elements along half the tube, finer at the disk, and midpoints of half a wave of wave number n."""

    n: int
    angles: int
    mesh: Mesh

    @cached_property
    def theta(self) -> Array:
        """The midpoints."""
        return (np.arange(self.angles) + 0.5) * np.pi / (self.angles * self.n)

    @cached_property
    def waves(self) -> tuple[Array, Array]:
        """Matrices from values to coefficients: of cos k n theta, k < J, and of sin k n theta, 0 < k <= J."""
        k = self.n * np.arange(self.angles)
        even, odd = np.cos(np.outer(self.theta, k)), np.sin(np.outer(self.theta, k + self.n))
        return np.linalg.inv(even), np.linalg.inv(odd)

    @cached_property
    def turns(self) -> tuple[Array, Array]:
        """Derivatives in theta of even and of odd functions, from values to values."""
        k = self.n * np.arange(self.angles)
        even, odd = self.waves
        of_even = -k * np.sin(np.outer(self.theta, k)) @ even
        of_odd = (k + self.n) * np.cos(np.outer(self.theta, k + self.n)) @ odd
        return of_even, of_odd

    def turned(self, first: int) -> Array:
        """Derivative in theta of a vector, whose components in turn are even (0) and odd (1), from ``first``.

        Shape (angles, 3, angles, 3); the frame turns.
        """
        out = np.zeros((self.angles, 3, self.angles, 3))
        for i in range(3):
            out[:, i, :, i] = self.turns[(i + first) % 2]
        here = np.arange(self.angles)
        out[here, 0, here, 1], out[here, 1, here, 0] = -1.0, 1.0
        return out

    @property
    def nodes(self) -> int:
        """Number of nodes along the tube."""
        return self.mesh.elements * self.mesh.degree + 1


@dataclass
class State:
    """Positions (nodes, angles, 3) in the turning frame, and the pressure."""

    tube: Tube
    net: Net
    x: Array
    p: float

    forces: ClassVar = staticmethod(forces)
    """On both cuts from the tangents."""

    def element(self, e: int) -> tuple[slice, Array, Array]:
        """Nodes of an element, the matrix of the slope in z, and both tangents (x_z, x_theta) there."""
        mesh = self.net.mesh
        here = slice(e * mesh.degree, (e + 1) * mesh.degree + 1)
        slope = differentiation(mesh.rule.nodes) / (mesh.widths[e] * self.tube.length)
        a = np.einsum("ij,jtc->itc", slope, self.x[here])
        b = np.einsum("tcsd,isd->itc", self.net.turned(0), self.x[here])
        return here, slope, np.stack([a, b])

    @property
    def volume(self) -> float:
        """Volume of the half tube per 2 pi."""
        return self._volume()[0]

    def _volume(self) -> tuple[float, Array]:
        """The volume and its gradient by the positions."""
        mesh, out, total = self.net.mesh, np.zeros_like(self.x), 0.0
        gauss, weights = np.polynomial.legendre.leggauss(mesh.degree + 4)
        value = lagrange(mesh.rule.nodes, (gauss + 1) / 2)

        def inside(v: Array) -> Array:
            x, a, b = v[..., :3], v[..., 3:6], v[..., 6:]
            normal = wedge(b, a)
            return (x[..., :1] * normal[..., :1] + x[..., 1:2] * normal[..., 1:2]) / 2

        for e in range(mesh.elements):
            here, slope, tangents = self.element(e)
            nine = np.concatenate([self.x[here], *tangents], axis=-1)
            at = np.einsum("gi,itc->gtc", value, nine)
            w = weights / 2 * mesh.widths[e] * self.tube.length / self.net.angles
            total += float(np.einsum("g,gtc->", w, inside(at)))
            by = w[:, None, None] * jacobian(inside, at)[..., 0, :]
            by = np.einsum("gi,gtc->itc", value, by)
            out[here] += by[..., :3] + np.einsum("ij,itc->jtc", slope, by[..., 3:6])
            out[here] += np.einsum("tcsd,itc->isd", self.net.turned(0), by[..., 6:])
        return total, out

    @property
    def amplitude(self) -> float:
        """Part of cos n theta in the radial position of the mid-plane."""
        return float(self.net.waves[0][1] @ self.x[0, :, 0])

    @property
    def u_max(self) -> float:
        """Mean radial displacement of the mid-plane."""
        return float(self.x[0, :, 0].mean() - 1)


def linear(state: State) -> tuple[Array, Array, Array]:
    """Residual of all equations, its matrix, and its derivative by p; all shaped like the positions."""
    tube, net, mesh = state.tube, state.net, state.net.mesh
    r0, shape = tube.r0, state.x.shape
    size = int(np.prod(shape))
    residual, by_p = np.zeros(shape), np.zeros(shape)
    matrix = np.zeros((*shape, *shape))
    points, angles = mesh.degree + 1, net.angles
    cell = points * angles * 3
    unit = np.eye(angles * 3)
    turned, turned_force = (net.turned(k).reshape(angles * 3, -1) for k in (0, 1))

    def local(v: Array) -> Array:
        a, b = v[..., :3], v[..., 3:]
        by_a, by_b = state.forces(tube, a, b / r0)
        return np.concatenate([r0 * by_a, by_b, wedge(b, a)], axis=-1)

    for e in range(mesh.elements):
        here, slope, (a, b) = state.element(e)
        six = np.concatenate([a, b], axis=-1)
        force, pull = local(six)[..., :6], local(six)[..., 6:]
        down = jacobian(local, six)  # (points, angles, 9, 6)
        to_a, to_b = np.kron(slope, unit), np.kron(np.eye(points), turned)
        by_x = np.einsum("itkc,itcn->itkn", down[..., :3], to_a.reshape(points, angles, 3, cell))
        by_x += np.einsum("itkc,itcn->itkn", down[..., 3:], to_b.reshape(points, angles, 3, cell))
        f_a, f_b, normal = (by_x[:, :, k : k + 3].reshape(cell, cell) for k in (0, 3, 6))
        over = np.kron(np.eye(points), turned_force)
        balance = to_a @ f_a + over @ f_b + state.p * normal
        missed = np.einsum("ij,jtc->itc", slope, force[..., :3])
        missed += (over @ force[..., 3:].reshape(cell)).reshape(points, angles, 3) + state.p * pull
        inner = slice(here.start + 1, here.stop - 1)
        residual[inner], by_p[inner] = missed[1:-1], pull[1:-1]
        matrix[inner, :, :, here] = balance.reshape(points, angles, 3, points, angles, 3)[1:-1]
        ends = f_a.reshape(points, angles, 3, points, angles, 3)
        for k, node, sign in ((0, here.start, -1.0), (-1, here.stop - 1, 1.0)):
            residual[node] += sign * force[k, :, :3]
            matrix[node, :, :, here] += sign * ends[k]
    # The mid-plane is a mirror: of its conditions f_a = 0 the one along the axis gives way to Z = 0.
    here = np.arange(angles)
    residual[0, :, 2] = state.x[0, :, 2]
    matrix[0, :, 2] = 0.0
    matrix[0, here, 2, 0, here, 2] = 1.0
    residual[-1] = state.x[-1] - np.array([1.0, 0.0, tube.lf / 2])
    matrix[-1] = 0.0
    for c in range(3):
        matrix[-1, here, c, -1, here, c] = 1.0
    return residual.ravel(), matrix.reshape(size, size), by_p.ravel()


def solve(state: State, held: str, target: float) -> State:
    """The state of a given volume ("V") or amplitude ("u_wave").

    Raises:
        RuntimeError: If Newton's method does not converge.
    """

    def correct(at: State) -> tuple[float, Callable[[Any], State]]:
        residual, matrix, by_p = linear(at)
        row = np.zeros_like(at.x)
        if held == "V":
            value, row = at._volume()
        else:
            value, row[0, :, 0] = at.amplitude, at.net.waves[0][1]
        whole = np.block([[matrix, by_p[:, None]], [row.reshape(1, -1), np.zeros((1, 1))]])
        step = np.linalg.solve(whole, -np.append(residual, value - target))

        def advance(share: Any) -> State:
            moved = float(share) * step
            return replace(at, x=at.x + moved[:-1].reshape(at.x.shape), p=at.p + float(moved[-1]))

        return float(np.abs(step).max()), advance

    return newton(state, correct, f"balance of forces of {state.tube}", longest=0.3)


def on(state: Known, net: Net, kind: type[State] = State) -> State:
    """A state of any code as a first guess."""
    mesh = net.mesh
    share = np.append((mesh.edges[:-1, None] + mesh.widths[:, None] * lobatto(mesh.degree)[:-1]).ravel(), 1.0)
    return kind(state.tube, net, state.position(share, net.theta), state.p)
