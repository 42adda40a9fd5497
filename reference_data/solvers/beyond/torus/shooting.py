r"""Method (a) for the inflated torus: shooting along the meridian from the outer equator to the inner one.

The torus is ``R = 1 + b cos t``, ``Z = b sin t`` without stress; upper half, ``0 <= t <= pi``. With the
slope :math:`\varphi` of the deformed meridian, stretches :math:`l_1, l_2 = r/R` and the force
:math:`N = R\, w_{,1}` across a circle, per radian, forces along the tangent and the normal balance if

.. math:: r' = b l_1 \cos\varphi, \quad z' = b l_1 \sin\varphi, \quad N' = b\, w_{,2} \cos\varphi, \quad
          N \varphi' = b\,(p\, r\, l_1 - w_{,2} \sin\varphi)

N is replaced by l_1, whose slope follows from the law. Both equators are planes of symmetry.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from reference_data.solvers.core.mooney_rivlin import curvature, energy, mixed, slope
from reference_data.solvers.core.newton import Secants

Array = np.ndarray


@dataclass
class Shooting:
    """One torus: ratio of the radii, C2/C1 (or a law), and the relative tolerance of the integration."""

    b: float
    alpha: float
    tolerance: float
    _secants: Secants = field(default_factory=Secants)

    def slopes(self, t: float, y: Array, p: float) -> Array:
        """Derivatives in t of r, z, slope, l_1, volume, strain energy, and of the sum of ``w_i l_i``."""
        r, _z, phi, l1, *_ = y
        radius, radius_t = 1 + self.b * np.cos(t), -self.b * np.sin(t)
        l2 = r / radius
        w1, w2 = slope(l1, l2, self.alpha), slope(l2, l1, self.alpha)
        r_t, z_t = self.b * l1 * np.cos(phi), self.b * l1 * np.sin(phi)
        l2_t = (r_t - l2 * radius_t) / radius
        force_t = self.b * w2 * np.cos(phi)
        l1_t = ((force_t - radius_t * w1) / radius - mixed(l1, l2, self.alpha) * l2_t) / curvature(
            l1, l2, self.alpha
        )
        phi_t = self.b * (p * r * l1 - w2 * np.sin(phi)) / (radius * w1)
        area = 4 * np.pi * self.b * radius  # of both halves
        stored, shared = area * energy(l1, l2, self.alpha), area * (w1 * l1 + w2 * l2)
        return np.array([r_t, z_t, phi_t, l1_t, 2 * np.pi * r**2 * z_t, stored, shared])

    def _path(self, p: float, r: float, l1: float, at: Array | None = None) -> tuple[Array, Array]:
        """States at angles, else at all steps, to the inner equator; heights of horizontal tangents."""
        done = solve_ivp(
            self.slopes,
            (0.0, np.pi),
            [r, 0.0, np.pi / 2, l1, 0.0, 0.0, 0.0],
            method="DOP853",
            args=(p,),
            t_eval=at,
            rtol=self.tolerance,
            atol=self.tolerance,
            events=lambda _t, y, _p: np.sin(y[2]),
        )
        if not done.success:
            raise RuntimeError(f"torus at p = {p:g}: {done.message}")
        tops = [y[1] for y in done.y_events[0]]
        return done.y, np.array(tops)

    def state(self, volume: float, guess: Array) -> tuple[dict[str, float], Array]:
        """The state of a volume, and its ``(p, r, l_1)`` at the outer equator, from a guess of them."""

        def miss(x: Array) -> Array:
            end = self._path(*x)[0][:, -1]
            return np.array([end[1], end[2] - 1.5 * np.pi, end[4] - volume])

        found = self._secants.solve(miss, guess, f"torus at V = {volume:g}")
        path, tops = self._path(*found)
        end, (p, outer, _) = path[:, -1], found
        out = {"p": p, "r_out": outer, "r_in": end[0], "z_top": tops.max(), "U": end[5], "virial": end[6]}
        return {name: float(value) for name, value in out.items()}, found

    def meridian(self, found: Array, t: Array) -> dict[str, Array]:
        """Position and stretches at angles, of a state by its ``(p, r, l_1)`` at the outer equator."""
        r, z, _, l1, *_ = self._path(*found, at=t)[0]
        return {"r": r, "z": z, "lam1": l1, "lam2": r / (1 + self.b * np.cos(t))}
