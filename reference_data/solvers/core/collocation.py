r"""Piecewise Chebyshev collocation for the half tube (first-order strong form).

Unknowns over the unstretched axial coordinate z in [0, L], L = l_f/(2 delta1), z = 0 at the
mid-plane: radius rho, axial position eta, meridional stretch l1 and slope angle b, with
sin b = rho'/l1, cos b = eta'/l1, l2 = rho/r0, r0 = sqrt(delta1):

.. math::
   \rho' = l_1 \sin b,\quad \eta' = l_1 \cos b,\quad
   l_1' = \sin b\,\frac{w_2 - l_1 w_{12}}{r_0 w_{11}},\quad
   b' = \frac{w_2 \cos b - P_{eff}(\rho)\, \rho\, l_1}{r_0 w_1}

(the Euler-Lagrange equations of Patil, Nordmark & Eriksson 2014, solved for the highest
derivatives), b(0) = eta(0) = 0, rho(L) = 1, eta(L) = l_f/2, and one scalar condition, on
u_max = rho(0) - 1 or on the half volume V = int rho^2 eta' dz/2, that makes p an unknown.

Each element carries polynomials of degree M on Chebyshev-Lobatto nodes and meets the
equations at its M Gauss points. Newton's derivatives are complex-step, hence exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.jets import Jet, sin_cos
from reference_data.solvers.core.mooney_rivlin import Tube

Array = np.ndarray
Pressure = Callable[[Any, Any], Any]
STEP = 1e-30  # complex-step increment, which may be arbitrarily small, because nothing is subtracted


def lagrange(nodes: Array, points: Array) -> Array:
    """Matrix of the interpolant through values at ``nodes``, evaluated at ``points``."""
    gaps = nodes[:, None] - nodes[None, :] + np.eye(len(nodes))
    weights = 1 / np.prod(gaps, axis=1)
    diff = points[:, None] - nodes[None, :]
    hit = diff == 0
    terms = weights / np.where(hit, 1.0, diff)
    rows = terms / terms.sum(axis=1, keepdims=True)
    return np.where(hit.any(axis=1, keepdims=True), hit.astype(float), rows)


def differentiation(nodes: Array) -> Array:
    """Matrix of the derivative, at the nodes, of the interpolant through the nodes."""
    gaps = nodes[:, None] - nodes[None, :] + np.eye(len(nodes))
    weights = 1 / np.prod(gaps, axis=1)
    d = weights[None, :] / weights[:, None] / gaps
    np.fill_diagonal(d, 0.0)
    # rows sum to zero exactly: the derivative of a constant
    return d - np.diag(d.sum(axis=1))


@dataclass(frozen=True)
class Mesh:
    """Elements on [0, 1] (fractions of L), graded towards the disk at 1.

    Attributes:
        elements: Number of elements.
        degree: Polynomial degree, also the number of collocation points per element.
        grading: Exponent q of 1 - (1 - s)^q; larger is finer at the disk.
    """

    elements: int
    degree: int
    grading: float = 1.6
    breaks: Array = field(init=False)
    nodes: Array = field(init=False)
    weights: Array = field(init=False)
    value: Array = field(init=False)
    deriv: Array = field(init=False)

    def __post_init__(self) -> None:
        put = lambda name, x: object.__setattr__(self, name, x)  # noqa: E731
        nodes = (1 - np.cos(np.pi * np.arange(self.degree + 1) / self.degree)) / 2
        gauss, weights = np.polynomial.legendre.leggauss(self.degree)
        put("breaks", 1 - (1 - np.linspace(0, 1, self.elements + 1)) ** self.grading)
        put("nodes", nodes)
        put("weights", weights / 2)
        put("value", lagrange(nodes, (gauss + 1) / 2))
        put("deriv", self.value @ differentiation(nodes))

    @property
    def widths(self) -> Array:
        """Element widths as fractions of L."""
        return np.diff(self.breaks)

    @property
    def x(self) -> Array:
        """Node positions, shape (elements, degree + 1)."""
        return self.breaks[:-1, None] + self.widths[:, None] * self.nodes


def rates(y: list[Any], p: Any, tube: Tube, pressure: Pressure) -> list[Any]:
    """Right-hand sides (rho', eta', l1', b'), then the volume density rho^2 eta'/2."""
    rho, _, l1, b = y
    l2, r0 = rho / tube.r0, tube.r0
    w1, w2 = mat.slope(l1, l2, tube.alpha), mat.slope(l2, l1, tube.alpha)
    w11, w12 = mat.curvature(l1, l2, tube.alpha), mat.mixed(l1, l2, tube.alpha)
    s, c = sin_cos(b)
    axial = l1 * c
    return [
        l1 * s,
        axial,
        s * (w2 - l1 * w12) / (r0 * w11),
        (w2 * c - pressure(rho, p) * rho * l1) / (r0 * w1),
        rho * rho * axial / 2,
    ]


