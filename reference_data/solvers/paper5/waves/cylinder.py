"""Second variation about the tracked states of :mod:`paper4.methods`, and the cylinder of paper 5."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core.collocation import lobatto
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper5.waves.second_variation import Profile, Quadratic

FLUID = Membrane(1.5, 3, Af=0.4362)
GAS = Membrane(1.5, 3, Af=0.4362, load="gas")


def quadratic(state: State, split: int = 1, all_tense: bool = False) -> Quadratic:
    """Matrices of the second variation at a state, with polynomials of the state's degree."""
    zone, p = state.zone, state.pattern
    tense, wet = np.array(p.tense)[zone], np.array(p.wet)[zone]
    profile = Profile(
        state.membrane, state.edges, lobatto(state.rule.degree), state.y, tense, wet, state.load
    )
    return Quadratic(profile, state.rule.degree, split, all_tense)
