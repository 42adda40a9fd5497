r"""Second method: the balance of forces at points of the whole length of the tube under a liquid.

.. math:: (h f_a)_{,Z} + (h f_b)_{,\Theta} + \gamma\,(z_w - x\cdot e)\, b\times a = 0, \qquad
          e = (\sin\tau, 0, \cos\tau)

with the nodes of :mod:`bowed.collocation`, here from the lower ring to the upper one, both held.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from reference_data.solvers.beyond.bowed.collocation import Collocation
from reference_data.solvers.beyond.imperfect.tube import Imperfect
from reference_data.solvers.core.collocation import Array


class LiquidCollocation(Collocation):
    """The discrete equations of one tube; the load is the level.

    Args:
        of: The tube.
        degree: Of the polynomials along it, an even number: its middle is a node.
        waves: Largest wave number around.
    """

    def __init__(self, of: Imperfect, degree: int, waves: int) -> None:
        super().__init__(2 * of.tube.length, degree, waves)
        self.of = of

    @cached_property
    def free(self) -> Array:
        """Whether a value is unknown."""
        out = np.ones((3, *self.shape), bool)
        out[:, [0, -1]] = False
        out[1, :, 0] = False
        return out.ravel()

    def _across(self, angle: float) -> Array:
        """The row that reads the distance from the axis in the middle of the length at a mirror."""
        m = np.arange(self.waves + 1)
        out = np.zeros((3, *self.shape))
        cos, sin = np.cos(np.outer(self.theta, m)), np.sin(np.outer(self.theta, m))
        middle = self.shape[0] // 2
        out[0, middle] = np.linalg.solve(cos.T, np.cos(m * angle)) * np.cos(angle)
        out[1, middle, 1:] = np.linalg.solve(sin[1:, 1:].T, np.sin(m[1:] * angle)) * np.sin(angle)
        return out.ravel()[self.free]

    @property
    def offset(self) -> Array:
        """The row that reads half the difference of the radii at both mirrors."""
        return self._across(0.0) / 2 - self._across(np.pi / self.of.n) / 2

    @property
    def radius(self) -> Array:
        """The row that reads their mean."""
        return self._across(0.0) / 2 + self._across(np.pi / self.of.n) / 2

    def load(self, place: Array, p: float, uneven: float) -> tuple[Array, Array, Array, Array]:
        """Pressure at the nodes, its derivatives by the level, by the imperfection and by x (nodes, 3)."""
        weight, one = self.of.tube.gamma, np.ones(self.size)
        angle = uneven * np.pi / 180 * self.of.tilted
        up = np.array([np.sin(angle), 0, np.cos(angle)])
        turned = np.array([np.cos(angle), 0, -np.sin(angle)]) * np.pi / 180 * self.of.tilted
        return (
            weight * (p - place @ up),
            weight * one,
            -weight * (place @ turned),
            -weight * np.outer(one, up),
        )

    def thickness(self, uneven: float) -> tuple[Array, Array]:
        """Thickness at the nodes, its derivative by the imperfection."""
        side = np.tile(np.cos(self.of.n * self.theta), self.shape[0]) * (not self.of.tilted)
        return 1 + uneven * side, side

    def volume(self, x: Array) -> float:
        """Volume of the liquid."""
        return 2 * self.enclosed(x)
