r"""Front-fitted piecewise Chebyshev collocation for the half tube in contact.

The half tube [0, L] is cut at fronts z_1 < z_2 < ... into zones. In a free-sliding zone the
unknowns are (rho, eta, l1, b) and the equations of ``tube_collocation`` hold; P_eff contains the spring where
it acts. In a stuck zone eta(z) is given, eta' = e(z), and only the radial equation is left; with a = rho',
l1^2 = a^2 + e^2 and the radial force m = r0 w_1 a/l1,

.. math:: \rho' = a, \qquad m(\rho, a, e)' = w_2 - P_{eff}(\rho)\, \rho\, e .

Between zones: everything continuous (two zones of one kind), or rho, eta and the radial force
continuous (stuck to free; a jump of the axial force is the line force). Ends: rho' = eta = 0 at
the mid-plane, rho = 1, eta = l_f/2 at the disk. The scalars are p and the fronts; as many scalar
conditions (p given, a front given, rho at a front given) close the system.

Each element carries polynomials on Chebyshev-Lobatto nodes and meets D M(y) = h f(y) at its
Gauss points, M = y or (rho, m). Newton's derivatives are complex-step, hence exact.
Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import STEP, Array, Mesh, rates
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2.substrate import Substrate, forces

BUMP = 1j * STEP


@dataclass(frozen=True)
class TwoSided(Mesh):
    """Elements graded to both ends; ``grading`` < 1 is the strength."""

    def __post_init__(self) -> None:
        super().__post_init__()
        s = np.linspace(0, 1, self.elements + 1)
        breaks = s - self.grading * np.sin(2 * np.pi * s) / (2 * np.pi)
        object.__setattr__(self, "breaks", breaks)


class History(Protocol):
    """Axial position frozen in the stuck zone, as a function of z (real or complex)."""

    def slope(self, z: Any) -> Any:
        """Slope eta' at which the patch is frozen."""

    def position(self, z: Any) -> Any:
        """Height eta at which the patch is frozen."""


@dataclass(frozen=True)
class Zone:
    """A part of the tube between two fronts."""

    mesh: Mesh
    stuck: bool = False
    spring: bool = False

    @property
    def size(self) -> int:
        """Unknowns per node."""
        return 2 if self.stuck else 4


@dataclass(frozen=True)
class State:
    """One equilibrium, or a guess of one.

    Attributes:
        tube: The membrane.
        substrate: The spring.
        zones: From the mid-plane to the disk.
        y: Nodal values per zone, shape (elements, degree + 1, 4 or 2).
        scalars: p, then the fronts.
        history: Frozen position of the stuck zones.
    """

    tube: Tube
    substrate: Substrate
    zones: tuple[Zone, ...]
    y: tuple[Array, ...]
    scalars: Array
    history: History | None = None

    @property
    def p(self) -> float:
        """Pressure."""
        return float(self.scalars[0])

    @property
    def fronts(self) -> Array:
        """Front positions z_1, z_2, ..."""
        return self.scalars[1:]


Condition = tuple[str, int, float]  # ("scalar", i, value) or ("rho", zone, value at its right end)


def bounds(state: State, scalars: Array) -> list[tuple[Any, Any]]:
    """Left and right end of each zone."""
    return list(pairwise([0.0, *scalars[1:], state.tube.length]))


def fluxes(state: State, zone: Zone, y: list[Any], z: Any) -> list[Any]:
    """M(y): what is differentiated."""
    if not zone.stuck:
        return y
    rho, a = y
    e = state.history.slope(z)
    return [rho, forces(state.tube, rho, np.sqrt(a * a + e * e), a, e)[0]]


def sources(state: State, zone: Zone, y: list[Any], z: Any, p: Any) -> list[Any]:
    """f(y), then the volume density rho^2 eta'/2."""
    push = state.substrate.push if zone.spring else mat.plain_pressure
    if not zone.stuck:
        return rates(y, p, state.tube, push)
    rho, a = y
    e = state.history.slope(z)
    l1 = np.sqrt(a * a + e * e)
    w2 = mat.slope(rho / state.tube.r0, l1, state.tube.alpha)
    return [a, w2 - push(rho, p) * rho * e, rho * rho * e / 2]


