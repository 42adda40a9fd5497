r"""Free inflation of a tube that cannot bear compression: it wrinkles around the axis beside the disks.

The relaxed energy is that of the law where :math:`g_w = \lambda_2\sqrt{\lambda_1} > 1`, and
:math:`w_R(\lambda_1) = w(\lambda_1, \lambda_1^{-1/2})` elsewhere. Up to the first state with ``gw = 1`` at
some place the branch is that of the law. From there on the mesh follows both ends of the wrinkled zone, two
scalar unknowns with the equations ``gw = 1``; a whole tube has a zone at either disk. Where the zone closes
again, the tube is taut and the branch is that of the law once more.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from itertools import pairwise

import numpy as np
import ufl
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.forms.wrinkling import wrinkling_function
from weakforms.problems.contact.guesses import transferred
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import BREAK, Blocks, both_ends, mirrored, one_end
from weakforms.problems.meridian.compression import ONSET
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.limits import limit_along
from weakforms.problems.meridian.model import TAUT, WET, WRINKLED, Marks
from weakforms.problems.tube.model import USUAL_LOAD, TubeMesh, TubeModel, free_branch, yielding, yields
from weakforms.problems.tube.parameters import TubeParameters
from weakforms.solvers.continuation.branch import EquilibriumBranch, MirroredBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

SMALLEST, AT_DISK = 2e-3, 2e-5
"""Fraction of the length of the smallest wrinkled zone that is followed, inside and at the disk. Inside a
zone opens with the root of what ``u_max`` has grown by, at the disk in proportion to it."""

VERGE = 1e-9
"""Deviation of ``gw`` from 1 that counts as zero: without pressure a pre-stretched tube has ``gw = 1``."""

MISFIT = 1e-5
"""Deviation of ``gw`` to the wrong side of 1 on the finest mesh beyond which another zone opens; below it is
the mesh's error."""

CLOSED = 0.999
"""Share of the smallest zone below which it closes."""

FRONTS = ("Z_front_1", "Z_front_2")
FRACTION = "wrinkled_fraction"


