"""Paper 3: the material surface of the tube on a mesh, on half the circumference or on the whole of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.fluid import Surface
from weakforms.problems.liquid_tube.bent.front import FrontMap
from weakforms.problems.liquid_tube.bent.mesh import fitted_heights, flat_sheet, heights, polygon, prism
from weakforms.problems.material_choice import Chosen

Shape = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""A position, or displacement, of shape ``(3, n)`` at material points ``Z``, ``Theta``."""


@dataclass(frozen=True)
class SurfaceData:
    """The tube, its liquid and its mesh.

    ``cells`` along the tube (a multiple of four), ``around`` over half the circumference. ``uneven`` is the
    relative amplitude by which the widths of the cells vary around, on the whole circumference only.
    """

    L: float
    delta: float
    gamma: float
    alpha: float
    cells: int
    around: int
    degree: int
    full: bool = False
    uneven: float = 0.0
    front: float | None = None
    """On half the circumference: approximate position of the free surface, which the mesh follows."""
    material: Chosen | None = None
    """A law that replaces the Mooney-Rivlin law with ``alpha``."""
    relaxed: bool = False
    """Whether the membrane wrinkles in place of bearing compression."""

    @property
    def length(self) -> float:
        """Length of the stress-free tube."""
        return self.L / self.delta


class MaterialSurface:
    """Mesh, fields on it, and the material coordinates ``(Z, Theta)`` of its points.

    Attributes:
        mesh: A sheet over ``(Z, Theta)``, or a prism on the whole circumference.
        nodes: Rows of nodes along the tube.
        space: Positions and displacements.
        front: The map of a mesh that follows the free surface; else ``None``.
    """

    def __init__(self, comm: MPI.Intracomm, data: SurfaceData) -> None:
        self.data = data
        if data.front is None:
            nodes = heights(data.cells, data.length)
        else:
            nodes, rows = fitted_heights(data.cells, data.length, data.front)
        if data.full:
            self._angles = _edges(2 * data.around, data.uneven)
            self.mesh = prism(comm, nodes, self._angles)
        else:
            self.mesh = flat_sheet(comm, nodes, data.around)
        element = basix.ufl.element("Lagrange", "quadrilateral", data.degree, shape=(3,))
        self.space = fem.functionspace(self.mesh, element)
        self.front = None
        if data.front is not None:
            self.front = FrontMap(self.mesh, rows, data.degree, 2 * data.around)
        self.nodes = nodes
        self._across = self._circumferential() if data.full else None

    def material(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """``(Z, Theta)`` of mesh coordinates, shape ``(3, n)``."""
        if self.front is not None:
            return self.front.material(points[0], points[1]), points[1]
        if not self.data.full:
            return points[0], points[1]
        corners, next_corners, widths = self._faces()
        # A point belongs to the face that contains it; on an edge both faces give the same angle.
        along = (next_corners - corners) / widths[:, None]
        offset = points[:2].T[:, None, :] - corners[None]
        s = np.einsum("ijk,jk->ij", offset, along)
        miss = np.abs(offset[..., 0] * along[:, 1] - offset[..., 1] * along[:, 0])
        miss += np.maximum(-s, 0) + np.maximum(s - widths, 0)
        face = np.argmin(miss, axis=1)
        return points[2], self._angles[face] + s[np.arange(len(face)), face]

    def _faces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """First and second corner of each face of the prism, and its width."""
        widths = np.diff([*self._angles, self._angles[0] + 2 * np.pi])
        corners = polygon(widths)
        return corners, np.roll(corners, -1, axis=0), widths

    def _over(self, shape: Shape) -> Callable[[np.ndarray], np.ndarray]:
        return lambda points: shape(*self.material(points))

    def _circumferential(self) -> fem.Function:
        """Unit vector along ``Theta`` on each face of the prism."""
        space = fem.functionspace(self.mesh, ("DG", 0, (3,)))
        direction = fem.Function(space)

        def tangent(points: np.ndarray) -> np.ndarray:
            # The middle of a face of a polygon inscribed in a circle lies on the face's normal.
            radius = np.hypot(points[0], points[1])
            return np.vstack([-points[1] / radius, points[0] / radius, np.zeros_like(radius)])

        direction.interpolate(tangent)
        return direction

    @property
    def _stretch(self) -> Expr | float:
        """Ratio of material area to mesh area."""
        return 1.0 if self.front is None else self.front.function.dx(0)

    def surface(self, of: Expr) -> Surface:
        """A field with its derivatives in ``Z`` and ``Theta``."""
        if self.front is not None:
            a = of.dx(0) / self._stretch
            return Surface(of, a, of.dx(1) - a * self.front.function.dx(1))
        if self._across is None:
            return Surface(of, of.dx(0), of.dx(1))
        return Surface(of, of.dx(2), ufl.dot(ufl.grad(of), self._across))


def _edges(cells: int, uneven: float) -> np.ndarray:
    """Angles of the edges of the prism's faces, whose widths vary by ``uneven`` with one wave around."""
    even = 2 * np.pi * np.arange(cells) / cells
    return even + uneven * (np.sin(even + 0.7) - np.sin(0.7))
