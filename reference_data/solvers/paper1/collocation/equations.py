r"""Method (b): piecewise Chebyshev collocation of the first-order system, many states at once.

In a sliding zone the unknowns are (rho, eta, l1, th), th the angle by which the membrane falls:

.. math::
   \rho' = l_1 \cos\theta, \quad \eta' = -l_1 \sin\theta, \quad
   l_1' = \frac{W_2 \cos\theta - W_1 - W_{12} (l_1 \cos\theta - l_2)}{x W_{11}}, \quad
   \theta' = \frac{p_e\, \rho\, l_1 - W_2 \sin\theta}{x W_1},

p_e = p - k (eta - l) where the spring acts. Fronts cut [0, 1/beta] into zones. Each zone is
mapped to [0, 1], linearly if it begins at the pole, else by x = left (right/left)^s; each of its
elements carries polynomials on Chebyshev-Lobatto nodes that meet the equations at the Gauss
points. Conditions couple the ends of the zones, p and the fronts; there are as many conditions as unknowns.

All arrays have a leading axis: states of one kind (same zones, same conditions) are solved together. Newton's
derivatives are complex-step, hence exact. Interior nodes are eliminated element by element. Source: Patil,
DasGupta & Eriksson (2015), equations (10)-(13) and (16).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import STEP, Array, Mesh, lagrange
from reference_data.solvers.paper1.membrane import Disk

BUMP = 1j * STEP
Rates = Callable[[list[Any], Any, Any], list[Any]]


@dataclass(frozen=True)
class Sliding:
    """A zone whose points move freely; ``spring``: the substrate pushes."""

    disk: Disk
    mesh: Mesh
    spring: bool = False
    size: int = 4

    def rates(self, y: list[Any], x: Any, p: Any) -> list[Any]:
        """Right-hand sides of (rho, eta, l1, th)."""
        rho, eta, l1, th = y
        a, l2 = self.disk.alpha, rho / x
        w1, w2 = mat.slope(l1, l2, a), mat.slope(l2, l1, a)
        c, s = np.cos(th), np.sin(th)
        push = p - self.disk.k * (eta - self.disk.l) if self.spring else p
        stretching = w2 * c - w1 - mat.mixed(l1, l2, a) * (l1 * c - l2)
        turning = push * rho * l1 - w2 * s
        return [l1 * c, -l1 * s, stretching / (x * mat.curvature(l1, l2, a)), turning / (x * w1)]


@dataclass(frozen=True)
class Batch:
    """Several states, converged or guesses.

    Attributes:
        zones: From the pole to the rim.
        y: Nodal values per zone, shape (state, element, node, unknown).
        scalars: p and further unknowns, shape (state, number).
        ends: The ends of the zones as a function of the scalars, each of shape (state,).
        conditions: Of (left values, right values, scalars) of the zones; lists over zones of
            lists over unknowns.
    """

    zones: tuple[Any, ...]
    y: tuple[Array, ...]
    scalars: Array
    ends: Callable[[Any], list[tuple[Any, Any]]]
    conditions: Callable[[list[list[Any]], list[list[Any]], list[Any]], list[Any]]

    @property
    def p(self) -> Array:
        """Pressures."""
        return self.scalars[:, 0]

    def edges(self, d: int) -> tuple[Array, Array]:
        """Left and right end of zone d."""
        left, right = self.ends(list(self.scalars.T))[d]
        return tuple(np.broadcast_to(e, self.p.shape) for e in (left, right))


def spread(left: Any, right: Any, at: Array) -> tuple[Any, Any]:
    """Position x and dx/ds at fractions ``at`` of a zone; at has shape (element, point)."""
    left, right = (np.asarray(e)[..., None, None] for e in (left, right))
    if np.all(left == 0):
        return right * at, right + 0 * at
    x = left * (right / left) ** at
    return x, x * np.log(right / left)


def fractions(left: Any, right: Any, x: Array) -> Array:
    """Inverse of :func:`spread`."""
    return x / right if left == 0 else np.log(x / left) / np.log(right / left)


def gauss(mesh: Mesh) -> Array:
    """Gauss points of a mesh as fractions of the zone, shape (element, point)."""
    return mesh.breaks[:-1, None] + mesh.widths[:, None] * (mesh.value @ mesh.nodes)


def components(y: Array) -> list[Array]:
    """Components of an array, with its last axis first."""
    return list(np.moveaxis(y, -1, 0))


def defect(batch: Batch, d: int, scalars: list[Any], at: list[Any]) -> Array:
    """dx/ds times the rates of zone d at the Gauss points, for the values ``at`` there."""
    zone = batch.zones[d]
    x, stretch = spread(*batch.ends(scalars)[d], gauss(zone.mesh))
    p = np.asarray(scalars[0])[:, None, None]
    return np.stack([f * stretch for f in zone.rates(at, x, p)], axis=-1)


@dataclass
class Eliminated:
    """Zone d of a batch, with its interior nodes expressed by the left end and the scalars.

    Attributes:
        inner: Solution operator, shape (state, element, node - 1, unknown, size + scalars + 1).
        through: Right end of the zone by left end, scalars and constant.
    """

    inner: Array
    through: Array


def eliminate(batch: Batch, d: int) -> Eliminated:
    """Linearise zone d and eliminate everything but its left end."""
    zone, y, mesh = batch.zones[d], batch.y[d], batch.zones[d].mesh
    n, (b, k, m) = zone.size, (len(batch.p), mesh.elements, mesh.degree)
    scalars, at = list(batch.scalars.T), components(mesh.value @ y)
    h = mesh.widths[:, None, None]
    f = defect(batch, d, scalars, at)
    right = [-(mesh.deriv @ y - h * f)]
    jac = np.empty((b, k, m, n, n))
    for j in range(n):
        bumped = [a + BUMP if i == j else a for i, a in enumerate(at)]
        jac[..., j] = np.imag(defect(batch, d, scalars, bumped)) / STEP
    for j in range(len(scalars)):
        bumped = [s + BUMP if i == j else s for i, s in enumerate(scalars)]
        right.insert(j, h * np.imag(defect(batch, d, bumped, at)) / STEP)
    block = np.einsum("mn,ij->minj", mesh.deriv, np.eye(n)) - np.einsum(
        "k,bkmij,mn->bkminj", mesh.widths, jac, mesh.value
    )
    block = block.reshape(b, k, n * m, n * (m + 1))
    rhs = np.concatenate([-block[..., :n], *(r.reshape(b, k, n * m, 1) for r in right)], axis=-1)
    inner = np.linalg.solve(block[..., n:], rhs)
    through = np.concatenate([np.eye(n), np.zeros((n, len(right)))], axis=1)[None] + np.zeros((b, 1, 1))
    for e in range(k):
        last = inner[:, e, -n:]
        through = last[..., :n] @ through + np.concatenate([0 * last[..., :n], last[..., n:]], axis=-1)
    return Eliminated(inner.reshape(b, k, m, n, -1), through)


def condition_system(batch: Batch) -> tuple[Array, list[Array], list[Array], Array]:
    """Conditions and their derivatives by left ends, right ends and scalars."""
    left = [components(y[:, 0, 0]) for y in batch.y]
    right = [components(y[:, -1, -1]) for y in batch.y]
    scalars = list(batch.scalars.T)

    def varied(group: list[Any], j: int, call: Callable[[list[Any]], list[Any]]) -> Array:
        bumped = [v + BUMP if i == j else v for i, v in enumerate(group)]
        rows = call(bumped)
        return np.stack([np.imag(r + 0j * group[j]) / STEP for r in rows], axis=-1)

    by_left, by_right = [], []
    for d, zone in enumerate(batch.zones):
        for side, kept in ((left, by_left), (right, by_right)):

            def call(new: list[Any], side: Any = side, d: int = d) -> list[Any]:
                moved = [new if i == d else v for i, v in enumerate(side)]
                return batch.conditions(
                    moved if side is left else left, moved if side is right else right, scalars
                )

            columns = [varied(side[d], j, call) for j in range(zone.size)]
            kept.append(np.stack(columns, axis=-1))
    call = lambda new: batch.conditions(left, right, new)  # noqa: E731
    by_scalar = np.stack([varied(scalars, j, call) for j in range(len(scalars))], axis=-1)
    zero = 0 * batch.p
    value = np.stack([r + zero for r in batch.conditions(left, right, scalars)], axis=-1)
    return value, by_left, by_right, by_scalar


def correction(batch: Batch) -> tuple[list[Array], Array]:
    """Newton correction of nodal values and scalars."""
    zones = [eliminate(batch, d) for d in range(len(batch.zones))]
    value, by_left, by_right, by_scalar = condition_system(batch)
    s, columns, rhs = batch.scalars.shape[1], [], -value
    total = by_scalar.copy()
    for zone, gone, left, right in zip(batch.zones, zones, by_left, by_right, strict=True):
        n = zone.size
        columns.append(left + right @ gone.through[..., :n])
        total += right @ gone.through[..., n : n + s]
        rhs = rhs - (right @ gone.through[..., n + s :])[..., 0]
    matrix = np.concatenate([*columns, total], axis=-1)
    z = np.linalg.solve(matrix, rhs[..., None])[..., 0]
    ds, dy, first = z[:, -s:], [], 0
    for zone, gone in zip(batch.zones, zones, strict=True):
        n, k = zone.size, zone.mesh.elements
        start = z[:, first : first + n]
        first += n
        parts = []
        for e in range(k):
            known = np.concatenate([start, ds, np.ones((len(ds), 1))], axis=-1)
            inside = np.einsum("bmic,bc->bmi", gone.inner[:, e], known)
            parts.append(np.concatenate([start[:, None], inside], axis=1))
            start = inside[:, -1]
        dy.append(np.stack(parts, axis=1))
    return dy, ds


def newton(batch: Batch, limit: float = 0.3, max_iter: int = 60) -> Batch:
    """Solve all states; one more step after the first below 1e-8 leaves rounding errors only.

    Raises:
        RuntimeError: If a state does not converge.
    """
    small = False
    for _ in range(max_iter):
        dy, ds = correction(batch)
        size = np.max(np.abs(ds), axis=1)
        for part in dy:
            size = np.maximum(size, np.max(np.abs(part), axis=(1, 2, 3)))
        if not np.all(np.isfinite(size)):
            break
        scale = np.minimum(1.0, limit / np.maximum(size, 1e-300))
        y = tuple(old + scale[:, None, None, None] * new for old, new in zip(batch.y, dy, strict=True))
        batch = replace(batch, y=y, scalars=batch.scalars + scale[:, None] * ds)
        if small:
            return batch
        small = bool(np.max(size) < 1e-8)
    raise RuntimeError(f"collocation: no convergence for {batch.zones[-1].disk}, scalars {batch.scalars[0]}")


def evaluate(batch: Batch, d: int, state: int, x: Array) -> Array:
    """Values of zone d of one state at positions x, shape of x, then unknowns."""
    mesh = batch.zones[d].mesh
    left, right = (float(e[state]) for e in batch.edges(d))
    s = fractions(left, right, np.asarray(x, dtype=float))
    e = np.clip(np.searchsorted(mesh.breaks, s, side="right") - 1, 0, mesh.elements - 1)
    rows = lagrange(mesh.nodes, (s - mesh.breaks[e]) / mesh.widths[e])
    return np.einsum("im,imc->ic", rows, batch.y[d][state][e])


def integral(batch: Batch, d: int, density: Callable[[list[Any], Any], Any]) -> Array:
    """Integral over x of a density (values, x), zone d, every state."""
    mesh = batch.zones[d].mesh
    x, stretch = spread(*batch.edges(d), gauss(mesh))
    at = components(mesh.value @ batch.y[d])
    weight = mesh.widths[:, None] * mesh.weights
    return np.sum(weight * stretch * density(at, x), axis=(1, 2))
