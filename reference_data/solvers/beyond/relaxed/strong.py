r"""The wrinkled tube by collocation, with both fronts as unknowns (method a).

Zones lead from the mid-plane over the fronts z_1 < z_2 to the disk; z_2 = L if the wrinkles reach it. Taut
zones have the equations of paper 2 for y = (rho, eta, l1, b, v). Between the fronts the hoop stress is zero
and the tension r0 W', W(l) = w(l, l^{-1/2}), balances the pressure alone. Along the meridian the pressure has
no component, so that the tension is constant there, and with it l1:

.. math:: l_1' = 0, \qquad b' = -\frac{p \rho l_1}{r_0 W'(l_1)}

All of y is continuous at a front, where l1 l2^2 = 1. Against a substrate the zone before these is the patch,
up to z_f, where rho = s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from reference_data.solvers.core.collocation import Array, Ends, Mesh, Problem, joined
from reference_data.solvers.core.collocation import Zone as Part
from reference_data.solvers.core.mooney_rivlin import Tube, plain_pressure, slope
from reference_data.solvers.paper2.collocation import equations as taut
from reference_data.solvers.paper2.collocation import states as touching
from reference_data.solvers.paper2.collocation.critical import start
from reference_data.solvers.paper2.substrate import Substrate

MESHES = Mesh.graded(8, 10, 2.0), Mesh.graded(12, 12, 2.0)
SURELY_RISES, LOAD_STEP = 0.3, 0.05
"""Edge of the patch, over the length, up to which it is given: at high pressure it returns. From there on the
pressure is given, in steps of at most this."""
TO_TOUCH, SMALL = 10, 0.03
"""Steps to first contact of a wrinkled tube, and its first edge of the patch, over the length."""
PLACES = 2001
"""Places at which the first fronts are looked for."""


@dataclass(frozen=True)
class State:
    """One state; nodal values of each zone, and the numbers p, z_f in contact, z_1 and, inside, z_2."""

    tube: Tube
    mesh: Mesh
    y: tuple[Array, ...]
    c: Array
    substrate: Substrate | None = None

    @property
    def p(self) -> float:
        """Pressure."""
        return float(self.c[0])

    @property
    def volume(self) -> float:
        """Volume of the half tube per 2 pi."""
        return float(self.y[-1][-1, -1, 4])

    @property
    def u_max(self) -> float:
        """Radial displacement of the mid-plane."""
        return float(self.y[0][0, 0, 0]) - 1

    @property
    def fronts(self) -> tuple[float, ...]:
        """Z of the fronts on the pre-stretched tube, from the mid-plane."""
        return tuple(float(z) * self.tube.delta1 for z in self.c[1:])


def wrinkled(tube: Tube, y: list[Any], p: Any) -> list[Any]:
    """(rho', eta', l1', b', v') of a wrinkled zone."""
    rho, _, l1, b, _ = y
    # The derivative of w(l, l^(-1/2)) is w_1, because w_2 = 0 at that width.
    tension = tube.r0 * slope(l1, l1**-0.5, tube.alpha)
    return [
        l1 * np.sin(b),
        l1 * np.cos(b),
        0 * l1,
        -p * rho * l1 / tension,
        rho * rho * l1 * np.cos(b) / 2,
    ]


def problem(state: State, held: str, value: float) -> Problem:
    """The equations with ``p``, the displacement of the mid-plane ``u_max`` or the first front given."""
    tube, substrate, mesh = state.tube, state.substrate, state.mesh
    patch = 0 if substrate is None else 1
    base = taut.State(tube, (), (), np.zeros(1))

    def edges(c: list[Any]) -> list[Any]:
        return [0.0, *c[1:], tube.length]

    def rates(d: int, y: list[Any], _s: Array, c: list[Any]) -> list[Any]:
        length = edges(c)[d + 1] - edges(c)[d]
        if d == 1 + patch:
            found = wrinkled(tube, y, c[0])
        else:
            push = substrate.push if d < patch else plain_pressure
            found = taut.free(base, y, None, lambda rho: push(rho, c[0]))
        return [length * f for f in found]

    def conditions(left: Ends, right: Ends, c: list[Any]) -> list[Any]:
        first, disk = left[0], right[-1]
        ends = [first[1], first[3], first[4], disk[0] - 1, disk[1] - tube.lf / 2]
        at_edge = [y[0] - substrate.s for y in left[1 : 1 + patch]]
        at_fronts = [y[2] * (y[0] / tube.r0) ** 2 - 1 for y in left[1 + patch :]]
        given = {"u_max": first[0] - 1, "p": c[0], "front": c[1]}[held]
        return [*ends, *joined(left, right), *at_edge, *at_fronts, given - value]

    return Problem(tuple(Part(mesh, partial(rates, d)) for d in range(len(state.c))), conditions)


def solve(guess: State, value: float, held: str = "u_max") -> State:
    """The state with a displacement of the mid-plane, with a pressure, or with the first front.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    what = f"wrinkled {guess.tube} at {held} = {value}"
    y, c = problem(guess, held, value).solve(guess.y, guess.c, what)
    return replace(guess, y=y, c=c)


def first_in_contact(tube: Tube, substrate: Substrate, mesh: Mesh, p: float) -> State:
    """A state in contact not far beyond the first wrinkle, from the one that bears compression."""
    how = touching.RESOLUTIONS[0]
    begin = touching.touch(tube, substrate, how.free)
    reached = np.linspace(0.04, SURELY_RISES, 8) * tube.length
    ordinary = touching.frictionless_near_touch(begin, how, float(reached[0]))
    for z in reached:
        ordinary = touching.at_front(ordinary, float(z))
    for load in np.linspace(ordinary.p, p, 2 + int((p - ordinary.p) / LOAD_STEP))[1:]:
        ordinary = taut.solve(ordinary, p=float(load), rho=substrate.s)
    z = np.linspace(float(ordinary.fronts[0]), tube.length, PLACES)
    y = taut.profile(ordinary, z)
    compressed = z[y[:, 2] * (y[:, 0] / tube.r0) ** 2 < 1]
    fronts = [float(ordinary.fronts[0]), compressed[0], compressed[-1]]
    guess = [
        taut.profile(ordinary, np.ravel(low + (high - low) * mesh.x))[:, :5].reshape(*mesh.x.shape, 5)
        for low, high in pairwise([0.0, *fronts, tube.length])
    ]
    return solve(State(tube, mesh, tuple(guess), np.array([p, *fronts]), substrate), p, "p")


def touched(free: State, substrate: Substrate) -> State:
    """A state in contact with a small patch, from a free one that is wrinkled when it touches."""
    for u in np.linspace(free.u_max, substrate.s - 1, TO_TOUCH + 1)[1:]:
        free = solve(free, float(u))
    mesh, at = free.mesh, SMALL * free.tube.length
    share = at / float(free.c[1])
    middle = [mesh.evaluate(free.y[0], low + (high - low) * mesh.x) for low, high in ((0, share), (share, 1))]
    guess = State(free.tube, mesh, (*middle, *free.y[1:]), np.array([free.p, at, *free.c[1:]]), substrate)
    return solve(guess, at, "front")


def first(tube: Tube, mesh: Mesh, u_max: float) -> State:
    """A state not far beyond the first wrinkle, from the one that bears compression."""
    ordinary = start(tube, taut.Mesh.graded(12, 12, 2.0), "u_max", u_max)
    s = np.linspace(0, 1, PLACES)
    y = ordinary.zones[0].mesh.evaluate(ordinary.y[0], s)
    compressed = s[y[:, 2] * (y[:, 0] / tube.r0) ** 2 < 1]
    fronts = [compressed[0], compressed[-1]] if compressed[-1] < 1 else [compressed[0]]
    bounds = [0.0, *fronts, 1.0]
    guess = [
        ordinary.zones[0].mesh.evaluate(ordinary.y[0], low + (high - low) * mesh.x)
        for low, high in pairwise(bounds)
    ]
    c = np.array([ordinary.p, *(f * tube.length for f in fronts)])
    return solve(State(tube, mesh, tuple(guess), c), u_max)


def again(state: State, mesh: Mesh, held: str) -> State:
    """The same state on another mesh, with the displacement ``u_max`` or the pressure ``p`` given."""
    y = tuple(state.mesh.evaluate(part, mesh.x) for part in state.y)
    return solve(replace(state, mesh=mesh, y=y), {"u_max": state.u_max, "p": state.p}[held], held)
