r"""Waves by the energy of the tube as a surface in space (method a).

.. math:: \Pi = \int\!\!\int \Big[ r_0\, W(x_z, x_\theta/r_0) - \tfrac p3\, x\cdot(x_\theta\times x_z) \Big]
          \mathrm d\theta\, \mathrm dz

in Cartesian components, with any Mooney-Rivlin W of the surface's metric. Its gradient with respect to the
nine numbers (x, x_z, x_theta) is written down once; its second derivatives are complex steps of the gradient.
Polynomials on elements are the trial functions both of the axisymmetric states and of the waves; the sum over
midpoints in theta is exact. A family is neutral where an eigenvalue of its matrix is zero.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import brentq

from reference_data.solvers.beyond.tube_waves.family import Family
from reference_data.solvers.core.collocation import Array, differentiation, lagrange
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton

STEP = 1e-30
EXTRA = 4
"""Gauss points of an element beyond the degree."""


def lobatto(degree: int) -> Array:
    """Chebyshev-Lobatto nodes on [0, 1]."""
    return (1 - np.cos(np.pi * np.arange(degree + 1) / degree)) / 2


def gradient(tube: Tube, p: float, x: Array, a: Array, b: Array) -> tuple[Array, Array, Array]:
    """Derivatives of the integrand by x, x_z and x_theta; vectors in the first axis, real or complex."""
    r0, alpha, c = tube.r0, tube.alpha, b / tube.r0
    g, h, k = (a * a).sum(0), (c * c).sum(0), (a * c).sum(0)
    t, j = g + h, g * h - k * k
    f_t, f_j = 1 + alpha / j, -1 / j**2 + alpha * (1 - t / j**2)
    by_a = r0 * (2 * f_t * a + 2 * f_j * (h * a - k * c))
    by_b = 2 * f_t * c + 2 * f_j * (g * c - k * a)
    return -p / 3 * cross(b, a), by_a - p / 3 * cross(x, b), by_b - p / 3 * cross(a, x)


def cross(v: Array, w: Array) -> Array:
    """Vector product over the first axis."""
    return np.array([v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]])


def hessian(
    tube: Tube, p: float, x: Array, a: Array, b: Array, gradient: Callable[..., Any] = gradient
) -> Array:
    """Second derivatives, shape (9, 9, ...), of an integrand with this gradient."""
    whole = np.concatenate([x, a, b]).astype(complex)
    out = np.empty((9, *whole.shape))
    for i in range(9):
        moved = whole.copy()
        moved[i] += 1j * STEP
        out[i] = np.imag(np.concatenate(gradient(tube, p, moved[:3], moved[3:6], moved[6:]))) / STEP
    return out


@dataclass(frozen=True)
class Basis:
    """Continuous polynomials of one degree on elements of [0, 1], finer at 1."""

    elements: int
    degree: int
    power: float = 2.0

    @cached_property
    def edges(self) -> Array:
        """Ends of the elements."""
        return 1 - (1 - np.linspace(0, 1, self.elements + 1)) ** self.power

    @cached_property
    def nodes(self) -> Array:
        """All nodes."""
        local = lobatto(self.degree)[:-1]
        return np.append((self.edges[:-1, None] + np.diff(self.edges)[:, None] * local).ravel(), 1.0)

    @cached_property
    def rule(self) -> tuple[Array, Array, Array, Array]:
        """Gauss points, weights, values and slopes of all functions there, (points, functions)."""
        gauss, weights = np.polynomial.legendre.leggauss(self.degree + EXTRA)
        nodes, t = lobatto(self.degree), (gauss + 1) / 2
        value = lagrange(nodes, t)
        slope = value @ differentiation(nodes)
        count = len(t)
        points, w = np.empty(self.elements * count), np.empty(self.elements * count)
        phi, dphi = np.zeros((2, self.elements * count, len(self.nodes)))
        for e, (left, width) in enumerate(zip(self.edges[:-1], np.diff(self.edges), strict=True)):
            rows = slice(e * count, (e + 1) * count)
            columns = slice(e * self.degree, (e + 1) * self.degree + 1)
            points[rows], w[rows] = left + width * t, width * weights / 2
            phi[rows, columns], dphi[rows, columns] = value, slope / width
        return points, w, phi, dphi


@dataclass
class State:
    """An axisymmetric state: nodal values of radius and height, and the pressure."""

    tube: Tube
    basis: Basis
    r: Array
    z: Array
    p: float

    def fields(self) -> tuple[Array, Array, Array, Array]:
        """r, r', z, z' at the Gauss points, ' being the derivative in the unstretched coordinate."""
        _, _, phi, dphi = self.basis.rule
        length = self.tube.length
        return phi @ self.r, dphi @ self.r / length, phi @ self.z, dphi @ self.z / length

    @property
    def weights(self) -> Array:
        """Weights of the Gauss points in the unstretched coordinate."""
        return self.basis.rule[1] * self.tube.length

    @property
    def thickening(self) -> Array | float:
        """Thickness at the Gauss points over that of the stress-free tube, less 1."""
        return 0.0

    @property
    def volume(self) -> float:
        """Volume of the half tube per 2 pi."""
        r, _, _, z1 = self.fields()
        return float(np.sum(self.weights * r**2 * z1) / 2)

    @property
    def u_max(self) -> float:
        """Displacement of the mid-plane."""
        return float(self.r[0] - 1)

    def surface(self, angle: float = 0.0) -> tuple[Array, Array, Array]:
        """x, x_z and x_theta at the Gauss points of a meridian."""
        r, r1, z, z1 = self.fields()
        c, s = np.cos(angle), np.sin(angle)
        return np.array([r * c, r * s, z]), np.array([r1 * c, r1 * s, z1]), np.array([-r * s, r * c, 0 * r])


