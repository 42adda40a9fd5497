"""The ranks that solve together: all of them, or each one alone if solves are handed out over MPI."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mpi4py import MPI

_alone = False


def every_rank_alone() -> None:
    """From now on each rank solves alone; this is for the start of a process."""
    global _alone  # noqa: PLW0603  (a fact about the process)
    _alone = True


def world() -> MPI.Intracomm:
    """The ranks that solve together."""
    from mpi4py import MPI

    return MPI.COMM_SELF if _alone else MPI.COMM_WORLD