def places(mesh: Mesh, left: Any, right: Any) -> tuple[Any, Any]:
    """Nodes and Gauss points of a zone, as z."""
    gauss = mesh.breaks[:-1, None] + mesh.widths[:, None] * (mesh.value @ mesh.nodes)
    return left + (right - left) * mesh.x, left + (right - left) * gauss


def defect(state: State, d: int, scalars: Array) -> tuple[Array, Any]:
    """D M - h f at the Gauss points of zone d, and its share of the volume."""
    zone, y, mesh = state.zones[d], state.y[d], state.zones[d].mesh
    left, right = bounds(state, scalars)[d]
    nodes, gauss = places(mesh, left, right)
    h = (mesh.widths * (right - left))[:, None]
    flux = np.stack(fluxes(state, zone, list(np.moveaxis(y, -1, 0)), nodes), axis=-1)
    f = sources(state, zone, list(np.moveaxis(mesh.value @ y, -1, 0)), gauss, scalars[0])
    volume = np.sum(h * mesh.weights * f[-1])
    return mesh.deriv @ flux - np.stack(f[:-1], axis=-1) * h[..., None], volume


def element_blocks(state: State, d: int) -> Array:
    """Derivative of :func:`defect` by the nodal values: (element, point, equation, node, unknown)."""
    zone, y, mesh = state.zones[d], state.y[d], state.zones[d].mesh
    left, right = bounds(state, state.scalars)[d]
    nodes, gauss = places(mesh, left, right)
    h = (mesh.widths * (right - left))[:, None, None]
    at_nodes, at_gauss = (list(np.moveaxis(v, -1, 0)) for v in (y, mesh.value @ y))
    out = np.empty((mesh.elements, mesh.degree, zone.size, mesh.degree + 1, zone.size))
    for j in range(zone.size):
        flux = fluxes(state, zone, [v + BUMP * (i == j) for i, v in enumerate(at_nodes)], nodes)
        f = sources(state, zone, [v + BUMP * (i == j) for i, v in enumerate(at_gauss)], gauss, state.p)
        for i in range(zone.size):
            slope = np.imag(flux[i] + BUMP * 0) / STEP
            push = np.imag(f[i] + BUMP * 0) / STEP
            out[:, :, i, :, j] = mesh.deriv * slope[:, None, :] - h * push[..., None] * mesh.value
    return out


def joint(state: State, d: int, left: Array, right: Array, z: Any) -> list[Any]:
    """Conditions between zones d and d + 1, given the nodal values on both sides."""
    before, after = state.zones[d], state.zones[d + 1]
    if before.stuck == after.stuck:
        return list(left - right)
    rho, a = left
    e = state.history.slope(z)
    inner = forces(state.tube, rho, np.sqrt(a * a + e * e), a, e)[0]
    outer = forces(state.tube, right[0], right[2], right[2] * np.sin(right[3]), 0.0)[0]
    return [rho - right[0], state.history.position(z) - right[1], inner - outer]


