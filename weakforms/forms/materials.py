"""Strain energies of incompressible membranes as functions of two principal stretches.

A law is one function ``w(lam1, lam2)``; stresses follow from it by differentiation.
"""

from __future__ import annotations

from ufl import diff, variable
from ufl.core.expr import Expr


def neo_hookean(lam1: Expr, lam2: Expr) -> Expr:
    r"""Neo-Hookean energy per reference volume over ``C1``.

    .. math:: w = I_1 - 3 = \lambda_1^2 + \lambda_2^2 + (\lambda_1\lambda_2)^{-2} - 3
    """
    return lam1**2 + lam2**2 + 1 / (lam1 * lam2) ** 2 - 3


def mooney_rivlin(lam1: Expr, lam2: Expr, alpha: Expr) -> Expr:
    r"""Mooney-Rivlin energy per reference volume over ``C1``, with ``alpha = C2/C1``.

    .. math:: w = (I_1 - 3) + \alpha (I_2 - 3), \qquad
              I_2 = \lambda_1^{-2} + \lambda_2^{-2} + (\lambda_1\lambda_2)^2
    """
    second = 1 / lam1**2 + 1 / lam2**2 + (lam1 * lam2) ** 2 - 3
    return neo_hookean(lam1, lam2) + alpha * second


def stress_resultants(law, lam1: Expr, lam2: Expr) -> tuple[Expr, Expr]:  # noqa: ANN001
    r"""Cauchy stress resultants, force per deformed length over ``C1 h_o``.

    .. math:: t_1 = w_{,1}/\lambda_2, \qquad t_2 = w_{,2}/\lambda_1

    Args:
        law: Energy ``w(lam1, lam2)``.
        lam1: Meridional stretch.
        lam2: Circumferential stretch.
    """
    l1, l2 = variable(lam1), variable(lam2)
    w = law(l1, l2)
    return diff(w, l1) / l2, diff(w, l2) / l1
