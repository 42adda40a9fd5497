r"""Method (a) for waves around the inflated torus: the linearised balance of forces, by shooting.

Per angle and per t, the forces :math:`T_1 = R(P_{11} m + P_{21} e_\theta + P_{31} k)` and
:math:`T_2 = b(P_{12} m + P_{22} e_\theta + P_{32} k)` of a membrane in space balance if

.. math:: T_{1,t} + T_{2,\theta} + p\, x_\theta\times x_t + \Lambda b R\, d = 0

with the tangent ``m`` of the meridian and the normal ``k``. Forces follow from the gradient of the
displacement by the second derivatives of the law at the principal stretches,

.. math:: \dot P_{11} = w_{11} \dot F_{11} + w_{12} \dot F_{22}, \quad
          \dot P_{21} = A \dot F_{21} + B \dot F_{12}, \quad \dot P_{31} = \frac{w_1}{l_1} \dot F_{31}, \quad
          A = \frac{l_1 w_1 - l_2 w_2}{l_1^2 - l_2^2}, \quad B = \frac{l_2 w_1 - l_1 w_2}{l_1^2 - l_2^2}

Displacement and force across a circle are integrated with the state, from three beginnings at the outer
equator. A family has an eigenvalue where the determinant of what must vanish at the inner one is zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from reference_data.solvers.beyond.torus.family import Family
from reference_data.solvers.beyond.torus.shooting import Shooting
from reference_data.solvers.core.mooney_rivlin import curvature, mixed, slope
from reference_data.solvers.core.newton import Secants

Array = np.ndarray
OWN = 7
"""Unknowns of the states."""


@dataclass(frozen=True)
class Jacobi:
    """Waves of one family around one torus.

    Attributes:
        states: The code of its states.
        family: Which waves.
    """

    states: Shooting
    family: Family

    def _slopes(self, t: float, flat: Array, p: float, shift: float) -> Array:
        """Derivatives of a state, and of displacements and forces (columns) for an eigenvalue."""
        b, alpha, n = self.states.b, self.states.alpha, self.family.n
        own = self.states.slopes(t, flat[:OWN], p)
        r, _, phi, l1 = flat[:4]
        (u, q, v), (f_r, f_th, f_z) = flat[OWN:].reshape(2, 3, -1)
        cos, sin, radius = np.cos(phi), np.sin(phi), 1 + b * np.cos(t)
        l2, square = r / radius, l1 * r / radius
        w1, w2 = slope(l1, l2, alpha), slope(l2, l1, alpha)
        w11, w12, w22 = curvature(l1, l2, alpha), mixed(l1, l2, alpha), curvature(l2, l1, alpha)
        across = 2 + 2 * alpha / square**2  # A and B of a Mooney-Rivlin law, without quotients
        along = 2 / square**3 + 2 * alpha * ((l1**2 + l2**2) / square**3 - square)
        # Gradient of the displacement: what turns around the axis is known, the rest follows from forces.
        f22 = (u + n * q) / radius
        f12 = (-(n * u + q) * cos - n * v * sin) / radius
        f32 = (-(n * u + q) * sin + n * v * cos) / radius
        f11 = ((f_r * cos + f_z * sin) / radius - w12 * f22) / w11
        f31 = (f_r * sin - f_z * cos) / radius * l1 / w1
        f21 = (f_th / radius - along * f12) / across
        u_t, v_t = b * (f11 * cos + f31 * sin), b * (f11 * sin - f31 * cos)
        p12, p22, p32 = along * f21 + across * f12, w12 * f11 + w22 * f22, w2 / l2 * f32
        t_r, t_th, t_z = b * (p12 * cos + p32 * sin), b * p22, b * (p12 * sin - p32 * cos)
        r_t, z_t, weight = own[0], own[1], shift * b * radius
        balance = (
            n * t_r - t_th + p * ((u + n * q) * z_t + r * v_t) + weight * u,
            t_r - n * t_th + p * ((n * u + q) * z_t - n * v * r_t) + weight * q,
            n * t_z - p * ((u + n * q) * r_t + r * u_t) + weight * v,
        )
        waves = np.array([u_t, b * f21, v_t, *(-part for part in balance)])
        return np.concatenate([own, waves.ravel()])

    def path(self, found: Array, shift: float = 0.0) -> tuple[Array, float]:
        """A state at the inner equator, and the determinant there, of ``(p, r, l_1)`` at the outer one."""
        kept = [i for i in range(3) if i not in self.family.everywhere]
        held = (*self.family.zero, *self.family.pinned)
        begin = np.eye(6)[:, [3 + i if i in held else i for i in kept]]
        p, r, l1 = found
        start = np.concatenate([[r, 0.0, np.pi / 2, l1, 0.0, 0.0, 0.0], begin.ravel()])
        done = solve_ivp(
            self._slopes,
            (0.0, np.pi),
            start,
            method="DOP853",
            args=(p, shift),
            rtol=self.states.tolerance,
            atol=self.states.tolerance,
        )
        if not done.success:
            raise RuntimeError(f"waves of a torus at p = {p:g}: {done.message}")
        end = done.y[:, -1]
        missed = end[OWN:].reshape(6, -1)[[i if i in self.family.zero else 3 + i for i in kept]]
        return end[:OWN], float(np.linalg.det(missed))

    def eigenvalue(self, found: Array, near: float, reach: float) -> float:
        """The eigenvalue of a state within a distance of a number.

        Raises:
            ValueError: If the determinant does not change its sign there.
        """
        return brentq(lambda shift: self.path(found, shift)[1], near - reach, near + reach, xtol=1e-13)

    def neutral(self, guess: Array, size: float) -> tuple[dict[str, float], Array]:
        """The state with the eigenvalue 0, from a guess of its ``(p, r, l_1)``.

        Args:
            guess: The guess.
            size: Size of the determinant, by which it is divided.
        """

        def miss(x: Array) -> Array:
            end, determinant = self.path(x)
            return np.array([end[1], end[2] - 1.5 * np.pi, determinant / size])

        found = Secants().solve(miss, guess, f"neutral torus, {self.family}")
        end, _ = self.path(found)
        return {"V": float(end[4]), "p": float(found[0]), "r_out": float(found[1])}, found
