"""Symmetric factorisation with inertia, and the block elimination of a few scalar unknowns."""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence

import numpy as np
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.support.memory import give_back

NATIVE_LIMIT = 400_000
"""Entries of a matrix up to which PETSc's own Cholesky beats MUMPS. For 1200 unknowns on a line it takes
0.04 ms against 0.3 ms, for 9500 on a membrane 27 ms against 14 ms."""

REFINED = 1e-9
"""Relative residual below which refinement does not improve a Newton step."""

REFINEMENT_LIMIT = 1e-6
"""Relative residual above which a bordered solve has failed."""

STIFF_LIMIT, OF_FORCES = 1e-3, 1e-15
"""The same for a stiff matrix, if the residual is round-off: smaller than this part of the forces ``|K| |z|``
that balance. For a singular matrix these grow without bound, and the first limit refuses it."""

ROUND_OFF = 1e-13
"""Absolute residual that is round-off for forces of order one, for any right-hand side."""


def count_inertia(pc: PETSc.PC) -> None:
    """Let a factorisation by MUMPS count its negative pivots."""
    pc.setFactorSetUpSolverType()
    factor = pc.getFactorMatrix()
    factor.setMumpsIcntl(24, 1)  # null pivot detection: PETSc's inertia insists on it ...
    factor.setMumpsCntl(3, -1e-200)  # ... but keep small pivots: they belong to folds
    factor.setMumpsIcntl(13, 1)  # no parallel root node: the inertia needs it
    factor.setMumpsIcntl(14, 50)  # room for delayed pivots of an indefinite matrix


class Factorization:
    """``K = L D Lᵀ``: solves, and the number of negative eigenvalues by Sylvester's law.

    PETSc's own factorisation does not pivot. This is safe here, because every bordered solve checks its
    residual; a solve that fails is repeated with MUMPS, which pivots.
    """

    def __init__(self, system: System, prefix: str = "weakforms_factor_") -> None:
        self.system = system
        self.prefix = prefix
        small = system.comm.size == 1 and system.matrix.getInfo()["nz_used"] <= NATIVE_LIMIT
        self.package = "petsc" if small else "mumps"
        self._pc = self._make(self.package)
        self.count = 0
        self.failed = False
        self.stiffened: tuple[float, np.ndarray] | None = None
        """``(τ, e_i)`` while ``K + τ e_i e_iᵀ`` is factorised instead of ``K``."""

    def _make(self, package: str) -> PETSc.PC:
        pc = PETSc.PC().create(self.system.comm)
        pc.setOptionsPrefix(self.prefix)
        pc.setOperators(self.system.matrix)
        pc.setType("cholesky")
        pc.setFactorSolverType(package)
        if package == "petsc":
            pc.setFactorOrdering("amd")
        else:
            count_inertia(pc)
        pc.setFromOptions()
        return pc

    def use_pivoting(self) -> bool:
        """Switch to MUMPS permanently; False if it is in use already."""
        if self.package == "mumps":
            return False
        self.package = "mumps"
        self._pc.destroy()
        self._pc = self._make("mumps")
        return True

    def update(self) -> None:
        """Factorise the tangent at the state that the system is lent to."""
        self.system.tangent()
        self.stiffened = None
        self.refactor()

    def refactor(self) -> None:
        """Factorise the current matrix."""
        self._pc.setOperators(self.system.matrix)
        self._pc.setUp()
        self._factors = self._pc.getFactorMatrix()
        self.failed = self._pc.getFailedReason() != PETSc.PC.FailedReason.NOERROR
        self.count += 1

    def release(self) -> None:
        """Free the factors, which take twice the memory of their matrix on a large surface."""
        self._factors = None
        self._pc.destroy()
        self._pc = self._make(self.package)
        self.count += 1  # whoever kept what was made with them must factorise again
        give_back()

    def stiffen(self) -> None:
        """Make a singular ``K`` regular by one diagonal entry, where its null vector is largest."""
        system = self.system
        null = self.solve(np.ones(system.size))
        size = np.abs(np.nan_to_num(null, nan=np.inf))
        size[system.bc_dofs] = 0.0
        # With a single degree of freedom the diagonal is the singular K itself; the mass is not zero.
        stiffness = max(
            float(np.abs(m.getDiagonal().array).max(initial=0.0)) for m in (system.matrix, system.mass)
        )
        largest = system.comm.allgather((float(size.max(initial=0.0)), stiffness))
        tau = max(value for _, value in largest)
        owner = int(np.argmax([amplitude for amplitude, _ in largest]))
        unit = np.zeros(system.size)
        if system.comm.rank == owner:
            i = int(np.argmax(size))
            unit[i] = 1.0
            row = system.matrix.getOwnershipRange()[0] + i
            system.matrix.setValue(row, row, tau, addv=True)
        system.matrix.assemble()
        self.stiffened = (tau, unit)
        self.refactor()

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """``K⁻¹ rhs`` for owned arrays; NaN where a zero pivot ended the factorisation."""
        if self.failed:
            return np.full(self.system.size, np.nan)
        return self.system.act(self._factors.solve, rhs)

    def negative_count(self) -> int:
        """Number of negative eigenvalues of ``K`` (its Dirichlet rows count as positive).

        Raises:
            ConvergenceError: If ``K`` is exactly singular.
        """
        if self.failed:
            raise ConvergenceError("inertia: the tangent is singular, its factorisation met a zero pivot")
        negative, _zero, _positive = self._factors.getInertia()
        return int(negative)


