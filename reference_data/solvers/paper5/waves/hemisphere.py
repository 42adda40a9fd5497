"""Second variation about the states of :mod:`hemisphere.states`."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.paper5.hemisphere.collocation import C2, KAPPA, Hanging
from reference_data.solvers.paper5.waves.second_variation import Profile, Quadratic, Surface

SURFACE = Surface(np.sin, np.ones_like, C2, pole=True)


def profile(state: Hanging) -> Profile:
    """A tracked state, as the second variation takes it."""
    zone, p = state.zone, state.pattern
    return Profile(
        SURFACE,
        state.edges,
        state.rule.nodes,
        state.y,
        np.array(p.tense)[zone],
        np.array(p.wet)[zone],
        lambda z: KAPPA * (state.zw - z),
        KAPPA,
    )


def quadratic(state: Hanging, split: int = 1) -> Quadratic:
    """Matrices of the second variation at a state, with polynomials of the state's degree."""
    return Quadratic(profile(state), state.rule.degree, split)
