"""Memory of finished solves.

Models, systems and solvers refer to each other, so that only Python's garbage collector frees them. It counts
objects, not the matrices and compiled forms that they own, and would run too seldom.
"""

from __future__ import annotations

import gc

from mpi4py import MPI
from petsc4py import PETSc


def release(comm: MPI.Intracomm) -> None:
    """Free what no longer has an owner; collective, because on several ranks PETSc frees objects together."""
    gc.collect()
    if comm.size > 1:
        PETSc.garbage_cleanup(comm)


def set_aside() -> None:
    """Leave out of all later collections what there is now, such as modules: they take a tenth of the time.

    This is for the start of a process of our own: what is there now is never freed.
    """
    gc.collect()
    gc.freeze()
