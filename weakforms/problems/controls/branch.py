r"""Stability of the same states under other controls than a given pressure.

A membrane encloses a volume ``V`` whose gradient in the unknowns is ``d``. With ``K`` the second variation at
a given pressure, that at a given volume is ``K`` on :math:`d^T x = 0`. By the inertia of the matrix bordered
by ``d``, with :math:`V_p = d^T K^{-1} d`, the rate of the volume with the pressure,

.. math:: n_V = n - [V_p < 0]

Along a branch it changes where the volume has an extremum. At a given mass: :mod:`weakforms.problems.gas`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from weakforms.problems.gas import Gas, folds_of
from weakforms.results import Quantity
from weakforms.solvers.continuation.amounts import AmountCurve
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.modes import rated
from weakforms.solvers.uncertainty.family import BranchFamily


class ControlledBranch(AmountCurve, EquilibriumBranch):
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
        found += [solved for _, solved in self.folds("p", "V", folds_of(self.gas))]
        return sorted(found, key=lambda at: at.values[self.along])

    def counts(self, state: State) -> dict[str, int]:
        """Negative eigenvalues at given volume and at given mass, in the symmetry of the unknowns.

        An eigenvalue that is zero, at an extremum of the pressure, the volume or the mass, does not count.
        """
        with self.system.at(state):
            found, volume = rated(self.system, self.solver.factor, "p"), self.system.monitor("V")
        at_mass = self.gas.count(found.count, state.loads["p"], volume, found.rate)
        return {"n_fixed_V": found.count_at_fixed, "n_fixed_m": at_mass}


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
