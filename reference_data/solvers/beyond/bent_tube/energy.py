r"""Bent states by the energy of the half tube as a surface in space (method a).

The integrand, its gradient and its complex-step second derivatives are those of ``tube_waves.ritz``. The
position in the frame of the material angle is a Fourier series in theta with the wave number n,

.. math:: X = \sum_{k=0}^K u_k \cos kn\theta, \quad Y = \sum_{k=1}^K q_k \sin kn\theta, \quad
          Z = \sum_{k=0}^K w_k \cos kn\theta,

times polynomials on elements along the tube. Means over theta are sums over midpoints of half a wave.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from reference_data.solvers.beyond.tube_waves import ritz
from reference_data.solvers.beyond.tube_waves.family import Family
from reference_data.solvers.core.collocation import Array, lagrange, lobatto
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton

OVERSAMPLED = 2.5
"""Midpoints in half a wave over the highest harmonic: the energy is no polynomial of it."""


def directions(angles: Array, waves: tuple[Array, Array, Array], odd: bool = False) -> tuple[Array, Array]:
    """The nine numbers (x, x_z, x_theta) by value and by slope of functions of theta, at angles.

    Args:
        angles: The angles.
        waves: Wave numbers of the functions of X, Y and Z.
        odd: Sines for X and Z and cosines for Y, in place of cosines and sines.
    """
    first = np.cumsum([0, *map(len, waves)])
    by_value = np.zeros((len(angles), first[-1], 9))
    shift = -np.pi / 2 if odd else 0.0
    for a, angle in enumerate(angles):
        c, s = np.cos(angle), np.sin(angle)
        radial, hoop, axial = np.array([c, s, 0]), np.array([-s, c, 0]), np.array([0, 0, 1.0])
        units = (radial, hoop), (hoop, -radial), (axial, 0 * axial)
        for i, (k, (unit, turned)) in enumerate(zip(waves, units, strict=True)):
            part, phase = slice(first[i], first[i + 1]), shift - np.pi / 2 * (i == 1)
            value, slope = np.cos(k * angle + phase)[:, None], (-k * np.sin(k * angle + phase))[:, None]
            by_value[a, part, :3], by_value[a, part, 6:] = value * unit, slope * unit + value * turned
    by_slope = np.zeros_like(by_value)
    by_slope[..., 3:6] = by_value[..., :3]
    return by_value, by_slope


@dataclass(frozen=True)
class Series:
    """Harmonics 0..K of the wave number n, and polynomials along the tube."""

    n: int
    highest: int
    basis: ritz.Basis

    @property
    def count(self) -> int:
        """Number of functions of Z."""
        return 3 * self.highest + 2

    @property
    def parts(self) -> tuple[slice, slice, slice]:
        """Functions that belong to X, Y and Z."""
        k = self.highest
        return slice(0, k + 1), slice(k + 1, 2 * k + 1), slice(2 * k + 1, 3 * k + 2)

    @cached_property
    def angles(self) -> Array:
        """Midpoints of half a wave."""
        count = round(OVERSAMPLED * self.highest) + 4
        return (np.arange(count) + 0.5) * np.pi / (count * self.n)

    @cached_property
    def directions(self) -> tuple[Array, Array]:
        """The nine numbers (x, x_z, x_theta) by value and by slope of each function, at all angles."""
        k = self.n * np.arange(self.highest + 1)
        return directions(self.angles, (k, k[1:], k))

    def held(self) -> tuple[Array, Array]:
        """Flat places of the numbers that the disk and the mid-plane fix, and those of X = 1 and Z = lf/2."""
        nodes = len(self.basis.nodes)
        rows = np.arange(self.count)
        at_disk, middle = rows * nodes + nodes - 1, rows[self.parts[2]] * nodes
        return np.concatenate([at_disk, middle]), at_disk[[0, self.parts[2].start]]


@dataclass
class State:
    """Nodal values of all functions, shape (functions, nodes), and the pressure."""

    tube: Tube
    series: Series
    x: Array
    p: float

    gradient: ClassVar = staticmethod(ritz.gradient)
    """Of the integrand by the nine numbers."""

    def fields(self) -> Array:
        """The nine numbers at the Gauss points and angles, shape (9, points, angles)."""
        _, _, phi, dphi = self.series.basis.rule
        by_value, by_slope = self.series.directions
        value, slope = phi @ self.x.T, dphi @ self.x.T / self.tube.length
        return np.einsum("gm,amj->jga", value, by_value) + np.einsum("gm,amj->jga", slope, by_slope)

    @property
    def weights(self) -> Array:
        """Weights of the Gauss points, for means over the angles."""
        return self.series.basis.rule[1] * self.tube.length / len(self.series.angles)

    @property
    def volume(self) -> float:
        """Volume of the half tube per 2 pi; the disk's part is a third of its distance times its area."""
        x, a, b = np.split(self.fields(), 3)
        inside = np.sum(x * ritz.cross(b, a), axis=0).sum(axis=1) / 3
        return float(self.weights @ inside) + self.tube.lf / 12

    @property
    def amplitude(self) -> float:
        """Part of cos n theta in the radial position of the mid-plane."""
        return float(self.x[1, 0])

    @property
    def u_max(self) -> float:
        """Mean radial displacement of the mid-plane."""
        return float(self.x[0, 0] - 1)

    def position(self, share: Array, theta: Array) -> Array:
        """(X, Y, Z) at fractions of the half length and at angles, shape (fractions, angles, 3)."""
        basis = self.series.basis
        e = np.clip(np.searchsorted(basis.edges, share, side="right") - 1, 0, basis.elements - 1)
        rows = lagrange(lobatto(basis.degree), (share - basis.edges[e]) / np.diff(basis.edges)[e])
        at = e[:, None] * basis.degree + np.arange(basis.degree + 1)
        values = np.einsum("si,msi->sm", rows, self.x[:, at])
        k = self.series.n * np.arange(self.series.highest + 1)
        cos, sin = np.cos(np.outer(k, theta)), np.sin(np.outer(k[1:], theta))
        x, y, z = (values[:, part] for part in self.series.parts)
        return np.stack([x @ cos, y @ sin, z @ cos], axis=-1)


