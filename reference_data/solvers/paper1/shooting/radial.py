r"""Adhesive inflation without radial slip only (model N) by shooting (method a).

The frozen radius is integrated over the front position. On each interval rho_c' is a polynomial through the
ends and Radau's points of the interval, found by repeated substitution; each front is solved by shooting from
the pole through the patch and on to the rim. In the patch (eta, V) with V = x W_1 eta'/lambda1 is integrated,
V' = -(p - k (eta - l)) rho_c rho_c', eta' by inverting V.

Source: Patil, DasGupta & Eriksson (2015), section 3.2, read as "no tangential slip" of the
radius alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import ode
from scipy.special import roots_jacobi

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.newton import Secants
from reference_data.solvers.paper1.membrane import toward
from reference_data.solvers.paper1.shooting.equations import Array, shoot
from reference_data.solvers.paper1.shooting.states import Shot, seed

WIDEST, GROWTH = 0.06, 0.5  # intervals: growth relative to the position
NODES = 6
PICARD, SETTLED = 1e-12, 1e-9  # small enough; or small, and not decreasing further (rounding)


def radau(n: int) -> Array:
    """0 and the n right Radau points of [0, 1]."""
    inner = roots_jacobi(n - 1, 1, 0)[0]
    return np.concatenate([[0.0], (inner + 1) / 2, [1.0]])


@dataclass(frozen=True)
class Piece:
    """rho_c on [left, right]: powers of x - left, lowest first, for rho_c and rho_c'."""

    left: float
    right: float
    radius: tuple[float, ...]
    slope: tuple[float, ...]


def horner(c: Sequence[float], x: float) -> float:
    """Polynomial with coefficients c, lowest first."""
    out = 0.0
    for a in reversed(c):
        out = out * x + a
    return out


def fitted(left: float, right: float, start: float, values: Array) -> Piece:
    """Piece with rho_c(left) = start and rho_c' through ``values`` at Radau's points."""
    width = right - left
    scaled = np.linalg.solve(np.vander(radau(len(values) - 1), increasing=True), values)
    powers = np.arange(len(values))
    slope = scaled / width**powers
    radius = np.concatenate([[start], slope / (powers + 1)])
    return Piece(left, right, tuple(map(float, radius)), tuple(map(float, slope)))


def inverted(force: float, q: float, l2: float, alpha: float, guess: float) -> float:
    """The eta' with W_1(l1, l2) eta'/l1 = force, l1^2 = q^2 + eta'^2."""
    w = guess
    for _ in range(30):
        l1 = (q * q + w * w) ** 0.5
        s = mat.slope(l1, l2, alpha) / l1
        step = (force - s * w) / (s + (mat.curvature(l1, l2, alpha) - s) * w * w / (l1 * l1))
        w += step
        if abs(step) < 1e-9 * max(abs(w), 1e-6):
            return w  # the step was quadratic
    raise RuntimeError(f"shooting: no slope carries the force {force:g}")


@dataclass(frozen=True)
class Front:
    """A state of model N; slope = rho' and dip = -eta' outside the front at x."""

    x: float
    rho: float
    t0: float
    p: float
    slope: float
    dip: float


