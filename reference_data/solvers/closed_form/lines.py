r"""Critical points of balloons and of long tubes, in closed form up to a root.

Of a balloon of stretch ``l`` with the tension :math:`\tau = w_1/l` and :math:`S = w_{11} + w_{12}`, a limit
point has :math:`S = 2\tau`, and a mode of degree 1 (a pear) is neutral where :math:`S = \tau`, where the
tension has an extremum. From the energy :math:`f(l) = w(l, l)` alone they are :math:`l f'' = 2 f'` and
:math:`l f'' = f'`.

Long waves of a tube with :math:`p = w_2/(l_1 l_2)` and axial force :math:`N = w_1 - p\, l_2^2/2` are neutral
where :math:`w_{11} (w_{22} - p\, l_1) = (w_{12} - p\, l_2)^2`, which is :math:`\partial(p, N)/\partial(l_1,
l_2) = 0` (Haughton & Ogden 1979; Fu, Pearce & Liu 2008). A long tube between fixed ends bends where ``N``
is zero.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq, fsolve

from reference_data.solvers.closed_form.bodies import FINE, Derivatives
from reference_data.solvers.core.contour import derivative

Energy = Callable[[Any, Any], Any]
LIMIT, PEAR = 2.0, 1.0
"""Values of ``S/tau`` at limit points of a balloon, and at modes of degree 1."""

WEIGHTS, PLACES = (-1, 9, -45, 45, -9, 1), (-3, -2, -1, 1, 2, 3)
"""First derivative by differences of sixth order."""


def root(f: Callable[[float], float], bracket: tuple[float, float]) -> float:
    """The root in an interval."""
    return brentq(f, *bracket, xtol=1e-16, rtol=FINE)


def slope(f: Callable[[float], float], x: float, step: float) -> float:
    """A derivative by differences of sixth order; ``step`` is relative."""
    h = step * x
    return sum(w * f(x + k * h) for w, k in zip(WEIGHTS, PLACES, strict=True)) / (60 * h)


# -- balloon ----------------------------------------------------------------------------------------


def balloon(d: Derivatives, lam: float, ratio: float) -> float:
    """``S - ratio tau``."""
    _, w1, _, w11, w12, _ = d(lam, lam)
    return w11 + w12 - ratio * w1 / lam


def balloon_from_energy(w: Energy, lam: float, ratio: float) -> float:
    """``l f'' - ratio f'``, with ``f'`` of both directions together."""
    first, second = (derivative(lambda x: w(x, x), lam, k) for k in (1, 2))
    return lam * second - ratio * first


def balloon_turn(make: Callable[[float], Derivatives], ratio: float, guess: tuple[float, float]) -> Any:
    """``(constant, lam)`` at which a line turns in the constant of the law."""

    def equations(z: np.ndarray) -> list[float]:
        lam, d = z[0], make(z[1])
        return [balloon(d, lam, ratio), slope(lambda x: balloon(d, x, ratio), lam, 2e-3)]

    return fsolve(equations, guess[::-1], xtol=1e-12)[::-1]


def balloon_turn_from_energy(
    make: Callable[[float], Energy], ratio: float, guess: tuple[float, float]
) -> Any:
    """The same from three derivatives of the energy."""

    def equations(z: np.ndarray) -> list[float]:
        lam, w = z[0], make(z[1])
        f1, f2, f3 = (derivative(lambda x: w(x, x), lam, k) for k in (1, 2, 3))
        return [lam * f2 - ratio * f1, lam * f3 + (1 - ratio) * f2]

    return fsolve(equations, guess[::-1], xtol=1e-12)[::-1]


# -- long tube --------------------------------------------------------------------------------------


def pressure(d: Derivatives, l1: float, l2: float) -> float:
    """``p`` of a tube that is held at ``l1``."""
    return d(l1, l2)[2] / (l1 * l2)


def force(d: Derivatives, l1: float, l2: float) -> float:
    """``N = w_1 - p l2^2/2``."""
    return d(l1, l2)[1] - pressure(d, l1, l2) * l2**2 / 2


def long_waves(d: Derivatives, l1: float, l2: float) -> float:
    """The determinant of the second variation at given pressure."""
    _, _, w2, w11, w12, w22 = d(l1, l2)
    p = w2 / (l1 * l2)
    return w11 * (w22 - p * l1) - (w12 - p * l2) ** 2


def loads_jacobian(d: Derivatives, l1: float, l2: float) -> float:
    """``d(p, N)/d(l1, l2)``."""
    _, _, w2, w11, w12, w22 = d(l1, l2)
    p = w2 / (l1 * l2)
    p1, p2 = w12 / (l1 * l2) - p / l1, w22 / (l1 * l2) - p / l2
    return p1 * (w12 - p2 * l2**2 / 2 - p * l2) - p2 * (w11 - p1 * l2**2 / 2)


def bends(w: Energy, l1: float, l2: float) -> float:
    """Rate of the energy at constant volume ``l1 l2^2``, which is zero where ``N = 0``."""
    return derivative(lambda s: w(l1 * s * s, l2 / s), 1.0, 1)


def where_both(d: Derivatives, guess: tuple[float, float]) -> Any:
    """``(l1, l2)`` at which long waves of both kinds are neutral."""
    return fsolve(lambda z: [long_waves(d, *z), force(d, *z)], guess, xtol=1e-12)


def waves_turn(
    condition: Callable[[Derivatives, float, float], float],
    d: Derivatives,
    guess: tuple[float, float],
    step: float,
) -> Any:
    """``(l1, l2)`` at which the line of a condition turns in ``l1``."""

    def equations(z: np.ndarray) -> list[float]:
        return [condition(d, *z), slope(lambda x: condition(d, z[0], x), z[1], step)]

    return fsolve(equations, guess, xtol=1e-12)


def tube_merge(
    rate: Callable[[float, float], float], guess: tuple[float, float], step: float
) -> tuple[float, float]:
    """``(constant, l2)`` at which limit points of a closed tube merge: the pressure's rate and its slope."""

    def equations(z: np.ndarray) -> list[float]:
        return [rate(z[1], z[0]), slope(lambda x: rate(z[1], x), z[0], step)]

    l2, constant = fsolve(equations, guess[::-1], xtol=1e-12)
    return constant, l2