def guess(tube: Tube, basis: Basis, u: float) -> State:
    """A bulge of height u."""
    x = basis.nodes
    return State(tube, basis, 1 + u * (1 - x**6), x * tube.lf / 2, 0.5)


def linear(state: State) -> tuple[Array, Array, Array]:
    """Residual of the axisymmetric equations, its matrix and its derivative by p, for (r, z)."""
    _, _, phi, dphi = state.basis.rule
    slope, w = dphi / state.tube.length, state.weights
    at = state.surface()
    stacked = np.concatenate(gradient(state.tube, state.p, *at))
    pull = np.concatenate(gradient(state.tube, 1.0, *at)) - np.concatenate(gradient(state.tube, 0.0, *at))
    # A change of r moves x and x_z along e_r and turns into x_theta along e_theta; one of z moves along e_z.
    parts = ((phi, 0), (slope, 3), (phi, 7)), ((phi, 2), (slope, 5))
    second = hessian(state.tube, state.p, *at)
    if np.any(state.thickening):  # the strain energy is in proportion to the thickness
        stacked = stacked + state.thickening * np.concatenate(gradient(state.tube, 0.0, *at))
        second = second + state.thickening * hessian(state.tube, 0.0, *at)
    residual = np.concatenate([sum((w * stacked[i]) @ f for f, i in own) for own in parts])
    by_p = np.concatenate([sum((w * pull[i]) @ f for f, i in own) for own in parts])
    blocks = [
        [sum(f.T @ ((w * second[i, j])[:, None] * g) for f, i in own for g, j in other) for other in parts]
        for own in parts
    ]
    return residual, np.block(blocks), by_p


def bordered(state: State, row: Array | None = None) -> tuple[Array, Array]:
    """Matrix and right-hand side of the equations for (r, z, p) with the ends held.

    The last row is the volume's gradient, or a given one; its right-hand side is left zero.
    """
    n = len(state.r)
    held = np.array([n - 1, n, 2 * n - 1])  # r at the disk, z at the mid-plane and at the disk
    residual, matrix, by_p = linear(state)
    row = -by_p if row is None else row  # the pressure's force is the volume's gradient
    residual[held] = [state.r[-1] - 1, state.z[0], state.z[-1] - state.tube.lf / 2]
    by_p = by_p.copy()
    matrix[held], by_p[held] = 0.0, 0.0
    matrix[held, held] = 1.0
    return np.block([[matrix, by_p[:, None]], [row[None, :], np.zeros((1, 1))]]), np.append(residual, 0.0)


