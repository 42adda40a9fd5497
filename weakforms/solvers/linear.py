"""Symmetric factorisation with inertia, and the block elimination of a few scalar unknowns."""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.solvers.system import System

NATIVE_LIMIT = 20_000
"""Unknowns up to which PETSc's own Cholesky beats MUMPS (0.04 ms against 0.3 ms at 1200)."""

REFINED = 1e-9
"""Relative residual at which refinement has nothing to add to a Newton step."""

REFINEMENT_LIMIT = 1e-6
"""Relative residual above which a bordered solve counts as failed."""


ROUND_OFF = 1e-13
"""Absolute residual that is round-off of forces of order one, whatever the right-hand side."""


class Factorization:
    """``K = L D Lᵀ``: solves, and the number of negative eigenvalues by Sylvester's law.

    PETSc's own factorisation does not pivot. That is sound here because every bordered solve checks its
    residual; one that fails is repeated with MUMPS, which pivots.
    """

    def __init__(self, system: System, prefix: str = "weakforms_factor_") -> None:
        self.system = system
        self.prefix = prefix
        small = system.matrix.getSize()[0] <= NATIVE_LIMIT
        self.package = "petsc" if system.comm.size == 1 and small else "mumps"
        self._pc = self._make(self.package)
        self.count = 0
        self.failed = False
        self.stiffened: tuple[float, np.ndarray] | None = None
        """``(τ, e_i)`` while ``K + τ e_i e_iᵀ`` is factorised in place of ``K``."""

    def _make(self, package: str) -> PETSc.PC:
        pc = PETSc.PC().create(self.system.comm)
        pc.setOptionsPrefix(self.prefix)
        pc.setOperators(self.system.matrix)
        pc.setType("cholesky")
        pc.setFactorSolverType(package)
        if package == "petsc":
            pc.setFactorOrdering("amd")
        else:
            pc.setFactorSetUpSolverType()
            factor = pc.getFactorMatrix()
            factor.setMumpsIcntl(24, 1)  # null pivot detection: PETSc's inertia insists on it ...
            factor.setMumpsCntl(3, -1e-200)  # ... but a small pivot is a fold, not a null one: keep it
            factor.setMumpsIcntl(13, 1)  # no parallel root node: the inertia needs it
            factor.setMumpsIcntl(14, 50)  # room for delayed pivots of an indefinite matrix
        pc.setFromOptions()
        return pc

    def use_pivoting(self) -> bool:
        """Go over to MUMPS for good; False when it is in use already."""
        if self.package == "mumps":
            return False
        self.package = "mumps"
        self._pc.destroy()
        self._pc = self._make("mumps")
        return True

    def update(self) -> None:
        """Factorise the tangent at the state the system holds."""
        self.system.tangent()
        self.stiffened = None
        self.refactor()

    def refactor(self) -> None:
        """Factorise the matrix as it stands."""
        self._pc.setOperators(self.system.matrix)
        self._pc.setUp()
        self.failed = self._pc.getFailedReason() != PETSc.PC.FailedReason.NOERROR
        self.count += 1

    def stiffen(self) -> None:
        """Make a singular ``K`` regular by one diagonal entry, where its null vector is largest."""
        system = self.system
        null = self.solve(np.ones(system.size))
        size = np.abs(np.nan_to_num(null, nan=np.inf))
        size[system.bc_dofs] = 0.0
        # Of a single degree of freedom the diagonal is the singular K itself; its mass is not.
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
        x, y = self.system._work()
        x.array[:] = rhs
        self._pc.getFactorMatrix().solve(x, y)
        return y.array.copy()

    def negative_count(self) -> int:
        """Number of negative eigenvalues of ``K`` (its Dirichlet rows count as positive).

        Raises:
            ConvergenceError: When ``K`` is exactly singular.
        """
        if self.failed:
            raise ConvergenceError("inertia: the tangent is singular, its factorisation met a zero pivot")
        negative, _zero, _positive = self._pc.getFactorMatrix().getInertia()
        return int(negative)


