r"""The soft substrate around the tube: its energy, its pressure and the forces on the patch.

Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282, equations (8), (9) and
(20)-(22). Lengths over R_f; k = K R_f^2/(C1 h_o), s = S/R_f. With g' = P_eff rho the potential
per 2 pi C1 h_o R_f^2 of the half tube of unstretched length L = l_f/(2 delta1) is

.. math::
   \int_0^L [\, r_0 w(\lambda_1, \lambda_2) - g(\rho)\, \eta' \,]\, dz, \qquad
   g = p \rho^2/2 - \chi\, k\, \rho\, (\rho - s)^2/2,

so that the substrate acts as an additional pressure normal to the deformed membrane,

.. math:: P_{eff} = p - \chi\, k\, [\, (\rho - s) + (\rho - s)^2/(2 \rho) \,].

chi is 1 where rho > s (inflation; unilateral spring) or on all of the acquired patch (deflation
with the bilateral spring of equation (9)).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube


@dataclass(frozen=True)
class Substrate:
    """Spring constant k and inner radius s, non-dimensional."""

    k: float
    s: float

    def push(self, rho: Any, p: Any) -> Any:
        """Effective pressure P_eff with the spring acting (chi = 1)."""
        gap = rho - self.s
        return p - self.k * (gap + gap * gap / (2 * rho))

    def potential(self, rho: Any, p: Any, acting: Any = True) -> Any:
        """g(rho), with or without the spring."""
        gap = rho - self.s
        return p * rho * rho / 2 - acting * self.k * rho * gap * gap / 2

    def radial(self, rho: Any, l1: Any, axial: Any) -> Any:
        """Spring density f_k = -k (eta'/lambda1) [(rho - s) + (rho - s)^2/(2 rho)]."""
        gap = rho - self.s
        return -self.k * axial / l1 * (gap + gap * gap / (2 * rho))


def forces(tube: Tube, rho: Any, l1: Any, slope: Any, axial: Any) -> tuple[Any, Any]:
    """Membrane force per 2 pi, radial and axial: r0 w_1 (rho', eta')/lambda1."""
    per = tube.r0 * mat.slope(l1, rho / tube.r0, tube.alpha) / l1
    return per * slope, per * axial


def turning(tube: Tube, rho: Any, l1: Any, cosine: Any, push: Any) -> Any:
    """Meridional curvature b'/lambda1 = (w_2 cos b - P_eff rho lambda1)/(r0 w_1 lambda1)."""
    l2 = rho / tube.r0
    w1, w2 = mat.slope(l1, l2, tube.alpha), mat.slope(l2, l1, tube.alpha)
    return (w2 * cosine - push * rho * l1) / (tube.r0 * w1 * l1)
