"""Numbers of a tracked equilibrium: fronts, extremes, volume, tension."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import lagrange, lobatto
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Array
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper4.methods.states import evaluate, wrinkling

SCALARS = ("V", "r_max", "N", "gw_max", "gw_min", "wrinkled_fraction")
TINY = 1e-300  # replaces an exact zero, which has no sign
GRID = np.linspace(0, 1, 33)


@dataclass
class Measures:
    """Numbers of one state.

    Attributes:
        scalars: By the names in SCALARS.
        fronts: Positions where gw = 1 is crossed, rising.
        slopes: Least |d gw/ds| on either side of each front.
        crests: Positions of the local maxima of r.
        troughs: Positions of the local minima of r.
        first: Whether gw > 1 below the first front.
    """

    scalars: dict[str, float]
    fronts: Array
    slopes: Array
    crests: Array
    troughs: Array
    first: bool


def fraction_below(fronts: Array, first: bool, length: float) -> float:
    """Fraction of the length with gw < 1, from the state below the first front."""
    marks = np.concatenate([[0.0], fronts, [length]])
    wrinkled = (np.arange(len(marks) - 1) % 2 == 0) != first
    return float(np.sum(np.diff(marks)[wrinkled])) / length


def roots(state: State, values: Array) -> list[tuple[float, float]]:
    """Zeros, rising, of the piecewise polynomial ``values``, with the slope's sign there."""
    nodes, mesh, found = lobatto(state.rule.degree), state.mesh, []
    fine = values @ lagrange(nodes, GRID).T
    fine[fine == 0] = TINY
    for e, i in zip(*np.nonzero(fine[:, :-1] * fine[:, 1:] < 0), strict=True):

        def at(x: float, e: int = e) -> float:
            return float((lagrange(nodes, np.array([x])) @ values[e])[0]) or TINY

        x = brentq(at, GRID[i], GRID[i + 1], xtol=1e-15)
        s = mesh.edges[e] + x * mesh.widths[e]
        found.append((float(s), float(np.sign(fine[e, i + 1] - fine[e, i]))))
    for e in np.nonzero(fine[:-1, -1] * fine[1:, 0] < 0)[0]:
        found.append((float(mesh.edges[e + 1]), float(np.sign(fine[e + 1, 0] - fine[e, -1]))))
    return sorted(found)


def measures(state: State) -> Measures:
    """All numbers of a state for the tables."""
    membrane, y = state.membrane, state.y
    g = wrinkling(membrane, state.s, y)
    slope = state.mesh.slope(g)
    stationary = np.array([s for s, _ in roots(state, slope)])
    extreme = np.concatenate([g.ravel(), wrinkling(membrane, stationary, evaluate(state, stationary))]) + 1
    turning = roots(state, y[..., 3])
    radii = [float(evaluate(state, np.array(s))[0]) for s, _ in turning]
    if membrane.energy == "standard":
        crossing = roots(state, g)
        fronts = np.array([s for s, _ in crossing])
        slopes = np.array([abs(float(np.interp(s, state.s.ravel(), slope.ravel()))) for s in fronts])
        first = bool(g[0, 0] > 0) if abs(g[0, 0]) > 1e-12 else bool(g[0, 1] > 0)
    else:
        fronts, first = state.pattern.fronts, state.pattern.tense[0]
        last = np.cumsum(state.counts)[:-1]
        at = [n for n, k in zip(last, state.pattern.kinds, strict=True) if k == "front"]
        slopes = np.array([min(abs(slope[n - 1, -1]), abs(slope[n, 0])) for n in at])
    r, _, l1, _ = y[0, 0]
    tense = membrane.energy == "standard" or state.pattern.tense[0]
    force = mat.slope(l1, r, membrane.c2) if tense else wri.relaxed_slope(l1, membrane.c2)
    scalars = {
        "V": state.volume,
        "r_max": max([membrane.radius, *radii]),
        "N": float(membrane.eta(0.0) * force),
        "gw_max": float(extreme.max()),
        "gw_min": float(extreme.min()),
        "wrinkled_fraction": fraction_below(fronts, first, membrane.L),
    }
    crests = np.array([s for s, sign in turning if sign < 0])
    troughs = np.array([s for s, sign in turning if sign > 0])
    return Measures(scalars, fronts, slopes, crests, troughs, first)


def profile(state: State, s: Array) -> dict[str, Array]:
    """Columns r, z, lam1, lam2, gw and tension at positions s."""
    r, z, l1, _ = np.moveaxis(evaluate(state, s), -1, 0)
    c2, zone = state.membrane.c2, np.searchsorted(np.array(state.pattern.breaks[1:-1]), s)
    tense = np.array(state.pattern.tense)[zone]
    force = np.where(tense, mat.slope(l1, r, c2), wri.relaxed_slope(l1, c2))
    return {
        "r": r,
        "z": z,
        "lam1": l1,
        "lam2": r,
        "gw": r * np.sqrt(l1),
        "tension": state.membrane.eta(s) * force,
    }