class BorderedMatrix:
    r"""Solves with :math:`\begin{pmatrix} K & B \\ C^T & D \end{pmatrix}` by block elimination.

    ``K`` may be nearly singular (at a limit point it is) as long as the whole is not: the elimination is
    followed by iterative refinement against the whole matrix, and the residual is checked. Where that does
    not converge because ``K`` is singular to round-off, the degree of freedom ``i`` that dominates its null
    vector is stiffened, :math:`\hat K = K + \tau e_i e_i^T`, and :math:`-\tau e_i (e_i^T z)` taken back by
    one more border; that is the same system with a regular block.

    Args:
        factor: Factorised ``K``; a stiffened one stays in it until its next update.
        columns: ``B``, one array a scalar unknown.
        rows: ``C``, one array a constraint.
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
        self.columns, self.rows, self.corner = self._given
        if self.factor.stiffened is not None:
            tau, unit = self.factor.stiffened
            self.columns, self.rows = [*self.columns, -tau * unit], [*self.rows, unit]
            wider = -np.eye(self._size + 1)
            wider[: self._size, : self._size] = self.corner
            self.corner = wider
        self._solved = [self.factor.solve(column) for column in self.columns]
        schur = self.corner.copy()
        for i, row in enumerate(self.rows):
            for j, column in enumerate(self._solved):
                schur[i, j] -= self.system.dot(row, column)
        self._schur = schur

    def _once(self, f: np.ndarray, g: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        z = self.factor.solve(f)
        if not len(g):
            return z, g
        inner = np.array([self.system.dot(row, z) for row in self.rows])
        mu = _small_solve(self._schur, g - inner)
        for value, column in zip(mu, self._solved, strict=True):
            z -= value * column
        return z, mu

    def multiply(self, z: np.ndarray, mu: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The bordered matrix times ``(z, mu)``; a stiffened diagonal entry is taken back."""
        wide = mu
        if self.factor.stiffened is not None:
            wide = np.append(mu, self.system.dot(self.factor.stiffened[1], z))
        r, h = self._defect(np.zeros_like(z), np.zeros(len(wide)), z, wide)
        return -r, -h[: self._size]

    def _defect(
        self, f: np.ndarray, g: np.ndarray, z: np.ndarray, mu: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        r = f - self.system.multiply(self.system.matrix, z)
        for value, column in zip(mu, self.columns, strict=True):
            r -= value * column
        inner = np.array([self.system.dot(row, z) for row in self.rows])
        return r, g - inner - self.corner @ mu

    def _norm(self, f: np.ndarray, g: np.ndarray) -> float:
        return float(np.sqrt(self.system.dot(f, f) + g @ g))

    def _refined(self, f: np.ndarray, g: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Solution by elimination and refinement, and its residual relative to the right-hand side."""
        scale = self._norm(f, g) or 1.0
        z, mu = self._once(f, g)
        left = np.inf
        for _ in range(4):
            r, h = self._defect(f, g, z, mu)
            before, left = left, self._norm(r, h) / scale
            if left < REFINED or not left < before:
                break
            dz, dmu = self._once(r, h)
            z, mu = z + dz, mu + dmu
        return z, mu, left

    def solve(self, f: np.ndarray, g: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Solution ``(z, mu)`` of the bordered system.

        Raises:
            ConvergenceError: When a residual above :data:`REFINEMENT_LIMIT` is left all the same.
        """
        for mend in (None, self._stiffen, self._pivot):
            if mend is not None:
                mend()
            wide = np.concatenate([g, np.zeros(len(self.rows) - len(g))])
            z, mu, left = self._refined(f, wide)
            if left < REFINEMENT_LIMIT or left * self._norm(f, g) < ROUND_OFF:
                return z, mu[: self._size]
        raise ConvergenceError(f"bordered linear system is singular (residual {left:.1e} after refinement)")

    def _stiffen(self) -> None:
        if self.factor.stiffened is None:
            self.factor.stiffen()
            self._eliminate()

    def _pivot(self) -> None:
        if self.factor.use_pivoting():
            self.factor.refactor()
            self._eliminate()


def _small_solve(matrix: np.ndarray, rhs: np.ndarray) -> np.ndarray:
    """Solution of a few equations; NaN where they are singular."""
    if len(rhs) == 1:  # most of them, and the library call would cost more than all of the rest
        pivot = matrix[0, 0]
        return rhs / pivot if pivot else np.full(1, np.nan)
    try:
        return np.linalg.solve(matrix, rhs)
    except np.linalg.LinAlgError:
        return np.full(len(rhs), np.nan)