class BorderedMatrix:
    r"""Solves with the matrix ``[K, B; C^T, D]`` by block elimination.

    ``K`` may be nearly singular, as at a limit point, if the whole matrix is not. Iterative refinement with
    the whole matrix follows the elimination, and the residual is checked. If it does not converge because
    ``K`` is singular to round-off, the degree of freedom ``i`` that dominates its null vector is stiffened,
    :math:`\hat K = K + \tau e_i e_i^T`. An additional border subtracts :math:`-\tau e_i (e_i^T z)`, so that
    the system is the same and its block is regular.

    Args:
        factor: Factorised ``K``; it stays stiffened until its next update.
        columns: ``B``, one array for each scalar unknown.
        rows: ``C``, one array for each constraint.
        corner: ``D``.
    """

    def __init__(
        self,
        factor: Factorization,
        columns: list[np.ndarray],
        rows: list[np.ndarray],
        corner: np.ndarray,
    ) -> None:
        self.factor, self.system = factor, factor.system
        self._given = (columns, rows, corner)
        self._size = len(rows)
        self._eliminate()

    def _eliminate(self) -> None:
        self.columns, self.rows, corner = self._given
        if self.factor.stiffened is not None:
            tau, unit = self.factor.stiffened
            self.columns, self.rows = [*self.columns, -tau * unit], [*self.rows, unit]
            wider = -np.eye(self._size + 1)
            wider[: self._size, : self._size] = corner
            corner = wider
        self.corner: list[list[float]] = corner.tolist()
        self._solved = [self.factor.solve(column) for column in self.columns]
        dot = self.system.dot
        self._schur = [
            [entry - dot(row, column) for entry, column in zip(line, self._solved, strict=True)]
            for line, row in zip(self.corner, self.rows, strict=True)
        ]

    # The few scalars are lists: a numpy call would cost more than the computation.

    def _solve_once(self, f: np.ndarray | None, g: list[float]) -> tuple[np.ndarray, list[float]]:
        if f is None:
            z = np.zeros(self.system.size)
        else:
            z = self.factor.solve(f)
            g = [value - self.system.dot(row, z) for value, row in zip(g, self.rows, strict=True)]
        mu = _small_solve(self._schur, g)
        for value, column in zip(mu, self._solved, strict=True):
            z -= value * column
        return z, mu

    def multiply(self, z: np.ndarray, mu: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """The bordered matrix times ``(z, mu)``, without the stiffened diagonal entry."""
        wide = [*mu]
        if self.factor.stiffened is not None:
            wide.append(self.system.dot(self.factor.stiffened[1], z))
        r, h = self._residual(None, [0.0] * len(wide), z, wide)
        return -r, -np.array(h[: self._size])

    def _residual(
        self, f: np.ndarray | None, g: list[float], z: np.ndarray, mu: list[float]
    ) -> tuple[np.ndarray, list[float]]:
        r = self.system.multiply(self.system.matrix, z)
        np.subtract(0.0 if f is None else f, r, out=r)
        for value, column in zip(mu, self.columns, strict=True):
            r -= value * column
        h = [
            value - self.system.dot(row, z) - _inner(line, mu)
            for value, row, line in zip(g, self.rows, self.corner, strict=True)
        ]
        return r, h

    def _norm(self, f: np.ndarray | None, g: Sequence[float]) -> float:
        square = 0.0 if f is None else self.system.dot(f, f)
        return math.sqrt(square + _inner(g, g))

    def _refined(self, f: np.ndarray | None, g: list[float]) -> tuple[np.ndarray, list[float], float]:
        """Solution by elimination and refinement, and its residual relative to the right-hand side."""
        scale = self._norm(f, g) or 1.0
        z, mu = self._solve_once(f, g)
        left = np.inf
        for _ in range(4):
            r, h = self._residual(f, g, z, mu)
            before, left = left, self._norm(r, h) / scale
            if left < REFINED or not left < before:
                break
            dz, dmu = self._solve_once(r, h)
            z += dz
            mu = [value + change for value, change in zip(mu, dmu, strict=True)]
        return z, mu, left

    def solve(self, f: np.ndarray | None, g: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """Solution ``(z, mu)`` of the bordered system.

        Args:
            f: Right-hand side of ``K``'s rows; ``None`` for zero, which saves solving for it.
            g: Right-hand side of the other rows.

        Raises:
            ConvergenceError: If the residual stays above :data:`REFINEMENT_LIMIT`, for a stiff matrix above
                :data:`STIFF_LIMIT`.
        """
        for mend in (None, self._stiffen, self._pivot):
            if mend is not None:
                mend()
            wide = [*map(float, g)] + [0.0] * (len(self.rows) - len(g))
            z, mu, left = self._refined(f, wide)
            if left < REFINEMENT_LIMIT or left * self._norm(f, g) < ROUND_OFF:
                return z, np.array(mu[: self._size])
        forces = self.system.matrix.norm() * math.sqrt(self.system.dot(z, z))
        if left < STIFF_LIMIT and left * self._norm(f, g) < OF_FORCES * forces:
            return z, np.array(mu[: self._size])
        raise ConvergenceError(f"bordered linear system is singular (residual {left:.1e} after refinement)")

    def _stiffen(self) -> None:
        if self.factor.stiffened is None:
            self.factor.stiffen()
            self._eliminate()

    def _pivot(self) -> None:
        if self.factor.use_pivoting():
            self.factor.refactor()
            self._eliminate()


def _small_solve(matrix: list[list[float]], rhs: list[float]) -> list[float]:
    """Solution of a few equations; NaN where they are singular."""
    if len(rhs) <= 1:  # the most frequent size; the library call would cost more than the rest
        return [value / matrix[0][0] if matrix[0][0] else math.nan for value in rhs]
    try:
        return np.linalg.solve(matrix, rhs).tolist()
    except np.linalg.LinAlgError:
        return [math.nan] * len(rhs)


def _inner(a: Sequence[float], b: Sequence[float]) -> float:
    return sum(map(operator.mul, a, b))
