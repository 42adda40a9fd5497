r"""Bent states of a tube of liquid that bears no compression: taut at first, wrinkled further on.

The energy is that of a tension field on the surface (:mod:`weakforms.forms.wrinkling`). Where the branch
begins the tube must be taut, so that its bifurcation is that of the law. Where a bent tube would be
compressed, beside the lower ring or above the liquid, it wrinkles; fronts lie inside of elements.

A wrinkled part under pressure resists no short wave across its tension. The longest of them fits when this
part is large enough, on a finer mesh earlier than on a coarse one. There the branch ends, as that of a tube
of gas does (:mod:`weakforms.problems.tube.secondary.wrinkled`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import ClassVar

import numpy as np
from scipy.interpolate import CubicSpline

from weakforms.errors import AbsentError
from weakforms.problems.liquid_tube.bent.branch import SecondaryBranch
from weakforms.problems.liquid_tube.bent.family import SecondaryFamily
from weakforms.problems.liquid_tube.critical import AxisymmetricState
from weakforms.problems.meridian.kinks import FRACTION, KinkedFamily
from weakforms.results import Quantity
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import Solved


class RelaxedSecondaryBranch(SecondaryBranch):
    """The branch on one mesh, as long as no short wave changes its stability."""

    def follow(self) -> None:
        """Trace the branch to its end, or up to the last point before a wave changes its stability."""
        self._before, self._ripples = self.points[0], False
        super().follow()
        if self._ripples:
            del self.points[-1]
            self.ended = (
                f"relaxed bent states were followed down to zw = {self.points[-1].state.loads['zw']:.6g}: "
                "beyond, their stability changes without a limit point, as by short waves of the wrinkled "
                "part, of which a finer mesh has more; raise secondary_end"
            )

    def ends(self, point: CurvePoint) -> bool:
        """As of any such branch, or because a wave changes the stability of a wrinkled state before it."""
        last, self._before = self._before, point
        turned = last.tangent.loads["zw"] * point.tangent.loads["zw"] < 0
        differ = last is not self.points[0] and abs(point.n_negative - last.n_negative) != turned
        self._ripples = differ and point.monitors[FRACTION] > 0
        return self._ripples or super().ends(point)


class RelaxedSecondaryFamily(KinkedFamily, SecondaryFamily):
    """The branch on a family of meshes."""

    fine: RelaxedSecondaryBranch
    levels: list[RelaxedSecondaryBranch]
    of: ClassVar[type[SecondaryBranch]] = RelaxedSecondaryBranch

    @classmethod
    def require_start(cls, begin: AxisymmetricState) -> None:
        r"""Refuse a bifurcation at which the tube is wrinkled, :math:`\lambda_2\sqrt{\lambda_1} < 1`.

        Raises:
            AbsentError: If it is.
        """
        slopes = (CubicSpline(begin.Z, part)(begin.Z, 1) for part in (begin.r, begin.z))
        if np.min(begin.r * np.hypot(*slopes) ** 0.5) < 1:
            raise AbsentError(
                "secondary branch",
                f"energy = 'relaxed': at zw = {begin.values['zw']:.6g}, where its n = 1 bifurcation is, the "
                "tube would be compressed; relaxed bent states begin where it is taut; raise delta, lower L, "
                "or set energy = 'standard'",
            )

    @cached_property
    def compressed(self) -> bool:
        """Whether a state is wrinkled, so that inertia may depend on the mesh."""
        return any(point.monitors[FRACTION] > 0 for point in self.levels[0].points)

    def _lowest(self, solved: Sequence[Solved]) -> dict[str, Quantity]:
        """As of any bent state; a parabola through points of a grid falls below zero in a wrinkled part."""
        found = super()._lowest(solved)
        return found | {"T_min": replace(found["T_min"], value=max(0.0, found["T_min"].value))}

    def _lowest_eigenvalue(self, solved: Sequence[Solved]) -> dict[str, Quantity]:
        """None: the eigenvalues of short waves of a wrinkled part under pressure do not converge."""
        self.warnings.append(
            f"secondary branch, zw = {solved[-1].values['zw']:.6g}: the tube is or may be wrinkled "
            "(wrinkled_fraction, T_min), and the meshes do not agree on its stability, of which nothing is "
            "said"
        )
        return {}
