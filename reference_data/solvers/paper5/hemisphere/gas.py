"""The hanging hemisphere under gas: the body of paper 5 with a uniform pressure instead of the liquid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from reference_data.solvers.paper5.hemisphere.body import Hemisphere


@dataclass(frozen=True)
class GasHemisphere(Hemisphere):
    """The same membrane; the load is p = P Ao/(C1 h)."""

    weight: float = 0.0
    load: ClassVar[str] = "gas"
    control: ClassVar[str] = "p"

    def pressure(self, z: Any, load: Any, _wet: Any) -> Any:
        """The same pressure at every height."""
        return load + 0 * z

    def crossed(self, _load: float) -> bool:
        """There is no surface."""
        return False


GAS = GasHemisphere()
