"""Memory of finished solves on several ranks."""

import pytest
from on_ranks import start

pytestmark = pytest.mark.mpi

SCRIPT = """
from pathlib import Path
from dolfinx.mesh import create_unit_interval
from mpi4py import MPI
from petsc4py import PETSc
from weakforms import solve
from weakforms.solvers.support import memory

comm, freed = MPI.COMM_WORLD, []

def resident():
    return 4096 * int(Path("/proc/self/statm").read_text().split()[1]) // 10**6

def dropped():
    mesh = create_unit_interval(comm, 8)
    memory.remember(mesh)
    PETSc.Vec().createMPI((1_000_000, None), comm=mesh.comm).set(1.0)

before = resident()
for _ in range(20):
    dropped()
    memory.release(comm)
print("grown", resident() - before)

cleanup = PETSc.garbage_cleanup
PETSc.garbage_cleanup = lambda own: (freed.append(own), cleanup(own))
solve("tube", numerics={"cells": 8, "levels": 2})
if comm.rank == 0:
    print("communicators", len(freed), "left", len(memory._meshes))
"""


def test_vectors_of_meshes_that_are_gone_are_freed(launcher):
    """Twenty vectors of 8 MB, each of another mesh; a solve frees what belongs to its two meshes."""
    words = start(["-c", SCRIPT], 2).split()
    grown = [int(words[i + 1]) for i, word in enumerate(words) if word == "grown"]
    assert len(grown) == 2
    assert max(grown) < 40
    assert int(words[words.index("communicators") + 1]) >= 3
    assert int(words[words.index("left") + 1]) == 0
