"""Second variation about the states of :mod:`methods.states`: the cylinder of paper 5."""

from __future__ import annotations

from functools import cache

import numpy as np

from reference_data.solvers.paper4.material import Array, Membrane
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper5.waves.second_variation import Profile, Quadratic, Surface

FLUID = Membrane(1.5, 3, Af=0.4362)
GAS = Membrane(1.5, 3, Af=0.4362, load="gas")


@cache
def surface(membrane: Membrane) -> Surface:
    """The unloaded cylinder."""

    def one(s: Array) -> Array:
        return np.ones_like(s)

    return Surface(one, membrane.eta, membrane.c2)


def profile(state: State) -> Profile:
    """A tracked state, as the second variation takes it."""
    membrane, zone, p = state.membrane, state.zone, state.pattern
    return Profile(
        surface(membrane),
        state.edges,
        state.rule.nodes,
        state.y,
        np.array(p.tense)[zone],
        np.array(p.wet)[zone],
        lambda z: membrane.pressure(z, state.load, True),
        0.0 if membrane.load == "gas" else membrane.gamma,
    )


def quadratic(state: State, split: int = 1, all_tense: bool = False) -> Quadratic:
    """Matrices of the second variation at a state, with polynomials of the state's degree."""
    return Quadratic(profile(state), state.rule.degree, split, all_tense)
