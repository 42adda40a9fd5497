"""Solve problems in parallel processes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from threading import Thread

from weakforms.errors import EnvironmentLackError


@contextmanager
def workers(jobs: int, begin: Callable[[], None] | None = None) -> Iterator[ProcessPoolExecutor]:
    """Parallel processes that end with this one, even by a kill; after Ctrl-C they start nothing more.

    Args:
        jobs: Number of processes.
        begin: Called once in each of them, before its first task.

    Raises:
        EnvironmentLackError: If one of them ended unexpectedly.
    """
    # Spawned, not forked: MPI and PETSc do not survive a fork.
    pool = ProcessPoolExecutor(jobs, mp_context=get_context("spawn"), initializer=_begin, initargs=(begin,))
    try:
        yield pool
    except BrokenProcessPool:
        raise EnvironmentLackError(
            "a worker process ended unexpectedly, perhaps because of too little memory; "
            f"with fewer than -j {jobs} and --resume the run continues from the stored solutions"
        ) from None
    finally:
        pool.shutdown(cancel_futures=True)


def _begin(begin: Callable[[], None] | None) -> None:
    Thread(target=lambda: (parent_process().join(), os._exit(1)), daemon=True).start()
    if begin is not None:
        begin()
