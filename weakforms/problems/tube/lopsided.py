r"""Lopsided states of the free tube: the branch on which the bulge moves towards one end.

It leaves free inflation where a state loses its mirror symmetry about mid-length. Its amplitude is the axial
displacement of the mid-plane,

.. math:: ξ = w_{mid} = η(0),

positive here; the mirror image of the branch has the opposite sign. The first point is the crossing itself,
the second one follows from the expansion of :class:`Expansion`, all others from steps of arc length. The
branch ends where it joins free inflation again, or at the volume at which free inflation ends.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import sqrt
from typing import Any

import numpy as np
from mpi4py import MPI

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.tube.model import STEEPEST, UNEVEN, USUAL_LOAD, TubeModel, yielding, yields
from weakforms.problems.tube.stability import TubeBranch, TubeFamily
from weakforms.results import Quantity, SpecialPoint
from weakforms.results.wording import counted
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.continuation.expansion import Expansion
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.uncertainty.refinement import estimate

AMPLITUDE = "w_mid"
"""Column of the amplitude."""

KIND, CROSSED = "mirror_breaking", "bifurcation_point"
"""Kind of the points at which the branch meets free inflation, and their kind on a whole tube's branch."""

FIRST, HALVINGS = 0.05, 6
"""Amplitude of the first lopsided state, and how often it is halved if Newton's method fails."""

ACROSS = "V", AMPLITUDE
"""Columns of the plane in which meshes are compared: one of them changes at every point of the branch."""


class WholeTube(TubeModel):
    """The whole tube with its amplitude as a column."""

    hidden = (AMPLITUDE,)

    def formulation(self) -> Formulation:
        """The weak form of the tube, with the axial displacement of the mid-plane."""
        given = super().formulation()
        return replace(given, monitors={**given.monitors, AMPLITUDE: self.at_middle(self.expressions["z"])})


def expanded(solver: ExtendedNewton, crossing: Solved) -> Expansion:
    """What leaves a crossing, with the force of an uneven thickness.

    Raises:
        ConvergenceError: If the crossing has no symmetry.
    """
    return Expansion.at(solver, crossing.state, "p", AMPLITUDE, UNEVEN)


def ending(primary: TubeBranch, side: float) -> Callable[[CurvePoint], bool]:
    """Whether a branch beside free inflation ends: at its last volume, at the mirror, or by the law.

    Args:
        primary: Free inflation.
        side: Sign of the branch's amplitude.
    """
    most = primary.points[-1].monitors["V"]

    def stop(point: CurvePoint) -> bool:
        columns, steep = point.monitors, point.tangent.loads[primary.control] > STEEPEST
        return columns["V"] > most or side * columns[AMPLITUDE] < 0 or yields(point) or steep

    return stop