def solve(state: State, volume: float | None = None, u_max: float | None = None) -> State:
    """The state of a given volume, or displacement of the mid-plane.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    n = len(state.r)

    def correct(at: State) -> tuple[float, Callable[[Any], State]]:
        if volume is not None:
            row, missed = None, at.volume - volume
        else:
            row, missed = np.eye(1, 2 * n)[0], at.u_max - float(u_max)
        matrix, right = bordered(at, row)
        right[-1] = missed
        step = np.linalg.solve(matrix, -right)

        def advance(share: Any) -> State:
            moved = float(share) * step
            r, z, p = at.r + moved[:n], at.z + moved[n : 2 * n], at.p + float(moved[-1])
            return State(at.tube, at.basis, r, z, p)

        return float(np.abs(step).max()), advance

    return newton(state, correct, f"energy in space of {state.tube}", longest=0.3)


def states(tube: Tube, basis: Basis, volumes: Array) -> list[State]:
    """States at rising volumes."""
    state, out = solve(guess(tube, basis, 0.3), u_max=0.3), []
    for volume in np.linspace(state.volume, float(volumes[0]), 6)[1:]:
        state = solve(state, float(volume))
    for volume in volumes:
        state = solve(state, float(volume))
        out.append(state)
    return out


def again(state: State, basis: Basis) -> State:
    """The state of the same volume in another basis."""
    if basis == state.basis:
        return state
    x, own = basis.nodes, state.basis
    e = np.clip(np.searchsorted(own.edges, x, side="right") - 1, 0, own.elements - 1)
    rows = lagrange(lobatto(own.degree), (x - own.edges[e]) / np.diff(own.edges)[e])
    columns = e[:, None] * own.degree + np.arange(own.degree + 1)
    r, z = ((rows * values[columns]).sum(axis=1) for values in (state.r, state.z))
    return solve(State(state.tube, basis, r, z, state.p), state.volume)


def matrices(state: State, family: Family) -> tuple[Array, Array]:
    """Second variation and mass of a family, without the conditions at the ends."""
    _, _, phi, dphi = state.basis.rule
    slope, w, n = dphi / state.tube.length, state.weights, family.n
    count, size = 4 * n + 2, phi.shape[1]
    k = np.zeros((3 * size, 3 * size))
    for angle in (np.arange(count) + 0.5) * 2 * np.pi / count:
        second = hessian(state.tube, state.p, *state.surface(angle))
        c, s = np.cos(angle), np.sin(angle)
        cn, sn = np.cos(n * angle), np.sin(n * angle)
        radial, hoop, axial = np.array([c, s, 0]), np.array([-s, c, 0]), np.array([0, 0, 1.0])
        moved = cn * radial, (sn if n else 1.0) * hoop, cn * axial
        turned = (  # derivatives in theta
            -n * sn * radial + cn * hoop,
            (n * cn * hoop - sn * radial) if n else -radial,
            -n * sn * axial,
        )
        # Of each component: the nine numbers by its value, and by its slope.
        by_value = [np.concatenate([m, 0 * m, t]) for m, t in zip(moved, turned, strict=True)]
        by_slope = [np.concatenate([0 * m, m, 0 * m]) for m in moved]
        parts = [((phi, v), (slope, d)) for v, d in zip(by_value, by_slope, strict=True)]
        for i, own in enumerate(parts):
            for j, other in enumerate(parts):
                block = sum(
                    f.T @ ((w * np.einsum("p,pqx,q->x", v, second, y))[:, None] * g)
                    for f, v in own
                    for g, y in other
                )
                k[i * size : (i + 1) * size, j * size : (j + 1) * size] += 2 / count * block
    return k, np.kron(np.eye(3), phi.T @ (w[:, None] * phi))


def free(state: State, family: Family) -> tuple[Array, Array]:
    """Second variation and mass on the degrees of freedom of a family; for n = 0 without torsion."""
    k, m = matrices(state, family)
    size = len(state.r)
    held = [i * size + size - 1 for i in range(3)] + [i * size for i in family.zero]
    if family.n == 0:
        held += list(range(size, 2 * size))
    keep = np.setdiff1d(np.arange(3 * size), held)
    part = np.ix_(keep, keep)
    return (k[part] + k[part].T) / 2, m[part]


def negative(state: State, family: Family) -> int:
    """Number of negative eigenvalues of a family, at most four."""
    return int(np.sum(eigh(*free(state, family), eigvals_only=True, subset_by_index=(0, 3)) < 0))


def eigenvalue(state: State, family: Family, index: int) -> float:
    """One eigenvalue in ascending order, by the Rayleigh quotient of its vector: little rounding."""
    k, m = free(state, family)
    _, vectors = eigh(k, m, subset_by_index=(index, index))
    v = vectors[:, 0]
    return float(v @ (k @ v) / (v @ (m @ v)))


def root(near: State, function: Callable[[State], float], low: float, high: float) -> State:
    """The state between two volumes at which a function of states is zero."""
    here = [near]

    def value(volume: float) -> float:
        here[0] = solve(here[0], volume)
        return function(here[0])

    return solve(here[0], brentq(value, low, high, xtol=1e-13, rtol=1e-14))


def rate(state: State) -> float:
    """dp/dV along the branch."""
    matrix, right = bordered(state)
    right[:], right[-1] = 0.0, 1.0
    return float(np.linalg.solve(matrix, right)[-1])


def least_hoop(state: State) -> tuple[float, float]:
    """Smallest l1 l2^2 - 1, the hoop resultant's sign, and its Z, by the elements' polynomials."""
    basis, best = state.basis, (np.inf, 0.0)
    nodes, degree = lobatto(basis.degree), basis.degree
    d = differentiation(nodes)
    for e, (left, width) in enumerate(zip(basis.edges[:-1], np.diff(basis.edges), strict=True)):
        own = slice(e * degree, (e + 1) * degree + 1)
        r, z = state.r[own], state.z[own]
        r1, z1 = (d @ f / (width * state.tube.length) for f in (r, z))
        low, high = 0.0, 1.0
        for _ in range(14):
            t = np.linspace(low, high, 17)
            rows = lagrange(nodes, t)
            found = np.hypot(rows @ r1, rows @ z1) * (rows @ r / state.tube.r0) ** 2 - 1
            k = int(np.argmin(found))
            best = min(best, (float(found[k]), float((left + width * t[k]) * state.tube.lf / 2)))
            low, high = t[max(k - 1, 0)], t[min(k + 1, 16)]
    return best
