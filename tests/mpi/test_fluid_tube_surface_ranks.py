"""The surface of the fluid-loaded tube serially and on two ranks: full circle, and the secondary branch."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = [pytest.mark.mpi, pytest.mark.paper3]

PROGRAM = """
import json
import numpy as np
from mpi4py import MPI
from weakforms import solve
from weakforms.problems import registry
from weakforms.problems.base import silent, validated
from weakforms.problems.fluid_tube_secondary import secondary_family

full = solve("fluid_tube_surface", numerics={"cells": 8, "degree": 3})
problem = registry.get("fluid_tube")
coarse = {"secondary_cells": 16, "secondary_degree": 3, "secondary_levels": 2, "secondary_end": 0.97}
numerics = validated(problem.numerics, coarse, "numerics")
parameters = validated(problem.parameters, {"secondary": True}, "fluid_tube")
family = secondary_family(parameters, numerics, MPI.COMM_WORLD, silent)
state = family.state("zw", 7.75, 1, np.linspace(0, 4, 5))
numbers = {name: q.value for name, q in state.quantities.items()}
profile = {name: values.tolist() for name, values in state.fields[0].columns.items()}
if MPI.COMM_WORLD.rank == 0:
    whole = {name: q.value for name, q in full.quantities.items()}
    print("RESULT" + json.dumps([whole, numbers, profile, MPI.COMM_WORLD.size]))
"""


def run(ranks):
    environment = os.environ | {
        "PYTHONPATH": str(ROOT),
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_btl": "self,sm",
        "OMPI_MCA_mpi_yield_when_idle": "1",  # there may be fewer cores than ranks
        "OMP_NUM_THREADS": "1",
    }
    launch = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run(
        [*launch, sys.executable, "-m", "mpi4py", "-c", PROGRAM],  # an error on one rank ends all
        capture_output=True,
        text=True,
        env=environment,
        timeout=480,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    line = next(text for text in done.stdout.splitlines() if text.startswith("RESULT"))
    return json.loads(line.removeprefix("RESULT"))


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs an MPI launcher")
def test_two_ranks_give_the_same_numbers():
    whole, numbers, profile, one = run(1)
    shared_whole, shared_numbers, shared_profile, two = run(2)
    assert (one, two) == (1, 2)
    # The eigenvalue of the turn is a zero: its digits are round-off.
    assert shared_whole == pytest.approx(whole, rel=1e-8, abs=1e-9)
    assert shared_whole["multiplicity"] == whole["multiplicity"] == 2
    assert abs(shared_whole["Lambda_split"]) < 1e-10
    assert shared_numbers == pytest.approx(numbers, rel=1e-8, abs=1e-9)
    for name, column in profile.items():
        assert shared_profile[name] == pytest.approx(column, rel=1e-8, abs=1e-9)
