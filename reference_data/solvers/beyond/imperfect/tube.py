"""The tubes, and their axisymmetric states as first guesses."""

from __future__ import annotations

from dataclasses import dataclass

from reference_data.solvers.paper3.common import critical
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.galerkin import Shape

STOP = 200.0
"""Volume up to which the axisymmetric branch is followed."""


@dataclass(frozen=True)
class Imperfect:
    """A tube that bends or flattens in one mode, and the imperfection that takes its bifurcation apart.

    Attributes:
        tube: The tube and its liquid.
        n: Number of waves around its axis.
        tilted: Whether gravity is tilted, by degrees; else the thickness is 1 + e cos(n Theta).
    """

    tube: FluidTube
    n: int
    tilted: bool

    def near(self) -> Shape:
        """The axisymmetric state at the bifurcation, by another code."""
        return critical(self.tube, STOP, (self.n,))[self.n][1][1]
