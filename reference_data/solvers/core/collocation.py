r"""Piecewise Chebyshev collocation of first-order systems between ends and fronts that may be unknown.

A problem is a chain of zones. In each, with the fraction s of the zone,

.. math:: dy/ds = f(y, s, c), \qquad 0 \le s \le 1,

c being numbers common to all zones: loads, volumes, positions of fronts. Conditions on the values at the ends
of zones and on c close the problem; there is one for each component of each zone and each of the numbers.

An element carries polynomials of one degree on Chebyshev-Lobatto nodes and meets the equations at its Gauss
points. Derivatives are complex steps, hence exact; inner nodes are eliminated element by element. Arrays may
have leading axes, in which states of one kind are solved side by side.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from reference_data.solvers.core.newton import newton

Array = np.ndarray
STEP = 1e-30  # complex-step increment, which may be arbitrarily small, because nothing is subtracted
CIRCLE = 0.05 * np.exp(2j * np.pi * np.arange(16) / 16)  # for second derivatives
Ends = list[list[Any]]
Conditions = Callable[[Ends, Ends, list[Any]], list[Any]]


def lagrange(nodes: Array, points: Array) -> Array:
    """Matrix of the interpolant through values at ``nodes``, evaluated at ``points``."""
    gaps = nodes[:, None] - nodes[None, :] + np.eye(len(nodes))
    weights = 1 / np.prod(gaps, axis=1)
    diff = points[:, None] - nodes[None, :]
    hit = diff == 0
    terms = weights / np.where(hit, 1.0, diff)
    rows = terms / terms.sum(axis=1, keepdims=True)
    return np.where(hit.any(axis=1, keepdims=True), hit.astype(float), rows)


def differentiation(nodes: Array) -> Array:
    """Matrix of the derivative, at the nodes, of the interpolant through the nodes."""
    gaps = nodes[:, None] - nodes[None, :] + np.eye(len(nodes))
    weights = 1 / np.prod(gaps, axis=1)
    d = weights[None, :] / weights[:, None] / gaps
    np.fill_diagonal(d, 0.0)
    # rows sum to zero exactly: the derivative of a constant
    return d - np.diag(d.sum(axis=1))


def lobatto(degree: int) -> Array:
    """Chebyshev-Lobatto nodes on [0, 1]."""
    return (1 - np.cos(np.pi * np.arange(degree + 1) / degree)) / 2


def components(y: Array) -> list[Array]:
    """Components of an array, with its last axis first."""
    return list(np.moveaxis(y, -1, 0))


@dataclass(frozen=True)
class Rule:
    """Polynomials of one degree on [0, 1]: nodes, Gauss points and weights, values and slopes there."""

    nodes: Array
    points: Array
    weights: Array
    value: Array
    deriv: Array


@cache
def rule(degree: int) -> Rule:
    """The rule of a degree, which is also the number of Gauss points."""
    gauss, weights = np.polynomial.legendre.leggauss(degree)
    nodes = lobatto(degree)
    value = lagrange(nodes, (gauss + 1) / 2)
    return Rule(nodes, (gauss + 1) / 2, weights / 2, value, value @ differentiation(nodes))


@dataclass(frozen=True)
class Mesh:
    """Elements of one degree between rising breaks (of a zone: from 0 to 1)."""

    breaks: tuple[float, ...]
    degree: int

    @classmethod
    def graded(cls, elements: int, degree: int, power: float = 1.0) -> Mesh:
        """Elements on [0, 1] with breaks 1 - (1 - s)^power, finer at 1 for larger powers."""
        return cls(tuple(map(float, 1 - (1 - np.linspace(0, 1, elements + 1)) ** power)), degree)

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.breaks) - 1

    @cached_property
    def edges(self) -> Array:
        """The breaks, as an array."""
        return np.array(self.breaks)

    @cached_property
    def widths(self) -> Array:
        """Widths of the elements."""
        return np.diff(self.edges)

    @property
    def rule(self) -> Rule:
        """Polynomials on each element."""
        return rule(self.degree)

    @cached_property
    def x(self) -> Array:
        """Nodes, shape (elements, degree + 1)."""
        return self.edges[:-1, None] + self.widths[:, None] * self.rule.nodes

    @cached_property
    def gauss(self) -> Array:
        """Gauss points, shape (elements, degree)."""
        return self.edges[:-1, None] + self.widths[:, None] * self.rule.points

    @cached_property
    def weights(self) -> Array:
        """Weights of the Gauss points."""
        return self.widths[:, None] * self.rule.weights

    def slope(self, y: Array) -> Array:
        """Derivative at the nodes of scalar values (..., elements, degree + 1)."""
        return y @ differentiation(self.rule.nodes).T / self.widths[:, None]

    def evaluate(self, y: Array, x: Array) -> Array:
        """Piecewise polynomial with values (elements, degree + 1, components) at x."""
        flat = np.ravel(x)
        k = np.clip(np.searchsorted(self.edges, flat, side="right") - 1, 0, self.elements - 1)
        rows = lagrange(self.rule.nodes, (flat - self.edges[k]) / self.widths[k])
        return np.einsum("im,imc->ic", rows, y[k]).reshape(*np.shape(x), y.shape[-1])


@dataclass(frozen=True)
class Zone:
    """A part in which the equations are smooth.

    Attributes:
        mesh: Elements over its fraction s, from 0 to 1.
        rates: Right-hand sides dy/ds from the components of y, the fractions s and the numbers c.
    """

    mesh: Mesh
    rates: Callable[[list[Any], Array, list[Any]], list[Any]]


@dataclass(frozen=True)
class Resolution:
    """Meshes of a free membrane, of a patch in contact and of the rest, and the terms of a frozen history."""

    free: Mesh
    inner: Mesh
    outer: Mesh
    terms: int


def joined(left: Ends, right: Ends) -> list[Any]:
    """Conditions that all components are continuous between zones."""
    return [
        a - b
        for end, start in zip(right[:-1], left[1:], strict=True)
        for a, b in zip(end, start, strict=True)
    ]


def derivatives(f: Callable[[list[Any]], Array], x: list[Any]) -> Array:
    """Derivatives of f by each of the arguments x, in a last axis."""
    return np.stack(
        [np.imag(f([v + 1j * STEP if i == j else v for i, v in enumerate(x)])) / STEP for j in range(len(x))],
        axis=-1,
    )


@dataclass(frozen=True)
class Problem:
    """Zones and conditions."""

    zones: tuple[Zone, ...]
    conditions: Conditions

    def rates(self, d: int, at: list[Any], c: list[Any]) -> Array:
        """Right-hand sides of zone d at its Gauss points, components in the last axis."""
        c = [np.asarray(v)[..., None, None] for v in c]
        found = self.zones[d].rates(at, self.zones[d].mesh.gauss, c)
        return np.stack(np.broadcast_arrays(*found, at[0])[:-1], axis=-1)

    def defects(self, y: tuple[Array, ...], c: Array) -> list[Array]:
        """What the polynomials miss of the equations at the Gauss points of each zone."""
        out = []
        for d, v in enumerate(y):
            mesh = self.zones[d].mesh
            f = self.rates(d, components(mesh.rule.value @ v), components(c))
            out.append(mesh.rule.deriv @ v - mesh.widths[:, None, None] * f)
        return out

    def missed(self, y: tuple[Array, ...], c: Array) -> Array:
        """The conditions' values, in the last axis."""
        return self._missed([*self._ends(y), *components(c)], y)

    @staticmethod
    def _ends(y: tuple[Array, ...]) -> list[Any]:
        ends = (v[..., e, e, :] for e in (0, -1) for v in y)
        return [x for end in ends for x in components(end)]

    def _missed(self, flat: list[Any], y: tuple[Array, ...]) -> Array:
        given, parts = iter(flat), []
        for _ in (0, -1):
            parts.append([[next(given) for _ in range(v.shape[-1])] for v in y])
        found = self.conditions(*parts, c := list(given))
        return np.stack(np.broadcast_arrays(*found, c[0])[:-1], axis=-1)

    def linearised(self, y: tuple[Array, ...], c: Array) -> Linearised:
        """The problem about some values."""
        return Linearised(self, y, c)

    def bent(self, y: tuple[Array, ...], c: Array, dy: list[Array], dc: Array) -> tuple[list[Array], Array]:
        """Coefficients of t^2 of defects and conditions along y + t dy, c + t dc (sums over a circle)."""
        found = [
            (self.defects(at := tuple(a + t * b for a, b in zip(y, dy, strict=True)), c + t * dc),
             self.missed(at, c + t * dc))
            for t in CIRCLE
        ]  # fmt: skip
        weight = 1 / CIRCLE**2 / len(CIRCLE)
        defects = [
            sum(np.real(w * f[0][d]) for w, f in zip(weight, found, strict=True)) for d in range(len(y))
        ]
        return defects, sum(np.real(w * f[1]) for w, f in zip(weight, found, strict=True))

    def solve(
        self,
        y: tuple[Array, ...],
        c: Array,
        what: str,
        room: Callable[[Array, Array], Any] = lambda _c, _dc: 1.0,
        **named: Any,
    ) -> tuple[tuple[Array, ...], Array]:
        """Values that meet equations and conditions, from a guess.

        Args:
            y: Nodal values of each zone, (..., elements, degree + 1, components).
            c: The numbers, (..., count).
            what: What is sought, for the message.
            room: The largest share of a correction of c that may be made.
            named: ``longest``, ``close`` and ``most`` of Newton's method.

        Raises:
            RuntimeError: If Newton's method does not converge.
        """

        def correct(at: tuple[tuple[Array, ...], Array]) -> tuple[Any, Callable[[Any], Any]]:
            y, c = at
            system = self.linearised(y, c)
            dy, dc = system.solve(system.defects, system.missed)
            size = np.max(np.abs(dc), axis=-1)
            for part in dy:
                size = np.maximum(size, np.max(np.abs(part), axis=(-3, -2, -1)))

            def advance(share: Any) -> tuple[tuple[Array, ...], Array]:
                share = np.minimum(share, room(c, dc))
                wide = np.asarray(share)[..., None, None, None]
                moved = tuple(a + wide * b for a, b in zip(y, dy, strict=True))
                return moved, c + np.asarray(share)[..., None] * dc

            return size, advance

        return newton((y, c), correct, what, **{"longest": 0.4, "close": 1e-8} | named)


