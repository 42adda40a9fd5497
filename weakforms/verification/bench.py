"""The benchmark: time and memory by stage, for fixed problems, warm and cold."""

from __future__ import annotations

import resource
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from weakforms.verification.summary import duration

CELLS, DEGREE, STEP = 150, 4, 0.07
"""A free tube of 1200 unknowns, traced to ``u_max = 5`` in about 120 points."""


def run_bench(progress: Callable[[str, int, int], None] = lambda *_: None) -> dict[str, Any]:
    """Run the benchmark on all ranks of the world.

    Returns:
        Rows with stage, seconds and counts; versions; peak memory.
    """
    from mpi4py import MPI

    from weakforms.problems.tube import TubeMesh, fold_line, formulation, free_branch
    from weakforms.solvers.provenance import versions
    from weakforms.solvers.system import System

    comm = MPI.COMM_WORLD
    rows: list[dict[str, Any]] = []

    def timed(stage: str, run: Callable[[], Any], **counts: Any) -> Any:
        progress(stage, len(rows), 12)
        comm.Barrier()
        begun = time.perf_counter()
        outcome = run()
        rows.append({"stage": stage, "seconds": time.perf_counter() - begun, **counts})
        return outcome

    mesh = TubeMesh(CELLS, DEGREE, 0.6)

    def build() -> System:
        return System(formulation(comm, 0.1, 1.0, 6.0, mesh))

    for temperature in ("first", "warm"):
        system = timed(f"set up, {temperature}", build)
        branch = timed(f"branch, {temperature}", lambda s=system: free_branch(s, 1.0, 5.0, STEP))
        rows[-1]["points"] = len(branch.points)
        rows[-1]["factorizations"] = branch.solver.factor.count
        timed(f"both limit points, {temperature}", branch.special)
        line = timed(f"fold line, {temperature}", lambda b=branch: fold_line(b, 3.0, 0.1))
        rows[-1]["points"] = len(line.points)
        timed(f"cusp, {temperature}", line.special)
    rows.append(_floor(system, branch))
    return {
        "unknowns": system.matrix.getSize()[0],
        "ranks": comm.size,
        "rows": rows,
        "peak_memory_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "versions": versions(),
    }


def _floor(system: Any, branch: Any) -> dict[str, Any]:
    """The bare cost of the branch: as many assemblies and factorisations, called directly."""
    factor = branch.solver.factor
    residuals = int(np.sum(branch.columns()["iterations"] + 1))
    begun = time.perf_counter()
    for _ in range(2 * len(branch.points)):
        factor.update()
    for _ in range(residuals):
        factor.solve(system.residual())
    seconds = time.perf_counter() - begun
    return {"stage": "floor of the branch", "seconds": seconds, "residuals": residuals}


def print_bench(table: dict[str, Any], console: Console) -> None:
    """The benchmark for people."""
    shown = Table("stage", "time", "counts", title=f"{table['unknowns']} unknowns, {table['ranks']} rank(s)")
    for row in table["rows"]:
        counts = ", ".join(f"{k} {v}" for k, v in row.items() if k not in ("stage", "seconds"))
        shown.add_row(row["stage"], duration(row["seconds"]), counts)
    console.print(shown)
    console.print(f"peak memory {table['peak_memory_mib']:.0f} MiB")
