"""Method (b) for framed sheets: Galerkin's method with Legendre polynomials over the whole square.

The displacements are sums of products of integrated Legendre polynomials, which vanish on the edges, with the
parities of a state with both mirrors. Gauss's rule on a quarter integrates. At the corners the deflection
contains ``r^2 ln r``; the error falls algebraically with the degree there.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss, legval
from scipy.linalg import block_diag, eigh

from reference_data.solvers.beyond.framed_sheet import (
    CLASSES,
    Array,
    Found,
    Framed,
    energy,
    kept,
    normal,
    normal_rates,
    parities,
    stresses,
)

EVEN, ODD = 1, 2
"""First index of integrated Legendre polynomials of either parity."""

Parities = tuple[tuple[int, int], ...]

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
        self.degree, self._x = degree, x
        self.values, self.slopes = self.basis(PARITIES)
        middle = []
        for first, second in PARITIES:
            (at, _), (by, _) = shapes(first, degree, np.zeros(1)), shapes(second, degree, np.zeros(1))
            middle.append(_products(at, by)[:, 0])
        counts = [len(v) for v in self.values]
        self.parts = np.split(np.arange(sum(counts)), np.cumsum(counts)[:-1])
        self.centre = np.zeros(sum(counts))
        self.centre[self.parts[2]] = sheet.sign * middle[2]

    def basis(self, firsts: Parities) -> tuple[list[Array], list[tuple[Array, Array]]]:
        """Of each component the shapes from its first indices in X and Y, and their derivatives."""
        values, slopes = [], []
        for first, second in firsts:
            (a, da), (b, db) = (shapes(at, self.degree, self._x) for at in (first, second))
            values.append(_products(a, b))
            slopes.append((_products(da, b), _products(a, db)))
        return values, slopes

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
        residual, by_load = np.zeros(size), np.zeros(size)
        for i, rows in enumerate(self.parts):
            of, ds = self.values[i], self.slopes[i]
            residual[rows] = ds[0] @ (w * stress[0, i]) + ds[1] @ (w * stress[1, i]) - of @ (w * push * n[i])
            by_load[rows] = -of @ (w * rate * n[i])
        k = self._tangent((moduli, push * turns, slope * n), self.values, self.slopes)
        return residual, k, by_load

    def lowest(self, found: Found, name: str) -> float:
        """The lowest eigenvalue of the second variation over ``int |v|^2 dA`` in a class of C4v."""
        firsts = tuple(tuple(EVEN if p > 0 else ODD for p in pair) for pair in parities(name))
        x1, x2 = self.tangents(found.u)
        _, moduli = stresses(x1, x2, self.sheet.alpha)
        push, slope, _ = self.sheet.push(self.height(found.u), found.load)
        values, slopes = self.basis(firsts)
        load = push * normal_rates(x1, x2), slope * normal(x1, x2)
        mass = block_diag(*((of * self.weights) @ of.T for of in values))
        k = self._tangent((moduli, *load), values, slopes)
        places = [
            (i, a, b)
            for i, (first, second) in enumerate(firsts)
            for a in range(first, self.degree, 2)
            for b in range(second, self.degree, 2)
        ]
        basis = kept(places, CLASSES[name][2])
        return float(eigh(basis.T @ k @ basis, basis.T @ mass @ basis, eigvals_only=True)[0])

    def _tangent(
        self, rates: tuple[Array, Array, Array], values: list[Array], slopes: list[tuple[Array, Array]]
    ) -> Array:
        """The matrix of the rates of stress, and of those of the load by the tangents and by the height."""
        (moduli, turned, risen), w = rates, self.weights
        parts = np.split(np.arange(sum(map(len, values))), np.cumsum([len(v) for v in values])[:-1])
        k = np.zeros((sum(map(len, values)),) * 2)
        for i, rows in enumerate(parts):
            of, ds = values[i], slopes[i]
            for j, columns in enumerate(parts):
                block = np.zeros((len(rows), len(columns)))
                for s in range(2):
                    right = (w * moduli[0, i, s, j]) * ds[0] + (w * moduli[1, i, s, j]) * ds[1]
                    right -= (w * turned[i, s, j]) * of
                    block += right @ slopes[j][s].T
                if j == 2:
                    block -= ((w * risen[i]) * of) @ values[2].T
                k[np.ix_(rows, columns)] = block
        return k

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
