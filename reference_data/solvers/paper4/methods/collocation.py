r"""Tracked membranes of revolution: collocation with fronts and the fluid's surface as unknown breakpoints.

The body has the unloaded radius R(s) and the thickness H(s). Unknowns over its meridian are the radius r, the
height z, the meridional stretch l, the slope angle b of the meridian with the axis and the volume v up to s.
With l2 = r/R,

.. math::
   r' = l \sin b,\quad z' = l \cos b,\quad v' = \tfrac12 r^2 z',\quad
   H R W_1\, b' = H W_2 \cos b - P r l,

   H R W_{11} l' = H W_2 \sin b - (H R)' W_1 - H W_{12} (l \sin b - l_2 R')

(the equilibrium equations of Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10, and paper 5,
section 3.3, solved for the highest derivatives), where the membrane is taut; where it is wrinkled
W_1 = W_r', W_11 = W_r'' and W_2 = W_12 = 0. The body says how its ends are held. Each zone is of one state
(taut or wrinkled, wet or dry), so that its equations are smooth; at a front l2^2 l = 1, at the surface z is
the level.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Array, Ends, Mesh, Problem, Zone, joined
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Body

SHORTEST = 1e-9  # a zone shorter than this has vanished
HELD = {
    "load": lambda left, right, c: c[0],
    "V": lambda left, right, c: right[-1][4],
    "z_pole": lambda left, right, c: left[0][1],
}
"""What may be given: load, enclosed volume per 2 pi, height of the lowest point."""


class VanishedZoneError(RuntimeError):
    """A zone shrank to nothing in Newton's iteration."""

    def __init__(self, zone: int) -> None:
        super().__init__(f"zone {zone} vanished")
        self.zone = zone


@dataclass(frozen=True)
class Rule:
    """Degree of the polynomials, and the largest length of an element."""

    degree: int
    longest: float


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
    def surface(self) -> float:
        """Position of the fluid's surface."""
        return self.breaks[1 + self.kinds.index("surface")]

    @property
    def signature(self) -> tuple[bool, ...]:
        """Taut or wrinkled from the bottom up, without the surface."""
        return tuple(t for i, t in enumerate(self.tense) if i == 0 or t != self.tense[i - 1])


@dataclass(frozen=True)
class State:
    """One equilibrium, or a guess: the load, and (r, z, l, b, v) at nodes (elements, degree + 1, 5)."""

    membrane: Body
    rule: Rule
    pattern: Pattern
    counts: tuple[int, ...]
    values: Array
    load: float

    @property
    def y(self) -> Array:
        """Nodal values of (r, z, l, b)."""
        return self.values[..., :4]

    @property
    def volume(self) -> float:
        """Enclosed volume per 2 pi."""
        return float(self.values[-1, -1, 4])

    @property
    def zone(self) -> Array:
        """Zone of each element."""
        return np.repeat(np.arange(len(self.counts)), self.counts)

    @cached_property
    def mesh(self) -> Mesh:
        """All elements, over s."""
        b = self.pattern.breaks
        parts = [np.linspace(b[j], b[j + 1], n + 1)[:-1] for j, n in enumerate(self.counts)]
        return Mesh(tuple(map(float, [*np.concatenate(parts), b[-1]])), self.rule.degree)

    @property
    def edges(self) -> Array:
        """Element boundaries."""
        return self.mesh.edges

    @property
    def s(self) -> Array:
        """Node positions (elements, degree + 1)."""
        return self.mesh.x

    @property
    def problem(self) -> Problem:
        """The equations of all zones; the body's conditions come with what is given."""
        meshes = [Mesh.graded(n, self.rule.degree) for n in self.counts]
        zones = (Zone(mesh, partial(self.rates, d)) for d, mesh in enumerate(meshes))
        return Problem(tuple(zones), self.conditions)

    def rates(self, d: int, y: list[Any], s: Array, c: list[Any]) -> list[Any]:
        """Right-hand sides over the fraction of zone d."""
        breaks, pattern = [0.0, *c[1:], self.membrane.L], self.pattern
        low, length = breaks[d], breaks[d + 1] - breaks[d]
        found = rates(y, low + length * s, c[0], self.membrane, pattern.tense[d], pattern.wet[d])
        return [length * f for f in found]

    def conditions(self, left: Ends, right: Ends, c: list[Any]) -> list[Any]:
        """How the ends are held, and what holds at fronts and surface."""
        out = [left[0][4], *self.membrane.clamped(left[0], right[-1]), *joined(left, right)]
        for kind, s, (r, z, l1, *_) in zip(self.pattern.kinds, c[1:], right, strict=False):
            out.append(r * r * l1 - self.membrane.unloaded(s) ** 2 if kind == "front" else z - c[0])
        return out

    def held(self, control: str, target: float) -> Problem:
        """The problem with one thing given, by its name in HELD."""
        return replace(
            self.problem,
            conditions=lambda *given: [*self.conditions(*given), HELD[control](*given) - target],
        )

    @property
    def c(self) -> Array:
        """The load and the inner breakpoints."""
        return np.array([self.load, *self.pattern.breaks[1:-1]])

    @property
    def parts(self) -> tuple[Array, ...]:
        """Nodal values by zone."""
        return tuple(np.split(self.values, np.cumsum(self.counts)[:-1]))

    def rate(self, control: str) -> float:
        """Derivative of the load by what is given, which is regular at a limit load."""
        return float(self.held(control, 0.0).linearised(self.parts, self.c).response()[1][0])


