"""An error on one rank ends all of them, with its reason; an error on all of them is said once."""

import subprocess
import sys

import pytest
from on_ranks import environment

pytestmark = pytest.mark.mpi

COMMAND = """
import sys
from mpi4py import MPI
from weakforms import terminal, world
from weakforms.errors import ConvergenceError

def run():
    if MPI.COMM_WORLD.rank == 1 or "all" in sys.argv:
        raise {error}
    MPI.COMM_WORLD.allreduce(1)

world.PATIENCE = 0.5
sys.exit(terminal.guarded(run))
"""


@pytest.mark.parametrize(("error", "status"), [("ValueError('odd')", 1), ("ConvergenceError('no state')", 3)])
@pytest.mark.parametrize("ranks", ["one", "all"])
def test_an_error_ends_all_ranks(launcher, error, status, ranks):
    words = ["mpirun", "--oversubscribe", "-n", "2", sys.executable, "-c", COMMAND.format(error=error), ranks]
    done = subprocess.run(words, capture_output=True, text=True, env=environment(2), timeout=60, check=False)
    assert done.returncode == status
    said = [line for line in done.stderr.splitlines() if line.startswith("weakforms: ")]
    assert len(said) == 1
    assert ("odd" in said[0]) == (status == 1)
    assert said[0].startswith("weakforms: rank 1 alone: ") == (ranks == "one")
