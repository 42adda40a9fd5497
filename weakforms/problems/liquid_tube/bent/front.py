r"""Paper 3: a mesh of the whole surface that follows the free surface of the liquid.

The pressure has a kink where the membrane leaves the liquid, along a curve :math:`Z = Z_f(\Theta)`. Elements
with the kink inside lose their order. The mesh over ``(X, Theta)`` is therefore fixed, and the material point
is a function on it,

.. math:: Z = Z_0 + (X - Z_0)\,\frac{Z_f(\Theta) - Z_0}{X_f - Z_0}, \qquad Z_0 \le X \le X_f \\
          Z = Z_1 - (Z_1 - X)\,\frac{Z_1 - Z_f(\Theta)}{Z_1 - X_f}, \qquad X_f \le X \le Z_1

and ``Z = X`` elsewhere. The row of edges ``X = X_f`` lies on the free surface; rows at and beyond ``Z_0`` and
``Z_1`` do not move. ``Z_f`` is a cosine polynomial, whose coefficients belong to the state. A row that is off
by ``d`` changes forces only by ``O(d^2)``. It is therefore moved between solves and is not an unknown of
them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy

import basix.ufl
import numpy as np
from dolfinx import cpp, fem
from dolfinx.mesh import Mesh
from numpy.polynomial import chebyshev
from petsc4py import PETSc
from scipy.fft import dct

from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

NAME = "front_"
"""Beginning of the coefficients' names in a state's loads."""


THIN = 1e-4
"""Smallest distance of the front from the fixed rows, relative to the distance between these."""


def front_of(loads: Mapping[str, float]) -> np.ndarray:
    """The coefficients of the front among the loads of a state; empty if there are none."""
    return np.array([value for name, value in loads.items() if name.startswith(NAME)])


class FrontMap:
    """``Z(X, Theta)`` on a mesh of half the circumference.

    Args:
        mesh: Sheet over ``(X, Theta)``.
        rows: ``Z_0``, ``X_f`` and ``Z_1``, rows of edges; the outer ones are fixed.
        degree: Degree of the function.
        count: Number of intervals of ``[0, pi]``, at whose ends the front is fitted.

    Attributes:
        function: The function ``Z``.
        moves: Number of changes.
    """

    def __init__(self, mesh: Mesh, rows: tuple[float, float, float], degree: int, count: int) -> None:
        low, self.row, high = rows
        self.between = low, high
        self.angles = np.pi * np.arange(count + 1) / count
        element = basix.ufl.element("Lagrange", "quadrilateral", degree)
        self.function = fem.Function(fem.functionspace(mesh, element), name="material")
        self.moves = 0
        self.coefficients = np.zeros(count + 1)
        self.reset()

    def reset(self) -> None:
        """Set ``Z = X``: no free surface meets the membrane."""
        nowhere = np.zeros(len(self.angles))
        nowhere[0] = self.row
        self.put(nowhere)

    def put(self, coefficients: np.ndarray) -> None:
        """Move the row to a front; coefficients beyond its own number are dropped, missing ones are zero."""
        given = self._own(coefficients)
        if self.moves and np.array_equal(given, self.coefficients):
            return
        self.coefficients = given
        self.function.interpolate(lambda x: self.material(x[0], x[1]))
        self.function.x.scatter_forward()
        self.moves += 1

    def at(self, theta: np.ndarray) -> np.ndarray:
        """``Z_f`` at given angles."""
        return chebyshev.chebval(np.cos(theta), self.coefficients)

    def material(self, x: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """``Z`` of points of the mesh."""
        front = self.at(theta)
        return self._moved(x, np.full_like(front, self.row), front)

    def mesh(self, z: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """``X`` of material points: the inverse of :meth:`material`."""
        front = self.at(theta)
        return self._moved(z, front, np.full_like(front, self.row))

    def frozen(self) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
        """:meth:`mesh` with the current front."""
        return copy(self).mesh

    def _moved(self, x: np.ndarray, old: np.ndarray, new: np.ndarray) -> np.ndarray:
        low, high = self.between
        below = low + (x - low) * (new - low) / (old - low)
        above = high - (high - x) * (high - new) / (high - old)
        return np.where((x <= low) | (x >= high), x, np.where(x <= old, below, above))

    def fitted(self, places: np.ndarray) -> np.ndarray:
        """Coefficients of the cosine polynomial through ``Z_f`` at :attr:`angles`, between the fixed rows."""
        low, high = self.between
        room = THIN * (high - low)
        clipped = np.clip(places, low + room, high - room)
        out = dct(clipped, type=1) / (len(clipped) - 1)
        out[[0, -1]] /= 2
        return out

    def loads(self, coefficients: np.ndarray | None = None) -> dict[str, float]:
        """Coefficients of a front by name, by default those of the current one."""
        of = self.coefficients if coefficients is None else self._own(coefficients)
        return {f"{NAME}{i}": float(c) for i, c in enumerate(of)}

    def _own(self, coefficients: np.ndarray) -> np.ndarray:
        """As many coefficients as this front has: more are dropped, missing ones are zero."""
        given = np.zeros(len(self.angles))
        count = min(len(given), len(coefficients))
        given[:count] = coefficients[:count]
        return given


class HalfSystem(System):
    """Equations on half the circumference, on a mesh that may follow a front, with columns at points.

    If it follows a front, the loads of a state include the coefficients of the front.

    Args:
        formulation: The weak form.
        front: The front that the mesh follows, or ``None``.
        read: Additional columns of the lent state, which cannot be prescribed.
        beside: A system with the same unknown and loads; what is lent to one is lent to both.
    """

    def __init__(
        self,
        formulation: Formulation,
        front: FrontMap | None,
        read: Callable[[], dict[str, float]],
        beside: System | None = None,
    ) -> None:
        self.front, self._read, self._beside = front, read, beside
        self._weighed = -1
        super().__init__(formulation)

    def _pattern(self) -> cpp.la.SparsityPattern:
        """That of the system with the same unknown, if there is one: it takes long to find."""
        return self._beside.stiffness.pattern if self._beside else super()._pattern()

    @property
    def is_lent(self) -> bool:
        """Whether the forms, or those of the system with the same unknown, belong to a state."""
        return super().is_lent or (self._beside is not None and self._beside.is_lent)

    @property
    def mass(self) -> PETSc.Mat:
        """Mass matrix over the material surface, which changes with the mesh."""
        moves = 0 if self.front is None else self.front.moves
        if self._weighed != moves:
            self._weighed = moves
            self._update_mass()
        return super().mass

    def _write_loads(self, loads: Mapping[str, float]) -> None:
        """Write scalars into the forms, and move the row to their front."""
        super()._write_loads({name: value for name, value in loads.items() if not name.startswith(NAME)})
        if self.front is not None and (coefficients := front_of(loads)).size:
            self.front.put(coefficients)

    def _held(self) -> State:
        held = super()._held()
        if self.front is not None:
            held.loads |= self.front.loads()
        return held

    def _require_whole(self, state: State) -> None:
        super()._require_whole(state)
        if self.front is not None and not front_of(state.loads).size:
            raise ValueError("a state without its front")

    def monitors(self) -> dict[str, float]:
        """All scalar functionals of the lent state, and the additional columns."""
        found = super().monitors()
        return found | self._read() if found else found
