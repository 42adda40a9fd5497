"""SLEPc solvers for eigenvalues near a target, by shift-and-invert."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc
from slepc4py import SLEPc

from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.support.compat import PETSC_ERRORS

Inverse = Callable[[np.ndarray], np.ndarray]

BASIS = 7
"""Vectors in the basis beyond the eigenvalues wanted. SLEPc takes 15, each of them a solve; restarts of the
smaller basis cost less than these, because few eigenvalues lie near a target."""

RESIDUAL = 1e-10
"""Relative residual of an eigenvector at which SLEPc stops. The error of an eigenvalue is of its square."""


def shift_and_invert(comm: MPI.Intracomm, prefix: str) -> SLEPc.EPS:
    r"""A solver of :math:`K x = \mu M x` for the eigenvalues nearest to its target.

    Its operators, its target and the inverse of the shifted matrix are yet to be set.

    Args:
        comm: Ranks.
        prefix: SLEPc options prefix.
    """
    eps = SLEPc.EPS().create(comm)
    eps.setOptionsPrefix(prefix)
    eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    st = eps.getST()
    st.setType("sinvert")
    st.getKSP().setType("preonly")
    return eps


def seek(eps: SLEPc.EPS, wanted: int, rows: int, wider: int = 1) -> None:
    """Ask for a number of eigenvalues.

    Args:
        eps: The solver.
        wanted: Their number.
        rows: Size of the matrix.
        wider: Factor of the basis, for eigenvalues that lie close together.
    """
    basis = min(wider * max(2 * wanted, wanted + BASIS), rows)
    eps.setDimensions(nev=wanted, ncv=basis, mpd=basis)
    eps.setTolerances(tol=RESIDUAL, max_it=200)
    eps.setFromOptions()


def by_cholesky(eps: SLEPc.EPS) -> None:
    """Let MUMPS factorise the shifted matrix."""
    pc = eps.getST().getKSP().getPC()
    pc.setType("cholesky")
    pc.setFactorSolverType("mumps")


def by_inverse(eps: SLEPc.EPS, callbacks: Deferred) -> ExactInverse:
    """Let an inverse that exists already, such as factors of the shifted matrix, be set before each solve."""
    inverse = ExactInverse(callbacks)
    pc = eps.getST().getKSP().getPC()
    pc.setType("python")
    pc.setPythonContext(inverse)
    return inverse


def give_back(eps: SLEPc.EPS) -> None:
    """Destroy a solver; after an error some of its parts are in use, and the first error counts."""
    with suppress(*PETSC_ERRORS):
        eps.destroy()


class ExactInverse:
    """A preconditioner that solves exactly.

    PETSc owns it, and Python's collector does not see this: it has its inverse only while it is in use, and
    owns no system.
    """

    solve: Inverse | None = None

    def __init__(self, callbacks: Deferred) -> None:
        self._callbacks = callbacks

    def apply(self, _pc: PETSc.PC, rhs: PETSc.Vec, out: PETSc.Vec) -> None:
        """``out`` is the solution for ``rhs``."""

        def work() -> None:
            out.array_w[:] = self.solve(rhs.array_r.copy())

        self._callbacks.run(work, lambda: out.set(0.0))  # every vector is an eigenvector of it
