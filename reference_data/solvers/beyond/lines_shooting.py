r"""Critical points of the free tube by shooting in Hamilton's variables, many points side by side.

Over the unstretched coordinate z from the mid-plane: radius rho, axial position eta, radial force
m = r0 w_1 sin b. The axial force F = r0 w_1 cos b - p rho^2/2 is constant, so that the force
N = (m, F + p rho^2/2) gives the stretch as the root of the quartic w_1(l1, rho/r0) = |N|/r0, and

.. math:: \rho' = l_1 N_1/|N|, \qquad \eta' = l_1 N_2/|N|, \qquad m' = w_2 - p \rho \eta'.

Integration is by extrapolation of the modified midpoint rule; derivatives by initial values are complex
steps. With rho(L) = 1, eta(L) = l_f/2 a state is

* a limit point if the derivatives of (rho, eta)(L) by (rho(0), F) at fixed p are linearly dependent;
* a point of mirror breaking if that of rho(L) by m(0) vanishes (that by eta(0) is a translation);
* an onset of wrinkling if w_2 = 0 at the disk, or w_2 and its derivative along z vanish inside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from reference_data.solvers.core.newton import newton

Array = np.ndarray
STEP = 1e-30
SUBSTEPS = (2, 4, 6, 8, 10, 12)
"""Numbers of substeps whose results are extrapolated to a vanishing one."""
ROOTS = 14
"""Newton's iterations for the stretch, from above, where they converge monotonically."""
DIFFERENCE = 1e-7
LEVELS = (24, 36)
"""Steps along the half tube."""


@dataclass(frozen=True)
class Data:
    """Parameters of the tubes; each may be an array."""

    alpha: Any
    delta1: Any
    lf: Any

    @property
    def r0(self) -> Any:
        """Unstretched radius."""
        return np.sqrt(self.delta1)


def stretch(rho: Any, force: Any, tube: Data) -> Any:
    """l1 at which r0 w_1 is the size of the force."""
    l2 = rho / tube.r0
    a, b, n = 2 * (1 + tube.alpha * l2**2), 2 * (l2**-2 + tube.alpha), force / tube.r0
    l1 = n / a + (b / a) ** 0.25
    for _ in range(ROOTS):
        cube = l1**3
        l1 = l1 - (a * l1**4 - n * cube - b) / (4 * a * cube - 3 * n * l1**2)
    return l1


def hoop(l1: Any, l2: Any, alpha: Any) -> Any:
    """w_2."""
    return 2 * (l2 - 1 / (l2**3 * l1**2)) + 2 * alpha * (l2 * l1**2 - 1 / l2**3)


def forces(y: Array, given: tuple[Any, Any], tube: Data) -> tuple[Any, Any, Any]:
    """l1, and both components of the force."""
    (force, p), (rho, _, m) = given, y
    axial = force + p * rho**2 / 2
    return stretch(rho, np.sqrt(m * m + axial * axial), tube), m, axial


def rates(y: Array, given: tuple[Any, Any], tube: Data) -> Array:
    """(rho', eta', m') over z."""
    l1, m, axial = forces(y, given, tube)
    size = np.sqrt(m * m + axial * axial)
    w2 = hoop(l1, y[0] / tube.r0, tube.alpha)
    up = l1 * axial / size
    return np.array([l1 * m / size, up, w2 - given[1] * y[0] * up])


def tension(y: Array, given: tuple[Any, Any], tube: Data) -> Any:
    """w_2 of a state."""
    return hoop(forces(y, given, tube)[0], y[0] / tube.r0, tube.alpha)


def tension_rate(y: Array, given: tuple[Any, Any], tube: Data) -> Any:
    """Derivative of w_2 along the tube, for real states."""
    moved = y + 1j * STEP * rates(y, given, tube)
    return np.imag(tension(moved, given, tube)) / STEP


def shot(y: Array, given: tuple[Any, Any], tube: Data, length: Any, steps: int) -> Array:
    """The state after a length."""
    h = length / steps
    for _ in range(steps):
        table = [_midpoint(y, given, tube, h, n) for n in SUBSTEPS]
        for k in range(1, len(table)):  # Neville's scheme in the square of the substep
            for i in range(len(table) - 1, k - 1, -1):
                ratio = (SUBSTEPS[i] / SUBSTEPS[i - k]) ** 2 - 1
                table[i] = table[i] + (table[i] - table[i - 1]) / ratio
        y = table[-1]
    return y


def _midpoint(y: Array, given: tuple[Any, Any], tube: Data, h: Any, n: int) -> Array:
    """Gragg's modified midpoint rule with n substeps."""
    step = h / n
    before, now = y, y + step * rates(y, given, tube)
    for _ in range(n - 1):
        before, now = now, before + 2 * step * rates(now, given, tube)
    return (before + now + step * rates(now, given, tube)) / 2


def misses(kind: str, x: Array, u: Array, tube: Data, steps: int) -> Array:
    """What the unknowns (F, p, and for an onset inside the front) miss of the equations of a kind.

    Args:
        kind: ``fold``, ``mirror``, ``wrinkling`` (at the disk) or ``wrinkling_front``.
        x: The unknowns but the parameter, which is in the tube; one column for each point.
        u: u_max.
        tube: The tubes.
        steps: Steps of the integration.
    """
    force, p = x[0], x[1]
    length = tube.lf / (2 * tube.delta1)
    zero = np.zeros_like(u)
    y = np.array([1 + u, zero, zero])
    at = lambda y, force=force, span=length, n=steps: shot(y, (force, p), tube, span, n)  # noqa: E731
    if kind == "wrinkling_front":
        inner = at(y, span=x[2] * length)
        end = at(inner, span=(1 - x[2]) * length)
        given = force, p
        more = [tension(inner, given, tube), tension_rate(inner, given, tube)]
    elif kind == "wrinkling":
        end = at(y)
        more = [tension(end, (force, p), tube)]
    elif kind == "mirror":
        moved = at(y + 1j * STEP * np.array([0.0, 0.0, 1.0])[:, None])
        end, more = np.real(moved), [np.imag(moved[0]) / STEP]
    else:
        by_rho = at(y + 1j * STEP * np.array([1.0, 0.0, 0.0])[:, None])
        by_force = at(y + 0j, force=force + 1j * STEP)
        end, a, b = np.real(by_rho), np.imag(by_rho) / STEP, np.imag(by_force) / STEP
        more = [a[0] * b[1] - a[1] * b[0]]
    return np.array([end[0] - 1, end[1] - tube.lf / 2, *more])


def solve(kind: str, tube: dict[str, Any], vary: str, x: Array, u: Array, steps: int) -> Array:
    """The unknowns at given u_max, the parameter in the last row, by Newton's method with differences.

    Raises:
        RuntimeError: If it does not converge.
    """

    def f(x: Array) -> Array:
        return misses(kind, x[:-1], u, Data(**tube | {vary: x[-1]}), steps)

    def correct(x: Array) -> tuple[float, Callable[[float], Array]]:
        here = f(x)
        columns = []
        for k in range(len(x)):
            moved = x.copy()
            moved[k] += DIFFERENCE
            columns.append((f(moved) - here) / DIFFERENCE)
        matrix = np.moveaxis(np.array(columns), 2, 0).transpose(0, 2, 1)
        step = np.linalg.solve(matrix, here.T[..., None])[..., 0].T
        return float(np.abs(step).max()), lambda share: x - share * step

    return newton(x, correct, f"shooting: {kind} over {vary}", longest=np.inf, close=1e-9, most=20)
