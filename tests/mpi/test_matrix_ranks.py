"""The matrix of a form on ranks that have copies of held rows without a triangle there."""

import json
from pathlib import Path

import pytest
from on_ranks import start

pytestmark = pytest.mark.mpi

CODE = """
import json, sys
sys.path.insert(0, sys.argv[1])
from mpi4py import MPI
from test_matrix import held_inside
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


def test_held_rows_are_the_identity_on_any_number_of_ranks(launcher):
    folder = str(Path(__file__).parents[1] / "solvers")
    serial, *others = (json.loads(start(["-c", CODE, folder], ranks)) for ranks in (1, 2, 3))
    assert serial[0] == serial[1] > 10
    for found in others:
        assert found == pytest.approx(serial, rel=1e-13)
