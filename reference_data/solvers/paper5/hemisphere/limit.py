"""The branch of the hanging hemisphere past its limit point, by both methods."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.collocation import Array
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper4.methods.shooting_newton import Solution
from reference_data.solvers.paper5.hemisphere import states as hem

STEPS = (0.02, 0.01)  # between the heights of the pole whose levels are fitted by a quartic


def held(z_pole: float, poles: hem.Walk = hem.POLES) -> tuple[State, State]:
    """States with the pole at a given height (below -1.3 under liquid), coarse and fine."""
    coarse = poles.at(z_pole)
    return coarse, hem.fine(coarse, "z_pole", z_pole)


def shots(z_pole: float, poles: hem.Walk = hem.POLES) -> list[Solution]:
    """The same by shooting, coarse and fine."""
    return hem.shots(poles.at(z_pole), "z_pole", z_pole)


@dataclass
class Limit:
    """The largest load: (z_pole, load, V) on two resolutions, by collocation and by shooting."""

    collocation: list[Array]
    shooting: list[Array]


def limit(poles: hem.Walk = hem.POLES, between: tuple[float, float, float] = (-1.60, -1.57, -1.54)) -> Limit:
    """Root of d load/d z_pole; by shooting, the maximum of the quartic through five loads.

    Args:
        poles: States of the membrane by the height of the pole.
        between: Heights below, near and above the root.
    """
    out = []
    low, near, high = between
    for first in held(near, poles):
        state = [first]

        def slope(z_pole: float, state: list[State] = state) -> float:
            state[0] = hem.polished(state[0], "z_pole", z_pole)
            return state[0].rate("z_pole")

        z_pole = float(brentq(slope, low, high, xtol=1e-12))
        end = hem.polished(state[0], "z_pole", z_pole)
        out.append(np.array([z_pole, end.load, end.volume]))
    middle = round(float(out[1][0]), 3)
    shooting = []
    for i, step in enumerate(STEPS):  # tolerance and spacing are refined together
        heights = middle + step * np.arange(-2, 3)
        found = [shots(float(z), poles)[i] for z in heights]
        fits = [np.polyfit(heights - middle, [getattr(x, k) for x in found], 4) for k in ("load", "volume")]
        roots = np.roots(np.polyder(fits[0]))
        x = float(np.real(roots[np.abs(roots).argmin()]))
        shooting.append(np.array([middle + x, np.polyval(fits[0], x), np.polyval(fits[1], x)]))
    return Limit(out, shooting)