class LopsidedBranch(TubeBranch):
    """The branch on one mesh.

    Args:
        primary: Free inflation on the same mesh.
        crossings: The points at which it loses, or regains, its symmetry.
        begin: Index of the one at which the branch begins.
        step: Largest step.
        side: Sign of the amplitude.

    Raises:
        ConvergenceError: If no lopsided state is found beside the crossing.
    """

    def __init__(
        self,
        primary: TubeBranch,
        crossings: Sequence[Solved],
        begin: int,
        step: float,
        side: float = 1.0,
    ) -> None:
        self.side, system = side, primary.system
        self.crossed = [crossings[begin]]
        """The crossings at which the branch begins and, if it joins free inflation again, ends."""
        self._others = [solved for i, solved in enumerate(crossings) if i != begin]
        solver = ExtendedNewton(system, [primary.control])
        self.expansion = expanded(solver, crossings[begin])
        steps = StepControl(first=step / 4, largest=step, usual_load=USUAL_LOAD)
        continuation = Continuation(solver, control=steps)
        start, stop = self._first_beside(continuation), ending(primary, side)
        super().__init__(continuation, primary.control, start, stop, primary.modes)
        self.end_at_limit(primary.limit)
        if yields(self.points[-1]):
            self.ended = f"the lopsided branch ends: {yielding(self.points[-1])}"

    def _insert_limits(self) -> None:
        """As for any branch, between its ends: the pressure turns at a crossing too."""
        self._begin()
        if self.side * self.points[-1].monitors[AMPLITUDE] < 0:
            self._join()
        super()._insert_limits()

    def _first_beside(self, continuation: Continuation) -> CurvePoint:
        """The first lopsided state, near enough to the crossing for its expansion to be a good guess."""
        amplitude = FIRST
        for _ in range(HALVINGS):
            guess, held = (
                self.expansion.predicted(self.side * amplitude),
                Held(AMPLITUDE, self.side * amplitude),
            )
            try:
                return continuation.start(guess, held, towards={AMPLITUDE: self.side})
            except ConvergenceError:
                amplitude /= 2
        raise ConvergenceError(f"no lopsided state with w_mid from {amplitude * 2:g} to {FIRST:g} was found")

    def _crossing(self, solved: Solved, mode: np.ndarray, arclength: float, like: CurvePoint) -> CurvePoint:
        """A crossing as a point of the branch, which passes it along the mode.

        Its zero eigenvalue makes the inertia depend on round-off: it gets the count of its neighbour.
        """
        dual = self.system.mass_times(mode)
        size = sqrt(self.system.dot(mode, dual))
        tangent = Tangent(mode / size, {self.control: 0.0}, dual / size)
        with self.system.at(solved.state):
            residual, monitors = self.system.residual(), self.system.monitors()
        record = SolveRecord("located", 0, 0, (sqrt(self.system.dot(residual, residual)),))
        return CurvePoint(solved.state, tangent, arclength, like.n_negative, record, monitors)

    def _begin(self) -> None:
        """Put the crossing before the first lopsided state."""
        first = self.points[0]
        length = self.continuation.distance(first.state, self.crossed[0].state)
        for point in self.points:
            point.arclength += length
        self.points.insert(0, self._crossing(self.crossed[0], self.side * self.expansion.mode, 0.0, first))

    def _join(self) -> None:
        """Replace the last point, beyond the mirror symmetry, by the crossing where the branch arrives."""
        before, last = self.points[-2:]
        length = last.arclength - before.arclength
        gaps = [
            max(self.continuation.distance(s.state, p.state) for p in (before, last)) for s in self._others
        ]
        if not gaps or min(gaps) > length:
            del self.points[-1]
            self.ended = "the branch becomes symmetric where free inflation has no located crossing"
            return
        found = self._others[int(np.argmin(gaps))]
        mode = expanded(self.solver, found).mode
        length = self.continuation.distance(found.state, before.state)
        self.points[-1] = self._crossing(found, -self.side * mode, before.arclength + length, before)
        self.crossed.append(found)

    @property
    def joins(self) -> bool:
        """Whether the branch ends on free inflation."""
        return len(self.crossed) > 1

    def met(self, point: CurvePoint) -> int | None:
        """Number, from 0, of the crossing that a point of the trace is; none for a lopsided state."""
        ends = [self.points[0], *self.points[-1:] * self.joins]
        return next((i for i, end in enumerate(ends) if end is point), None)

    def at_crossing(self, i: int) -> Solved:
        """One of the crossings, with all columns and marks."""
        solved = self.solved(self.crossed[i].state, KIND)
        marks = {"n": 0.0, "parity": -1.0}
        return self._flagged(self.complete(replace(solved, values=solved.values | marks)))

    def special(self) -> list[Solved]:
        """The crossing at which the branch begins, its own special points, and the one at which it ends."""
        begin, *end = (self.at_crossing(i) for i in range(len(self.crossed)))
        return [begin, *super().special(), *end]


