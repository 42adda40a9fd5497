"""Method (a) for framed sheets: the equations of equilibrium at Chebyshev points.

``P1_X + P2_Y + push N = 0`` in three components, at the points of a quarter, by differentiation matrices
folded to the parities of a state with both mirrors. Volumes and energies by Clenshaw and Curtis's rule.
"""

from __future__ import annotations

import numpy as np

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

Parities = tuple[tuple[int, int], ...]

PARITIES = ((-1, 1), (1, -1), (1, 1))
"""Of x, y and z in X and in Y: 1 even, -1 odd."""


def chebyshev(n: int) -> tuple[Array, Array, Array]:
    """Points on [-1, 1] in descending order, differentiation matrix, and Clenshaw and Curtis's weights."""
    angle = np.pi * np.arange(n + 1) / n
    x = np.cos(angle)
    c = np.where((np.arange(n + 1) % n) == 0, 2.0, 1.0) * (-1.0) ** np.arange(n + 1)
    gaps = x[:, None] - x + np.eye(n + 1)
    d = np.outer(c, 1 / c) / gaps
    d -= np.diag(d.sum(axis=1))
    moments = np.array([0.0 if k % 2 else 2 / (1 - k**2) for k in range(n + 1)])
    cosines = np.cos(np.outer(np.arange(n + 1), angle))
    ends = np.where((np.arange(n + 1) % n) == 0, 0.5, 1.0)
    weights = (2 / n) * ends * ((ends * moments) @ cosines)
    return x, d, weights


class CollocatedSheet:
    """The discrete sheet.

    Args:
        sheet: Law, frame and load.
        half: Intervals of the points from the centre to an edge.
    """

    def __init__(self, sheet: Framed, half: int) -> None:
        self.sheet = sheet
        x, d, weights = chebyshev(2 * half)
        x, m = x[: half + 1], half + 1
        mirrored = d[:m, half + 1 :][:, ::-1]
        self.fold = {}
        for parity in (1, -1):
            self.fold[parity] = d[:m, :m].copy()
            self.fold[parity][:, :half] += parity * mirrored
        w = 2 * weights[:m]
        w[half] /= 2
        self.weights = np.outer(w, w).ravel()
        self.place = np.array([p.ravel() for p in np.meshgrid(x, x, indexing="ij")])
        eye = np.eye(m)
        self.along = {
            (s, parity): np.kron(self.fold[parity], eye) if s == 0 else np.kron(eye, self.fold[parity])
            for s in range(2)
            for parity in (1, -1)
        }
        self.count = m * m
        self.free = self._free(PARITIES)
        middle = 2 * self.count + self.count - 1
        self.centre = np.where(self.free == middle, sheet.sign, 0.0)

    def _free(self, signs: Parities) -> Array:
        """Numbers of the unknowns that neither the edge nor a parity makes zero."""
        edge = (self.place > 1 - 1e-12).any(axis=0)
        free = []
        for i, parity in enumerate(signs):
            zero = edge.copy()
            for s in range(2):
                if parity[s] < 0:
                    zero |= np.abs(self.place[s]) < 1e-12
            free.append(np.flatnonzero(~zero) + i * self.count)
        return np.concatenate(free)

    def start(self, height: float, load: float) -> Found:
        """A guess: half a wave of cosine in either direction."""
        full = np.zeros(3 * self.count)
        full[2 * self.count :] = self.sheet.sign * height * np.cos(np.pi * self.place / 2).prod(axis=0)
        return Found(full[self.free], load, height, 0.0)

    def _whole(self, u: Array) -> Array:
        full = np.zeros(3 * self.count)
        full[self.free] = u
        return full.reshape(3, -1)

    def tangents(self, whole: Array) -> tuple[Array, Array]:
        """``x_X`` and ``x_Y`` at the points."""
        out = []
        for s in range(2):
            tangent = np.array([self.along[s, PARITIES[i][s]] @ whole[i] for i in range(3)])
            tangent[s] += self.sheet.delta
            out.append(tangent)
        return out[0], out[1]

    def equations(self, u: Array, load: float) -> tuple[Array, Array, Array]:
        """Residual, its derivatives in the displacements and in the load."""
        whole, q = self._whole(u), self.count
        x1, x2 = self.tangents(whole)
        stress, moduli = stresses(x1, x2, self.sheet.alpha)
        push, slope, rate = self.sheet.push(whole[2], load)
        n, turns = normal(x1, x2), normal_rates(x1, x2)
        residual = np.zeros((3, q))
        for i in range(3):
            # a derivative of component i has the opposite parity in its direction
            d = [self.along[r, -PARITIES[i][r]] for r in range(2)]
            residual[i] = d[0] @ stress[0, i] + d[1] @ stress[1, i] + push * n[i]
        matrix = self._tangent((moduli, push * turns, slope * n), PARITIES)[np.ix_(self.free, self.free)]
        return residual.ravel()[self.free], matrix, (rate * n).ravel()[self.free]

    def lowest(self, found: Found, name: str) -> float:
        """The lowest eigenvalue of the equations at the points in a class of C4v.

        They are linear in a displacement there; their matrix is not symmetric.
        """
        own = parities(name)
        whole = self._whole(found.u)
        x1, x2 = self.tangents(whole)
        _, moduli = stresses(x1, x2, self.sheet.alpha)
        push, slope, _ = self.sheet.push(whole[2], found.load)
        rates = moduli, push * normal_rates(x1, x2), slope * normal(x1, x2)
        free = self._free(own)
        k = -self._tangent(rates, own)[np.ix_(free, free)]
        component, point = np.divmod(free, self.count)
        row, column = np.divmod(point, round(self.count**0.5))
        places = list(zip(component.tolist(), row.tolist(), column.tolist(), strict=True))
        basis = kept(places, CLASSES[name][2])
        return float(np.linalg.eigvals(basis.T @ k @ basis).real.min())

    def _tangent(self, rates: tuple[Array, Array, Array], signs: Parities) -> Array:
        """The matrix of the rates of stress, and of those of the load by the tangents and by the height."""
        (moduli, turned, risen), q = rates, self.count
        k = np.zeros((3, q, 3, q))
        for i in range(3):
            d = [self.along[r, -signs[i][r]] for r in range(2)]
            for j in range(3):
                for s in range(2):
                    inner = d[0] * moduli[0, i, s, j] + d[1] * moduli[1, i, s, j]
                    inner[np.diag_indices(q)] += turned[i, s, j]
                    k[i, :, j] += inner @ self.along[s, signs[j][s]]
            k[i, :, 2][np.diag_indices(q)] += risen[i]
        return k.reshape(3 * q, 3 * q)

    def columns(self, found: Found) -> dict[str, float]:
        """Volume, strain energy, and the load."""
        whole = self._whole(found.u)
        x1, x2 = self.tangents(whole)
        c = np.array([np.sum(x1 * x1, 0), np.sum(x2 * x2, 0), np.sum(x1 * x2, 0)])
        amount = self.sheet.amount(whole[2], found.load) * normal(x1, x2)[2]
        return {
            "load": found.load,
            "w_c": found.height,
            "amount": float(self.weights @ amount),
            "U": float(self.weights @ energy(c, self.sheet.alpha)),
        }
