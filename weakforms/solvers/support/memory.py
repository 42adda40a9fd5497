"""Memory of finished solves.

Models, systems and solvers refer to each other, so that only Python's garbage collector frees them. It counts
objects, not the matrices and compiled forms that they own, and would run too seldom. The C library keeps
memory that was freed between pieces in use, 2.6 GB of a large solve, until it is asked to give it back.

On several ranks PETSc keeps an object that Python drops until all ranks of its communicator free it together.
Every mesh has a communicator of its own, and nobody could name it once the mesh is gone.
"""

from __future__ import annotations

import ctypes
import gc
import resource
from contextlib import suppress
from math import inf
from pathlib import Path

from dolfinx.mesh import Mesh
from mpi4py import MPI
from petsc4py import PETSc

GROWTH = 64 * 2**20
"""Bytes by which a process may grow before it looks for what has no owner any more. To look takes 0.07 s, as
long as a small solve."""

_least = {"bytes": 0.0}
"""Memory of the process after the last time it looked."""

_meshes: list[Mesh] = []
"""Meshes on several ranks, whose objects the next :func:`release` frees; the same order on every rank."""


def remember(mesh: Mesh) -> None:
    """Keep a mesh of several ranks until :func:`release`, because objects of PETSc belong to it."""
    if mesh.comm.size > 1 and not any(known is mesh for known in _meshes):
        _meshes.append(mesh)


def release(comm: MPI.Intracomm) -> None:
    """Free what no longer has an owner, if there may be much of it; collective on several ranks."""
    if comm.size == 1 and _in_use() < _least["bytes"] + GROWTH:
        return
    gc.collect()
    if comm.size > 1:
        for own in (*(mesh.comm for mesh in _meshes), comm):
            PETSc.garbage_cleanup(own)
        _meshes.clear()
    give_back()
    _least["bytes"] = _in_use()


def _in_use() -> float:
    """Bytes of this process that lie in memory; infinite where the system does not say."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except OSError:
        return inf
    return pages * resource.getpagesize()


def give_back() -> None:
    """Give the memory that was freed back to the system."""
    with suppress(AttributeError):  # the GNU C library has it
        ctypes.CDLL(None).malloc_trim(0)


def set_aside() -> None:
    """Leave out of all later collections what there is now, such as modules: they take a tenth of the time.

    This is for the start of a process of our own: what is there now is never freed.
    """
    gc.collect()
    gc.freeze()
