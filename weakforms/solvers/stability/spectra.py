"""Stability of an equilibrium: lowest eigenvalues by SLEPc, counted independently by matrix inertia."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from petsc4py import PETSc
from slepc4py import SLEPc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.equilibrium.linear import BorderedMatrix, Factorization
from weakforms.solvers.equilibrium.system import State, System

LOWEST = -1e6
"""Eigenvalue below which none is looked for."""

BACKWARD_ERROR = 1e-12
"""Of a solve, relative, above which a factorisation is not the matrix's, and one that pivots is made."""

BESIDE = 1e-4
"""Relative distance from a known eigenvalue at which its mode is looked for."""


Inverse = Callable[[np.ndarray], np.ndarray]
Found = TypeVar("Found")


@dataclass(frozen=True)
class Spectrum:
    """Lowest eigenvalues of ``K x = μ M x`` in ascending order, and the inertia's count."""

    eigenvalues: tuple[float, ...]
    n_negative: int


@dataclass(frozen=True)
class Mode:
    """An eigenvalue and its eigenvector, of unit length in the mass norm."""

    eigenvalue: float
    vector: np.ndarray


class Stability:
    r"""Second variation at fixed loads against the mass matrix, :math:`K x = \mu M x`.

    Shift-and-invert about zero, by the very factors that the inertia is counted from (one more factorisation
    would be half the cost of a spectrum); that they are the matrix's own is tested by a solve. The mass
    matrix has zero Dirichlet rows, so the constrained degrees of freedom sit at infinity and add no
    eigenvalue. The number of negative eigenvalues is taken from the inertia of ``K``; SLEPc must find
    exactly as many, or the spectrum is refused.
    """

    def __init__(self, system: System, prefix: str = "weakforms_eigen_") -> None:
        self.system = system
        self.factor = Factorization(system)
        self._prefix = prefix
        self._callbacks = Deferred()

    def _solver(self, wanted: int, target: float = 0.0, inverse: Inverse | None = None) -> SLEPc.EPS:
        """Shift-and-invert about a target, by an inverse at hand (of the matrix as it stands) or by MUMPS."""
        eps = SLEPc.EPS().create(self.system.comm)
        eps.setOptionsPrefix(self._prefix)
        eps.setOperators(self.system.matrix, self.system.mass)
        eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
        eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
        eps.setTarget(target)
        eps.setDimensions(nev=wanted)
        eps.setTolerances(tol=1e-12, max_it=200)
        st = eps.getST()
        st.setType("sinvert")
        st.getKSP().setType("preonly")
        pc = st.getKSP().getPC()
        if inverse is None:
            pc.setType("cholesky")
            pc.setFactorSolverType("mumps")
        else:
            pc.setType("python")
            pc.setPythonContext(_Preconditioner(inverse, self._callbacks))
        eps.setFromOptions()
        return eps

    def spectrum(self, state: State, count: int = 2, shift: float = 0.0) -> Spectrum:
        """The ``count`` lowest eigenvalues and all negative ones.

        Args:
            state: An equilibrium.
            count: Eigenvalues wanted at least.
            shift: Eigenvalues above ``-shift`` count as positive (a fold's own zero, to round-off).

        Raises:
            ConvergenceError: When SLEPc's count of negative eigenvalues is not the inertia's, or an
                eigenvalue is too close to zero for its sign to be known.
        """
        self.system.set_state(state.u, state.loads)
        self.system.tangent()
        if shift:
            self.system.shift(shift)
        self._factorise()
        negative = self.factor.negative_count()
        # A body of one freedom has one eigenvalue.
        wanted = min(max(count, negative + 1), self.system.matrix.getSize()[0])
        for extra in (0, wanted):
            values = self._eigenvalues(wanted + extra, self.factor.solve)
            if int(np.sum(values < 0)) == negative:
                return Spectrum(tuple((values[:wanted] - shift).tolist()), negative)
        found = int(np.sum(values < 0))
        if found < negative:  # more than the inertia's are round-off of a zero: nothing was missed
            below = self._from_below(negative)
            found = int(np.sum(below < 0))
            if found == negative:
                values = np.concatenate([below[:negative], values[values >= 0]])
                return Spectrum(tuple((values[:wanted] - shift).tolist()), negative)
        raise ConvergenceError(
            f"stability: inertia counts {negative} negative eigenvalues, SLEPc finds {found} "
            f"(nearest to zero: {values[np.argmin(np.abs(values))]:.1e})"
        )

    def _from_below(self, count: int) -> np.ndarray:
        """The lowest eigenvalues of the matrix as it stands, about a target that the inertia finds below all.

        A few far from zero would otherwise be reached only past all the small ones.
        """
        target = 0.0
        while target > LOWEST:
            further = min(2 * target, -1.0)
            self.system.shift(target - further)
            target = further
            self._factorise()
            if not self.factor.negative_count():
                return self._eigenvalues(count, self.factor.solve, target)
        raise ConvergenceError(f"stability: there are eigenvalues below {LOWEST:g}")

    def nearest_by_index(self, state: State, index: int) -> float:
        """The eigenvalue number ``index`` in ascending order, by way of the one nearest to zero.

        For root finding: where the inertia is ``index`` or ``index + 1`` that one is the nearest from its
        side, whatever sign round-off gives it.
        """
        self.system.set_state(state.u, state.loads)
        self.system.tangent()
        self._factorise()
        negative = self.factor.negative_count()
        values = self._eigenvalues(index + 3, self.factor.solve)
        below, above = values[values < 0], values[values >= 0]
        if negative > index:
            return float(below[-1]) if len(below) else float(values[0])
        return float(above[0]) if len(above) else float(values[-1])

    def bordered(self, state: State, border: np.ndarray, compliance: float, shift: float = 0.0) -> Spectrum:
        r"""Lowest eigenvalue of :math:`K + b b^T/c`, or for ``c = 0`` of ``K`` on :math:`b^T x = 0`.

        Solves go through the bordered matrix :math:`\begin{pmatrix} K & b \\ b^T & -c \end{pmatrix}`, whose
        inertia, less one negative eigenvalue, is that of the operator.

        Args:
            state: An equilibrium.
            border: ``b``, zero on Dirichlet rows.
            compliance: ``c``, not negative.
            shift: Added to all eigenvalues while they are computed, where ``K`` alone is singular.

        Raises:
            ConvergenceError: When SLEPc's count of negative eigenvalues is not the inertia's.
        """
        self.system.set_state(state.u, state.loads)
        self.system.tangent()
        if shift:
            self.system.shift(shift)
        self._factorise()
        negative = self.factor.negative_count()
        bordered = BorderedMatrix(self.factor, [border], [border], np.array([[-compliance]]))
        schur = -compliance - self.system.dot(border, self.factor.solve(border))
        negative += int(schur < 0) - 1
        for wanted in (negative + 1, 2 * negative + 4):
            values = self._eigenvalues(wanted, lambda rhs: bordered.solve(rhs, np.zeros(1))[0])
            if int(np.sum(values < 0)) == negative:
                return Spectrum(tuple((values - shift).tolist()), negative)
        raise ConvergenceError(
            f"stability: inertia counts {negative} negative eigenvalues under the constraint, SLEPc finds "
            f"{int(np.sum(values < 0))}"
        )

    def modes(self, state: State, count: int) -> list[Mode]:
        """The eigenvalues nearest to zero with their modes, at least ``count`` of them, nearest first.

        Raises:
            ConvergenceError: When fewer converge.
        """
        self.system.set_state(state.u, state.loads)
        self.system.tangent()
        found = self._near(self._solver(count), count, self._pairs)
        return sorted(found, key=lambda mode: abs(mode.eigenvalue))

    def mode_at(self, state: State, eigenvalue: float) -> Mode:
        """The mode of an eigenvalue known already, such as the lowest.

        The target lies a little below it, off the singular matrix.

        Raises:
            ConvergenceError: When none converges.
        """
        self.system.set_state(state.u, state.loads)
        self.system.tangent()
        return self._near(self._solver(1, eigenvalue - BESIDE * max(1.0, abs(eigenvalue))), 1, self._pairs)[0]

    def about(self, state: State, target: float, count: int) -> tuple[list[Mode], int]:
        r"""Eigenvalues about a target, and how many lie below it, from one factorisation of ``K - target M``.

        SLEPc solves with the very factors that the inertia is counted from: on large meshes a factorisation
        is what a spectrum costs. The eigenvalues are Rayleigh quotients, and do not suffer from a factor
        that is nearly singular.

        Args:
            state: An equilibrium.
            target: No eigenvalue itself, to more than round-off.
            count: Modes wanted at least, nearest to the target first.

        Raises:
            ConvergenceError: When fewer converge, or the factorisation fails.
        """
        self.system.set_state(state.u, state.loads)
        self.system.tangent()
        if target:
            self.system.shift(-target)
        self._factorise()
        below = self.factor.negative_count()
        pairs = self._near(self._solver(count, inverse=self.factor.solve), count, self._pairs)
        found = [self._improved(mode, target) for mode in pairs]
        return sorted(found, key=lambda mode: abs(mode.eigenvalue - target)), below

    def _factorise(self) -> None:
        """Factorise the matrix as it stands; with pivoting where round-off would be large otherwise."""
        system, rhs = self.system, np.cos(np.arange(self.system.size))  # any vector that is not special
        self.factor.refactor()
        x = self.factor.solve(rhs)
        left = rhs - system.multiply(system.matrix, x)
        scale = system.matrix.norm() * np.sqrt(system.dot(x, x)) + np.sqrt(system.dot(rhs, rhs))
        if not np.sqrt(system.dot(left, left)) <= BACKWARD_ERROR * scale and self.factor.use_pivoting():
            self.factor.refactor()

    def _pairs(self, eps: SLEPc.EPS) -> list[Mode]:
        vector, _ = self.system.matrix.createVecs()
        found = []
        for i in range(eps.getConverged()):
            value = eps.getEigenpair(i, vector).real
            found.append(self._mode(value, vector.array.copy()))
        return found

    def _improved(self, mode: Mode, target: float) -> Mode:
        """With its Rayleigh quotient; the matrix is ``K - target M``."""
        product = self.system.multiply(self.system.matrix, mode.vector)
        return Mode(self.system.dot(mode.vector, product) + target, mode.vector)

    def _mode(self, eigenvalue: float, vector: np.ndarray) -> Mode:
        length = np.sqrt(self.system.dot(vector, self.system.mass_times(vector)))
        return Mode(float(eigenvalue), vector / length)

    def _eigenvalues(self, wanted: int, inverse: Inverse, target: float = 0.0) -> np.ndarray:
        """At least ``wanted`` of those nearest to a target, ascending; the matrix is ``K - target M``."""
        return np.sort(self._near(self._solver(wanted, inverse=inverse), wanted, _values)) + target

    def lowest_against(self, state: State, other: PETSc.Mat) -> float:
        r"""The lowest eigenvalue of :math:`K x = \nu A x`, where ``K`` is positive and ``A`` is not negative.

        Raises:
            ConvergenceError: When ``K`` has negative eigenvalues, or none is found.
        """
        self.system.set_state(state.u, state.loads)
        self.system.tangent()
        self._factorise()
        if self.factor.negative_count():
            raise ConvergenceError("stability: the stiffness to compare with is not positive")
        eps = self._solver(1, inverse=self.factor.solve)
        eps.setOperators(self.system.matrix, other)
        return float(min(self._near(eps, 1, _values)))

    def _near(self, eps: SLEPc.EPS, wanted: int, read: Callable[[SLEPc.EPS], list[Found]]) -> list[Found]:
        """What SLEPc finds about its target.

        Raises:
            ConvergenceError: When fewer than ``wanted`` converge, SLEPc breaks off, or an inverse fails.
        """
        try:
            self._run(eps)
            if eps.getConverged() < wanted:
                raise ConvergenceError(f"SLEPc converged {eps.getConverged()} of {wanted} eigenvalues")
            return read(eps)
        finally:
            give_back(eps)

    def _run(self, eps: SLEPc.EPS) -> None:
        try:
            try:
                eps.solve()
            finally:
                self._callbacks.release()
        except (ConvergenceError, PETSc.Error) as error:
            raise ConvergenceError(f"SLEPc failed: {error}") from error


def _values(eps: SLEPc.EPS) -> list[float]:
    return [eps.getEigenvalue(i).real for i in range(eps.getConverged())]


def give_back(eps: SLEPc.EPS) -> None:
    """Destroy it; one that broke off (a singular matrix) has parts in use, and what it raised counts."""
    with suppress(PETSc.Error):
        eps.destroy()


class _Preconditioner:
    """One that is the solver."""

    def __init__(self, solve: Inverse, callbacks: Deferred) -> None:
        self._solve, self._callbacks = solve, callbacks

    def apply(self, _pc: PETSc.PC, rhs: PETSc.Vec, out: PETSc.Vec) -> None:
        """``out`` is the solution for ``rhs``."""

        def work() -> None:
            out.array_w[:] = self._solve(rhs.array_r.copy())

        self._callbacks.run(work, lambda: out.set(0.0))  # of which all is an eigenvector
