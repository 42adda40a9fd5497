"""Solves on one rank and on two, and how their results are compared."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

PROGRAM = """
import json, sys
from mpi4py import MPI
from weakforms import solve
requests = json.loads(sys.argv[1])
found = [solve(**{**r, "at": [tuple(item) for item in r.get("at", [])]}).to_json() for r in requests]
if MPI.COMM_WORLD.rank == 0:
    print("RESULT" + json.dumps([*found, MPI.COMM_WORLD.size]))
"""


def run(requests: list[dict], ranks: int) -> list[dict]:
    """Results of :func:`weakforms.solve` at some requests, in a process of its own."""
    environment = os.environ | {
        "PYTHONPATH": str(ROOT),
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_btl": "self,sm",
        "OMPI_MCA_mpi_yield_when_idle": "1",  # there may be fewer cores than ranks
        "OMP_NUM_THREADS": "1",
    }
    launch = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run(
        # mpi4py's runner: an error on one rank ends all
        [*launch, sys.executable, "-m", "mpi4py", "-c", PROGRAM, json.dumps(requests)],
        capture_output=True,
        text=True,
        env=environment,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    line = next(text for text in done.stdout.splitlines() if text.startswith("RESULT"))
    *found, size = json.loads(line.removeprefix("RESULT"))
    assert size == ranks
    return found


@pytest.fixture
def same_on_two_ranks():
    """Calls :func:`run` on one rank and on two, and compares what comes out."""
    if shutil.which("mpirun") is None:
        pytest.skip("needs an MPI launcher")

    def check(requests: list[dict], rel: float = 1e-10, branches: bool = True) -> list[dict]:
        serial, split = run(requests, 1), run(requests, 2)
        for a, b in zip(serial, split, strict=True):
            assert a["failures"] == b["failures"] == []
            compare_points(a, b, rel)
            compare_states(a, b, rel)
            compare_quantities(a["quantities"], b["quantities"], rel)
            if branches:
                for p, q in zip(a["branches"], b["branches"], strict=True):
                    compare_branches(p["columns"], q["columns"], rel)
        return serial

    return check


def compare_points(a, b, rel):
    assert [p["kind"] for p in a["special_points"]] == [p["kind"] for p in b["special_points"]]
    for p, q in zip(a["special_points"], b["special_points"], strict=True):
        assert q["values"] == pytest.approx(p["values"], rel=rel, abs=rel)


def compare_states(a, b, rel):
    for p, q in zip(a["states"], b["states"], strict=True):
        compare_quantities(p["quantities"], q["quantities"], rel)
        for f, g in zip(p["fields"], q["fields"], strict=True):
            for name, column in f["columns"].items():
                assert g["columns"][name] == pytest.approx(column, rel=10 * rel, abs=10 * rel)


def compare_quantities(a, b, rel):
    values = [{name: q["value"] for name, q in some.items()} for some in (a, b)]
    assert values[1] == pytest.approx(values[0], rel=rel, abs=rel)


def compare_branches(a, b, rel):
    assert a["n_negative"] == b["n_negative"]
    for name in set(a) - {"residual", "iterations"}:
        assert b[name] == pytest.approx(a[name], rel=rel, abs=rel, nan_ok=True)
