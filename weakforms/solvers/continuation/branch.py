"""Curves with their special points: equilibria over a load, and over a load and fronts."""

from __future__ import annotations

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.apart import tell_apart
from weakforms.solvers.continuation.crossing import Crossing
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import OwnVariation, Singular

HALVINGS = 4
"""How often a step beyond the end of a trace is halved."""


class FittedBranch(SolutionCurve):
    """Solutions with further unknown loads besides the control, such as a front that the mesh follows."""

    def special(self) -> list[Solved]:
        """Limit points of the control: zeros of its rate along the curve."""
        return [self._turn(int(i)) for i in self.turns()]

    def extend_to(self, load: str, value: float, halvings: int = HALVINGS) -> None:
        """Add a point at the end, at a value of a load that is near enough for a linear guess.

        If it is not, points between are added too.

        Raises:
            ConvergenceError: If even the steps that were halved as often as allowed do not converge.
        """
        last, continuation = self.points[-1], self.continuation
        at = last.state.loads[load]
        guess = continuation.predict(None, last, (value - at) / last.tangent.loads[load])
        try:
            state, record = continuation.solve(guess, Held(load, value))
        except ConvergenceError:
            if not halvings:
                raise
            self.extend_to(load, (at + value) / 2, halvings - 1)
            self.extend_to(load, value, halvings - 1)
            return
        length = continuation.distance(state, last.state)
        self.points.append(continuation.point(state, record, last.tangent, last.arclength + length))


class EquilibriumBranch(SolutionCurve):
    """Solutions of ``R(U; λ) = 0`` in one load ``λ``."""

    kind = "limit_point"

    def special(self) -> list[Solved]:
        """Limit points and bifurcation points in order.

        Limit points are bracketed where ``dλ/ds`` changes sign; there the inertia must also change by one.
        The extended system of :class:`Singular` locates them. Where the inertia changes without a limit
        point, another branch crosses: :class:`Crossing` locates it.

        Raises:
            ConvergenceError: If slope and inertia disagree, or the solve for a point does not converge.
        """
        tell_apart(self, self._count, self._counts())
        counts = np.array(self._counts())
        turns = self.turns().tolist()
        changes = np.flatnonzero(np.diff(counts)).tolist()
        if not set(turns) <= set(changes):
            raise ConvergenceError(
                f"folds by slope (after points {turns}) and by inertia (after points {changes}) disagree"
            )
        jumps = np.abs(np.diff(counts)[changes])
        if np.any(jumps != 1):
            raise ConvergenceError(
                f"several eigenvalues change sign between neighbours (after points {changes}): "
                "shorter steps are needed to tell them apart"
            )
        return [self._fold(i) if i in turns else Crossing(self, i).located() for i in changes]

    def tell_apart(self) -> bool:
        """As for any curve, for the eigenvalues of ``K``."""
        return tell_apart(self, self._count, self._counts(), unseen=True)

    def _counts(self) -> list[int]:
        return [point.n_negative for point in self.points]

    def _count(self, state: State) -> int:
        with self.system.at(state):
            self.solver.factor.update()
        return self.solver.factor.negative_count()

    def _fold(self, i: int) -> Solved:
        """By its extended system or, if a sharp turn makes round-off large there, by root finding."""
        a, b = self.points[i], self.points[i + 1]
        border = self.system.mass_times(a.tangent.u + b.tangent.u)
        try:
            singular = Singular(lambda: OwnVariation(self.solver), border)
            solved = self._solve(self._turn_guess(i), singular, "limit_point")
        except ConvergenceError:
            return self._turn(i)
        self.require_within(i, solved, f"limit point of {self.control}")
        return solved


class MirroredBranch(FittedBranch, EquilibriumBranch):
    """States with a mirror symmetry, with a front on either side: other branches may cross them."""

    def special(self) -> list[Solved]:
        """Limit points and bifurcation points in order, as on a branch without fronts."""
        return EquilibriumBranch.special(self)

    def _fold(self, i: int) -> Solved:
        return self._turn(i)
