"""Linear algebra and Newton's iteration for the two-dimensional Galerkin method.

Each element's interior nodes are eliminated, which leaves one dense system for the element edges.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg

from reference_data.solvers.core.newton import newton as iterate
from reference_data.solvers.paper3.bent.equations import EVEN, Array, Assembly, Grid, Surface

CONVERGED = 2e-10  # size of the last step; what is left is at most a tenth of it


class Factor:
    """Factorised matrix, given element by element, with the rings held.

    Args:
        blocks: Matrices (elements, n, n) over the nodes of each element.
        functions: Unknowns per node.
        definite: Use Cholesky's method, which succeeds only for a positive definite matrix.

    Raises:
        numpy.linalg.LinAlgError: If ``definite`` and the matrix is not.
    """

    def __init__(self, blocks: Array, functions: int, definite: bool = False) -> None:
        self.n, self.functions = len(blocks), functions
        self.definite, size = definite, functions * (len(blocks) - 1)
        m = functions
        edge = np.zeros((size, size))
        self.inner, self.left, self.right = [], [], []
        for e, k in enumerate(blocks):
            inside, ends = slice(m, len(k) - m), self._ends(e, len(k))
            factor = self._factor(k[inside, inside])
            down = self._solve(factor, k[inside][:, ends])
            where = self._edges(e)
            edge[np.ix_(where, where)] += k[np.ix_(ends, ends)] - k[ends][:, inside] @ down
            self.inner.append(factor)
            self.left.append(k[ends][:, inside].copy())
            self.right.append(down)
        self.edge = self._factor(edge)

    def _factor(self, k: Array) -> tuple[Array, ...]:
        if self.definite:
            return scipy.linalg.cho_factor((k + k.T) / 2, check_finite=False)
        return scipy.linalg.lu_factor(k, check_finite=False)

    def _solve(self, factor: tuple[Array, ...], b: Array) -> Array:
        solve = scipy.linalg.cho_solve if self.definite else scipy.linalg.lu_solve
        return solve(factor, b, check_finite=False)

    def _ends(self, e: int, size: int) -> Array:
        """Local unknowns of an element's free edges."""
        m = self.functions
        first = np.arange(m) if e > 0 else np.arange(0)
        last = np.arange(size - m, size) if e < self.n - 1 else np.arange(0)
        return np.concatenate([first, last])

    def _edges(self, e: int) -> Array:
        """The same unknowns in the system of the edges."""
        m = self.functions
        return np.arange(max(e - 1, 0) * m, min(e + 1, self.n - 1) * m)

    def solve(self, b: Array) -> Array:
        """Solve for right-hand sides (nodes, functions) or (nodes, functions, k)."""
        m, shape = self.functions, b.shape
        b = b.reshape(shape[0], m, -1)
        degree, width = (shape[0] - 1) // self.n, b.shape[2]
        edge = b[degree:-1:degree].reshape(-1, width).copy()
        inside = []
        for e in range(self.n):
            right = b[e * degree + 1 : (e + 1) * degree].reshape(-1, width)
            inside.append(self._solve(self.inner[e], right))
            edge[self._edges(e)] -= self.left[e] @ inside[-1]
        edge = self._solve(self.edge, edge)
        out = np.zeros_like(b)
        out[degree:-1:degree] = edge.reshape(-1, m, width)
        for e in range(self.n):
            found = inside[e] - self.right[e] @ edge[self._edges(e)]
            out[e * degree + 1 : (e + 1) * degree] = found.reshape(-1, m, width)
        return out.reshape(shape)


def fitted(surface: Surface) -> tuple[Surface, float]:
    """The membrane on elements fitted to its free surface, and how far that moved."""
    if not surface.partial:
        return surface, 0.0
    grid, length = surface.grid, surface.tube.length
    front, _ = surface.front_at(grid.theta)
    x, a, _ = surface.evaluate(front[None, :] * (1 - 1e-15), grid.theta)
    move = (surface.zw - x[0, :, 2]) / a[0, :, 2]
    room = 0.5 * np.minimum(front, length - front)
    new = grid.project(front + np.clip(move, -room, room), EVEN)
    return surface.moved_to(grid, new), float(np.abs(new - surface.front).max())


@dataclass
class Kept:
    """A factorised matrix, kept as long as it makes the steps ten times smaller each."""

    factor: Factor | None = None
    last: float = np.inf

    def next(self, size: float) -> None:
        """Forget the matrix after a step of this size, if that did not shrink."""
        if size > 0.1 * self.last or size > 1e-2:
            self.factor = None
        self.last = size


def newton(guess: Surface, offset: float | None = None) -> Surface:
    """Equilibrium at the guess's level or, with the level free, at a given centroid offset.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    kept = Kept()

    def correct(surface: Surface) -> tuple[float, Callable[[float], Surface]]:
        surface, move = fitted(surface)
        now = Assembly(surface, tangent=kept.factor is None)
        kept.factor = kept.factor or Factor(now.stiffness, now.functions)
        if offset is None:
            dx, dzw = kept.factor.solve(-now.residual), 0.0
        else:
            load = surface.tube.gamma * now.volume
            both = kept.factor.solve(np.stack([-now.residual, load], axis=-1))
            inner = np.sum(now.offset[..., None] * both, axis=(0, 1))
            dzw = float((offset - np.sum(now.offset * surface.x) - inner[0]) / inner[1])
            dx = both[..., 0] + dzw * both[..., 1]
        size = max(float(np.abs(dx).max()), abs(dzw), move)
        kept.next(size)
        return size, lambda share: replace(surface, x=surface.x + share * dx, zw=surface.zw + share * dzw)

    what = f"bent tube by Galerkin's method at z_w = {guess.zw:g} for {guess.tube}"
    return fitted(iterate(guess, correct, what, longest=0.5, close=CONVERGED, more=0))[0]


def raised(surface: Surface, grid: Grid) -> Surface:
    """A converged membrane solved again, at its level, on a finer grid.

    Raises:
        RuntimeError: If Newton's iteration does not converge.
    """
    return newton(surface.moved_to(grid))
