r"""Piecewise Chebyshev collocation with the fronts and the fluid's surface as unknown breakpoints.

Unknowns over s in [0, L]: radius r, height z, meridional stretch l and slope angle b of the
meridian with the axis, with

.. math::
   r' = l \sin b,\quad z' = l \cos b,\quad
   \eta W_1\, b' = \eta W_2 \cos b - P r l,

and, taut, eta W_11 l' = eta (W_2 - W_12 l) sin b - eta' W_1, or, wrinkled,
eta W_r'' l' = -eta' W_r' with W_2 = 0 (the equilibrium equations of Patil, Nordmark & Eriksson,
Eur. J. Mech. A/Solids 54 (2015) 1-10, solved for the highest derivatives); r = Af at both ends,
z(0) = 0, z(L) = delta L. Each zone is of one state (taut or wrinkled, wet or dry), so that its
equations are smooth; at a front r^2 l = 1, at the surface z = zw.

Every element carries polynomials on Chebyshev-Lobatto nodes and meets the equations at its
Gauss points. Newton's derivatives are complex-step, hence exact, the breakpoints included.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Array, Membrane

STEP = 1e-30


@dataclass(frozen=True)
class Rule:
    """Polynomials of one degree on [0, 1], and the largest length of an element.

    Attributes:
        degree: Polynomial degree, also the number of collocation points per element.
        longest: Longest element, in units of Ao.
    """

    degree: int
    longest: float
    nodes: Array = field(init=False, compare=False)
    weights: Array = field(init=False, compare=False)
    value: Array = field(init=False, compare=False)
    deriv: Array = field(init=False, compare=False)
    points: Array = field(init=False, compare=False)

    def __post_init__(self) -> None:
        put = lambda name, x: object.__setattr__(self, name, x)  # noqa: E731
        nodes = (1 - np.cos(np.pi * np.arange(self.degree + 1) / self.degree)) / 2
        gauss, weights = np.polynomial.legendre.leggauss(self.degree)
        put("nodes", nodes)
        put("points", (gauss + 1) / 2)
        put("weights", weights / 2)
        put("value", lagrange(nodes, (gauss + 1) / 2))
        put("deriv", self.value @ differentiation(nodes))


@dataclass(frozen=True)
class Pattern:
    """Breakpoints, and the zones between them.

    Attributes:
        breaks: 0, the fronts and the surface in rising order, L.
        kinds: "front" or "surface" for each inner breakpoint.
        tense: Whether each zone is taut.
        wet: Whether each zone lies below the surface (all True for gas).
    """

    breaks: tuple[float, ...]
    kinds: tuple[str, ...]
    tense: tuple[bool, ...]
    wet: tuple[bool, ...]

    @property
    def fronts(self) -> Array:
        """Positions of the fronts."""
        return np.array([b for b, k in zip(self.breaks[1:-1], self.kinds, strict=True) if k == "front"])

    @property
    def signature(self) -> tuple[bool, ...]:
        """Taut or wrinkled from the bottom up, without the surface."""
        return tuple(t for i, t in enumerate(self.tense) if i == 0 or t != self.tense[i - 1])

    def moved(self, inner: Array) -> Pattern:
        """The same zones between other breakpoints."""
        return replace(self, breaks=(self.breaks[0], *map(float, inner), self.breaks[-1]))


@dataclass
class State:
    """One equilibrium: nodal values (elements, degree + 1, 4) of (r, z, l, b), and the load."""

    membrane: Membrane
    rule: Rule
    pattern: Pattern
    counts: tuple[int, ...]
    y: Array
    load: float

    @property
    def zone(self) -> Array:
        """Zone of each element."""
        return np.repeat(np.arange(len(self.counts)), self.counts)

    @property
    def edges(self) -> Array:
        """Element boundaries."""
        b = self.pattern.breaks
        parts = [np.linspace(b[j], b[j + 1], n + 1)[:-1] for j, n in enumerate(self.counts)]
        return np.concatenate([*parts, b[-1:]])

    @property
    def s(self) -> Array:
        """Node positions (elements, degree + 1)."""
        edges = self.edges
        return edges[:-1, None] + np.diff(edges)[:, None] * self.rule.nodes


def rates(y: list[Any], s: Any, load: Any, membrane: Membrane, tense: Any, wet: Any) -> list[Any]:
    """Right-hand sides (r', z', l', b'), then the volume density r^2 z'/2 per 2 pi."""
    r, z, l1, b = y
    c2, eta = membrane.c2, membrane.eta(s)
    w1 = np.where(tense, mat.slope(l1, r, c2), wri.relaxed_slope(l1, c2))
    w2 = np.where(tense, mat.slope(r, l1, c2), 0.0)
    w11 = np.where(tense, mat.curvature(l1, r, c2), wri.relaxed_curvature(l1, c2))
    w12 = np.where(tense, mat.mixed(l1, r, c2), 0.0)
    sine, cosine = np.sin(b), np.cos(b)
    axial = l1 * cosine
    force = membrane.pressure(z, load, wet) * r * l1
    return [
        l1 * sine,
        axial,
        ((w2 - w12 * l1) * sine - membrane.eta_slope / eta * w1) / w11,
        (w2 * cosine - force / eta) / w1,
        r * r * axial / 2,
    ]


