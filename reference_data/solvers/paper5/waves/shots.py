"""Shots of :mod:`methods.shooting` as base states of :mod:`waves.transfer`."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.paper4.methods.shooting_measures import inside
from reference_data.solvers.paper4.methods.shooting_newton import Solution
from reference_data.solvers.paper5.waves.transfer import Array, Parts


def parts(found: Solution) -> Parts:
    """The smooth pieces of a converged shot."""
    pieces = [p for p in found.shot.parts if p.h > 0]
    return Parts(
        found.membrane,
        np.array([p.s for p in pieces]),
        np.array([p.h for p in pieces]),
        np.array([p.tense for p in pieces]),
        np.array([p.wet for p in pieces]),
        np.array([p.y[:4] for p in pieces]),
        found.load,
    )


def split(low: float, high: float, n: float, longest: float, reach: float) -> Array:
    """Ends of parts between two angles: none longer than reach R/n, or longest."""
    marks = [low]
    while marks[-1] < high:
        t = marks[-1]
        marks.append(t + min(longest, reach * float(np.sin(t)) / max(n, 5.0)))
    return np.concatenate([marks[:-1], [high]])


def hemisphere_parts(found: Solution, n: float, fineness: float) -> Parts:
    """Smooth pieces of a shot from the pole, short enough for a wave number.

    Clamped where the expansion ends: for n >= 4 the modes there are below rounding.
    """
    pieces = [(i, p) for i, p in enumerate(found.shot.parts) if p.h > 0]
    marks = [split(p.s, p.s + p.h, n, 0.02 / fineness, 1.0 / fineness) for _, p in pieces]
    s = np.concatenate([m[:-1] for m in marks])
    index = np.repeat([i for i, _ in pieces], [len(m) - 1 for m in marks])
    start = np.repeat([p.s for _, p in pieces], [len(m) - 1 for m in marks])
    _, y, tense, wet = inside(found.shot, index, s - start)
    h = np.concatenate([np.diff(m) for m in marks])
    return Parts(found.membrane, s, h, tense, wet, y[:, :4], found.load)
