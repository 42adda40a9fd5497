r"""Lowest eigenvalues of a second variation whose spectrum is crowded or degenerate.

:math:`K x = \mu M x` by SLEPc about a target just below the lowest eigenvalue. Sylvester's law proves that no
eigenvalue lies below the target, and that none is missing up to the last one returned. A Krylov method may
find only one copy of a multiple eigenvalue; missing copies are then searched for beside those found.
"""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc
from slepc4py import SLEPc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.spectra import LOWEST, Mode, give_back

ROUGH, SHARP = 1e-3, 1e-11
"""Relative residuals of the first search and of the returned modes."""

BELOW = 0.02
"""Distance of the target below the lowest eigenvalue, relative to its magnitude."""

APART = 1e-8
"""Eigenvalues closer together than this relative distance are copies of one."""

ATTEMPTS = 6
"""Number of searches for missing copies."""


class Lowest:
    """Computes the lowest eigenvalues and modes at states of one system.

    Args:
        system: The discrete equilibrium equations.
        prefix: SLEPc options prefix.
    """

    def __init__(self, system: System, prefix: str = "weakforms_lowest_") -> None:
        self.system = system
        self.factor = Factorization(system, prefix + "factor_")
        self.factor.use_pivoting()
        self._prefix = prefix
        self._generic = _generic(system)

    def __call__(self, state: State, count: int) -> list[Mode]:
        """The ``count`` lowest eigenvalues in ascending order, multiple ones repeated, with their modes.

        The first mode is the same on any number of ranks, also in sign and, for a multiple eigenvalue, in
        direction: it is the projection of a generic displacement.

        Raises:
            ConvergenceError: If SLEPc finds fewer than the inertia counts.
        """
        with self.system.at(state):
            self.system.tangent()
            target = self._target()
            (first,) = self._solve(1, target, ROUGH, [])[:1]
            near = first[0] - BELOW * max(abs(first[0]), 1e-3)
            if near > target and not self._below(near):
                target = near
            found = self._solve(count, target, SHARP, [])
            for _ in range(ATTEMPTS):
                found = sorted(found, key=lambda pair: pair[0])
                last = found[count - 1][0]
                edge = last + APART * max(1.0, abs(last))
                if self._below(edge) <= sum(value < edge for value, _ in found):
                    return self._directed([self._mode(*pair) for pair in found])[:count]
                found += self._solve(count, target, SHARP, [vector for _, vector in found])
            raise ConvergenceError("stability: SLEPc finds fewer lowest eigenvalues than the inertia counts")

    def _below(self, shift: float) -> int:
        """Number of eigenvalues below a shift."""
        self.system.shift(-shift)
        self.factor.refactor()
        count = self.factor.negative_count()
        self.system.shift(shift)
        return count

    def _target(self) -> float:
        """Zero, or the first of -1, -2, -4 ... below all eigenvalues."""
        target = 0.0
        while self._below(target):
            target = min(2 * target, -1.0)
            if target < LOWEST:
                raise ConvergenceError(f"stability: there are eigenvalues below {LOWEST:g}")
        return target

    def _solve(
        self, wanted: int, target: float, tolerance: float, apart_from: list[PETSc.Vec]
    ) -> list[tuple[float, PETSc.Vec]]:
        eps = SLEPc.EPS().create(self.system.comm)
        eps.setOptionsPrefix(self._prefix)
        eps.setOperators(self.system.matrix, self.system.mass)
        eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
        eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
        eps.setTarget(target)
        eps.setDimensions(nev=wanted)
        eps.setTolerances(tol=tolerance, max_it=300)
        if apart_from:
            eps.setDeflationSpace(apart_from)
        st = eps.getST()
        st.setType("sinvert")
        st.getKSP().setType("preonly")
        st.getKSP().getPC().setType("cholesky")
        st.getKSP().getPC().setFactorSolverType("mumps")
        eps.setFromOptions()
        try:
            eps.solve()
            if eps.getConverged() < wanted:
                raise ConvergenceError(f"SLEPc converged {eps.getConverged()} of {wanted} eigenvalues")
            out = []
            for i in range(eps.getConverged()):
                vector = self.system.matrix.createVecRight()
                out.append((float(eps.getEigenpair(i, vector).real), vector))
            return out
        except PETSc.Error as error:
            raise ConvergenceError(f"SLEPc failed: {error}") from error
        finally:
            give_back(eps)

    def _mode(self, eigenvalue: float, vector: PETSc.Vec) -> Mode:
        array = vector.array.copy()
        length = np.sqrt(self.system.dot(array, self.system.mass_times(array)))
        return Mode(eigenvalue, array / length)

    def _directed(self, modes: list[Mode]) -> list[Mode]:
        """Modes of the lowest eigenvalue, the first of them the projection of a generic displacement."""
        lowest = modes[0].eigenvalue
        copies = [m for m in modes if m.eigenvalue < lowest + APART * max(1.0, abs(lowest))]
        weighed = self.system.mass_times(self._generic)
        parts = np.array([self.system.dot(mode.vector, weighed) for mode in copies])
        turn, _ = np.linalg.qr(np.column_stack([parts, np.eye(len(parts))]))
        turn[:, 0] *= np.sign(turn[:, 0] @ parts)
        vectors = np.column_stack([mode.vector for mode in copies]) @ turn
        turned = [Mode(m.eigenvalue, vector) for m, vector in zip(copies, vectors.T, strict=True)]
        return turned + modes[len(copies) :]


def _generic(system: System) -> np.ndarray:
    """A displacement without symmetry that depends on position and component, not on the numbering."""
    space = system.unknown.function_space
    blocks = space.dofmap.index_map_bs
    places = space.tabulate_dof_coordinates()[: system.size // blocks]
    phases = places @ np.array([2.0, 3.0, 5.0])
    return np.cos(1.0 + phases[:, None] + 7.0 * np.arange(blocks)).ravel()
