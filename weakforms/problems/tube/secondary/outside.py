r"""Stability of bent states, inside and outside of their own symmetry.

A state has the mirrors ``Theta = 0`` and ``pi/n`` and that at mid-length. Displacements of other parities
about them do not mix in the second variation with those of the states' own class nor with each other. Each
class has a matrix on the same mesh, with conditions of its own on the mirrors, and the inertia of this matrix
is its number of negative eigenvalues. A class that is odd about one of the mirrors does not change the volume
to first order: its number is the same at fixed pressure and at fixed volume.

The state may be turned about the axis. This displacement, :math:`t = -x_{,\Theta}` in the turning frame, is
odd about both meridians and even about mid-length, and needs no energy. Its eigenvalue is zero, and the
computed one, of either sign, shows the error. The count is therefore that on the displacements normal to it,
:math:`b^T q = 0` with :math:`b_i = \int t\cdot\varphi_i`: the inertia of :math:`(K, b; b^T, 0)` less one
negative eigenvalue. That ``t`` is a zero mode is tested by its overlap with :math:`K^{-1} b`, which such a
mode dominates.

With ``n = 1`` these classes are all displacements. With ``n = 2`` those that change sign from one wave to the
next, odd about one of the meridians and even about the other, complete them. With more waves others are left
out, and no total is given.

The gas inside may have a given mass instead, :mod:`weakforms.problems.gas`. As with a given volume, this
holds back displacements of the states' own class only.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.gas import Gas
from weakforms.problems.meridian.families import Wave
from weakforms.problems.tube.secondary.surface import EVEN, ODD, TURN, TURNING, BentTube, Parities
from weakforms.solvers.stability.modes import SecondVariation, across, judged, rated
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.support.least import Least

TURNED = Parities(ODD, ODD, EVEN)
"""The class of the rotation."""

CLASSES = {
    "n_negative_even_odd": (Parities(EVEN, EVEN, ODD),),
    "n_negative_odd_even": (TURNED,),
    "n_negative_odd_odd": (Parities(ODD, ODD, ODD),),
}
"""Columns of the classes that repeat with the pattern, by parity about the meridians and about mid-length."""

ALTERNATING = {
    "n_negative_alternating": tuple(
        Parities(first, last, middle) for middle in (EVEN, ODD) for first, last in ((EVEN, ODD), (ODD, EVEN))
    )
}
"""Column of those that change sign from one wave to the next."""

WHOLE = {1: CLASSES, 2: CLASSES | ALTERNATING}
"""All classes outside of the states' own, for the numbers of waves for which they are all displacements."""

LIKENESS = 0.9
"""Smallest accepted overlap between the rotation and ``K^-1 b``: of a zero mode it is 1."""

SMALLEST_TURN = 1e-6
"""Root mean square of the rotation below which there is no pattern to turn: at the crossing."""


class BentModes:
    """Stability of bent states by classes, and the smallest principal resultant.

    Args:
        model: The surface.
        gas: The gas inside, if its mass is to be held.
    """

    wave_numbers: Sequence[Wave] = ()
    columns: Sequence[str] = ("t_min", "Lambda_rotation", "m")
    full = False

    def __init__(self, model: BentTube, gas: Gas) -> None:
        self.model, self.gas, self._own = model, gas, Stability(model.system)
        self._classes = WHOLE.get(model.n, CLASSES)
        self._variations: dict[Parities, SecondVariation] = {}
        self._least = Least(model.unknown, model.principal_resultants())

    def observe(self) -> dict[str, float]:
        """The states' lowest eigenvalue, the smallest resultant, the rotation's eigenvalue, the mass."""
        own = judged(self._own, self.model.system.state(), 1).eigenvalues[0]
        least, (_, rotation) = self.least_resultant()[0], self.turned()
        mass = self.gas.mass(*self._inside())
        return {"eigenvalue_1": own, "t_min": least, "Lambda_rotation": rotation, "m": mass}

    def _inside(self) -> tuple[float, float]:
        """Pressure and volume."""
        return self.model.system.load("p"), self.model.system.monitor("V")

    def least_resultant(self) -> tuple[float]:
        """Smallest of both principal resultants anywhere."""
        return (self._least(),)

    def variation(self, parities: Parities) -> SecondVariation:
        """The operator of a class, made when first used."""
        if parities not in self._variations:
            self._variations[parities] = self.model.variation(parities)
        return self._variations[parities]

    def counts(self, own: int | None = None) -> dict[str, int]:
        """Negative eigenvalues at fixed volume and mass, of the other classes, and of all, by inertia.

        Args:
            own: Number in the states' own class at fixed pressure, if it is known.

        Raises:
            ConvergenceError: If the rotation of the pattern is no zero mode.
        """
        here = rated(self.model.system, self._own.factor, "p")
        held = {
            "volume": here.count_at_fixed,
            "mass": self.gas.count(here.count, *self._inside(), here.rate),
        }
        out = {f"n_negative_{what}": count for what, count in held.items()}
        out |= {name: sum(map(self._count, parts)) for name, parts in self._classes.items()}
        if self.model.n in WHOLE:
            rest = sum(out[name] for name in self._classes)
            out["n_negative_all"] = rest + (here.count if own is None else own)
            out |= {f"n_negative_all_{what}": rest + count for what, count in held.items()}
        return out

    def _count(self, parities: Parities) -> int:
        return self.turned()[0] if parities == TURNED else self.variation(parities).negative_count()

    def turned(self) -> tuple[int, float]:
        """Negative eigenvalues in the class of the rotation without it, and the eigenvalue of the rotation.

        The latter is zero at the crossing, where there is no pattern to turn.

        Raises:
            ConvergenceError: If the rotation is no zero mode.
        """
        variation = self.variation(TURNED)
        dual, _ = variation.monitor_gradient(TURNING, ())
        square, found = variation.monitor(TURN), across(variation, variation.factor, dual)
        if np.sqrt(square / self.model.length) < SMALLEST_TURN:
            return found.count_at_fixed, 0.0
        answer = variation.factor.solve(dual)
        largest = np.sqrt(square * variation.dot(answer, variation.mass_times(answer)))
        if not abs(found.rate) > LIKENESS * largest:
            raise ConvergenceError(
                "stability: the rotation of the pattern about the axis is not a zero mode, overlap "
                f"{abs(found.rate) / largest:.2f}: raise secondary_cells or secondary_around"
            )
        return found.count_at_fixed, float(square / found.rate)
