r"""Bent states of a tube that bears no compression, by both methods with a tension field.

Where the smaller principal stress of the law would be negative the tube is wrinkled: it is in uniaxial
tension along the direction ``v`` of the larger stretch ``l``, and slack if ``l <= 1``.

(a) The energy is that of uniaxial tension, and with the projector ``N`` on ``v``

.. math:: \frac{\partial W}{\partial C} = \frac{w_r'(l)}{2l}\,N, \quad N = \frac{C - l_2^2 I}{l^2 - l_2^2},
          \quad w_r = l^2 + 2/l - 3 + \alpha (2l + l^{-2} - 3).

(b) The force on a cut is Mooney's :math:`2(1 + \alpha/l)(l - l^{-2})` along ``d/l`` times the component of
``v`` across the cut, ``d`` being the fibre that was along ``v``.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from reference_data.solvers.beyond.bent_tube import energy, strong
from reference_data.solvers.beyond.tube_waves import ritz
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube


def gradient(tube: Tube, p: float, x: Array, a: Array, b: Array) -> tuple[Array, Array, Array]:
    """As of a tube that bears compression, with the energy of a tension field."""
    r0, alpha, c = tube.r0, tube.alpha, b / tube.r0
    by_x, by_a, by_b = ritz.gradient(tube, p, x, a, b)
    _, taut_a, taut_b = ritz.gradient(tube, 0.0, x, a, b)
    g, h, k = (a * a).sum(0), (c * c).sum(0), (a * c).sum(0)
    t, j = g + h, g * h - k * k
    apart = np.sqrt((g - h) ** 2 + 4 * k**2 + 0j)
    large, small = (t + apart) / 2, (t - apart) / 2
    law = 1 + alpha / j + large * (alpha * (1 - t / j**2) - 1 / j**2)
    wrinkled, slack = np.real(law) < 0, np.real(large) <= 1
    stretch = np.sqrt(large)
    tension = (stretch - 1 / large) * (2 + 2 * alpha / stretch) / (2 * stretch)
    tension = np.where(slack, 0.0, tension) / np.where(np.abs(apart) > 0, apart, 1.0)
    own_a = 2 * r0 * tension * ((g - small) * a + k * c)
    own_b = 2 * tension * ((h - small) * c + k * a)
    if not any(map(np.iscomplexobj, (x, a, b))):
        own_a, own_b = own_a.real, own_b.real
    return by_x, by_a + np.where(wrinkled, own_a - taut_a, 0), by_b + np.where(wrinkled, own_b - taut_b, 0)


def forces(tube: Tube, a: Array, b: Array) -> tuple[Array, Array]:
    """Forces on both cuts from the tangents."""
    taut_a, taut_b = strong.forces(tube, a, b)
    g, h, k = (np.sum(u * v, axis=-1, keepdims=True) for u, v in ((a, a), (b, b), (a, b)))
    large = (g + h + np.sqrt((g - h) ** 2 + 4 * k * k)) / 2
    steep = np.real(h) > np.real(g)
    first, second = np.where(steep, k, large - h), np.where(steep, large - g, k)
    length = np.sqrt(first**2 + second**2)
    first, second = first / length, second / length
    fibre, across = first * a + second * b, first * b - second * a
    stretch = np.sqrt(np.sum(fibre * fibre, axis=-1, keepdims=True))
    pull = 2 * (1 + tube.alpha / stretch) * (stretch - stretch**-2) * fibre / stretch
    pull = np.where(np.real(stretch) > 1, pull, 0)
    pushed = np.real(np.sum((first * taut_b - second * taut_a) * across, axis=-1, keepdims=True)) < 0
    return np.where(pushed, first * pull, taut_a), np.where(pushed, second * pull, taut_b)


class ByEnergy(energy.State):
    """A state by method (a)."""

    gradient: ClassVar = staticmethod(gradient)


class ByForces(strong.State):
    """A state by method (b)."""

    forces: ClassVar = staticmethod(forces)
