"""Tracked states of the hanging hemisphere by the methods of paper 4, over the level or the pole's height."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reference_data.solvers.paper4.cases import STEPS
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.paper4.methods.collocation import Rule, State
from reference_data.solvers.paper4.methods.shooting_measures import starts_of
from reference_data.solvers.paper4.methods.shooting_newton import Solution, solve
from reference_data.solvers.paper4.methods.states import from_grid, moved_to, polished
from reference_data.solvers.paper5.hemisphere.body import BODY, EQUATOR, Hemisphere
from reference_data.solvers.paper5.hemisphere.gas import GAS
from reference_data.solvers.paper5.hemisphere.uneven import UNEVEN

RULES = (Rule(16, 0.16), Rule(18, 0.12))
CELLS = 120


def start(body: Hemisphere, load: float) -> State:
    """The state at an easy load, from central differences that begin with a sphere lowered by a fiftieth."""
    s = np.linspace(0, EQUATOR, CELLS + 1)
    grid = fd.newton(fd.Grid(body, np.sin(s), -1.02 * np.cos(s), load), load, 200)
    return polished(from_grid(grid, RULES[0]), "load", load)


def steps_to(here: float, there: float, longest: float) -> list[float]:
    """Values from one to another, at most ``longest`` apart, without the first."""
    out = []
    while here != there:
        here = there if abs(there - here) <= longest else here + float(np.sign(there - here)) * longest
        out.append(here)
    return out


def fine(state: State, control: str, target: float) -> State:
    """The same state on the finer rule."""
    return polished(moved_to(state, RULES[1]), control, target)


@dataclass
class Walk:
    """States on the coarse rule by what is given; each is reached from the nearest one.

    Attributes:
        control: The load, or the height of the pole.
        first: Where the walk begins, from the state at an easy load.
        body: The membrane.
        easy: That load.
        steps: Longest steps below and above ``first``.
        known: States computed so far.
    """

    control: str
    first: float
    body: Hemisphere = BODY
    easy: float = -0.6
    steps: tuple[float, float] = (0.03, 0.01)
    known: dict[float, State] = field(default_factory=dict)

    def at(self, target: float) -> State:
        """The state at a value.

        Raises:
            RuntimeError: If a step fails.
        """
        if not self.known:
            self.known[self.first] = polished(start(self.body, self.easy), self.control, self.first)
        here = min(self.known, key=lambda x: abs(x - target))
        longest = self.steps[max(here, target) > self.first]
        state = self.known[here]
        for value in steps_to(here, target, longest):
            state = polished(state, self.control, value)
        self.known[target] = state
        return state


LEVELS, POLES = Walk("load", -0.6), Walk("z_pole", -1.33, steps=(0.03, 0.03))
UNEVEN_LEVELS = Walk("load", -0.6, UNEVEN)
PRESSURES = Walk("load", 0.5, GAS, 0.5, (0.05, 0.1))
GAS_POLES = Walk("z_pole", -1.03, GAS, 0.5, (0.05, 0.05))


def shots(state: State, control: str, target: float) -> list[Solution]:
    """The same state by shooting on both numbers of steps; the tracked one is the first guess only."""
    out = []
    for steps in STEPS:
        starts = starts_of(state, steps)
        starts[0] = state.y[0, 0, 2], state.y[0, 0, 1], 0.0, 0.0
        out.append(solve(state.membrane, starts, state.load, control, target, steps))
    return out
