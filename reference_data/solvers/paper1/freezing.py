r"""The time-discrete scheme of adhesive inflation: raise the pole, let a ring touch, freeze it.

At each step of size Delta t the patch [0, x_j] is rigid and raised so that eta(0) = t0; the ring [x_j,
x_(j+1)] that touches in this step slides under the force of the springs, and the rest is free. Unknowns:
(rho', eta') or (l1, th) at x_j+, p and x_(j+1); conditions: the balance of the patch at x_j, eta(x_(j+1)) = l
and the rim. Then the ring is frozen too. For Delta t -> 0 this is the continuous history of
``disk_shooting_history`` and ``disk_collocation_history``; first order in Delta t.

Source: Patil, DasGupta & Eriksson (2015), the algorithm of section 3.2.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import joined
from reference_data.solvers.core.newton import Secants
from reference_data.solvers.paper1.collocation.equations import (
    Batch,
    Sliding,
    evaluate,
    integral,
    newton,
    spread,
)
from reference_data.solvers.paper1.collocation.states import (
    Resolution,
    at_rim,
    frictionless_at,
    sliding_contact,
)
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.shooting.equations import Accuracy, Array, pole, shoot
from reference_data.solvers.paper1.shooting.history import pull
from reference_data.solvers.paper1.shooting.states import Shot, touching


def first_a(onset: Shot, step: float, newton: Secants) -> tuple[float, Array]:
    """Frictionless contact at t0 = l + step: (p, state at the front with x first)."""
    disk, how, start = onset.disk, onset.how, touching(onset, step)
    first = how.start * disk.length

    def landed(lam: float, p: float, front: float) -> Array:
        y = [*pole(disk, lam, disk.l + step, p, first, True), 0.0]
        return shoot(disk, p, True, y, [first, front], how.rtol, moment=True)[-1]

    def miss(z: Array) -> Array:
        y = landed(*z)
        end = shoot(disk, z[1], False, y[:4], [z[2], disk.length], how.rtol)[-1]
        return np.array([y[1] - disk.l, end[0] - 1, end[1]])

    lam, p, front = (float(v) for v in newton.solve(miss, [start.lam, start.p, start.front]))
    return p, np.array([front, *landed(lam, p, front)])


def ring_a(
    disk: Disk,
    how: Accuracy,
    at: tuple[float, float, float, float],
    guess: Sequence[float],
    newton: Secants,
) -> tuple[float, float, Array]:
    """One step by shooting: (p, width of the ring, state and volume at its outer edge).

    ``at`` = (x_j, rho_j, eta(x_j), I_j); the unknowns are rho' and -eta' at x_j and the width.
    """
    x, rho, height, moment = at

    def landed(z: Array) -> tuple[float, Array]:
        springs = disk.k * ((height - disk.l) * rho**2 / 2 + moment)
        p = 2 * (springs - pull(disk, x, rho, z[0], z[1])) / rho**2
        return p, shoot(disk, p, True, [rho, height, z[0], -z[1], 0.0], [x, x + z[2]], how.rtol, moment=True)[
            -1
        ]

    def miss(z: Array) -> Array:
        p, y = landed(z)
        end = shoot(disk, p, False, y[:4], [x + z[2], disk.length], how.rtol)[-1]
        return np.array([y[1] - disk.l, end[0] - 1, end[1]])

    z = newton.solve(miss, guess)
    p, y = landed(z)
    return float(p), float(z[2]), y


def shooting(onset: Shot, top: float, count: int) -> float:
    """Pressure at t0 = top after ``count`` equal steps from t0 = l, by shooting."""
    disk, step, newton = onset.disk, (top - onset.disk.l) / count, Secants()
    p, (x, rho, _, slope, dip, moment) = first_a(onset, step, Secants())
    width = 0.8 * x
    for _ in range(1, count):
        # the edge was at eta = l and is raised with the pole
        at = (x, rho, disk.l + step, moment)
        p, width, y = ring_a(disk, onset.how, at, (slope, -dip, width), newton)
        x, moment = x + width, moment + float(y[4])
        rho, slope, dip = float(y[0]), float(y[2]), float(y[3])
    return p


def ring(disk: Disk, how: Resolution, at: tuple[float, float, float, float], guess: Batch) -> Batch:
    """One step: ``at`` = (x_j, rho_j, eta(x_j), I_j)."""
    x, rho, height, moment = at

    def conditions(left: Any, right: Any, scalars: Any) -> list[Any]:
        r, eta, l1, th = left[0]
        force = x * mat.slope(l1, r / x, disk.alpha) * np.sin(th)
        springs = disk.k * ((eta - disk.l) * rho**2 / 2 + moment)
        balance = (scalars[0] * rho**2 / 2 - springs - force) / x**2
        return [r - rho, eta - height, balance, *joined(left, right), left[1][1] - disk.l, *at_rim(right[1])]

    zones = (Sliding(disk, how.inner, True), Sliding(disk, how.outer))
    ends = lambda s: [(x + 0 * s[1], s[1]), (s[1], disk.length)]  # noqa: E731
    return newton(Batch(zones, guess.y, guess.scalars, ends, conditions))


def collocation(disk: Disk, how: Resolution, onset: Batch, top: float, count: int) -> float:
    """The same by collocation."""
    step = (top - disk.l) / count
    guess = frictionless_at(sliding_contact(disk, how, onset, step), onset.p)
    held = guess.conditions

    def at_height(left: Any, right: Any, scalars: Any) -> list[Any]:
        return [*held(left, right, scalars)[:-1], left[0][1] - disk.l - step]

    state = newton(Batch(guess.zones, guess.y, guess.scalars, guess.ends, at_height))
    moment, before = 0.0, 0.0
    for j in range(2, count + 1):
        moment += float(integral(state, 0, lambda y, _: y[0] ** 2 * y[2] * np.sin(y[3]) / 2)[0])
        x = float(state.scalars[0, 1])
        rho, _, _, _ = state.y[1][0, 0, 0]
        width, before = (0.8 * x if j == 2 else x - before), x
        y = []
        for mesh, ends in ((how.inner, (x, x + width)), (how.outer, (x + width, disk.length))):
            places = spread(*ends, mesh.x)[0]
            y.append(evaluate(state, 1, 0, places.ravel()).reshape(1, *places.shape, 4))
        y[0][..., 1] += step
        start = Batch(state.zones, tuple(y), np.array([[state.p[0], x + width]]), None, None)
        state = ring(disk, how, (x, float(rho), disk.l + step, moment), start)
    return float(state.p[0])
