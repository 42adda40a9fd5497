"""Memory of finished solves."""

from pathlib import Path

import numpy as np
from mpi4py import MPI

from weakforms.solvers.support.memory import release

PAGE, PIECE, COUNT = 4096, 100_000, 2000


def resident() -> int:
    """Bytes that this process has in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE


def test_memory_that_is_freed_between_pieces_in_use_is_given_back():
    pieces = [np.ones(PIECE, dtype=np.uint8) for _ in range(COUNT)]
    last = pieces[-1]  # the C library shrinks its heap by itself down to what is in use last
    full = resident()
    del pieces
    release(MPI.COMM_SELF)
    assert resident() < full - COUNT * PIECE / 2
    assert last.all()
