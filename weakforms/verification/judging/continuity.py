"""Order of continuity of a sampled field at a front, measured.

On each side of the front a polynomial is fitted to the samples over a window, and the derivatives of both are
compared at the front. The first derivative with a jump gives the order.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging import decide
from weakforms.verification.judging.decide import Finding, Number, Stated
from weakforms.verification.run.solutions import Solutions

NODES, FIT, HIGHEST = 30, 9, 4
"""Number of samples on each side, degree of the fit, and first derivative that is not measured."""

VANISHES = Stated(2e-3, "continuous", "the error of fitted polynomials for a derivative that does not jump")
JUMPS = Stated(1e-2, "jumps", "five times the limit for continuity; values in between are not decided")


def samples(front: float, window: float) -> tuple[float, ...]:
    """Sample points: Chebyshev points of the windows on both sides."""
    offsets = window * (1 - np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)) / 2
    return tuple(sorted([*(front - offsets), *(front + offsets)]))


def jumps(offset: np.ndarray, values: Number, window: float) -> Number:
    """Relative jumps of the derivatives 0 to 3, with uncertainties from the samples.

    Args:
        offset: Distance of the samples from the front, negative on one side.
        values: Values of the field at these points.
        window: Length of the windows.
    """
    (before, largest), (after, other) = (one_sided(offset, values, side, window) for side in (-1, 1))
    return abs(before - after) / np.maximum(largest, other)


def first_jumps(
    solutions: Solutions, spec: Spec, at: At, front: float, window: float, expected: Mapping[str, int]
) -> Finding:
    """Whether the first derivatives that jump at a front are the expected ones."""
    found = []
    for name, first in expected.items():
        measured = jumps(np.asarray(at.profile) - front, solutions.samples(spec, at, name), window)
        if first:
            found.append(decide.at_most(f"{name}, derivatives below {first}", measured[:first], VANISHES))
        if first < HIGHEST:
            found.append(decide.at_least(f"{name}, derivative {first}", measured[first], JUMPS))
    return decide.all_of(found)


def one_sided(offset: np.ndarray, values: Number, side: int, window: float) -> tuple[Number, np.ndarray]:
    """Derivatives 0 to 3 at a front from one side, and their largest magnitudes in half the window.

    A derivative of the fit is a weighted sum of the samples, with the derivatives of the fits to unit samples
    as weights; these weights propagate the samples' uncertainties. The difference from a fit of one degree
    less is added as the uncertainty of the fit.
    """
    inside = (side * offset > 0) & (side * offset < window)
    x, samples = offset[inside], values.value[inside]
    grid = side * np.linspace(0, window / 2, 20)

    def derivatives(samples: np.ndarray, where: np.ndarray, degree: int = FIT) -> np.ndarray:
        fit = np.polynomial.Chebyshev.fit(x, samples, degree)
        return np.array([fit.deriv(m)(where) if m else fit(where) for m in range(HIGHEST)])

    front = np.zeros(1)
    weights = np.array([derivatives(unit, front)[:, 0] for unit in np.eye(len(x))]).T
    passed_on = Number(np.zeros(HIGHEST), np.hypot.reduce(weights * values.uncertainty[inside], axis=1))
    fitted, coarser = derivatives(samples, front)[:, 0], derivatives(samples, front, FIT - 1)[:, 0]
    largest = np.abs(derivatives(samples, grid)).max(axis=1)
    return Number(fitted, np.abs(fitted - coarser)) + passed_on, largest
