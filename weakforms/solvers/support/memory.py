"""Memory of finished solves.

Models, systems and solvers refer to each other, so that only Python's garbage collector frees them. It counts
objects, not the matrices and compiled forms that they own, and would run too seldom. The C library keeps
memory that was freed between pieces in use, 2.6 GB of a large solve, until it is asked to give it back.
"""

from __future__ import annotations

import ctypes
import gc
from contextlib import suppress

from mpi4py import MPI
from petsc4py import PETSc


def release(comm: MPI.Intracomm) -> None:
    """Free what no longer has an owner; collective, because on several ranks PETSc frees objects together."""
    gc.collect()
    if comm.size > 1:
        PETSc.garbage_cleanup(comm)
    with suppress(AttributeError):  # the GNU C library has it
        ctypes.CDLL(None).malloc_trim(0)


def set_aside() -> None:
    """Leave out of all later collections what there is now, such as modules: they take a tenth of the time.

    This is for the start of a process of our own: what is there now is never freed.
    """
    gc.collect()
    gc.freeze()
