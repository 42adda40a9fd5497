"""Potentials of the loads on a membrane."""

from __future__ import annotations

from ufl import conditional
from ufl.conditional import Condition
from ufl.core.expr import Expr


def enclosed_volume(rho: Expr, eta_slope: Expr) -> Expr:
    r"""Volume inside a surface of revolution, per ``2 pi`` and meridional coordinate.

    .. math:: V/(2\pi) = \int \tfrac12 \rho^2 \eta' \,\mathrm{d}Z
    """
    return rho**2 * eta_slope / 2


def gas_potential(rho: Expr, eta_slope: Expr, p: Expr) -> Expr:
    """Potential of a gas with controlled pressure, per ``2 pi``: minus pressure times enclosed volume."""
    return -p * enclosed_volume(rho, eta_slope)


def substrate_potential(rho: Expr, eta_slope: Expr, k: Expr, s: Expr, in_contact: Expr) -> Expr:
    r"""Elastic foundation at radius ``s`` around the axis, per ``2 pi`` and meridional coordinate.

    .. math:: \int \tfrac k2\, \chi\, \rho\, (\rho - s)^2\, \eta' \,\mathrm{d}Z

    The weight is the *current* radius and height, so the foundation acts as a pressure
    ``-k [(rho - s) + (rho - s)^2/(2 rho)]`` normal to the deformed membrane (Patil, Nordmark & Eriksson 2014,
    equations 8 and 9).

    Args:
        rho: Deformed radius.
        eta_slope: Derivative of the deformed axial position.
        k: Stiffness ``K R_f^2/(C1 h_o)``.
        s: Radius of the substrate.
        in_contact: Indicator of contact, held fixed when the potential is differentiated.
    """
    return k * in_contact * rho * (rho - s) ** 2 * eta_slope / 2


def bed_potential(rho: Expr, rho_slope: Expr, gap: Expr, k: Expr, in_contact: Expr) -> Expr:
    r"""Bed of springs on a plane normal to the axis, per ``2 pi`` and meridional coordinate.

    .. math:: \int \tfrac k2\, \chi\, g^2 \rho\, \rho' \,\mathrm{d}x

    The weight is the *projected* area, so the springs act as a pressure ``-k g`` normal to the deformed
    membrane (Patil, DasGupta & Eriksson 2015, equation 9).

    Args:
        rho: Deformed radius.
        rho_slope: Its derivative.
        gap: Depth ``g`` beyond the plane; negative where the springs pull.
        k: Stiffness ``K R_f^2/(C1 h)``.
        in_contact: Indicator of contact, held fixed when the potential is differentiated.
    """
    return k * in_contact * gap**2 * rho * rho_slope / 2


def liquid_potential(rho: Expr, rho_slope: Expr, z: Expr, level: Expr, gamma: Expr, wet: Condition) -> Expr:
    r"""Liquid of a given level in a surface of revolution, per ``2 pi`` and meridional coordinate.

    .. math:: -\int \Phi(z)\, \rho\, \rho' \,\mathrm{d}S, \qquad
              \Phi = \tfrac12 \gamma \max(z_w - z, 0)^2

    Up to a constant (if the ends are fixed, or on the axis) this is
    :math:`-\int \gamma\max(z_w - z, 0)\,\tfrac12\rho^2 z'\,\mathrm{d}S`, by integration by parts. Its second
    derivative in ``z`` has only a step, so that no line term arises.

    Args:
        rho: Deformed radius.
        rho_slope: Its derivative along the meridian.
        z: Deformed height.
        level: Level ``z_w`` of the liquid.
        gamma: Specific weight.
        wet: Indicator of ``z < z_w``, held fixed when the potential is differentiated.
    """
    head = conditional(wet, gamma * (level - z) ** 2 / 2, 0.0)
    return -head * rho * rho_slope