class Linearised:
    """Newton system at a state: residual, matrix, and solutions with its factors."""

    def __init__(self, state: State, conditions: list[Condition]) -> None:
        self.state, self.conditions = state, conditions
        counts = [z.mesh.elements * (z.mesh.degree + 1) * z.size for z in state.zones]
        self.offset = np.concatenate([[0], np.cumsum(counts)])
        self.size = int(self.offset[-1]) + len(state.scalars)
        self.entries: list[tuple[Any, Any, Any]] = []
        self.rhs: list[Array] = []
        self.row, self.volume = 0, 0.0
        for d in range(len(state.zones)):
            self._zone(d)
        self.joint_row = self.row
        for d in range(len(state.zones) - 1):
            self._joint(d)
        self._ends()
        rows, cols, values = (np.concatenate([np.ravel(e[i]) for e in self.entries]) for i in range(3))
        matrix = sp.csc_matrix((values, (rows, cols)), shape=(self.size, self.size))
        self.factors = splu(matrix)
        self.residual = np.concatenate(self.rhs)

    def index(self, d: int, element: int, node: int) -> Array:
        """Positions of the unknowns at one node."""
        mesh, size = self.state.zones[d].mesh, self.state.zones[d].size
        element, node = element % mesh.elements, node % (mesh.degree + 1)
        return self.offset[d] + (element * (mesh.degree + 1) + node) * size + np.arange(size)

    def _add(self, residual: Array, cols: Array, block: Array) -> None:
        """Rows for ``residual`` whose derivative by the unknowns ``cols`` is ``block``."""
        residual = np.atleast_1d(residual)
        rows = self.row + np.arange(len(residual))
        self.entries.append((*np.broadcast_arrays(rows[:, None], cols[None, :]), block))
        self.rhs.append(residual)
        self.row += len(residual)

    def _zone(self, d: int) -> None:
        state, zone = self.state, self.state.zones[d]
        mesh, size = zone.mesh, zone.size
        k, m = mesh.elements, mesh.degree
        value, volume = defect(state, d, state.scalars)
        self.volume += float(volume)
        blocks = element_blocks(state, d).reshape(k, m * size, (m + 1) * size)
        by_scalar = []
        for i in range(len(state.scalars)):
            bumped = state.scalars + BUMP * (np.arange(len(state.scalars)) == i)
            by_scalar.append(np.imag(defect(state, d, bumped)[0]).reshape(k, -1) / STEP)
        last = self.size - len(state.scalars) + np.arange(len(state.scalars))
        for e in range(k):
            cols = self.offset[d] + e * (m + 1) * size + np.arange((m + 1) * size)
            more = np.stack([b[e] for b in by_scalar], axis=1)
            self._add(value[e].ravel(), np.append(cols, last), np.hstack([blocks[e], more]))
        for e in range(k - 1):
            gap = state.y[d][e, -1] - state.y[d][e + 1, 0]
            cols = np.append(self.index(d, e, -1), self.index(d, e + 1, 0))
            self._add(gap, cols, np.hstack([np.eye(size), -np.eye(size)]))

    def _joint(self, d: int) -> None:
        state = self.state
        left, right, z = state.y[d][-1, -1], state.y[d + 1][0, 0], state.fronts[d]
        values = np.concatenate([left, right, [z]])
        n = len(left)
        cols = np.concatenate(
            [self.index(d, -1, -1), self.index(d + 1, 0, 0), [self.offset[-1] + 1 + d]]
        ).astype(int)
        block = np.empty((len(joint(state, d, left, right, z)), len(values)))
        for i in range(len(values)):
            v = values + BUMP * (np.arange(len(values)) == i)
            block[:, i] = np.imag(joint(state, d, v[:n], v[n:-1], v[-1])) / STEP
        self._add(np.array(joint(state, d, left, right, z)), cols, block)

    def _ends(self) -> None:
        state, one = self.state, np.ones((1, 1))
        first, disk = self.index(0, 0, 0), self.index(len(state.zones) - 1, -1, -1)
        for i in (1,) if state.zones[0].stuck else (1, 3):
            self._add(state.y[0][0, 0, i], first[i : i + 1], one)
        for i, wanted in ((0, 1.0), (1, state.tube.lf / 2)):
            self._add(state.y[-1][-1, -1, i] - wanted, disk[i : i + 1], one)
        for kind, i, wanted in self.conditions:
            if kind == "scalar":
                self._add(state.scalars[i] - wanted, np.array([self.offset[-1] + i]), one)
            else:
                self._add(state.y[i][-1, -1, 0] - wanted, self.index(i, -1, -1)[:1], one)

    def split(self, step: Array) -> Iterator[Array]:
        """Cut a vector of all unknowns into zones and scalars."""
        for d, y in enumerate(self.state.y):
            yield step[self.offset[d] : self.offset[d + 1]].reshape(y.shape)
        yield step[self.offset[-1] :]


def newton(start: State, conditions: list[Condition], max_iter: int = 40) -> tuple[State, Linearised]:
    """Equilibrium under the scalar conditions, and the system linearised at it.

    Steps are damped while they are large; one more is taken after the first below 1e-7.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    state, small = start, 0
    for _ in range(max_iter):
        system = Linearised(state, conditions)
        if small == 2:
            return state, system
        step = -system.factors.solve(system.residual)
        size = float(np.abs(step).max())
        if not np.isfinite(size):
            break
        parts = list(system.split(min(1.0, 0.4 / size) * step))
        y = tuple(a + b for a, b in zip(state.y, parts, strict=False))
        state = replace(state, y=y, scalars=state.scalars + parts[-1])
        small += size < 1e-7
    raise RuntimeError(f"collocation: no convergence at {conditions} for {start.tube}")
