r"""Central finite differences with the Heaviside form: the paper's scheme, without tracked fronts.

On n equal intervals, with stretches at the mid-points from differences and means of r and z,

.. math::
   (\eta W_1 r'/l_1)' = \eta W_2 - P r z',\qquad (\eta W_1 z'/l_1)' = P r r'

(Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10, equations (12), (13) and the
relaxed energy), where the sign of gw - 1 decides at each mid-point between taut and wrinkled. The equations
are Lipschitz continuous across a front, so that Newton's method needs no tracking, but the order of accuracy
is lower there. The scheme finds the pattern of zones for the tracked solvers, and is compared with them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_banded

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Array, Membrane

STEP = 1e-30
FIRST = {"gas": 0.004, "fluid": 0.5}  # first load step from the unloaded membrane
LONGEST = {"gas": 0.03, "fluid": 0.5}


@dataclass
class Grid:
    """Nodal r and z of one state on equal intervals, and its load."""

    membrane: Membrane
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
        _, r, l1, _ = self.middle
        return r * np.sqrt(l1)

    @property
    def fronts(self) -> Array:
        """Zeros of gw - 1, interpolated linearly between mid-points."""
        s, g = self.middle[0], self.gw - 1
        i = np.nonzero(g[:-1] * g[1:] < 0)[0]
        return s[i] - g[i] * (s[i + 1] - s[i]) / (g[i + 1] - g[i])


def stresses(r: Array, l1: Array, membrane: Membrane) -> tuple[Array, Array]:
    """W_1 and W_2 at mid-points, by the Heaviside form of the energy."""
    c2 = membrane.c2
    full = mat.slope(l1, r, c2), mat.slope(r, l1, c2)
    if membrane.energy == "standard":
        return full
    tense = np.real(r * r * l1) > 1
    return np.where(tense, full[0], wri.relaxed_slope(l1, c2)), np.where(tense, full[1], 0.0)


def residual(r: list[Array], z: list[Array], s: Array, h: float, membrane: Membrane, load: float) -> Array:
    """Both equations at inner nodes, times h; r and z hold the left, own and right values."""
    flux, hoop = [], []
    for side in (0, 1):
        dr, dz = (r[side + 1] - r[side]) / h, (z[side + 1] - z[side]) / h
        l1, mean = np.sqrt(dr * dr + dz * dz), (r[side + 1] + r[side]) / 2
        w1, w2 = stresses(mean, l1, membrane)
        eta = membrane.eta(s + (side - 0.5) * h)
        flux.append((eta * w1 * dr / l1, eta * w1 * dz / l1))
        hoop.append(eta * w2)
    p = membrane.pressure(z[1], load, np.real(z[1]) < load)
    first = flux[1][0] - flux[0][0] - h * (hoop[0] + hoop[1]) / 2 + p * r[1] * (z[2] - z[0]) / 2
    second = flux[1][1] - flux[0][1] - p * r[1] * (r[2] - r[0]) / 2
    return np.stack([first, second], axis=-1)


def newton(guess: Grid, load: float, max_iter: int = 25) -> Grid:
    """State at a load.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    membrane, n = guess.membrane, guess.n
    h = membrane.L / n
    s = h * np.arange(1, n)
    y = np.stack([guess.r, guess.z], axis=-1)
    for _ in range(max_iter):
        around = [y[:-2], y[1:-1], y[2:]]
        r, z = [a[:, 0] for a in around], [a[:, 1] for a in around]
        now = residual(r, z, s, h, membrane, load)
        band = np.zeros((7, 2 * (n - 1)))
        for j in range(3):
            for c in range(2):
                bump = [[a + (1j * STEP if (i, d) == (j, c) else 0) for i, a in enumerate(x)]
                        for d, x in enumerate((r, z))]  # fmt: skip
                column = np.imag(residual(*bump, s, h, membrane, load)) / STEP
                for row in range(2):
                    # unknown 2 (i + j - 1) + c of equation 2 i + row
                    offset = 2 * (j - 1) + c - row
                    source = np.arange(max(0, 1 - j), n - 1 - max(0, j - 1))
                    target = 2 * (source + j - 1) + c
                    band[3 - offset, target] = column[source, row]
        step = solve_banded((3, 3), band, -now.ravel()).reshape(-1, 2)
        size = float(np.abs(step).max())
        if not np.isfinite(size):
            break
        y[1:-1] += step * min(1.0, 0.5 / size)
        if size < 1e-10:
            return Grid(membrane, y[:, 0].copy(), y[:, 1].copy(), load)
    raise RuntimeError(f"finite differences: no convergence at {membrane.control} = {load:g} for {membrane}")


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
