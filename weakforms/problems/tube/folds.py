"""A wrinkled zone of a tube: its ends on the mesh, and where a taut tube begins to wrinkle."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import ufl
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError
from weakforms.forms.wrinkling import wrinkling_function
from weakforms.problems.contact.guesses import transferred
from weakforms.problems.meridian.blocks import BREAK, UPPER
from weakforms.problems.meridian.compression import ONSET
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.kinks import FRACTION
from weakforms.problems.meridian.model import TAUT, WET, WRINKLED, Marks
from weakforms.problems.tube.model import TubeModel
from weakforms.solvers.continuation.branch import MirroredBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

SMALLEST, AT_DISK = 2e-3, 2e-5
"""Fraction of the length of the smallest wrinkled zone that is followed, inside and at the disk. Inside a
zone opens with the root of what ``u_max`` has grown by, at the disk in proportion to it."""

LEFT = 2e-4
"""Fraction of the length by which a zone that leaves the disk has left it when it is followed again."""

VERGE = 1e-9
"""Deviation of ``gw`` from 1 that counts as zero: without pressure a pre-stretched tube has ``gw = 1``."""

MISFIT = 1e-5
"""Deviation of ``gw`` to the wrong side of 1 on the finest mesh beyond which another zone opens; below it is
the mesh's error."""

CLOSED = 0.999
"""Share of the smallest zone below which it closes."""

FRONTS = ("Z_front_1", "Z_front_2")
DISK = "gap_disk"
"""``gw - 1`` at the disk: where it grows above zero, a zone that ends at the disk leaves it."""


def zone_breaks(half: float, to_disk: bool) -> list[float]:
    """First positions of the ends of the smallest zone on half a tube, without the disk."""
    least, inside = (AT_DISK, 1) if to_disk else (SMALLEST, 2)
    return [half * (1 - k * least) for k in range(inside, 0, -1)]


class Folds(TubeModel):
    """What a model of the tube has besides, if break points of its mesh are the ends of a wrinkled zone.

    Such a model calls :meth:`fold` when its mesh is known.
    """

    def fold(self, to_disk: bool) -> None:
        """Mark the blocks of a zone that ends at the disk, or before; the whole tube has another one."""
        self.smallest = AT_DISK if to_disk else SMALLEST
        self.gaps = {name: f"gap_{name}" for name in self.fronts if name.startswith(FRONTS)}
        states = [WRINKLED] if to_disk else [WRINKLED, TAUT]
        full = self.breaks[0] < 0
        rest = self.blocks // (1 + full) - len(states)
        states = [TAUT] * rest + states
        states = [*reversed(states), *states] if full else states
        self.marks = Marks(np.array(states), np.full(self.blocks, WET))

    @cached_property
    def gw(self) -> Expr:
        """The wrinkling function, 1 at both ends of a zone."""
        return gw_of(self)

    def formulation(self) -> Formulation:
        """The weak form with the equations of the fronts, and how far any block is from its own state."""
        given, taut = super().formulation(), ufl.gt(self._by_cell["taut"], 0.0)
        places = {name: self.inner(BREAK + self.fronts[name] - 1) for name in self.gaps}
        share = ufl.conditional(taut, 0.0, 1.0) / (self.breaks[-1] - self.breaks[0])
        return replace(
            given,
            monitors={
                **given.monitors,
                FRACTION: share * self.expressions["width"] * self.dx,
                DISK: (self.gw - 1) * self.ends(UPPER),
                **{self.gaps[name]: ufl.avg(self.gw - 1) * at for name, at in places.items()},
            },
            maxima={
                **given.maxima,
                "misfit": ufl.conditional(taut, 1 - self.gw, self.gw - 1),
                "slack": ufl.conditional(taut, 1 - across_of(self), 1 - self.expressions["lam1"]),
            },
            mark=self.mark,
            internal=(
                *given.internal,
                *(name for name in self.gaps if name not in FRONTS),
                *self.gaps.values(),
                DISK,
                "misfit",
                "slack",
            ),
        )

    def first_fronts(self, place: float) -> dict[str, float]:
        """Guesses of the ends of the smallest zone about the place of the first wrinkle."""
        apart = self.smallest * self.half / (1 if self.smallest == AT_DISK else 2)
        return self.both_sides(dict(zip(FRONTS, (place - apart, place + apart), strict=True)))

    def both_sides(self, ends: Mapping[str, float]) -> dict[str, float]:
        """Positions of those ends that the mesh follows, with mirror images if the tube is whole."""
        near = {**ends, **{f"{name}_lower": -z for name, z in ends.items()}}
        return {name: near[name] for name in self.gaps if name in near}


