"""Hands solves to an engine that exists already: MPI ranks under ``mpirun`` or ``srun``, or a Dask cluster.

The process that hands them out is the only one that writes. What is stored, and what ``--resume`` keeps, does
not depend on the engine.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from weakforms import api, world
from weakforms.errors import EnvironmentLackError, InputError
from weakforms.verification.run import workers

PATIENCE = 30
"""Seconds for which a Dask scheduler is waited for."""

CONTINUE = "with --resume the run continues from the stored solutions"


@contextmanager
def executor(name: str) -> Iterator[bool]:
    """Hand the work of this block to an engine.

    Args:
        name: ``processes``, ``mpi``, or ``dask:ADDRESS``.

    Yields:
        Whether this process runs the command; ranks that only solved are told not to, after the last solve.

    Raises:
        InputError: For an unknown engine, or one that cannot be used like this.
        EnvironmentLackError: If the engine is not installed, not there, or lost too many workers.
    """
    kind, _, address = name.partition(":")
    if kind == "processes" and not address:
        yield True
    elif kind == "mpi" and not address:
        yield from _over_mpi()
    elif kind == "dask" and address:
        yield from _over_dask(address)
    else:
        raise InputError(f"--executor {name!r}: allowed are processes, mpi and dask:ADDRESS")


def _over_mpi() -> Iterator[bool]:
    """Rank 0 hands out, and each other rank solves alone."""
    try:
        from mpi4py import MPI
        from mpi4py.futures import MPICommExecutor
    except ImportError as error:
        raise EnvironmentLackError("mpi4py is not installed here: apt install python3-mpi4py") from error
    ranks = MPI.COMM_WORLD
    if ranks.size < 2:
        raise InputError("--executor mpi: at least two ranks are wanted, as by mpirun -n 3")
    world.every_rank_alone()
    # Each rank initialises PETSc by itself, now: later, the first to do so would wait for the others.
    api.require_environment()
    with MPICommExecutor(ranks, root=0) as pool:
        if pool is None:
            yield False
            return
        try:
            with workers.handed_to(pool, ranks.size - 1):
                yield True
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _over_dask(address: str) -> Iterator[bool]:
    """The workers of a cluster, which must have one thread each and the same source code."""
    try:
        from distributed import Client, KilledWorker
    except ImportError as error:
        raise EnvironmentLackError(
            "distributed is not installed here: apt install python3-distributed"
        ) from error
    try:
        client = Client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        raise EnvironmentLackError(f"no Dask scheduler answers at {address}: {error}") from error
    with client:
        count = _require_alike(client, address)
        pool = client.get_executor(pure=False)
        try:
            with workers.handed_to(pool, count):
                yield True
        except KilledWorker as error:
            raise EnvironmentLackError(
                f"Dask lost several workers on one solve ({error}); {CONTINUE}"
            ) from error
        finally:
            pool.shutdown(wait=False)


def _require_alike(client: Any, address: str) -> int:
    """The number of workers.

    Raises:
        InputError: If there are none, they have several threads, which PETSc does not allow, or other code.
    """
    from weakforms.verification.run.solving import source_digest

    known = client.scheduler_info(n_workers=-1)["workers"]
    if not known:
        raise InputError(f"--executor dask: the scheduler at {address} has no workers")
    if any(worker["nthreads"] != 1 for worker in known.values()):
        raise InputError(
            "--executor dask: PETSc needs workers with one thread each: dask worker --nthreads 1"
        )
    if set(client.run(source_digest).values()) != {source_digest()}:
        raise InputError("--executor dask: the workers have another version of weakforms")
    return len(known)
