r"""The wrinkled tube by shooting from the mid-plane across its fronts (method b).

The Lagrangian over the unstretched coordinate z is :math:`r_0 W(l_1, l_2) - \tfrac12 p \rho^2 \eta'`, W being
the relaxed energy. With the momenta m (of rho) and F (of eta, which is constant), the meridional tension is
:math:`N = |(m, F + \tfrac12 p \rho^2)| = r_0 W_1`. Hamilton's equations are

.. math:: \rho' = l_1 m/N,\quad \eta' = l_1 (F + \tfrac12 p \rho^2)/N,\quad m' = W_2 - p \rho \eta'

with l1 from N and rho. Against a substrate :math:`\tfrac12 p \rho^2` is replaced by its g(rho) where rho > s;
the integration stops where rho is s, too. A point is wrinkled if the stretch l that has the tension N in uniaxial tension has
:math:`l\,(\rho/r_0)^2 < 1`. No front is an unknown: the integration stops where this quantity is 1 and goes
on with the other state. The radius at the mid-plane is given; N there and p are such that the disk is met.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import Secants

TOLERANCES = 1e-10, 1e-13
"""Relative tolerances of the integration, coarse and fine."""
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


def shoot(tube: Tube, u_max: float, tension: float, p: float, rtol: float) -> tuple[Array, list[float]]:
    """Values (rho, eta, m, v) at the disk, and the z of the fronts."""
    law, r0, rho0 = Law(tube.alpha), tube.r0, 1 + u_max
    axial = tension - p * rho0**2 / 2

    def force(y: Array) -> float:
        return float(np.hypot(y[2], axial + p * y[0] ** 2 / 2))

    def excess(_z: float, y: Array, _taut: bool) -> float:
        return law.stretch(force(y) / r0, None, 1.5) * (y[0] / r0) ** 2 - 1

    excess.terminal = True

    def rates(_z: float, y: Array, taut: bool) -> list[float]:
        n, h = force(y), (y[0] / r0) ** 2
        l1 = law.stretch(n / r0, h if taut else None, 1.5)
        up = l1 * (axial + p * y[0] ** 2 / 2) / n
        hoop = law.hoop(l1, h) if taut else 0.0
        return [l1 * y[2] / n, up, hoop - p * y[0] * up, y[0] ** 2 * up / 2]

    z, y, fronts, taut = 0.0, np.array([rho0, 0.0, 0.0, 0.0]), [], True
    while True:
        excess.direction = -1 if taut else 1
        run = solve_ivp(
            rates, (z, tube.length), y, "DOP853", events=excess, args=(taut,), rtol=rtol, atol=1e-2 * rtol
        )
        y = run.y[:, -1]
        if run.status != 1:
            return y, fronts
        z, taut = float(run.t[-1]), not taut
        fronts.append(z)


def solve(tube: Tube, u_max: float, tension: float, p: float, rtol: float) -> Shot:
    """The state with a displacement of the mid-plane, from guesses of its tension there and of its pressure.

    Raises:
        RuntimeError: If the disk is not met.
    """

    def missed(x: Array) -> Array:
        end, _ = shoot(tube, u_max, float(x[0]), float(x[1]), rtol)
        return np.array([end[0] - 1, end[1] - tube.lf / 2])

    n, found = Secants(offset=1e-6).solve(missed, [tension, p], f"shooting of {tube} at u_max = {u_max}")
    end, fronts = shoot(tube, u_max, float(n), float(found), rtol)
    places = tuple(f * tube.delta1 for f in fronts)
    return Shot(float(found), float(end[3]), places, float(n))
