r"""Gas of a given mass inside a membrane, isothermal or adiabatic, with a rigid reservoir.

With the pressure ``p`` above that outside, the volume ``V`` of the membrane and that of the reservoir

.. math:: (p + p_{atm})\,(V + V_r)^\kappa = m

The second variation at a given mass is :math:`K + s\,d\,d^T` with the one at a given pressure ``K``, the
gradient ``d`` of the volume and :math:`s = \kappa\,(p + p_{atm})/(V + V_r)`. By the inertia of the matrix
bordered by ``d``, with the rate of the volume with the pressure :math:`V_p = d^T K^{-1} d`,

.. math:: n_m = n - [1 + s V_p < 0]

Along a branch it changes where the mass has an extremum.
"""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import Field

from weakforms.problems.material_choice import MaterialChoice
from weakforms.solvers.continuation.amounts import Rate
from weakforms.solvers.stability.modes import NO_RATE


@dataclass(frozen=True)
class Gas:
    """The gas inside, and the atmosphere outside."""

    kappa: float
    """1 for an isothermal gas, the ratio of its specific heats for an adiabatic one."""
    p_atm: float
    """Absolute pressure outside."""
    reservoir: float
    """Volume of a rigid reservoir."""

    def mass(self, p: float, volume: float) -> float:
        """``(p + p_atm) (V + V_r)^kappa``, proportional to the mass of an isothermal gas."""
        return (p + self.p_atm) * (volume + self.reservoir) ** self.kappa

    def balance(self, p: float, volume: float, by_p: float, by_volume: float) -> float:
        """``(V + V_r) by_p + kappa (p + p_atm) by_volume``: the rate of the mass from those of p and V."""
        return (volume + self.reservoir) * by_p + self.kappa * (p + self.p_atm) * by_volume

    def count(self, negative: int, p: float, volume: float, rate: float) -> int:
        """Negative eigenvalues at a given mass; one that is zero, at an extremum of the mass, does not count.

        Args:
            negative: Those at a given pressure.
            p: Pressure.
            volume: Volume.
            rate: ``V_p``.
        """
        parts = self.balance(p, volume, 1.0, 0.0), self.balance(p, volume, 0.0, rate)
        return negative - int(sum(parts) < NO_RATE * max(map(abs, parts)))


def _volume(_p: float, _volume: float, _by_p: float, by_volume: float) -> float:
    return by_volume


def folds_of(gas: Gas | None) -> dict[str, Rate]:
    """Rates of what has folds along a branch: of the amount of gas or liquid, and of the mass of a gas."""
    return {"volume_fold": _volume} | ({} if gas is None else {"mass_fold": gas.balance})


EXPONENT = Field(1.0, ge=1, le=2, description="1: isothermal gas; ratio of specific heats: adiabatic")
OUTSIDE = Field(1.0, ge=0, le=1e4, description="absolute pressure outside; 0 is a vacuum")
RESERVOIR = Field(
    0.0, ge=0, le=1e6, description="volume of a rigid reservoir, for the part whose volume is V; 0: none"
)


class GasChoice(MaterialChoice):
    """The gas inside a membrane of any law."""

    kappa: float = EXPONENT
    p_atm: float = OUTSIDE
    V_r: float = RESERVOIR

    @property
    def gas(self) -> Gas:
        """The gas with a given mass."""
        return Gas(self.kappa, self.p_atm, self.V_r)