def rates(y: list[Any], s: Any, load: Any, body: Body, tense: bool, wet: bool) -> list[Any]:
    """(r', z', l', b', v')."""
    r, z, l1, b, _ = y
    R, H, (dR, dH) = body.unloaded(s), body.eta(s), body.slopes(s)
    l2, c2 = r / R, body.c2
    if tense:
        w1, w2 = mat.slope(l1, l2, c2), mat.slope(l2, l1, c2)
        w11, w12 = mat.curvature(l1, l2, c2), mat.mixed(l1, l2, c2)
    else:
        w1, w2, w11, w12 = wri.relaxed_slope(l1, c2), 0.0, wri.relaxed_curvature(l1, c2), 0.0
    sine, cosine = np.sin(b), np.cos(b)
    force = body.pressure(z, load, wet) * r * l1
    hoop = w2 * sine - w12 * (l1 * sine - l2 * dR)
    stretching = (hoop / R - (dR / R + dH / H) * w1) / w11
    return [l1 * sine, l1 * cosine, stretching, (w2 * cosine - force / H) / (R * w1), r * r * l1 * cosine / 2]


def newton(start: State, control: str, target: float) -> State:
    """Equilibrium with one thing given (see HELD), the zones' order fixed.

    Raises:
        VanishedZoneError: If a zone shrinks to nothing.
        RuntimeError: If the iteration does not converge.
    """

    def room(c: Array, dc: Array) -> float:
        widths = np.diff([0.0, *c[1:], start.membrane.L])
        change = np.diff([0.0, *dc[1:], 0.0])
        share = np.where(change < 0, 0.8 * widths / np.maximum(-change, 1e-300), np.inf)
        if widths.min() < SHORTEST and change[np.argmin(widths)] < 0 and share.min() < 1:
            raise VanishedZoneError(int(np.argmin(widths)))
        return float(share.min())

    what = f"collocation of {start.membrane} at {control} = {target:g}"
    problem = start.held(control, target)
    parts, c = problem.solve(start.parts, start.c, what, room, longest=start.membrane.longest)
    pattern = replace(start.pattern, breaks=(0.0, *map(float, c[1:]), start.membrane.L))
    return replace(start, pattern=pattern, values=np.concatenate(parts), load=float(c[0]))
