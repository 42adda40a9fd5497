"""Order of continuity of a sampled field at a front, measured.

On each side of the front a polynomial is fitted to the samples over a window, and the derivatives of the two
are compared at the front: the first that does not vanish is the order.
"""

from __future__ import annotations

import numpy as np

NODES, FIT, HIGHEST = 30, 9, 4
"""Samples a side, degree of the fit, and the derivative from which on nothing is measured."""

VANISHES, JUMPS = 2e-3, 1e-2
"""Relative jumps below the one are none, above the other are one; in between nothing is measured."""


def samples(front: float, window: float) -> tuple[float, ...]:
    """Where to sample: Chebyshev points of the windows on both sides."""
    offsets = window * (1 - np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)) / 2
    return tuple(sorted([*(front - offsets), *(front + offsets)]))


def jumps(offset: np.ndarray, values: np.ndarray, window: float) -> list[float]:
    """Relative jumps of the derivatives 0 to 3.

    Args:
        offset: Distance of the samples from the front, negative on one side.
        values: The field there.
        window: Length of the windows.
    """
    sides = [_one_sided(offset, values, side, window) for side in (-1, 1)]
    return [abs(a - b) / max(p, q) for (a, p), (b, q) in zip(*sides, strict=True)]


def first_jump(found: list[float]) -> tuple[int, bool]:
    """First derivative that jumps (4 if none does), and whether all before it clearly vanish."""
    first = next((m for m, jump in enumerate(found) if jump > JUMPS), HIGHEST)
    return first, all(jump < VANISHES for jump in found[:first])


def _one_sided(offset: np.ndarray, values: np.ndarray, side: int, window: float) -> list[tuple[float, float]]:
    """Value at the front and largest magnitude in the window of each derivative."""
    inside = (side * offset > 0) & (side * offset < window)
    fit = np.polynomial.Chebyshev.fit(offset[inside], values[inside], FIT)
    grid = side * np.linspace(0, window / 2, 20)
    derivatives = [fit, *(fit.deriv(m) for m in range(1, HIGHEST))]
    return [(float(d(0.0)), float(np.abs(d(grid)).max())) for d in derivatives]
