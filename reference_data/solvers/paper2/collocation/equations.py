r"""The half tube, free or in contact, as a problem of piecewise collocation (method b).

Unknowns of a part that slides freely, over the unstretched axial coordinate z in [0, L], L = l_f/(2 delta1),
z = 0 at the mid-plane: radius rho, axial position eta, meridional stretch l1, slope angle b and the volume v
up to z, with sin b = rho'/l1, cos b = eta'/l1, l2 = rho/r0, r0 = sqrt(delta1):

.. math::
   \rho' = l_1 \sin b,\quad \eta' = l_1 \cos b,\quad
   l_1' = \sin b\,\frac{w_2 - l_1 w_{12}}{r_0 w_{11}},\quad
   b' = \frac{w_2 \cos b - P_{eff}(\rho)\, \rho\, l_1}{r_0 w_1},\quad v' = \tfrac12 \rho^2 \eta'

(the Euler-Lagrange equations solved for the highest derivatives). P_eff contains the spring where it acts. In
a stuck part eta(z) is given, eta' = e(z), and only the radial equation is left: with a = rho',
l1^2 = a^2 + e^2 and the radial force m = r0 w_1 a/l1 it is m' = w_2 - P_eff rho e, solved for a'.

Fronts z_1 < z_2 < ... cut the tube into zones. Between two of one kind everything is continuous,
between stuck and free rho, eta and the radial force are (a jump of the axial force is the line force). At
the mid-plane rho' = eta = 0, at the disk rho = 1, eta = l_f/2. Numbers common to all zones are p and the
fronts; as many things (see HELD) are given.
Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any, Protocol

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Array, Ends, Mesh, Problem
from reference_data.solvers.core.collocation import Zone as Part
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2.substrate import Substrate, forces

HELD = {
    "p": lambda left, right, c: c[0],
    "front": lambda left, right, c: c[-1],
    "u_max": lambda left, right, c: left[0][0] - 1,
    "V": lambda left, right, c: right[-1][-1],
    "rho": lambda left, right, c: right[0][0],
}
"""What may be given: pressure, last front, displacement of the mid-plane, volume, radius at first front."""


class History(Protocol):
    """Axial position frozen in the stuck zones, as functions of z (real or complex)."""

    def position(self, z: Any) -> Any:
        """Position eta."""

    def slope(self, z: Any) -> Any:
        """Slope eta'."""

    def bend(self, z: Any) -> Any:
        """Second derivative eta''."""


@dataclass(frozen=True)
class Zone:
    """A part of the tube between two fronts."""

    mesh: Mesh
    stuck: bool = False
    spring: bool = False


@dataclass(frozen=True)
class State:
    """One equilibrium, several side by side (a leading axis of y and c), or guesses.

    Attributes:
        tube: The membrane.
        zones: From the mid-plane to the disk.
        y: Nodal values per zone, shape (elements, degree + 1, 5 or, stuck, 3): (rho, eta, l1, b, v) or
            (rho, a, v).
        c: p, then the fronts.
        substrate: The spring, if there is one.
        history: Frozen position of the stuck zones.
    """

    tube: Tube
    zones: tuple[Zone, ...]
    y: tuple[Array, ...]
    c: Array
    substrate: Substrate | None = None
    history: History | None = None

    @property
    def p(self) -> float:
        """Pressure."""
        return float(self.c[0])

    @property
    def fronts(self) -> Array:
        """Front positions z_1, z_2, ..."""
        return self.c[1:]

    @property
    def u_max(self) -> float:
        """Displacement of the mid-plane."""
        return float(self.y[0][0, 0, 0]) - 1

    @property
    def volume(self) -> float:
        """Volume of the half tube per 2 pi."""
        return float(self.y[-1][-1, -1, -1])

    @property
    def bounds(self) -> list[tuple[Any, Any]]:
        """Left and right end of each zone."""
        return list(pairwise([0.0, *self.fronts, self.tube.length]))


def rates(state: State, d: int, y: list[Any], s: Array, c: list[Any]) -> list[Any]:
    """Right-hand sides over the fraction of zone d."""
    edges, zone = [0.0, *c[1:], state.tube.length], state.zones[d]
    left, length = edges[d], edges[d + 1] - edges[d]
    push = state.substrate.push if zone.spring else mat.plain_pressure
    found = (stuck if zone.stuck else free)(state, y, left + length * s, lambda rho: push(rho, c[0]))
    return [length * f for f in found]


def free(state: State, y: list[Any], _z: Any, push: Any) -> list[Any]:
    """(rho', eta', l1', b', v')."""
    tube, (rho, _, l1, b, _) = state.tube, y
    l2, r0 = rho / tube.r0, tube.r0
    w1, w2 = mat.slope(l1, l2, tube.alpha), mat.slope(l2, l1, tube.alpha)
    w11, w12 = mat.curvature(l1, l2, tube.alpha), mat.mixed(l1, l2, tube.alpha)
    s, c = np.sin(b), np.cos(b)
    turn = (w2 * c - push(rho) * rho * l1) / (r0 * w1)
    return [l1 * s, l1 * c, s * (w2 - l1 * w12) / (r0 * w11), turn, rho * rho * l1 * c / 2]


