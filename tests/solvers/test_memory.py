"""What a finished solve needed is freed."""

import gc

import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.support.memory import release

SMALL = {"cells": 16, "levels": 2, "step": 0.5}


def alive():
    release(MPI.COMM_SELF)
    return sum(isinstance(item, System) for item in gc.get_objects())


@pytest.mark.parametrize(("problem", "parameters"), [("tube", {"alpha": 0.1}), ("fluid_tube", {"n_max": 1})])
def test_a_finished_solve_leaves_no_system_behind(problem, parameters):
    """A solver that is owned by a Python context of PETSc would stay for ever, with its mesh and matrices."""
    before = alive()
    solve(problem, numerics=SMALL, **parameters)
    assert alive() <= before
