"""Values of expressions at points of the body, the same on every rank."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import ufl
from dolfinx import fem, geometry
from dolfinx.mesh import Mesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.solvers.support import compat
from weakforms.solvers.support.roots import polynomial_through, root


class Interpolant:
    """Expressions of an unknown as polynomials on each cell, discontinuous between cells.

    Args:
        unknown: The function on which the expressions depend; each call uses its current values.
        expressions: Name and expression of each column.
        raise_degree: Difference between the degrees of the polynomials and of the unknown.
    """

    def __init__(self, unknown: fem.Function, expressions: Mapping[str, Expr], raise_degree: int = 1) -> None:
        space = unknown.function_space
        degree = space.ufl_element().degree + raise_degree
        target = compat.scalar_space(space, "Lagrange", degree, len(expressions))
        self.function = fem.Function(target)
        nodes = compat.interpolation_points(target.element)
        self._expression = fem.Expression(ufl.as_vector(list(expressions.values())), nodes)
        self._columns = len(expressions)
        self._owned = target.dofmap.index_map.size_local

    def update(self) -> None:
        """Interpolate the current expressions."""
        self.function.interpolate(self._expression)

    def values(self) -> np.ndarray:
        """Values at the nodes of this rank's cells, shape ``(nodes, expressions)``."""
        self.update()
        return self.function.x.array.reshape(-1, self._columns)[: self._owned]


class FirstLevels:
    """The first positions along a one-dimensional body where expressions reach a level in magnitude.

    Args:
        unknown: The function the expressions depend on.
        coordinate: Material coordinate.
        levels: Expression and level of each name.
    """

    def __init__(
        self, unknown: fem.Function, coordinate: Expr, levels: Mapping[str, tuple[Expr, float]]
    ) -> None:
        self._levels = {name: level for name, (_, level) in levels.items()}
        columns = {"": coordinate, **{name: expression for name, (expression, _) in levels.items()}}
        self._interpolant = Interpolant(unknown, columns)
        space = unknown.function_space
        self._comm = space.mesh.comm
        cells = space.mesh.topology.index_map(1).size_local
        self._dofs = self._interpolant.function.function_space.dofmap.list[:cells]
        self._order: np.ndarray | None = None

    def __call__(self) -> dict[str, float]:
        """The smallest such coordinate, or the end of the body if a level is never reached."""
        values = self._interpolant.values()
        if self._order is None:  # fronts move the nodes, and keep them in order
            places = np.argsort(values[self._dofs, 0], axis=1)
            self._order = np.take_along_axis(self._dofs, places, axis=1)
        nodes = values[self._order]
        local = [_first(nodes[:, :, 0], nodes[:, :, i], v) for i, v in enumerate(self._levels.values(), 1)]
        end = nodes[:, :, 0].max(initial=-np.inf)
        gathered = np.array(self._comm.allgather([*local, end]))
        found = np.minimum(gathered[:, :-1].min(axis=0), gathered[:, -1].max())
        return dict(zip(self._levels, found.tolist(), strict=True))


def _first(x: np.ndarray, values: np.ndarray, level: float) -> float:
    """Smallest ``x`` with ``|value| = level`` by the polynomials on the cells; infinite if there is none.

    Args:
        x: Nodes, ascending in each row (a cell).
        values: Values there.
        level: Positive.
    """
    beyond = np.abs(values) >= level
    if not beyond.any():
        return np.inf
    cell = min(np.flatnonzero(beyond.any(axis=1)), key=lambda c: x[c, beyond[c].argmax()])
    node = int(beyond[cell].argmax())
    if node == 0:
        return float(x[cell, 0])
    polynomial, sign = polynomial_through(x[cell], values[cell]), np.sign(values[cell, node])
    ends = x[cell, node - 1], x[cell, node]
    return root(lambda at: sign * polynomial(at) - level, *ends, f"|value| = {level:g}", xtol=1e-15)


