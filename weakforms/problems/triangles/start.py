"""The first state of a branch of a membrane that may have no stiffness without load."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

TAUT_START = 1.15
"""Stretch of the supports from which one with less stretch is approached, at the same height."""

FIRST_SHARE, LEAST_SHARE = 0.25, 1e-3
"""First and smallest step of that approach, as a fraction of it."""


def first_state(
    solver: ExtendedNewton, height: float, wanted: Mapping[str, float], guess: np.ndarray
) -> State:
    """Equilibrium with a small height ``w_c``.

    Supports that stretch the sheet give it stiffness against deflection, and Newton's method starts from the
    guess. A slack membrane is approached from a taut one at this height, in steps that are halved if one
    fails.

    Args:
        solver: Solves for displacement and load.
        height: The height.
        wanted: Stretches of the supports, by the names of these loads.
        guess: Displacement, owned degrees of freedom.

    Raises:
        ConvergenceError: If the state is not reached.
    """
    taut = {name: max(value, TAUT_START) for name, value in wanted.items()}
    if min(wanted.values()) >= TAUT_START:
        taut = dict(wanted)
    held = [Held("w_c", height)]

    def at(share: float, guess: State) -> State:
        frame = {name: value + share * (wanted[name] - value) for name, value in taut.items()}
        return solver.solve(State(guess.u, guess.loads | frame), held)[0]

    state = at(0.0, State(guess, solver.system.initial.loads))
    done, step = 0.0, 1.0 if taut == wanted else FIRST_SHARE
    while done < 1.0:
        share = min(1.0, done + step)
        try:
            state, done = at(share, state), share
        except ConvergenceError:
            step /= 2
            if step < LEAST_SHARE:
                raise
    return State(state.u, state.loads | wanted)
