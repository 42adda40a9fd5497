r"""Lopsided states by the energy of the whole tube as a surface in space (method b).

The functional, its gradient and its complex-step second derivatives are those of ``tube_waves.ritz``; the
trial functions are polynomials on elements of the whole tube, finer at both disks. Only the disks hold the
tube. The volume, or the axial position w of the middle, is given.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from reference_data.solvers.beyond.tube_waves import ritz
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton


@dataclass(frozen=True)
class Whole(ritz.Basis):
    """Continuous polynomials on elements of [-1, 1], finer at both ends; ``elements`` on either half."""

    @cached_property
    def edges(self) -> Array:
        """Ends of the elements."""
        half = 1 - (1 - np.linspace(0, 1, self.elements + 1)) ** self.power
        return np.concatenate([-half[:0:-1], half])

    @cached_property
    def rule(self) -> tuple[Array, Array, Array, Array]:
        """Gauss points, weights, values and slopes of all functions there, (points, functions)."""
        gauss, weights = np.polynomial.legendre.leggauss(self.degree + ritz.EXTRA)
        local, t = ritz.lobatto(self.degree), (gauss + 1) / 2
        value = ritz.lagrange(local, t)
        slope, count, parts = value @ ritz.differentiation(local), len(t), 2 * self.elements
        points, w = np.empty(parts * count), np.empty(parts * count)
        phi, dphi = np.zeros((2, parts * count, len(self.nodes)))
        for e, (left, width) in enumerate(zip(self.edges[:-1], np.diff(self.edges), strict=True)):
            rows = slice(e * count, (e + 1) * count)
            columns = slice(e * self.degree, (e + 1) * self.degree + 1)
            points[rows], w[rows] = left + width * t, width * weights / 2
            phi[rows, columns], dphi[rows, columns] = value, slope / width
        return points, w, phi, dphi

    @property
    def middle(self) -> int:
        """Index of the node at the middle."""
        return self.elements * self.degree


BASES = Whole(8, 12), Whole(11, 14)


@dataclass
class State(ritz.State):
    """One state of the whole tube; its volume is the whole one."""

    basis: Whole
    uneven: float = 0.0
    """``e`` of the thickness ``1 + e s``, s from -1 to 1 along the tube."""

    @property
    def thickening(self) -> Array:
        """Thickness at the Gauss points, less 1."""
        return self.uneven * self.basis.rule[0]

    @property
    def u_max(self) -> float:
        """Radial displacement of the middle."""
        return float(self.r[self.basis.middle] - 1)

    @property
    def w_mid(self) -> float:
        """Axial displacement of the middle."""
        return float(self.z[self.basis.middle])

    def meridian(self, places: Array) -> tuple[Array, Array]:
        """Rho and eta at places along the half length, from -1 to 1."""
        basis = self.basis
        e = np.clip(np.searchsorted(basis.edges, places, side="right") - 1, 0, 2 * basis.elements - 1)
        rows = ritz.lagrange(ritz.lobatto(basis.degree), (places - basis.edges[e]) / np.diff(basis.edges)[e])
        columns = e[:, None] * basis.degree + np.arange(basis.degree + 1)
        r, z = ((rows * values[columns]).sum(axis=1) for values in (self.r, self.z))
        return r, z


def bordered(state: State, held: str) -> tuple[Array, Array]:
    """Matrix and right-hand side for (r, z, p); the last equation is that of V or w, still without its value.

    The pressure's force is the gradient of the volume, with the opposite sign.
    """
    n = len(state.r)
    disks = np.array([0, n - 1, n, 2 * n - 1])
    residual, matrix, by_p = ritz.linear(state)
    row = np.eye(1, 2 * n, n + state.basis.middle)[0] if held == "w" else -by_p
    half = state.tube.lf / 2
    residual[disks] = [state.r[0] - 1, state.r[-1] - 1, state.z[0] + half, state.z[-1] - half]
    by_p = by_p.copy()
    matrix[disks], by_p[disks] = 0.0, 0.0
    matrix[disks, disks] = 1.0
    return np.block([[matrix, by_p[:, None]], [row[None, :], np.zeros((1, 1))]]), np.append(residual, 0.0)


def solve(guess: State, held: str, value: float) -> State:
    """The state with a given volume, or w.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    n = len(guess.r)

    def correct(at: State) -> tuple[float, Callable[[Any], State]]:
        matrix, right = bordered(at, held)
        right[-1] = (at.volume if held == "V" else at.w_mid) - value
        step = np.linalg.solve(matrix, -right)

        def advance(share: Any) -> State:
            moved = float(share) * step
            r, z = at.r + moved[:n], at.z + moved[n : 2 * n]
            return State(at.tube, at.basis, r, z, at.p + moved[-1], at.uneven)

        return float(np.abs(step).max()), advance

    return newton(guess, correct, f"lopsided states of {guess.tube} by their energy", longest=0.3)


def at(tube: Tube, basis: Whole, near: Any, held: str, value: float) -> State:
    """The state near one of the other method, which is the guess."""
    r, z = near.meridian(basis.nodes)
    return solve(State(tube, basis, r, z, near.p, near.uneven), held, value)


def rates_of(state: State) -> tuple[float, float]:
    """dp/dw and dV/dw along the branch."""
    n = len(state.r)
    matrix, right = bordered(state, "w")
    right[:], right[-1] = 0.0, 1.0
    step = np.linalg.solve(matrix, right)
    return float(step[-1]), float(-ritz.linear(state)[2] @ step[: 2 * n])


def rate(state: State) -> float:
    """dp/dV along the branch."""
    matrix, right = bordered(state, "V")
    right[:], right[-1] = 0.0, 1.0
    return float(np.linalg.solve(matrix, right)[-1])
