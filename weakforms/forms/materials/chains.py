r"""Networks of chains of limited extensibility, and the inverse Langevin function (section 3.1.3).

The Langevin function is :math:`\mathcal{L}(y) = \coth y - 1/y`. Its inverse has no closed form, but the
energy of a chain is a Legendre transform,

.. math:: \epsilon(x) = \max_y \Big( x y - \ln\frac{\sinh y}{y} \Big), \qquad
          \epsilon'(x) = \mathcal{L}^{-1}(x)

so that a ``y`` with a relative error of :math:`\delta` gives :math:`\epsilon` and its derivatives with one of
the order :math:`\delta^2`. Here ``y`` is a rational function fitted to 1.4e-8. The energy then has double
precision, without iterations that a form compiler would have to differentiate.
"""

from __future__ import annotations

from ufl import conditional, diff, exp, ln, lt, sqrt, variable
from ufl.core.expr import Expr

NUMERATOR = (
    0.370407999630575,
    -1.44709419469843,
    2.90300015418804,
    -3.40267386230566,
    2.57160819329407,
    -1.1741068050906,
    0.315718126052264,
    -0.0328427272579788,
)
DENOMINATOR = (
    0.154625121730467,
    -0.567614481471156,
    1.07045344202479,
    -1.14779783222177,
    0.776532204576627,
    -0.293017705459885,
    0.0606354577308892,
    -0.00180776493073154,
)
r"""Coefficients in :math:`s = 2x^2 - 1` of a rational fit of :math:`(1 - x^2)\,\mathcal{L}^{-1}(x)/x` on
[0, 1]. Their last digits do not matter, because only the square of their error enters."""

SERIES = (
    1 / 6,
    -1 / 180,
    1 / 2835,
    -1 / 37800,
    1 / 467775,
    -691 / 3831077250,
    2 / 127702575,
    -3617 / 2605132530000,
    43867 / 350813659321125,
    -174611 / 15313294652906250,
)
r"""Coefficients of :math:`\ln(\sinh y/y)` in powers of :math:`y^2`, from the first power."""

SMALL = 0.5
"""Largest ``y`` for the series; the exact function would lose digits by differences of large numbers."""


def _polynomial(coefficients: tuple[float, ...], x: Expr) -> Expr:
    """Value of a polynomial by Horner's scheme."""
    value = coefficients[-1]
    for c in reversed(coefficients[:-1]):
        value = c + x * value
    return value


def _fitted(x: Expr) -> Expr:
    """Inverse Langevin function to 1.4e-8, odd in ``x``; not a number beyond full extension, ``|x| >= 1``."""
    s = 2 * x**2 - 1
    # 1 - x is exact near full extension, 1 - x^2 is not. The squared square root is not a number beyond x =
    # 1, where a negative denominator would describe a chain under pressure.
    left = sqrt(1 - x) ** 2 * (1 + x)
    return x * _polynomial(NUMERATOR, s) / (_polynomial(DENOMINATOR, s) * left)


def chain_energy(x: Expr) -> Expr:
    r"""Energy of a chain at a fraction ``0 <= x < 1`` of its full length, per link and ``K T``.

    .. math:: \epsilon(x) = x\beta - \ln\frac{\sinh\beta}{\beta}, \qquad \beta = \mathcal{L}^{-1}(x)

    The first derivative is the inverse Langevin function.
    """
    y = _fitted(x)
    square = y**2
    small = x * y - square * _polynomial(SERIES, square)
    # ln(sinh y/y) = y - ln(2 y) + ln(1 - exp(-2 y)); 1 - x is exact, so no digits are lost near x = 1.
    large = ln(2 * y) - (1 - x) * y - ln(1 - exp(-2 * y))
    return conditional(lt(y, SMALL), small, large)


def inverse_langevin(x: Expr) -> Expr:
    r""":math:`\mathcal{L}^{-1}(x)` for ``0 <= x < 1``, the derivative of :func:`chain_energy`."""
    at = variable(x)
    return diff(chain_energy(at), at)


def three_chain(lam1: Expr, lam2: Expr, nkt: Expr, links: Expr) -> Expr:
    r"""James & Guth's network of three chains, zero at rest (equation 3.8).

    .. math:: w = \frac{NKT\,n}{3} \sum_i \big[\epsilon(\lambda_i/\sqrt n) - \epsilon(1/\sqrt n)\big]
    """
    stretches = (lam1, lam2, 1 / (lam1 * lam2))
    energies = sum(chain_energy(stretch / sqrt(links)) for stretch in stretches)
    return nkt * links / 3 * (energies - 3 * chain_energy(1 / sqrt(links)))


def arruda_boyce(lam1: Expr, lam2: Expr, nkt: Expr, links: Expr) -> Expr:
    r"""Arruda & Boyce's network of eight chains, zero at rest (equations 3.9 and 3.10).

    .. math:: w = NKT\,n \big[\epsilon(\lambda_c/\sqrt n) - \epsilon(1/\sqrt n)\big], \qquad
              \lambda_c^2 = I_1/3
    """
    return eight_chain((lam1**2 + lam2**2 + 1 / (lam1 * lam2) ** 2) / 3, nkt, links)


def eight_chain(square: Expr, nkt: Expr, links: Expr) -> Expr:
    """The same energy as a function of the chains' squared stretch, a third of the first invariant."""
    return nkt * links * (chain_energy(sqrt(square / links)) - chain_energy(1 / sqrt(links)))