class Verge:
    """Where the states of a model of the taut tube begin to wrinkle, or cease to.

    Args:
        model: The model.
    """

    def __init__(self, model: TubeModel) -> None:
        self.model = model
        self._meridian = Meridian(model, {"gw": gw_of(model), "across": across_of(model)})

    def least(self, state: State, name: str = "gw") -> tuple[float, float]:
        """Smallest ``gw - 1`` of a state of the taut tube, and the distance of its place from mid-length."""
        with self.model.system.at(state):
            value, x = self._meridian.extreme_at(name, -1)
        return value - 1, abs(float(self.model.material(np.array([x]), state.loads)[0]))

    def passed(self, branch: SolutionCurve) -> list[int]:
        """Points of a trace after which the smallest ``gw - 1`` changes its sign."""
        least = np.array([self.least(point.state)[0] for point in branch.points])
        sign = np.where(np.abs(least) > VERGE, np.sign(least), 0.0)
        known = np.flatnonzero(sign)
        return [int(j) - 1 for i, j in pairwise(known) if sign[i] * sign[j] < 0]

    def slack(self, points: Sequence[CurvePoint]) -> np.ndarray:
        """Indices of points at which the taut tube is compressed along the meridian."""
        across = [self.least(point.state, "across")[0] for point in points]
        return np.flatnonzero(np.array(across) < -VERGE)

    def first(self, branch: SolutionCurve) -> tuple[int, Solved] | None:
        """The first wrinkle of a trace, and the point before it, if there is one."""
        at = self.passed(branch)
        return (at[0], self.touch(branch, at[0])) if at else None

    def closing(self, branch: SolutionCurve, after: str) -> Solved:
        """The state at which the zone closes, from which on a trace is kept.

        Args:
            branch: A trace of the taut tube that begins with a zone which is smaller than is followed.
            after: The last wrinkled state, as text.

        Raises:
            ConvergenceError: If the tube does not become taut.
        """
        at = self.passed(branch)
        if not at or self.least(branch.points[0].state)[0] > 0:
            raise ConvergenceError(
                f"tube: the wrinkled zone closes after {after}, but the tube does not become taut there; "
                "raise cells"
            )
        found = self.touch(branch, at[0])
        branch.points[: at[0] + 1] = [point_at(branch, at[0], found)]
        return found

    def touch(self, branch: SolutionCurve, i: int) -> Solved:
        """The state between two points of a trace at which ``gw`` just reaches 1, with its place."""
        found = branch.zero(i, lambda solved: self.least(solved.state)[0], ONSET)
        place = self.least(found.state)[1]
        return replace(found, values=found.values | dict.fromkeys(FRONTS, place))


def at_disk(onset: Solved, half: float) -> bool:
    """Whether the first wrinkle is at the disk."""
    return onset.values[FRONTS[0]] > (1 - SMALLEST / 2) * half


def unlike(point: CurvePoint, misfit: float = MISFIT) -> str:
    """Why the marks of the blocks do not fit a wrinkled state, as text; empty if they do."""
    if point.monitors["misfit"] > misfit:
        return "another part of it wrinkles, or becomes taut, which is not followed"
    if point.monitors["slack"] > misfit:
        return "a part of it has no tension along the meridian, which is not followed"
    return ""


def gw_of(model: TubeModel) -> Expr:
    """The wrinkling function of a tube."""
    return wrinkling_function(model.expressions["lam1"], model.expressions["lam2"])


def across_of(model: TubeModel) -> Expr:
    """The same with the stretches exchanged: below 1 a taut tube is compressed along the meridian."""
    return wrinkling_function(model.expressions["lam2"], model.expressions["lam1"])


def point_at(branch: SolutionCurve, i: int, solved: Solved) -> CurvePoint:
    """A state that was solved for after a point of a trace, as a point of it."""
    before, after = branch.points[i : i + 2]
    arclength = before.arclength + branch.continuation.distance(solved.state, before.state)
    return branch.continuation.point(solved.state, after.record, before.tangent, arclength)


