r"""The same states from a first integral, without integrating a differential equation.

The relaxed energy :math:`W(\lambda_0 + \kappa w, w')` does not depend on :math:`Y`, so that
:math:`H = w' W_{w'} - W` is the same at every point. For a given :math:`H` the slope :math:`w' = q(w)` is
the root of an equation, and :math:`H` follows from the width, :math:`\int \mathrm dw/q = 1`. Force, moment
and energy are the integrals of :math:`W_1`, :math:`W_1 w` and :math:`W` over :math:`\mathrm dw/q`. The
derivatives of the bulk energy are complex steps.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.beyond.bent_sheet.shooting import Bent, Sheet
from reference_data.solvers.closed_form.sheets import natural, stored

STEP = 1e-30
NEWTON = 60
"""Largest number of Newton's steps."""


def bent(sheet: Sheet, kap: float, nodes: int) -> Bent:
    """The state at a curvature, with so many points of Gauss over the taut part."""
    inner = sheet.lam0 - kap * sheet.s / 2

    def parts(slope: float) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
        """Band, and the offsets, slopes and weights of the taut part, for a slope at the inner arc."""
        border = natural(sheet.alpha, slope)
        band = max(0.0, (border - inner) / (kap * slope))
        begin = slope * band - sheet.s / 2
        if begin >= sheet.s / 2:
            return sheet.s / slope, np.empty(0), np.empty(0), np.empty(0)
        l1 = max(inner, border)
        integral = slope * _rate(sheet.alpha, l1, slope, 1) - stored(sheet.alpha, l1, slope)
        offsets, weights = _gauss(begin, sheet.s / 2, nodes)
        return band, offsets, _slopes(sheet, kap, offsets, integral, slope), weights

    def width(slope: float) -> float:
        band, _, slopes, weights = parts(slope)
        return band + float(np.sum(weights / slopes))

    slope = brentq(lambda x: width(x) - 1, 0.6 * sheet.s, 1.6 * sheet.s, xtol=1e-15, rtol=1e-14)
    band, offsets, slopes, weights = parts(slope)
    l1, share = sheet.lam0 + kap * offsets, weights / slopes
    along = _rate(sheet.alpha, l1, slopes, 0)
    energy = np.sum(share * _stored(sheet.alpha, l1, slopes))
    folded = band * stored(sheet.alpha, natural(sheet.alpha, slope), slope)
    return Bent(
        float(np.sum(share * along)), float(np.sum(share * along * offsets)), float(energy + folded), band
    )


def onset(sheet: Sheet, nodes: int) -> float:
    """Curvature at which the stress along the inner arc vanishes."""

    def margin(kap: float) -> float:
        inner = sheet.lam0 - kap * sheet.s / 2
        slope = brentq(lambda l2: _rate(sheet.alpha, inner, l2, 0), 0.5, 4.0, xtol=1e-15)
        integral = slope * _rate(sheet.alpha, inner, slope, 1) - stored(sheet.alpha, inner, slope)
        offsets, weights = _gauss(-sheet.s / 2, sheet.s / 2, nodes)
        return float(np.sum(weights / _slopes(sheet, kap, offsets, integral, slope))) - 1

    least = 2 * (sheet.lam0 - sheet.s**-0.5) / sheet.s
    return float(brentq(margin, 0.2 * least, 1.5 * least, xtol=1e-15, rtol=1e-14))


def _stored(alpha: float, l1: np.ndarray, l2: np.ndarray) -> np.ndarray:
    return np.array([stored(alpha, a, b) for a, b in zip(l1, l2, strict=True)])


def _rate(alpha: float, l1: float | np.ndarray, l2: float | np.ndarray, which: int) -> float | np.ndarray:
    """Derivative of the bulk energy in one of its stretches."""
    step = [1j * STEP * (which == k) for k in (0, 1)]
    pairs = zip(*np.atleast_1d(l1 + step[0], l2 + step[1]), strict=True)
    found = np.array([stored(alpha, a, b).imag / STEP for a, b in pairs])
    return found if np.ndim(l1) else float(found[0])


def _slopes(sheet: Sheet, kap: float, offsets: np.ndarray, integral: float, first: float) -> np.ndarray:
    """Slopes at offsets at which the first integral has its value, by Newton's method with differences.

    Raises:
        RuntimeError: If it does not converge.
    """
    l1, slopes, h = sheet.lam0 + kap * offsets, np.full(len(offsets), first), 1e-6

    def excess(q: np.ndarray) -> np.ndarray:
        return q * _rate(sheet.alpha, l1, q, 1) - _stored(sheet.alpha, l1, q) - integral

    for _ in range(NEWTON):
        value = excess(slopes)
        step = value * 2 * h / (excess(slopes + h) - excess(slopes - h))
        slopes = slopes - step
        if np.max(np.abs(step)) < 1e-14:
            return slopes
    raise RuntimeError(f"{sheet}, kap = {kap:g}: Newton's last step is {np.max(np.abs(step)):.1e}")


def _gauss(begin: float, end: float, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    x, w = np.polynomial.legendre.leggauss(nodes)
    return (begin + end) / 2 + (end - begin) / 2 * x, (end - begin) / 2 * w
