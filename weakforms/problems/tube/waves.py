r"""The tube's stability against waves of any symmetry: bending, bulges that move, wrinkles.

The families are those of :mod:`weakforms.problems.meridian.families`, with the mid-plane as the mirror of
half the tube. A bent tube is ``n = 1``, even; a bulge that moves to one end is ``n = 0``, odd.

.. math:: K x = \Lambda M x, \qquad
          x^T M x = \int (u^2 + q^2 + w^2)\, \mathrm dZ \quad\text{(the mass of the axisymmetric states too)}
"""

from __future__ import annotations

from weakforms.problems.meridian.families import EVEN, ODD, WHOLE, Wave, WaveModes
from weakforms.problems.meridian.waves import AXIAL, CLAMPED, HOOP, RADIAL, MeridianWaves
from weakforms.problems.tube.model import TubeModel
from weakforms.solvers.stability.modes import SecondVariation

AT_MIDDLE = {EVEN: (AXIAL,), ODD: (RADIAL, HOOP), WHOLE: CLAMPED}
"""Components that are zero at the first end: the mid-plane, or the disk of a whole tube."""

EXTREMES = ("t_min", "Z_t_min")
"""Columns: the smallest principal resultant of a state, and where it is."""


class TubeWaves(MeridianWaves):
    """Second variations with the mass of the tube, ``int |dx|^2 dZ``."""

    def density(self) -> float:
        """One per ``Z``."""
        return 1.0


class TubeModes(WaveModes):
    """Quantities along a branch: eigenvalues by wave number, and the smallest principal resultant.

    Args:
        model: The tube.
        numbers: Wave numbers; 0 stands for axisymmetric waves.
        full: Whether the tube is the whole one.
    """

    def __init__(self, model: TubeModel, numbers: tuple[int, ...], full: bool) -> None:
        super().__init__(model, numbers, full)
        self.waves = TubeWaves(model)
        self.columns = (*EXTREMES, *self.columns)

    def variation(self, wave: Wave) -> SecondVariation:
        """The operator of a family."""
        return self.waves.operator(wave.n, AT_MIDDLE[wave.parity], everywhere=() if wave.n else (HOOP,))

    def observe(self) -> dict[str, float]:
        """The eigenvalues and the extremes."""
        return super().observe() | dict(zip(EXTREMES, self.least_resultant(), strict=True))

    def least_resultant(self) -> tuple[float, float]:
        """Smallest of both principal resultants anywhere, and its distance ``|Z|`` from the mid-plane."""
        value, x, _ = self.model.tension.least()
        return value, self.model.tension.place(x, {})
