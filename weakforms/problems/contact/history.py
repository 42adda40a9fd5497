"""The history of a stuck patch, by collocation in the position of its front.

While the patch grows, nothing jumps at its front. The shape that is frozen there therefore continues the free
part with its slopes, at every position of the front. These conditions are collocated at the fronts, each of
which has a state of the front-fitted mesh, and solved by Newton's method.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.contact.model import PatchModel
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

ITERATIONS = 20
"""Largest number of Newton iterations; about 5 are needed."""

ACCURACY = 2e-11
"""Largest accepted defect of the conditions."""

SLOW = 0.1
"""If a step leaves more than this fraction of the defect, the derivative is computed again."""

DIFFERENCE = 1e-6
"""Change of a value by which what depends on it is differentiated."""


class History:
    r"""Frozen quantities of a patch, from conditions at fronts that are Chebyshev points of ``(0, span]``.

    The unknowns ``x`` are the values of the frozen quantities at the fronts, one quantity after the other.
    The conditions are :math:`c(x) = A x`: what the free part has at its edge, and what the patch keeps.

    Args:
        model: Model with a bond, whose series are set.
        t: Points of [-1, 1] that belong to the fronts.
        frozen: The matrix ``A``.
        weights: Of the defects ``c - A x``, where they are compared with :data:`ACCURACY`.
    """

    conditions: ClassVar[tuple[str, ...]]
    """Functionals of the model: what the free part has at its edge."""

    def __init__(
        self, model: PatchModel, t: np.ndarray, frozen: np.ndarray, weights: np.ndarray | float = 1.0
    ) -> None:
        self.model, self.span = model, model.bond.span
        self.fronts = self.span * (1 + t) / 2
        self._frozen, self._weights = frozen, weights
        self._solver = ExtendedNewton(model.system, ["p", *model.edges])

    # -- what depends on the body --------------------------------------------------------------

    def write(self, x: np.ndarray) -> None:
        """Write the series through the frozen values into the model."""
        raise NotImplementedError

    def guess(self, slipped: Sequence[Solved]) -> np.ndarray:
        """A first ``x`` from frictionless states at the fronts."""
        raise NotImplementedError

    # -- the history ---------------------------------------------------------------------------

    def solve(self, states: Sequence[State], x: np.ndarray) -> None:
        """Newton's method for the frozen values; at the end the series are written.

        Args:
            states: First guesses of the states at the fronts.
            x: First guess of the frozen values.

        Raises:
            ConvergenceError: If it does not converge.
        """
        self._states = list(states)
        before, slope = np.inf, np.empty(0)
        for _ in range(ITERATIONS):
            self.write(x)
            defects = self._outside() - self._frozen @ x
            largest = np.abs(self._weights * defects).max()
            if largest < ACCURACY:
                self.found = x
                return
            if not (len(slope) and largest < SLOW * before):
                slope = self._sensitivity(x)
            x, before = x - np.linalg.solve(slope, defects), largest
        raise ConvergenceError(
            f"history of the stuck patch: defect {largest:.1e} after {ITERATIONS} iterations"
        )

    def _held(self, front: float) -> list[Held]:
        return [*(Held(gap, 0.0) for gap in self._gaps), Held("front", float(front))]

    @property
    def _gaps(self) -> list[str]:
        return [gap for gap, _ in self.model.edges.values()]

    def _outside(self) -> np.ndarray:
        """The functionals of the conditions at every front, with the current series."""
        out = np.empty((len(self.conditions), len(self.fronts)))
        for j, front in enumerate(self.fronts):
            self._states[j], _ = self._solver.solve(self._states[j], self._held(front))
            with self.model.system.at(self._states[j]):
                out[:, j] = [self.model.system.monitor(name) for name in self.conditions]
        return out.ravel()

    def _sensitivity(self, x: np.ndarray) -> np.ndarray:
        """Derivative of the defects: at each front a linear solve for every frozen value."""
        count, system, gaps = len(self.fronts), self.model.system, len(self._gaps)
        names = (*self.conditions, *self._gaps)

        def observed(x: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
            self.write(x)
            out = []
            for state in self._states:
                with system.at(state):
                    out.append((system.residual(), np.array([system.monitor(name) for name in names])))
            return out

        moved = [observed(x + DIFFERENCE * unit) for unit in np.eye(len(x))]
        here, out = observed(x), -self._frozen
        for j, front in enumerate(self.fronts):
            with system.at(self._states[j]):
                self._solver.factor.update()
                bordered = self._solver.border(self._held(front))
                rows = [system.monitor_gradient(name, self._solver.scalars) for name in self.conditions]
            for m, there in enumerate(moved):
                force, direct = ((b - a) / DIFFERENCE for a, b in zip(here[j], there[j], strict=True))
                u, loads = bordered.solve(-force, [*-direct[-gaps:], 0.0])
                for i, (row, rates) in enumerate(rows):
                    scalars = zip(self._solver.scalars, loads, strict=True)
                    by_loads = sum(rates.get(name, 0.0) * float(value) for name, value in scalars)
                    out[i * count + j, m] += direct[i] + system.dot(row, u) + by_loads
        return out