@dataclass
class State:
    """One equilibrium: nodal values (elements, degree + 1, 4) of (rho, eta, l1, b), and p."""

    tube: Tube
    mesh: Mesh
    y: Array
    p: float

    def moved_to(self, mesh: Mesh) -> State:
        """The same state on another mesh, by interpolation."""
        return State(self.tube, mesh, evaluate(self.mesh, self.y, mesh.x), self.p)


def evaluate(mesh: Mesh, y: Array, x: Array) -> Array:
    """Piecewise polynomial ``y`` at fractions ``x`` of L; shape of x, then components."""
    flat = np.ravel(x)
    k = np.clip(np.searchsorted(mesh.breaks, flat, side="right") - 1, 0, mesh.elements - 1)
    local = (flat - mesh.breaks[k]) / mesh.widths[k]
    rows = lagrange(mesh.nodes, local)
    return np.einsum("im,imc->ic", rows, y[k]).reshape(*np.shape(x), -1)


class Linearised:
    """Newton system at a state, reduced element by element to the element ends."""

    def __init__(self, state: State, control: str, pressure: Pressure) -> None:
        tube, mesh = state.tube, state.mesh
        self.mesh, (k, m) = mesh, (mesh.elements, mesh.degree)
        h = (mesh.widths * tube.length)[:, None]
        at = [c for c in np.moveaxis(mesh.value @ state.y, -1, 0)]
        f = rates(at, state.p, tube, pressure)
        self.defect = (mesh.deriv @ state.y) - np.stack(f[:4], axis=-1) * h[..., None]
        self.volume = float(np.sum(h * mesh.weights * f[4]))
        jac = np.empty((k, m, 5, 5))  # rate i, derivative with respect to rho, eta, l1, b, p
        for j in range(5):
            args = [a + 1j * STEP if i == j else a for i, a in enumerate(at)]
            bump = rates(args, state.p + (1j * STEP if j == 4 else 0), tube, pressure)
            jac[..., j] = np.stack([np.imag(g) for g in bump], axis=-1) / STEP
        block = np.einsum("mn,ij->minj", mesh.deriv, np.eye(4))[None] - np.einsum(
            "k,kmij,mn->kminj", h[:, 0], jac[:, :, :4, :4], mesh.value
        )
        self.block = block.reshape(k, 4 * m, 4 * (m + 1))
        self.load = (-h[..., None] * jac[:, :, :4, 4]).reshape(k, 4 * m)
        row = np.zeros((k, m + 1, 4))
        if control == "V":
            weight = h * mesh.weights
            row = np.einsum("km,kmj,mn->knj", weight, jac[:, :, 4, :4], mesh.value)
        else:
            row[0, 0, 0] = 1.0
        self.row = row.reshape(k, -1)

    def solve(self, rhs: Array, ends: Array, scalar: float) -> tuple[Array, float]:
        """Solve for (dy, dp); rhs at the Gauss points, ends for b0, eta0, rhoL, etaL."""
        k, m = self.mesh.elements, self.mesh.degree
        right = np.concatenate(
            [-self.block[:, :, :4], -self.load[..., None], rhs.reshape(k, 4 * m, 1)], axis=2
        )
        x = np.linalg.solve(self.block[:, :, 4:], right)  # all but the left node, per element
        size = 4 * (k + 1) + 1
        a, b = np.zeros((size, size)), np.zeros(size)
        for e in range(k):
            rows, left = slice(4 * e, 4 * e + 4), slice(4 * e, 4 * e + 4)
            a[rows, 4 * e + 4 : 4 * e + 8] = np.eye(4)
            a[rows, left] = -x[e, -4:, :4]
            a[rows, -1], b[rows] = -x[e, -4:, 4], x[e, -4:, 5]
            inner = self.row[e, 4:] @ x[e]
            a[-1, left] += self.row[e, :4] + inner[:4]
            a[-1, -1] += inner[4]
            b[-1] -= inner[5]
        for i, place in enumerate((3, 1, 4 * k, 4 * k + 1)):
            a[4 * k + i, place], b[4 * k + i] = 1.0, ends[i]
        b[-1] += scalar
        ends_and_p = np.linalg.solve(a, b)
        left = ends_and_p[:-1].reshape(k + 1, 4)
        factors = np.concatenate([left[:-1], np.full((k, 1), ends_and_p[-1]), np.ones((k, 1))], axis=1)
        inner = np.einsum("kij,kj->ki", x, factors).reshape(k, m, 4)
        return np.concatenate([left[:-1, None], inner], axis=1), float(ends_and_p[-1])


