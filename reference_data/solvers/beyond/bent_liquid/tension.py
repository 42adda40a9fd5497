r"""A neo-Hookean sheet that bears no compression, once for each of the two codes of bent states.

(a) By principal stretches: the energy is :math:`l^2 + 2/l - 3` of uniaxial tension where the smaller stretch
is below :math:`l^{-1/2}`, and zero if no stretch is above 1.

(b) By forces: where the force across the larger stretch ``l`` would push, Mooney's force
:math:`2(l - l^{-2})` along the fibre of that stretch (:mod:`beyond.bent_tube.wrinkled`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from reference_data.solvers.beyond.bent_tube import strong, wrinkled
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube

PLAIN = Tube(0.0, 1.0, 1.0)
"""Neo-Hookean; forces depend on nothing else of it."""


class ByStretches:
    """Method (a)."""

    def energy(self, l1: Any, l2: Any) -> Any:
        """``w`` of real stretches."""
        large, small = np.maximum(l1, l2), np.minimum(l1, l2)
        tension = np.where(large > 1, large**2 + 2 / large - 3, 0.0)
        return np.where(small**2 * large > 1, l1**2 + l2**2 + (l1 * l2) ** -2 - 3, tension)

    def slope(self, l1: Any, l2: Any) -> Any:
        """``w_1``."""
        pulled = (np.real(l1) > np.real(l2)) & (np.real(l1) > 1)
        return np.where(
            self._taut(l1, l2), 2 * (l1 - 1 / (l1**3 * l2**2)), np.where(pulled, 2 * (l1 - l1**-2), 0 * l1)
        )

    def shear_modulus(self, l1: Any, l2: Any) -> Any:
        """``(w_1/(2 l_1) - w_2/(2 l_2))/(l_1^2 - l_2^2)``; a taut sheet of equal stretches needs no limit."""
        taut, apart = self._taut(l1, l2), l1**2 - l2**2
        first, second = self.slope(l1, l2) / (2 * l1), self.slope(l2, l1) / (2 * l2)
        wrinkled_part = (first - second) / np.where(taut | (apart == 0), 1.0, apart)
        return np.where(taut, (l1 * l2) ** -4, wrinkled_part)

    @staticmethod
    def _taut(l1: Any, l2: Any) -> Any:
        one, two = np.real(l1), np.real(l2)
        return (one * two**2 > 1) & (two * one**2 > 1)


class ByForces:
    """Method (b)."""

    def forces(self, a: Array, b: Array) -> tuple[Array, Array]:
        """Forces on cuts Z = const and Theta = const, per material length, over ``mu H``."""
        first, second = wrinkled.forces(PLAIN, a, b)
        return first / 2, second / 2

    def rates(self, a: Array, b: Array) -> Array:
        """Their derivative by (a, b), by complex steps, shape (..., 2, 3, 2, 3)."""

        def flat(x: Array) -> Array:
            return np.concatenate(self.forces(x[..., :3], x[..., 3:]), axis=-1)

        return strong.jacobian(flat, np.concatenate([a, b], axis=-1)).reshape(*a.shape[:-1], 2, 3, 2, 3)

    def energy(self, l1: Any, l2: Any) -> Any:
        """Twice the energy: the work of these forces, of a sheet pulled along one fibre where it is slack."""
        large, small = np.maximum(l1, l2), np.minimum(l1, l2)
        across = np.maximum(small, np.sqrt(1 / np.maximum(large, 1.0)))
        along = np.maximum(large, 1.0)
        return along**2 + across**2 + 1 / (along * across) ** 2 - 3
