r"""The wrinkled tube by shooting from the mid-plane across its fronts (method b).

The Lagrangian over the unstretched coordinate z is :math:`r_0 W(l_1, l_2) - \tfrac12 p \rho^2 \eta'`, W being
the relaxed energy. With the momenta m (of rho) and F (of eta, which is constant), the meridional tension is
:math:`N = |(m, F + \tfrac12 p \rho^2)| = r_0 W_1`. Hamilton's equations are

.. math:: \rho' = l_1 m/N,\quad \eta' = l_1 (F + \tfrac12 p \rho^2)/N,\quad m' = W_2 - p \rho \eta'

with l1 from N and rho. Against a substrate :math:`\tfrac12 p \rho^2` is replaced by its g(rho) where rho > s.
A point is wrinkled if the stretch l that has the tension N in uniaxial tension has
:math:`l\,(\rho/r_0)^2 < 1`. No front is an unknown: the integration stops where this quantity is 1, or rho is
s, and goes on with the other state. The radius at the mid-plane (against a substrate, p) is given; N there
and p (the radius) are such that the disk is met.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import Secants

TOLERANCES = 1e-10, 1e-13
"""Relative tolerances of the integration, coarse and fine."""
LEAST = 1e-11
"""Relative step of differences by numbers that a patch amplifies."""
MOST = 60
"""Largest number of Newton steps for a stretch."""


class Shot(NamedTuple):
    """One state."""

    p: float
    volume: float
    fronts: tuple[float, ...]
    """Z of the fronts on the pre-stretched tube, from the mid-plane."""
    tension: float
    """N at the mid-plane."""
    u_max: float


class Spring(NamedTuple):
    """The substrate: its stiffness and its radius. Without stiffness there is none."""

    k: float = 0.0
    s: float = np.inf

    def load(self, rho: float, p: float, acts: bool) -> tuple[float, float]:
        """g(rho) = p rho^2/2 - k rho (rho - s)^2/2, the last term where it acts, and its derivative."""
        if not acts:
            return p * rho**2 / 2, p * rho
        gap = rho - self.s
        return (p * rho - self.k * gap**2) * rho / 2, p * rho - self.k * gap * (gap / 2 + rho)


NONE = Spring()


class Law(NamedTuple):
    """Mooney-Rivlin law with invariants of the squared stretches; ``h = l2^2``."""

    alpha: float

    def tension(self, l1: float, h: float) -> tuple[float, float]:
        """dw/dl1 and its derivative."""
        a = self.alpha
        return (
            2 * l1 - 2 / (l1**3 * h) + a * (2 * l1 * h - 2 / l1**3),
            2 + 6 / (l1**4 * h) + a * (2 * h + 6 / l1**4),
        )

    def hoop(self, l1: float, h: float) -> float:
        """dw/dl2."""
        l2 = h**0.5
        return 2 * l2 - 2 / (l1**2 * h * l2) + self.alpha * (2 * l1**2 * l2 - 2 / (h * l2))

    def uniaxial(self, l1: float) -> tuple[float, float]:
        """d/dl of w(l, l^(-1/2)) = l^2 + 2/l - 3 + alpha (2 l + 1/l^2 - 3), and its derivative."""
        a = self.alpha
        return 2 * l1 - 2 / l1**2 + a * (2 - 2 / l1**3), 2 + 4 / l1**3 + 6 * a / l1**4

    def stretch(self, force: float, h: float | None, guess: float) -> float:
        """l1 with a tension at a hoop stretch or, without one, in uniaxial tension."""
        l1 = guess
        for _ in range(MOST):
            value, rate = self.uniaxial(l1) if h is None else self.tension(l1, h)
            step = max((value - force) / rate, -l1) if value < force else min((value - force) / rate, l1 / 2)
            l1 -= step
            if abs(step) < 4e-16 * l1:
                break
        return l1


def shoot(
    tube: Tube,
    u_max: float,
    tension: float,
    p: float,
    rtol: float,
    spring: Spring = NONE,
    offset: tuple[float, float] = (0.0, 0.0),
) -> tuple[Array, list[float]]:
    """Values (rho, eta, m, v) at the disk, and the z of the edge of contact and of the fronts.

    Without symmetry about the mid-plane ``offset`` has eta and m there, and ``tension`` is the axial one.
    """
    law, r0, rho0 = Law(tube.alpha), tube.r0, 1 + u_max
    taut, acts = True, rho0 > spring.s
    axial = tension - spring.load(rho0, p, acts)[0]

    def force(y: Array) -> float:
        return float(np.hypot(y[2], axial + spring.load(y[0], p, acts)[0]))

    def excess(_z: float, y: Array) -> float:
        return law.stretch(force(y) / r0, None, 1.5) * (y[0] / r0) ** 2 - 1

    def leaves(_z: float, y: Array) -> float:
        return y[0] - spring.s

    def rates(_z: float, y: Array) -> list[float]:
        n, h = force(y), (y[0] / r0) ** 2
        g, push = spring.load(y[0], p, acts)
        l1 = law.stretch(n / r0, h if taut else None, 1.5)
        up = l1 * (axial + g) / n
        hoop = law.hoop(l1, h) if taut else 0.0
        return [l1 * y[2] / n, up, hoop - push * up, y[0] ** 2 * up / 2]

    excess.terminal = leaves.terminal = True
    leaves.direction = -1
    z, y, fronts = 0.0, np.array([rho0, *offset, 0.0]), []
    while True:
        excess.direction = -1 if taut else 1
        events = [leaves] if acts else [excess]
        run = solve_ivp(rates, (z, tube.length), y, "DOP853", events=events, rtol=rtol, atol=1e-2 * rtol)
        y = run.y[:, -1]
        if run.status != 1:
            return y, fronts
        z = float(run.t[-1])
        acts, taut = False, taut if acts else not taut
        fronts.append(z)


def solve(
    tube: Tube,
    u_max: float,
    tension: float,
    p: float,
    rtol: float,
    spring: Spring = NONE,
    held: str = "u_max",
) -> Shot:
    """The state with a displacement of the mid-plane, or with a pressure.

    Args:
        tube: The tube.
        u_max: Displacement of the mid-plane, or a guess.
        tension: A guess of N there.
        p: The pressure, or a guess.
        rtol: Relative tolerance.
        spring: The substrate.
        held: Which of ``u_max`` and ``p`` is given.

    Raises:
        RuntimeError: If the disk is not met.
    """

    def both(x: Array) -> tuple[float, float, float]:
        u, pressure = (float(x[1]), p) if held == "p" else (u_max, float(x[1]))
        return u, float(x[0]), pressure

    def missed(x: Array) -> Array:
        end, _ = shoot(tube, *both(x), rtol, spring)
        return np.array([end[0] - 1, end[1] - tube.lf / 2])

    guess = [tension, u_max if held == "p" else p]
    x = Secants(offset=1e-6).solve(missed, guess, f"shooting of {tube} at u_max = {u_max}, p = {p}")
    u, n, found = both(x)
    end, fronts = shoot(tube, u, n, found, rtol, spring)
    seen = np.array([end[3], *(tube.delta1 * z for z in fronts)])
    if 1 + u > spring.s:
        seen += _rest(lambda x: shoot(tube, *both(x), rtol, spring), x, tube)
    return Shot(found, float(seen[0]), tuple(map(float, seen[1:])), n, u)


def _rest(run: Callable[[Array], tuple[Array, list[float]]], x: Array, tube: Tube) -> Array:
    """What volume and fronts change by, to first order, in a last step that is too small for the numbers x.

    The patch amplifies the rounding of x by 1e6: the disk is missed by that.
    """

    def all_of(x: Array) -> Array:
        end, fronts = run(x)
        return np.array([end[0] - 1, end[1] - tube.lf / 2, end[3], *(tube.delta1 * z for z in fronts)])

    at = all_of(x)
    rates = np.array([(all_of(x + d) - at) / d.sum() for d in np.diag(LEAST * x)]).T
    return -rates[2:] @ np.linalg.solve(rates[:2], at[:2])
