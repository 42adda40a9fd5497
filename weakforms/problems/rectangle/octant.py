r"""Classes of displacements by the mirrors in the diagonals of a square, on an octant of it.

With both mirrors, the exchange :math:`(x, y, z)(X, Y) \to (y, x, z)(Y, X)` and a sign ``s`` of it, the group
C4v of the square has four simple classes

========  ===================  ====
class     ``z`` in X and in Y  s
========  ===================  ====
A1        even                 1
B1        even                 -1
B2        odd                  1
A2        odd                  -1
========  ===================  ====

and the pair E, one even and one odd. On the diagonal :math:`u_x = s\,u_y`, and ``z = 0`` for ``s = -1``. The
unknown is ``q`` with :math:`u = (q_0 + s\,q_1, q_1, q_2)`, for odd ``z`` with ``u_x`` and ``u_y`` exchanged:
conditions on the diagonal are then ones of ``q_0`` and ``q_2``, those on the mirror ``Y = 0`` of ``q_1`` and
``q_2``. The inertia is that of the displacements.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from ufl.core.expr import Expr

DIAGONAL = {"A1": ("even", 1.0), "A2": ("odd", -1.0), "B1": ("even", -1.0), "B2": ("odd", 1.0)}
"""Parity of ``z`` in ``X`` and ``Y``, and sign of the exchange, of each class."""

COPIES = 8
"""Number of octants of the square."""

CLOSE = 1e-9
"""Largest distance of a node from a line that it is on."""


class Octant:
    """One class of displacements on the part ``0 <= Y <= X`` of the mesh of a quarter.

    Args:
        mesh: The quarter, cut along its diagonal.
        space: The displacements on the quarter; those beyond the diagonal are zero.
        parity: Of ``z`` in ``X`` and in ``Y``, ``even`` or ``odd``.
        sign: Of the exchange.
    """

    def __init__(self, mesh: dmesh.Mesh, space: fem.FunctionSpace, parity: str, sign: float) -> None:
        self._mesh, self._space = mesh, space
        self._odd, self._anti = parity == "odd", sign < 0
        # Numbers of the form, not of its code, which all classes share.
        rows = np.array([[1.0, sign], [0.0, 1.0]])
        self._matrix = fem.Constant(mesh, rows[::-1].copy() if self._odd else rows)
        x, y, *_ = ufl.SpatialCoordinate(mesh)
        self.copies = ufl.conditional(ufl.lt(y, x), float(COPIES), 0.0)

    def displacement(self, q: Expr) -> Expr:
        """``u`` of the unknown ``q``."""
        across = self._matrix * ufl.as_vector([q[0], q[1]])
        return ufl.as_vector([across[0], across[1], q[2]])

    def conditions(self) -> list[fem.DirichletBC]:
        """No displacement of the edge nor beyond the diagonal; on both mirrors that of the class."""
        beyond = fem.locate_dofs_geometrical(self._space, lambda x: x[1] > x[0] + CLOSE)
        out = [fem.dirichletbc(np.zeros(3), beyond, self._space)]
        out += [self._zero(i, lambda x: np.abs(x[0] - 1) < CLOSE) for i in range(3)]
        out += [self._zero(i, lambda x: np.abs(x[0] - x[1]) < CLOSE) for i in (0, 2)[: 1 + self._anti]]
        return out + [self._zero(i, lambda x: np.abs(x[1]) < CLOSE) for i in (1, 2)[: 1 + self._odd]]

    def _zero(self, component: int, line: Callable[[np.ndarray], np.ndarray]) -> fem.DirichletBC:
        part = self._space.sub(component)
        edges = dmesh.locate_entities(self._mesh, 1, line)
        return fem.dirichletbc(np.array(0.0), fem.locate_dofs_topological(part, 1, edges), part)