@dataclass
class Radial:
    """Adhesive inflation of model N from first touch to x* = reach."""

    onset: Shot
    reach: float
    pieces: list[Piece] = field(default_factory=list)
    newton: Secants = field(default_factory=Secants)

    def __post_init__(self) -> None:
        self.disk, self.how = self.onset.disk, self.onset.how
        (l0, bend, curve), first = seed(self.onset), 3 * self.how.first
        self.pieces.append(Piece(0.0, first, (0.0, l0, 0.0, bend), (l0, 0.0, 3 * bend)))
        top, slope = self.disk.l + curve * first**2 / 2, l0 + 3 * bend * first**2
        self.last = Front(first, self.radius(first), top, self.onset.p, slope, curve * first)
        at, rho = first, self.radius(first)
        while at < self.reach:
            right = toward(at, self.reach, min(WIDEST, GROWTH * at))
            nodes = at + (right - at) * radau(NODES)
            values = np.full(len(nodes), horner(self.pieces[-1].slope, at - self.pieces[-1].left))
            before = np.inf
            for _ in range(40):
                self.pieces.append(fitted(at, right, rho, values))
                new = np.array([values[0], *(self._solve(x).slope for x in nodes[1:])])
                change, values = np.max(np.abs(new - values)), new
                if change < PICARD or (change < SETTLED and change > before / 2):
                    break
                before = change
                self.pieces.pop()
            else:
                raise RuntimeError(f"shooting: history of {self.disk} not settled at x = {right:g}")
            at, rho = right, self.radius(right)

    def _piece(self, x: float) -> Piece:
        for piece in reversed(self.pieces):
            if x >= piece.left:
                return piece
        return self.pieces[0]

    def radius(self, x: float) -> float:
        """rho_c(x)."""
        piece = self._piece(x)
        return horner(piece.radius, x - piece.left)

    def _patch(self, t0: float, p: float, xs: Sequence[float], volume: bool = False) -> list[Array]:
        """(eta, V, volume) at xs, from the pole."""
        k, height, alpha, guess = self.disk.k, self.disk.l, self.disk.alpha, [0.0]

        def rates(x: float, y: Array) -> list[float]:
            eta, force = float(y[0]), float(y[1])
            piece = self._piece(x)
            rho, q = horner(piece.radius, x - piece.left), horner(piece.slope, x - piece.left)
            guess[0] = inverted(force / x, q, rho / x, alpha, guess[0])
            out = [guess[0], -(p - k * (eta - height)) * rho * q]
            return [*out, -rho * rho * guess[0] / 2] if volume else out

        x, l0 = self.how.start * self.disk.length, self.onset.lam
        force = -(p - k * (t0 - height)) * l0 * l0 * x * x / 2
        w = guess[0] = inverted(force / x, l0, l0, alpha, 0.0)
        run = ode(rates).set_integrator("dop853", rtol=self.how.rtol, atol=self.how.rtol / 10, nsteps=20000)
        run.set_initial_value([t0 + w * x / 2, force, *([0.0] if volume else [])], x)
        return [run.integrate(s) for s in xs]

    def _outer(self, x: float, rho: float, slope: float, force: float) -> list[float]:
        w = inverted(force / x, slope, rho / x, self.disk.alpha, -self.last.dip)
        return [rho, self.disk.l, slope, w]

    def _solve(self, x: float) -> Front:
        """The state with its front at x."""
        rho, end, last = self.radius(x), self.disk.length, self.last

        def miss(z: Array) -> Array:
            eta, force = self._patch(z[0], z[1], [x])[-1]
            start = self._outer(x, rho, z[2], force)
            far = shoot(self.disk, z[1], False, start, [x, end], self.how.rtol)[-1]
            return np.array([eta - self.disk.l, far[0] - 1, far[1]])

        guess = [last.t0 + last.dip * (x - last.x), last.p, last.slope]
        t0, p, slope = (float(v) for v in self.newton.solve(miss, guess))
        force = float(self._patch(t0, p, [x])[-1][1])
        self.last = Front(x, rho, t0, p, slope, -self._outer(x, rho, slope, force)[3])
        return self.last

    def at(self, x: float) -> Front:
        """The state with its front at x, from the known state nearest to it."""
        while self.last.x != x:
            self._solve(toward(self.last.x, x, WIDEST))
        return self.last

    def volume(self, front: Front) -> float:
        """Enclosed volume per 2 pi."""
        patch = float(self._patch(front.t0, front.p, [front.x], volume=True)[-1][2])
        start = [front.rho, self.disk.l, front.slope, -front.dip, patch, 0.0]
        x = [front.x, self.disk.length]
        return float(shoot(self.disk, front.p, False, start, x, self.how.rtol, totals=True)[-1][4])
