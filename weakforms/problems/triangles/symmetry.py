r"""Positions of a triangulated surface that are surfaces of revolution: :math:`x = Q(\Theta)\, \xi(S)`.

``Q`` is the rotation about the axis, ``xi`` the radial, hoop and axial position along one meridian. On a
structured tube, with one value of ``xi`` for each ring, these are the ring-periodic positions. A rotation by
one column of quadrilaterals maps the mesh onto itself, so that an equilibrium among them is one of the whole
surface. On an unstructured mesh ``xi`` is a cubic spline, and an equilibrium among these positions is the
guess for Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc
from scipy.interpolate import BSpline
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import lsqr

from weakforms.errors import InputError
from weakforms.problems.triangles.meshes import Triangulation

POLE = 1e-6
"""Largest distance from the axis, relative to the largest radius, of a node on the axis."""

FINENESS = 1.5
"""Approximate length of a spline's interval over the length of an edge."""

ALIKE = 0.02
"""Largest distance of the nodes from one meridian, relative to the height, for a surface of revolution."""


@dataclass(frozen=True)
class Meridian:
    """Splines along the meridian, over a parameter in [0, 1] of each node."""

    given: Triangulation
    parameter: np.ndarray
    knots: np.ndarray
    degree: int
    pole: bool

    @classmethod
    def of(cls, given: Triangulation) -> Meridian:
        """Splines for a mesh: one value for each ring, or cubic splines about as fine as the mesh.

        The parameter is the height ``s`` above the lowest node; with a pole it is ``arccos(1 - s)``, which on
        a hemisphere is the arc length.

        Raises:
            InputError: If the surface is flat.
        """
        z, radius = given.points[:, 2], given.radius
        if np.ptp(z) < 1e-3 * radius.max():
            raise InputError("surface: it is flat; allowed: a membrane whose meridian rises everywhere")
        s = np.clip((z - z.min()) / np.ptp(z), 0.0, 1.0)
        if given.rings:
            nodes = np.arange(given.rings[0] + 1) / given.rings[0]
            return cls(given, nodes[np.rint(s * given.rings[0]).astype(int)], _clamped(nodes, 1), 1, False)
        pole = bool(radius.min() < POLE * radius.max())
        t = np.arccos(1 - s) / (np.pi / 2) if pole else s
        length = np.ptp(z) + (radius.max() - radius.min() if pole else 0.0)
        count = max(4, int(length / (FINENESS * given.size)))
        return cls(given, t, _clamped(np.linspace(0, 1, count + 1), 3), 3, pole)

    @property
    def _splines(self) -> csr_matrix:
        return csr_matrix(BSpline.design_matrix(self.parameter, self.knots, self.degree))

    def positions(self) -> csr_matrix:
        """``Q(Theta) B``: positions of the nodes from radial, then hoop, then axial coefficients."""
        b = self._splines
        angle = self.given.angle[:, None]
        c, s = b.multiply(np.cos(angle)), b.multiply(np.sin(angle))
        by_component = csr_matrix(bmat([[c, -s, None], [s, c, None], [None, None, b]]))
        return by_component[np.arange(3 * b.shape[0]).reshape(3, -1).T.ravel()]

    def prescribed(self, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which coefficients are prescribed, and their values, with zero for the others.

        Args:
            start: Positions of the nodes; only those of clamped nodes matter.
        """
        count = len(self.knots) - self.degree - 1
        fixed, values = np.zeros((3, count), dtype=bool), np.zeros((3, count))
        held = self.given.held
        for end, place in ((0, 0.0), (-1, 1.0)):
            here = held & (np.abs(self.parameter - place) < 1e-6)
            if here.any():
                fixed[:, end] = True
                values[0, end] = np.hypot(*start[here, :2].T).mean()
                values[2, end] = start[here, 2].mean()
        if self.pole:
            fixed[:2, 0] = True
        return fixed.ravel(), values.ravel()

    def require_revolved(self, name: str) -> None:
        """Refuse a surface whose nodes do not lie on one meridian rotated about the ``z`` axis.

        Raises:
            InputError: If they are further from the best meridian than :data:`ALIKE`.
        """
        b = self._splines
        wrong = 0.0
        for values in (self.given.radius, self.given.points[:, 2]):
            fit = lsqr(b, values, atol=1e-12, btol=1e-12, iter_lim=2000)[0]
            wrong = max(wrong, float(np.abs(b @ fit - values).max()))
        share = wrong / np.ptp(self.given.points[:, 2])
        if share > ALIKE:
            raise InputError(
                f"surface: geometry = {name} is not a surface of revolution about the z axis with a rising "
                f"meridian: nodes lie {share:.1e} of its height off one meridian; allowed: {ALIKE:g}"
            )


def _clamped(breaks: np.ndarray, degree: int) -> np.ndarray:
    return np.concatenate([np.zeros(degree), breaks, np.ones(degree)])


def subspace_of(
    meridian: Meridian, start: np.ndarray, nodes: np.ndarray, comm: object
) -> tuple[PETSc.Mat, np.ndarray]:
    """Basis and lift of the surfaces of revolution ``lift + P q`` with prescribed clamped nodes.

    Args:
        meridian: The splines.
        start: Positions of all nodes; those of clamped nodes are prescribed.
        nodes: Nodes that this rank owns.
        comm: Ranks.

    Returns:
        ``P``, with a row for each of this rank's degrees of freedom, zero where they are prescribed; and the
        lift.
    """
    fixed, values = meridian.prescribed(start)
    rows = (3 * nodes[:, None] + np.arange(3)).ravel()
    basis = meridian.positions()[rows]
    held = np.repeat(meridian.given.held[nodes], 3)
    lift = np.where(held, start[nodes].ravel(), basis @ values)
    free = csr_matrix(basis[:, ~fixed].multiply(~held[:, None]))
    free.eliminate_zeros()
    csr = (free.indptr.astype(PETSc.IntType), free.indices.astype(PETSc.IntType), free.data)
    # PETSc distributes the columns evenly.
    matrix = PETSc.Mat().createAIJ(((len(rows), None), (None, free.shape[1])), csr=csr, comm=comm)
    matrix.assemble()
    return matrix, lift
