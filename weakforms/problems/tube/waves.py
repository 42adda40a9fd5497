r"""The tube's stability against waves of any symmetry: bending, bulges that move, wrinkles.

The second variation of an axisymmetric state splits into families: one for each wave number ``n`` around the
axis and, on half the tube, for each parity along it. A wave is *even* if the mid-plane is a mirror of the
displaced tube and *odd* if the mirror reverses the displacement. A bent tube is ``n = 1``, even; a bulge that
moves to one end is ``n = 0``, odd. The eigenvalues of both parities together are those of the whole tube. For
``n = 0`` torsion is left out.

.. math:: K x = \Lambda M x, \qquad
          x^T M x = \int (u^2 + q^2 + w^2)\, \mathrm dZ \quad\text{(the mass of the axisymmetric states too)}
"""

from __future__ import annotations

from dataclasses import dataclass

from weakforms.problems.meridian.waves import AXIAL, CLAMPED, HOOP, RADIAL, MeridianWaves
from weakforms.problems.tube.model import TubeModel
from weakforms.problems.wave_numbers import LOWEST, eigenvalue_names
from weakforms.solvers.stability.modes import SecondVariation, judged, rated
from weakforms.solvers.stability.spectra import Stability

EVEN, ODD, WHOLE = 1, -1, 0
"""Parity of a family; a whole tube has waves of both."""

AT_MIDDLE = {EVEN: (AXIAL,), ODD: (RADIAL, HOOP), WHOLE: CLAMPED}
"""Components that are zero at the first end: the mid-plane, or the disk of a whole tube."""

EXTREMES = ("t_min", "Z_t_min")
"""Columns: the smallest principal resultant of a state, and where it is."""


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


class TubeWaves(MeridianWaves):
    """Second variations with the mass of the tube, ``int |dx|^2 dZ``."""

    def density(self) -> float:
        """One per ``Z``."""
        return 1.0


class TubeModes:
    """Quantities along a branch: eigenvalues by wave number, and the smallest principal resultant.

    Args:
        model: The tube.
        numbers: Wave numbers; 0 stands for axisymmetric waves.
        full: Whether the tube is the whole one.
    """

    def __init__(self, model: TubeModel, numbers: tuple[int, ...], full: bool) -> None:
        self.model, self.numbers, self.full = model, numbers, full
        self.waves = TubeWaves(model)
        parities = (WHOLE,) if full else (EVEN, ODD)
        families = [Wave(n, parity) for n in numbers for parity in parities]
        # The axisymmetric waves of the unknowns' own symmetry are those of the equilibrium equations.
        self.wave_numbers = [w for w in families if w.n or w.parity == ODD]
        self.columns = (*EXTREMES, *(name for n in numbers for name in eigenvalue_names(n)))
        self._own = Stability(model.system)

    def variation(self, wave: Wave) -> SecondVariation:
        """The operator of a family."""
        return self.waves.operator(wave.n, AT_MIDDLE[wave.parity], everywhere=() if wave.n else (HOOP,))

    def observe(self) -> dict[str, float]:
        """The columns, and the lowest eigenvalue in the symmetry of the unknowns, ``eigenvalue_1``."""
        with self.model.system.weighed_here():
            own = judged(self._own, self.model.system.state(), LOWEST).eigenvalues
        out = {"eigenvalue_1": own[0], **dict(zip(EXTREMES, self.least_resultant(), strict=True))}
        for n in self.numbers:
            found = [] if n else list(own)
            for wave in self.wave_numbers:
                if wave.n == n:
                    found += self.variation(wave).spectrum(LOWEST).eigenvalues
            out |= dict(zip(eigenvalue_names(n), sorted(found), strict=False))
        return out

    def least_resultant(self) -> tuple[float, float]:
        """Smallest of both principal resultants anywhere, and its distance ``|Z|`` from the mid-plane."""
        value, x, _ = self.model.tension.least()
        return value, self.model.tension.place(x, {})

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
