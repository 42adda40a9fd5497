"""SLEPc solvers for eigenvalues near a target, by shift-and-invert."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

import numpy as np
from petsc4py import PETSc
from slepc4py import SLEPc

from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.equilibrium.system import System

Inverse = Callable[[np.ndarray], np.ndarray]


def shift_and_invert(system: System, prefix: str, wanted: int, target: float) -> SLEPc.EPS:
    r"""A solver of :math:`K x = \mu M x` for eigenvalues near a target, whose inverse is yet to be chosen.

    Args:
        system: Its current matrix is ``K``.
        prefix: SLEPc options prefix.
        wanted: Number of eigenvalues.
        target: The target; the eigenvalues nearest to it are found.
    """
    eps = SLEPc.EPS().create(system.comm)
    eps.setOptionsPrefix(prefix)
    eps.setOperators(system.matrix, system.mass)
    eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    eps.setTarget(target)
    eps.setDimensions(nev=wanted)
    st = eps.getST()
    st.setType("sinvert")
    st.getKSP().setType("preonly")
    return eps


def by_cholesky(eps: SLEPc.EPS) -> None:
    """Let MUMPS factorise the shifted matrix."""
    pc = eps.getST().getKSP().getPC()
    pc.setType("cholesky")
    pc.setFactorSolverType("mumps")


def by_inverse(eps: SLEPc.EPS, inverse: Inverse, callbacks: Deferred) -> None:
    """Use a given inverse of the shifted matrix, such as factors that exist already."""
    pc = eps.getST().getKSP().getPC()
    pc.setType("python")
    pc.setPythonContext(_Preconditioner(inverse, callbacks))


def give_back(eps: SLEPc.EPS) -> None:
    """Destroy a solver; after an error some of its parts are in use, and the first error counts."""
    with suppress(PETSc.Error):
        eps.destroy()


class _Preconditioner:
    """A preconditioner that solves exactly."""

    def __init__(self, solve: Inverse, callbacks: Deferred) -> None:
        self._solve, self._callbacks = solve, callbacks

    def apply(self, _pc: PETSc.PC, rhs: PETSc.Vec, out: PETSc.Vec) -> None:
        """``out`` is the solution for ``rhs``."""

        def work() -> None:
            out.array_w[:] = self._solve(rhs.array_r.copy())

        self._callbacks.run(work, lambda: out.set(0.0))  # every vector is an eigenvector of it
