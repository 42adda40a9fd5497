"""Memory of finished solves."""

from pathlib import Path

import numpy as np
from mpi4py import MPI

from weakforms.solvers.support import memory
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


def test_a_small_solve_is_not_followed_by_a_search_for_garbage(monkeypatch):
    release(MPI.COMM_SELF)
    searches = []
    monkeypatch.setattr(memory.gc, "collect", lambda: searches.append(True))
    release(MPI.COMM_SELF)
    assert not searches
    grown = np.ones(2 * memory.GROWTH, dtype=np.uint8)
    release(MPI.COMM_SELF)
    assert searches
    assert grown.all()
