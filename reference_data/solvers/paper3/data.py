"""Data of the fluid-loaded, pre-stretched tube, in non-dimensional form.

Source: paper 3 of the thesis (Patil, Nordmark & Eriksson, fluid-loaded pre-stretched cylindrical
membranes). Lengths over the radius A, areas over A^2, energies over mu H A^2, stress resultants over
mu H, gamma = rho g A^2/(mu H).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

GAMMA = 0.116
GAMMA_EXACT = 3.924 / 33.8  # rho g A^2/(mu H) of the printed data, 1000 9.81 0.02^2/(0.4225e6 0.08e-3)


@dataclass(frozen=True)
class FluidTube:
    """A pre-stretched tube on rigid discs, filled from z = 0 upwards.

    Attributes:
        L: Distance of the discs over A.
        delta: Axial pre-stretch; the discs are bonded before it.
        gamma: Weight of the fluid, rho g A^2/(mu H).
        law: Another law in the place of the neo-Hookean one (``material_laws``), its energy over mu H being
            half its own: mu is twice the stress its constants are over.
    """

    L: float
    delta: float
    gamma: float = GAMMA
    law: Any = None

    @property
    def length(self) -> float:
        """Material length l = L/delta."""
        return self.L / self.delta