def linear(state: State) -> tuple[Array, Array, Array]:
    """Residual, its matrix, and its derivative by p, for all nodal values."""
    by_value, by_slope = state.series.directions
    at = np.split(state.fields(), 3)
    first, one, none = (np.concatenate(state.gradient(state.tube, p, *at)) for p in (state.p, 1.0, 0.0))
    pull = one - none
    _, _, phi, dphi = state.series.basis.rule
    rows = phi, dphi / state.tube.length

    def tested(vector: Array) -> Array:
        parts = (
            np.einsum("g,gi,amp,pga->mi", state.weights, f, own, vector, optimize=True)
            for f, own in zip(rows, (by_value, by_slope), strict=True)
        )
        return sum(parts).ravel()

    return tested(first), stiffness(state, state.series.directions), tested(pull)


def stiffness(state: State, directions: tuple[Array, Array]) -> Array:
    """Second derivatives of the potential for nodal values of functions of theta, by their directions."""
    series, w, (by_value, *_) = state.series, state.weights, directions
    second = ritz.hessian(state.tube, state.p, *np.split(state.fields(), 3), state.gradient)
    blocks = {
        (i, j): np.einsum("amp,pqga,anq->gmn", own, second, other, optimize=True)
        for i, own in enumerate(directions)
        for j, other in enumerate(directions)
    }
    _, _, phi, dphi = series.basis.rule
    rows = phi, dphi / state.tube.length
    m, nodes = by_value.shape[1], len(series.basis.nodes)
    matrix = np.zeros((m, nodes, m, nodes))
    count, degree = len(w) // series.basis.elements, series.basis.degree
    for e in range(series.basis.elements):
        g, i = slice(e * count, (e + 1) * count), slice(e * degree, (e + 1) * degree + 1)
        for (a, b), block in blocks.items():
            weighed = w[g, None, None] * block[g]
            matrix[:, i, :, i] += np.einsum(
                "gi,gmn,gj->minj", rows[a][g, i], weighed, rows[b][g, i], optimize=True
            )
    return matrix.reshape(m * nodes, -1)