class Sampler:
    """Evaluates expressions of an unknown at points of a mesh.

    On each element the expressions are interpolated by polynomials of one degree more than the unknown, and
    then evaluated. The interpolation error is smaller than the discretisation error of a derivative. A point
    between two cells gets the mean of both sides, so that the order of the ranks does not matter.

    Args:
        unknown: The function on which the expressions depend; each call uses its current values.
        expressions: Name and expression of each column.
        points: Coordinates, shape ``(n,)`` or, on a mesh of ``d`` coordinates, ``(n, d)``.
    """

    def __init__(self, unknown: fem.Function, expressions: Mapping[str, Expr], points: np.ndarray) -> None:
        self.names = tuple(expressions)
        self._interpolant = Interpolant(unknown, expressions)
        space = unknown.function_space
        self._comm = space.mesh.comm
        given = np.asarray(points, dtype=float).reshape(len(points), -1)
        self._points = np.zeros((len(points), 3))
        self._points[:, : given.shape[1]] = given
        self._index, self._cells = self._locate(space.mesh)
        count = np.bincount(self._index, minlength=len(points))
        self._count = self._comm.allreduce(count, op=MPI.SUM)
        if np.any(self._count == 0):
            raise ValueError(f"sample point {points[np.argmin(self._count)]} lies outside the mesh")

    def _locate(self, mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
        """All pairs of a point and a cell of this rank that contains it."""
        tree = geometry.bb_tree(mesh, mesh.topology.dim, padding=1e-10)
        candidates = geometry.compute_collisions_points(tree, self._points)
        cells = geometry.compute_colliding_cells(mesh, candidates, self._points)
        owned = mesh.topology.index_map(mesh.topology.dim).size_local
        pairs = [(i, c) for i in range(len(self._points)) for c in cells.links(i) if c < owned]
        index, cell = np.array(pairs, dtype=np.int32).reshape(-1, 2).T
        return index, cell

    def __call__(self) -> dict[str, np.ndarray]:
        """Evaluate: one array for each column."""
        self._interpolant.update()
        values = np.zeros((len(self._points), len(self.names)))
        if len(self._index):
            found = self._interpolant.function.eval(self._points[self._index], self._cells)
            np.add.at(values, self._index, found.reshape(len(self._index), -1))
        values = self._comm.allreduce(values, op=MPI.SUM) / self._count[:, None]
        return dict(zip(self.names, values.T, strict=True))


class Probe:
    """Expressions of an unknown at one point of a one-dimensional mesh, which each call locates again.

    Args:
        unknown: The function on which the expressions depend; each call uses its current values.
        expressions: Name and expression of each column.
    """

    def __init__(self, unknown: fem.Function, expressions: Mapping[str, Expr]) -> None:
        self.names = tuple(expressions)
        self._interpolant = Interpolant(unknown, expressions)
        self._mesh = unknown.function_space.mesh
        self._tree = geometry.bb_tree(self._mesh, self._mesh.topology.dim, padding=1e-10)
        self._owned = self._mesh.topology.index_map(self._mesh.topology.dim).size_local

    def __call__(self, x: float) -> dict[str, float]:
        """Evaluate: one number for each column; between two cells the mean of both."""
        point = np.array([[x, 0.0, 0.0]])
        candidates = geometry.compute_collisions_points(self._tree, point)
        found = geometry.compute_colliding_cells(self._mesh, candidates, point).links(0)
        cells = found[found < self._owned].astype(np.int32)
        self._interpolant.update()
        total = np.zeros(len(self.names) + 1)
        if len(cells):
            values = self._interpolant.function.eval(np.repeat(point, len(cells), axis=0), cells)
            total[:-1] = values.reshape(len(cells), -1).sum(axis=0)
            total[-1] = len(cells)
        total = self._mesh.comm.allreduce(total, op=MPI.SUM)
        return dict(zip(self.names, (total[:-1] / total[-1]).tolist(), strict=True))


SEARCHED = 3
"""Cells that are searched for the largest value: it lies in one with the largest nodal values."""

SAMPLES, BELOW = 17, 0.1
"""Number of samples in such a cell, and how far below the largest sample, as a part of the range of all,
another peak of the samples may lie to be looked at too."""

STEPS, AT_REST = 20, 1e-9
"""Largest number of Newton steps from a sample to the stationary point beside it, and the last step: a value
there has the square of its error."""


class Peak:
    """Largest value of one component of a function on a one-dimensional mesh, by its polynomials."""

    def __init__(self, function: fem.Function, component: int) -> None:
        space = function.function_space
        self._function, self._block, self._component = function, space.dofmap.index_map_bs, component
        self._comm = space.mesh.comm
        self._cells = space.dofmap.list[: space.mesh.topology.index_map(1).size_local]
        nodes = space.tabulate_dof_coordinates()[:, 0][self._cells]
        middle, half = nodes.mean(axis=1, keepdims=True), np.ptp(nodes, axis=1, keepdims=True) / 2
        powers = np.arange(nodes.shape[1])
        self._to_coefficients = np.linalg.inv(((nodes - middle) / half)[:, :, None] ** powers)
        self._samples = np.linspace(-1.0, 1.0, SAMPLES) ** powers[:, None]

    def __call__(self) -> float:
        """The largest value, from the cells with the largest nodal values; infinite if one is no number."""
        values = self._function.x.array[self._block * self._cells + self._component]
        found = -np.inf
        if not np.isfinite(values).all():
            found = np.inf
        elif len(values):
            highest = values.max(axis=1)
            searched = np.argsort(highest)[-SEARCHED:]
            polynomials = (self._to_coefficients[searched] @ values[searched, :, None])[:, :, 0]
            inside = _largest(polynomials, polynomials @ self._samples)
            found = max(float(highest[searched[-1]]), inside)
        return found if self._comm.size == 1 else self._comm.allreduce(found, op=MPI.MAX)


def _largest(polynomials: np.ndarray, samples: np.ndarray) -> float:
    """Largest value on ``[-1, 1]`` of polynomials, one row of coefficients each, from their samples there."""
    best, least = samples.max(), samples.min()
    beside = np.full((len(samples), 1), -np.inf)
    left, right = np.hstack([beside, samples[:, :-1]]), np.hstack([samples[:, 1:], beside])
    peaks = (samples >= left) & (samples >= right) & (samples >= best - BELOW * (best - least))
    rows = [row.tolist() for row in polynomials]
    width = 2.0 / (SAMPLES - 1)
    return max(
        float(best), *(_stationary(rows[row], width * i - 1.0, width) for row, i in np.argwhere(peaks))
    )


def _stationary(coefficients: list[float], at: float, width: float) -> float:
    """Value of a polynomial at its maximum on ``[-1, 1]`` next to a sample, at most one width away."""
    slope = [k * c for k, c in enumerate(coefficients)][1:]
    bend = [k * c for k, c in enumerate(slope)][1:]
    low, high, t = max(at - width, -1.0), min(at + width, 1.0), at
    for _ in range(STEPS):
        curvature = _horner(bend, t)
        if not curvature < 0:  # no maximum here
            break
        before, t = t, min(max(t - _horner(slope, t) / curvature, low), high)
        if abs(t - before) < AT_REST:
            break
    return _horner(coefficients, t)


def _horner(coefficients: list[float], t: float) -> float:
    """Value of a polynomial; without numpy, whose calls would cost more than the sum."""
    total = 0.0
    for coefficient in reversed(coefficients):
        total = total * t + coefficient
    return total


def lowest_on_grid(values: np.ndarray) -> tuple[float, float]:
    """Smallest value on a rectangular grid, by parabolas, and its difference from half the points."""
    fine, coarse = (_by_parabolas(grid) for grid in (values, values[::2, ::2]))
    return fine, abs(fine - coarse)


def _by_parabolas(values: np.ndarray) -> float:
    i, j = np.unravel_index(int(np.argmin(values)), values.shape)
    reach = 0.0
    for row, k in ((values[:, j], i), (values[i], j)):
        if 0 < k < len(row) - 1:
            left, here, right = row[k - 1 : k + 2]
            reach += (right - left) ** 2 / (8 * (left - 2 * here + right))
    return float(values[i, j] - reach)
