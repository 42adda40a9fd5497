r"""Lopsided states of the free tube: the branch on which the bulge moves towards one end.

It leaves free inflation where a state loses its mirror symmetry about mid-length. Its amplitude is the axial
displacement of the mid-plane,

.. math:: ξ = w_{mid} = η(0),

positive here; the mirror image of the branch has the opposite sign.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

from weakforms.problems.meridian.limits import limit_along
from weakforms.problems.tube.model import UNEVEN, TubeModel, yielding, yields
from weakforms.problems.tube.secondary.crossed import CrossedFamily, FlaggedBranch, require_crossings
from weakforms.problems.tube.stability import TubeBranch, TubeFamily
from weakforms.problems.tube.waves import TubeModes
from weakforms.results import Quantity
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System

AMPLITUDE = "w_mid"
"""Column of the amplitude."""

CROSSED = "bifurcation_point"
"""Kind of the points where the mirror symmetry breaks on a whole tube's branch."""

ACROSS = "V", AMPLITUDE
"""Columns of the plane in which meshes are compared: one of them changes at every point of the branch."""

LOST = "the mirror symmetry breaks", "delta1 or lf"
"""What happens at a crossing, and parameters that may give one."""


class WholeTube(TubeModel):
    """The whole tube with its amplitude as a column."""

    hidden = (AMPLITUDE,)

    def formulation(self) -> Formulation:
        """The weak form of the tube, with the axial displacement of the mid-plane."""
        given = super().formulation()
        return replace(given, monitors={**given.monitors, AMPLITUDE: self.at_middle(self.expressions["z"])})


class LopsidedBranch(FlaggedBranch):
    """The branch on one mesh, that of free inflation of the whole tube."""

    kind, amplitude, imperfection, called = "mirror_breaking", AMPLITUDE, UNEVEN, "lopsided"
    family: ClassVar = {"n": 0.0, "parity": -1.0}

    def __init__(
        self,
        primary: TubeBranch,
        crossings: Sequence[Solved],
        begin: int,
        step: float,
        side: float = 1.0,
        own: tuple[System, TubeModes] | None = None,
    ) -> None:
        super().__init__(primary, crossings, begin, step, side, own)
        self.end_at_limit(primary.limit if own is None else limit_along(own[1].model))
        if yields(self.points[-1]):
            self.ended = f"the lopsided branch ends: {yielding(self.points[-1])}"

    @classmethod
    def ending(
        cls, primary: TubeBranch, side: float, most: float | None = None
    ) -> Callable[[CurvePoint], bool]:
        """As for any branch beside free inflation, or where the law gives way."""
        stop = super().ending(primary, side, most)
        return lambda point: stop(point) or yields(point)


class LopsidedFamily(CrossedFamily, TubeFamily):
    """The branch on all meshes, with the coefficients of an uneven tube's laws."""

    fine: LopsidedBranch
    levels: list[LopsidedBranch]

    def curvatures(self) -> Mapping[str, Quantity]:
        """Besides, the force of an uneven thickness and the coefficients of the two-thirds laws."""
        found = [level.expansion for level in self.levels]
        rows = {"B": [expansion.push for expansion in found]}
        for name, part in {"p_s": "load", "V_s": "conjugate"}.items():
            rows[name] = [expansion.two_thirds[part] for expansion in found]
        return {**super().curvatures(), **self.estimated(rows)}


def lopsided_family(
    primary: TubeFamily,
    number: int,
    step: float,
    progress: Callable[[str, int, int], None],
) -> LopsidedFamily:
    """The branch from one crossing on all meshes of free inflation.

    Args:
        primary: Free inflation of the whole tube.
        number: The crossing, counted from 1 along free inflation.
        step: Largest step.
        progress: Says which mesh is solved on.

    Raises:
        AbsentError: If there are not as many crossings.
    """
    crossings = primary.located(CROSSED)
    require_crossings(len(crossings), number, primary.fine, *LOST)

    def make(level: int) -> LopsidedBranch:
        progress("lopsided branch", level, len(primary.levels))
        on_mesh = [same[level] for same in crossings]
        return LopsidedBranch(primary.levels[level], on_mesh, number - 1, step)

    return LopsidedFamily(make, len(primary.levels), primary.cap, ACROSS, "secondary", primary.caps)
