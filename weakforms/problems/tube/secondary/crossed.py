r"""Branches that leave free inflation where a symmetry breaks: first states, both ends, initial curvatures.

The first point is the crossing itself, the second one follows from the expansion of
:class:`weakforms.solvers.continuation.expansion.Expansion`, all others from steps of arc length. The branch
ends where it joins free inflation again, or at the volume at which free inflation ends.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import sqrt
from typing import Any, ClassVar

import numpy as np
from mpi4py import MPI

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.meridian.families import WaveBranch, WaveFamily
from weakforms.problems.problem import Requests
from weakforms.problems.tube.model import STEEPEST, USUAL_LOAD
from weakforms.problems.tube.parameters import TubeParameters
from weakforms.problems.tube.stability import TubeBranch
from weakforms.results import Quantity, SpecialPoint
from weakforms.results.wording import counted
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.continuation.expansion import Expansion
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.modal import Modes
from weakforms.solvers.uncertainty.refinement import estimate

FIRST, HALVINGS = 0.05, 6
"""Amplitude of the first state, and how often it is halved if Newton's method fails."""

CURVATURES = {"p_2": "load_2", "V_2": "conjugate_2", "A1": "linear", "A3": "cubic"}
"""Values of the crossing at which a branch begins, and the parts of its expansion that they are."""


class CrossedBranch(WaveBranch):
    """The branch on one mesh.

    Args:
        primary: Free inflation, on the same mesh or on another one.
        crossings: The points at which it loses, or regains, its symmetry, in the unknowns of the branch.
        begin: Index of the one at which the branch begins.
        step: Largest step.
        side: Sign of the amplitude.
        own: Equations and stability of the branch, if they are not those of free inflation.

    Raises:
        ConvergenceError: If no state is found beside the crossing.
    """

    kind: ClassVar[str]
    """Kind of the points at which the branch meets free inflation."""

    amplitude: ClassVar[str]
    """Column of the amplitude."""

    imperfection: ClassVar[str] = ""
    """The load that breaks the symmetry, if there is one."""

    family: ClassVar[Mapping[str, float]]
    """Wave number and parity of the mode, the marks of a crossing."""

    called: ClassVar[str]
    """What its states are, as text."""

    def __init__(
        self,
        primary: TubeBranch,
        crossings: Sequence[Solved],
        begin: int,
        step: float,
        side: float = 1.0,
        own: tuple[System, Modes] | None = None,
    ) -> None:
        self.side = side
        system, modes = own or (primary.system, primary.modes)
        self.crossed = [crossings[begin]]
        """The crossings at which the branch begins and, if it joins free inflation again, ends."""
        self._others = [solved for i, solved in enumerate(crossings) if i != begin]
        solver = ExtendedNewton(system, [primary.control])
        self.expansion = self.expanded(solver, crossings[begin])
        steps = StepControl(first=step / 4, largest=step, usual_load=USUAL_LOAD)
        continuation = Continuation(solver, control=steps)
        start = self._first_beside(continuation)
        super().__init__(continuation, primary.control, start, self.until(primary, start), modes)

    @classmethod
    def expanded(cls, solver: ExtendedNewton, crossing: Solved) -> Expansion:
        """What leaves a crossing, with the force of the imperfection.

        Raises:
            ConvergenceError: If the crossing has no symmetry.
        """
        return Expansion.at(solver, crossing.state, "p", cls.amplitude, cls.imperfection)

    def until(self, primary: TubeBranch, _start: CurvePoint) -> Callable[[CurvePoint], bool]:
        """Whether the branch ends at a point, from its first state on."""
        return self.ending(primary, self.side)

    @classmethod
    def ending(
        cls, primary: TubeBranch, side: float, most: float | None = None
    ) -> Callable[[CurvePoint], bool]:
        """Whether a branch beside free inflation ends: at its last volume, symmetric again, or by the law.

        Args:
            primary: Free inflation.
            side: Sign of the branch's amplitude.
            most: The volume at which free inflation ends, if that is not the last one of ``primary``.
        """
        most = primary.points[-1].monitors["V"] if most is None else most

        def stop(point: CurvePoint) -> bool:
            columns, steep = point.monitors, point.tangent.loads[primary.control] > STEEPEST
            return columns["V"] > most or side * columns[cls.amplitude] < 0 or steep

        return stop

    def _insert_limits(self) -> None:
        """As for any branch, between its ends: the pressure turns at a crossing too."""
        self._begin()
        if self.side * self.points[-1].monitors[self.amplitude] < 0:
            self._join()
        super()._insert_limits()

    def _first_beside(self, continuation: Continuation) -> CurvePoint:
        """The first state, near enough to the crossing for its expansion to be a good guess."""
        amplitude = FIRST
        for _ in range(HALVINGS):
            guess, held = (
                self.expansion.predicted(self.side * amplitude),
                Held(self.amplitude, self.side * amplitude),
            )
            try:
                return continuation.start(guess, held, towards={self.amplitude: self.side})
            except ConvergenceError:
                amplitude /= 2
        raise ConvergenceError(
            f"no {self.called} state with {self.amplitude} from {amplitude * 2:g} to {FIRST:g} was found"
        )

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
        """Put the crossing before the first state."""
        first = self.points[0]
        length = self.continuation.distance(first.state, self.crossed[0].state)
        for point in self.points:
            point.arclength += length
        self.points.insert(0, self._crossing(self.crossed[0], self.side * self.expansion.mode, 0.0, first))

    def _join(self) -> None:
        """Replace the last point, beyond the symmetry, by the crossing where the branch arrives."""
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
        mode = self.expanded(self.solver, found).mode
        length = self.continuation.distance(found.state, before.state)
        self.points[-1] = self._crossing(found, -self.side * mode, before.arclength + length, before)
        self.crossed.append(found)

    @property
    def joins(self) -> bool:
        """Whether the branch ends on free inflation."""
        return len(self.crossed) > 1

    def met(self, point: CurvePoint) -> int | None:
        """Number, from 0, of the crossing that a point of the trace is; none for a state beside it."""
        ends = [self.points[0], *self.points[-1:] * self.joins]
        return next((i for i, end in enumerate(ends) if end is point), None)

    def at_crossing(self, i: int) -> Solved:
        """One of the crossings, with all columns and marks."""
        solved = self.solved(self.crossed[i].state, self.kind)
        return self.complete(replace(solved, values=solved.values | self.family))

    def special(self) -> list[Solved]:
        """The crossing at which the branch begins, its own special points, and the one at which it ends."""
        begin, *end = (self.at_crossing(i) for i in range(len(self.crossed)))
        return [begin, *super().special(), *end]


