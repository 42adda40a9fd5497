r"""Lopsided states of a tube of uneven thickness: the pitchfork of the even tube comes apart.

With the thickness :math:`1 + \varepsilon Z/(l_f/2)` free inflation has no symmetry to lose. Its bulge moves
to one end by itself. The states with the bulge at the other end lie on a branch of their own, detached from
free inflation. It has a smallest volume and a largest pressure near those of the even tube's crossing. For
small :math:`\varepsilon` they follow Koiter's two-thirds law
(:mod:`weakforms.solvers.continuation.expansion`).

The branch begins beyond its smallest volume, where the bulge is nearer to the middle, passes it, and goes on
to larger volumes with the bulge nearer to the end.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from weakforms.errors import AbsentError
from weakforms.problems.gas import folds_of
from weakforms.problems.tube.model import USUAL_LOAD, made_uneven, yielding, yields
from weakforms.problems.tube.secondary.crossed import require_crossings
from weakforms.problems.tube.secondary.lopsided import (
    ACROSS,
    AMPLITUDE,
    CROSSED,
    LOST,
    LopsidedBranch,
)
from weakforms.problems.tube.stability import TubeBranch, TubeFamily
from weakforms.solvers.continuation.amounts import AmountCurve
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton

LEAST = 1e-6
"""Smallest unevenness other than zero: below, both branches are too near for one step not to change over."""

APART, SHRINKS = 1e-4, 1 / 3
"""Unevenness below which steps are shorter, and the power of it with which they and the distance of both
branches shrink."""

BEYOND, BEFORE = 1.5, 0.5
"""Amplitudes over that of the smallest volume by the two-thirds law: where a state of the even tube is made
uneven, and where the branch begins."""


def largest_step(step: float, uneven: float) -> float:
    """Largest step of free inflation that does not change over to the detached branch unnoticed."""
    return step * min(1.0, (abs(uneven) / APART) ** SHRINKS) if uneven else step


def detached_side(even: TubeBranch, crossing: Solved, uneven: float) -> float:
    """Sign of the amplitude of the side that free inflation does not take.

    Before the crossing the force of the uneven thickness displaces the middle to the side that it pushes to.
    """
    about = LopsidedBranch.expanded(ExtendedNewton(even.system, [even.control]), crossing)
    place = crossing.values["u_max"]
    before = [point.n_negative for point in even.points if point.monitors["u_max"] < place]
    after = [point.n_negative for point in even.points if point.monitors["u_max"] > place]
    taken = np.sign(about.conjugate_rate * uneven * about.push / about.linear)
    return -float(taken * np.sign(after[0] - before[-1]))


class DetachedBranch(AmountCurve, TubeBranch):
    """The branch on one mesh.

    Args:
        lopsided: Lopsided states of the even tube to the same side, on the same mesh.
        even: Free inflation of the even tube.
        uneven: The unevenness.
        step: Largest step.
        begin: Amplitude at which it begins, that of other meshes; if none is given, one is chosen.

    Raises:
        AbsentError: If the even tube has no lopsided state beyond the smallest volume.
        ConvergenceError: If there is no first state.
    """

    def __init__(
        self,
        lopsided: LopsidedBranch,
        even: TubeBranch,
        uneven: float,
        step: float,
        begin: float | None = None,
    ) -> None:
        solver = ExtendedNewton(even.system, [even.control])
        extremum = abs(lopsided.expansion.amplitude_of_extremum(uneven))
        steps = StepControl(first=min(step, extremum) / 16, largest=step, usual_load=USUAL_LOAD)
        continuation = Continuation(solver, control=steps)
        start = _first(lopsided, continuation, uneven, extremum, begin)
        stop = lopsided.ending(even, lopsided.side)
        super().__init__(continuation, even.control, start, stop, even.modes)
        self.end_at_limit(even.limit)
        if yields(self.points[-1]):
            self.ended = f"the detached branch ends: {yielding(self.points[-1])}"

    def _placed(self) -> list[tuple[float, Solved]]:
        """Besides, the extrema of the volume."""
        found = super()._placed()
        folds = self.folds(self.control, "V", folds_of(None))
        return found + [(self._arclength(i, solved), solved) for i, solved in folds]


def _first(
    lopsided: LopsidedBranch,
    continuation: Continuation,
    uneven: float,
    extremum: float,
    begin: float | None,
) -> CurvePoint:
    """The first point of the detached branch, beyond its smallest volume towards the symmetric states.

    A lopsided state of the even tube, with an amplitude beyond that of the smallest volume, is made uneven.
    From there the branch is followed backwards, past the smallest volume.

    Raises:
        AbsentError: If the even tube has no state with that amplitude.
        ConvergenceError: If the state is lost on the way.
    """
    side, solver = lopsided.side, continuation.solver
    most = max(side * point.monitors[AMPLITUDE] for point in lopsided.points)
    beyond = side * BEYOND * extremum
    if abs(beyond) > most:
        raise AbsentError(
            "secondary branch",
            f"tube: uneven = {uneven:g}: the states with the bulge at the thick end would have their "
            f"smallest volume near |w_mid| = {extremum:.3g}, but those of the even tube reach {most:.3g} "
            "only; choose a smaller magnitude of uneven, or a larger u_end",
        )
    held = Held(AMPLITUDE, beyond)
    near = abs(beyond) <= side * lopsided.points[1].monitors[AMPLITUDE]
    guess = lopsided.expansion.predicted(beyond) if near else lopsided.at(AMPLITUDE, beyond).state
    start = continuation.start(made_uneven(solver, guess, held, uneven), held, towards={AMPLITUDE: -side})

    def passed(point: CurvePoint) -> bool:
        amplitude, volume = side * point.monitors[AMPLITUDE], point.monitors["V"]
        if begin is not None:
            return amplitude < side * begin
        return volume > start.monitors["V"] or amplitude < BEFORE * extremum

    *_, last = continuation.trace(start, passed)
    place = Held(AMPLITUDE, last.monitors[AMPLITUDE] if begin is None else begin)
    return continuation.start(last.state, place, towards={AMPLITUDE: side})


def detached_family(
    even: TubeFamily,
    uneven: float,
    number: int,
    step: float,
    progress: Callable[[str, int, int], None],
) -> TubeFamily:
    """The branch beside one crossing of the even tube, on all meshes.

    Args:
        even: Free inflation of the even tube.
        uneven: The unevenness.
        number: The crossing, counted from 1 along free inflation.
        step: Largest step.
        progress: Says which mesh is solved on.

    Raises:
        AbsentError: If there are not as many crossings, or the unevenness is too large.
        ConvergenceError: If there is no first state.
    """
    crossings = even.located(CROSSED)
    require_crossings(len(crossings), number, even.fine, *LOST)
    side = detached_side(even.fine, crossings[number - 1][-1], uneven)

    made: list[DetachedBranch] = []

    def make(level: int) -> DetachedBranch:
        progress("detached branch", level, len(even.levels))
        own, on_mesh = even.levels[level], [same[level] for same in crossings]
        begin = made[0].points[0].monitors[AMPLITUDE] if made else None
        lopsided = LopsidedBranch(own, on_mesh, number - 1, step, side)
        made.append(DetachedBranch(lopsided, own, uneven, step, begin))
        return made[-1]

    return TubeFamily(make, len(even.levels), even.cap, ACROSS, "secondary", even.caps)
