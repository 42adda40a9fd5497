"""The first state of a membrane that bears load only where it has moved: the least energy at a pressure."""

from __future__ import annotations

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

FIRST, LEAST = 1e-3, 1e-9
"""Weight of the mass matrix in the first step over the pressure scale, and one that is left out instead."""

RISE, FALL = 4.0, 0.25
"""Factors of this weight after a step that is refused, and after one that is taken."""

BALANCED = 1e-9
"""Residual over the nodal forces of the pressure at which Newton's method takes over."""

MOST = 800
"""Largest number of factorisations."""

ROUNDING = 1e-14
"""Relative round-off of an energy, by which it may rise."""


def least_energy(system: System, guess: State, load: str = "p", head: float | None = None) -> State:
    r"""A minimum of the potential energy at the loads of a guess.

    Steps solve :math:`(K + \mu M)\,\Delta U = -R`. A step is taken if the matrix is positive definite, by its
    inertia, and the energy falls; else ``mu`` is raised. Newton's method from a far guess does not converge
    here: wrinkled parts have no stiffness across the wrinkles, slack ones none at all.

    Args:
        system: With a monitor ``Pi``, the potential energy, and the load.
        guess: Displacement and loads.
        load: Name of the load.
        head: Part of the load that pushes: of a level, its height above the edges; by default all of it.

    Returns:
        A state at which the tangent is positive definite.

    Raises:
        ConvergenceError: If none is reached.
    """
    factor, at = Factorization(system), guess.loads[load]
    u, weight = guess.u, FIRST
    energy, forces = _at(system, guess)
    with system.at(guess):
        pushed = (at if head is None else head) * _size(system, system.load_derivative(load))
    for _ in range(MOST):
        state = State(u, guess.loads)
        with system.at(state):
            system.tangent()
            system.shift(weight)
            factor.refactor()
        if not factor.failed and factor.negative_count() == 0:
            if weight == 0 and _size(system, forces) < BALANCED * pushed:
                return state
            step = -factor.solve(forces)
            new, left = _at(system, State(u + step, guess.loads))
            if np.isfinite(new) and new <= energy + ROUNDING * abs(energy):
                u, energy, forces = u + step, new, left
                weight = FALL * weight if weight > LEAST else 0.0
                continue
        weight = max(RISE * weight, RISE * LEAST)
    raise ConvergenceError(
        f"the energy at {load} = {at:g} has not reached its minimum after {MOST} steps; its forces are "
        f"{_size(system, forces) / pushed:.1e} of those of the pressure"
    )


def _at(system: System, state: State) -> tuple[float, np.ndarray]:
    with system.at(state):
        return system.monitor("Pi"), system.residual()


def _size(system: System, forces: np.ndarray) -> float:
    return float(np.sqrt(system.dot(forces, forces)))
