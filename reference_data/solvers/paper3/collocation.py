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

:func:`solve_on` solves any such problem with further components (perturbations, :mod:`paper3.canonical`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from reference_data.solvers.core.collocation import Array, Ends, Problem, Zone, joined
from reference_data.solvers.core.collocation import Mesh as Elements
from reference_data.solvers.paper3.data import FluidTube

BASE = 5  # components r, z, l1, psi, v


@dataclass(frozen=True)
class Mesh(Elements):
    """Elements of the wet region, 0 to 1, finer at the lower ring, and of the dry one, 1 to 2.

    Attributes:
        wet: Number of elements below the free surface.
    """

    wet: int

    @classmethod
    def filled(cls, wet: int, dry: int, degree: int, grading: float = 1.5) -> Mesh:
        """Breaks s^grading of the wet region and equal elements, or none, of the dry one."""
        low, high = np.linspace(0, 1, wet + 1) ** grading, 1 + np.linspace(0, 1, dry + 1)[1:]
        return cls(tuple(map(float, [*low, *high])), degree, wet)

    @property
    def dry(self) -> int:
        """Number of elements above the free surface; 0 when over-filled."""
        return self.elements - self.wet

    @property
    def dampness(self) -> Array:
        """1 for wet elements, 0 for dry ones, shape (elements, 1)."""
        return (np.arange(self.elements) < self.wet).astype(float)[:, None]

    @property
    def regions(self) -> list[Region]:
        """The wet region and, unless over-filled, the dry one."""
        low = Region(Elements(self.breaks[: self.wet + 1], self.degree), slice(0, self.wet), 1.0)
        high = tuple(x - 1 for x in self.breaks[self.wet :])
        return [low, Region(Elements(high, self.degree), slice(self.wet, None), 0.0)] if self.dry else [low]

    def lengths(self, tube: FluidTube, front: float) -> Array:
        """Material length of the region of each element, shape (elements, 1)."""
        return self.dampness * front + (1 - self.dampness) * (tube.length - front)

    def position(self, tube: FluidTube, front: float) -> Array:
        """Material coordinate Z of every node."""
        return np.where(self.x <= 1, self.x * front, front + (self.x - 1) * (tube.length - front))


@dataclass(frozen=True)
class Region:
    """Elements below or above the free surface, and which of all elements they are."""

    mesh: Elements
    at: slice
    wet: float

    def length(self, tube: FluidTube, front: Any) -> Any:
        """Material length."""
        return front if self.wet else tube.length - front


Rates = Callable[[list[Any], list[Any], Region], list[Any]]


def solve_on(
    mesh: Mesh, rates: Rates, conditions: Callable[..., list[Any]], y: Array, c: Array, what: str
) -> tuple[Array, Array]:
    """Nodal values and numbers with dy/ds = rates(y, c, region) in each region.

    Args:
        mesh: Elements.
        rates: Derivatives with respect to the fraction of the region.
        conditions: On the values at start, front and end, and c, besides continuity at the front.
        y: Guess, shape (elements, degree + 1, components).
        c: Guess of the numbers.
        what: What is sought, for the message.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """

    def every(left: Ends, right: Ends, c: list[Any]) -> list[Any]:
        return [*conditions(left[0], right[0], right[-1], c), *joined(left, right)]

    zones = (Zone(r.mesh, lambda y, _s, c, r=r: rates(y, c, r)) for r in mesh.regions)
    problem = Problem(tuple(zones), every)
    parts = tuple(y[r.at] for r in mesh.regions)
    parts, c = problem.solve(parts, c, f"collocation of {what}", longest=0.5, close=1e-7, most=30)
    return np.concatenate(parts), c


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


def base_rates(y: list[Any], zw: Any, front: Any, tube: FluidTube, region: Region) -> list[Any]:
    """Derivatives of (r, z, l1, psi, v) with respect to s."""
    r, z, l1, psi = y[:4]
    c, s, wet = np.cos(psi), np.sin(psi), region.wet
    sq, rr = l1 * l1, r * r
    s1, s2 = tensions(l1, r, tube.law)
    if tube.law is None:
        stretch = c * (r - 3 / (sq * rr * r)) / (1 + 3 / (sq * sq * rr))
    else:
        stretch = c * (2 * s2 - tube.law.mixed(l1, r) * l1) / tube.law.curvature(l1, r)
    load = tube.gamma * (zw - z) * wet
    h = region.length(tube, front)
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
        s = z_material / self.front
        if self.partial:
            beyond = (z_material - self.front) / (self.tube.length - self.front)
            s = np.where(s <= 1, s, 1 + beyond)
        return self.mesh.evaluate(y, s)

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

    def rates(y: list[Any], c: list[Any], region: Region) -> list[Any]:
        return base_rates(y, c[0], c[1] if partial else tube.length, tube, region)

    def conditions(start: list[Any], front: list[Any], end: list[Any], c: list[Any]) -> list[Any]:
        return base_conditions(start, front, end, c[0], volume, tube, partial)

    c = np.array([guess.zw, guess.front] if partial else [guess.zw])
    y, c = solve_on(mesh, rates, conditions, guess.y, c, f"{tube} at V = {volume:g}")
    return State(tube, mesh, y, float(c[0]), float(c[1]) if partial else tube.length)
