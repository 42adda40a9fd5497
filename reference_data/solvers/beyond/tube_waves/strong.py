r"""Waves by the linearised strong equations of a membrane in space (method b).

With the tangents a = x_z and b = x_th/r0, G = a.a, H = b.b, and W = f(t, J) of t = G + H and
J = G H - (a.b)^2, the stress vectors are N = dW/da = 2 f_t a + 2 f_J (H a - (a.b) b), and M = dW/db with a
and b exchanged. Equilibrium under a gas is

.. math:: (r_0 N)' + \partial_\theta M + p\, x_\theta \times x_z = 0.

Linearised at a state of revolution, where a.b = 0, for the wave (u cos n th, b sin n th, w cos n th), this is
a system of six equations of first order for q = (u, b, w) and the forces m = r0 dN. A state is neutral to a
family if the solutions with the family's three conditions at the mid-plane have a combination that vanishes
at the disk: a 3 x 3 determinant is zero. The states are those of the collocation of paper 2; the transfer
matrix of the linear system is collocated on the same elements.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.beyond.tube_waves.family import Family
from reference_data.solvers.core.collocation import Array, Mesh
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2.collocation import equations as eq
from reference_data.solvers.paper2.collocation.critical import start
from reference_data.solvers.paper2.collocation.equations import State, Zone, solve

MESHES = (Mesh.graded(12, 12, 2.0), Mesh.graded(16, 16, 2.0))


def forces(tube: Tube, n: int, p: float, base: Array, q: Array, slope: Array) -> tuple[Array, Array]:
    """Forces m, and m' without the part that is a derivative of m, of a wave and its slope.

    Args:
        tube: The membrane.
        n: Wave number.
        p: Pressure.
        base: (rho, l1, angle) at points, in the last axis.
        q: (u, b, w) there.
        slope: Their derivatives in z.
    """
    r, l1, angle = base
    r0, alpha = tube.r0, tube.alpha
    s, c, l2 = np.sin(angle), np.cos(angle), r / r0
    g, h = l1**2, l2**2
    t, j = g + h, g * h
    f_t, f_j = 1 + alpha / j, -1 / j**2 + alpha * (1 - t / j**2)
    f_tj, f_jj = -alpha / j**2, 2 / j**3 + 2 * alpha * t / j**3
    (u, b, w), (u1, b1, w1) = q, slope
    along = l1 * (s * u1 + c * w1)  # a.da
    around = l2 * (u + n * b) / r0  # b.db
    shear = -l1 * (s * (n * u + b) + c * n * w) / r0 + l2 * b1  # a.db + b.da
    dt, dj = 2 * (along + around), 2 * (h * along + g * around)
    first = 2 * f_tj * dj + 2 * h * (f_tj * dt + f_jj * dj) + 4 * f_j * around  # times a
    second = 2 * f_tj * dj + 2 * g * (f_tj * dt + f_jj * dj) + 4 * f_j * along  # times b
    spread_a, spread_b = 2 * (f_t + f_j * h), 2 * (f_t + f_j * g)
    m = r0 * np.array(
        [
            spread_a * u1 + first * l1 * s,
            spread_a * b1 - 2 * f_j * shear * l2,
            spread_a * w1 + first * l1 * c,
        ]
    )
    turned = np.array([-(n * u + b), u + n * b, -n * w])  # derivative of the wave in th
    fr = spread_b * turned[0] / r0 - 2 * f_j * shear * l1 * s
    ft = spread_b * turned[1] / r0 + second * l2
    fz = spread_b * turned[2] / r0 - 2 * f_j * shear * l1 * c
    push = p * np.array(
        [
            turned[1] * l1 * c + r * w1,
            turned[2] * l1 * s - turned[0] * l1 * c,
            -turned[1] * l1 * s - r * u1,
        ]
    )
    return m, -np.array([n * fr - ft, fr - n * ft, n * fz]) - push


def system(state: State, n: int) -> Array:
    """Matrix of the six equations over z at the Gauss points, shape (elements, points, 6, 6)."""
    mesh = state.zones[0].mesh
    rho, _, l1, angle, _ = np.moveaxis(mesh.rule.value @ state.y[0], -1, 0)
    at, unit = (rho, l1, angle), np.eye(3)[:, :, None, None] * np.ones_like(rho)
    zero = np.zeros_like(unit[0])
    by_q = [forces(state.tube, n, state.p, at, e, zero) for e in unit]
    by_slope = [forces(state.tube, n, state.p, at, zero, e) for e in unit]
    order = (2, 3, 1, 0)  # columns are the unit vectors

    def matrix(found: list[tuple[Array, Array]], k: int) -> Array:
        return np.transpose(np.array([f[k] for f in found]), order)

    stiff, mixed = matrix(by_slope, 0), matrix(by_q, 0)
    inverse = np.linalg.inv(stiff)
    top = np.concatenate([-inverse @ mixed, inverse], axis=-1)
    rest = matrix(by_slope, 1)
    bottom = np.concatenate([matrix(by_q, 1) + rest @ top[..., :3], rest @ top[..., 3:]], axis=-1)
    return np.concatenate([top, bottom], axis=-2)


def transferred(state: State, n: int, begin: Array) -> Array:
    """An orthonormal basis, at the disk, of the solutions with given values at the mid-plane.

    It is made orthonormal again after every element, without a change of orientation: otherwise all columns
    would turn to the solution that grows most.
    """
    mesh, a = state.zones[0].mesh, system(state, n)
    points = len(mesh.rule.points)
    for block, width in zip(a, mesh.widths * state.tube.length, strict=True):
        matrix = np.einsum("mq,ij->miqj", mesh.rule.deriv, np.eye(6))
        matrix = matrix - width * np.einsum("mij,mq->miqj", block, mesh.rule.value)
        flat = matrix.reshape(6 * points, 6 * (points + 1))
        step = np.linalg.solve(flat[:, 6:], -flat[:, :6])[-6:]
        q, r = np.linalg.qr(step @ begin)
        begin = q * np.sign(np.diag(r))
    return begin


def determinant(state: State, family: Family) -> float:
    """The determinant; its sign tells sides of a neutral state apart."""
    begin = np.eye(6)[:, [*family.free, *(3 + i for i in family.zero)]]
    return float(np.linalg.det(transferred(state, family.n, begin)[:3]))


def states(tube: Tube, volumes: Array) -> list[State]:
    """States of the finest mesh at rising volumes."""
    state, out = start(tube, MESHES[-1], "V", float(volumes[0])), []
    for volume in volumes:
        state = solve(state, V=float(volume))
        out.append(state)
    return out


def least_hoop(state: State) -> tuple[float, float]:
    """Smallest l1 l2^2 - 1, which has the sign of the hoop resultant for every law, and its Z."""
    mesh = state.zones[0].mesh

    def margin(s: Array) -> Array:
        y = mesh.evaluate(state.y[0], s)
        return y[..., 2] * (y[..., 0] / state.tube.r0) ** 2 - 1

    s = np.unique(mesh.edges[:-1, None] + mesh.widths[:, None] * np.linspace(0, 1, 33))
    found = margin(s)
    k = int(np.argmin(found))
    low, high = s[max(k - 1, 0)], s[min(k + 1, len(s) - 1)]
    for _ in range(40):
        fine = np.linspace(low, high, 9)
        found = margin(fine)
        k = int(np.argmin(found))
        low, high = fine[max(k - 1, 0)], fine[min(k + 1, 8)]
    return float(found[k]), float(fine[k] * state.tube.lf / 2)


def rate(state: State) -> float:
    """dp/dV along the branch."""
    return eq.slopes(state, "V")[0]


def roots(near: State, function: Callable[[State], float], low: float, high: float) -> list[State]:
    """The state between two volumes at which a function of states is zero, on both meshes."""
    out = []
    for mesh in MESHES:
        here = [solve(eq.recut(near, (Zone(mesh),), ()), V=near.volume)]

        def value(volume: float, here: list[State] = here) -> float:
            here[0] = solve(here[0], V=volume)
            return function(here[0])

        out.append(solve(here[0], V=brentq(value, low, high, xtol=1e-13, rtol=1e-14)))
    return out