def solve(state: State, held: str, target: float) -> State:
    """The state of a given volume ("V") or amplitude ("u_wave").

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    series, nodes = state.series, len(state.series.basis.nodes)
    fixed, ones = series.held()

    def correct(at: State) -> tuple[float, Callable[[Any], State]]:
        residual, matrix, by_p = linear(at)
        if held == "V":
            row, missed = -by_p, at.volume - target
        else:
            row, missed = np.eye(1, len(by_p), nodes)[0], at.amplitude - target
        wanted = np.zeros(len(by_p))
        wanted[ones] = 1.0, at.tube.lf / 2
        residual[fixed] = (at.x.ravel() - wanted)[fixed]
        row, by_p = row.copy(), by_p.copy()
        matrix[fixed], by_p[fixed] = 0.0, 0.0
        matrix[fixed, fixed] = 1.0
        whole = np.block([[matrix, by_p[:, None]], [row[None, :], np.zeros((1, 1))]])
        step = np.linalg.solve(whole, -np.append(residual, missed))

        def advance(share: Any) -> State:
            moved = float(share) * step
            return replace(at, x=at.x + moved[:-1].reshape(at.x.shape), p=at.p + float(moved[-1]))

        return float(np.abs(step).max()), advance

    return newton(state, correct, f"energy in space of {state.tube}", longest=0.3)


def on(state: State, series: Series) -> State:
    """A first guess with other functions."""
    found = np.zeros((series.count, len(series.basis.nodes)))
    own, x = state.series, series.basis.nodes
    e = np.clip(np.searchsorted(own.basis.edges, x, side="right") - 1, 0, own.basis.elements - 1)
    rows = lagrange(lobatto(own.basis.degree), (x - own.basis.edges[e]) / np.diff(own.basis.edges)[e])
    at = e[:, None] * own.basis.degree + np.arange(own.basis.degree + 1)
    values = np.einsum("si,msi->ms", rows, state.x[:, at])
    for mine, theirs in zip(series.parts, own.parts, strict=True):
        shared = min(mine.stop - mine.start, theirs.stop - theirs.start)
        found[mine.start : mine.start + shared] = values[theirs.start : theirs.start + shared]
    return replace(state, series=series, x=found)


def beside(tube: Tube, series: Series, between: tuple[float, float], order: int, amplitude: float) -> State:
    """A state of small amplitude beside the axisymmetric state at which an even wave is neutral.

    Args:
        tube: The tube.
        series: The functions.
        between: Volumes on either side of that state.
        order: Number of the eigenvalue that is zero there, from 0.
        amplitude: The amplitude.
    """
    family, low, high = Family(series.n, 1), *between
    start = tube.lf / 4
    volumes = np.append(np.geomspace(1.05 * start, low, round(np.log(low / start) / 0.04) + 2), low)
    near = ritz.states(tube, series.basis, volumes)[-1]
    critical = ritz.root(near, lambda state: ritz.eigenvalue(state, family, order), low, high)
    k, m = ritz.free(critical, family)
    _, vectors = ritz.eigh(k, m, subset_by_index=(order, order))
    nodes = len(series.basis.nodes)
    keep = np.setdiff1d(
        np.arange(3 * nodes), [i * nodes + nodes - 1 for i in range(3)] + [i * nodes for i in family.zero]
    )
    mode = np.zeros(3 * nodes)
    mode[keep] = vectors[:, 0]
    mode = mode.reshape(3, nodes) * amplitude / mode[0]
    x = np.zeros((series.count, nodes))
    parts = series.parts
    x[0], x[parts[2].start] = critical.r, critical.z
    x[1], x[parts[1].start], x[parts[2].start + 1] = mode
    return solve(State(tube, series, x, critical.p), "u_wave", amplitude)
