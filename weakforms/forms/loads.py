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
