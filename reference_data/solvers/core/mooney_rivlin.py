r"""Mooney-Rivlin membrane and the data of the pre-stretched tube, in non-dimensional form.

Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282, equations (2)-(4).
The energy per reference area over C1 h_o, with lambda3 = 1/(lambda1 lambda2), is

.. math:: w = l_1^2 + l_2^2 + (l_1 l_2)^{-2} - 3
              + \alpha\,[\,l_1^{-2} + l_2^{-2} + (l_1 l_2)^2 - 3\,].

Every function uses only +, -, * and /, so that it can be evaluated for real and complex
arrays (complex-step derivatives) and for truncated Taylor series alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Tube:
    """A pre-stretched tube; lengths over the disk radius R_f, p = P R_f/(C1 h_o).

    Attributes:
        alpha: C2/C1 (0 is neo-Hookean).
        delta1: Axial pre-stretch; the lateral one is 1/sqrt(delta1).
        lf: Distance of the two disks, L_f/R_f.
    """

    alpha: float
    delta1: Any
    lf: float

    @property
    def r0(self) -> Any:
        """Unstretched radius R_o/R_f = sqrt(delta1)."""
        return self.delta1**0.5

    @property
    def length(self) -> Any:
        """Unstretched length of the half tube, l_f/(2 delta1)."""
        return self.lf / (2 * self.delta1)


def energy(l1: Any, l2: Any, alpha: float) -> Any:
    """Strain energy w(l1, l2) over C1 h_o.

    Here and below ``alpha`` may be another law in place of C2/C1 (``material_laws``).
    """
    if not isinstance(alpha, float | int):
        return alpha.energy(l1, l2)
    a, b, c = l1 * l1, l2 * l2, l1 * l1 * l2 * l2
    return a + b + 1 / c - 3 + alpha * (1 / a + 1 / b + c - 3)


def slope(l1: Any, l2: Any, alpha: float) -> Any:
    """First derivative of w with respect to its first stretch.

    w is symmetric: ``slope(l2, l1, alpha)`` is the derivative with respect to the second.
    """
    if not isinstance(alpha, float | int):
        return alpha.slope(l1, l2)
    cube = l1 * l1 * l1
    return 2 * (l1 - 1 / (cube * l2 * l2)) + 2 * alpha * (l1 * l2 * l2 - 1 / cube)


def curvature(l1: Any, l2: Any, alpha: float) -> Any:
    """Second derivative of w with respect to its first stretch (second: swap arguments)."""
    if not isinstance(alpha, float | int):
        return alpha.curvature(l1, l2)
    fourth = l1 * l1 * l1 * l1
    return 2 + 6 / (fourth * l2 * l2) + 2 * alpha * (l2 * l2 + 3 / fourth)


def mixed(l1: Any, l2: Any, alpha: float) -> Any:
    """Mixed second derivative of w."""
    if not isinstance(alpha, float | int):
        return alpha.mixed(l1, l2)
    c = l1 * l2
    return 4 / (c * c * c) + 4 * alpha * c


def resultants(l1: Any, l2: Any, alpha: float) -> tuple[Any, Any]:
    """Cauchy stress resultants t1 = w_1/l2 and t2 = w_2/l1 (force per deformed length)."""
    return slope(l1, l2, alpha) / l2, slope(l2, l1, alpha) / l1


def plain_pressure(rho: Any, p: Any) -> Any:
    """Effective normal pressure of free inflation: P_eff(rho) = p.

    Both solvers accept a function of this signature. A deformable substrate, which acts as an additional
    normal pressure that depends on the radius, is another such function.
    """
    return p + 0 * rho
