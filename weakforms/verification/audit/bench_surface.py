"""The benchmark of large surfaces: a refinement with time and memory by stage."""

from __future__ import annotations

import os
import resource
import time
from math import isqrt
from typing import Any, ClassVar, Protocol

from mpi4py import MPI
from rich.console import Console
from rich.table import Table

from weakforms.terminal import WorkProgress

WORTH = 1.25
"""Ratio of unknowns by which one mesh exceeds the mesh before at least."""

EIGENVALUES = 3
"""Number of lowest eigenvalues."""


class Surface(Protocol):
    """What is measured on one mesh."""

    title: ClassVar[str]

    def states(self) -> None:
        """Solve for three states; the last one is measured."""

    def inertia(self) -> int:
        """Number of negative eigenvalues there, by a factorisation."""

    def lowest(self) -> dict[str, float]:
        """``Lambda_1`` of the lowest eigenvalues there, and the volume ``V``."""


class Tube:
    """The tube on flat triangles under a liquid.

    Args:
        comm: Ranks.
        size: Quadrilaterals along and around.
    """

    title = "Tube on flat triangles, zw = 4"
    FIRST: ClassVar = 40, 96
    LEVELS: ClassVar = 0.5, 3.0, 4.0

    def __init__(self, comm: MPI.Intracomm, size: tuple[int, int]) -> None:
        from weakforms.problems.triangles.branch import SurfaceRun
        from weakforms.problems.triangles.meshes import tube
        from weakforms.problems.triangles.model import Body, SurfaceModel
        from weakforms.problems.wrinkled.problem import PAPER_GAMMA

        body = Body(tube(8.0, *size), M=1.5, delta=3.0, Af=0.4362, c2=0.01, gamma=PAPER_GAMMA)
        self._run = SurfaceRun(SurfaceModel(comm, body), "zw", {"p": 0.0, "zw": 0.0})

    @staticmethod
    def sizes(unknowns: int) -> list[tuple[int, int]]:
        """Meshes from the first one on: each doubles one number in turn, the last one fills what is left."""
        found = [Tube.FIRST]
        while Tube.unknowns(found[-1]) < unknowns / 2:
            rows, columns = found[-1]
            found.append((2 * rows, columns) if len(found) % 2 else (rows, 2 * columns))
        rows, columns = unknowns // (3 * found[-1][1]) - 1, found[-1][1]
        return [*found, (rows, columns)] if rows > WORTH * found[-1][0] else found

    @staticmethod
    def unknowns(size: tuple[int, int]) -> int:
        """Their number on a mesh."""
        return 3 * (size[0] + 1) * size[1]

    def states(self) -> None:
        """Solve at three levels of the liquid."""
        for level in self.LEVELS:
            self._run.at(level)

    def inertia(self) -> int:
        """Number of negative eigenvalues at the last level."""
        run = self._run
        self._point = run.at(self.LEVELS[-1])
        with run.system.at(self._point.state):
            run.stability.factor.update()
        self._point.n_negative = run.stability.factor.negative_count()
        return self._point.n_negative

    def lowest(self) -> dict[str, float]:
        """The lowest eigenvalue and the volume."""
        return self._run.columns(self._point, EIGENVALUES)


