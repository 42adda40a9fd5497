"""The branch of the hanging hemisphere past its limit point, by both methods."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.paper5.hemisphere import shooting as hsh
from reference_data.solvers.paper5.hemisphere import states as hem
from reference_data.solvers.paper5.hemisphere.collocation import Hanging, linearised

Array = np.ndarray
STEPS = (0.02, 0.01)  # between the heights of the pole whose levels are fitted by a quartic


KNOWN: dict[float, tuple[Hanging, Hanging]] = {}


def held(z_pole: float) -> tuple[Hanging, Hanging]:
    """States with the pole at a given height (below -1.3), coarse and fine, in steps from the nearest."""
    if not KNOWN:
        state = hem.polished(hem.start(-0.6), "z_pole", -1.33)
        KNOWN[-1.33] = state, hem.polished(hem.moved_to(state, hem.RULES[1]), "z_pole", -1.33)
    here = min(KNOWN, key=lambda z: abs(z - z_pole))
    state = KNOWN[here][0]
    while here != z_pole:
        here = z_pole if abs(z_pole - here) <= 0.03 else here + 0.03 * float(np.sign(z_pole - here))
        state = hem.polished(state, "z_pole", here)
    if z_pole not in KNOWN:
        KNOWN[z_pole] = state, hem.polished(hem.moved_to(state, hem.RULES[1]), "z_pole", z_pole)
    return KNOWN[z_pole]


def rate(state: Hanging) -> float:
    """Derivative d zw/d z_pole from Newton's matrix."""
    a, b = linearised(state, "z_pole", float(state.y[0, 0, 1]))
    unit = np.zeros_like(b)
    unit[-1] = 1.0
    return float(np.linalg.solve(a, unit)[-1])


def shots(z_pole: float) -> list[hsh.Shot]:
    """The same by shooting, coarse and fine."""
    state, out = held(z_pole)[0], []
    for tol in hsh.TOLERANCES:
        out.append(hsh.solve(float(state.y[0, 0, 2]), z_pole, "z_pole", z_pole, tol, state.zw))
    return out


@dataclass
class Limit:
    """The largest level: (z_pole, zw, V) on two resolutions, by collocation and by shooting."""

    collocation: list[Array]
    shooting: list[Array]


def limit() -> Limit:
    """Root of d zw/d z_pole; by shooting, the maximum of the quartic through five levels."""
    first = held(-1.57)
    out = []
    for i in (0, 1):
        state = [first[i]]

        def slope(z_pole: float, state: list[Hanging] = state) -> float:
            state[0] = hem.polished(state[0], "z_pole", z_pole)
            return rate(state[0])

        z_pole = float(brentq(slope, -1.60, -1.54, xtol=1e-12))
        end = hem.polished(state[0], "z_pole", z_pole)
        out.append(np.array([z_pole, end.zw, end.volume]))
    middle = round(float(out[1][0]), 3)
    shooting = []
    for i, step in enumerate(STEPS):  # tolerance and spacing are refined together
        heights = middle + step * np.arange(-2, 3)
        found = [shots(float(z))[i] for z in heights]
        fits = [np.polyfit(heights - middle, [getattr(x, k) for x in found], 4) for k in ("zw", "volume")]
        roots = np.roots(np.polyder(fits[0]))
        x = float(np.real(roots[np.abs(roots).argmin()]))
        shooting.append(np.array([middle + x, np.polyval(fits[0], x), np.polyval(fits[1], x)]))
    return Limit(out, shooting)
