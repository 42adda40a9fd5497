r"""Compressible laws of a sheet in plane stress, with the thickness stretch eliminated.

From a law in space, ``W(l1, l2, l3)``, the condition :math:`\partial W/\partial\lambda_3 = 0` gives
:math:`\lambda_3(\lambda_1, \lambda_2)`, and ``w(l1, l2) = W(l1, l2, l3(l1, l2))`` is the energy of the sheet
(section 3.2). The width in uniaxial tension is not :math:`\lambda_1^{-1/2}` but depends on the law.
"""

from __future__ import annotations

from ufl import max_value, sqrt
from ufl.core.expr import Expr

FLAT = 1e-6
"""Lower limit of the squared width, so that laws without a positive width stay finite."""


def saint_venant_kirchhoff(lam1: Expr, lam2: Expr, shear: Expr, poisson: Expr) -> Expr:
    r"""Saint Venant-Kirchhoff energy in plane stress (equation 3.12).

    .. math:: w = \frac{\lambda}{2}(\mathrm{tr} E)^2 + \mu\, \mathrm{tr} E^2, \qquad
              E_i = \tfrac12(\lambda_i^2 - 1), \qquad \lambda = \frac{2\mu\nu}{1 - \nu}

    with the 2 x 2 strain ``E`` of the sheet and the modified Lame constant of plane stress.
    """
    e1, e2 = (lam1**2 - 1) / 2, (lam2**2 - 1) / 2
    return shear * poisson / (1 - poisson) * (e1 + e2) ** 2 + shear * (e1**2 + e2**2)


def kirchhoff_width(lam1: Expr, poisson: Expr) -> Expr:
    r"""Width in uniaxial tension, :math:`\lambda_2^2 = 1 - \nu(\lambda_1^2 - 1)`."""
    return sqrt(max_value(1 - poisson * (lam1**2 - 1), FLAT))


def harmonic_in_space(lam1: Expr, lam2: Expr, lam3: Expr, shear: Expr, f2: Expr) -> Expr:
    r"""Harmonic material in space (equation 3.25) with a quadratic ``f``.

    .. math:: W = 2\mu\,[f(\lambda_1 + \lambda_2 + \lambda_3) - \lambda_1\lambda_2\lambda_3], \qquad
              f(i) = 1 + (i - 3) + \tfrac12 f_2 (i - 3)^2, \quad f_2 > \tfrac23

    ``f2 = (1 - nu)/(1 - 2 nu)`` in small strains.
    """
    more = lam1 + lam2 + lam3 - 3
    return 2 * shear * (1 + more + f2 * more**2 / 2 - lam1 * lam2 * lam3)


def harmonic_thickness(lam1: Expr, lam2: Expr, f2: Expr) -> Expr:
    r"""Thickness stretch without normal stress, :math:`f'(i) = \lambda_1\lambda_2`.

    .. math:: \lambda_3 = 3 + (\lambda_1\lambda_2 - 1)/f_2 - \lambda_1 - \lambda_2
    """
    return 3 + (lam1 * lam2 - 1) / f2 - lam1 - lam2


def harmonic(lam1: Expr, lam2: Expr, shear: Expr, f2: Expr) -> Expr:
    """Harmonic material with ``lam3`` eliminated; not a number where ``lam3`` is negative."""
    lam3 = sqrt(harmonic_thickness(lam1, lam2, f2)) ** 2
    return harmonic_in_space(lam1, lam2, lam3, shear, f2)


def harmonic_of_sum(total: Expr, area: Expr, shear: Expr, f2: Expr) -> Expr:
    """The same energy as a function of the sum and the product of the two stretches."""
    lam3 = sqrt(3 + (area - 1) / f2 - total) ** 2
    more = total + lam3 - 3
    return 2 * shear * (1 + more + f2 * more**2 / 2 - area * lam3)


def harmonic_width(lam1: Expr, f2: Expr) -> Expr:
    r"""Width in uniaxial tension, :math:`\lambda_2 = \lambda_3`; none beyond :math:`\lambda_1 = 3 - 1/f_2`.

    .. math:: \lambda_2 = \frac{3 - 1/f_2 - \lambda_1}{2 - \lambda_1/f_2}
    """
    return max_value(3 - 1 / f2 - lam1, FLAT) / max_value(2 - lam1 / f2, FLAT)
