"""The benchmark: time and memory by stage for fixed problems, also relative to the bare PETSc calls.

In serial, each problem is measured in two separate processes: with an empty cache of compiled forms (cold)
and with a full one (warm). On several ranks there is one process for each rank, and only warm numbers.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from typing import Any

from rich.console import Console
from rich.table import Table

from weakforms.errors import InputError
from weakforms.verification.report.wording import duration, fraction

REPEATS = {"tube": 5}
"""Number of measurements of a run and its floor; the best of each counts."""
USUAL = 2
ALSO_COLD = ("tube", "bent", "surface-small")
"""Problems that are also started cold; other sizes compile the same forms."""
STAGES = ("matrix assembly", "vector assembly", "functionals", "factorisation", "back substitution")

Progress = Callable[[str, int, int], None]


def run_bench(
    progress: Progress = lambda *_: None, only: tuple[str, ...] = (), cold: bool = True
) -> dict[str, Any]:
    """Run the benchmark.

    Args:
        progress: Called with what is being measured.
        only: Names of problems; all if empty.
        cold: Whether to measure cold and warm starts (compilation takes minutes); otherwise the start is that
            of this process, which may have compiled forms.

    Returns:
        One entry for each problem with seconds by stage, counts, ratio to the floor, peak memory; and
        versions.

    Raises:
        InputError: If there is no problem of that name.
    """
    from mpi4py import MPI

    from weakforms.solvers.support.provenance import versions
    from weakforms.verification.audit.bench_work import works
    from weakforms.verification.run.machine import environment

    known = list(works())
    if unknown := [name for name in only if name not in known]:
        raise InputError(f"bench has no problem {unknown[0]!r}; it has {', '.join(known)}")
    alone = MPI.COMM_WORLD.size == 1
    chosen = [name for name in known if name in only or not only]
    starts = [name for name in chosen if name in ALSO_COLD] if cold and alone else []
    found: dict[str, dict[str, Any]] = {}
    for i, name in enumerate(chosen):
        progress(name, i, len(chosen) + len(starts))
        found[name] = _in_a_process(name, "whole") if alone else measure(name, time.time(), False)
    for i, name in enumerate(starts):
        progress(f"{name}, cold and warm start", len(chosen) + i, len(chosen) + len(starts))
        measured, warm = (_in_a_process(name, kind)["start"] for kind in ("cold", "warm"))
        spent = sum(measured[key] - warm[key] for key in ("set_up", "first_run"))
        found[name] |= {"cold": measured, "start": warm, "jit_seconds": spent}
    return {
        "schema": "weakforms.bench/1",
        "ranks": MPI.COMM_WORLD.size,
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "problems": list(found.values()),
        "machine": environment(),
        "versions": versions(),
    }


def _in_a_process(name: str, kind: str) -> dict[str, Any]:
    """Measure in a new process: everything (``whole``), or the start, ``warm`` or not."""
    with tempfile.TemporaryDirectory(prefix="weakforms-bench-") as cache:
        environment = os.environ | ({"XDG_CACHE_HOME": cache} if kind == "cold" else {})
        command = [sys.executable, "-m", __name__, name, kind, repr(time.time())]
        done = subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def measure(name: str, started: float, only_start: bool) -> dict[str, Any]:
    """Measure one problem in this process.

    Args:
        name: Name of the problem.
        started: Time at which the process was launched.
        only_start: End after the first run.
    """
    from mpi4py import MPI

    from weakforms.verification.audit.bench_work import metered, works

    work = works()[name]()
    comm = MPI.COMM_WORLD

    def timed(run: Callable[[], Any]) -> tuple[float, Any]:
        comm.Barrier()
        begun = time.perf_counter()
        outcome = run()
        return time.perf_counter() - begun, outcome

    start = {"imports": time.time() - started}
    start["set_up"], _ = timed(lambda: work.set_up(comm))
    start["first_run"], points = timed(work.run)
    start["total"] = time.time() - started
    found = {
        "name": name,
        "title": work.title,
        "unknowns": work.system.matrix.getSize()[0],
        "points": points,
        "start": start,
    }
    if only_start:
        return found
    with metered(work.primitives) as meter:
        work.run()
    rounds = [(_spent(work.run), _spent(meter.floor)) for _ in range(REPEATS.get(name, USUAL))]
    run, floor = (min(times) for times in zip(*rounds, strict=True))
    ratios = [one / other for one, other in rounds]
    work.run()  # the state for the eigenvalues
    eigen, _ = timed(work.eigenvalues)
    return found | {
        "run_seconds": run,
        "floor_seconds": floor,
        "ratio": run / floor,
        "ratio_spread": max(ratios) / min(ratios) - 1,
        "ratio_asked": work.asked,
        "stages": {
            stage: {"calls": meter.calls[stage], "seconds": meter.seconds[stage]}
            for stage in STAGES
            if meter.calls[stage]
        },
        "eigenvalues_seconds": eigen,
        "peak_memory_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def _spent(run: Callable[[], Any]) -> float:
    """Processor time in seconds, because the machine may be busy with other work."""
    begun = time.process_time()
    run()
    return time.process_time() - begun


def print_bench(table: dict[str, Any], console: Console) -> None:
    """Print the benchmark with one column for each problem."""
    problems = table["problems"]
    shown = Table("", title=f"{table['ranks']} rank(s), {table['cores']} cores, load {table['load']:.1f}")
    for row in problems:
        shown.add_column(row["name"], justify="right")
    for head, text in ROWS.items():
        shown.add_row(head, *(text(row) for row in problems))
    for stage in STAGES:
        parts = [row["stages"].get(stage) for row in problems]
        shown.add_row(
            stage, *(f"{p['calls']} x {1e3 * p['seconds'] / p['calls']:.3g} ms" if p else "–" for p in parts)
        )
    console.print(shown)
    for row in problems:
        console.print(f"{row['name']}: {row['title']}", soft_wrap=True)
    console.print(
        "cold, warm: from the launch of a process to the end of its first run, without and with compiled "
        "forms. run: processor time of a second run of the branch. floor: processor time of the same "
        "assemblies, factorisations and solves alone. eigenvalues: the lowest three at its last state, with "
        "inertia.",
        soft_wrap=True,
    )


ROWS: dict[str, Callable[[dict[str, Any]], str]] = {
    "unknowns": lambda row: str(row["unknowns"]),
    "points": lambda row: str(row["points"]),
    "cold start": lambda row: duration(row["cold"]["total"]) if "cold" in row else "–",
    "warm start": lambda row: duration(row["start"]["total"]),
    "JIT": lambda row: duration(row["jit_seconds"]) if "cold" in row else "–",
    "run": lambda row: duration(row["run_seconds"]),
    "floor": lambda row: duration(row["floor_seconds"]),
    "run / floor": lambda row: fraction(row["ratio"]),
    "at most": lambda row: f"{row['ratio_asked']}{'' if row['ratio'] <= row['ratio_asked'] else ' (missed)'}",
    "eigenvalues": lambda row: duration(row["eigenvalues_seconds"]),
    "peak MiB": lambda row: f"{row['peak_memory_mib']:.0f}",
}
"""Lines of the table."""


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1], float(sys.argv[3]), sys.argv[2] != "whole")))
