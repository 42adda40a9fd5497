r"""Equilibrium within a linear subspace of the displacements, by SNES: :math:`P^T R(u_0 + P q) = 0`.

If a symmetry defines the subspace, its equilibria are equilibria of the whole system (principle of symmetric
criticality). Newton's method cannot leave it in an unstable direction.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.equilibrium.linear import count_inertia
from weakforms.solvers.equilibrium.snes import SolveRecord, run_snes, solve_record
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System


class Subspace:
    """A system on ``u = lift + P q``.

    Args:
        system: The discrete equilibrium equations.
        basis: ``P``: rows of this rank's degrees of freedom, zero where they are prescribed.
        lift: ``u_0``, owned degrees of freedom: the prescribed values, and zero elsewhere.
        stol: Newton step, relative to ``q``, at which a state is converged.
        max_iterations: Largest number of Newton iterations.
        line_search: PETSc's name.
        prefix: PETSc options prefix.
    """

    def __init__(
        self,
        system: System,
        basis: PETSc.Mat,
        lift: np.ndarray,
        stol: float = 1e-11,
        max_iterations: int = 30,
        line_search: str = "bt",
        prefix: str = "weakforms_subspace_",
    ) -> None:
        self.system, self.basis, self.lift = system, basis, lift
        self._q, self._u = basis.createVecs()
        self._callbacks = Deferred()
        with system.at(system.initial):
            self._reduced = system.tangent().ptap(basis)
        snes = PETSc.SNES().create(system.comm)
        snes.setOptionsPrefix(prefix)
        snes.setFunction(self._residual, self._q.duplicate())
        snes.setJacobian(self._jacobian, self._reduced)
        ksp = snes.getKSP()
        ksp.setType("preonly")
        self._direct(ksp.getPC())
        snes.setTolerances(rtol=0.0, atol=0.0, stol=stol, max_it=max_iterations)
        snes.setConvergenceHistory(max_iterations + 1, reset=True)
        options, key = PETSc.Options(), f"{prefix}snes_linesearch_type"
        given = options.hasName(key)
        if not given:
            options[key] = line_search
        snes.setFromOptions()
        if not given:
            options.delValue(key)  # the option table is global: leave it as it was found
        self._snes = snes

    def _direct(self, pc: PETSc.PC) -> None:
        pc.setType("lu")
        if self.system.comm.size > 1:
            pc.setFactorSolverType("mumps")

    def _put(self, q: PETSc.Vec) -> None:
        self.basis.mult(q, self._u)
        self.system.rewrite(self.lift + self._u.array_r, {})

    def _residual(self, _snes: PETSc.SNES, q: PETSc.Vec, out: PETSc.Vec) -> None:
        def work() -> None:
            self._put(q)
            self._u.array_w[:] = self.system.residual()
            self.basis.multTranspose(self._u, out)

        self._callbacks.run(work, lambda: out.set(np.nan))

    def _jacobian(self, _snes: PETSc.SNES, q: PETSc.Vec, jacobian: PETSc.Mat, _p: PETSc.Mat) -> None:
        def work() -> None:
            self._put(q)
            self.system.tangent().ptap(self.basis, result=jacobian)

        self._callbacks.run(work, lambda: None)  # the next residual is then invalid

    def nearest(self, u: np.ndarray) -> np.ndarray:
        """Member of the subspace nearest to a vector of owned degrees of freedom (least squares)."""
        gram, ksp = self.basis.transposeMatMult(self.basis), PETSc.KSP().create(self.system.comm)
        ksp.setOperators(gram)
        ksp.setType("preonly")
        self._direct(ksp.getPC())
        self._u.array_w[:] = u - self.lift
        rhs = self._q.duplicate()
        self.basis.multTranspose(self._u, rhs)
        ksp.solve(rhs, self._q)
        self.basis.mult(self._q, self._u)
        return self.lift + self._u.array_r

    def negative_count(self, state: State) -> int:
        """Number of negative eigenvalues of the tangent ``P^T K P``, by Sylvester's law."""
        with self.system.at(state):
            self.system.tangent().ptap(self.basis, result=self._reduced)
        pc = PETSc.PC().create(self.system.comm)
        pc.setOperators(self._reduced)
        pc.setType("cholesky")
        pc.setFactorSolverType("mumps")
        count_inertia(pc)
        pc.setUp()
        negative, _zero, _positive = pc.getFactorMatrix().getInertia()
        pc.destroy()
        return int(negative)

    def solve(self, guess: State, loads: Mapping[str, float] | None = None) -> tuple[State, SolveRecord]:
        """Equilibrium in the subspace from a guess.

        Args:
            guess: First guess; its part outside the subspace is dropped.
            loads: Loads that replace the guess's loads.

        Raises:
            ConvergenceError: If the solve diverges or needs too many iterations.
        """
        with self.system.at(State(guess.u, guess.loads | dict(loads or {}))):
            return self._solve(guess)

    def _solve(self, guess: State) -> tuple[State, SolveRecord]:
        self.nearest(guess.u)
        q = self._q.copy()
        run_snes(self._snes, q, self._callbacks)
        its = self._snes.getIterationNumber()
        record = solve_record(self._snes, its)
        if self._snes.getConvergedReason() <= 0:
            last = record.norms[-1] if record.norms else np.nan
            raise ConvergenceError(
                f"SNES ended with {record.reason} in the subspace after {its} iterations, residual {last:.1e}"
            )
        self._put(q)
        return self.system.state(), record
