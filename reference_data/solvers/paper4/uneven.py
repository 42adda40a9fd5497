"""A cylinder and a flat disk whose thickness is a cosine of the meridian, for the methods of this room.

The disk is clamped at its edge, has the radius 1 without pre-stretch, and hangs under gas: its pole is its
lowest point.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from reference_data.solvers.paper4.material import Array, Membrane
from reference_data.solvers.paper4.methods.pole import Pole, begin

NEAR = 0.01  # end of the pole's expansion, times the number of steps of a segment


@dataclass(frozen=True)
class UnevenTube(Membrane):
    """A cylinder of the thickness 1 + a cos(2 pi s/L); M says nothing.

    Attributes:
        a: Half of the difference of the thickness between ends and middle.
    """

    a: float = 0.4

    def eta(self, s: Any) -> Any:
        """Thickness over its mean."""
        return 1 + self.a * np.cos(2 * np.pi * s / self.L)

    def slopes(self, s: Any) -> tuple[Any, Any]:
        """Derivatives of the unloaded radius and of the thickness."""
        rate = 2 * np.pi / self.L
        return 0.0, -self.a * rate * np.sin(rate * s)

    @property
    def thinnest(self) -> float:
        """Least thickness over the mean."""
        return 1 - abs(self.a)


@dataclass(frozen=True)
class FlatDisk:
    """A body, as :class:`material.Body` describes it, of the thickness 1 + a cos(pi s); the full energy."""

    a: float = 0.2
    L: ClassVar[float] = 1.0
    c2: ClassVar[float] = 0.1
    energy: ClassVar[str] = "standard"
    load: ClassVar[str] = "gas"
    control: ClassVar[str] = "p"
    weight: ClassVar[float] = 0.0
    pole: ClassVar[bool] = True
    longest: ClassVar[float] = 0.2
    cautious: ClassVar[float] = 0.02

    def unloaded(self, s: Any) -> Any:
        """Unloaded radius."""
        return 1.0 * s

    def eta(self, s: Any) -> Any:
        """Thickness."""
        return 1 + self.a * np.cos(np.pi * s)

    def slopes(self, s: Any) -> tuple[Any, Any]:
        """Derivatives of the unloaded radius and of the thickness."""
        return 1.0, -self.a * np.pi * np.sin(np.pi * s)

    def clamped(self, bottom: list[Any], top: list[Any]) -> list[Any]:
        """Smooth at the pole, held at the edge."""
        return [bottom[0], bottom[3] - np.pi / 2, top[0] - 1, top[1]]

    def pressure(self, z: Any, load: Any, _wet: Any) -> Any:
        """The same pressure everywhere."""
        return load + 0 * z

    def decided(self, _load: float) -> bool:
        """The sign of gw - 1 is not needed."""
        return True

    def segments(self, count: int, steps: int) -> Array:
        """Segments that grow from where the pole's expansion ends, which is nearer for more steps."""
        return np.geomspace(NEAR / steps, self.L, count + 1)

    def begin(self, given: Array, load: Array, s: float) -> Array:
        """(r, z, A, F) at a small radius from the stretch and the height of the pole."""
        thick = 1 + self.a
        return begin(self, Pole(0.0, thick, -self.a * np.pi**2 / (2 * thick)), given, load, s)

    def free(self, given: Array) -> list[Any]:
        """The pole has two unknowns only."""
        return [given[2], given[3]]

    def crossed(self, _load: float) -> bool:
        """There is no surface."""
        return False
