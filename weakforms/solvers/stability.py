"""Stability of an equilibrium: lowest eigenvalues by SLEPc, counted independently by matrix inertia."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc
from slepc4py import SLEPc

from weakforms.errors import ConvergenceError
from weakforms.solvers.linear import Factorization
from weakforms.solvers.system import State, System


@dataclass(frozen=True)
class Spectrum:
    """Lowest eigenvalues of ``K x = μ M x`` in ascending order, and the inertia's count."""

    eigenvalues: tuple[float, ...]
    n_negative: int


class Stability:
    r"""Second variation at fixed loads against the mass matrix, :math:`K x = \mu M x`.

    Shift-and-invert about zero. The mass matrix has zero Dirichlet rows, so the constrained degrees of
    freedom sit at infinity and add no eigenvalue. The number of negative eigenvalues is taken from the
    inertia of ``K``; SLEPc must find exactly as many, or the spectrum is refused.
    """

    def __init__(self, system: System, prefix: str = "weakforms_eigen_") -> None:
        self.system = system
        self.factor = Factorization(system)
        self._prefix = prefix

    def _solver(self, wanted: int) -> SLEPc.EPS:
        eps = SLEPc.EPS().create(self.system.comm)
        eps.setOptionsPrefix(self._prefix)
        eps.setOperators(self.system.matrix, self.system.mass)
        eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
        eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
        eps.setTarget(0.0)
        eps.setDimensions(nev=wanted)
        eps.setTolerances(tol=1e-12, max_it=200)
        st = eps.getST()
        st.setType("sinvert")
        st.getKSP().setType("preonly")
        pc = st.getKSP().getPC()
        pc.setType("cholesky")
        pc.setFactorSolverType("mumps")
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
            self.system.matrix.axpy(shift, self.system.mass)
        self.factor.refactor()
        negative = self.factor.negative_count()
        wanted = max(count, negative + 1)
        for extra in (0, wanted, 4 * wanted):
            values = self._eigenvalues(wanted + extra)
            if int(np.sum(values < 0)) == negative:
                return Spectrum(tuple((values[:wanted] - shift).tolist()), negative)
        found = int(np.sum(values < 0))
        raise ConvergenceError(
            f"stability: inertia counts {negative} negative eigenvalues, SLEPc finds {found} "
            f"(nearest to zero: {values[np.argmin(np.abs(values))]:.1e})"
        )

    def nearest_by_index(self, state: State, index: int) -> float:
        """The eigenvalue number ``index`` in ascending order, by way of the one nearest to zero.

        For root finding: where the inertia is ``index`` or ``index + 1`` that one is the nearest from its
        side, whatever sign round-off gives it.
        """
        self.system.set_state(state.u, state.loads)
        self.factor.update()
        negative = self.factor.negative_count()
        values = self._eigenvalues(index + 3)
        below, above = values[values < 0], values[values >= 0]
        if negative > index:
            return float(below[-1]) if len(below) else float(values[0])
        return float(above[0]) if len(above) else float(values[-1])

    def _eigenvalues(self, wanted: int) -> np.ndarray:
        eps = self._solver(wanted)
        try:
            eps.solve()
            if eps.getConverged() < wanted:
                raise ConvergenceError(f"SLEPc converged {eps.getConverged()} of {wanted} eigenvalues")
            return np.sort([eps.getEigenvalue(i).real for i in range(eps.getConverged())])
        except PETSc.Error as error:
            raise ConvergenceError(f"SLEPc failed: {error}") from error
        finally:
            eps.destroy()
