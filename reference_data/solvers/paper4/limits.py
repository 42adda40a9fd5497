"""Limit loads: d load/d V = 0 with the enclosed volume V as the control.

The derivative comes from the bordered linear system at each state, which is regular at a limit
load, fronts and surface included.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reference_data.solvers.core.newton import secant
from reference_data.solvers.paper4.cases import STEPS, Pair, grid_at
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.methods.collocation import State

NOISE = 3e-13  # of d load/d V, relative to the load
RULES = (sta.Rule(18, 0.3), sta.Rule(20, 0.22))  # the membrane is stretched far at its limit


@dataclass
class Limit:
    """Load, V and r_max at a limit load by both methods."""

    membrane: Membrane
    values: dict[str, tuple[Pair, Pair]]


def climbed(membrane: Membrane, load: float, step: float, most: int = 200) -> tuple[State, float, float]:
    """The first state past the limit load, by raising V from a state at a given load.

    Returns:
        The state, its volume, and the volume one step before.

    Raises:
        RuntimeError: If there is no limit load within ``most`` steps.
    """
    guess = sta.from_grid(grid_at(membrane, load), sta.RULES[0])
    state = sta.polished(guess, "load", load)
    for _ in range(most):
        before = state.volume
        state = sta.polished(state, "V", before + step)
        if state.rate("V") < 0:
            return state, before + step, before
    raise RuntimeError(f"collocation: no limit load of {membrane}")


def by_collocation(
    first: State, v0: float, v1: float, rule: sta.Rule
) -> tuple[State, float, dict[str, float]]:
    """State, d2 load/d V2 and numbers at the limit load."""
    here = [sta.moved_to(first, rule)]

    def value(v: float) -> float:
        here[0] = sta.polished(here[0], "V", v)
        return here[0].rate("V")

    v, bend = secant(value, v0, v1)
    value(v)
    radius = msr.measures(here[0]).scalars["r_max"]
    return here[0], bend, {"load": here[0].load, "V": v, "r_max": radius}


def by_shooting(state: State, v: float, steps: int) -> dict[str, float]:
    """Numbers at the limit load, by one secant step from the volume found by collocation."""
    other, found = v * (1 - 1e-3), []
    for target in (v, other):
        shot = sho.solve(state.membrane, smsr.starts_of(state, steps), state.load, "V", target, steps)
        found.append((shot.rate, shot.load, smsr.measures(shot).scalars["r_max"]))
    (rate0, load, radius), (rate1, _, radius1) = found
    move = -rate0 * (other - v) / (rate1 - rate0)
    return {
        "load": load + rate0 * move / 2,
        "V": v + move,
        "r_max": radius + (radius1 - radius) * move / (other - v),
    }


def limit(membrane: Membrane, load: float, step: float) -> Limit:
    """The first limit load above a given load, searched by raising V in steps of ``step``."""
    past, v1, v0 = climbed(membrane, load, step)
    a = [by_collocation(past, v1, v0, rule) for rule in RULES]
    state, bend, fine = a[1]
    b = [by_shooting(state, fine["V"], 2 * n) for n in STEPS]
    loose = NOISE * max(1.0, fine["load"]) / abs(bend)  # V follows from a slope that is nearly flat
    floors = {"load": 0.0, "V": loose, "r_max": loose * fine["r_max"] / fine["V"]}
    values = {
        k: (
            Pair(np.array(a[0][2][k]), np.array(fine[k]), floors[k]),
            Pair(np.array(b[0][k]), np.array(b[1][k]), floors[k]),
        )
        for k in fine
    }
    return Limit(membrane, values)
