r"""Method (b) for waves around the inflated torus: the second variation of its energy by polynomials.

Of the displacement :math:`\epsilon(u\cos n\theta\,e_r + q\sin n\theta\,e_\theta + w\cos n\theta\,e_z)` the
metric is, with :math:`c = \cos n\theta` and :math:`s = \sin n\theta`,

.. math:: g_{tt} = r'^2 + z'^2 + 2\epsilon c\,(r'u' + z'w') + \epsilon^2 [c^2(u'^2 + w'^2) + s^2 q'^2], \\
          g_{\theta\theta} = r^2 + 2\epsilon c\,r(u + nq)
          + \epsilon^2 [c^2 (u + nq)^2 + s^2 ((nu + q)^2 + n^2w^2)], \\
          g_{t\theta} = \epsilon s\,[r q' - r'(nu + q) - n z'w] + O(\epsilon^2)

and the energy is a function of its trace T and determinant D. The volume's second variation is
:math:`\frac12\int d\cdot(x_\theta\times d_t + d_\theta\times x_t)`. States are trigonometric polynomials
(:mod:`.fourier`), waves are polynomials on elements of the upper half.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from reference_data.solvers.beyond.torus.family import Family
from reference_data.solvers.beyond.torus.fourier import Series
from reference_data.solvers.beyond.tube_waves.ritz import Basis

Array = np.ndarray


@dataclass(frozen=True)
class Waves:
    """Second variations of the states of one torus.

    Attributes:
        series: The code of its states.
        basis: Trial functions.
    """

    series: Series
    basis: Basis

    def matrices(self, x: Array, n: int) -> tuple[Array, Array]:
        """Second variation (twice its mean in theta) and mass, without conditions at the ends."""
        points, weights, phi, dphi = self.basis.rule
        t, w, slope, b, p = np.pi * points, np.pi * weights, dphi / np.pi, self.series.b, x[-1]
        r, r_t, z_t = self.series.slopes(x, t)
        radius = 1 + b * np.cos(t)
        # Rows are points, columns are the functions of u, q and w, one after the other.
        u, q, v = (np.kron(unit, phi) for unit in np.eye(3)[:, None])
        u_t, q_t, v_t = (np.kron(unit, slope) for unit in np.eye(3)[:, None])

        def form(of: Array | float, one: Array, other: Array) -> Array:
            half = one.T @ ((w * of)[:, None] * other)
            return half + half.T

        def times(of: Array, rows: Array) -> Array:
            return of[:, None] * rows

        # Components of the metric over those without stress, their first-order changes, and T and D.
        g, h = (r_t**2 + z_t**2) / b**2, (r / radius) ** 2
        wider, turned = u + n * q, n * u + q
        g_1 = 2 / b**2 * (times(r_t, u_t) + times(z_t, v_t))
        h_1 = times(2 * r / radius**2, wider)
        sheared = times(1 / (b * radius), times(r, q_t) - times(r_t, turned) - n * times(z_t, v))
        trace, det, alpha = g + h, g * h, self.series.alpha
        by_t, by_d = 1 + alpha / det, -1 / det**2 + alpha * (1 - trace / det**2)
        by_td, by_dd = -alpha / det**2, 2 * (1 + alpha * trace) / det**3
        det_1 = times(h, g_1) + times(g, h_1)

        area = b * radius
        k = sum(form(area * (by_t + h * by_d) / b**2, d, d) for d in (u_t, q_t, v_t))
        k = k + sum(form(area * (by_t + g * by_d) / radius**2, d, d) for d in (wider, turned, n * v))
        k += form(area * by_d, g_1, h_1) - form(area * by_d, sheared, sheared)
        k += form(area * by_td, g_1 + h_1, det_1) + form(area * by_dd / 2, det_1, det_1)
        volume = form(r / 2, u, v_t) - form(r / 2, v, u_t)
        volume += form(z_t / 2, u, wider) + form(z_t / 2, q, turned)
        volume -= form(r_t / 2, n * v, q) + form(r_t / 2, v, wider)
        mass = sum(form(area / 2, d, d) for d in (u, q, v))
        return k - p * volume, mass

    def free(self, x: Array, family: Family) -> tuple[Array, Array]:
        """Both matrices on the degrees of freedom of a family."""
        k, m = self.matrices(x, family.n)
        size = len(self.basis.nodes)
        held = [i * size + at for i in family.zero for at in (0, size - 1)]
        held += [i * size for i in family.pinned]
        held += [i * size + at for i in family.everywhere for at in range(size)]
        keep = np.setdiff1d(np.arange(3 * size), held)
        part = np.ix_(keep, keep)
        return k[part], m[part]

    def eigenvalues(self, x: Array, family: Family, count: int) -> Array:
        """The lowest eigenvalues of a state."""
        return eigh(*self.free(x, family), eigvals_only=True, subset_by_index=(0, count - 1))
