"""Method (b) for framed sheets: Galerkin's method with Legendre polynomials over the whole square.

The displacements are sums of products of integrated Legendre polynomials, which vanish on the edges, with the
parities of a state with both mirrors. Gauss's rule on a quarter integrates. At the corners the deflection
contains ``r^2 ln r``; the error falls algebraically with the degree there.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss, legval

from reference_data.solvers.beyond.framed_sheet import (
    Array,
    Found,
    Framed,
    energy,
    normal,
    normal_rates,
    stresses,
)

EVEN, ODD = 1, 2
"""First index of integrated Legendre polynomials of either parity."""

PARITIES = ((ODD, EVEN), (EVEN, ODD), (EVEN, EVEN))
"""Of x, y and z in X and in Y."""


def shapes(first: int, degree: int, x: Array) -> tuple[Array, Array]:
    """``(P_{k+1} - P_{k-1})/sqrt(4k + 2)`` of one parity at points, and their derivatives."""
    values, slopes = [], []
    for k in range(first, degree, 2):
        unit = np.eye(k + 2)
        values.append((legval(x, unit[k + 1]) - legval(x, unit[k - 1])) / np.sqrt(4 * k + 2))
        slopes.append(np.sqrt(k + 0.5) * legval(x, unit[k]))
    return np.array(values), np.array(slopes)


class RitzSheet:
    """The discrete sheet.

    Args:
        sheet: Law, frame and load.
        degree: Degree in either direction.
        more: Gauss points on half an edge beyond two thirds of the degree.
    """

    def __init__(self, sheet: Framed, degree: int, more: int = 14) -> None:
        self.sheet = sheet
        points, weights = leggauss(2 * degree // 3 + more)
        x, w = (points + 1) / 2, weights / 2
        self.weights = 4 * np.outer(w, w).ravel()
        self.place = np.array([p.ravel() for p in np.meshgrid(x, x, indexing="ij")])
        self.values, self.slopes, middle = [], [], []
        for first, second in PARITIES:
            (a, da), (b, db) = shapes(first, degree, x), shapes(second, degree, x)
            self.values.append(_products(a, b))
            self.slopes.append((_products(da, b), _products(a, db)))
            (at, _), (by, _) = shapes(first, degree, np.zeros(1)), shapes(second, degree, np.zeros(1))
            middle.append(_products(at, by)[:, 0])
        counts = [len(v) for v in self.values]
        self.parts = np.split(np.arange(sum(counts)), np.cumsum(counts)[:-1])
        self.centre = np.zeros(sum(counts))
        self.centre[self.parts[2]] = sheet.sign * middle[2]

    def start(self, height: float, load: float) -> Found:
        """A guess: half a wave of cosine in either direction, projected."""
        u = np.zeros(len(self.centre))
        wave = self.sheet.sign * height * np.cos(np.pi * self.place / 2).prod(axis=0)
        basis = self.values[2]
        gram = (basis * self.weights) @ basis.T
        u[self.parts[2]] = np.linalg.solve(gram, basis @ (self.weights * wave))
        return Found(u, load, height, 0.0)

    def tangents(self, u: Array) -> tuple[Array, Array]:
        """``x_X`` and ``x_Y`` at the points."""
        out = []
        for s in range(2):
            tangent = np.array(
                [u[part] @ slopes[s] for part, slopes in zip(self.parts, self.slopes, strict=True)]
            )
            tangent[s] += self.sheet.delta
            out.append(tangent)
        return out[0], out[1]

    def height(self, u: Array) -> Array:
        """``z`` at the points."""
        return u[self.parts[2]] @ self.values[2]

    def equations(self, u: Array, load: float) -> tuple[Array, Array, Array]:
        """Residual, its derivatives in the coefficients and in the load."""
        x1, x2 = self.tangents(u)
        stress, moduli = stresses(x1, x2, self.sheet.alpha)
        push, slope, rate = self.sheet.push(self.height(u), load)
        n, turns = normal(x1, x2), normal_rates(x1, x2)
        w, size = self.weights, len(u)
        residual, k, by_load = np.zeros(size), np.zeros((size, size)), np.zeros(size)
        for i, rows in enumerate(self.parts):
            of, ds = self.values[i], self.slopes[i]
            residual[rows] = ds[0] @ (w * stress[0, i]) + ds[1] @ (w * stress[1, i]) - of @ (w * push * n[i])
            by_load[rows] = -of @ (w * rate * n[i])
            for j, columns in enumerate(self.parts):
                block = np.zeros((len(rows), len(columns)))
                for s in range(2):
                    right = (w * moduli[0, i, s, j]) * ds[0] + (w * moduli[1, i, s, j]) * ds[1]
                    right -= (w * push * turns[i, s, j]) * of
                    block += right @ self.slopes[j][s].T
                if j == 2:
                    block -= ((w * slope * n[i]) * of) @ self.values[2].T
                k[np.ix_(rows, columns)] = block
        return residual, k, by_load

    def columns(self, found: Found) -> dict[str, float]:
        """Volume, strain energy, and the load."""
        x1, x2 = self.tangents(found.u)
        c = np.array([np.sum(x1 * x1, 0), np.sum(x2 * x2, 0), np.sum(x1 * x2, 0)])
        amount = self.sheet.amount(self.height(found.u), found.load) * normal(x1, x2)[2]
        return {
            "load": found.load,
            "w_c": found.height,
            "amount": float(self.weights @ amount),
            "U": float(self.weights @ energy(c, self.sheet.alpha)),
        }


def _products(a: Array, b: Array) -> Array:
    return np.einsum("ix,jy->ijxy", a, b).reshape(len(a) * len(b), -1)
