r"""Central finite differences for the half tube (second-order strong form).

This is the kind of scheme the paper itself uses (Patil, Nordmark & Eriksson 2014): the
Euler-Lagrange equations, in the unstretched axial coordinate z in [0, L], L = l_f/(2 delta1),

.. math::
   \big(r_0 w_1 \rho'/\lambda_1\big)' = w_2 - P_{eff}(\rho)\, \rho\, \eta', \qquad
   \big(r_0 w_1 \eta'/\lambda_1\big)' = P_{eff}(\rho)\, \rho\, \rho',

lambda1 = sqrt(rho'^2 + eta'^2), lambda2 = rho/r0, r0 = sqrt(delta1), with fluxes at half points
and central differences at the nodes of a smoothly mapped grid, z = L tanh(a x)/tanh(a), x
uniform, which is fine at the disk. At the mid-plane rho is mirrored and eta is odd, so the
same formulas hold there and every error is a series in even powers of h = 1/n: three grids
give h^2 and h^4 eliminated, and an uncertainty.

The Jacobian is analytic; only P_eff'(rho) and dF/dp are complex-step (hence also exact).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton as iterate

Array = np.ndarray
Pressure = Callable[[Any, Any], Any]
STEP = 1e-30
SMALL = 1e-6  # Newton takes one more step after the first step below this: rounding only


@dataclass(frozen=True)
class Grid:
    """Grid of n cells; ``node`` and ``half`` hold (dz/dx)/L there, times h."""

    n: int
    stretch: float = 1.5
    x: Array = field(init=False)
    node: Array = field(init=False)
    half: Array = field(init=False)

    def __post_init__(self) -> None:
        put = lambda name, x: object.__setattr__(self, name, x)  # noqa: E731
        put("x", np.arange(self.n + 1) / self.n)
        put("node", self.density(self.x) / self.n)
        put("half", self.density((self.x[1:] + self.x[:-1]) / 2) / self.n)

    def density(self, x: Array) -> Array:
        """Derivative of the mapping z/L = tanh(a x)/tanh(a)."""
        return self.stretch / np.tanh(self.stretch) / np.cosh(self.stretch * x) ** 2

    def fraction(self, x: Array) -> Array:
        """The mapping z/L itself."""
        return np.tanh(self.stretch * x) / np.tanh(self.stretch)

    def inverse(self, fraction: Array) -> Array:
        """Grid coordinate x of a fraction z/L."""
        return np.arctanh(np.asarray(fraction) * np.tanh(self.stretch)) / self.stretch


@dataclass
class Half:
    """Quantities at half points: slopes a = rho', b = eta', stretches and energy slopes."""

    a: Array
    b: Array
    l1: Array
    rho: Array
    l2: Array
    w1: Array


def half_points(tube: Tube, grid: Grid, y: Array) -> Half:
    """Slopes and stretches midway between the nodes."""
    rho, eta = y[0::2], y[1::2]
    dz = grid.half * tube.length
    a, b, mid = np.diff(rho) / dz, np.diff(eta) / dz, (rho[1:] + rho[:-1]) / 2
    l1, l2 = np.sqrt(a * a + b * b), mid / tube.r0
    return Half(a, b, l1, mid, l2, mat.slope(l1, l2, tube.alpha))


def node_slopes(tube: Tube, grid: Grid, y: Array) -> tuple[Array, Array]:
    """Central rho', eta' at nodes 0 .. n-1; at the mid-plane from the mirrored neighbour."""
    dz = grid.node[:-1] * tube.length
    rho = np.concatenate([y[2:3], y[0::2]])
    eta = np.concatenate([-y[3:4], y[1::2]])
    return (rho[2:] - rho[:-2]) / (2 * dz), (eta[2:] - eta[:-2]) / (2 * dz)


def residual(tube: Tube, grid: Grid, y: Array, p: Any, pressure: Pressure) -> Array:
    """Difference equations at nodes 0 .. n-1 and the conditions at both ends.

    y holds (rho_0, eta_0, ..., rho_n, eta_n); equation 2i belongs to rho_i, 2i+1 to eta_i.
    """
    at = half_points(tube, grid, y)
    flux_r, flux_e = tube.r0 * at.w1 * at.a / at.l1, tube.r0 * at.w1 * at.b / at.l1
    a, b = node_slopes(tube, grid, y)
    rho = y[0:-2:2]
    dz = grid.node[:-1] * tube.length
    l1, l2 = np.sqrt(a * a + b * b), rho / tube.r0
    push = pressure(rho, p) * rho
    out = np.zeros(len(y), dtype=np.result_type(flux_r, push))
    # the meridional flux of rho is odd about the mid-plane: the mirrored one is its negative
    left = np.concatenate([-flux_r[:1], flux_r[:-1]])
    out[0:-2:2] = (flux_r - left) / dz - mat.slope(l2, l1, tube.alpha) + push * b
    out[3:-2:2] = np.diff(flux_e) / dz[1:] - push[1:] * a[1:]
    out[1], out[-2], out[-1] = y[1], y[-2] - 1, y[-1] - tube.lf / 2
    return out


def _flux_blocks(tube: Tube, at: Half, dz: Array) -> tuple[Array, Array]:
    """Derivatives of the fluxes (rho, eta) at half points by the left and the right node."""
    c, s, r0 = at.b / at.l1, at.a / at.l1, tube.r0
    w11, w12 = mat.curvature(at.l1, at.l2, tube.alpha), mat.mixed(at.l1, at.l2, tube.alpha)
    t = at.w1 / at.l1
    by_slope = r0 * np.array(
        [[w11 * s * s + t * c * c, (w11 - t) * s * c], [(w11 - t) * s * c, w11 * c * c + t * s * s]]
    )
    by_rho = np.zeros_like(by_slope)
    by_rho[0, 0], by_rho[1, 0] = w12 * s / 2, w12 * c / 2
    return by_rho - by_slope / dz, by_rho + by_slope / dz


def jacobian(tube: Tube, grid: Grid, y: Array, p: Any, pressure: Pressure) -> sp.csc_matrix:
    """Analytic derivative of :func:`residual` with respect to y (also for complex y)."""
    return _assemble(jacobian_blocks(tube, grid, y, p, pressure), grid.n)


def jacobian_blocks(tube: Tube, grid: Grid, y: Array, p: Any, pressure: Pressure) -> Array:
    """The derivative as blocks: node 0 .. n-1, equation, unknown, neighbour (left, self, right)."""
    n, at = grid.n, half_points(tube, grid, y)
    left, right = _flux_blocks(tube, at, grid.half * tube.length)
    dz = grid.node[:-1] * tube.length
    a, b = node_slopes(tube, grid, y)
    rho = y[0:-2:2]
    l1, l2 = np.sqrt(a * a + b * b), rho / tube.r0
    w12, w22 = mat.mixed(l1, l2, tube.alpha), mat.curvature(l2, l1, tube.alpha)
    push = pressure(rho, p) * rho
    if np.iscomplexobj(y):  # second derivatives of F: so far only for P_eff = p
        if pressure is not mat.plain_pressure:
            raise ValueError("complex states are only implemented for free inflation")
        slope = push / rho
    else:
        slope = np.imag(pressure(rho + 1j * STEP, p) * (rho + 1j * STEP)) / STEP
    blocks = np.zeros((n, 2, 2, 3), dtype=left.dtype)  # node, equation, unknown, neighbour
    blocks[..., 1] += np.moveaxis(left, -1, 0) / dz[:, None, None]
    blocks[..., 2] += np.moveaxis(right, -1, 0) / dz[:, None, None]
    blocks[1:, :, :, 0] -= np.moveaxis(left[..., :-1], -1, 0) / dz[1:, None, None]
    blocks[1:, :, :, 1] -= np.moveaxis(right[..., :-1], -1, 0) / dz[1:, None, None]
    central = np.array([[-w12 * a / l1, -w12 * b / l1 + push], [-push, 0 * push]]) / (2 * dz)
    blocks[..., 2] += np.moveaxis(central, -1, 0)
    blocks[..., 0] -= np.moveaxis(central, -1, 0)
    blocks[:, 0, 0, 1] += -w22 / tube.r0 + slope * b
    blocks[:, 1, 0, 1] -= slope * a
    # mid-plane: rho_{-1} = rho_1, eta_{-1} = -eta_1 and the odd flux doubles the right one
    blocks[0, 0, :, 1:] += np.stack([left[0, :, 0], right[0, :, 0]], axis=-1) / dz[0]
    blocks[0, 0, :, 2] += blocks[0, 0, :, 0] * np.array([1, -1])
    blocks[0, 1] = 0
    blocks[0, 1, 1, 1] = 1
    return blocks


def _assemble(blocks: Array, n: int) -> sp.csc_matrix:
    """Block-tridiagonal matrix with unit rows for the two conditions at the disk."""
    node, eq, unknown, nb = np.meshgrid(*map(np.arange, blocks.shape), indexing="ij")
    rows, cols = 2 * node + eq, 2 * (node + nb - 1) + unknown
    keep = cols >= 0
    rows = np.concatenate([rows[keep], [2 * n, 2 * n + 1]])
    cols = np.concatenate([cols[keep], [2 * n, 2 * n + 1]])
    values = np.concatenate([blocks[keep], [1.0, 1.0]])
    return sp.csc_matrix((values, (rows, cols)), shape=(2 * n + 2, 2 * n + 2))


def bordered_solve(core: Any, cols: list[Array], rows: list[Array], rhs: Array) -> Array:
    """Solve [[core, cols], [rows]] x = rhs; each row is as long as the whole system."""
    m = core.shape[0]
    top = sp.hstack([core] + [sp.csc_matrix(c.reshape(m, 1)) for c in cols])
    full = sp.vstack([top] + [sp.csr_matrix(r.reshape(1, -1)) for r in rows], format="csc")
    return splu(full).solve(rhs)


def volume(y: Array) -> Any:
    """V = int rho^2 eta' dz/2 by the midpoint rule."""
    rho, eta = y[0::2], y[1::2]
    return np.sum(((rho[1:] + rho[:-1]) / 2) ** 2 * np.diff(eta)) / 2


