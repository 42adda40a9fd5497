r"""Derivatives of a law's energy with respect to the metric of a surface about a state of revolution.

With :math:`x_i = l_i^2` and ``g_12 = 0`` in the state, the energy of a perturbed surface is to second order

.. math:: U(x_1 + \delta g_{11},\ x_2 + \delta g_{22}) + f_y\,\delta g_{12}^2, \qquad
          f_y = \frac{f_1 - f_2}{x_1 - x_2}, \qquad f_i = \partial U/\partial x_i

and ``f_y`` is written so that equal stretches need no special treatment: for a part
:math:`\Phi(I, D)` of the invariants it is :math:`-\Phi_D`, for a part :math:`\sum\varphi(l_i)` it is the
divided difference of :math:`h = \varphi'/(2 l)` over :math:`l_1 + l_2`, the mean of ``h'`` between the two.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from reference_data.solvers.core.laws import Law

NEAR = 0.25
"""Difference of stretches over their sum below which the mean is integrated (20 Gauss points)."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True)
class Metric:
    """``f1, f2, f_y, f11, f12, f22`` of an energy."""

    f1: Any
    f2: Any
    fy: Any
    f11: Any
    f12: Any
    f22: Any


def metric(law: Law, l1: Any, l2: Any) -> Metric:
    """Derivatives of the energy with respect to the metric, real or complex."""
    w1, w2 = law.slope(l1, l2), law.slope(l2, l1)
    return Metric(
        w1 / (2 * l1),
        w2 / (2 * l2),
        shear_modulus(law, l1, l2),
        (law.curvature(l1, l2) - w1 / l1) / (4 * l1 * l1),
        law.mixed(l1, l2) / (4 * l1 * l2),
        (law.curvature(l2, l1) - w2 / l2) / (4 * l2 * l2),
    )


def shear_modulus(law: Any, l1: Any, l2: Any) -> Any:
    """``f_y``; an energy that is not a sum of such parts has its own."""
    if not isinstance(law, Law):
        return law.shear_modulus(l1, l2)
    out: Any = 0.0
    trace, area = l1 * l1 + l2 * l2, (l1 * l2) ** 2
    if law.invariants:
        _, fx, fz, *_ = law.invariants(trace + 1 / area - 3, trace / area + area - 3)
        out = out + fx / area**2 + fz * (trace / area**2 - 1)
    if law.stretch:
        l3 = 1 / (l1 * l2)
        out = out + law.stretch(l3)[1] * l3 / (2 * area) + _divided(law, l1, l2) / (l1 + l2)
    return out


def _divided(law: Law, l1: Any, l2: Any) -> Any:
    """``(h(l1) - h(l2))/(l1 - l2)``, ``h = phi'/(2 l)``."""
    half, mean = (l1 - l2) / 2, (l1 + l2) / 2
    near = np.abs(np.real(half)) < NEAR * np.real(mean)
    inside = 0.0
    for point, weight in zip(_POINTS, _WEIGHTS, strict=True):
        at = mean + half * point
        _, first, second = law.stretch(at)
        inside = inside + weight / 2 * (second - first / at) / (2 * at)
    h1, h2 = (law.stretch(x)[1] / (2 * x) for x in (l1, l2))
    return np.where(near, inside, (h1 - h2) / np.where(near, 1.0, l1 - l2))
