r"""Limit points, fold line and cusp of the half tube by finite differences.

With F(y, p, delta1) = 0 the difference equations and J = F_y, the scalar g and the vectors
phi, psi are defined by the bordered systems

.. math::
   \begin{pmatrix} J & b \\ c^T & 0 \end{pmatrix}
   \begin{pmatrix} \varphi \\ g \end{pmatrix} = \begin{pmatrix} 0 \\ 1 \end{pmatrix}, \qquad
   \begin{pmatrix} J & b \\ c^T & 0 \end{pmatrix}^{T}
   \begin{pmatrix} \psi \\ g \end{pmatrix} = \begin{pmatrix} 0 \\ 1 \end{pmatrix},

g = 0 exactly where J is singular, and dg = -psi^T dJ phi. Newton is applied to the extended
system (F, g) = 0 for a limit point, to (F, rho_0 - 1 - u, g) = 0 in (y, p, delta1) for the
fold line; the cusp is the point of that line where psi^T F_yy[phi, phi] = 0. The second
derivatives come from complex steps in the analytic J.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from reference_data.solvers.core.mooney_rivlin import Tube, plain_pressure
from reference_data.solvers.core.newton import newton, secant
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences.branch import GRIDS, State, Trace, refined
from reference_data.solvers.paper2.differences.equations import SMALL, STEP, Array, Grid


class Null:
    """g, phi, psi at one state, and the derivatives of g."""

    def __init__(self, tube: Tube, grid: Grid, state: State) -> None:
        self.tube, self.grid, (self.y, self.p) = tube, grid, state
        self.core = fd.jacobian(tube, grid, self.y, self.p, plain_pressure)
        size = len(self.y)
        self.by_p = fd.by_pressure(tube, grid, self.y, self.p, plain_pressure)
        b, c = self.by_p, np.zeros(size)
        c[0] = 1.0
        for _ in range(2):  # once to find the null vectors, once with them as borders
            b, c = b / np.linalg.norm(b), c / np.linalg.norm(c)
            top = sp.hstack([self.core, sp.csc_matrix(b.reshape(-1, 1))])
            full = sp.vstack([top, sp.csr_matrix(np.append(c, 0.0))], format="csc")
            lu, unit = splu(full), np.append(np.zeros(size), 1.0)
            right, left = lu.solve(unit), lu.solve(unit, trans="T")
            self.phi, self.psi, self.g = right[:-1], left[:-1], float(right[-1])
            b, c = self.psi, self.phi

    def second(self) -> sp.csc_matrix:
        """F_yy[phi, .] as a matrix."""
        bumped = fd.jacobian(self.tube, self.grid, self.y + 1j * STEP * self.phi, self.p, plain_pressure)
        return bumped.imag / STEP

    def g_by_state(self) -> Array:
        """Gradient of g with respect to (y, p)."""
        y = self.y + 1j * STEP * self.phi
        # F is linear in p, so F_py phi is the y-derivative of F(y, 1) - F(y, 0)
        one = fd.residual(self.tube, self.grid, y, 1.0, plain_pressure)
        none = fd.residual(self.tube, self.grid, y, 0.0, plain_pressure)
        by_p = np.imag(one - none) / STEP
        return -np.append(self.second().T @ self.psi, self.psi @ by_p)

    def by_delta1(self) -> tuple[Array, float]:
        """Derivatives of F and of g with respect to delta1 (z/L fixed)."""
        tube = replace(self.tube, delta1=self.tube.delta1 + 1j * STEP)
        f = fd.residual(tube, self.grid, self.y, self.p, plain_pressure)
        core = fd.jacobian(tube, self.grid, self.y, self.p, plain_pressure)
        return np.imag(f) / STEP, -float(self.psi @ (core.imag / STEP @ self.phi))

    def cubic_degeneracy(self) -> float:
        """psi^T F_yy[phi, phi] for phi scaled to phi(rho_0) = 1: zero at a cusp."""
        scale = self.phi[0] ** 2 * float(np.abs(self.psi).max())
        return float(self.psi @ (self.second() @ self.phi)) / scale


def limit_point(tube: Tube, grid: Grid, start: State) -> State:
    """Newton on (F, g) = 0 for (y, p).

    Raises:
        RuntimeError: If the iteration does not converge.
    """

    def correct(state: State) -> tuple[float, Callable[[float], State]]:
        null, (y, p) = Null(tube, grid, state), state
        rhs = -np.append(fd.residual(tube, grid, y, p, plain_pressure), null.g)
        step = fd.bordered_solve(null.core, [null.by_p], [null.g_by_state()], rhs)
        return float(np.abs(step).max()), lambda share: (y + share * step[:-1], p + share * float(step[-1]))

    what = f"finite differences: limit point of {tube}, n = {grid.n}"
    return newton(start, correct, what, longest=0.3, close=SMALL, most=25)


def fold_at(tube: Tube, grid: Grid, start: State, u: float) -> tuple[Tube, State]:
    """The limit point with u_max = u, for (y, p, delta1); the tube's own delta1 is the guess.

    Raises:
        RuntimeError: If the iteration does not converge.
    """

    def correct(found: tuple[Tube, State]) -> tuple[float, Callable[[float], tuple[Tube, State]]]:
        tube, (y, p) = found
        null = Null(tube, grid, (y, p))
        f_delta, g_delta = null.by_delta1()
        _, control = fd.control_row("u", y)
        residual = fd.residual(tube, grid, y, p, plain_pressure)
        rhs = -np.concatenate([residual, [y[0] - 1 - u, null.g]])
        rows = [np.append(control, 0.0), np.append(null.g_by_state(), g_delta)]
        step = fd.bordered_solve(null.core, [null.by_p, f_delta], rows, rhs)

        def advance(share: float) -> tuple[Tube, State]:
            moved = replace(tube, delta1=tube.delta1 + share * float(step[-1]))
            return moved, (y + share * step[:-2], p + share * float(step[-2]))

        return float(np.abs(step).max()), advance

    what = f"finite differences: fold of {tube} at u_max = {u:g}, n = {grid.n}"
    return newton((tube, start), correct, what, longest=0.2, close=SMALL, most=25)


def fold_top(tube: Tube, grid: Grid, start: State, step: float = 0.05) -> tuple[Tube, State]:
    """Follow the fold line from a first limit point until delta1 stops rising."""
    here, state = tube, start
    while True:
        ahead, further = fold_at(here, grid, state, float(state[0][0]) - 1 + step)
        if ahead.delta1 < here.delta1:
            return here, state
        here, state = ahead, further


def cusp(tube: Tube, grid: Grid, start: State) -> tuple[Tube, State]:
    """Secant iteration along the fold line for psi^T F_yy[phi, phi] = 0.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    here = [(tube, start)]

    def degeneracy(u: float) -> float:
        here[0] = fold_at(here[0][0], grid, here[0][1], float(u))
        return Null(here[0][0], grid, here[0][1]).cubic_degeneracy()

    u = float(start[0][0]) - 1
    degeneracy(secant(degeneracy, u, u + 0.02, 0.3)[0])
    return here[0]


def limit_points(tube: Tube, u_stop: float, v_stop: float = np.inf) -> list[list[State]]:
    """Every limit point with u_max (and V) up to the bound, each on the three grids."""
    first = Grid(GRIDS[0])
    trace = Trace(tube, first).run(u_stop, v_stop)
    return [climb(tube, start, limit_point) for start in trace.turning_points()]


def climb(tube: Tube, start: State, solve: Callable[[Tube, Grid, State], State]) -> list[State]:
    """Apply a solver on the three grids, each starting from the coarser result."""
    grids = [Grid(n) for n in GRIDS]
    states = [solve(tube, grids[0], start)]
    for grid, finer in pairwise(grids):
        states.append(solve(tube, finer, refined(states[-1], grid, finer)))
    return states
