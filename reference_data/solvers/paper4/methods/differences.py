r"""Central finite differences with the Heaviside form: the paper's scheme, without tracked fronts.

On n equal intervals, with stretches at the mid-points from differences and means of r and z and l2 = r/R,

.. math::
   (H R W_1 r'/l_1)' = H W_2 - P r z',\qquad (H R W_1 z'/l_1)' = P r r'

(Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10, equations (12), (13) and the relaxed
energy), where the sign of l2^2 l1 - 1 decides at each mid-point between taut and wrinkled. At a pole r = 0,
and the vertical force balances the pressure on half an interval. The equations are Lipschitz continuous
across a front, so that Newton's method needs no tracking, but the order of accuracy is lower there. The
scheme finds the pattern of zones for the tracked solvers, and is compared with them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_banded

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.newton import newton as iterate
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Array, Body, Membrane

STEP = 1e-30
FIRST = {"gas": 0.004, "fluid": 0.5}  # first load step from the unloaded membrane
LONGEST = {"gas": 0.03, "fluid": 0.5}


@dataclass
class Grid:
    """Nodal r and z of one state on equal intervals, and its load."""

    membrane: Body
    r: Array
    z: Array
    load: float

    @property
    def n(self) -> int:
        """Number of intervals."""
        return len(self.r) - 1

    @property
    def middle(self) -> tuple[Array, Array, Array, Array]:
        """Mid-points s, with r, lam1 and the slope angle there."""
        h = self.membrane.L / self.n
        dr, dz = np.diff(self.r) / h, np.diff(self.z) / h
        s = h * (np.arange(self.n) + 0.5)
        return s, (self.r[1:] + self.r[:-1]) / 2, np.hypot(dr, dz), np.arctan2(dr, dz)

    @property
    def gw(self) -> Array:
        """Wrinkling function at the mid-points."""
        s, r, l1, _ = self.middle
        return r / self.membrane.unloaded(s) * np.sqrt(l1)

    @property
    def fronts(self) -> Array:
        """Zeros of gw - 1, interpolated linearly between mid-points."""
        s, g = self.middle[0], self.gw - 1
        i = np.nonzero(g[:-1] * g[1:] < 0)[0]
        return s[i] - g[i] * (s[i + 1] - s[i]) / (g[i + 1] - g[i])


def stresses(l2: Array, l1: Array, membrane: Body) -> tuple[Array, Array]:
    """W_1 and W_2 at mid-points, by the Heaviside form of the energy."""
    c2 = membrane.c2
    full = mat.slope(l1, l2, c2), mat.slope(l2, l1, c2)
    if membrane.energy == "standard":
        return full
    tense = np.real(l2 * l2 * l1) > 1
    return np.where(tense, full[0], wri.relaxed_slope(l1, c2)), np.where(tense, full[1], 0.0)


def residual(y: Array, membrane: Body, load: float) -> Array:
    """Both equations at inner nodes, times h, and what holds at the ends, from nodal (r, z)."""
    n = len(y) - 1
    h = membrane.L / n
    s = h * (np.arange(n) + 0.5)
    R, H, (r, z) = membrane.unloaded(s), membrane.eta(s), y.T
    dr, dz = np.diff(r) / h, np.diff(z) / h
    l1 = np.sqrt(dr * dr + dz * dz)
    w1, w2 = stresses((r[1:] + r[:-1]) / 2 / R, l1, membrane)
    force, hoop = H * R * w1 / l1, H * w2
    p = membrane.pressure(z, load, np.real(z) < load)
    out = np.empty_like(y)
    out[1:-1, 0] = np.diff(force * dr) - h * (hoop[1:] + hoop[:-1]) / 2
    out[1:-1, 0] += p[1:-1] * r[1:-1] * (z[2:] - z[:-2]) / 2
    out[1:-1, 1] = np.diff(force * dz) - p[1:-1] * r[1:-1] * (r[2:] - r[:-2]) / 2
    held = membrane.clamped([*y[0], 0.0, np.pi / 2], [*y[-1], 0.0, 0.0])
    out[0], out[-1] = held[:2], held[2:]
    if membrane.pole:
        out[0, 1] = force[0] * dz[0] - p[0] * r[1] ** 2 / 8
    return out


def newton(guess: Grid, load: float, most: int = 25) -> Grid:
    """State at a load.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    membrane, n = guess.membrane, guess.n

    def correct(y: Array) -> tuple[float, Callable[[float], Array]]:
        band = np.zeros((7, 2 * (n + 1)))
        for colour in range(3):
            for c in range(2):
                bumped, nodes = y.astype(complex), np.arange(colour, n + 1, 3)
                bumped[nodes, c] += 1j * STEP
                slope = np.imag(residual(bumped, membrane, load)) / STEP
                for off in (-1, 0, 1):
                    at = nodes[(nodes + off >= 0) & (nodes + off <= n)]
                    for row in range(2):  # equation 2 (node + off) + row, unknown 2 node + c
                        band[3 + 2 * off + row - c, 2 * at + c] = slope[at + off, row]
        step = solve_banded((3, 3), band, -residual(y, membrane, load).ravel()).reshape(-1, 2)
        return float(np.abs(step).max()), lambda share: y + share * step

    what = f"finite differences of {membrane} at {membrane.control} = {load:g}"
    y = np.stack([guess.r, guess.z], axis=-1)
    r, z = iterate(y, correct, what, membrane.cautious, close=1e-10, most=most, more=0).T
    return Grid(membrane, r.copy(), z.copy(), load)


def unloaded(membrane: Membrane, n: int) -> Grid:
    """Zero load, starting from a cylinder of the disks' radius with the tension of uniaxial stretch."""
    s = np.linspace(0, membrane.L, n + 1)
    force = wri.uniaxial_tension(membrane)
    middle = wri.uniaxial_stretch(force / membrane.eta((s[1:] + s[:-1]) / 2), membrane.c2)
    z = np.concatenate([[0.0], np.cumsum(middle)]) * membrane.delta * membrane.L / np.sum(middle)
    return newton(Grid(membrane, np.full(n + 1, membrane.radius), z, 0.0), 0.0, 60)


def walk(start: Grid, load: float) -> Grid:
    """Raise the load step by step, with steps as long as Newton's method converges.

    Raises:
        RuntimeError: If the steps become too short.
    """
    here, kind = start, start.membrane.load
    step = FIRST[kind] if start.load == 0 else LONGEST[kind]
    while here.load != load:
        ahead = load if abs(load - here.load) <= step else here.load + np.sign(load - here.load) * step
        try:
            here = newton(here, float(ahead))
            step = min(LONGEST[kind], 1.5 * step)
        except RuntimeError:
            step /= 3
            if step < 1e-3 * FIRST[kind]:
                raise
    return here
