r"""Branches of a membrane of revolution with their stability against families of waves.

The second variation of an axisymmetric state splits into families: one for each wave number ``n`` around the
axis and, if a plane is a mirror of the state, for each parity about it. A wave is *even* if the plane is a
mirror of the displaced membrane and *odd* if the mirror reverses the displacement. The eigenvalues of both
parities together are those of the whole membrane. For ``n = 0`` torsion is left out.

.. math:: K x = \Lambda M x
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import ClassVar

import numpy as np

from weakforms.problems.meridian.model import MeridianModel
from weakforms.problems.wave_numbers import LOWEST, eigenvalue_names
from weakforms.results import Quantity
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.modal import ModalBranch, ModalFamily
from weakforms.solvers.stability.modes import SecondVariation, judged, rated
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.uncertainty.family import BranchFamily

EVEN, ODD, WHOLE = 1, -1, 0
"""Parity of a family; a membrane without a mirror has waves of both."""


@dataclass(frozen=True)
class Wave:
    """A family of waves."""

    n: int
    parity: int

    @property
    def kind(self) -> str:
        """Kind of a special point at which its second variation is singular."""
        return f"bifurcation_n{self.n}" if self.n else "mirror_breaking"

    def __str__(self) -> str:
        """The family in words."""
        return {EVEN: "even waves of ", ODD: "odd waves of ", WHOLE: ""}[self.parity] + f"n = {self.n}"


class WaveModes:
    """Eigenvalues by wave number along a branch; a subclass has the operators.

    Args:
        model: The membrane.
        numbers: Wave numbers; 0 stands for axisymmetric waves.
        full: Whether the unknowns are those of the whole membrane, without a mirror.
    """

    def __init__(self, model: MeridianModel, numbers: tuple[int, ...], full: bool = False) -> None:
        self.model, self.numbers, self.full = model, numbers, full
        parities = (WHOLE,) if full else (EVEN, ODD)
        families = [Wave(n, parity) for n in numbers for parity in parities]
        # The axisymmetric waves of the unknowns' own symmetry are those of the equilibrium equations.
        self.wave_numbers = [w for w in families if w.n or w.parity == ODD]
        self.columns: tuple[str, ...] = tuple(name for n in numbers for name in eigenvalue_names(n))
        self._own = Stability(model.system)

    def variation(self, wave: Wave) -> SecondVariation:
        """The operator of a family."""
        raise NotImplementedError

    def observe(self) -> dict[str, float]:
        """The columns, and the lowest eigenvalue in the symmetry of the unknowns, ``eigenvalue_1``."""
        with self.model.system.weighed_here():
            own = judged(self._own, self.model.system.state(), LOWEST).eigenvalues
        out = {"eigenvalue_1": own[0]}
        for n in self.numbers:
            found = [] if n else list(own)
            for wave in self.wave_numbers:
                if wave.n == n:
                    found += self.variation(wave).spectrum(LOWEST).eigenvalues
            out |= dict(zip(eigenvalue_names(n), sorted(found), strict=False))
        return out

    def counts(self, own: int | None = None) -> dict[str, int]:
        """Negative eigenvalues of every wave number, and of axisymmetric waves at fixed volume, by inertia.

        Args:
            own: Number in the symmetry of the unknowns, if it is known.
        """
        out = {}
        for n in self.numbers:
            broken = sum(self.variation(wave).negative_count() for wave in self.wave_numbers if wave.n == n)
            if n:
                out[f"n_negative_n{n}"] = broken
            else:
                here = rated(self.model.system, self._own.factor, "p")
                out["n_negative_n0"] = broken + (here.count if own is None else own)
                out["n_negative_volume"] = broken + here.count_at_fixed  # waves do not change the volume
        return out


class WaveBranch(ModalBranch):
    """Axisymmetric states over the pressure, with the stability against waves."""

    modes: WaveModes

    along: ClassVar[str]
    """A column that grows along the whole branch."""

    end = inf
    """Its value at which the branch ends. The last step goes beyond, on each mesh by another length."""

    @property
    def computed(self) -> Sequence[str]:
        """The additional columns, and the lowest eigenvalue in the symmetry of the states."""
        return ("eigenvalue_1", *self.modes.columns)

    def special(self) -> list[Solved]:
        """Limit points and zeros of every family before the end, in order along the branch."""
        return [s for s in super().special() if s.kind == "limit_point" or s.values[self.along] <= self.end]

    def counted(self, state: State, own: int | None = None) -> dict[str, int]:
        """Numbers of negative eigenvalues of a state.

        Args:
            state: The state.
            own: Number in the symmetry of the states, if it is known (at a limit point it is round-off's).
        """
        with self.system.at(state):
            return self.modes.counts(own)

    def _named(self, n: Wave, direction: float) -> tuple[str, dict[str, float]]:
        return n.kind, {"n": float(n.n), "parity": float(n.parity), "direction": direction}


class WaveFamily(ModalFamily):
    """A branch with the stability against waves, on all meshes."""

    fine: WaveBranch
    marks: ClassVar = ("n", "parity", "direction")

    def _trace(self) -> dict[str, np.ndarray]:
        """Columns of the finest mesh's trace, with the counts."""
        rows, points = [], self.fine.points
        for i, point in enumerate(points):
            self.progress(f"stability of the {self.name} branch", i, len(points))
            self.fine.observed(point)
            rows.append(self.fine.counted(point.state, point.n_negative))
        return super()._trace() | {name: np.array([row[name] for row in rows]) for name in rows[0]}

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Numbers of negative eigenvalues; at a special point those of the waves are left out."""
        found = BranchFamily._diagnostics(self, solved, critical)
        if critical:
            return found
        rows = [level.counted(s.state) for level, s in zip(self.levels, solved, strict=True)]
        return found | {name: Quantity(same_count(row[name] for row in rows)) for name in rows[0]}
