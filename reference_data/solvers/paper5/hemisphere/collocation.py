r"""The hanging hemisphere under liquid: collocation with fronts and level as unknown breakpoints.

Paper 5 of the thesis, section 3.3: neo-Hookean (c2 = 0), R = sin t, t in [0, pi/2] from the lowest
point, thickness 1, clamped at the equator, liquid up to the level zw < 0. Unknowns r, z, the
meridional stretch l and the angle b of the meridian with the axis, l2 = r/R,

.. math::
   r' = l \sin b,\quad z' = l \cos b,\quad R W_1 b' = W_2 \cos b - p r l,\quad
   R W_{11} l' = W_2 \sin b - R' W_1 - W_{12} (l \sin b - l_2 R'),

or, wrinkled, R W_r'' l' = -R' W_r' and W_2 = 0; r = 0 and b = pi/2 at the pole, r = 1 and z = 0 at
the equator, l2^2 l = 1 at a front, z = zw at the level, and either zw or the height of the pole given.
Polynomials of one degree in every element meet the equations at its Gauss points (never at the
pole, where the solution is smooth).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import GAMMA
from reference_data.solvers.paper4.methods.collocation import Pattern, Rule

Array = np.ndarray
STEP = 1e-30
KAPPA = 100 * GAMMA  # rho g Ao^2/(C1 h) with Ao = 0.1 m instead of 0.01 m
EQUATOR = np.pi / 2
C2 = 0.0
SHORTEST = 1e-9


@dataclass
class Hanging:
    """One equilibrium: values (elements, degree + 1, 4) of (r, z, l, b), the level, elements per zone."""

    rule: Rule
    pattern: Pattern
    y: Array
    zw: float
    shares: tuple[int, ...] = ()

    @property
    def zone(self) -> Array:
        """Zone of each element."""
        return np.repeat(np.arange(len(self.shares)), self.shares)

    @property
    def edges(self) -> Array:
        """Element boundaries."""
        b = self.pattern.breaks
        parts = [np.linspace(b[j], b[j + 1], n + 1)[:-1] for j, n in enumerate(self.shares)]
        return np.concatenate([*parts, b[-1:]])

    @property
    def t(self) -> Array:
        """Node positions (elements, degree + 1)."""
        edges = self.edges
        return edges[:-1, None] + np.diff(edges)[:, None] * self.rule.nodes

    @property
    def level(self) -> float:
        """Material angle of the level."""
        p = self.pattern
        return p.breaks[1 + p.kinds.index("surface")]

    @property
    def volume(self) -> float:
        """Volume per 2 pi, int r^2 z'/2 dt."""
        at = np.einsum("mn,knc->kmc", self.rule.value, self.y)
        r, _, l1, b = np.moveaxis(at, -1, 0)
        return float(np.sum(np.diff(self.edges)[:, None] * self.rule.weights * r**2 * l1 * np.cos(b) / 2))


def counts(pattern: Pattern, rule: Rule) -> tuple[int, ...]:
    """Elements per zone."""
    return tuple(int(np.ceil(w / rule.longest)) for w in np.diff(pattern.breaks))


def rates(y: list[Any], t: Any, zw: Any, tense: Any, wet: Any) -> list[Any]:
    """Right-hand sides (r', z', l', b')."""
    r, z, l1, b = y
    R, dR = np.sin(t), np.cos(t)
    l2 = r / R
    w1 = np.where(tense, mat.slope(l1, l2, C2), wri.relaxed_slope(l1, C2))
    w2 = np.where(tense, mat.slope(l2, l1, C2), 0.0)
    w11 = np.where(tense, mat.curvature(l1, l2, C2), wri.relaxed_curvature(l1, C2))
    w12 = np.where(tense, mat.mixed(l1, l2, C2), 0.0)
    sine, cosine = np.sin(b), np.cos(b)
    p = np.where(wet, KAPPA * (zw - z), 0.0)
    return [
        l1 * sine,
        l1 * cosine,
        (w2 * sine - dR * w1 - w12 * (l1 * sine - l2 * dR)) / (R * w11),
        (w2 * cosine - p * r * l1) / (R * w1),
    ]


