"""Paper 1: states that Newton's method begins from."""

from __future__ import annotations

import numpy as np

from weakforms.problems.disk.model import DiskModel
from weakforms.problems.homogeneous.material_point import evaluated
from weakforms.problems.material_choice import Chosen
from weakforms.solvers.equilibrium.system import State

HIGHEST_P = 50.0
"""Largest pressure at which inflation may end."""

FIRST_T0 = 0.05
"""Pole height of the first state of a disk without tension at rest, whose tangent is singular there."""


def parabola(x: np.ndarray, law: Chosen, beta: float) -> tuple[np.ndarray, float]:
    """A first state of pole height ``FIRST_T0``, slightly stretched, and the pressure its tension carries.

    Args:
        x: Radius of every degree of freedom, ``lam2`` and ``eta`` in turn.
        law: The membrane's.
        beta: Pre-stretch.
    """
    lam = beta + 0.3 * FIRST_T0**2
    square = (x * beta) ** 2
    u = np.empty_like(x)
    u[0::2] = beta + (lam - beta) * (1 - square[0::2])
    u[1::2] = FIRST_T0 * (1 - square[1::2])
    tension = evaluated(law, lam, lam)["W1"]
    return u, 4 * FIRST_T0 * tension / beta


def stick_guess(model: DiskModel, slipped: State, lam2_front: float) -> State:
    """A frictionless state as a guess for the stuck model with the same mesh and front."""
    s = np.repeat(model.space.tabulate_dof_coordinates()[: model.system.size // 2, 0], 2)
    u = slipped.u.copy()
    stretch = np.arange(len(u)) % 2 == 0
    outside = s > 1 + 1e-12
    u[stretch & ~outside] = 0.0
    # Lifted by its own stretch at the front, not by the series': the two differ, and a jump would be torn.
    u[stretch & outside] -= (lam2_front * (2 - s))[stretch & outside]
    if model.bond.rigid:
        u[~stretch & ~outside] = model.data.l
    return State(u, dict(slipped.loads))
