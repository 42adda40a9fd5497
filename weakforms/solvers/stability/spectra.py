"""Stability of an equilibrium: lowest eigenvalues by SLEPc, counted independently by matrix inertia."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from petsc4py import PETSc
from slepc4py import SLEPc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.equilibrium.linear import BorderedMatrix, Factorization
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.eigensolver import (
    ExactInverse,
    Inverse,
    by_cholesky,
    by_inverse,
    give_back,
    seek,
    shift_and_invert,
)
from weakforms.solvers.support.compat import PETSC_ERRORS

LOWEST = -1e12
"""Lower limit of the search for eigenvalues."""

BACKWARD_ERROR = 1e-12
"""Relative residual of a solve above which a factorisation is repeated with pivoting."""

CROWDED = 8
"""Factor of the basis if no eigenvalue converges: then many lie close together, as those of short waves."""

BESIDE = 1e-4
"""Relative distance between a known eigenvalue and the target for its mode."""

SAME = 1e-6
"""Relative distance below which an eigenvalue found from two targets is one."""

Found = TypeVar("Found")


class _UnfoundError(ConvergenceError):
    """Fewer eigenvalues converged than were wanted."""


@dataclass(frozen=True)
class Spectrum:
    """Lowest eigenvalues of ``K x = μ M x`` in ascending order, and the inertia's count of negative ones."""

    eigenvalues: tuple[float, ...]
    n_negative: int


@dataclass(frozen=True)
class Mode:
    """An eigenvalue and its eigenvector, of unit length in the mass norm."""

    eigenvalue: float
    vector: np.ndarray


