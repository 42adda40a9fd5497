"""The largest deflection of a membrane, also between nodes."""

from __future__ import annotations

import numpy as np
from dolfinx import fem
from mpi4py import MPI

from weakforms.problems.membrane.model import MembraneModel
from weakforms.problems.membrane.reference import NODES, quadratics
from weakforms.solvers.support import compat

SEARCHED = 6
"""Triangles that are searched on each rank: the largest value lies in one with large values at its nodes."""


class Highest:
    """Largest deflection, by the polynomials on the triangles."""

    def __init__(self, model: MembraneModel) -> None:
        self._comm = model.mesh.comm
        space = fem.functionspace(model.mesh, ("Lagrange", model.body.degree))
        self._function = fem.Function(space)
        self._expression = fem.Expression(model.deflection, compat.interpolation_points(space.element))
        self._cells = space.dofmap.list[: model.mesh.topology.index_map(2).size_local]

    def __call__(self) -> float:
        """Its value at the state that the system is lent to."""
        self._function.interpolate(self._expression)
        values = self._function.x.array[self._cells]
        largest = float(values.max(initial=-np.inf))
        if values.shape[1] == 6:
            top = values[np.argsort(values.max(axis=1))[-SEARCHED:]]
            largest = max([largest, *map(_peak, top)])
        return self._comm.allreduce(largest, op=MPI.MAX)


def _peak(values: np.ndarray) -> float:
    """Value of a quadratic polynomial where it is stationary; minus infinity outside of its triangle."""
    x, y = NODES.T
    monomials = np.column_stack([x**0, x, y, x**2, y**2, x * y])
    _, b1, b2, a11, a22, a12 = np.linalg.solve(monomials, values)
    hessian = np.array([[2 * a11, a12], [a12, 2 * a22]])
    if np.linalg.det(hessian) <= 0:
        return -np.inf
    top = -np.linalg.solve(hessian, [b1, b2])
    inside = min(*top, 1 - top.sum()) >= 0
    return (quadratics(top[None]) @ values).item() if inside else -np.inf
