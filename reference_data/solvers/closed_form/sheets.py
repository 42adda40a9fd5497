r"""Homogeneous Mooney-Rivlin sheets: nominal stresses of taut and of wrinkled states, in two ways.

A sheet with :math:`x = \lambda X + \gamma Y,\ y = s Y` has :math:`I = \lambda^2 + \gamma^2 + s^2` and
:math:`D = \lambda^2 s^2`; the squares of its principal stretches are the roots :math:`x_1 > x_2` of
:math:`x^2 - I x + D`. Taut, its energy over ``C1`` is :math:`I + 1/D - 3 + \alpha (I/D + D - 3)`. It is
wrinkled where :math:`x_1 x_2^2 < 1`, and has there the energy of uniaxial tension,
:math:`f(x_1) = x_1 + 2 x_1^{-1/2} - 3 + \alpha (2 x_1^{1/2} + 1/x_1 - 3)`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.closed_form.lines import PLACES, WEIGHTS

STEP = 1e-3
"""Step of the differences."""


class State(NamedTuple):
    """Stretches in X, shear, and stretch in Y."""

    lam: float
    gam: float
    s: float


class Found(NamedTuple):
    """Nominal stresses and principal stretches of a state."""

    tau: float
    T_x: float
    T_y: float
    lam1: float
    lam2: float


def by_hand(alpha: float, at: State) -> Found:
    """From the invariants, by derivatives worked out by hand."""
    lam, gam, s = at
    trace, area = lam**2 + gam**2 + s**2, (lam * s) ** 2
    root = np.sqrt(trace**2 - 4 * area)
    large, small = (trace + root) / 2, (trace - root) / 2
    rates = [(2 * gam, 0.0), (2 * lam, 2 * lam * s**2), (2 * s, 2 * s * lam**2)]
    if large * small**2 < 1:
        slope = 1 - large**-1.5 + alpha * (large**-0.5 - large**-2)
        stresses = [slope * (large * i - d) / root for i, d in rates]
    else:
        of_trace = 1 + alpha / area
        of_area = -(area**-2) + alpha * (1 - trace / area**2)
        stresses = [of_trace * i + of_area * d for i, d in rates]
    return Found(*map(float, stresses), float(np.sqrt(large)), float(np.sqrt(small)))


def stored(alpha: float, l1: float, l2: Any) -> Any:
    """Bulk energy of an incompressible sheet with these principal stretches."""
    squares = np.array([l1, l2, 1 / (l1 * l2)]) ** 2
    return squares.sum() - 3 + alpha * ((1 / squares).sum() - 3)


def natural(alpha: float, l1: float) -> float:
    """Width at which it is least, by the root of its rate from a complex step."""
    rate = lambda width: (stored(alpha, l1, width + 1e-30j) / 1e-30).imag  # noqa: E731
    return float(brentq(rate, 0.5 * l1**-0.5, 1.5 * l1**-0.5, xtol=1e-15))


def by_energy(alpha: float, at: State) -> Found:
    """From the bulk energy, the least over all greater widths, by differences of sixth order in the edges."""

    def relaxed(state: np.ndarray) -> float:
        lam, gam, s = state
        l1, l2 = np.linalg.svd([[lam, gam], [0.0, s]], compute_uv=False)
        return stored(alpha, l1, max(l2, natural(alpha, l1)))

    centre = np.array(at)
    stresses = [_slope(relaxed, centre, axis) for axis in np.eye(3)[[1, 0, 2]]]
    return Found(*stresses, *np.linalg.svd([[at.lam, at.gam], [0.0, at.s]], compute_uv=False).tolist())


def _slope(f: Callable[[np.ndarray], float], centre: np.ndarray, axis: np.ndarray) -> float:
    values = [w * f(centre + k * STEP * axis) for w, k in zip(WEIGHTS, PLACES, strict=True)]
    return float(sum(values) / (60 * STEP))


def onset_by_hand(s: float) -> float:
    """Shear at which a sheet of the width ``s`` begins to wrinkle: its larger stretch is ``s^2``."""
    return float(np.sqrt(s**4 + s**-2 - 1 - s**2))


def onset_by_stretches(s: float) -> float:
    """The same: the smaller stretch is the width of the larger one in uniaxial tension, from a bracket."""

    def excess(gam: float) -> float:
        l1, l2 = np.linalg.svd([[1.0, gam], [0.0, s]], compute_uv=False)
        return float(l2 - natural(0.0, l1))

    return float(brentq(excess, 1e-3, 10.0, xtol=1e-15))
