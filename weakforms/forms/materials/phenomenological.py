r"""Laws in the invariants or in the principal stretches (sections 3.1.2, 3.1.4 and 3.1.5).

All are energies per reference volume of an incompressible material,
:math:`\lambda_3 = 1/(\lambda_1\lambda_2)`, over the stress in which their constants are given.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ufl import ln, sqrt
from ufl.core.expr import Expr


def first_invariant(lam1: Expr, lam2: Expr) -> Expr:
    r""":math:`I_1 - 3 = \lambda_1^2 + \lambda_2^2 + (\lambda_1\lambda_2)^{-2} - 3`."""
    return lam1**2 + lam2**2 + 1 / (lam1 * lam2) ** 2 - 3


def second_invariant(lam1: Expr, lam2: Expr) -> Expr:
    r""":math:`I_2 - 3 = \lambda_1^{-2} + \lambda_2^{-2} + (\lambda_1\lambda_2)^2 - 3`."""
    return 1 / lam1**2 + 1 / lam2**2 + (lam1 * lam2) ** 2 - 3


def neo_hookean(lam1: Expr, lam2: Expr) -> Expr:
    r"""Neo-Hookean energy per reference volume over ``C1``.

    .. math:: w = I_1 - 3 = \lambda_1^2 + \lambda_2^2 + (\lambda_1\lambda_2)^{-2} - 3
    """
    return first_invariant(lam1, lam2)


def mooney_rivlin(lam1: Expr, lam2: Expr, alpha: Expr) -> Expr:
    r"""Mooney-Rivlin energy per reference volume over ``C1``, with ``alpha = C2/C1``.

    .. math:: w = (I_1 - 3) + \alpha (I_2 - 3), \qquad
              I_2 = \lambda_1^{-2} + \lambda_2^{-2} + (\lambda_1\lambda_2)^2
    """
    return neo_hookean(lam1, lam2) + alpha * second_invariant(lam1, lam2)


def rivlin(lam1: Expr, lam2: Expr, coefficients: Iterable[tuple[int, int, Expr]]) -> Expr:
    r"""Rivlin's series, the general Mooney-Rivlin law.

    .. math:: w = \sum c_{ij} (I_1 - 3)^i (I_2 - 3)^j, \qquad c_{00} = 0

    Args:
        lam1: Principal stretch 1.
        lam2: Principal stretch 2.
        coefficients: ``(i, j, c_ij)`` of each term.
    """
    return series(first_invariant(lam1, lam2), second_invariant(lam1, lam2), coefficients)


def series(x: Expr, y: Expr, coefficients: Iterable[tuple[int, int, Expr]]) -> Expr:
    """The same energy as a function of ``x = I1 - 3`` and ``y = I2 - 3``."""
    return sum(c * x**i * y**j for i, j, c in coefficients)


def ogden(lam1: Expr, lam2: Expr, terms: Iterable[tuple[Expr, Expr]]) -> Expr:
    r"""Ogden's law.

    .. math:: w = \sum_i \frac{\mu_i}{\alpha_i}
              (\lambda_1^{\alpha_i} + \lambda_2^{\alpha_i} + \lambda_3^{\alpha_i} - 3),
              \qquad \sum_i \mu_i\alpha_i = 2\mu

    Args:
        lam1: Principal stretch 1.
        lam2: Principal stretch 2.
        terms: ``(mu_i, alpha_i)``.
    """
    lam3 = 1 / (lam1 * lam2)
    return sum(mu / a * (lam1**a + lam2**a + lam3**a - 3) for mu, a in terms)


def rivlin_saunders(lam1: Expr, lam2: Expr, c: Expr, f: Callable[[Expr], Expr]) -> Expr:
    r"""Rivlin & Saunders: a function of the second invariant measured in an experiment.

    .. math:: w = c (I_1 - 3) + f(I_2 - 3), \qquad f(0) = 0,\ f' \ge 0
    """
    return c * first_invariant(lam1, lam2) + f(second_invariant(lam1, lam2))


def falling_slope(slope: Expr, range_: Expr) -> Callable[[Expr], Expr]:
    r"""A function like the one that Rivlin and Saunders measured: its slope decreases as the invariant grows.

    .. math:: f(x) = c_{01}\, q \ln(1 + x/q), \qquad f'(x) = \frac{c_{01}}{1 + x/q}
    """
    return lambda x: slope * range_ * ln(1 + x / range_)


def beda_chevalier(lam1: Expr, lam2: Expr, k1: Expr, k2: Expr, k3: Expr, power: Expr) -> Expr:
    r"""Beda & Chevalier: Gent and Thomas's law at small strains, a term of Ogden's law at large strains.

    .. math:: w = K_1 (I_1 - 3) + K_2 \ln\frac{I_2}{3}
              + \frac{K_3}{\alpha}(\lambda_1^\alpha + \lambda_2^\alpha + \lambda_3^\alpha - 3)
    """
    gent_thomas = k1 * first_invariant(lam1, lam2) + k2 * ln(1 + second_invariant(lam1, lam2) / 3)
    return gent_thomas + ogden(lam1, lam2, [(k3, power)])


def gent(lam1: Expr, lam2: Expr, shear: Expr, jm: Expr) -> Expr:
    r"""Gent's law, of limited extensibility.

    .. math:: w = -\frac{\mu J_m}{2} \ln\Big(1 - \frac{I_1 - 3}{J_m}\Big)

    Not a number where :math:`I_1 - 3 \ge J_m`: there is no such deformation.
    """
    return limited(first_invariant(lam1, lam2), shear, jm)


def limited(x: Expr, shear: Expr, jm: Expr) -> Expr:
    """The same energy as a function of ``x = I1 - 3``; by the square root, not a number beyond ``jm``."""
    return -shear * jm * ln(sqrt(1 - x / jm))


def varga(lam1: Expr, lam2: Expr, shear: Expr) -> Expr:
    r"""Varga's law.

    .. math:: w = 2\mu (\lambda_1 + \lambda_2 + \lambda_3 - 3)
    """
    return 2 * shear * (lam1 + lam2 + 1 / (lam1 * lam2) - 3)
