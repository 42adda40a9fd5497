"""The hanging hemisphere under liquid, paper 5 of the thesis, section 3.3: data and ends.

Neo-Hookean (c2 = 0) if no other law is given, R = sin s, s in [0, pi/2] the angle from the lowest point,
thickness 1, clamped at the equator, where z = 0; liquid up to the level zw < 0. The methods of paper 4 apply
to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from reference_data.solvers.paper4.material import GAMMA, Array
from reference_data.solvers.paper4.methods.pole import Pole, begin

EQUATOR = np.pi / 2
NEAR = 0.01  # end of the pole's expansion, times the number of steps of a segment
KAPPA = 100 * GAMMA  # rho g Ao^2/(C1 h) with Ao = 0.1 m instead of 0.01 m


@dataclass(frozen=True)
class Hemisphere:
    """A body, as :class:`paper4.material.Body` describes it.

    Attributes:
        c2: C2/C1, or another law.
        weight: rho g Ao^2/(C1 h) of the liquid.
    """

    c2: float = 0.0
    weight: float = KAPPA
    L: ClassVar[float] = EQUATOR
    energy: ClassVar[str] = "relaxed"
    load: ClassVar[str] = "fluid"
    control: ClassVar[str] = "zw"
    pole: ClassVar[bool] = True
    longest: ClassVar[float] = 0.2
    cautious: ClassVar[float] = 0.02
    at_pole: ClassVar[Pole] = Pole(-1 / 6)

    def unloaded(self, s: Any) -> Any:
        """Unloaded radius."""
        return np.sin(s)

    def eta(self, s: Any) -> Any:
        """Thickness."""
        return 1.0 + 0 * s

    def slopes(self, s: Any) -> tuple[Any, Any]:
        """Derivatives of the unloaded radius and of the thickness."""
        return np.cos(s), 0.0

    def clamped(self, bottom: list[Any], top: list[Any]) -> list[Any]:
        """Smooth at the pole, held at the equator."""
        return [bottom[0], bottom[3] - EQUATOR, top[0] - 1, top[1]]

    def pressure(self, z: Any, load: Any, wet: Any) -> Any:
        """Pressure of the liquid up to a level, on the wet part."""
        return np.where(wet, self.weight * (load - z), 0.0)

    def decided(self, _load: float) -> bool:
        """Whether the sign of gw - 1 is not needed."""
        return False

    def segments(self, count: int, steps: int) -> Array:
        """Segments that grow from where the pole's expansion ends, which is nearer for more steps."""
        return np.geomspace(NEAR / steps, EQUATOR, count + 1)

    def begin(self, given: Array, load: Array, s: float) -> Array:
        """(r, z, A, F) at a small angle from the stretch and the height of the pole."""
        return begin(self, self.at_pole, given, load, s)

    def free(self, given: Array) -> list[Any]:
        """The pole has two unknowns only."""
        return [given[2], given[3]]

    def crossed(self, _load: float) -> bool:
        """Whether the fluid's surface lies between the ends."""
        return True


BODY = Hemisphere()