def control_row(control: str, y: Array) -> tuple[float, Array]:
    """Value of the control (u_max or V) and its gradient with respect to (y, p)."""
    row = np.zeros(len(y) + 1)
    if control != "V":
        row[0] = 1.0
        return float(y[0]) - 1, row
    rho, eta = y[0::2], y[1::2]
    mid, step = (rho[1:] + rho[:-1]) / 2, np.diff(eta)
    row[0:-3:2] += mid * step / 2
    row[2:-1:2] += mid * step / 2
    row[1:-3:2] -= mid**2 / 2
    row[3:-1:2] += mid**2 / 2
    return float(volume(y)), row


def by_pressure(tube: Tube, grid: Grid, y: Array, p: float, pressure: Pressure) -> Array:
    """Derivative of the residual with respect to p."""
    return np.imag(residual(tube, grid, y, p + 1j * STEP, pressure)) / STEP


Condition = Callable[[Array, float], tuple[float, Array]]


def newton(
    tube: Tube,
    grid: Grid,
    start: tuple[Array, float],
    condition: Condition,
    pressure: Pressure = mat.plain_pressure,
    max_iter: int = 40,
) -> tuple[Array, float]:
    """Solve the difference equations together with one scalar condition for (y, p).

    Args:
        tube: The problem.
        grid: The grid.
        start: First guess (y, p).
        condition: Value (to vanish) and gradient, as functions of y and p.
        pressure: Effective pressure P_eff(rho, p).
        max_iter: Iterations allowed.

    Raises:
        RuntimeError: If the iteration does not converge.
    """

    def correct(state: tuple[Array, float]) -> tuple[float, Callable[[float], tuple[Array, float]]]:
        y, p = state
        value, row = condition(y, p)
        rhs = -np.append(residual(tube, grid, y, p, pressure), value)
        core = jacobian(tube, grid, y, p, pressure)
        step = bordered_solve(core, [by_pressure(tube, grid, y, p, pressure)], [row], rhs)
        return float(np.abs(step).max()), lambda share: (y + share * step[:-1], p + share * float(step[-1]))

    return iterate(start, correct, f"finite differences of {tube}, n = {grid.n}", close=SMALL, most=max_iter)


def at_control(control: str, target: float) -> Condition:
    """The condition 'u_max (or V) equals target'."""

    def condition(y: Array, _: float) -> tuple[float, Array]:
        value, row = control_row(control, y)
        return value - target, row

    return condition


def first_guess(tube: Tube, grid: Grid, u: float) -> tuple[Array, float]:
    """A bulge of height u: rho = 1 + u (1 - (z/L)^6), eta uniform."""
    zeta = grid.fraction(grid.x)
    y = np.empty(2 * grid.n + 2)
    y[0::2], y[1::2] = 1 + u * (1 - zeta**6), zeta * tube.lf / 2
    return y, 0.5
