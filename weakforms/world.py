"""The ranks that solve together: all of them, or each one alone if solves are handed out over MPI."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mpi4py import MPI

PATIENCE = 10.0
"""Seconds in which all ranks of a run must meet an error that one of them has met."""

PARTING = 2.0
"""Seconds for the launcher to pass the last message on: it may drop what is unread when it ends the ranks."""

IN_ERROR = 4711
"""Tag of the messages by which they tell each other."""

_alone = False


def every_rank_alone() -> None:
    """From now on each rank solves alone; this is for the start of a process."""
    global _alone  # noqa: PLW0603  (a fact about the process)
    _alone = True


def world() -> MPI.Intracomm:
    """The ranks that solve together."""
    from mpi4py import MPI

    return MPI.COMM_SELF if _alone else MPI.COMM_WORLD


def end_ranks_that_wait(status: int, text: str) -> None:
    """End all ranks if an error has come to this one alone: the others would wait for it for ever.

    An error that all of them meet ends each of them by itself. They tell each other by messages: a barrier
    would be taken for the collective call in which another rank waits.
    """
    try:
        comm = world()
    except ImportError:
        return
    others = [other for other in range(comm.size) if other != comm.rank]
    here = [comm.Isend(bytearray(), other, IN_ERROR) for other in others]
    here += [comm.Irecv(bytearray(), other, IN_ERROR) for other in others]
    last = time.monotonic() + PATIENCE
    while not all([request.Test() for request in here]):
        if time.monotonic() > last:
            sys.stderr.write(f"weakforms: rank {comm.rank} alone: {text}\n")
            sys.stderr.flush()
            time.sleep(PARTING)
            comm.Abort(status)
        time.sleep(0.01)
