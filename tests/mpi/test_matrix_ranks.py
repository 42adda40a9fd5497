"""On ranks: dolfinx adds up the matrix of a form as PETSc would, and what solves leave is freed."""

import json
from pathlib import Path

import dolfinx.fem.petsc as fem_petsc
import numpy as np
import pytest
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from on_ranks import start

from weakforms.solvers.equilibrium.matrix import FormMatrix, pattern_of

pytestmark = pytest.mark.mpi

DROPPED = """
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

CODE = """
import json, sys
sys.path.insert(0, sys.argv[1])
from mpi4py import MPI
from test_matrix_ranks import held_inside
from weakforms.solvers.equilibrium.matrix import FormMatrix, pattern_of

comm = MPI.COMM_WORLD
space, (form, mass), bcs, held = held_inside(comm)
matrix = FormMatrix(space, pattern_of(form), bcs, held)
matrix.assemble(form)
matrix.assemble(form)
masses = matrix.without_zeros(mass)
found = [comm.allreduce(len(held)), comm.allreduce(matrix.petsc.getDiagonal().array[held].sum())]
found += [m.norm() for m in (matrix.petsc, masses)] + [m.getDiagonal().sum() for m in (matrix.petsc, masses)]
if comm.rank == 0:
    print(json.dumps(found))
"""


def held_inside(comm):
    """Two forms on quadratic triangles; the triangle above the diagonal is held, in blocks."""
    mesh = dmesh.create_rectangle(
        comm, [np.zeros(2), np.ones(2)], [8, 8], dmesh.CellType.triangle, diagonal=dmesh.DiagonalType.crossed
    )
    space = fem.functionspace(mesh, ("Lagrange", 2, (3,)))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    x = ufl.SpatialCoordinate(mesh)[0]
    coupled = (u[0] + u[1] + u[2]) * (v[0] + v[1] + v[2])
    forms = [ufl.inner(ufl.grad(u), ufl.grad(v)) + (1 + x) * coupled, ufl.inner(u, v)]
    beyond = fem.locate_dofs_geometrical(space, lambda p: p[1] > p[0] + 1e-9)
    bc = fem.dirichletbc(np.zeros(3), beyond, space)
    owned = 3 * space.dofmap.index_map.size_local
    dofs = bc.dof_indices()[0]
    return space, [fem.form(f * ufl.dx) for f in forms], [bc], dofs[dofs < owned]


def test_the_entries_are_those_of_petsc_and_held_rows_the_identity():
    space, (form, mass), bcs, held = held_inside(MPI.COMM_SELF)
    expected = fem_petsc.assemble_matrix(form, bcs)
    expected.assemble()
    matrix = FormMatrix(space, pattern_of(form), bcs, held)
    for _ in range(2):
        matrix.assemble(form)
        assert (matrix.petsc - expected).norm() < 1e-13 * expected.norm()
    assert matrix.petsc.getDiagonal().array[held] == pytest.approx(1.0, abs=0)
    masses = matrix.without_zeros(mass)
    assert (matrix.petsc - expected).norm() < 1e-13 * expected.norm()
    assert masses.getDiagonal().array[held] == pytest.approx(0.0, abs=0)
    assert masses.getInfo()["nz_used"] < 0.4 * expected.getInfo()["nz_used"]
    whole = fem_petsc.assemble_matrix(mass, bcs, 0.0)
    whole.assemble()
    assert (masses - whole).norm() < 1e-13 * whole.norm()


def test_held_rows_are_the_identity_on_any_number_of_ranks(launcher):
    folder = str(Path(__file__).parent)
    serial, *others = (json.loads(start(["-c", CODE, folder], ranks)) for ranks in (1, 2, 3))
    assert serial[0] == serial[1] > 10
    for found in others:
        assert found == pytest.approx(serial, rel=1e-13)


def test_vectors_of_meshes_that_are_gone_are_freed(launcher):
    """Twenty vectors of 8 MB, each of another mesh; a solve frees what belongs to its two meshes."""
    words = start(["-c", DROPPED], 2).split()
    grown = [int(words[i + 1]) for i, word in enumerate(words) if word == "grown"]
    assert len(grown) == 2
    assert max(grown) < 40
    assert int(words[words.index("communicators") + 1]) >= 3
    assert int(words[words.index("left") + 1]) == 0
