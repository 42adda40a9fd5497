r"""States of a bent sheet by integration across its width, from the inner arc outwards.

With the offset :math:`w(Y)` of a point from the arc of mean stretch the stretches are
:math:`\lambda_1 = \lambda_0 + \kappa w` along the sheet and :math:`\lambda_2 = w'` across it. Equilibrium is
:math:`(W_2)' = \kappa W_1` with :math:`w(0) = -s/2` and :math:`w(1) = s/2`. Where the sheet is wrinkled,
:math:`W_1 = 0`, so that :math:`w'` is constant; the front is where :math:`\lambda_1 = \lambda_2^{-1/2}`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from reference_data.solvers.core import mooney_rivlin as law


@dataclass(frozen=True)
class Sheet:
    """A sheet of width 1 and its arcs."""

    alpha: float
    lam0: float
    """Stretch along the sheet of the arc midway between its guides."""
    s: float
    """Distance of the guides."""


@dataclass(frozen=True)
class Bent:
    """Numbers of a state, per length of the stress-free sheet."""

    force: float
    moment: float
    energy: float
    wrinkled: float
    """Width of the wrinkled band."""


def bent(sheet: Sheet, kap: float, tolerance: float) -> Bent:
    """The state at a curvature.

    Args:
        sheet: The sheet.
        kap: Curvature, per length of the stress-free sheet.
        tolerance: Of the integration, relative.
    """

    def beyond(slope: float) -> float:
        return _across(sheet, kap, slope, tolerance)[1][0] - sheet.s / 2

    slope = brentq(beyond, 0.6 * sheet.s, 1.6 * sheet.s, xtol=1e-15, rtol=1e-14)
    band, (_, _, force, moment, energy) = _across(sheet, kap, slope, tolerance)
    folded = law.energy(slope, slope**-0.5, sheet.alpha) * band
    return Bent(float(force), float(moment), float(energy + folded), band)


def onset(sheet: Sheet, tolerance: float) -> float:
    """Curvature at which the stress along the inner arc vanishes."""

    def margin(kap: float) -> float:
        """Offset at the outer arc of the sheet whose inner arc begins to wrinkle, less its own."""
        inner = sheet.lam0 - kap * sheet.s / 2
        return _integrated(sheet, kap, -sheet.s / 2, inner**-2, 0.0, tolerance)[0] - sheet.s / 2

    least = 2 * (sheet.lam0 - sheet.s**-0.5) / sheet.s
    return float(brentq(margin, 0.2 * least, 1.5 * least, xtol=1e-15, rtol=1e-14))


def _across(sheet: Sheet, kap: float, slope: float, tolerance: float) -> tuple[float, np.ndarray]:
    """Width of the wrinkled band, and offset, slope, force, moment and energy at the outer arc."""
    inner, border = sheet.lam0 - kap * sheet.s / 2, slope**-0.5
    band = max(0.0, (border - inner) / (kap * slope))
    if band >= 1.0:
        return 1.0, np.array([slope - sheet.s / 2, slope, 0.0, 0.0, 0.0])
    return band, _integrated(sheet, kap, -sheet.s / 2 + slope * band, slope, band, tolerance)


def _integrated(
    sheet: Sheet, kap: float, offset: float, slope: float, begin: float, tolerance: float
) -> np.ndarray:
    alpha = sheet.alpha

    def rates(_: float, y: np.ndarray) -> list[float]:
        l1, l2 = sheet.lam0 + kap * y[0], y[1]
        along = law.slope(l1, l2, alpha)
        bend = kap * (along - law.mixed(l1, l2, alpha) * l2) / law.curvature(l2, l1, alpha)
        return [l2, bend, along, along * y[0], law.energy(l1, l2, alpha)]

    start = [offset, slope, 0.0, 0.0, 0.0]
    found = solve_ivp(rates, (begin, 1.0), start, "DOP853", rtol=tolerance, atol=tolerance * 1e-3)
    return found.y[:, -1]
