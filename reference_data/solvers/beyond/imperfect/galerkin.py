r"""First method: the principle of virtual work for the whole length of the tube under a liquid.

.. math:: F(x; v) = \iint h\,(f_a \cdot v_{,Z} + f_b \cdot v_{,\Theta}) - P\, v\cdot N \; dZ\, d\Theta, \qquad
          P = \gamma\,(z_w - z\cos\tau - x\sin\tau)

with the polynomials of :mod:`bowed.galerkin`, here from the lower ring to the upper one, both held.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from reference_data.solvers.beyond.bowed.galerkin import Galerkin
from reference_data.solvers.beyond.imperfect.tube import Imperfect
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.paper3 import weak


class LiquidGalerkin(Galerkin):
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
        """Whether a coefficient is unknown."""
        out = np.ones((3, len(self.nodes), self.waves + 1), bool)
        out[:, [0, -1]] = False
        out[1, :, 0] = False
        return out.ravel()

    def _radius(self, angle: float) -> Array:
        """The row that reads the radius in the middle of the length at a mirror."""
        m = np.arange(self.waves + 1)
        out = np.zeros((3, len(self.nodes), self.waves + 1))
        out[0, self.degree // 2] = np.cos(m * angle) * np.cos(angle)
        out[1, self.degree // 2] = np.sin(m * angle) * np.sin(angle)
        return out.ravel()[self.free]

    @property
    def offset(self) -> Array:
        """The row that reads half the difference of the radii at both mirrors."""
        return (self._radius(0.0) - self._radius(np.pi / self.of.n)) / 2

    @property
    def radius(self) -> Array:
        """The row that reads their mean."""
        return (self._radius(0.0) + self._radius(np.pi / self.of.n)) / 2

    def local(self, at: tuple[Array, Array, Array], p: float, uneven: float) -> tuple[Array, ...]:
        """Factors of (v_,Z, v_,Theta, v), their derivatives by these of x, by the level and imperfection."""
        a, b, place = at
        tilt, none = np.radians(uneven) if self.of.tilted else 0.0, np.zeros(len(a))
        gamma, (x, _, z) = self.of.tube.gamma, place.T
        normal = -weak.residual(a, b, none + 1)[:, 6:]
        strain = weak.residual(a, b, none)
        pressure = gamma * (p - z * np.cos(tilt) - x * np.sin(tilt))
        side = np.cos(self.of.n * self.theta) * (not self.of.tilted)
        h = 1 + uneven * side

        def pushed(rate: Array | float) -> Array:
            return np.column_stack([np.zeros((len(a), 6)), -(rate + none)[:, None] * normal])

        stiff = weak.tangent(a, b, none, none)
        turn = weak.tangent(a, b, pressure, none - gamma * np.cos(tilt)) - stiff
        turn[:, 6:, 6] += gamma * np.sin(tilt) * normal
        by_level = pushed(gamma)
        if self.of.tilted:
            other = pushed(np.radians(1.0) * gamma * (z * np.sin(tilt) - x * np.cos(tilt)))
        else:
            other = side[:, None] * strain
        own = h[:, None] * strain + pushed(pressure)
        return own, h[:, None, None] * stiff + turn, by_level, other

    def volume(self, x: Array) -> float:
        """Volume of the liquid."""
        return 2 * self.enclosed(x)
