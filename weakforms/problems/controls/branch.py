r"""Stability of the same states under other controls than a given pressure.

A membrane encloses a volume ``V`` whose gradient in the unknowns is ``d``. With ``K`` the second variation at
a given pressure, that at a given volume is ``K`` on :math:`d^T x = 0`, and that at a given mass of gas

.. math:: K + s\,d\,d^T, \qquad s = \kappa\,\frac{p + p_{atm}}{V + V_r}, \qquad
          (p + p_{atm})\,(V + V_r)^\kappa = m

with a rigid reservoir ``V_r``. By the inertia of the matrix bordered by ``d``, with
:math:`V_p = d^T K^{-1} d`, the rate of the volume with the pressure,

.. math:: n_V = n - [V_p < 0], \qquad n_m = n - [1 + s V_p < 0]

Along a branch they change where the volume, or the mass, has an extremum.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from weakforms.results import Quantity
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.modes import NO_RATE, rated
from weakforms.solvers.uncertainty.family import BranchFamily


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


class ControlledBranch(EquilibriumBranch):
    """Equilibria over the gas pressure ``p``, with the mass of gas ``m`` as a column.

    Args:
        continuation: Follows the curve.
        control: The load ``p``.
        start: First point.
        stop: True at the last requested point.
        gas: The gas.
        along: A column that increases along the branch.
    """

    def __init__(
        self,
        continuation: Continuation,
        control: str,
        start: CurvePoint,
        stop: Callable[[CurvePoint], bool],
        gas: Gas,
        along: str,
    ) -> None:
        self.gas, self.along = gas, along
        super().__init__(continuation, control, start, stop)

    @property
    def shown(self) -> list[str]:
        """Columns that results show, with the mass."""
        return [*super().shown, "m"]

    def columns(self) -> dict[str, np.ndarray]:
        """Every column, with the mass."""
        found = super().columns()
        masses = [self.gas.mass(*both) for both in zip(found["p"], found["V"], strict=True)]
        return found | {"m": np.array(masses)}

    def _values(self, state: State) -> dict[str, float]:
        found = super()._values(state)
        return found | {"m": self.gas.mass(found["p"], found["V"])}

    def special(self) -> list[Solved]:
        """Limit points of the pressure, the volume and the mass, in order along the branch."""
        found = super().special()
        for kind, rate in {"volume_fold": _volume, "mass_fold": self.gas.balance}.items():
            rates = np.array([rate(*self._rates(p.state, p)) for p in self.points])
            for i in np.flatnonzero(rates[:-1] * rates[1:] < 0).tolist():
                like = self.points[i]

                def function(at: Solved, rate: Callable[..., float] = rate, like: CurvePoint = like) -> float:
                    return rate(*self._rates(at.state, like))

                found.append(self._root(i, function, kind))
        return sorted(found, key=lambda at: at.values[self.along])

    def _rates(self, state: State, like: CurvePoint) -> tuple[float, float, float, float]:
        """``p, V`` and their rates along the branch at a state, in the sense of a point near it."""
        tangent = self.continuation.direction(state, like.tangent)
        with self.system.at(state):
            rate, volume = self.continuation.rate("V", tangent), self.system.monitor("V")
        return state.loads["p"], volume, tangent.loads["p"], rate

    def counts(self, state: State) -> dict[str, int]:
        """Negative eigenvalues at given volume and at given mass, in the symmetry of the unknowns.

        An eigenvalue that is zero, at an extremum of the pressure, the volume or the mass, does not count.
        """
        with self.system.at(state):
            found, volume = rated(self.system, self.solver.factor, "p"), self.system.monitor("V")
        p = state.loads["p"]
        parts = self.gas.balance(p, volume, 1.0, 0.0), self.gas.balance(p, volume, 0.0, found.rate)
        removed = sum(parts) < NO_RATE * max(map(abs, parts))
        return {"n_fixed_V": found.count_at_fixed, "n_fixed_m": found.count - int(removed)}


def _volume(_p: float, _volume: float, _by_p: float, by_volume: float) -> float:
    return by_volume


class ControlledFamily(BranchFamily):
    """A branch with its stability under all controls, on all meshes."""

    fine: ControlledBranch

    def _trace(self) -> dict[str, np.ndarray]:
        """Columns of the finest mesh's trace, with the counts."""
        rows = [self.fine.counts(point.state) for point in self.fine.points]
        return super()._trace() | _table(rows)

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """As for any branch, with the counts."""
        levels = zip(self.levels, solved, strict=True)
        rows = _table([level.counts(s.state) for level, s in levels if isinstance(level, ControlledBranch)])
        found = {name: Quantity(same_count(values.tolist())) for name, values in rows.items()}
        return super()._diagnostics(solved, critical) | found


def _table(rows: Sequence[Mapping[str, int]]) -> dict[str, np.ndarray]:
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}
