"""A framed sheet at points: stresses, their derivatives, the load, and classes of C4v, for both methods.

Mooney-Rivlin, ``W = t + 1/d - 3 + alpha (d + t/d - 3)`` with ``t = c1 + c2`` and ``d = c1 c2 - c3^2``, a
function of ``c = (x_X.x_X, x_Y.x_Y, x_X.x_Y)``; or the law of Saint Venant and Kirchhoff in plane stress. The
sheet must be taut.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from reference_data.solvers.core.newton import newton

Array = np.ndarray


@dataclass(frozen=True)
class Kirchhoff:
    """``W = [e1^2 + e2^2 + 2 nu e1 e2 + (1 - nu) c3^2/2]/(2 (1 - nu^2))`` with ``e = (c - 1)/2``.

    It is over Young's modulus and the thickness; ``nu`` is Poisson's ratio.
    """

    nu: float

    def energy(self, c: Array) -> Array:
        """``W`` for ``c`` of shape (3, q)."""
        e1, e2 = (c[0] - 1) / 2, (c[1] - 1) / 2
        both = e1**2 + e2**2 + 2 * self.nu * e1 * e2 + (1 - self.nu) * c[2] ** 2 / 2
        return both / (2 * (1 - self.nu**2))

    def derivatives(self, c: Array) -> tuple[Array, Array]:
        """Gradient (3, q) and Hessian (3, 3, q) of ``W`` in ``c``."""
        nu = self.nu
        hessian = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, 2 * (1 - nu)]]) / (4 * (1 - nu**2))
        gradient = hessian @ np.array([c[0] - 1, c[1] - 1, c[2]])
        return gradient, np.repeat(hessian[:, :, None], c.shape[1], axis=2)


@dataclass(frozen=True)
class Framed:
    """The sheet [-1, 1] x [-1, 1] with its frame at ``delta (X, Y)``, and its load.

    Attributes:
        alpha: C2/C1, or another law.
        delta: Pre-stretch.
        gamma: Weight of the liquid on top; 0 for gas from below.
    """

    alpha: float | Kirchhoff
    delta: float = 1.1
    gamma: float = 0.0

    @property
    def sign(self) -> float:
        """Direction of the deflection."""
        return -1.0 if self.gamma else 1.0

    def push(self, z: Array, load: float) -> tuple[Array, Array, Array]:
        """Pressure along the upward normal, and its derivatives in the height and in the load."""
        if not self.gamma:
            return np.full_like(z, load), np.zeros_like(z), np.ones_like(z)
        wet = (z < load).astype(float)
        return -self.gamma * (load - z) * wet, self.gamma * wet, -self.gamma * wet

    def amount(self, z: Array, load: float) -> Array:
        """Integrand of the volume of the gas, or of the liquid, over the area of the plane."""
        return np.maximum(load - z, 0.0) if self.gamma else z


def energy(c: Array, alpha: float | Kirchhoff) -> Array:
    """``W`` for ``c`` of shape (3, q)."""
    if isinstance(alpha, Kirchhoff):
        return alpha.energy(c)
    t, d = c[0] + c[1], c[0] * c[1] - c[2] ** 2
    return t + 1 / d - 3 + alpha * (d + t / d - 3)


def derivatives(c: Array, alpha: float | Kirchhoff) -> tuple[Array, Array]:
    """Gradient (3, q) and Hessian (3, 3, q) of ``W`` in ``c``."""
    if isinstance(alpha, Kirchhoff):
        return alpha.derivatives(c)
    t, d = c[0] + c[1], c[0] * c[1] - c[2] ** 2
    one, none = np.ones_like(t), np.zeros_like(t)
    dt, dd = np.array([one, one, none]), np.array([c[1], c[0], -2 * c[2]])
    w_t, w_d = 1 + alpha / d, -1 / d**2 + alpha * (1 - t / d**2)
    w_td, w_dd = -alpha / d**2, 2 / d**3 + 2 * alpha * t / d**3
    ddd = np.zeros((3, 3, len(t)))
    ddd[0, 1] = ddd[1, 0] = 1.0
    ddd[2, 2] = -2.0
    cross = dt[:, None] * dd[None]
    hessian = w_td * (cross + cross.swapaxes(0, 1)) + w_dd * dd[:, None] * dd[None] + w_d * ddd
    return w_t * dt + w_d * dd, hessian


def stresses(x1: Array, x2: Array, alpha: float | Kirchhoff) -> tuple[Array, Array]:
    """First Piola stresses (2, 3, q) over the tangents ``x_X, x_Y`` (3, q), and their derivative.

    The derivative has the shape (2, 3, 2, 3, q): by direction and component of stress and of tangent.
    """
    tangents = np.array([x1, x2])
    c = np.array([np.sum(x1 * x1, 0), np.sum(x2 * x2, 0), np.sum(x1 * x2, 0)])
    g, h = derivatives(c, alpha)
    factors = np.array([[2 * g[0], g[2]], [g[2], 2 * g[1]]])
    strain = np.zeros((3, 2, 3, x1.shape[1]))  # derivative of c in the tangents
    strain[0, 0], strain[1, 1], strain[2, 0], strain[2, 1] = 2 * x1, 2 * x2, x2, x1
    rate = np.einsum("mnq,nsjq->msjq", h, strain)
    moduli = np.einsum("mriq,msjq->risjq", strain, rate)
    for i in range(3):
        moduli[:, i, :, i] += factors
    return np.einsum("rsq,siq->riq", factors, tangents), moduli


def normal(x1: Array, x2: Array) -> Array:
    """``x_X x x_Y``, shape (3, q)."""
    return np.cross(x1, x2, axis=0)


def normal_rates(x1: Array, x2: Array) -> Array:
    """Derivative (3, 2, 3, q) of the normal in the tangents."""
    out = np.zeros((3, 2, 3, x1.shape[1]))
    for j in range(3):
        unit = np.zeros_like(x1)
        unit[j] = 1.0
        out[:, 0, j], out[:, 1, j] = np.cross(unit, x2, axis=0), np.cross(x1, unit, axis=0)
    return out


@dataclass
class Found:
    """A state: unknowns, load, height of the centre, and the load's rate over that height."""

    u: Array
    load: float
    height: float
    rate: float


