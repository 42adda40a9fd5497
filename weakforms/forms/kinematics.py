"""Axisymmetric membrane kinematics: stretches of a surface of revolution."""

from __future__ import annotations

from dataclasses import dataclass

from ufl import sqrt
from ufl.core.expr import Expr


@dataclass(frozen=True)
class Stretches:
    """Principal stretches of an axisymmetric membrane and the meridian's slope."""

    lam1: Expr
    """Meridional stretch."""
    lam2: Expr
    """Circumferential stretch."""
    cos_beta: Expr
    """Axial component of the unit tangent of the deformed meridian."""
    sin_beta: Expr
    """Radial component of the unit tangent of the deformed meridian."""


def tube_stretches(rho: Expr, eta: Expr, delta1: Expr, jacobian: Expr | float = 1.0) -> Stretches:
    r"""Stretches of a cylinder stretched axially by ``delta1`` in uniaxial tension, then inflated.

    .. math:: \lambda_1 = \delta_1\sqrt{\rho_{,Z}^2 + \eta_{,Z}^2}, \qquad
              \lambda_2 = \rho/\sqrt{\delta_1}

    ``Z = delta1 z`` runs over the stretched length, ``z`` over the unstretched one; all lengths are
    divided by the disk radius ``R_f = R_o/sqrt(delta1)``, hence the reference radius
    ``r0 = sqrt(delta1)`` (Patil, Nordmark & Eriksson 2014, section 2).

    Args:
        rho: Deformed radius over ``Z``.
        eta: Deformed axial position over ``Z``.
        delta1: Axial pre-stretch.
        jacobian: ``dZ/dx``, if the coordinate ``x`` of the mesh is not ``Z``.
    """
    arc = sqrt(rho.dx(0) ** 2 + eta.dx(0) ** 2)
    return Stretches(
        lam1=delta1 * arc / jacobian,
        lam2=rho / sqrt(delta1),
        cos_beta=eta.dx(0) / arc,
        sin_beta=rho.dx(0) / arc,
    )


class Slope:
    """Represents a function that enters a form only by its derivative."""

    def __init__(self, slope: Expr) -> None:
        self._slope = slope

    def dx(self, _direction: int) -> Expr:
        """The derivative."""
        return self._slope


def disk_stretches(x: Expr, lam2: Expr, lam2_slope: Expr, eta_slope: Expr) -> Stretches:
    r"""Stretches of a flat disk deformed into a surface of revolution, with ``lam2`` as an unknown.

    .. math:: \rho = x\lambda_2, \qquad \rho' = \lambda_2 + x\lambda_2', \qquad
              \lambda_1 = \sqrt{\rho'^2 + \eta'^2}

    With the circumferential stretch instead of the radius, no division by ``x`` occurs, and the pole needs no
    special treatment (Patil, DasGupta & Eriksson 2015, section 2, use the same variable).

    Args:
        x: Radius in the unstretched disk.
        lam2: Circumferential stretch over ``x``.
        lam2_slope: Its derivative in ``x``.
        eta_slope: Derivative of the deformed height in ``x``.
    """
    radial = lam2 + x * lam2_slope
    lam1 = sqrt(radial**2 + eta_slope**2)
    return Stretches(lam1=lam1, lam2=lam2, cos_beta=-eta_slope / lam1, sin_beta=radial / lam1)
