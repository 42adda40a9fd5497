"""Run Python on several ranks, and the differences that its numbers may have."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from weakforms.results import Result
from weakforms.verification.audit.same import differences

ROOT = Path(__file__).resolve().parents[2]
TOLERANCE = 1e-9
"""Relative to each number's scale."""
TRACTIONS = ("traction_front", "traction_max", "f_t")
SLOPES = ("dzw_dV", "dzw_dr2", "dr_mean_dzw")
LOOSER = dict.fromkeys(("X_iso", "Lambda_B1", "Lambda_B2", "kappa", *TRACTIONS, *SLOPES), 1e-8)
"""Numbers that multiply round-off. ``X_iso`` is the place where lam1 - lam2 is 1e-4, and its slope there
is 1e-3. ``Lambda_B`` has the round-off of the shell's bending stiffness, which is far larger. ``kappa`` and
the axial traction of a patch hold second derivatives. Slopes at a bifurcation are differences of states whose
amplitudes are 0.02 apart, divided by the squares of the amplitudes: the same two ranks, which solved for one
wrinkled tube six times, found its slopes with a spread of 3e-9, and its level with one of 4e-15.
"""
FRICTIONLESS, OF_DEGREE_6 = 2e-7, 1e-6
"""Without friction that traction is zero, and round-off is all there is, on the cells of a small patch."""
LETTING_GO = 1e-6
"""Where a unilateral spring has just begun to let go, the block that it has left is 3e-6 of the length wide:
slopes in it multiply the round-off of positions."""


SERVER = """
import itertools, json, os, sys, time
from pathlib import Path
from mpi4py import MPI
from weakforms import solve

folder, comm = Path(sys.argv[1]), MPI.COMM_WORLD
cores = sorted(os.sched_getaffinity(0))
os.sched_setaffinity(0, {cores[comm.rank % len(cores)]})  # they may not wait for each other on one core
for number in itertools.count():
    asked = folder / f"{number}.json"
    while not asked.exists():  # a rank that waits in MPI would keep a core busy
        time.sleep(0.02)
    requests = json.loads(asked.read_text())
    found = [solve(**{**r, "at": [tuple(item) for item in r.get("at", [])]}).to_json() for r in requests]
    if comm.rank == 0:
        done = folder / f"{number}.done"
        done.with_suffix(".part").write_text(json.dumps([*found, comm.size]))
        done.with_suffix(".part").rename(done)
"""


def command(arguments: list[str], ranks: int) -> list[str]:
    """The command that runs Python on several ranks; an error on one rank ends all (mpi4py's runner)."""
    launch = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    return [*launch, sys.executable, "-m", "mpi4py", *arguments]


def environment(ranks: int) -> dict[str, str]:
    """The environment of that command.

    A rank that waits for another one keeps its core: if it let another process go first, each of thousands of
    messages would take a slice of the scheduler's time. Only more ranks than cores must let one another go.
    """
    crowded = ranks > len(os.sched_getaffinity(0))
    return os.environ | {
        "PYTHONPATH": str(ROOT),
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_btl": "self,sm",
        "OMPI_MCA_mpi_yield_when_idle": str(int(crowded)),
        "OMP_NUM_THREADS": "1",
    }


def start(arguments: list[str], ranks: int, timeout: float = 900) -> str:
    """Output of Python on several ranks."""
    done = subprocess.run(
        command(arguments, ranks),
        capture_output=True,
        text=True,
        env=environment(ranks),
        timeout=timeout,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


class Ranks:
    """Several ranks that solve one list of requests after the other.

    Starting them for each test, with all imports and forms, would take longer than most solves.

    Args:
        ranks: Their number.
    """

    def __init__(self, ranks: int) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self._told = open(Path(self._folder.name) / "output", "w+b")  # noqa: SIM115
        self._process = subprocess.Popen(
            command(["-c", SERVER, self._folder.name], ranks),
            stdin=subprocess.DEVNULL,
            stdout=self._told,
            stderr=subprocess.STDOUT,
            env=environment(ranks),
        )
        self._asked = 0

    @property
    def running(self) -> bool:
        """Whether they wait for requests."""
        return self._process.poll() is None

    def solve(self, requests: list[dict], timeout: float = 900) -> list[dict]:
        """Results of :func:`weakforms.solve` as JSON, and the number of ranks after them."""
        done = Path(self._folder.name) / f"{self._asked}.done"
        part = done.with_suffix(".asked")
        part.write_text(json.dumps(requests))
        part.rename(done.with_suffix(".json"))
        self._asked += 1
        end = time.monotonic() + timeout
        while not done.exists():
            if not self.running or time.monotonic() > end:
                self.end()
                self._told.seek(0)
                raise AssertionError(f"the ranks ended or hang: {self._told.read()[-4000:].decode()}")
            time.sleep(0.02)
        return json.loads(done.read_text())

    def end(self) -> None:
        """End them."""
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def allowed(place: str, spec: str) -> float:
    """Allowed difference of a number of a solution."""
    name = place.removesuffix(", uncertainty").split()[-1]
    if name in TRACTIONS and "contact=frictionless" in spec:
        return OF_DEGREE_6 if "degree=6" in spec else FRICTIONLESS
    if name in (*TRACTIONS, "line_force", "line_force_membrane") and "spring=unilateral" in spec:
        return LETTING_GO
    return LOOSER.get(name, TOLERANCE)


def beyond(first: Result, second: Result, also: Sequence[tuple[str, float]] = ()) -> list[str]:
    """The numbers of two results that differ by more than allowed, the largest difference first.

    Args:
        first: A result.
        second: The same on other ranks.
        also: Ends of names of numbers that may differ by more, and by how much.
    """
    said = {name: first.parameters.get(name) for name in ("contact", "spring")}
    spec = f"contact={said['contact']}, spring={said['spring']}, degree={first.numerics.get('degree')}"
    found = []
    for item in differences(first, second):
        more = [most for end, most in also if item.place.endswith(end)]
        if not item.relative <= max([allowed(item.place, spec), *more]):
            found.append(str(item))
    return found
