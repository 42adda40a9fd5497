"""The same numbers serially and on several ranks."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = [pytest.mark.mpi, pytest.mark.paper2]

PROGRAM = """
import json
from mpi4py import MPI
from weakforms import solve
mesh = {"cells": 32, "degree": 3, "levels": 2}
tube = solve("tube", alpha=0.1, delta1=1.1, at=[("p", 1.85), ("u_max", 3.0)], numerics=mesh)
fold = solve("tube_fold", alpha=0.1, numerics=mesh)
touching = solve("tube", contact="frictionless", p_end=1.6, at={"p": 1.5}, numerics=mesh)
if MPI.COMM_WORLD.rank == 0:
    print("RESULT" + json.dumps([tube.to_json(), fold.to_json(), touching.to_json(), MPI.COMM_WORLD.size]))
"""


def run(ranks):
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
        [*launch, sys.executable, "-m", "mpi4py", "-c", PROGRAM],  # an error on one rank ends all
        capture_output=True,
        text=True,
        env=environment,
        timeout=480,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    line = next(text for text in done.stdout.splitlines() if text.startswith("RESULT"))
    return json.loads(line.removeprefix("RESULT"))


@pytest.fixture(scope="module")
def serial():
    return run(1)


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs an MPI launcher")
@pytest.mark.parametrize("ranks", [2])
def test_ranks_agree_to_1e_10(ranks, serial):
    *expected, one = serial
    *found, several = run(ranks)
    assert (one, several) == (1, ranks)
    for a, b in zip(expected, found, strict=True):
        compare_points(a, b)
        compare_states(a, b)
        if a["parameters"].get("contact", "none") == "none":
            # The line force of a small patch is a difference of forces, zero but for their round-off.
            compare_branches(a["branches"][0]["columns"], b["branches"][0]["columns"])


def compare_points(a, b):
    assert [p["kind"] for p in a["special_points"]] == [p["kind"] for p in b["special_points"]]
    for p, q in zip(a["special_points"], b["special_points"], strict=True):
        assert q["values"] == pytest.approx(p["values"], rel=1e-10)


def compare_states(a, b):
    for p, q in zip(a["states"], b["states"], strict=True):
        values = [{k: v["value"] for k, v in s["quantities"].items()} for s in (p, q)]
        assert values[1] == pytest.approx(values[0], rel=1e-10, abs=1e-10)
        for name, column in p["fields"][0]["columns"].items():
            assert q["fields"][0]["columns"][name] == pytest.approx(column, rel=1e-9, abs=1e-10)


def compare_branches(a, b):
    assert a["n_negative"] == b["n_negative"]
    for name in set(a) - {"residual", "iterations"}:
        assert b[name] == pytest.approx(a[name], rel=1e-10, abs=1e-10)