Linear = Callable[[Array, float], tuple[Array, Array, Array]]
"""Residual, its derivative in the unknowns and in the load, of unknowns and load."""


def solve(equations: Linear, centre: Array, start: Found, height: float, tolerance: float = 1e-12) -> Found:
    """Newton's method at a height of the centre, which is ``centre`` times the unknowns.

    Raises:
        RuntimeError: If it does not converge.
    """
    n = len(start.u)

    def bordered(u: Array, load: float) -> tuple[Array, Array]:
        residual, k, rate = equations(u, load)
        matrix = np.block([[k, rate[:, None]], [centre[None], np.zeros((1, 1))]])
        return matrix, np.append(residual, centre @ u - height)

    def correct(at: tuple[Array, float]) -> tuple[float, Callable[[float], tuple[Array, float]]]:
        u, load = at
        step = -np.linalg.solve(*bordered(u, load))
        return float(np.abs(step).max()), lambda share: (u + share * step[:n], load + share * step[n])

    what = f"height {height:g}"
    u, load = newton((start.u, start.load), correct, what, longest=np.inf, close=tolerance, most=30, more=0)
    rate = np.linalg.solve(bordered(u, load)[0], np.append(np.zeros(n), 1.0))[n]
    return Found(u, load, height, float(rate))


def follow(equations: Linear, centre: Array, start: Found, heights: Array) -> list[Found]:
    """States at increasing heights, each from the one before; rows in between where they lie far apart."""
    out, at = [], start
    for height in heights:
        steps = max(1, int(np.ceil((height - at.height) / STRIDE)))
        for between in np.linspace(at.height, height, steps + 1)[1:]:
            at = solve(equations, centre, at, float(between))
        out.append(at)
    return out


STRIDE = 0.1
"""Largest step of the height that Newton's method takes."""


def limit(equations: Linear, centre: Array, near: Found, width: float = 0.02) -> Found:
    """The limit load near a state, where the load's rate over the height is zero, by secants."""
    a = near
    b = solve(equations, centre, a, a.height + width)
    for _ in range(20):
        if abs(b.rate - a.rate) < 1e-14:
            break
        target = b.height - b.rate * (b.height - a.height) / (b.rate - a.rate)
        a, b = b, solve(equations, centre, b, target)
        if abs(b.height - a.height) < 1e-9:
            return b
    raise RuntimeError(f"no limit load near the height {near.height:g}")


CLASSES = {"A1": (1, 1, 1), "A2": (-1, -1, -1), "B1": (1, 1, -1), "B2": (-1, -1, 1), "E": (1, -1, 0)}
"""Of each class of the group C4v the parities of z in X and in Y (1 even, -1 odd), and the sign of the
exchange ``(x, y, z)(X, Y) -> (y, x, z)(Y, X)``; 0 in E, which it does not keep."""


def parities(name: str) -> tuple[tuple[int, int], ...]:
    """Those of x, y and z in X and in Y, in a class."""
    p, q, _ = CLASSES[name]
    return (-p, q), (p, -q), (p, q)


def kept(places: list[tuple[int, int, int]], sign: int) -> Array:
    """Orthonormal vectors that the exchange multiplies by a sign, over unknowns (component, row, column)."""
    if not sign:
        return np.eye(len(places))
    number = {place: n for n, place in enumerate(places)}
    other = {0: 1, 1: 0, 2: 2}
    columns = []
    for n, (i, a, b) in enumerate(places):
        image = number[other[i], b, a]
        if image < n or (image == n and sign < 0):
            continue
        column = np.zeros(len(places))
        column[n] = 1.0
        column[image] += sign if image != n else 0.0
        columns.append(column / np.linalg.norm(column))
    return np.array(columns).T
