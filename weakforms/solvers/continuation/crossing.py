r"""Points where another branch crosses a curve.

There even the matrix of an arc-length step is singular: the null vector ``φ`` of ``K`` breaks the symmetry of
the curve. With a force ``μ b`` in its direction, ``b = M φ₀``, and a condition for its amplitude

.. math:: R(U; λ) + μ b = 0, \qquad t \cdot (U, λ) = x, \qquad b^T U = β

every state is regular, and on the curve ``μ = 0``. The two numbers ``x, β`` follow from two conditions (the
first of which is that of :class:`Singular`)

.. math:: K \varphi + g\,b = 0, \qquad b^T \varphi = 1, \qquad g = 0, \qquad
          h = \varphi^T \sum_i R_{λ_i} \dot λ_i = 0

with the rates of the loads along the curve. Both conditions together are regular at a simple crossing, with
and without symmetry (Govaerts 2000, chapter 7).
"""

from __future__ import annotations

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.balance import RESIDUAL_LIMIT
from weakforms.solvers.equilibrium.constraints import Plane
from weakforms.solvers.equilibrium.linear import BorderedMatrix
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.spectra import Stability

DIFFERENCE = 1e-4
"""Change of the two numbers by which their conditions are differentiated, once."""

ITERATIONS, LAST = 10, 1e-8
"""Largest number of iterations, and the step after which they end. Each step is about a thousandth of the one
before it, until round-off in ``g``, a few 1e-9 of the interval, ends their decrease."""


class Crossing:
    """The crossing in one interval of a curve.

    Args:
        curve: The curve.
        i: Index of the point before it; the inertia changes by one to the next point.
    """

    def __init__(self, curve: SolutionCurve, i: int) -> None:
        self.curve, self.i, self.system = curve, i, curve.system
        before, after = (point.n_negative for point in curve.points[i : i + 2])
        self._at = curve.narrowed(i, self._count, before, after)
        guess = curve.between(i, self._at)
        with self.system.at(guess):
            self.border = self.system.mass_times(Stability(self.system).highest_negative(guess).vector)
        self.solver = ExtendedNewton(self.system, curve.loads, unfolding=self.border)
        self._guess = guess

    def _count(self, state: State) -> int:
        factor = self.curve.solver.factor
        with self.system.at(state):
            factor.update()
            return factor.negative_count()

    def located(self) -> Solved:
        """The state at the crossing.

        Raises:
            ConvergenceError: If it is not found in the interval, or is no equilibrium without the force.
        """
        what = f"bifurcation in {self.curve.control}"
        state = self._state(self._numbers(what))
        (left,) = self.solver.unfolded
        if not abs(left) < RESIDUAL_LIMIT:
            raise ConvergenceError(f"{what}: no branch crosses here, a force of {left:.1e} is left")
        solved = self.curve.solved(state, "bifurcation_point")
        self.curve.require_within(self.i, solved, what)
        return solved

    def _numbers(self, what: str) -> np.ndarray:
        """``x`` and ``β`` at which both conditions hold."""
        numbers = np.array([self._at, self.system.dot(self.border, self._guess.u)])
        here = self._conditions(numbers)
        moved = [self._conditions(numbers + DIFFERENCE * unit) for unit in np.eye(2)]
        slopes = np.column_stack([there - here for there in moved]) / DIFFERENCE
        for _ in range(ITERATIONS):
            step = np.linalg.solve(slopes, -here)
            numbers = numbers + step
            if np.abs(step).max() < LAST:
                return numbers
            here = self._conditions(numbers)
        raise ConvergenceError(f"{what}: not found within {ITERATIONS} iterations")

    def _state(self, numbers: np.ndarray) -> State:
        """The state at ``x`` (a fraction of the interval) and ``β``."""
        along, across = map(float, numbers)
        guess, continuation = self.curve.between(self.i, along), self.curve.continuation
        plane = continuation.plane(guess, self.curve.points[self.i].tangent)
        self._guess, _ = self.solver.solve(
            guess, [*continuation.fixed, plane, Plane(self.border, {}, across)]
        )
        return self._guess

    def _conditions(self, numbers: np.ndarray) -> np.ndarray:
        """``g`` and ``h``."""
        state, rates = self._state(numbers), self.curve.points[self.i].tangent.loads
        with self.system.at(state):
            self.solver.factor.update()
            square = BorderedMatrix(self.solver.factor, [self.border], [self.border], np.zeros((1, 1)))
            mode, (singular,) = square.solve(None, [1.0])
            forces = sum(rate * self.system.load_derivative(name) for name, rate in rates.items())
            return np.array([singular, self.system.dot(mode, forces)])
