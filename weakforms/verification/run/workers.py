"""Solve problems in parallel processes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from threading import Thread

from weakforms.errors import EnvironmentLackError

_elsewhere: list[tuple[Executor, int]] = []
"""The engine to which this process hands its work, and the number of its workers."""


@contextmanager
def handed_to(pool: Executor, count: int) -> Iterator[None]:
    """In this block :func:`workers` are those of an engine (:mod:`weakforms.verification.run.executors`)."""
    _elsewhere.append((pool, count))
    try:
        yield
    finally:
        _elsewhere.pop()


def at_once(jobs: int) -> int:
    """Number of tasks that run at the same time: that of the engine, if there is one, or of processes."""
    return _elsewhere[-1][1] if _elsewhere else jobs


def in_this_process(jobs: int) -> bool:
    """Whether tasks run one after the other in this process."""
    return jobs == 1 and not _elsewhere


@contextmanager
def workers(jobs: int, begin: Callable[[], None] | None = None) -> Iterator[Executor]:
    """Parallel processes that end with this one, even by a kill; after Ctrl-C they start nothing more.

    The engine of :func:`handed_to` takes their place, if there is one.

    Args:
        jobs: Number of processes.
        begin: Called once in each of them, before its first task.

    Raises:
        EnvironmentLackError: If one of them ended unexpectedly.
    """
    if _elsewhere:
        yield _elsewhere[-1][0]
        return
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
