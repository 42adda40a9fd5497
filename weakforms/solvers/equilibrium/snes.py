"""How a solve by PETSc's SNES is run, and how it ended."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.support.compat import PETSC_ERRORS

_REASONS = {value: name for name, value in vars(PETSc.SNES.ConvergedReason).items() if isinstance(value, int)}


@dataclass(frozen=True)
class SolveRecord:
    """The outcome of a solve."""

    reason: str
    iterations: int
    factorizations: int
    norms: tuple[float, ...]
    """Residual norm of the whole system at each iteration."""

    def followed_by(self, other: SolveRecord) -> SolveRecord:
        """The record of both solves, one after the other."""
        both = self.iterations + other.iterations, self.factorizations + other.factorizations
        return SolveRecord(other.reason, *both, (*self.norms, *other.norms))


def run_snes(snes: PETSc.SNES, x: PETSc.Vec, callbacks: Deferred) -> None:
    """Solve, starting from ``x``; the caller must check whether the solve converged.

    Raises:
        ConvergenceError: If PETSc raises an error, or a function that it calls fails.
    """
    try:
        try:
            snes.solve(None, x)
        finally:
            callbacks.release()
    except (ConvergenceError, *PETSC_ERRORS, ArithmeticError, np.linalg.LinAlgError) as error:
        reason = snes.getConvergedReason()
        raise ConvergenceError(f"SNES ended with {_REASONS.get(reason, reason)}: {error}") from error


def solve_record(snes: PETSc.SNES, factorizations: int) -> SolveRecord:
    """The outcome of the last solve; the caller counts the factorisations."""
    reason = snes.getConvergedReason()
    norms, _ = snes.getConvergenceHistory()
    return SolveRecord(
        _REASONS.get(reason, str(reason)), snes.getIterationNumber(), factorizations, tuple(norms.tolist())
    )
