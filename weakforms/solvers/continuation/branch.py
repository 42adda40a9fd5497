"""Curves with their special points: equilibria over a load, over a load and fronts, and lines of folds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.constraints import Fold, Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.support.roots import polynomial_through, root

NODES = 8
"""Number of states from which a bifurcation point is interpolated."""

AWAY = 1e-6
"""Shift of the inertia on a line of folds: its critical eigenvalue, which is zero, does not count."""


class FittedBranch(SolutionCurve):
    """Solutions with further unknown loads besides the control, such as a front that the mesh follows."""

    def special(self) -> list[Solved]:
        """Limit points of the control: zeros of its rate along the curve."""
        return [self._root(int(i), self._control_rate(int(i)), "limit_point") for i in self.turns()]

    def _control_rate(self, i: int) -> Callable[[Solved], float]:
        along = self.points[i].tangent

        def rate(solved: Solved) -> float:
            return self.continuation.direction(solved.state, along).loads[self.control]

        return rate


class EquilibriumBranch(SolutionCurve):
    """Solutions of ``R(U; λ) = 0`` in one load ``λ``."""

    kind = "limit_point"

    def special(self) -> list[Solved]:
        """Limit points and bifurcation points in order.

        Limit points are bracketed where ``dλ/ds`` changes sign; there the inertia must also change by one.
        The extended system of :class:`Fold` locates them. Where the inertia changes without a limit point,
        another branch crosses.

        Raises:
            ConvergenceError: If slope and inertia disagree, or the solve for a point does not converge.
        """
        counts = np.array([p.n_negative for p in self.points])
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
        return [self._fold(i) if i in turns else self._bifurcation(i) for i in changes]

    def require_nothing_between(self) -> None:
        """Check the eigenvalues of ``K`` as in the base class."""
        factor = self.solver.factor

        def count(state: State) -> int:
            with self.system.at(state):
                factor.update()
            return factor.negative_count()

        self._require_same_between(np.array([p.n_negative for p in self.points]), count, "eigenvalues")

    def _fold(self, i: int) -> Solved:
        a, b = self.points[i], self.points[i + 1]
        border = self.system.mass_times(a.tangent.u + b.tangent.u)
        solved = self._solve(self._turn_guess(i), Fold(self.control, border), "limit_point")
        self._require_within(i, solved, f"limit point of {self.control}")
        return solved

    def _bifurcation(self, i: int) -> Solved:
        """The point where the eigenvalue that changes sign is zero, interpolated from states on both sides.

        At the point even the bordered matrix is singular, because the null vector breaks the symmetry of the
        branch. Nothing is therefore solved there. Eigenvalue, columns and state are smooth along the branch,
        and are interpolated from :data:`NODES` states at Chebyshev nodes.
        """
        stability, tangent = Stability(self.system), self.points[i].tangent
        index = min(self.points[i].n_negative, self.points[i + 1].n_negative)
        nodes = (1 - np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)) / 2
        solved, eigenvalues = [], []
        for fraction in nodes:
            guess = self._between(i, float(fraction))
            solved.append(self._solve(guess, self.continuation.plane(guess, tangent)))
            eigenvalues.append(stability.nearest_by_index(solved[-1].state, index))
        along = polynomial_through(nodes, np.array(eigenvalues))
        zero = root(lambda x: float(along(x)), 0.0, 1.0, "a change of stability", xtol=1e-14)

        def at_root(values: list) -> np.ndarray:
            return polynomial_through(nodes, np.array(values))(zero)

        names = solved[0].values
        loads = {k: float(at_root([s.state.loads[k] for s in solved])) for k in solved[0].state.loads}
        return Solved(
            {name: float(at_root([s.values[name] for s in solved])) for name in names},
            State(at_root([s.state.u for s in solved]), loads, solved[0].state.marks),
            "bifurcation_point",
        )


class FoldLine(SolutionCurve):
    """Limit points in one load, followed over a second load, the control."""

    kind = "cusp_point"

    def special(self) -> list[Solved]:
        """Cusps in order: points where two limit points, the ends of an unstable part of the branch, merge.

        Cusps are bracketed where the control has an extremum. They are located as zeros of the fold's
        curvature (:meth:`Fold.curvature`) over planes across the line.
        """
        return [self._cusp(int(i)) for i in self.turns()]

    def _cusp(self, i: int) -> Solved:
        (fold,) = self.continuation.fixed

        def curvature(solved: Solved) -> float:
            with self.system.at(solved.state):
                return fold.curvature(self.solver)

        return self._root(i, curvature, "cusp_point")


def fold_line(
    branch: EquilibriumBranch,
    second: str,
    towards: float,
    steps: StepControl,
    stop: Callable[[CurvePoint], bool],
) -> FoldLine:
    """The first limit point of a branch, followed over a second load.

    Args:
        branch: The branch, which has a limit point.
        second: The second load.
        towards: Sign of its change along the line at first.
        steps: Lengths of steps.
        stop: True at the last requested point.
    """
    first = branch.special()[0].state
    middle = branch.points[int(branch.turns()[0])]
    fold = Fold(branch.control, branch.system.mass_times(middle.tangent.u))
    solver = ExtendedNewton(branch.system, [branch.control, second])
    line = Continuation(solver, [fold], steps, shift=AWAY)
    start = line.start(first, Held(second, first.loads[second]), towards={second: towards})
    return FoldLine(line, second, start, stop)
