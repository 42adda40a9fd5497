"""Polynomials of high degree as expressions."""

from __future__ import annotations

from collections.abc import Sequence

from ufl.core.expr import Expr


def newton_series(
    coefficients: Sequence[Expr], nodes: Sequence[float], x: Expr, span: Expr | float
) -> tuple[Expr, Expr]:
    r"""Value and derivative in ``x`` of a polynomial on ``[0, span]`` in Newton's form.

    .. math:: f(x) = c_0 + (t - t_0)\,\big(c_1 + (t - t_1)\,(c_2 + \dots)\big),
              \qquad t = 4 x/\mathrm{span} - 2

    Each bracket occurs once in the next one. The recurrence of Chebyshev polynomials would use two earlier
    terms each time; the number of paths through the expression would grow like the Fibonacci numbers, and
    forms with twenty terms could not be compiled.

    Args:
        coefficients: Divided differences ``c_m``.
        nodes: ``t_m`` in ``[-2, 2]``, an interval on which the coefficients neither grow nor decrease with
            ``m``; in Leja's order.
        x: Argument.
        span: Right end of the interval.
    """
    t = 4 * x / span - 2
    value, rate = coefficients[-1], 0
    for c, node in zip(reversed(coefficients[:-1]), reversed(nodes[:-1]), strict=True):
        rate = value + (t - node) * rate
        value = c + (t - node) * value
    return value, rate * (4 / span)
