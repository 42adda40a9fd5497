r"""Lopsided states by collocation of the strong equations of paper 2 on the whole tube (method a).

Two zones lead from the middle to both disks, y = (rho, eta, l1, b, v) in each: radius, axial position,
meridional stretch, slope angle, and the volume counted from the middle. All of y but v is continuous at the
middle, v is zero there, and rho = 1, eta = -l_f/2 or l_f/2 at the disks. The pressure is unknown; the volume
or the axial position w of the middle is given. No symmetry enters.

With a thickness h = 1 + e s, s from -1 to 1 along the tube, the tangential balance (r_0 h w_1)' = h w_2 sin b
adds -(h'/h) w_1/w_11 to l1', and the pressure acts on h: p/h in place of p.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.collocation import Array, Ends, Linearised, Mesh, Problem
from reference_data.solvers.core.collocation import Zone as Part
from reference_data.solvers.core.mooney_rivlin import Tube, curvature, plain_pressure, slope
from reference_data.solvers.paper2.collocation import equations as symmetric
from reference_data.solvers.paper2.collocation.critical import start

MESHES = Mesh.graded(10, 12, 2.0), Mesh.graded(14, 14, 2.0)
MIRROR = np.array([1.0, -1.0, 1.0, -1.0, -1.0])
"""Signs of y under the mirror about the middle."""
SIDES = 1.0, -1.0
LONGEST = {"V": 0.06, "w": 0.03}
"""Longest steps between two guesses: of the volume, relative, and of w."""
SHORTEST = 1e-4
"""Shortest step that is tried."""


class Middle:
    """A state whose first zone begins at the middle, and whose first unknown constant is the pressure."""

    y: tuple[Array, ...]
    c: Array

    @property
    def p(self) -> float:
        """Pressure."""
        return float(self.c[0])

    @property
    def u_max(self) -> float:
        """Radial displacement of the middle."""
        return float(self.y[0][0, 0, 0]) - 1

    @property
    def w_mid(self) -> float:
        """Axial displacement of the middle."""
        return float(self.y[0][0, 0, 1])


@dataclass(frozen=True)
class State(Middle):
    """One state; nodal values of the upper and the lower half, and the pressure."""

    tube: Tube
    mesh: Mesh
    y: tuple[Array, Array]
    c: Array
    uneven: float = 0.0
    """``e`` of the thickness."""

    @property
    def volume(self) -> float:
        """Volume of the whole tube per 2 pi."""
        return float(self.y[0][-1, -1, 4] - self.y[1][-1, -1, 4])

    def meridian(self, z: Array) -> tuple[Array, Array]:
        """Rho and eta at places along the half length, from -1 to 1."""
        above, below = (self.mesh.evaluate(y, np.abs(z)) for y in self.y)
        found = np.where((z >= 0)[:, None], above, below)
        return found[:, 0], found[:, 1]


def problem(tube: Tube, mesh: Mesh, held: str, value: float, uneven: float = 0.0) -> Problem:
    """The equations, with the volume (V) or the axial position of the middle (w) given."""
    base = symmetric.State(tube, (), (), np.zeros(1))

    def rates(side: float, y: list[Any], s: Array, c: list[Any]) -> list[Any]:
        h = 1 + uneven * side * s
        found = symmetric.free(base, y, None, lambda rho: plain_pressure(rho, c[0]) / h)
        if uneven:
            l1, l2 = y[2], y[0] / tube.r0
            thinning = uneven / (tube.length * h)
            found[2] = found[2] - thinning * slope(l1, l2, tube.alpha) / curvature(l1, l2, tube.alpha)
        return [side * tube.length * f for f in found]

    def conditions(left: Ends, right: Ends, _c: list[Any]) -> list[Any]:
        (first, other), (upper, lower) = left, right
        joined = [a - b for a, b in zip(first[:4], other[:4], strict=True)]
        disks = [upper[0] - 1, upper[1] - tube.lf / 2, lower[0] - 1, lower[1] + tube.lf / 2]
        given = upper[4] - lower[4] if held == "V" else first[1]
        return [*joined, first[4], other[4], *disks, given - value]

    return Problem(tuple(Part(mesh, partial(rates, side)) for side in SIDES), conditions)


def solve(guess: State, held: str, value: float) -> State:
    """The state with a given volume or w.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    what = f"lopsided states of {guess.tube} by collocation"
    equations = problem(guess.tube, guess.mesh, held, value, guess.uneven)
    y, c = equations.solve(guess.y, guess.c, what, close=1e-7)
    return replace(guess, y=y, c=c)


