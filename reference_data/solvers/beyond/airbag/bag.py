r"""Least energy of a quarter of one sheet of a square airbag, on square elements of Lagrange polynomials.

The sheet ``[-1, 1]^2`` is joined at its edges with another one. By symmetry a quarter ``[0, 1]^2`` has
``x = 0`` on ``X = 0``, ``y = 0`` on ``Y = 0``, and a seam on ``X = 1`` and ``Y = 1`` that is free in its
plane, ``z = 0``. The potential ``U - p V`` with :math:`V = \int z (x_X y_Y - x_Y y_X)` is minimised.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.sparse import bmat, csc_matrix, csr_matrix, diags, kron
from scipy.sparse.linalg import splu

from reference_data.solvers.beyond.airbag.sheet import SLACK, WRINKLED, Array, relaxed, stresses

FIRST, LEAST = 1e-3, 1e-9
"""Weight of the mass matrix in the first step, and one that is left out instead."""

CLOSE = 1e-11
"""Largest nodal force, over the pressure, of a solution."""

MOST = 800
"""Largest number of steps."""


@dataclass(frozen=True)
class Bag:
    """The quarter on ``count`` by ``count`` squares.

    Attributes:
        count: Squares along half a side.
        degree: Degree of the polynomials; one more Gauss point in each direction.
        nu: Poisson's ratio.
    """

    count: int
    degree: int
    nu: float

    @property
    def _line(self) -> Array:
        return np.linspace(0, 1, self.degree * self.count + 1)

    @cached_property
    def nodes(self) -> Array:
        """``X`` and ``Y`` of the nodes, ``(2, n)``."""
        return np.array([c.ravel() for c in np.meshgrid(self._line, self._line, indexing="ij")])

    @cached_property
    def _along(self) -> tuple[csr_matrix, csr_matrix, Array]:
        """Values and slopes at the Gauss points of a line, and their weights."""
        points, weights = leggauss(self.degree + 1)
        places, size = np.linspace(0, 1, self.degree + 1), 1 / self.count
        shapes = [np.poly1d(np.poly(np.delete(places, k))) for k in range(self.degree + 1)]
        shapes = [s / s(x) for s, x in zip(shapes, places, strict=True)]
        at = (points + 1) / 2
        rows, columns = (
            np.concatenate([i.ravel() + step * k for k in range(self.count)])
            for i, step in zip(np.indices((len(at), len(shapes))), (len(at), self.degree), strict=True)
        )
        out = [
            csr_matrix((np.tile(values.ravel(), self.count), (rows, columns)))
            for values in (
                np.array([s(at) for s in shapes]).T,
                np.array([s.deriv()(at) / size for s in shapes]).T,
            )
        ]
        return *out, np.tile(weights / 2 * size, self.count)

    @cached_property
    def _tables(self) -> tuple[csr_matrix, csr_matrix, csr_matrix, Array]:
        """Values and both derivatives at the Gauss points, and their weights."""
        value, slope, weight = self._along
        both = ((value, value), (slope, value), (value, slope))
        return *(kron(a, b, format="csr") for a, b in both), np.outer(weight, weight).ravel()

    @cached_property
    def free(self) -> Array:
        """Numbers of the unknowns that are not prescribed; positions are ``x``, then ``y``, then ``z``."""
        x, y = self.nodes
        return np.flatnonzero(~np.concatenate([x == 0, y == 0, (x == 1) | (y == 1)]))

    @cached_property
    def _mass(self) -> csc_matrix:
        value, _, _, weight = self._tables
        return diags(np.tile(value.power(2).T @ weight, 3)[self.free]).tocsc()

    def dome(self) -> Array:
        """A first guess."""
        x, y = self.nodes
        shorter = [a * (1 - 0.15 * (1 - b**2)) for a, b in ((x, y), (y, x))]
        return np.concatenate([*shorter, 0.5 * (1 - x**2) * (1 - y**2)])

    def equations(self, u: Array, p: float) -> tuple[float, Array, csc_matrix, dict[str, float]]:
        """Potential, its derivatives in the free unknowns, and columns of the table."""
        value, along, across, w = self._tables
        x = u.reshape(3, -1)
        x1, x2, z = (along @ x.T).T, (across @ x.T).T, value @ x[2]
        point = relaxed(np.array([(x1 * x1).sum(0), (x2 * x2).sum(0), (x1 * x2).sum(0)]), self.nu)
        stress, moduli = stresses(x1, x2, point)
        plan = x1[0] * x2[1] - x1[1] * x2[0]
        rates = np.zeros((2, 3, len(w)))  # of the area in the plan, in the tangents
        rates[0, 0], rates[0, 1], rates[1, 0], rates[1, 1] = x2[1], -x2[0], -x1[1], x1[0]
        stress -= p * z * rates
        for sign, (r, i, s, j) in ((1, (0, 0, 1, 1)), (-1, (0, 1, 1, 0))):
            moduli[r, i, s, j] -= sign * p * z
            moduli[s, j, r, i] -= sign * p * z
        forces = np.array([along.T @ (w * stress[0, i]) + across.T @ (w * stress[1, i]) for i in range(3)])
        forces[2] -= p * (value.T @ (w * plan))
        pair = along, across
        block = [
            [
                sum(pair[r].T @ diags(w * moduli[r, i, s, j]) @ pair[s] for r in range(2) for s in range(2))
                for j in range(3)
            ]
            for i in range(3)
        ]
        for i in range(2):
            coupled = -p * sum(pair[r].T @ diags(w * rates[r, i]) @ value for r in range(2))
            block[i][2], block[2][i] = block[i][2] + coupled, block[2][i] + coupled.T
        matrix = bmat(block).tocsr()[self.free][:, self.free].tocsc()
        volume = float(w @ (z * plan))
        stored = float(w @ point.energy)
        about = {"V": volume, "U": stored, "Pi": stored - p * volume}
        about |= {n: float(w @ (point.state == s)) for n, s in (("f_w", WRINKLED), ("f_s", SLACK))}
        return about["Pi"], forces.ravel()[self.free], matrix, about

    def least(self, p: float) -> dict[str, float]:
        """Columns of the table at a minimum, by Newton steps with a multiple of the mass matrix.

        Raises:
            RuntimeError: If none is found.
        """
        u, weight = self.dome(), FIRST
        energy, forces, matrix, about = self.equations(u, p)
        for _ in range(MOST):
            factor = splu(
                matrix + weight * self._mass,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
            if _is_positive(factor):
                if not weight and np.abs(forces).max() < CLOSE * p:
                    return self._read(u) | about
                new = u.copy()
                new[self.free] -= factor.solve(forces)
                trial = self.equations(new, p)
                if np.isfinite(trial[0]) and trial[0] <= energy + 1e-14 * abs(energy):
                    u, (energy, forces, matrix, about) = new, trial
                    weight = weight / 4 if weight > LEAST else 0.0
                    continue
            weight = max(4 * weight, 4 * LEAST)
        raise RuntimeError(f"no minimum at p = {p:g} on {self.count} squares of degree {self.degree}")

    def _read(self, u: Array) -> dict[str, float]:
        """Height of the centre, and displacement of the corner towards it."""
        x = u.reshape(3, -1)
        return {"w_c": float(x[2, 0]), "u_far": float(2**0.5 - np.hypot(x[0, -1], x[1, -1]))}


def _is_positive(factor: object) -> bool:
    """Whether a symmetric matrix is positive definite, by pivots along its diagonal."""
    return bool((factor.perm_r == factor.perm_c).all() and (factor.U.diagonal() > 0).all())