class FoldedTube(TubeModel):
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
        half, self.smallest, inside = (lf / 2, AT_DISK, 1) if to_disk else (lf / 2, SMALLEST, 2)
        breaks = [0.0, *(half * (1 - k * self.smallest) for k in range(inside, 0, -1)), half]
        states, grading = (
            [TAUT, WRINKLED, TAUT][: inside + 1],
            [one_end(at.grading), *[both_ends(0.0)] * inside],
        )
        ends = dict(zip(FRONTS, range(1, inside + 1), strict=False))
        if at.full:
            grading = [*(mirrored(block) for block in reversed(grading)), *grading]
            breaks = [-s for s in breaks[:0:-1]] + breaks
            middle, states = len(states), [*reversed(states), *states]
            sides = {"": 1, "_lower": -1}
            ends = {
                name + side: middle + sign * k for side, sign in sides.items() for name, k in ends.items()
            }
        self.gaps = {name: f"gap_{name}" for name in ends}
        mesh = Blocks(breaks, at.cells, at.degree, 2 * at.degree + 4, ends, grading)
        super().__init__(comm, material, {"p": 0.0, "delta1": delta1}, half, mesh, "relaxed")
        self.marks = Marks(np.array(states), np.full(self.blocks, WET))

    @cached_property
    def gw(self) -> Expr:
        """The wrinkling function, 1 at both ends of a zone."""
        return gw_of(self)

    def formulation(self) -> Formulation:
        """The weak form with the equations of the fronts, and how far any block is from its own state."""
        given, taut = super().formulation(), ufl.gt(self._by_cell["taut"], 0.0)
        places = {name: self.inner(BREAK + k - 1) for name, k in self.fronts.items()}
        share = ufl.conditional(taut, 0.0, 1.0) / (self.breaks[-1] - self.breaks[0])
        return replace(
            given,
            monitors={
                **given.monitors,
                FRACTION: share * self.expressions["width"] * self.dx,
                **{self.gaps[name]: ufl.avg(self.gw - 1) * at for name, at in places.items()},
            },
            maxima={
                "misfit": ufl.conditional(taut, 1 - self.gw, self.gw - 1),
                "slack": ufl.conditional(taut, 1 - across_of(self), 1 - self.expressions["lam1"]),
            },
            mark=self.mark,
            internal=(
                *given.internal,
                *(name for name in self.fronts if name not in FRONTS),
                *self.gaps.values(),
                "misfit",
                "slack",
            ),
        )


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
        self._meridian = Meridian(self.taut, {"gw": gw_of(self.taut), "across": across_of(self.taut)})

    # -- taut ----------------------------------------------------------------------------------

    @cached_property
    def free(self) -> EquilibriumBranch:
        """The taut tube, up to the first wrinkle if there is one."""
        branch = self._inflated(None)
        at = self._touching(branch)
        if at:
            i, self.onset = at[0], self._touch(branch, at[0])
            branch.points[i + 1 :] = [_point(branch, i, self.onset)]
            branch.stalled = branch.ended = None
        return branch

    onset: Solved | None = None
    """The first wrinkle; known after :attr:`free`."""

    @cached_property
    def smooth(self) -> EquilibriumBranch:
        """The tube that is taut again, from where the zone closes."""
        last = self.wrinkled.points[-1]
        begin = transferred(self.folded, last.state, self.taut, {})
        branch = self._inflated((begin, Held("u_max", last.monitors["u_max"])))
        at = self._touching(branch)
        if not at or at[0] > 0:
            raise ConvergenceError(
                f"tube: the wrinkled zone closes after u_max = {last.monitors['u_max']:.6g}, but the tube "
                "does not become taut there; raise cells"
            )
        self.closing = self._touch(branch, 0)
        branch.points[0] = _point(branch, 0, self.closing)
        if len(at) > 1:
            solved = self._touch(branch, at[1])
            branch.points[at[1] + 1 :] = [_point(branch, at[1], solved)]
            again = f"tube: at u_max = {solved.values['u_max']:.6g} it wrinkles for a second time"
            branch.stalled, branch.ended = None, f"{again}, which is not followed; lower u_end"
        return branch

    closing: Solved | None = None
    """Where the zone closes; known after :attr:`smooth`."""

    def _inflated(self, begin: tuple[State, Held] | None) -> EquilibriumBranch:
        limit, given = limit_along(self.taut), self.parameters
        inflation = self.taut.system, given.delta1, given.u_end, self.step
        branch = free_branch(*inflation, EquilibriumBranch, limit, begin)
        across = [self.least(point.state, "across")[0] for point in branch.points]
        slack = np.flatnonzero(np.array(across) < -VERGE)
        if self.finest and len(slack):
            at = branch.points[slack[0]].monitors["u_max"]
            if slack[0] < 2:
                raise AbsentError(
                    "relaxed states", f"tube: at u_max = {at:.6g} its meridian is compressed; raise delta1"
                )
            del branch.points[slack[0] :]
            branch.stalled = None
            branch.ended = f"tube: at u_max = {at:.6g} its meridian is compressed; lower u_end"
        return branch

    def least(self, state: State, name: str = "gw") -> tuple[float, float]:
        """Smallest ``gw - 1`` of a state of the taut tube, and the distance of its place from mid-length."""
        with self.taut.system.at(state):
            value, x = self._meridian.extreme_at(name, -1)
        return value - 1, abs(float(self.taut.material(np.array([x]), {})[0]))

    def _touching(self, branch: EquilibriumBranch) -> list[int]:
        """Points of a trace after which the smallest ``gw - 1`` changes its sign."""
        least = np.array([self.least(point.state)[0] for point in branch.points])
        sign = np.where(np.abs(least) > VERGE, np.sign(least), 0.0)
        known = np.flatnonzero(sign)
        return [int(j) - 1 for i, j in pairwise(known) if sign[i] * sign[j] < 0]

    def _touch(self, branch: EquilibriumBranch, i: int) -> Solved:
        """The state between two points of a trace at which ``gw`` just reaches 1, with its place."""
        found = branch.zero(i, lambda solved: self.least(solved.state)[0], ONSET)
        place = self.least(found.state)[1]
        return replace(found, values=found.values | dict.fromkeys(FRONTS, place))

    # -- wrinkled ------------------------------------------------------------------------------

    @property
    def to_disk(self) -> bool:
        """Whether the first wrinkle is at the disk."""
        return self.onset.values[FRONTS[0]] > (1 - SMALLEST / 2) * self.taut.half

    @cached_property
    def folded(self) -> FoldedTube:
        """The model of a tube with a wrinkled zone."""
        return FoldedTube(*self._given, self.to_disk)

    @cached_property
    def wrinkled(self) -> MirroredBranch:
        """The tube with a wrinkled zone, or with one at either disk."""
        model, place, half = self.folded, self.onset.values[FRONTS[0]], self.taut.half
        apart = model.smallest * half / (1 if self.to_disk else 2)
        near = dict(zip(FRONTS, (place - apart, place + apart), strict=True))
        near |= {f"{name}_lower": -z for name, z in near.items()}
        fronts = {name: near[name] for name in model.fronts}
        continuation = Continuation(
            ExtendedNewton(model.system, ["p", *model.fronts]),
            [Held(gap, 0.0) for gap in model.gaps.values()],
            StepControl(self.step / 16, self.step, usual_load=USUAL_LOAD),
            allowed=lambda state: bool(np.all(np.diff(model.breaks_of(state.loads)) > 0)),
        )
        begin = replace(transferred(self.taut, self.onset.state, model, fronts), marks=model.marks)
        start = continuation.start(begin, Held(FRACTION, model.smallest), towards={FRACTION: 1.0})
        end = self.parameters.u_end

        def closes(point: CurvePoint) -> bool:
            return point.monitors[FRACTION] < CLOSED * model.smallest

        def ends(point: CurvePoint) -> str:
            if yields(point):
                return yielding(point)
            if self.finest and point.monitors["misfit"] > MISFIT:
                return "another part of it wrinkles, or becomes taut, which is not followed"
            if self.finest and point.monitors["slack"] > MISFIT:
                return "a part of it has no tension along the meridian, which is not followed"
            return ""

        def stop(point: CurvePoint) -> bool:
            return point.monitors["u_max"] > end or closes(point) or bool(ends(point))

        branch = MirroredBranch(continuation, "p", start, stop)
        last = branch.points[-1]
        self.closes = closes(last)
        followed = f"tube: wrinkled states were followed up to u_max = {last.monitors['u_max']:.6g}"
        if self.closes:
            branch.end_at(FRACTION, model.smallest)
        elif ends(last):
            branch.ended = f"{followed}: {ends(last)}; lower u_end, or raise cells"
        elif branch.stalled:
            branch.stalled = f"{followed}: {branch.stalled}; lower u_end, or raise cells"
        return branch

    closes = False
    """Whether the zone closes before the end; known after :attr:`wrinkled`."""


def gw_of(model: TubeModel) -> Expr:
    """The wrinkling function of a tube."""
    return wrinkling_function(model.expressions["lam1"], model.expressions["lam2"])


def across_of(model: TubeModel) -> Expr:
    """The same with the stretches exchanged: below 1 a taut tube is compressed along the meridian."""
    return wrinkling_function(model.expressions["lam2"], model.expressions["lam1"])


def _point(branch: EquilibriumBranch, i: int, solved: Solved) -> CurvePoint:
    """A state that was solved for after a point of a trace, as a point of it."""
    before, after = branch.points[i : i + 2]
    arclength = before.arclength + branch.continuation.distance(solved.state, before.state)
    return branch.continuation.point(solved.state, after.record, before.tangent, arclength)
