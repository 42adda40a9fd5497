r"""Limit points of a part of a sphere by shooting from the pole, many side by side.

Over the arc s at rest from the pole, with R = sin(s sin A)/sin A, the axial force of any part around the pole
is carried by the pressure, p r^2/2. Hence the meridional force per hoop length at rest has the components m
(radial) and f = p r^2/(2 R), and the stretch is the root of w_1(l1, l2) = |(m, f)|. With l2 = r/R,

.. math:: R l_2' = l_1 m/|N| - l_2 R', \qquad R m' = w_2 - p\, r z' - m R', \qquad z' = l_1 f/|N|,

in the logarithm of s, in which the equations are regular at the pole. They begin with a small flat piece,
stretched by l0 in both directions; the error of this is of the order of its area. The clamp is met if l2 = 1
at its end. All states of a pressure are a family in l0, so that limit points are those at which the
derivative of l2 there by l0 vanishes, and cusps those at which the second one vanishes too. Both are sums
over a circle around l0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from reference_data.solvers.core.newton import newton

Array = np.ndarray
SUBSTEPS = (2, 4, 6, 8, 10, 12)
"""Numbers of substeps whose results are extrapolated to a vanishing one."""
ROOTS = 10
"""Newton's iterations for the stretch."""
SHORTER = 2.0
"""Power by which steps, in the logarithm, are shorter towards the clamp."""
CIRCLE = 0.03 * np.exp(2j * np.pi * (np.arange(16) + 0.5) / 16)
DIFFERENCE = 1e-6


@dataclass(frozen=True)
class Accuracy:
    """Steps of the integration, and the size of the flat piece over the arc."""

    steps: int
    piece: float


LEVELS = (Accuracy(24, 1e-6), Accuracy(32, 3e-7))


@dataclass(frozen=True)
class Data:
    """Parameters; each may be an array."""

    p: Any
    alpha: Any
    angle: Any


def meridional(l1: Any, l2: Any, alpha: Any) -> Any:
    """w_1."""
    return 2 * (l1 - 1 / (l1**3 * l2**2)) + 2 * alpha * (l1 * l2**2 - 1 / l1**3)


def stretch(l2: Any, force: Any, alpha: Any) -> Any:
    """l1 at which w_1 is the force."""
    a, b = 2 * (1 + alpha * l2**2), 2 * (l2**-2 + alpha)
    l1 = force / a + (b / a) ** 0.25
    for _ in range(ROOTS):
        cube = l1**3
        l1 = l1 - (a * l1**4 - force * cube - b) / (4 * a * cube - 3 * force * l1**2)
    return l1


def rates(y: Array, log_s: Any, of: Data) -> Array:
    """(l2, m, z) by the logarithm of s."""
    l2, m, _ = y
    s, sine = np.exp(log_s), np.sin(of.angle)
    radius, slope = np.sin(s * sine) / sine, np.cos(s * sine)
    f = of.p * l2**2 * radius / 2
    force = np.sqrt(m * m + f * f)
    l1 = stretch(l2, force, of.alpha)
    up = l1 * f / force
    w2 = meridional(l2, l1, of.alpha)
    by = s / radius
    return np.array([
        by * (l1 * m / force - l2 * slope), by * (w2 - of.p * radius * l2 * up - m * slope), s * up
    ])  # fmt: skip


def shot(l0: Array, of: Data, how: Accuracy) -> Array:
    """(l2, m, z) at the clamp."""
    length = of.angle / np.sin(of.angle)
    left = (1 - np.arange(how.steps + 1) / how.steps) ** SHORTER * np.log(how.piece)
    y = np.array([l0, meridional(l0, l0, of.alpha), 0 * l0])
    for begin, end in pairwise([np.log(length) + x for x in left.tolist()]):
        y = extrapolated(lambda y, at: rates(y, at, of), y, begin, end)
    return y


def extrapolated(slope: Callable[[Array, Any], Array], y: Array, begin: Any, end: Any) -> Array:
    """A step by Gragg's midpoint rule, extrapolated by Neville's scheme in the square of the substep."""
    table = [_midpoint(slope, y, begin, end - begin, n) for n in SUBSTEPS]
    for j in range(1, len(table)):
        for i in range(len(table) - 1, j - 1, -1):
            ratio = (SUBSTEPS[i] / SUBSTEPS[i - j]) ** 2 - 1
            table[i] = table[i] + (table[i] - table[i - 1]) / ratio
    return table[-1]


def _midpoint(slope: Callable[[Array, Any], Array], y: Array, at: Any, h: Any, n: int) -> Array:
    """N substeps."""
    step = h / n
    before, now = y, y + step * slope(y, at)
    for k in range(1, n):
        before, now = now, before + 2 * step * slope(now, at + k * step)
    return (before + now + step * slope(now, at + h)) / 2


def misses(x: Array, held: dict[str, Array], of: dict[str, Any], vary: str, how: Accuracy) -> Array:
    """What (l0, p, parameter) miss of a limit point at a height or parameter, or of a cusp.

    Args:
        x: The unknowns, a column for each point.
        held: ``t0`` or the parameter, with a value for each point; nothing for cusps.
        of: The other parameter.
        vary: Name of the unknown one.
        how: Accuracy.
    """
    l0, p, mu = x
    data = Data(p, **(of | {vary: mu}))
    end = shot(l0 + CIRCLE[:, None], data, how)
    values, heights = end[0], end[2]
    first = np.mean(values / CIRCLE[:, None], axis=0).real
    rows = [np.mean(values, axis=0).real - 1, first]
    if "t0" in held:
        rows.append(np.mean(heights, axis=0).real - held["t0"])
    elif held:
        rows.append(mu - held[vary])
    else:
        rows.append(np.mean(values / CIRCLE[:, None] ** 2, axis=0).real)
    return np.array(rows)


def solve(x: Array, held: dict[str, Array], of: dict[str, Any], vary: str, how: Accuracy) -> dict[str, Array]:
    """Stretch and height of the pole, pressure and parameter, from guesses of (l0, p, parameter).

    Raises:
        RuntimeError: If Newton's method does not converge.
    """

    def correct(x: Array) -> tuple[float, Callable[[float], Array]]:
        here = misses(x, held, of, vary, how)
        columns = []
        for k in range(3):
            moved = x.copy()
            moved[k] += DIFFERENCE
            columns.append((misses(moved, held, of, vary, how) - here) / DIFFERENCE)
        matrix = np.moveaxis(np.array(columns), 2, 0).transpose(0, 2, 1)
        step = np.linalg.solve(matrix, here.T[..., None])[..., 0].T
        return float(np.abs(step).max()), lambda share: x - share * step

    x = newton(x, correct, f"shooting from the pole over {vary}", longest=np.inf, close=1e-9, most=20)
    height = np.mean(shot(x[0] + CIRCLE[:, None], Data(x[1], **(of | {vary: x[2]})), how)[2], axis=0).real
    return {"lam_pole": x[0], "t0": height, "p": x[1], vary: x[2]}
