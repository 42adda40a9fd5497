"""Potentials of the loads on a membrane."""

from __future__ import annotations

from ufl.core.expr import Expr


def enclosed_volume(rho: Expr, eta: Expr) -> Expr:
    r"""Volume inside a surface of revolution about the axis, per ``2 pi`` and per meridian coordinate.

    .. math:: V/(2\pi) = \int \tfrac12 \rho^2 \eta' \,\mathrm{d}Z
    """
    return rho**2 * eta.dx(0) / 2


def gas_potential(rho: Expr, eta: Expr, p: Expr) -> Expr:
    """Minus pressure times enclosed volume, per ``2 pi``: a gas whose pressure is controlled."""
    return -p * enclosed_volume(rho, eta)


def substrate_potential(rho: Expr, eta: Expr, k: Expr, s: Expr, in_contact: Expr) -> Expr:
    r"""Elastic foundation at radius ``s`` around the axis, per ``2 pi`` and per meridian coordinate.

    .. math:: \int \tfrac k2\, \chi\, \rho\, (\rho - s)^2\, \eta' \,\mathrm{d}Z

    The weight is the *current* radius and height, so the foundation acts as a pressure
    ``-k [(rho - s) + (rho - s)^2/(2 rho)]`` normal to the deformed membrane (Patil, Nordmark & Eriksson 2014,
    equations 8 and 9).

    Args:
        rho: Deformed radius.
        eta: Deformed axial position.
        k: Stiffness ``K R_f^2/(C1 h_o)``.
        s: Radius of the substrate.
        in_contact: Indicator of contact, held fixed when the potential is differentiated.
    """
    return k * in_contact * rho * (rho - s) ** 2 * eta.dx(0) / 2