def newton(
    start: State,
    control: str,
    target: float,
    pressure: Pressure = mat.plain_pressure,
    max_iter: int = 40,
) -> tuple[State, Linearised]:
    """Equilibrium with u_max or V equal to ``target``.

    Returns the state and the system linearised at it. Steps are damped while they are large;
    after the first step below 1e-7 one more is taken, which leaves only rounding errors.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    state, small = start, 0
    half = state.tube.lf / 2
    for _ in range(max_iter):
        system = Linearised(state, control, pressure)
        y = state.y
        if small == 2:
            return state, system
        ends = -np.array([y[0, 0, 3], y[0, 0, 1], y[-1, -1, 0] - 1, y[-1, -1, 1] - half])
        now = system.volume if control == "V" else y[0, 0, 0] - 1
        dy, dp = system.solve(-system.defect, ends, target - now)
        size = max(float(np.abs(dy).max()), abs(dp))
        if not np.isfinite(size):
            break
        scale = min(1.0, 0.4 / size)
        state = State(state.tube, state.mesh, y + scale * dy, state.p + scale * dp)
        small += size < 1e-7
    raise RuntimeError(f"collocation: no convergence at {control} = {target:g} for {start.tube}")


def derivatives(
    state: State, system: Linearised, control: str, pressure: Pressure = mat.plain_pressure
) -> tuple[float, float]:
    """First and second derivative of p along the branch, with respect to the control.

    With Y(s) = Y0 + s Y1 + s^2 Y2 + ... the residual's Taylor coefficients of order 1 and 2
    vanish: A Y1 = (0, 1), A Y2 = -(quadratic terms in Y1), A being the bordered matrix, which
    is regular at a limit point. dp/ds = p1, d2p/ds2 = 2 p2.
    """
    zero, tube, mesh = np.zeros_like(system.defect), state.tube, state.mesh
    y1, p1 = system.solve(zero, np.zeros(4), 1.0)
    base, first = mesh.value @ state.y, mesh.value @ y1
    jets = [Jet([base[..., i], first[..., i], np.zeros_like(base[..., i])]) for i in range(4)]
    f = rates(jets, Jet([state.p, p1, 0.0]), tube, pressure)
    h = (mesh.widths * tube.length)[:, None]
    second = np.stack([g.c[2] for g in f[:4]], axis=-1) * h[..., None]
    bend = float(np.sum(h * mesh.weights * f[4].c[2])) if control == "V" else 0.0
    _, p2 = system.solve(second, np.zeros(4), -bend)
    return p1, 2 * p2


def first_guess(tube: Tube, mesh: Mesh, u: float) -> State:
    """A bulge of height u to start Newton from: rho = 1 + u (1 - x^6), eta uniform."""
    x = mesh.x
    slope = -6 * u * x**5 / tube.length
    y = np.stack(
        [
            1 + u * (1 - x**6),
            x * tube.lf / 2,
            np.hypot(tube.delta1, slope),
            np.arctan2(slope, tube.delta1 + 0 * x),
        ],
        axis=-1,
    )
    return State(tube, mesh, y, 0.5)