def linearised(state: State, held: str) -> Linearised:
    """The equations about a state."""
    return problem(state.tube, state.mesh, held, 0.0, state.uneven).linearised(state.y, state.c)


def moved(state: State, held: str, step: float) -> State:
    """A state with another volume or w, to first order."""
    dy, dc = linearised(state, held).response()
    y = tuple(a + step * b for a, b in zip(state.y, dy, strict=True))
    return replace(state, y=y, c=state.c + step * dc)


def rate(state: State) -> float:
    """dp/dV along the branch."""
    return float(linearised(state, "V").response()[1][0])


def mirrored(half: symmetric.State) -> State:
    """A symmetric state as one of the whole tube."""
    return State(half.tube, half.zones[0].mesh, (half.y[0], half.y[0] * MIRROR), half.c)


def offset(state: State) -> list[Array]:
    """Change of a symmetric state by an offset of the middle at fixed pressure, with a jump of l1 there.

    At the crossing the jump is zero, and the change is the null vector.
    """
    system = linearised(state, "w")
    system.by_ends[2], system.by_ends[2, -1] = 0.0, 1.0  # the pressure stays; l1 need not be continuous
    unit = np.zeros_like(system.missed)
    unit[-1] = -1.0
    return system.solve([0 * d for d in system.defects], unit)[0]


def jump(state: State) -> float:
    """That jump."""
    above, below = offset(state)
    return float(above[0, 0, 2] - below[0, 0, 2])


def beside(tube: Tube, mesh: Mesh, between: tuple[float, float], w: float) -> State:
    """A state with a small w beside the crossing between two displacements of the symmetric branch."""
    half = [start(tube, mesh, "V", tube.lf / 4 * 1.1)]
    while half[0].u_max < between[0]:
        half[0] = symmetric.solve(half[0], V=1.04 * half[0].volume)

    def at(u: float) -> State:
        half[0] = symmetric.solve(half[0], u_max=u)
        return mirrored(half[0])

    crossing = at(brentq(lambda u: jump(at(u)), *between, xtol=1e-9))
    y = tuple(a + w * b for a, b in zip(crossing.y, offset(crossing), strict=True))
    return solve(replace(crossing, y=y), "w", w)


def follow(begin: State, values: Array, held: str) -> list[State]:
    """States at volumes, or at values of w, in turn, by steps that are halved if Newton's method fails."""
    state, out = begin, []
    at = begin.volume if held == "V" else begin.w_mid
    for value in map(float, values):
        step = LONGEST[held] * (at if held == "V" else 1.0)
        while at != value:
            to = value if abs(value - at) <= step else at + step * np.sign(value - at)
            try:
                state, at = solve(moved(state, held, to - at), held, to), to
            except RuntimeError:
                step = min(step, abs(value - at)) / 2
                if step < SHORTEST:
                    raise
        out.append(state)
    return out


def again(state: State, mesh: Mesh, held: str, value: float) -> State:
    """The state on another mesh."""
    y = tuple(mesh_values(state.mesh, mesh, part) for part in state.y)
    return solve(replace(state, mesh=mesh, y=y), held, value)


def mesh_values(old: Mesh, new: Mesh, y: Array) -> Array:
    """Nodal values on another mesh."""
    return old.evaluate(y, symmetric.places(new, 0.0, 1.0))


def rates_of(state: State) -> tuple[float, float]:
    """dp/dw and dV/dw along the branch."""
    (above, below), c = linearised(state, "w").response()
    return float(c[0]), float(above[-1, -1, 4] - below[-1, -1, 4])


def extremum(state: State, which: int, between: tuple[float, float]) -> State:
    """The state between two positions of the middle at which dp/dw (0) or dV/dw (1) is zero."""
    here = [follow(state, np.array([between[0]]), "w")[0]]

    def slope_at(w: float) -> float:
        here[0] = follow(here[0], np.array([w]), "w")[0]
        return rates_of(here[0])[which]

    return follow(here[0], np.array([brentq(slope_at, *between, xtol=1e-10)]), "w")[0]


def limit(state: State, between: tuple[float, float]) -> State:
    """The state between two volumes at which dp/dV = 0."""
    here = [follow(state, np.array([between[0]]), "V")[0]]

    def slope(volume: float) -> float:
        here[0] = follow(here[0], np.array([volume]), "V")[0]
        return rate(here[0])

    volume = brentq(slope, *between, xtol=1e-9)
    return follow(here[0], np.array([volume]), "V")[0]
