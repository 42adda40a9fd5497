r"""The branch that leaves a symmetric crossing: its direction, its curvature and its load to second order.

At a state ``U_c`` where ``K`` has the null vector ``φ``, with an amplitude ``ξ = c·(U - U_c)``, ``c·φ = 1``,

.. math:: U = U_0(λ) + ξ φ + ξ^2 ψ + \dots, \qquad λ = λ_c + λ_2 ξ^2 + \dots

with the tangent ``udot`` of the crossed branch and ``ψ`` from the tangent bordered by ``c``:

.. math:: K\, \dot U = -R_λ, \qquad K ψ = -\tfrac12 Π'''[φ, φ, \cdot], \qquad c·\dot U = c·ψ = 0

The equation of the amplitude is ``A1 (λ - λ_c) ξ + A2 ξ² + A3 ξ³ = 0`` with

.. math:: A_1 = Π'''[φ, φ, \dot U] + Π''_λ[φ, φ], \quad A_2 = \tfrac12 Π'''[φ, φ, φ], \quad
          A_3 = \tfrac16 Π''''[φ, φ, φ, φ] + Π'''[φ, φ, ψ], \quad λ_2 = -A_3/A_1

where a symmetry that ``φ`` breaks makes ``A2`` zero (Koiter 1945; Budiansky 1974, Adv. Appl. Mech. 14). What
is conjugate to the load, ``V = -Π_λ`` (of gas: the volume), follows ``V - V_c = V_2 ξ²``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.linear import BorderedMatrix
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

ASYMMETRIC = 1e-6
"""``A2`` above this part of ``A3``, at an amplitude of one, belongs to a crossing without symmetry."""


@dataclass(frozen=True)
class Expansion:
    """The coefficients at one crossing; vectors are displacements for an amplitude of one."""

    state: State
    load: str
    mode: np.ndarray
    curvature: np.ndarray
    along: np.ndarray
    """``φ``, ``ψ`` and the tangent of the crossed branch per load."""
    linear: float
    quadratic: float
    cubic: float
    """``A1``, ``A2`` and ``A3``."""
    load_2: float
    conjugate_2: float
    """``λ_2`` and ``V_2``."""

    @classmethod
    def at(cls, solver: ExtendedNewton, state: State, load: str, amplitude: str) -> Self:
        """The expansion at a state that was located.

        Args:
            solver: Of the equilibrium equations.
            state: The state.
            load: The load ``λ``.
            amplitude: The functional whose gradient is ``c``.

        Raises:
            ConvergenceError: If the crossing has no symmetry (``A2`` is not zero).
        """
        system = solver.system
        with system.at(state):
            across, _ = system.monitor_gradient(amplitude, ())
            solver.factor.update()
            bordered = BorderedMatrix(solver.factor, [across], [across], np.zeros((1, 1)))
            mode, _ = bordered.solve(None, [1.0])
            force = system.load_derivative(load)
            along, _ = bordered.solve(-force, [0.0])
            third, rates = system.quadratic_gradient(mode, (load,))
            curvature, _ = bordered.solve(-third / 2, [0.0])
            linear = system.dot(third, along) + rates[load]
            cubic = system.quartic(mode) / 6 + system.dot(third, curvature)
        quadratic = system.dot(third, mode) / 2
        if not abs(quadratic) <= ASYMMETRIC * abs(cubic):
            raise ConvergenceError(
                f"the branch that crosses has no symmetry: A2 = {quadratic:.3g}, A3 = {cubic:.3g}"
            )
        load_2 = -cubic / linear
        conjugate_2 = -system.dot(force, curvature + load_2 * along) - rates[load] / 2
        vectors = mode, curvature, along
        return cls(state, load, *vectors, linear, quadratic, cubic, load_2, conjugate_2)

    def predicted(self, amplitude: float) -> State:
        """The state of the branch with an amplitude, to second order."""
        square = amplitude**2
        u = self.state.u + amplitude * self.mode + square * (self.curvature + self.load_2 * self.along)
        value = self.state.loads[self.load] + square * self.load_2
        return State(u, {**self.state.loads, self.load: value}, self.state.marks)
