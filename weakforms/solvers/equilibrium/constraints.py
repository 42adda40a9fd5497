"""Scalar equations for an equilibrium with unknown loads: load, functional, arc length, fold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from weakforms.solvers.equilibrium.linear import BorderedMatrix
from weakforms.solvers.equilibrium.newton import ExtendedNewton


@dataclass(frozen=True)
class Plane:
    r"""The condition ``row·U + Σ weight_λ λ = target``: an arc-length step, or a load at a fixed value."""

    row: np.ndarray
    weights: dict[str, float]
    target: float

    def value(self, solver: ExtendedNewton) -> float:
        """Distance from the plane."""
        system = solver.system
        loads = sum(w * system.load(name) for name, w in self.weights.items())
        return system.dot(self.row, system.owned()) + loads - self.target

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """The gradient, which is constant."""
        return self.row, self.weights


@dataclass(frozen=True)
class Held:
    """The condition that a functional, or a load, has a prescribed value."""

    name: str
    target: float

    def value(self, solver: ExtendedNewton) -> float:
        """Difference from the prescribed value."""
        system = solver.system
        known = system.load(self.name) if self._is_load(solver) else system.monitor(self.name)
        return known - self.target

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """The gradient, from the derivative of the functional's form."""
        system = solver.system
        if self._is_load(solver):
            return np.zeros(system.size), {self.name: 1.0}
        return system.monitor_gradient(self.name, solver.scalars)

    def _is_load(self, solver: ExtendedNewton) -> bool:
        return self.name in solver.system.load_names


@dataclass(frozen=True)
class MonitorPlane:
    """The condition ``Σ weight_m m(U, λ) = target`` over functionals and loads: a plane across a branch."""

    weights: dict[str, float]
    target: float

    def value(self, solver: ExtendedNewton) -> float:
        """Distance from the plane."""
        return sum(w * Held(n, 0.0).value(solver) for n, w in self.weights.items()) - self.target

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """Weighted sum of the functionals' gradients."""
        row, loads = np.zeros(solver.system.size), {}
        for name, weight in self.weights.items():
            part, rates = Held(name, 0.0).gradient(solver)
            row = row + weight * part
            loads = {k: loads.get(k, 0.0) + weight * rates.get(k, 0.0) for k in {*loads, *rates}}
        return row, loads


@dataclass(frozen=True)
class Fold:
    r"""The condition ``q = 0`` for a fold of a curve of equilibria in one load ``λ``.

    With a fixed vector ``c`` the bordered system

    .. math:: \begin{pmatrix} K & R_\lambda \\ c^T & 0 \end{pmatrix}
              \begin{pmatrix} \varphi \\ q \end{pmatrix} = \begin{pmatrix} 0 \\ 1 \end{pmatrix}

    gives ``q = dλ/d(cᵀU)`` along the curve. It vanishes exactly where ``K φ = 0``; unlike ``det K`` it does
    so linearly and is well scaled. By the transposed system (``ψ``, normalised to ``ψᵀR_λ = 1``)

    .. math:: \mathrm{d}q = -\mathrm{d}(\psi^T K \varphi + q\, \psi^T R_\lambda)

    at fixed ``φ, ψ, q`` inside the bracket (Griewank & Reddien 1984; Govaerts 2000, chapter 3).
    """

    load: str
    border: np.ndarray

    def vectors(self, solver: ExtendedNewton) -> tuple[np.ndarray, np.ndarray, float]:
        """``(φ, ψ, q)``; ``K`` must be factorised at the state that the system is lent to."""
        rate = solver.system.load_derivative(self.load)
        phi, q = self._solution(solver, rate, self.border)
        psi, _ = self._solution(solver, self.border, rate)
        return phi, psi, q

    @staticmethod
    def _solution(solver: ExtendedNewton, column: np.ndarray, row: np.ndarray) -> tuple[np.ndarray, float]:
        vector, q = BorderedMatrix(solver.factor, [column], [row], np.zeros((1, 1))).solve(None, [1.0])
        return vector, float(q[0])

    def value(self, solver: ExtendedNewton) -> float:
        """The value of ``q``; factorises ``K``."""
        solver.factor.update()
        _, q = self._solution(solver, solver.system.load_derivative(self.load), self.border)
        return q

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """The gradient, from the third variation."""
        phi, psi, q = self.vectors(solver)
        row, loads = solver.system.third_variation(phi, psi, self.load, q)
        return -row, {name: -value for name, value in loads.items()}

    def curvature(self, solver: ExtendedNewton) -> float:
        """``d²λ/d(cᵀU)²`` at the fold that the system is lent to; it is zero at a cusp."""
        solver.factor.update()
        phi, _, q = self.vectors(solver)
        row, loads = self.gradient(solver)
        return solver.system.dot(row, phi) + q * loads[self.load]
