"""The benchmark of the triangulated tube: a refinement with time and memory by stage."""

from __future__ import annotations

import resource
import time
from typing import Any

from rich.console import Console
from rich.table import Table

from weakforms.terminal import WorkProgress

ROWS, COLUMNS = 40, 96
"""Quadrilaterals along and around on the first mesh; each further mesh doubles one of them in turn, and the
last one has as many along as the number of unknowns allows, if that is worth another mesh."""

WORTH = 1.25
"""Ratio of unknowns by which one mesh exceeds the mesh before at least."""

LEVELS = (0.5, 3.0, 4.0)
"""Loads of the states; the last one is measured."""

EIGENVALUES = 3
"""Number of lowest eigenvalues."""


def run_surface_bench(unknowns: int, progress: WorkProgress | None = None) -> dict[str, Any]:
    """Meshes of the tube up to a number of unknowns: equilibrium, inertia and eigenvalues at ``zw = 4``.

    Args:
        unknowns: Largest number of degrees of freedom.
        progress: Called with the mesh, the number of finished meshes, and the number of meshes; a finished
            mesh is a line.

    Returns:
        A row for each mesh: its size, seconds by stage, peak memory so far over all ranks, and the numbers.
    """
    from mpi4py import MPI

    from weakforms.problems.triangles.branch import SurfaceRun
    from weakforms.problems.triangles.meshes import tube
    from weakforms.problems.triangles.model import Body, SurfaceModel
    from weakforms.problems.wrinkled.problem import PAPER_GAMMA
    from weakforms.solvers.support.provenance import versions

    comm, meshes = MPI.COMM_WORLD, [(ROWS, COLUMNS)]
    while 3 * (meshes[-1][0] + 1) * meshes[-1][1] < unknowns / 2:
        rows, columns = meshes[-1]
        meshes.append((2 * rows, columns) if len(meshes) % 2 else (rows, 2 * columns))
    rows, columns = unknowns // (3 * meshes[-1][1]) - 1, meshes[-1][1]
    if rows > WORTH * meshes[-1][0]:
        meshes.append((rows, columns))
    table, progress = [], progress or WorkProgress()
    for i, (rows, columns) in enumerate(meshes):
        progress(f"{rows} x {columns}", i, len(meshes))
        row: dict[str, Any] = {"mesh": f"{rows} x {columns}", "unknowns": 3 * (rows + 1) * columns}
        begun = time.perf_counter()

        def lap(stage: str, row: dict[str, Any] = row) -> None:
            nonlocal begun
            comm.Barrier()
            row[stage] = time.perf_counter() - begun
            begun = time.perf_counter()

        body = Body(tube(8.0, rows, columns), M=1.5, delta=3.0, Af=0.4362, c2=0.01, gamma=PAPER_GAMMA)
        run = SurfaceRun(SurfaceModel(comm, body), "zw", {"p": 0.0, "zw": 0.0})
        lap("set_up_s")
        for level in LEVELS:
            run.at(level)
        lap("states_s")
        point = run.at(LEVELS[-1])
        with run.system.at(point.state):
            run.stability.factor.update()
        point.n_negative = run.stability.factor.negative_count()
        lap("inertia_s")
        values = run.columns(point, EIGENVALUES)
        lap("lowest_s")
        row |= {name: values[name] for name in ("n_negative", "Lambda_1", "V", "residual")}
        row["peak_mib"] = comm.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) / 1024
        del run, point  # before the next mesh needs the memory
        table.append(row)
        progress.line(
            ", ".join(f"{name} {text}" for name, text in zip(HEADINGS.values(), _texts(row), strict=True))
        )
    return {"ranks": comm.size, "zw": LEVELS[-1], "rows": table, "versions": versions()}


HEADINGS = {"mesh": "mesh", "unknowns": "unknowns", "set_up_s": "set up", "states_s": "states"}
HEADINGS |= {
    "inertia_s": "inertia",
    "lowest_s": f"lowest {EIGENVALUES}",
    "peak_mib": "memory",
    "n_negative": "negative",
}
HEADINGS |= {"Lambda_1": "Lambda_1"}
DIGITS = {"Lambda_1": 6, "peak_mib": 4}


def _texts(row: dict[str, Any]) -> list[str]:
    return [f"{v:.{DIGITS.get(n, 3)}g}" if isinstance(v := row[n], float) else str(v) for n in HEADINGS]


def print_surface_bench(table: dict[str, Any], console: Console) -> None:
    """Print the refinement as a table."""
    title = f"Tube on flat triangles, zw = {table['zw']:g}, {table['ranks']} rank(s); seconds, MiB"
    shown = Table(title=title, box=None, padding=(0, 1, 0, 0))
    for heading in HEADINGS.values():
        shown.add_column(heading, no_wrap=True)
    for row in table["rows"]:
        shown.add_row(*_texts(row))
    console.print(shown)
