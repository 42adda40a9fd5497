"""The hanging hemisphere whose thickness is a cosine of the meridian, 1 + 0.3 cos(2 t), under liquid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from reference_data.solvers.paper4.methods.pole import Pole
from reference_data.solvers.paper5.hemisphere.body import Hemisphere

A = 0.3


@dataclass(frozen=True)
class UnevenHemisphere(Hemisphere):
    """The same membrane with another thickness."""

    at_pole: ClassVar[Pole] = Pole(-1 / 6, 1 + A, -2 * A / (1 + A))

    def eta(self, s: Any) -> Any:
        """Thickness."""
        return 1 + A * np.cos(2 * s)

    def slopes(self, s: Any) -> tuple[Any, Any]:
        """Derivatives of the unloaded radius and of the thickness."""
        return np.cos(s), -2 * A * np.sin(2 * s)


UNEVEN = UnevenHemisphere()
EXPRESSION = f"1 + {A:g}*cos(2*t)"