def stuck(state: State, y: list[Any], z: Any, push: Any) -> list[Any]:
    """(rho', a', v')."""
    tube, (rho, a, _) = state.tube, y
    e, bend = state.history.slope(z), state.history.bend(z)
    l1, l2 = np.sqrt(a * a + e * e), rho / tube.r0
    s, c, t = a / l1, e / l1, mat.slope(l1, l2, tube.alpha) / l1
    w11, w12 = mat.curvature(l1, l2, tube.alpha), mat.mixed(l1, l2, tube.alpha)
    force = mat.slope(l2, l1, tube.alpha) - push(rho) * rho * e
    change = w12 * s * a + tube.r0 * (w11 - t) * s * c * bend  # of m by rho and e
    return [a, (force - change) / (tube.r0 * (w11 * s * s + t * c * c)), rho * rho * e / 2]


def joint(state: State, d: int, left: list[Any], right: list[Any], z: Any) -> list[Any]:
    """Conditions between zones d and d + 1, given the values on both sides."""
    if state.zones[d].stuck == state.zones[d + 1].stuck:
        return [a - b for a, b in zip(left, right, strict=True)]
    rho, a, v = left
    e = state.history.slope(z)
    inner = forces(state.tube, rho, np.sqrt(a * a + e * e), a, e)[0]
    outer = forces(state.tube, right[0], right[2], right[2] * np.sin(right[3]), 0.0)[0]
    return [rho - right[0], state.history.position(z) - right[1], inner - outer, v - right[4]]


def problem(state: State, **held: Any) -> Problem:
    """The tube's problem with some things given, by their names in HELD."""

    def conditions(left: Ends, right: Ends, c: list[Any]) -> list[Any]:
        first, disk = left[0], right[-1]
        out = [first[1], first[2]] if state.zones[0].stuck else [first[1], first[3], first[4]]
        for d in range(len(state.zones) - 1):
            out += joint(state, d, right[d], left[d + 1], c[1 + d])
        out += [disk[0] - 1, disk[1] - state.tube.lf / 2]
        return out + [HELD[name](left, right, c) - value for name, value in held.items()]

    parts = (Part(z.mesh, partial(rates, state, d)) for d, z in enumerate(state.zones))
    return Problem(tuple(parts), conditions)


def solve(guess: State, **held: Any) -> State:
    """Equilibrium with some things given, by their names in HELD.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    given = ", ".join(f"{name} = {value}" for name, value in held.items())
    what = f"collocation of {guess.tube} at {given}"
    y, c = problem(guess, **held).solve(guess.y, guess.c, what, close=1e-7)
    return replace(guess, y=y, c=c)


def slope(state: State, control: str) -> float:
    """First derivative of p along the branch, as :func:`slopes` finds it, without the second one."""
    return float(_along(state, control).linearised(state.y, state.c).response()[1][0])


def slopes(state: State, control: str) -> tuple[float, float]:
    """First and second derivative of p along the branch, with respect to u_max or V.

    With Y(s) = Y0 + s Y1 + s^2 Y2 + ... the residual's Taylor coefficients of order 1 and 2 vanish: A Y1 =
    (0, 1), A Y2 = -(quadratic terms in Y1), A being the bordered matrix, which is regular at a limit point.
    """
    held = _along(state, control)
    system = held.linearised(state.y, state.c)
    dy, dc = system.response()
    return float(dc[0]), 2 * float(system.solve(*held.bent(state.y, state.c, dy, dc))[1][0])


def _along(state: State, control: str) -> Problem:
    return problem(state, **{control: state.u_max if control == "u_max" else state.volume})


def places(mesh: Mesh, left: Any, right: Any) -> Array:
    """Nodes of a mesh on [left, right], as z."""
    return left + (right - left) * mesh.x


def profile(state: State, z: Array, side: int = 1) -> Array:
    """Columns (rho, eta, l1, b, v, zone) at positions z; at a front the zone after (side 1) or before."""
    edges = np.array([0.0, *state.fronts, state.tube.length])
    where = np.clip(np.searchsorted(edges, z, side="right" if side > 0 else "left") - 1, 0, len(state.y) - 1)
    out = np.empty((len(z), 6))
    for d, zone in enumerate(state.zones):
        here = where == d
        if not here.any():
            continue
        x = (z[here] - edges[d]) / (edges[d + 1] - edges[d])
        values = zone.mesh.evaluate(state.y[d], x)
        if zone.stuck:
            e, eta = state.history.slope(z[here]), state.history.position(z[here])
            rho, a, v = values.T
            values = np.stack([rho, eta, np.hypot(a, e), np.arctan2(a, e), v], axis=-1)
        out[here, :5], out[here, 5] = values, d
    return out


def recut(state: State, zones: tuple[Zone, ...], fronts: Any) -> State:
    """Guess with other zones between other fronts, with the values of a state in between.

    A zone that becomes stuck has the history of the state.
    """
    y = []
    for zone, (left, right) in zip(zones, pairwise([0.0, *fronts, state.tube.length]), strict=True):
        z = places(zone.mesh, left, right)
        found = profile(state, np.ravel(z))
        keep = found[:, :5]
        if zone.stuck:
            keep = np.stack([found[:, 0], found[:, 2] * np.sin(found[:, 3]), found[:, 4]], axis=-1)
        y.append(keep.reshape(*z.shape, -1))
    return replace(state, zones=zones, y=tuple(y), c=np.array([state.p, *fronts]))


def columns(tube: Tube, values: Array) -> dict[str, Array]:
    """Profile columns of a table from (rho, eta, l1, ...)."""
    rho, eta, l1 = values[:, 0], values[:, 1], values[:, 2]
    l2 = rho / tube.r0
    t1, t2 = mat.resultants(l1, l2, tube.alpha)
    return {"rho": rho, "eta": eta, "lam1": l1, "lam2": l2, "t1": t1, "t2": t2}
