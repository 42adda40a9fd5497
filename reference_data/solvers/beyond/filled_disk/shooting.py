r"""Method (a) for a filled disk: shooting along the radius from the pole to the rim.

The disk has the radius 1 without stress and the thickness ``H = 1 + e R^2``; its rim is held at the radius
``delta`` and the height 0. With the slope :math:`\varphi` of the deformed meridian, the stretches :math:`l_1,
l_2 = r/R`, the force :math:`N = R H w_{,1}` across a circle, per radian, and a pressure ``P`` upwards, forces
along the tangent and the normal balance if

.. math:: r' = l_1 \cos\varphi, \quad z' = l_1 \sin\varphi, \quad N' = H w_{,2} \cos\varphi, \quad
          N \varphi' = -H w_{,2} \sin\varphi - P\, r\, l_1 .

Gas has a uniform pressure ``p``, a liquid on top :math:`P = -\gamma\,(z_w - z)`. N is replaced by l_1, whose
slope follows from the law.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from reference_data.solvers.core.mooney_rivlin import curvature, energy, mixed, slope
from reference_data.solvers.core.newton import Secants

Array = np.ndarray

POLE = 1e-4
"""Radius at which the integration starts, with the first terms of the series at the pole."""


@dataclass
class Shooting:
    """One disk: C2/C1, stretch of the rim, weight of the liquid (0: gas), ``e``, and relative tolerance."""

    alpha: float
    delta: float
    gamma: float
    uneven: float
    tolerance: float
    _secants: Secants = field(default_factory=Secants)

    def pressure(self, z: float, load: float) -> float:
        """Pressure upwards at a height."""
        return self.gamma * (z - load) if self.gamma else load

    def slopes(self, radius: float, y: Array, load: float) -> Array:
        """Derivatives in R of r, z, slope, l_1, amount and strain energy."""
        r, z, phi, l1, *_ = y
        thick, thick_r = 1 + self.uneven * radius**2, 2 * self.uneven * radius
        l2 = r / radius
        w1, w2 = slope(l1, l2, self.alpha), slope(l2, l1, self.alpha)
        r_r, z_r = l1 * np.cos(phi), l1 * np.sin(phi)
        l2_r = (r_r - l2) / radius
        spread = (thick * (w2 * np.cos(phi) - w1) / radius - thick_r * w1) / thick
        l1_r = (spread - mixed(l1, l2, self.alpha) * l2_r) / curvature(l1, l2, self.alpha)
        push = self.pressure(z, load)
        phi_r = -(thick * w2 * np.sin(phi) + push * r * l1) / (radius * thick * w1)
        depth = load - z if self.gamma else z
        amount, stored = depth * r * r_r, thick * energy(l1, l2, self.alpha) * radius
        return np.array([r_r, z_r, phi_r, l1_r, 2 * np.pi * amount, 2 * np.pi * stored])

    def state(self, height: float, guess: Array) -> tuple[dict[str, float], Array]:
        """The state of a height of the centre, down for a liquid, from a guess of l_1 there and the load."""
        pole = -height if self.gamma else height

        def path(x: Array) -> Array:
            l1, load = x
            turn = -self.pressure(pole, load) * l1**2 / (2 * slope(l1, l1, self.alpha))
            depth = load - pole if self.gamma else pole
            cap = np.pi * POLE**2 * np.array([depth * l1**2, energy(l1, l1, self.alpha)])
            start = [l1 * POLE, pole + l1 * turn * POLE**2 / 2, turn * POLE, l1, *cap]
            given = {"args": (load,), "rtol": self.tolerance, "atol": self.tolerance}
            done = solve_ivp(self.slopes, (POLE, 1.0), start, method="DOP853", **given)
            if not done.success:
                raise RuntimeError(f"disk at {height:g}: {done.message}")
            return done.y[:, -1]

        def miss(x: Array) -> Array:
            end = path(x)
            return np.array([end[0] - self.delta, end[1]])

        found = self._secants.solve(miss, guess, f"disk at w_c = {height:g}", stalled=1e-12)
        end = path(found)
        return {"load": float(found[1]), "amount": float(end[4]), "U": float(end[5])}, found
