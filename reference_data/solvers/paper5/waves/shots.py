"""Shots of :mod:`methods.shooting` as base states of :mod:`waves.transfer`."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.paper4.methods.shooting_newton import Solution
from reference_data.solvers.paper5.hemisphere.collocation import KAPPA
from reference_data.solvers.paper5.hemisphere.shooting import Shot
from reference_data.solvers.paper5.waves.cylinder import surface
from reference_data.solvers.paper5.waves.hemisphere import SURFACE
from reference_data.solvers.paper5.waves.transfer import Array, Parts


def parts(found: Solution) -> Parts:
    """The smooth pieces of a converged shot."""
    pieces = [p for p in found.shot.parts if p.h > 0]
    membrane, load = found.membrane, found.load
    return Parts(
        surface(membrane),
        np.array([p.s for p in pieces]),
        np.array([p.h for p in pieces]),
        np.array([p.tense for p in pieces]),
        np.array([p.wet for p in pieces]),
        np.array([p.y[:4] for p in pieces]),
        lambda z: membrane.pressure(z, load, True),
        0.0 if membrane.load == "gas" else membrane.gamma,
    )


def split(low: float, high: float, n: float, longest: float, reach: float) -> Array:
    """Ends of parts between two angles: none longer than reach R/n, or longest."""
    marks = [low]
    while marks[-1] < high:
        t = marks[-1]
        marks.append(t + min(longest, reach * float(np.sin(t)) / max(n, 5.0)))
    return np.concatenate([marks[:-1], [high]])


def hemisphere_parts(found: Shot, n: float, fineness: float) -> Parts:
    """Smooth pieces of a shot from the pole, short enough for a wave number.

    Clamped where the expansion ends: for n >= 4 the modes there are below rounding.
    """
    s, h, tense, wet, y = [], [], [], [], []
    for p in found.pieces:
        marks = split(p.low, p.high, n, 0.02 / fineness, 1.0 / fineness)
        s.append(marks[:-1])
        h.append(np.diff(marks))
        y.append(np.array([p.curve(t) for t in marks[:-1]]))
        tense += [p.tense] * (len(marks) - 1)
        wet += [p.wet] * (len(marks) - 1)
    return Parts(
        SURFACE,
        np.concatenate(s),
        np.concatenate(h),
        np.array(tense),
        np.array(wet),
        np.concatenate(y),
        lambda z: KAPPA * (found.zw - z),
        KAPPA,
    )
