"""Numbers of a state on triangles that need a point: least stress, and the weight that reads a corner."""

from __future__ import annotations

import basix
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import Mesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError
from weakforms.problems.gas import Gas
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.system import System

ZERO = 1e-6
"""Eigenvalues above minus this do not count as negative: at a limit load one is zero."""

ALIKE = 1e-9
"""Difference of stresses, over the larger of the stress and the law's modulus, at points that are images of
each other: near a slack state stresses are small and their round-off is that of the modulus."""


class LeastStress:
    """The least principal stress over the quadrature points.

    Args:
        mesh: The reference surface.
        stress: An expression.
        rule: Degree of the quadrature.
        mirrored: Whether places are those of the part with positive coordinates.
    """

    def __init__(self, mesh: Mesh, stress: Expr, rule: int, mirrored: bool = False) -> None:
        self._mesh, self._mirrored = mesh, mirrored
        points, _ = basix.make_quadrature(basix.CellType.triangle, rule)
        self._expression = fem.Expression(ufl.as_vector([stress, *ufl.SpatialCoordinate(mesh)]), points)
        self._columns = 1 + mesh.geometry.dim
        self._cells = np.arange(mesh.topology.index_map(2).size_local, dtype=np.int32)

    def least(self) -> tuple[tuple[float, ...], float]:
        """Its place and its value; of points that share it by symmetry, the one with the largest ``X``.

        Raises:
            ConvergenceError: If the law has no stress at one of the points.
        """
        values = self._expression.eval(self._mesh, self._cells).reshape(-1, self._columns)
        if self._mirrored:
            values[:, 1:] = np.abs(values[:, 1:])
        lowest = values[:, 0].min(initial=np.inf)
        lowest = min(self._mesh.comm.allgather(lowest))
        if not np.isfinite(self._mesh.comm.allreduce(float(values[:, 0].sum()))):
            raise ConvergenceError(
                "the law has no stress where the membrane is wrinkled or stretched beyond its limit; lower "
                "w_end, or choose a law without a largest stretch"
            )
        near = values[values[:, 0] <= lowest + ALIKE * max(1.0, abs(lowest))]
        _, *place = max(
            (row for rows in self._mesh.comm.allgather(near.tolist()) for row in rows), key=_order
        )
        return tuple(place), lowest


def _order(row: list[float]) -> tuple[float, ...]:
    return tuple(round(x, 9) for x in row[1:])


class AmountHeld:
    r"""Negative eigenvalues of the tangent ``K``, with the load or with the amount of gas or liquid held.

    The amount ``V`` changes with the load :math:`\ell` by :math:`\mathrm dV/\mathrm d\ell = V_{,\ell} -
    V_{,u} K^{-1} R_{,\ell}`. With the amount held there is one negative eigenvalue less where this is
    negative: a liquid's level then falls while it is filled in. The mass of a gas: :class:`Gas`.

    Args:
        system: The equations in the space whose displacements keep the symmetry of the states.
        load: The load.
        amount: The functional whose derivative is conjugate to it.
        gas: The gas inside, whose mass may be held instead of its volume; none of a liquid.
    """

    def __init__(self, system: System, load: str, amount: str, gas: Gas | None) -> None:
        self._system, self._load, self._amount, self._gas = system, load, amount, gas
        self._factor = Factorization(system)
        self.columns = ("n_held",) if gas is None else ("n_held", "m", "n_fixed_m")

    def counts(self) -> dict[str, int]:
        """Counts at the state that the system is lent to: ``n_all`` with the load held, and the others."""
        system = self._system
        system.tangent()
        system.shift(ZERO)
        self._factor.refactor()
        b, own = system.monitor_gradient(self._amount, (self._load,))
        turned = self._factor.solve(system.load_derivative(self._load))
        rate = own[self._load] - system.dot(b, turned)
        count = self._factor.negative_count()
        counts = {"n_all": count, "n_held": count - int(rate < 0)}
        if self._gas is not None:
            counts["n_fixed_m"] = self._gas.count(count, *self._state(), rate)
        return counts

    def mass(self) -> dict[str, float]:
        """The mass ``m`` of the gas at the state that the system is lent to, if there is one."""
        return {} if self._gas is None else {"m": self._gas.mass(*self._state())}

    def _state(self) -> tuple[float, float]:
        """Load and amount."""
        return self._system.load(self._load), self._system.monitor(self._amount)


def corner_weight(mesh: Mesh, degree: int, here: np.ndarray) -> fem.Function:
    r"""A function ``g`` on one triangle with :math:`\int g\, v\,\mathrm dA = v(c)` for any ``v`` of a degree.

    The integral is the quadrature of degree ``2 degree``, on straight and on curved triangles.

    Args:
        mesh: The reference surface.
        degree: Of the elements.
        here: Whether a corner of one of this rank's triangles is the node ``c``, ``(m, 3)``.
    """
    weight = fem.Function(fem.functionspace(mesh, ("DG", degree)))
    cell, corner = (found[:1] for found in np.nonzero(here))
    first = mesh.comm.allreduce(mesh.comm.rank if len(cell) else mesh.comm.size, op=MPI.MIN)
    if mesh.comm.rank == first:
        points, weights = basix.make_quadrature(basix.CellType.triangle, 2 * degree)
        basis = weight.function_space.element.basix_element.tabulate(0, points)[0, :, :, 0]
        nodes = mesh.geometry.x[mesh.geometry.dofmap[cell[0]]]
        shape = basix.create_element(
            basix.ElementFamily.P, basix.CellType.triangle, mesh.geometry.cmap.degree
        ).tabulate(1, points)[1:, :, :, 0]
        tangents = np.einsum("dqi,ik->qkd", shape, nodes)
        area = np.sqrt(np.linalg.det(np.einsum("qkd,qke->qde", tangents, tangents)))
        product = np.einsum("q,qi,qj->ij", weights * area, basis, basis)
        dofs = weight.function_space.dofmap.cell_dofs(cell[0])
        weight.x.array[dofs] = np.linalg.solve(product, np.eye(len(dofs))[corner[0]])
    weight.x.scatter_forward()
    return weight
