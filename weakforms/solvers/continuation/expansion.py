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

A small imperfection ``ε`` adds ``ε B`` to that equation, with ``B = Π_ε'[φ]``. The states then are

.. math:: λ - λ_c = λ_2 ξ^2 - \frac{ε B}{A_1 ξ}, \qquad V - V_c = V_2 ξ^2 - \frac{\dot V ε B}{A_1 ξ}

with ``Vdot`` the rate of ``V`` along the crossed branch. Both have an extremum, which follows Koiter's
two-thirds law:

.. math:: λ_s - λ_c = 3 λ_2 \left|\frac{ε B}{2 A_1 λ_2}\right|^{2/3} \text{ at } ξ^3 = -\frac{ε B}{2 A_1 λ_2}
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
    conjugate_rate: float
    """``Vdot``, for a load that the potential is linear in."""
    push: float
    """``B``; zero without an imperfection."""

    @classmethod
    def at(
        cls, solver: ExtendedNewton, state: State, load: str, amplitude: str, imperfection: str = ""
    ) -> Self:
        """The expansion at a state that was located.

        Args:
            solver: Of the equilibrium equations.
            state: The state.
            load: The load ``λ``.
            amplitude: The functional whose gradient is ``c``.
            imperfection: The load ``ε``, zero at the state, if there is one.

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
            push = system.dot(mode, system.load_derivative(imperfection)) if imperfection else 0.0
        quadratic = system.dot(third, mode) / 2
        if not abs(quadratic) <= ASYMMETRIC * abs(cubic):
            raise ConvergenceError(
                f"the branch that crosses has no symmetry: A2 = {quadratic:.3g}, A3 = {cubic:.3g}"
            )
        load_2 = -cubic / linear
        conjugate_2 = -system.dot(force, curvature + load_2 * along) - rates[load] / 2
        conjugate_rate = -system.dot(force, along)
        vectors, amplitudes = (mode, curvature, along), (linear, quadratic, cubic)
        return cls(
            state, load, *vectors, *amplitudes, load_2, conjugate_2, conjugate_rate=conjugate_rate, push=push
        )

    @property
    def two_thirds(self) -> dict[str, float]:
        """Coefficients of ``|ε|^(2/3)`` in the extrema of the load and of its conjugate, by their names."""
        found = {"load": (self.load_2, 1.0), "conjugate": (self.conjugate_2, self.conjugate_rate)}
        return {
            name: 3 * second * abs(rate * self.push / (2 * self.linear * second)) ** (2 / 3)
            for name, (second, rate) in found.items()
        }

    def amplitude_of_extremum(self, imperfection: float) -> float:
        """Amplitude at which the conjugate of the load has its extremum, to first order."""
        force = self.conjugate_rate * imperfection * self.push
        return float(np.cbrt(-force / (2 * self.linear * self.conjugate_2)))

    def predicted(self, amplitude: float) -> State:
        """The state of the branch with an amplitude, to second order."""
        square = amplitude**2
        u = self.state.u + amplitude * self.mode + square * (self.curvature + self.load_2 * self.along)
        value = self.state.loads[self.load] + square * self.load_2
        return State(u, {**self.state.loads, self.load: value}, self.state.marks)