class Stability:
    r"""Eigenvalues of the second variation at fixed loads, :math:`K x = \mu M x` with the mass matrix.

    Shift-and-invert at zero uses the same factors as the inertia, because another factorisation would be half
    the cost of a spectrum. A solve tests that the factors are accurate. The mass matrix has zero Dirichlet
    rows, so that constrained degrees of freedom have infinite eigenvalues. The inertia of ``K`` gives the
    number of negative eigenvalues. SLEPc must find exactly this number, or the spectrum is refused.
    """

    def __init__(self, system: System, prefix: str = "weakforms_eigen_") -> None:
        self.system = system
        self.factor = Factorization(system)
        self._prefix = prefix
        self._callbacks = Deferred()
        self._kept: SLEPc.EPS | None = None
        self._inverse: ExactInverse | None = None

    @contextmanager
    def _tangent_at(self, state: State, shift: float = 0.0) -> Iterator[None]:
        """Context of a state, with ``K + shift M`` assembled."""
        with self.system.at(state):
            self.system.tangent()
            if shift:
                self.system.shift(shift)
            yield

    def _solver(
        self, wanted: int, target: float = 0.0, inverse: Inverse | None = None, wider: int = 1
    ) -> SLEPc.EPS:
        """Shift-and-invert at a target, with a given inverse of the current matrix or with MUMPS.

        With a given inverse it is the same object each time: to make one costs as much as a small spectrum.
        """
        if inverse is None:
            eps = shift_and_invert(self.system.comm, self._prefix)
            by_cholesky(eps)
        else:
            if self._kept is None:
                self._kept = shift_and_invert(self.system.comm, self._prefix)
                self._inverse = by_inverse(self._kept, self._callbacks)
            eps, self._inverse.solve = self._kept, inverse
        eps.setOperators(self.system.matrix, self.system.mass)
        eps.setTarget(target)
        seek(eps, wanted, self.system.matrix.getSize()[0], wider)
        return eps

    def spectrum(self, state: State, count: int = 2, shift: float = 0.0) -> Spectrum:
        """The ``count`` lowest eigenvalues and all negative ones.

        Args:
            state: An equilibrium.
            count: Smallest number of eigenvalues.
            shift: Eigenvalues above ``-shift`` count as positive (for the zero eigenvalue of a fold).

        Raises:
            ConvergenceError: If SLEPc and the inertia disagree on the number of negative eigenvalues, or an
                eigenvalue is so close to zero that its sign is uncertain.
        """
        with self._tangent_at(state, shift):
            self._factorise()
            negative = self.factor.negative_count()
            # A system with one degree of freedom has one eigenvalue.
            wanted = min(max(count, negative + 1), self.system.matrix.getSize()[0])
            for extra in (0, wanted):
                values = self._eigenvalues(wanted + extra, self.factor.solve)
                if int(np.sum(values < 0)) == negative:
                    return Spectrum(tuple((values[:wanted] - shift).tolist()), negative)
            found = int(np.sum(values < 0))
            if found < negative:  # more than the inertia's count: a zero with round-off, nothing is missing
                for missing in (negative - found, negative):
                    below = self._from_below(state, shift, missing)[:missing]
                    further = values - below.max(initial=-np.inf) > SAME * np.abs(values)
                    joined = np.concatenate([below, values[further]])
                    if int(np.sum(joined < 0)) == negative:
                        return Spectrum(tuple((joined[:wanted] - shift).tolist()), negative)
            raise ConvergenceError(
                f"stability: inertia counts {negative} negative eigenvalues, SLEPc finds {found} "
                f"(nearest to zero: {values[np.argmin(np.abs(values))]:.1e})"
            )

    def _from_below(self, state: State, shift: float, count: int) -> np.ndarray:
        """The lowest eigenvalues of ``K + shift M``, with a target below all of them by inertia.

        From zero, SLEPc would find a few low eigenvalues far from zero only after all the small ones.
        """
        target = 0.0
        with self._tangent_at(state, shift):
            while target > LOWEST:
                further = min(2 * target, -1.0)
                self.system.shift(target - further)
                target = further
                self._factorise()
                if not self.factor.negative_count():
                    return self._eigenvalues(count, self.factor.solve, target)
        raise ConvergenceError(f"stability: there are eigenvalues below {LOWEST:g}")

    def nearest_by_index(self, state: State, index: int) -> float:
        """The eigenvalue number ``index`` in ascending order, found as the one nearest to zero.

        This is for root finding: if the inertia is ``index`` or ``index + 1``, this eigenvalue is the one
        nearest to zero on its side, even if round-off changes its sign.
        """
        with self._tangent_at(state):
            self._factorise()
            negative = self.factor.negative_count()
            wanted = min(index + 3, self.system.matrix.getSize()[0])
            values = self._eigenvalues(wanted, self.factor.solve)
            below, above = values[values < 0], values[values >= 0]
            if negative > index:
                return float(below[-1]) if len(below) else float(values[0])
            return float(above[0]) if len(above) else float(values[-1])

    def bordered(self, state: State, border: np.ndarray, compliance: float, shift: float = 0.0) -> Spectrum:
        r"""Lowest eigenvalue of :math:`K + b b^T/c`, or for ``c = 0`` of ``K`` on :math:`b^T x = 0`.

        Solves go through the bordered matrix ``[K, b; b^T, -c]``, whose inertia, less one negative
        eigenvalue, equals the inertia of the operator.

        Args:
            state: An equilibrium.
            border: ``b``, zero on Dirichlet rows.
            compliance: ``c``, not negative.
            shift: Added to all eigenvalues during the computation, if ``K`` alone is singular.

        Raises:
            ConvergenceError: If SLEPc and the inertia disagree on the number of negative eigenvalues.
        """
        with self._tangent_at(state, shift):
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
                f"stability: inertia counts {negative} negative eigenvalues under the constraint, SLEPc "
                f"finds {int(np.sum(values < 0))}"
            )

    def modes(self, state: State, count: int) -> list[Mode]:
        """The eigenvalues nearest to zero with their modes, at least ``count`` of them, nearest first.

        Raises:
            ConvergenceError: If fewer converge.
        """
        with self._tangent_at(state):
            found = self._near(self._solver(count), count, self._pairs)
            return sorted(found, key=lambda mode: abs(mode.eigenvalue))

    def highest_negative(self, state: State) -> Mode:
        """The negative eigenvalue nearest to zero, with its mode.

        Raises:
            ConvergenceError: If none is found.
        """
        for count in (4, 16):
            for mode in self.modes(state, min(count, self.system.matrix.getSize()[0])):
                if mode.eigenvalue < 0:
                    return mode
        raise ConvergenceError("stability: no negative eigenvalue is found near zero")

    def mode_at(self, state: State, eigenvalue: float) -> Mode:
        """The mode of a known eigenvalue, such as the lowest.

        The target lies a little below it, where the matrix is not singular.

        Raises:
            ConvergenceError: If none converges.
        """
        target = eigenvalue - BESIDE * max(1.0, abs(eigenvalue))
        with self._tangent_at(state):
            return self._near(self._solver(1, target), 1, self._pairs)[0]

    def about(self, state: State, target: float, count: int) -> tuple[list[Mode], int]:
        r"""Eigenvalues near a target, and the number below it, from one factorisation of ``K - target M``.

        SLEPc uses the same factors as the inertia, because on large meshes the factorisation dominates the
        cost. The eigenvalues are Rayleigh quotients, whose accuracy does not depend on nearly singular
        factors.

        Args:
            state: An equilibrium.
            target: Must differ from every eigenvalue by more than round-off.
            count: Smallest number of modes, nearest to the target first.

        Raises:
            ConvergenceError: If fewer converge, or the factorisation fails.
        """
        with self._tangent_at(state, -target):
            self._factorise()
            below = self.factor.negative_count()
            pairs = self._near(self._solver(count, inverse=self.factor.solve), count, self._pairs)
            found = [self._improved(mode, target) for mode in pairs]
            return sorted(found, key=lambda mode: abs(mode.eigenvalue - target)), below

    def _factorise(self) -> None:
        """Factorise the current matrix, with pivoting if round-off would be large otherwise."""
        system, rhs = self.system, np.cos(np.arange(self.system.size))  # an arbitrary vector
        self.factor.refactor()
        x = self.factor.solve(rhs)
        left = rhs - system.multiply(system.matrix, x)
        scale = system.matrix.norm() * np.sqrt(system.dot(x, x)) + np.sqrt(system.dot(rhs, rhs))
        if not np.sqrt(system.dot(left, left)) <= BACKWARD_ERROR * scale and self.factor.use_pivoting():
            self.factor.refactor()

    def _pairs(self, eps: SLEPc.EPS) -> list[Mode]:
        vector, _ = self.system.matrix.createVecs()
        values = (eps.getEigenpair(i, vector).real for i in range(eps.getConverged()))  # also the vector
        return [self._mode(value, vector.array.copy()) for value in values]

    def _improved(self, mode: Mode, target: float) -> Mode:
        """The mode with its Rayleigh quotient; the matrix is ``K - target M``."""
        product = self.system.multiply(self.system.matrix, mode.vector)
        return Mode(self.system.dot(mode.vector, product) + target, mode.vector)

    def _mode(self, eigenvalue: float, vector: np.ndarray) -> Mode:
        length = np.sqrt(self.system.dot(vector, self.system.mass_times(vector)))
        return Mode(float(eigenvalue), vector / length)

    def _eigenvalues(self, wanted: int, inverse: Inverse, target: float = 0.0) -> np.ndarray:
        """At least ``wanted`` eigenvalues nearest to a target, ascending; the matrix is ``K - target M``."""
        try:
            found = self._near(self._solver(wanted, inverse=inverse), wanted, _values)
        except _UnfoundError:
            found = self._near(self._solver(wanted, inverse=inverse, wider=CROWDED), wanted, _values)
        return np.sort(found) + target

    def lowest_against(self, state: State, other: PETSc.Mat) -> float:
        r"""The lowest eigenvalue of :math:`K x = \nu A x`, for positive ``K`` and non-negative ``A``.

        Raises:
            ConvergenceError: If ``K`` has negative eigenvalues, or none is found.
        """
        with self._tangent_at(state):
            self._factorise()
            if self.factor.negative_count():
                raise ConvergenceError("stability: the stiffness to compare with is not positive")
            eps = self._solver(1, inverse=self.factor.solve)
            eps.setOperators(self.system.matrix, other)
            return float(min(self._near(eps, 1, _values)))

    def _near(self, eps: SLEPc.EPS, wanted: int, read: Callable[[SLEPc.EPS], list[Found]]) -> list[Found]:
        """The eigenpairs that SLEPc finds near its target.

        Raises:
            ConvergenceError: If fewer than ``wanted`` converge, SLEPc raises an error, or an inverse fails.
        """
        found = None
        try:
            self._run(eps)
            if eps.getConverged() < wanted:
                raise _UnfoundError(f"SLEPc converged {eps.getConverged()} of {wanted} eigenvalues")
            found = read(eps)
        finally:
            if self._inverse is not None:
                self._inverse.solve = None
            if found is None:  # after an error its parts may be in use
                self._kept = None
            if eps is not self._kept:
                give_back(eps)
        return found

    def _run(self, eps: SLEPc.EPS) -> None:
        try:
            try:
                eps.solve()
            finally:
                self._callbacks.release()
        except (ConvergenceError, *PETSC_ERRORS) as error:
            raise ConvergenceError(f"SLEPc failed: {error}") from error


def spectrum_of(system: System, state: State, shift: float) -> Spectrum:
    """The lowest eigenvalues of a state, with the mass matrix of its own mesh (which fronts move)."""
    with system.at(state), system.weighed_here():
        return Stability(system).spectrum(state, shift=shift)


def _values(eps: SLEPc.EPS) -> list[float]:
    return [eps.getEigenvalue(i).real for i in range(eps.getConverged())]
