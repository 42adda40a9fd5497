r"""The state of a membrane of revolution near its pole, from which shooting starts.

With the unloaded radius :math:`R = s + \rho s^3` and the thickness :math:`H = H_0 (1 + \eta s^2)`,
equilibrium and the stretch of the meridian give, with errors O(s^4),

.. math::
   l_1 = \lambda + \alpha s^2,\quad l_2 = \lambda + \beta s^2,\quad b = \pi/2 - c s,\quad
   c = \frac{p \lambda^2}{2 H_0 W_1},\quad \alpha = 3 (\beta + \rho \lambda) + \tfrac12 \lambda c^2,

   (3 \rho + 2 \eta + \tfrac12 c^2) W_1 + (3 W_{11} - W_{12})\,\alpha + (3 W_{12} - W_{11})\,\beta = 0 .
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper4.material import Array, Body


@dataclass(frozen=True)
class Pole:
    """The series of a body there.

    Attributes:
        cubic: rho.
        thick: H_0.
        bulge: eta.
    """

    cubic: float
    thick: float = 1.0
    bulge: float = 0.0


def begin(body: Body, pole: Pole, given: Array, load: Any, s: float) -> Array:
    """(r, z, A, F) at a small s from the stretch and the height of the pole, which is taut."""
    lam, z0 = given[..., 0], given[..., 1]
    w = mat.slope(lam, lam, body.c2)
    w11, w12 = mat.curvature(lam, lam, body.c2), mat.mixed(lam, lam, body.c2)
    c = body.pressure(z0, load, True) * lam**2 / (2 * pole.thick * w)
    shift = lam * (3 * pole.cubic + c * c / 2)  # alpha = 3 beta + shift
    beta = -(w * (3 * pole.cubic + 2 * pole.bulge + c * c / 2) + (3 * w11 - w12) * shift) / (8 * w11)
    l1, l2 = lam + (3 * beta + shift) * s**2, lam + beta * s**2
    R, b = body.unloaded(s), np.pi / 2 - c * s
    tension = body.eta(s) * R * mat.slope(l1, l2, body.c2)
    height = z0 + lam * c * s**2 / 2
    return np.stack([R * l2, height, tension * np.sin(b), tension * np.cos(b)], axis=-1)
