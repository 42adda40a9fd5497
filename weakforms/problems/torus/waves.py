r"""The torus's stability against waves of any symmetry, with the equatorial plane as the mirror.

The families are those of :mod:`weakforms.problems.meridian.families`. A free torus moves as a rigid body
without any energy: odd waves of ``n = 0`` shift it along the axis, even ones of ``n = 1`` across it, and odd
ones of ``n = 1`` tilt it. One component is therefore held at the outer equator. Each displacement of a free
torus has the energy of that with a rigid motion added which makes this component zero. The numbers of
negative eigenvalues, and states at which one is zero, are therefore those of the free torus.

.. math:: K x = \Lambda M x, \qquad
          x^T M x = \int (u^2 + q^2 + w^2)\, b R\, \mathrm dt
"""

from __future__ import annotations

from typing import ClassVar

from weakforms.problems.meridian.families import EVEN, ODD, Wave, WaveBranch, WaveModes
from weakforms.problems.meridian.waves import AXIAL, HOOP, RADIAL, MeridianWaves
from weakforms.problems.torus.model import TorusModel
from weakforms.solvers.stability.modes import SecondVariation

AT_EQUATORS = {EVEN: (AXIAL,), ODD: (RADIAL, HOOP)}
"""Components that are zero at both equators."""

PINNED = {Wave(0, ODD): (AXIAL,), Wave(1, EVEN): (HOOP,), Wave(1, ODD): (AXIAL,)}
"""A further one that is zero at the outer equator, so that the torus does not move as a rigid body."""


class TorusModes(WaveModes):
    """Eigenvalues by wave number.

    Args:
        model: The torus.
        numbers: Wave numbers; 0 stands for axisymmetric waves.
    """

    def __init__(self, model: TorusModel, numbers: tuple[int, ...]) -> None:
        super().__init__(model, numbers)
        self.waves = MeridianWaves(model)

    def variation(self, wave: Wave) -> SecondVariation:
        """The operator of a family."""
        mirror, torsion = AT_EQUATORS[wave.parity], () if wave.n else (HOOP,)
        return self.waves.operator(wave.n, (*mirror, *PINNED.get(wave, ())), mirror, torsion)


class TorusBranch(WaveBranch):
    """Inflation with the stability against waves."""

    along: ClassVar = "v"