def cut(branch: SolutionCurve, i: int, solved: Solved) -> None:
    """End a trace at a state that was solved for after one of its points."""
    branch.points[i + 1 :] = [point_at(branch, i, solved)]
    branch.stalled = branch.ended = None


class Followed(NamedTuple):
    """States with a wrinkled zone."""

    branch: SolutionCurve
    closes: bool
    """Whether the zone closes at their end."""
    leaves: bool
    """Whether the zone leaves the disk there."""
    ended: str
    """Why they end before what was asked for, as text; empty if they do not."""


def opening(taut: TubeModel, wrinkle: Solved, model: Folds) -> Callable[[Continuation], CurvePoint]:
    """Finds the first state with a zone, the smallest one that is followed, from the first wrinkle.

    Args:
        taut: The model of the taut tube.
        wrinkle: Its first wrinkle.
        model: The model with a zone.

    Raises:
        ConvergenceError: When it is called, if there is no solution.
    """
    fronts = model.first_fronts(wrinkle.values[FRONTS[0]])
    begin = replace(transferred(taut, wrinkle.state, model, fronts), marks=model.marks)
    opens = f"opens at u_max = {wrinkle.values['u_max']:.6g}"
    return _start(begin, Held(FRACTION, model.smallest), {FRACTION: 1.0}, opens)


def leaving(before: Folds, last: State, model: Folds) -> Callable[[Continuation], CurvePoint]:
    """Finds the first state with a zone that has left the disk, from the last one at the disk.

    Args:
        before: The model with a zone that ends at the disk.
        last: Its last state.
        model: The model with a zone that ends before.

    Raises:
        ConvergenceError: When it is called, if there is no solution.
    """
    at = (1 - LEFT) * model.half
    fronts = model.both_sides({FRONTS[0]: last.loads[FRONTS[0]], FRONTS[1]: at})
    begin = replace(transferred(before, last, model, fronts), marks=model.marks)
    leaves = f"leaves the disk at p = {last.loads['p']:.6g}"
    return _start(begin, Held(FRONTS[1], at), {FRONTS[1]: -1.0}, leaves)


def _start(
    begin: State, held: Held, towards: dict[str, float], what: str
) -> Callable[[Continuation], CurvePoint]:
    def start(continuation: Continuation) -> CurvePoint:
        try:
            return continuation.start(begin, held, towards)
        except ConvergenceError as error:
            raise ConvergenceError(
                f"tube: the wrinkled zone that {what} is not found: {error}; raise cells"
            ) from error

    return start


def follow(
    model: Folds,
    edges: Mapping[str, str],
    steps: StepControl,
    start: Callable[[Continuation], CurvePoint],
    enough: Callable[[CurvePoint], bool],
    ends: Callable[[CurvePoint], str],
    kind: type[SolutionCurve] = MirroredBranch,
    to_disk: bool = False,
) -> Followed:
    """States with a wrinkled zone, up to what was asked for or to where the zone closes, or leaves the disk.

    Args:
        model: The model with a zone.
        edges: Further fronts that are unknowns, each with the functional that is zero there.
        steps: Step control.
        start: Finds the first state.
        enough: Whether a point is beyond what was asked for.
        ends: Why states are not followed beyond a point, as text; empty if they are.
        kind: Class of the branch.
        to_disk: Whether the zone ends at the disk, and its states are asked for until it leaves it.
    """
    continuation = Continuation(
        ExtendedNewton(model.system, ["p", *edges, *model.gaps]),
        [Held(gap, 0.0) for gap in (*edges.values(), *model.gaps.values())],
        steps,
        allowed=lambda state: bool(np.all(np.diff(model.breaks_of(state.loads)) > 0)),
    )

    def closes(point: CurvePoint) -> bool:
        return point.monitors[FRACTION] < CLOSED * model.smallest

    def leaves(point: CurvePoint) -> bool:
        return to_disk and point.monitors[DISK] > 0

    def stop(point: CurvePoint) -> bool:
        return enough(point) or closes(point) or leaves(point) or bool(ends(point))

    branch = kind(continuation, "p", start(continuation), stop)
    closed, left = closes(branch.points[-1]), leaves(branch.points[-1])
    if closed:
        branch.end_at(FRACTION, model.smallest)
    elif left:
        branch.end_at(DISK, 0.0)
    why = "" if closed else ends(branch.points[-1])
    return Followed(branch, closed, left and not why, why)
