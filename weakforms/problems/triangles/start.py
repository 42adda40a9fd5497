"""The first state of a branch of a membrane that may have no stiffness without load."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import sqrt

import numpy as np
from dolfinx import fem

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

TAUT_START = 1.15
"""Stretch of the supports from which one with less stretch is approached, at the same height."""

FIRST_SHARE, LEAST_SHARE = 0.25, 1e-3
"""First and smallest step of that approach, as a fraction of it."""

SLACK, SLACK_START = 1.05, 0.2
"""Stretch below which a sheet counts as slack; first height of its states under a liquid."""

LIGHTER, LIGHTEST = 0.5, 1 / 64
"""Factor by which the liquid is made lighter to find a first state, and the smallest share of its weight."""


def begins(start: float, stretch: float, load: str) -> float:
    """Height at the first point: the one asked for, or a larger one.

    A small pond on a slack sheet wets only the neighbourhood of the centre, which no mesh resolves.

    Args:
        start: The height asked for.
        stretch: Least stretch of the supports.
        load: ``gas`` or ``liquid``.
    """
    return max(start, SLACK_START) if stretch < SLACK and load == "liquid" else start


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


def first_under_load(
    solver: ExtendedNewton,
    height: float,
    wanted: Mapping[str, float],
    guess: np.ndarray,
    weight: fem.Constant,
) -> State:
    """As :func:`first_state`; under a heavy liquid by way of lighter ones.

    A liquid heavier than the critical one wets a part of the sheet only, whose edge Newton's method does not
    find from a guess that is wet all over.

    Args:
        solver: Solves for displacement and load.
        height: The height.
        wanted: Stretches of the supports, by the names of these loads.
        guess: Displacement, owned degrees of freedom.
        weight: Weight of the liquid in the form; zero for gas.

    Raises:
        ConvergenceError: If it is found under no liquid, or is lost while the weight is raised.
    """
    share, state = 1.0, None
    while state is None:
        try:
            with _lighter(weight, share):
                state = first_state(solver, height, wanted, guess)
        except ConvergenceError:
            if not weight.value or share <= LIGHTEST:
                raise
            share *= LIGHTER
    while share < 1.0:
        share = min(1.0, share / sqrt(LIGHTER))
        with _lighter(weight, share):
            state = solver.solve(state, [Held("w_c", height)])[0]
    return state


@contextmanager
def _lighter(weight: fem.Constant, share: float) -> Iterator[None]:
    """Let the liquid have a share of its weight inside of this context."""
    own = weight.value.copy()
    weight.value = share * own
    try:
        yield
    finally:
        weight.value = own