class Linearised:
    """A problem about some values: defects, what conditions miss, and solutions of the linear system."""

    def __init__(self, problem: Problem, y: tuple[Array, ...], c: Array) -> None:
        self.count = c.shape[-1]
        self.defects: list[Array] = []
        self.blocks: list[tuple[Array, Array]] = []
        for d, v in enumerate(y):
            self._zone(problem, d, v, components(c))
        flat = [*problem._ends(y), *components(c)]
        self.missed = problem._missed(flat, y)
        self.by_ends = derivatives(lambda x: problem._missed(x, y), flat)

    def _zone(self, problem: Problem, d: int, v: Array, c: list[Array]) -> None:
        mesh, n = problem.zones[d].mesh, v.shape[-1]
        at, width = components(mesh.rule.value @ v), mesh.widths[:, None, None]
        call = lambda x: problem.rates(d, x[:n], x[n:])  # noqa: E731
        self.defects.append(mesh.rule.deriv @ v - width * call([*at, *c]))
        jac = width[..., None] * derivatives(call, [*at, *c])
        block = np.einsum("mq,ij->miqj", mesh.rule.deriv, np.eye(n))
        block = block - np.einsum("...mij,mq->...miqj", jac[..., :n], mesh.rule.value)
        shape = (*v.shape[:-2], n * mesh.degree)
        self.blocks.append((block.reshape(*shape, -1), jac[..., n:].reshape(*shape, -1)))

    def solve(self, defects: list[Array], missed: Array) -> tuple[list[Array], Array]:
        """Changes of all values that cancel these defects and misses to first order."""
        inner = []  # all nodes of an element but the left one, by the left one, by c, and the rest
        for (block, by_c), defect in zip(self.blocks, defects, strict=True):
            n = defect.shape[-1]
            right = [-block[..., :n], by_c, -defect.reshape(*by_c.shape[:-1], 1)]
            inner.append(np.linalg.solve(block[..., n:], np.concatenate(right, axis=-1)))
        sizes = [d.shape[-1] for d in defects]
        ends = [n * (x.shape[-3] + 1) for n, x in zip(sizes, inner, strict=True)]
        total, first = sum(ends) + self.count, sum(ends) - sum(sizes)
        a, b = np.zeros((*missed.shape[:-1], total, total)), np.zeros((*missed.shape[:-1], total))
        row = column = place = 0
        for n, x in zip(sizes, inner, strict=True):
            begin = column
            for e in range(x.shape[-3]):
                rows, through = slice(row, row + n), x[..., e, -n:, :]
                a[..., rows, column : column + n] = -through[..., :n]
                a[..., rows, column + n : column + 2 * n] = np.eye(n)
                a[..., rows, sum(ends) :], b[..., rows] = -through[..., n:-1], through[..., -1]
                row, column = row + n, column + n
            a[..., first:, begin : begin + n] += self.by_ends[..., place : place + n]
            right = sum(sizes) + place
            a[..., first:, column : column + n] += self.by_ends[..., right : right + n]
            column, place = column + n, place + n
        a[..., first:, sum(ends) :], b[..., first:] = self.by_ends[..., 2 * sum(sizes) :], -missed
        z = np.linalg.solve(a, b[..., None])[..., 0]
        dc, dy, begin = z[..., sum(ends) :], [], 0
        for n, x, size in zip(sizes, inner, ends, strict=True):
            at = z[..., begin : begin + size].reshape(*z.shape[:-1], -1, n)
            begin += size
            k = at.shape[-2] - 1
            rest = np.broadcast_to(dc[..., None, :], (*dc.shape[:-1], k, self.count))
            known = np.concatenate([at[..., :-1, :], rest, np.ones((*rest.shape[:-1], 1))], axis=-1)
            inside = np.einsum("...ij,...j->...i", x, known).reshape(*z.shape[:-1], k, -1, n)
            dy.append(np.concatenate([at[..., :-1, None, :], inside], axis=-2))
        return dy, dc

    def response(self, condition: int = -1) -> tuple[list[Array], Array]:
        """Derivative of all values by the number to which a condition holds something."""
        unit = np.zeros_like(self.missed)
        unit[..., condition] = -1.0
        return self.solve([0 * d for d in self.defects], unit)
