r"""Adhesive contact with a locked patch by shooting from the front (method a).

Inflation: for the front at x* with (rho*, F, I) known and eta = l there, the unknowns are
(rho', eta') just outside; p follows from the balance of the patch,

.. math:: p \rho_*^2/2 - k [ (e_* - l) \rho_*^2/2 + I ] + x_* W_1 \eta'/\lambda_1 = 0,

and the rim's conditions rho = 1, eta = 0 close the problem. The history is the ordinary
differential equation in x* (Runge-Kutta 8(5,3), dense output)

.. math:: \rho_c' = \rho', \quad F' = -\eta', \quad I' = -\eta' \rho_*^2/2, \quad
          E' = x_* W, \quad J' = -2 \eta' I .

Deflation: x*, rho*, F and I are frozen, p is given and the balance yields the edge's height e*.
Source: Patil, DasGupta & Eriksson (2015), sections 3.2 and 3.3, closed by the vertical balance
of the whole patch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from scipy.integrate import solve_ivp

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.newton import Secants
from reference_data.solvers.paper1.membrane import Disk, Patch
from reference_data.solvers.paper1.shooting.equations import Accuracy, Array, shoot
from reference_data.solvers.paper1.shooting.states import Shot, seed


@dataclass(frozen=True)
class Edge:
    """A state with a locked patch: its outer side at the front.

    Attributes:
        disk: The membrane.
        patch: The patch.
        p: Pressure.
        height: e* = eta(x*).
        slope: rho' just outside.
        dip: -eta' just outside.
        how: Accuracy.
    """

    disk: Disk
    patch: Patch
    p: float
    height: float
    slope: float
    dip: float
    how: Accuracy

    @property
    def t0(self) -> float:
        """Pole height."""
        return self.height + self.patch.depth

    def outside(self, x: Sequence[float], totals: bool = False) -> list[Array]:
        """States with the front at rising x >= x*."""
        y = [self.patch.rho, self.height, self.slope, -self.dip, *([0.0, 0.0] if totals else [])]
        return shoot(self.disk, self.p, False, y, [self.patch.x, *x], self.how.rtol, totals)

    @property
    def volume(self) -> float:
        """Enclosed volume per 2 pi."""
        return self.patch.moment + float(self.outside([self.disk.length], totals=True)[-1][4])


def pull(disk: Disk, x: float, rho: float, slope: float, dip: float) -> float:
    """Force x W_1 eta'/lambda1 of the outer part on the patch, per 2 pi."""
    l1 = (slope * slope + dip * dip) ** 0.5
    return -x * mat.slope(l1, rho / x, disk.alpha) * dip / l1


def inflating(
    disk: Disk, how: Accuracy, at: tuple[float, float, float], guess: Sequence[float], newton: Secants
) -> tuple[float, float, float]:
    """(rho', -eta', p) at the front ``at`` = (x*, rho*, I) of adhesive inflation."""
    x, rho, moment = at

    def pressure(z: Array) -> float:
        return 2 * (disk.k * moment - pull(disk, x, rho, z[0], z[1] * x)) / rho**2

    def miss(z: Array) -> Array:
        start = [rho, disk.l, z[0], -z[1] * x]
        end = shoot(disk, pressure(z), False, start, [x, disk.length], how.rtol)[-1]
        return end[:2] - [1.0, 0.0]

    z = newton.solve(miss, [guess[0], guess[1] / x])
    return float(z[0]), float(z[1] * x), float(pressure(z))


@dataclass
class Inflation:
    """History of the patch, from the free state at first touch to x* = reach.

    ``onset`` is that state; a series begins the history.
    """

    onset: Shot
    reach: float
    newton: Secants = field(default_factory=Secants)
    last: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        self.disk, self.how = self.onset.disk, self.onset.how
        self.known: dict[float, Patch] = {}
        x, (l0, bend, curve) = self.how.first, seed(self.onset)
        rho, depth = l0 * x + bend * x**3, curve * x * x / 2
        self.last = (x, l0 + 3 * bend * x * x, curve * x)
        energy = x * x / 2 * mat.energy(l0, l0, self.disk.alpha)
        start = [rho, depth, depth * rho**2 / 4, energy, depth**2 * rho**2 / 6]
        self.path = solve_ivp(
            self._rates,
            (x, self.reach),
            start,
            method="DOP853",
            dense_output=True,
            rtol=self.how.history,
            atol=self.how.history * 1e-3,
            max_step=0.05,
        )
        if not self.path.success:
            raise RuntimeError(f"shooting: history of {self.disk} ends early: {self.path.message}")

    def _edge(self, x: float, rho: float, moment: float) -> tuple[float, float, float]:
        at, slope, dip = self.last
        found = inflating(self.disk, self.how, (x, rho, moment), (slope, dip * x / at), self.newton)
        self.last = (x, found[0], found[1])
        return found

    def _rates(self, x: float, y: Array) -> list[float]:
        rho, _, moment = (float(v) for v in y[:3])
        slope, dip, _ = self._edge(x, rho, moment)
        w = mat.energy((slope * slope + dip * dip) ** 0.5, rho / x, self.disk.alpha)
        return [slope, dip, dip * rho**2 / 2, x * w, 2 * dip * moment]

    def at(self, x: float) -> Edge:
        """The state with its front at x."""
        rho, depth, moment, energy, second = (float(v) for v in self.path.sol(x))
        slope, dip, p = self._edge(x, rho, moment)
        patch = Patch(x, rho, depth, moment, second, energy, slope, dip)
        return Edge(self.disk, patch, p, self.disk.l, slope, dip, self.how)

    def frozen(self, x: float) -> Patch:
        """The patch frozen up to x."""
        if x not in self.known:
            self.known[x] = self.at(x).patch
        return self.known[x]


def deflated(start: Edge, p: float, newton: Secants) -> Edge:
    """The same patch at another pressure, ``start`` being the guess."""
    disk, patch = start.disk, start.patch

    def height(z: Array) -> float:
        load = p * patch.rho**2 / 2 + pull(disk, patch.x, patch.rho, z[0], z[1])
        return disk.l + (load / disk.k - patch.moment) * 2 / patch.rho**2

    def miss(z: Array) -> Array:
        y = [patch.rho, height(z), z[0], -z[1]]
        return shoot(disk, p, False, y, [patch.x, disk.length], start.how.rtol)[-1][:2] - [1.0, 0.0]

    z = newton.solve(miss, [start.slope, start.dip])
    return Edge(disk, patch, p, float(height(z)), float(z[0]), float(z[1]), start.how)