class FlaggedBranch(CrossedBranch, TubeBranch):
    """A branch whose states, and both of whose ends, say whether the membrane is compressed."""

    def at_crossing(self, i: int) -> Solved:
        """One of the crossings, with all columns and marks."""
        return self._flagged(super().at_crossing(i))


class CrossedFamily(WaveFamily):
    """The branch on all meshes; its first special point has the coefficients of the expansion."""

    fine: CrossedBranch
    levels: list[CrossedBranch]

    def _compared(self, point: CurvePoint, near: float, row: dict[str, float]) -> Any:
        """As for any branch; the crossings, where no plane selects a state, are those of each mesh."""
        i = self.fine.met(point)
        if i is None:
            return super()._compared(point, near, row)
        if len({level.joins for level in self.levels}) > 1:
            raise ConvergenceError(
                f"whether the {self.fine.called} branch joins free inflation depends on the mesh"
            )
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
        """``p_2``, ``V_2`` and the coefficients of the amplitude's equation, on all meshes."""
        found = [level.expansion for level in self.levels]
        rows = {name: [getattr(expansion, part) for expansion in found] for name, part in CURVATURES.items()}
        return self.estimated(rows)

    def estimated(self, rows: Mapping[str, Sequence[float]]) -> dict[str, Quantity]:
        """Numbers of all meshes, coarse to fine, with their uncertainties."""
        both = {name: estimate(row, self.cap) for name, row in rows.items()}
        return {name: Quantity(float(b.value), float(b.uncertainty)) for name, b in both.items()}


def require_crossings(count: int, number: int, primary: TubeBranch, where: str, change: str) -> None:
    """Refuse a crossing that free inflation does not have.

    Args:
        count: How many there are.
        number: The one that is asked for, from 1.
        primary: Free inflation.
        where: What happens at such a point, as text.
        change: Parameters that may give one, as text.

    Raises:
        AbsentError: If there are not as many crossings as the number that is asked for.
    """
    if count >= number:
        return
    there = f"only {counted(count, 'point', 'points')}" if count else "no point"
    last = primary.points[-1].monitors["u_max"]
    raise AbsentError(
        "secondary branch",
        f"tube: secondary_from = {number}: free inflation up to u_max = {last:.6g} has {there} at which "
        f"{where}, where a secondary branch would begin; raise u_end (allowed: up to 10), or "
        f"choose another law, {change}",
    )


def begun_taut(crossings: Sequence[Solved], number: int, where: str) -> tuple[list[int], int]:
    """Which crossings a tube that bears no compression has, and where among them its branch begins.

    Args:
        crossings: Those of free inflation by the law's energy, with the mark ``wrinkled``.
        number: The one that is asked for, from 1.
        where: What happens at such a point, as text.

    Raises:
        AbsentError: If the tube would be compressed at the one that is asked for.
    """
    begin = crossings[number - 1].values
    if begin["wrinkled"]:
        raise AbsentError(
            "secondary branch",
            f"tube: energy = 'relaxed', secondary_from = {number}: at u_max = {begin['u_max']:.6g}, "
            f"where {where}, the tube would be compressed; relaxed states begin "
            "where it is taut; change delta1 or lf, lower secondary_from, or set energy = 'standard'",
        )
    taut = [i for i, solved in enumerate(crossings) if not solved.values["wrinkled"]]
    return taut, taut.index(number - 1)


def require_secondary_possible(parameters: TubeParameters, requests: Requests) -> None:
    """Refuse a secondary branch where there is none, and states of one that is not solved for."""
    if not parameters.secondary:
        if any(wanted.branch == "secondary" for wanted in requests.states):
            raise InputError("tube: the secondary branch is solved for only with secondary = true")
        return
    if parameters.contact != "none":
        raise InputError(
            f"tube: secondary = true with contact = {parameters.contact!r}: secondary branches are those of "
            "free inflation; set contact = 'none'"
        )
    if parameters.extent == "half" and not parameters.secondary_n:
        raise InputError(
            "tube: secondary = true: lopsided states are not symmetric; set extent = 'full', or "
            "secondary_n = 1 for bent states"
        )
    if parameters.extent == "full" and parameters.secondary_n:
        raise InputError(
            f"tube: secondary_n = {parameters.secondary_n} with extent = 'full': these states are symmetric "
            "about mid-length; set extent = 'half', or secondary_n = 0 for lopsided states"
        )
