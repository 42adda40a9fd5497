"""Axisymmetric membrane kinematics: stretches of a surface of revolution, and of a flat twisted sheet."""

from __future__ import annotations

from dataclasses import dataclass

from ufl import as_matrix, sqrt
from ufl.core.expr import Expr


@dataclass(frozen=True)
class Stretches:
    """Principal stretches of an axisymmetric membrane and the direction of its meridian."""

    lam1: Expr
    """Meridional stretch."""
    lam2: Expr
    """Circumferential stretch."""
    cos_beta: Expr
    """Axial component of the unit tangent of the deformed meridian."""


def revolution_stretches(
    ratio: Expr, r_slope: Expr, z_slope: Expr, scales: tuple[Expr | float, Expr | float] = (1.0, 1.0)
) -> Stretches:
    r"""Stretches of a surface of revolution over the radius ``R(S)`` of its reference.

    .. math:: \lambda_1 = a\sqrt{r_{,S}^2 + z_{,S}^2}, \qquad \lambda_2 = b\,r/R

    The factors ``(a, b)`` are 1 if ``S`` is the length of the stress-free meridian and ``R`` its radius. They
    differ if both belong to a stretched surface: for a cylinder stretched by ``delta1`` in uniaxial tension
    they are ``delta1`` and ``1/sqrt(delta1)`` (Patil, Nordmark & Eriksson 2014, section 2). With ``r/R``
    instead of the radius as an unknown, no division by ``R`` occurs, and a pole needs no special treatment
    (Patil, DasGupta & Eriksson 2015, section 2, use the same variable).

    Args:
        ratio: ``r/R`` over ``S``.
        r_slope: Derivative of the deformed radius in ``S``.
        z_slope: Derivative of the deformed height in ``S``.
        scales: ``(a, b)``.
    """
    along, around = scales
    arc = sqrt(r_slope**2 + z_slope**2)
    return Stretches(lam1=along * arc, lam2=around * ratio, cos_beta=z_slope / arc)


def polar_metric(ratio: Expr, r: Expr, r_slope: Expr, turn_slope: Expr) -> Expr:
    r"""Right Cauchy-Green tensor, 2 x 2, of a flat sheet: ``r(R)``, ``theta = Theta + w(R)`` in its plane.

    .. math:: C_{11} = r_{,R}^2 + r^2 w_{,R}^2, \qquad C_{12} = r^2 w_{,R}/R, \qquad C_{22} = r^2/R^2

    Args:
        ratio: ``r/R``.
        r: Deformed radius.
        r_slope: Its derivative in ``R``.
        turn_slope: Derivative of the angle ``w``.
    """
    shear = r * turn_slope
    return as_matrix([[r_slope**2 + shear**2, ratio * shear], [ratio * shear, ratio**2]])
