"""Paper 3: states and modes of the primary branch as plain arrays, as guesses for the surface.

The secondary branch on a mesh of the whole surface starts where the axisymmetric branch bifurcates. The two
meshes are independent. States and modes are passed as columns over the material coordinate ``Z``, the same on
every rank.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from mpi4py import MPI

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.liquid_tube.branch import WIDEST, FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.material_choice import Chosen
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.continuation.pieces import nth
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modal import ModalBranch
from weakforms.solvers.support.sampling import Sampler


@dataclass(frozen=True)
class AxisymmetricState:
    """A state of the primary branch at material points ``Z``, and at a bifurcation point its mode."""

    values: dict[str, float]
    """Columns of the branch: ``zw``, ``V``, ``Pi``, ``r_mid``, eigenvalues and others."""
    Z: np.ndarray
    r: np.ndarray
    z: np.ndarray
    n: int = 0
    """Wave number of the mode; 0 if there is none."""
    mode: np.ndarray | None = None
    """Null vector ``(u, beta, w)`` at ``Z``, shape ``(3, len(Z))``: the displacement
    ``u cos(n Theta) e_r + beta sin(n Theta) e_theta + w cos(n Theta) e_z``, of unit norm
    ``int (u^2 + beta^2 + w^2) dZ = 1``, with ``u > 0`` where it is largest."""


class PrimaryBranch:
    """The primary branch on one mesh, evaluated at any state and any ``Z``.

    Args:
        comm: Ranks.
        L: Length of the stretched tube over the radius.
        delta: Pre-stretch.
        gamma: ``rho g A^2/(mu H)``.
        alpha: Second Mooney-Rivlin constant over the first; 0 is neo-Hookean.
        material: A law that replaces the Mooney-Rivlin law.
        cells: Cells on each of the two parts of the mesh; 48 of degree 5 give ten digits.
        degree: Degree of the elements.
        n_max: Largest wave number whose eigenvalues are computed.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        L: float,
        delta: float,
        gamma: float = 0.116,
        alpha: float = 0.0,
        material: Chosen | None = None,
        cells: int = 48,
        degree: int = 5,
        n_max: int = 1,
    ) -> None:
        data = TubeData(L, delta, gamma, alpha, cells, degree, material=material)
        self.path = FluidPath(comm, data, n_max)

    def bifurcation(self, points: np.ndarray, n: int = 1, order: int = 1) -> AxisymmetricState:
        """The ``order``-th zero of a wave number's eigenvalue along the branch, with its mode.

        Raises:
            AbsentError: If the branch, followed to its end, has no such point.
            ConvergenceError: If it is not followed to its end, or the solve does not converge.
        """
        found = 0
        for piece in self.path.pieces:
            for solved in piece.special():
                found += solved.values.get("n") == n
                if solved.values.get("n") == n and found == order:
                    return self._bifurcated(piece, solved, np.asarray(points, dtype=float), n)
        has = f"the primary branch has {found} bifurcation points of n = {n}, not {order}"
        stalled = [piece.stalled for piece in self.path.pieces if piece.stalled]
        if stalled:
            raise ConvergenceError(f"{has}, as far as it was followed: {stalled[0]}")
        raise AbsentError(
            "bifurcation point",
            f"{has}, up to where its level has fallen to {self.path.zw_end:g} of the highest, or the tube is "
            f"{WIDEST:g} radii wide, or the law is at its limit; choose another delta or L, or another law",
        )

    def at(self, name: str, value: float, points: np.ndarray, crossing: int = 1) -> AxisymmetricState:
        """The state at which a column takes a value for the ``crossing``-th time along the branch.

        Raises:
            ConvergenceError: If the branch has no such state.
        """
        found = nth(self.path.pieces, lambda piece: len(piece.crossings(name, value)), crossing)
        if found is None:
            raise ConvergenceError(f"{name} = {value:g} is not taken {crossing} times on the primary branch")
        piece, here = found
        return self._read(piece.at(name, value, here), np.asarray(points, dtype=float))

    def _read(self, solved: Solved, points: np.ndarray) -> AxisymmetricState:
        r, z = self.path.sampled(solved.state, points, ("r", "z"))
        return AxisymmetricState({"zw": solved.state.loads["zw"], **solved.values}, points, r, z)

    def _bifurcated(
        self, piece: ModalBranch, solved: Solved, points: np.ndarray, n: int
    ) -> AxisymmetricState:
        base = self._read(solved, points)
        waves = self.path.model.waves
        columns = {name: waves.unknown[i] for i, name in enumerate(("u", "beta", "w"))}
        where = self.path.model.position(points, solved.state.loads)
        sampler = Sampler(waves.unknown, columns, where)
        with self.path.model.system.at(solved.state), waves.at(State(piece.null_vector(solved), {})):
            found = sampler()
        mode = np.array([found[name] for name in columns])
        sign = np.sign(mode[0][np.argmax(np.abs(mode[0]))])
        return AxisymmetricState(base.values, points, base.r, base.z, n, sign * mode)
