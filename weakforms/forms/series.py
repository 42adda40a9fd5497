"""Chebyshev series as expressions."""

from __future__ import annotations

from collections.abc import Sequence

from ufl.core.expr import Expr


def chebyshev_series(coefficients: Sequence[Expr], x: Expr, span: Expr | float) -> tuple[Expr, Expr]:
    r"""Value and derivative in ``x`` of a Chebyshev series on ``[0, span]``.

    .. math:: f(x) = \sum_m a_m T_m(t), \qquad t = 2 x/\mathrm{span} - 1, \qquad T_m' = m\,U_{m-1}

    Args:
        coefficients: ``a_m``, two or more.
        x: Where.
        span: Right end.
    """
    t, slope = 2 * x / span - 1, 2 / span
    first, second = (1.0, t), (1.0, 2 * t)  # T_{m-1}, T_m and U_{m-1}, U_m
    value, rate = coefficients[0], 0
    for m in range(1, len(coefficients)):
        value = value + coefficients[m] * first[1]
        rate = rate + coefficients[m] * m * second[0]
        first = (first[1], 2 * t * first[1] - first[0])
        second = (second[1], 2 * t * second[1] - second[0])
    return value, rate * slope