class Linearised:
    """Newton system at a state, reduced element by element to the element ends.

    Unknowns of the reduced system: four values at each element end, the inner breakpoints, the
    load.
    """

    def __init__(self, state: State, control: str) -> None:
        self.state, rule, zone = state, state.rule, state.zone
        k, m, self.inner = len(zone), rule.degree, len(state.pattern.kinds)
        size = np.array(state.counts)[zone]
        index = np.concatenate([np.arange(n) for n in state.counts])
        self.zone = zone
        breaks = np.array(state.pattern.breaks)
        tense = np.array(state.pattern.tense)[zone][:, None]
        wet = np.array(state.pattern.wet)[zone][:, None]
        at = list(np.moveaxis(rule.value @ state.y, -1, 0))
        share = (index[:, None] + rule.points) / size[:, None]

        def slopes(args: list[Any], low: Any, high: Any, load: Any) -> Any:
            h = ((high - low) / size)[:, None]
            f = rates(args, low[:, None] + (high - low)[:, None] * share, load, state.membrane, tense, wet)
            return np.stack(f, axis=-1) * h[..., None]

        low, high = breaks[zone], breaks[zone + 1]
        f = slopes(at, low, high, state.load)
        self.defect = rule.deriv @ state.y - f[..., :4]
        self.volume = float(np.sum(rule.weights[:, None] * f[..., 4:]))
        jac = np.empty((k, m, 5, 7))  # rate; derivative by r, z, l, b, low, high, load
        for j in range(7):
            bump = [1j * STEP if i == j else 0.0 for i in range(7)]
            args = [a + bump[i] for i, a in enumerate(at)]
            moved = slopes(args, low + bump[4], high + bump[5], state.load + bump[6])
            jac[..., j] = np.imag(moved) / STEP
        block = np.einsum("mn,ij->minj", rule.deriv, np.eye(4))[None] - np.einsum(
            "kmij,mn->kminj", jac[:, :, :4, :4], rule.value
        )
        self.block = block.reshape(k, 4 * m, 4 * (m + 1))
        self.sides = -jac[:, :, :4, 4:].reshape(k, 4 * m, 3)
        self.control = control
        row = np.einsum("m,kmj,mn->knj", rule.weights, jac[:, :, 4, :4], rule.value)
        self.row = row.reshape(k, -1)
        self.row_sides = np.einsum("m,kmj->kj", rule.weights, jac[:, :, 4, 4:])

    def columns(self, e: int) -> list[tuple[int, int]]:
        """Pairs (parameter column of element e's block, column of the reduced matrix)."""
        j, first = int(self.zone[e]), 4 * (len(self.zone) + 1)
        pairs = [(4, first + j - 1)] if j > 0 else []
        pairs += [(5, first + j)] if j < self.inner else []
        return [*pairs, (6, first + self.inner)]

    def reduced(self, x: Array, ends: Array, at: Array, scalar: float) -> tuple[Array, Array]:
        """Matrix and right-hand side for the element ends, the inner breakpoints and the load.

        Args:
            x: Each element's inner nodes by its left node (4), its parameters (3) and its defects.
            ends: For r(0), z(0), r(L), z(L).
            at: For the conditions at the inner breakpoints.
            scalar: For the load, or for the volume.
        """
        state, k = self.state, len(self.zone)
        first = 4 * (k + 1)  # index of the first inner breakpoint
        a, b = np.zeros((first + self.inner + 1,) * 2), np.zeros(first + self.inner + 1)
        for e in range(k):
            rows, left = slice(4 * e, 4 * e + 4), slice(4 * e, 4 * e + 4)
            a[rows, 4 * e + 4 : 4 * e + 8] = np.eye(4)
            a[rows, left], b[rows] = -x[e, -4:, :4], x[e, -4:, 7]
            for p, q in self.columns(e):
                a[rows, q] -= x[e, -4:, p]
            if self.control == "V":
                inside = self.row[e, 4:] @ x[e]
                a[-1, left] += self.row[e, :4] + inside[:4]
                for p, q in self.columns(e):
                    a[-1, q] += inside[p] + self.row_sides[e, p - 4]
                b[-1] -= inside[7]
        for i, place in enumerate((0, 1, 4 * k, 4 * k + 1)):
            a[4 * k + i, place], b[4 * k + i] = 1.0, ends[i]
        for i, kind in enumerate(state.pattern.kinds):
            node = 4 * int(np.sum(state.counts[: i + 1]))
            r, _, l1, _ = state.y[node // 4 - 1, -1]
            if kind == "front":
                a[first + i, node], a[first + i, node + 2] = 2 * r * l1, r * r
            else:
                a[first + i, node + 1], a[first + i, -1] = 1.0, -1.0
            b[first + i] = at[i]
        if self.control != "V":
            a[-1, -1] = 1.0
        b[-1] += scalar
        return a, b

    def solve(self, rhs: Array, ends: Array, at: Array, scalar: float) -> tuple[Array, Array, float]:
        """Solve for (dy, d breakpoints, d load); rhs at the Gauss points, (elements, degree, 4).

        The other right-hand sides are the same as in :meth:`reduced`.
        """
        k, m = len(self.zone), self.state.rule.degree
        right = [-self.block[:, :, :4], -self.sides, rhs.reshape(k, 4 * m, 1)]
        x = np.linalg.solve(self.block[:, :, 4:], np.concatenate(right, axis=2))
        out = np.linalg.solve(*self.reduced(x, ends, at, scalar))
        left, load = out[: 4 * (k + 1)].reshape(k + 1, 4), float(out[-1])
        moves = np.concatenate([[0.0], out[4 * (k + 1) : -1], [0.0]])
        sides = np.stack([moves[self.zone], moves[self.zone + 1], np.full(k, load)], axis=1)
        factors = np.concatenate([left[:-1], sides, np.ones((k, 1))], axis=1)
        rest = np.einsum("kij,kj->ki", x, factors).reshape(k, m, 4)
        return np.concatenate([left[:-1, None], rest], axis=1), moves[1:-1], load

    def conditions(self) -> tuple[Array, Array]:
        """Defects at the two ends and at the inner breakpoints, with the sign Newton needs."""
        state, y = self.state, self.state.y
        membrane = state.membrane
        ends = -np.array(
            [
                y[0, 0, 0] - membrane.radius,
                y[0, 0, 1],
                y[-1, -1, 0] - membrane.radius,
                y[-1, -1, 1] - membrane.delta * membrane.L,
            ]
        )
        at = np.empty(self.inner)
        for i, kind in enumerate(state.pattern.kinds):
            r, z, l1, _ = y[int(np.sum(state.counts[: i + 1])) - 1, -1]
            at[i] = 1 - r * r * l1 if kind == "front" else state.load - z
        return ends, at
