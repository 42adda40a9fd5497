"""The same numbers as :mod:`methods.measures`, computed independently from a shot."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Array
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper4.methods.measures import Measures, fraction_below
from reference_data.solvers.paper4.methods.shooting import SEGMENTS, Shot, local
from reference_data.solvers.paper4.methods.shooting_newton import Solution
from reference_data.solvers.paper4.methods.states import evaluate


def inside(shot: Shot, index: Any, x: Any) -> tuple[Array, Array, Array, Array]:
    """s, (r, z, A, F, V), and flags, a length x into a part, or into several."""
    parts = [shot.parts[i] for i in np.atleast_1d(index)]
    s, y = np.array([p.s for p in parts]), np.array([p.y for p in parts])
    t, w = np.array([p.tense for p in parts]), np.array([p.wet for p in parts])
    x = np.atleast_1d(np.asarray(x, dtype=float))
    return s + x, np.real(shot.advance(s, y[:, None], x, t, w)[:, 0]), t, w


def located(shot: Shot, s: Array) -> tuple[Array, Array]:
    """Parts in which positions lie, and how far."""
    starts = np.array([p.s for p in shot.parts])
    index = np.maximum(np.searchsorted(starts, s, side="right") - 1, 0)
    return index, s - starts[index]


TINY = 1e-300  # replaces an exact zero, which has no sign
Value = Callable[[int, float], float]


class Reading:
    """Ends of all the smooth parts of a shot, for finding zeros between them."""

    def __init__(self, found: Solution) -> None:
        self.found, self.shot, self.membrane = found, found.shot, found.membrane
        self.parts = [i for i, p in enumerate(self.shot.parts) if p.h > 0]
        of = [self.shot.parts[i] for i in self.parts]
        self.s, self.h = np.array([p.s for p in of]), np.array([p.h for p in of])
        self.tense, self.wet = np.array([p.tense for p in of]), np.array([p.wet for p in of])
        self.first, self.last = np.array([p.y for p in of]), np.array([p.end for p in of])

    def gw(self, which: int) -> tuple[Array, Array, Value]:
        """Of gw - 1 (1) or its derivative (2) at the parts' ends, and anywhere in a part."""

        def value(part: int, x: float) -> float:
            at, y, t, _ = inside(self.shot, part, x)
            return float(local(self.membrane, at, y, t)[which][0])

        first = local(self.membrane, self.s, self.first, self.tense)[which]
        return first, local(self.membrane, self.s + self.h, self.last, self.tense)[which], value

    def inclination(self, which: int) -> tuple[Array, Array, Value]:
        """Sine of the slope angle (1) or its derivative (2), likewise."""

        def at(s: Array, y: Array, tense: Array, wet: Array) -> Array:
            tension = np.hypot(y[:, 2], y[:, 3])
            if which == 1:
                return y[:, 2] / tension
            l1 = local(self.membrane, s, y, tense)[0]
            l2 = y[:, 0] / self.membrane.unloaded(s)
            hoop = self.membrane.eta(s) * np.where(tense, mat.slope(l2, l1, self.membrane.c2), 0.0)
            push = self.membrane.pressure(y[:, 1], self.found.load, wet) * y[:, 0] * l1
            cosine = y[:, 3] / tension
            return cosine * (hoop * cosine - push) / tension

        def value(part: int, x: float) -> float:
            return float(at(*inside(self.shot, part, x))[0])

        first = at(self.s, self.first, self.tense, self.wet)
        return first, at(self.s + self.h, self.last, self.tense, self.wet), value

    def zeros(self, first: Array, last: Array, value: Value) -> list[tuple[float, int, float, float]]:
        """(s, part, x, sign of the slope) for every change of sign inside a part, or between two."""
        first, last = (np.where(v == 0, TINY, v) for v in (first, last))
        out = []
        for i in np.nonzero(first * last < 0)[0]:
            part = self.parts[i]
            x = brentq(lambda x, part=part: value(part, x), 0.0, self.h[i], xtol=1e-14)
            out.append((float(self.s[i] + x), part, x, float(np.sign(last[i] - first[i]))))
        for i in np.nonzero(last[:-1] * first[1:] < 0)[0]:
            sign = float(np.sign(first[i + 1] - last[i]))
            out.append((float(self.s[i] + self.h[i]), self.parts[i], float(self.h[i]), sign))
        return sorted(out)


def starts_of(state: State, steps: int) -> Array:
    """First values for shooting from a tracked state, at the starts of its segments."""
    body = state.membrane
    s = body.segments(SEGMENTS, steps)[:-1]
    r, z, l1, b = np.moveaxis(evaluate(state, s), -1, 0)
    R, l2 = body.unloaded(s), r / body.unloaded(s)
    force = np.where(l2 * l2 * l1 > 1, mat.slope(l1, l2, body.c2), wri.relaxed_slope(l1, body.c2))
    tension = body.eta(s) * R * force
    return np.stack([r, z, tension * np.sin(b), tension * np.cos(b)], axis=-1)


def measures(found: Solution) -> Measures:
    """All numbers of a state for the tables."""
    shot, membrane, reading = found.shot, found.membrane, Reading(found)
    first, last, value = reading.gw(1)
    stationary = [value(i, x) for _, i, x, _ in reading.zeros(*reading.gw(2))]
    extreme = 1 + np.concatenate([first, last, stationary])
    turning = reading.zeros(*reading.inclination(1))
    radii = [float(inside(shot, i, x)[1][0, 0]) for _, i, x, _ in turning]
    fronts = shot.fronts
    if membrane.energy == "standard":
        fronts = np.array([z[0] for z in reading.zeros(first, last, value)])
    below = bool(first[0] > 0) if abs(first[0]) > 1e-12 else bool(last[0] > 0)
    scalars = {
        "V": found.volume,
        "r_max": max([membrane.radius, *radii]),
        "N": float(np.hypot(*found.starts[0, 2:4])),
        "gw_max": float(extreme.max()),
        "gw_min": float(extreme.min()),
        "wrinkled_fraction": fraction_below(fronts, below, membrane.L),
    }
    crests = np.array([z[0] for z in turning if z[3] < 0])
    troughs = np.array([z[0] for z in turning if z[3] > 0])
    return Measures(scalars, fronts, np.ones(len(fronts)), crests, troughs, below)


def profile(found: Solution, every: int) -> dict[str, Array]:
    """Columns at every ``every``-th step, from s = 0 to L."""
    shot, membrane = found.shot, found.membrane
    y = np.concatenate([shot.path[:, :-1].reshape(-1, 5), shot.path[-1, -1:]])[::every]
    s = np.linspace(0, membrane.L, len(y))
    l1, g, _ = local(membrane, s, y, np.ones(len(s), bool))
    if membrane.energy == "relaxed":
        wrinkled, h, _ = local(membrane, s, y, np.zeros(len(s), bool))
        l1, g = np.where(h < 0, wrinkled, l1), np.where(h < 0, h, g)
    return {
        "r": y[:, 0],
        "z": y[:, 1],
        "lam1": l1,
        "lam2": y[:, 0],
        "gw": g + 1,
        "tension": np.hypot(y[:, 2], y[:, 3]),
    }