class LopsidedFamily(TubeFamily):
    """The branch on all meshes; its first special point has the coefficients of the expansion."""

    fine: LopsidedBranch
    levels: list[LopsidedBranch]

    def _compared(self, point: CurvePoint, near: float, row: dict[str, float]) -> Any:
        """As for any branch; the crossings, where no plane selects a state, are those of each mesh."""
        i = self.fine.met(point)
        if i is None:
            return super()._compared(point, near, row)
        if len({level.joins for level in self.levels}) > 1:
            raise ConvergenceError("whether the lopsided branch joins free inflation depends on the mesh")
        return [*(level.at_crossing(i).values for level in self.levels[:-1]), row], row

    def left_by_round_off(self, _index: int) -> Mapping[str, float]:
        """The round-off of eigenvalues, which is that of the largest eigenvalue of the mesh."""
        return {name: self._round_off for name in self.fine.shown if name.startswith("Lambda_")}

    @cached_property
    def _round_off(self) -> float:
        """``eps max K_ii/M_ii`` at the first state."""
        system = self.fine.system
        with system.at(self.fine.points[0].state):
            stiffness = system.tangent().getDiagonal().array
            mass = system.mass.getDiagonal().array
        largest = float(np.max(np.abs(stiffness[mass > 0]) / mass[mass > 0], initial=0.0))
        return float(np.finfo(float).eps) * system.comm.allreduce(largest, op=MPI.MAX)

    def _trace(self) -> dict[str, np.ndarray]:
        """Columns of the finest mesh's trace; at a crossing the counts of its neighbour."""
        columns = super()._trace()
        places = [(0, 1), *[(-1, -2)] * self.fine.joins]
        for name in columns:
            if name.startswith("n_negative"):
                for here, beside in places:
                    columns[name][here] = columns[name][beside]
        return columns

    def special_points(self) -> list[SpecialPoint]:
        """Special points; the first one has the branch's curvatures and coefficients."""
        first, *others = super().special_points()
        for name, quantity in self.curvatures().items():
            first.values[name], first.uncertainty[name] = quantity.value, quantity.uncertainty
        return [first, *others]

    def curvatures(self) -> Mapping[str, Quantity]:
        """``p_2``, ``V_2``, coefficients of the amplitude's equation, of two-thirds laws, on all meshes."""
        found = [level.expansion for level in self.levels]
        parts = {"p_2": "load_2", "V_2": "conjugate_2", "A1": "linear", "A3": "cubic", "B": "push"}
        rows = {name: [getattr(expansion, part) for expansion in found] for name, part in parts.items()}
        for name, part in {"p_s": "load", "V_s": "conjugate"}.items():
            rows[name] = [expansion.two_thirds[part] for expansion in found]
        both = {name: estimate(row, self.cap) for name, row in rows.items()}
        return {name: Quantity(float(b.value), float(b.uncertainty)) for name, b in both.items()}


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
    require_crossings(len(crossings), number, primary.fine)

    def make(level: int) -> LopsidedBranch:
        progress("lopsided branch", level, len(primary.levels))
        on_mesh = [same[level] for same in crossings]
        return LopsidedBranch(primary.levels[level], on_mesh, number - 1, step)

    return LopsidedFamily(make, len(primary.levels), primary.cap, ACROSS, "secondary", primary.caps)


def require_crossings(count: int, number: int, primary: TubeBranch) -> None:
    """Refuse a crossing that free inflation does not have.

    Raises:
        AbsentError: If there are not as many crossings as the number that is asked for.
    """
    if count >= number:
        return
    there = f"only {counted(count, 'point', 'points')}" if count else "no point"
    last = primary.points[-1].monitors["u_max"]
    raise AbsentError(
        "secondary branch",
        f"tube: secondary_from = {number}: free inflation up to u_max = {last:.6g} has {there} at which the "
        "mirror symmetry breaks, where a secondary branch would begin; raise u_end (allowed: up to 10), or "
        "choose another law, delta1 or lf",
    )