class Square:
    """The quarter of a square sheet of quadratic triangles under gas, with the relaxed energy.

    Args:
        comm: Ranks.
        size: Squares along half a side, twice.
    """

    title = "Quarter of a square sheet, quadratic triangles, w_c = 0.8"
    FIRST: ClassVar = 16
    HEIGHTS: ClassVar = 0.3, 0.6, 0.8

    def __init__(self, comm: MPI.Intracomm, size: tuple[int, int]) -> None:
        from weakforms.problems.rectangle.model import RectangleModel
        from weakforms.problems.rectangle.parameters import RectangleParameters
        from weakforms.solvers.equilibrium.newton import ExtendedNewton
        from weakforms.solvers.stability.lowest import Lowest

        self._model = RectangleModel(comm, RectangleParameters(load="gas").sheet(size[0], degree=2))
        self._solver = ExtendedNewton(self._model.system, ["p"])
        self._lowest = Lowest(self._model.system, factor=self._solver.factor)

    @staticmethod
    def sizes(unknowns: int) -> list[tuple[int, int]]:
        """Meshes from the first one on: each has twice as many each way, the last one fills what is left."""
        found = [Square.FIRST]
        while Square.unknowns((2 * found[-1],) * 2) <= unknowns:
            found.append(2 * found[-1])
        last = (isqrt((2 * unknowns - 3) // 3) - 1) // 4
        return [(n, n) for n in ([*found, last] if last**2 > WORTH * found[-1] ** 2 else found)]

    @staticmethod
    def unknowns(size: tuple[int, int]) -> int:
        """Their number on a mesh."""
        return 3 * (8 * size[0] ** 2 + 4 * size[0] + 1)

    def states(self) -> None:
        """Solve at three heights of the centre."""
        from weakforms.problems.rectangle.start import states_at

        *_, self._state = states_at(self._model, self._solver, self.HEIGHTS)

    def inertia(self) -> int:
        """Number of negative eigenvalues at the last height."""
        with self._model.system.at(self._state):
            self._solver.factor.update()
        self._negative = self._solver.factor.negative_count()
        return self._negative

    def lowest(self) -> dict[str, float]:
        """The lowest eigenvalue and the volume."""
        modes = self._lowest(self._state, EIGENVALUES, self._negative)
        with self._model.system.at(self._state):
            return {"Lambda_1": modes[0].eigenvalue, "V": self._model.system.monitor("V")}


BODIES = {"tube": Tube, "square": Square}


def run_surface_bench(
    unknowns: int, progress: WorkProgress | None = None, body: str = "tube"
) -> dict[str, Any]:
    """Meshes of one body up to a number of unknowns: equilibrium, inertia and eigenvalues.

    Args:
        unknowns: Largest number of degrees of freedom.
        progress: Called with the mesh, the number of finished meshes, and the number of meshes; a finished
            mesh is a line.
        body: ``tube`` or ``square``.

    Returns:
        A row for each mesh: its size, seconds by stage, peak memory so far over all ranks, and the numbers.
    """
    from weakforms.solvers.support.provenance import versions
    from weakforms.verification.run.machine import environment

    kind, comm, progress = BODIES[body], MPI.COMM_WORLD, progress or WorkProgress()
    meshes, table = kind.sizes(unknowns), []
    for i, size in enumerate(meshes):
        mesh = " x ".join(map(str, size))
        progress(mesh, i, len(meshes))
        row: dict[str, Any] = {"mesh": mesh, "unknowns": kind.unknowns(size)}
        begun = time.perf_counter()

        def lap(stage: str, row: dict[str, Any] = row) -> None:
            nonlocal begun
            comm.Barrier()
            row[stage] = time.perf_counter() - begun
            begun = time.perf_counter()

        surface: Surface = kind(comm, size)
        lap("set_up_s")
        surface.states()
        lap("states_s")
        row["n_negative"] = surface.inertia()
        lap("inertia_s")
        row |= {name: value for name, value in surface.lowest().items() if name in ("Lambda_1", "V")}
        lap("lowest_s")
        row["peak_mib"] = comm.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) / 1024
        del surface  # before the next mesh needs the memory
        table.append(row)
        progress.line(
            ", ".join(f"{name} {text}" for name, text in zip(HEADINGS.values(), _texts(row), strict=True))
        )
    about = {"ranks": comm.size, "title": kind.title, "machine": environment(), "load": os.getloadavg()[0]}
    return {**about, "rows": table, "versions": versions()}


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
    title = f"{table['title']}, {table['ranks']} rank(s); seconds, MiB"
    shown = Table(title=title, box=None, padding=(0, 1, 0, 0))
    for heading in HEADINGS.values():
        shown.add_column(heading, no_wrap=True)
    for row in table["rows"]:
        shown.add_row(*_texts(row))
    console.print(shown)
