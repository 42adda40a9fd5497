r"""Free inflation of a tube that cannot bear compression: it wrinkles around the axis beside the disks.

The relaxed energy is that of the law where :math:`g_w = \lambda_2\sqrt{\lambda_1} > 1`, and
:math:`w_R(\lambda_1) = w(\lambda_1, \lambda_1^{-1/2})` elsewhere. Up to the first state with ``gw = 1`` at
some place the branch is that of the law. From there on the mesh follows both ends of the wrinkled zone, two
scalar unknowns with the equations ``gw = 1``; a whole tube has a zone at either disk. Where the zone closes
again, the tube is taut and the branch is that of the law once more.
"""

from __future__ import annotations

from functools import cached_property

from mpi4py import MPI

from weakforms.errors import AbsentError
from weakforms.problems.contact.guesses import transferred
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import Blocks, both_ends, mirrored, one_end
from weakforms.problems.meridian.limits import limit_along
from weakforms.problems.tube.folds import (
    FRONTS,
    Folds,
    Verge,
    at_disk,
    cut,
    follow,
    opening,
    unlike,
    zone_breaks,
)
from weakforms.problems.tube.model import USUAL_LOAD, TubeMesh, TubeModel, free_branch, yielding, yields
from weakforms.problems.tube.parameters import TubeParameters
from weakforms.solvers.continuation.branch import EquilibriumBranch, MirroredBranch
from weakforms.solvers.continuation.continuation import CurvePoint, StepControl
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.state import State


class FoldedTube(Folds):
    """Weak form of the tube with a mesh that follows the ends of its wrinkled zone.

    Loads: ``p``, ``delta1`` and the fronts ``Z_front_1 < Z_front_2``; a whole tube has their mirror images
    too, ``Z_front_1_lower`` and ``Z_front_2_lower``.

    Args:
        comm: Ranks.
        material: The law.
        delta1: Pre-stretch.
        lf: Length.
        at: Its mesh; every block has as many cells.
        to_disk: Whether the zone ends at the disk, and not before.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        material: Chosen,
        delta1: float,
        lf: float,
        at: TubeMesh,
        to_disk: bool = False,
    ) -> None:
        half, inside = lf / 2, 1 if to_disk else 2
        breaks = [0.0, *zone_breaks(half, to_disk), half]
        grading = [one_end(at.grading), *[both_ends(0.0)] * inside]
        ends = dict(zip(FRONTS, range(1, inside + 1), strict=False))
        if at.full:
            grading = [*(mirrored(block) for block in reversed(grading)), *grading]
            breaks = [-s for s in breaks[:0:-1]] + breaks
            middle, sides = inside + 1, {"": 1, "_lower": -1}
            ends = {
                name + side: middle + sign * k for side, sign in sides.items() for name, k in ends.items()
            }
        mesh = Blocks(breaks, at.cells, at.degree, 2 * at.degree + 4, ends, grading)
        super().__init__(comm, material, {"p": 0.0, "delta1": delta1}, half, mesh, "relaxed")
        self.fold(to_disk)


class RelaxedTube:
    """Free inflation with the relaxed energy on one mesh, in parts; each is solved when it is first needed.

    Args:
        comm: Ranks.
        parameters: The tube.
        at: Its mesh.
        step: Largest arc-length step.
        finest: Whether it is the finest mesh, on which the states of all parts are judged.
    """

    def __init__(
        self, comm: MPI.Intracomm, parameters: TubeParameters, at: TubeMesh, step: float, finest: bool
    ) -> None:
        given = comm, parameters.material, parameters.delta1, parameters.lf, at
        self.taut, self._given = TubeModel.free(*given), given
        self.parameters, self.step, self.finest = parameters, step, finest
        self.verge = Verge(self.taut)

    # -- taut ----------------------------------------------------------------------------------

    @cached_property
    def free(self) -> EquilibriumBranch:
        """The taut tube, up to the first wrinkle if there is one."""
        branch = self._inflated(None)
        first = self.verge.first(branch)
        if first:
            self.onset = first[1]
            cut(branch, *first)
        return branch

    onset: Solved | None = None
    """The first wrinkle; known after :attr:`free`."""

    @cached_property
    def smooth(self) -> EquilibriumBranch:
        """The tube that is taut again, from where the zone closes."""
        last = self.wrinkled.points[-1]
        begin = transferred(self.folded, last.state, self.taut, {})
        branch = self._inflated((begin, Held("u_max", last.monitors["u_max"])))
        self.closing = self.verge.closing(branch, f"u_max = {last.monitors['u_max']:.6g}")
        second = self.verge.first(branch)
        if second:
            solved = second[1]
            cut(branch, *second)
            again = f"tube: at u_max = {solved.values['u_max']:.6g} it wrinkles for a second time"
            branch.stalled, branch.ended = None, f"{again}, which is not followed; lower u_end"
        return branch

    closing: Solved | None = None
    """Where the zone closes; known after :attr:`smooth`."""

    def _inflated(self, begin: tuple[State, Held] | None) -> EquilibriumBranch:
        limit, given = limit_along(self.taut), self.parameters
        inflation = self.taut.system, given.delta1, given.u_end, self.step
        branch = free_branch(*inflation, EquilibriumBranch, limit, begin)
        slack = self.verge.slack(branch.points) if self.finest else ()
        if len(slack):
            at = branch.points[slack[0]].monitors["u_max"]
            if slack[0] < 2:
                raise AbsentError(
                    "relaxed states", f"tube: at u_max = {at:.6g} its meridian is compressed; raise delta1"
                )
            del branch.points[slack[0] :]
            branch.stalled = None
            branch.ended = f"tube: at u_max = {at:.6g} its meridian is compressed; lower u_end"
        return branch

    # -- wrinkled ------------------------------------------------------------------------------

    @property
    def to_disk(self) -> bool:
        """Whether the first wrinkle is at the disk."""
        return at_disk(self.onset, self.taut.half)

    @cached_property
    def folded(self) -> FoldedTube:
        """The model of a tube with a wrinkled zone."""
        return FoldedTube(*self._given, self.to_disk)

    @cached_property
    def wrinkled(self) -> MirroredBranch:
        """The tube with a wrinkled zone, or with one at either disk."""
        model, end = self.folded, self.parameters.u_end

        def ends(point: CurvePoint) -> str:
            if yields(point):
                return yielding(point)
            return unlike(point) if self.finest else ""

        branch, self.closes, _, ended = follow(
            model,
            {},
            StepControl(self.step / 16, self.step, usual_load=USUAL_LOAD),
            opening(self.taut, self.onset, model),
            lambda point: point.monitors["u_max"] > end,
            ends,
        )
        last = branch.points[-1]
        followed = f"tube: wrinkled states were followed up to u_max = {last.monitors['u_max']:.6g}"
        if ended:
            branch.ended = f"{followed}: {ended}; lower u_end, or raise cells"
        elif branch.stalled:
            branch.stalled = f"{followed}: {branch.stalled}; lower u_end, or raise cells"
        return branch

    closes = False
    """Whether the zone closes before the end; known after :attr:`wrinkled`."""