def linearised(state: Hanging, control: str, target: float) -> tuple[Array, Array]:
    """Newton's matrix and minus the defects; unknowns: nodal values, inner breakpoints, zw."""
    rule, zone, k, m = state.rule, state.zone, len(state.zone), state.rule.degree
    size = np.array(state.shares)[zone]
    index = np.concatenate([np.arange(n) for n in state.shares])
    breaks, inner = np.array(state.pattern.breaks), len(state.pattern.kinds)
    tense = np.array(state.pattern.tense)[zone][:, None]
    wet = np.array(state.pattern.wet)[zone][:, None]
    at = list(np.moveaxis(np.einsum("mn,knc->kmc", rule.value, state.y), -1, 0))
    share = (index[:, None] + rule.points) / size[:, None]

    def slopes(args: list[Any], low: Any, high: Any, zw: Any) -> Any:
        h = ((high - low) / size)[:, None]
        f = rates(args, low[:, None] + (high - low)[:, None] * share, zw, tense, wet)
        return np.stack(f, axis=-1) * h[..., None]

    low, high = breaks[zone], breaks[zone + 1]
    nodes = 4 * (k * m + 1)
    first, total = nodes, nodes + inner + 1
    a, b = np.zeros((total, total)), np.zeros(total)
    defect = np.einsum("mn,knc->kmc", rule.deriv, state.y) - slopes(at, low, high, state.zw)
    b[: 4 * k * m] = -defect.ravel()
    jac = np.empty((k, m, 4, 7))
    for j in range(7):
        bump = [1j * STEP if i == j else 0.0 for i in range(7)]
        moved = slopes(
            [x + bump[i] for i, x in enumerate(at)], low + bump[4], high + bump[5], state.zw + bump[6]
        )
        jac[..., j] = np.imag(moved) / STEP
    block = np.einsum("mn,ij->minj", rule.deriv, np.eye(4))[None] - np.einsum(
        "kmij,mn->kminj", jac[..., :4], rule.value
    )
    for e in range(k):
        rows, j = slice(4 * m * e, 4 * m * (e + 1)), int(zone[e])
        a[rows, 4 * m * e : 4 * m * (e + 1) + 4] = block[e].reshape(4 * m, 4 * (m + 1))
        for column, p in ((j - 1, 4), (j, 5)):
            if 0 <= column < inner:
                a[rows, first + column] -= jac[e, :, :, p].ravel()
        a[rows, -1] -= jac[e, :, :, 6].ravel()
    bottom, top = state.y[0, 0], state.y[-1, -1]
    row = 4 * k * m
    ends = (
        (0, -bottom[0]),
        (3, EQUATOR - bottom[3]),
        (nodes - 4, 1 - top[0]),
        (nodes - 3, -top[1]),
    )
    for i, (place, value) in enumerate(ends):
        a[row + i, place], b[row + i] = 1.0, value
    for i, kind in enumerate(state.pattern.kinds):
        e, now = int(np.sum(state.shares[: i + 1])) - 1, row + 4 + i
        node, t = 4 * m * (e + 1), state.pattern.breaks[i + 1]
        r, z, l1, _ = state.y[e, -1]
        if kind == "front":
            a[now, node], a[now, node + 2], a[now, first + i] = 2 * r * l1, r * r, -np.sin(2 * t)
            b[now] = np.sin(t) ** 2 - r * r * l1
        else:
            a[now, node + 1], a[now, -1], b[now] = 1.0, -1.0, state.zw - z
    if control == "zw":
        a[-1, -1], b[-1] = 1.0, target - state.zw
    else:
        a[-1, 1], b[-1] = 1.0, target - bottom[1]
    return a, b


class VanishedZoneError(RuntimeError):
    """A zone shrank to nothing."""

    def __init__(self, zone: int) -> None:
        super().__init__(f"zone {zone} vanished")
        self.zone = zone


def newton(start: Hanging, control: str, target: float, max_iter: int = 40) -> Hanging:
    """Equilibrium at a level (control "zw") or a height of the pole ("z_pole"), zones' order fixed.

    Raises:
        VanishedZoneError: If a zone shrinks to nothing.
        RuntimeError: If the iteration does not converge.
    """
    state, small, m = start, 0, start.rule.degree
    for _ in range(max_iter):
        if small == 2:
            return state
        a, b = linearised(state, control, target)
        step = np.linalg.solve(a, b)
        inner = len(state.pattern.kinds)
        moves, values = step[len(step) - inner - 1 : -1], step[: len(step) - inner - 1].reshape(-1, 4)
        size = float(np.abs(step).max())
        if not np.isfinite(size):
            break
        widths = np.diff(state.pattern.breaks)
        change = np.diff(np.concatenate([[0.0], moves, [0.0]]))
        room = np.where(change < 0, 0.8 * widths / np.maximum(-change, 1e-300), np.inf)
        scale = min(1.0, 0.2 / size, float(room.min()))
        if widths.min() < SHORTEST and change[np.argmin(widths)] < 0 and room.min() < 1:
            raise VanishedZoneError(int(np.argmin(widths)))
        dy = np.stack([values[m * e : m * (e + 1) + 1] for e in range(len(state.y))])
        breaks = np.array(state.pattern.breaks[1:-1]) + scale * moves
        state = replace(
            state,
            pattern=state.pattern.moved(breaks),
            y=state.y + scale * dy,
            zw=state.zw + scale * float(step[-1]),
        )
        small = small + 1 if size < 1e-8 else 0
    raise RuntimeError(f"hemisphere: no convergence at {control} = {target:g}")
