"""Scalar equations for an equilibrium with unknown loads: load, functional, arc length."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

import numpy as np

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
    """The condition ``Σ weight_m m(U, λ) = target`` over functionals and loads: a plane across a branch.

    It is divided by the length of the weights: where a functional grows steeply along the branch, round-off
    of the undivided sum would exceed the limit of residuals.
    """

    weights: dict[str, float]
    target: float

    @property
    def _normal(self) -> dict[str, float]:
        return {name: weight / self._length for name, weight in self.weights.items()}

    @property
    def _length(self) -> float:
        return hypot(*self.weights.values())

    def value(self, solver: ExtendedNewton) -> float:
        """Distance from the plane."""
        place = sum(w * Held(n, 0.0).value(solver) for n, w in self._normal.items())
        return place - self.target / self._length

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """Weighted sum of the functionals' gradients."""
        row, loads = np.zeros(solver.system.size), {}
        for name, weight in self._normal.items():
            part, rates = Held(name, 0.0).gradient(solver)
            row = row + weight * part
            loads = {k: loads.get(k, 0.0) + weight * rates.get(k, 0.0) for k in {*loads, *rates}}
        return row, loads
