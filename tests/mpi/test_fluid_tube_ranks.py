"""The fluid-loaded tube: the same numbers serially and on two ranks."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = [pytest.mark.mpi, pytest.mark.paper3]

PROGRAM = """
import json
from mpi4py import MPI
from weakforms import solve
mesh = {"cells": 16, "degree": 4, "levels": 2}
short = solve("fluid_tube", n_max=1, zw_end=0.93, at=[("zw", 8.2), ("r_mid", 1.0)], numerics=mesh)
if MPI.COMM_WORLD.rank == 0:
    print("RESULT" + json.dumps([short.to_json(), MPI.COMM_WORLD.size]))
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


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs an MPI launcher")
def test_two_ranks_agree_with_one():
    (serial, one), (split, two) = run(1), run(2)
    assert (one, two) == (1, 2)
    a, b = serial["special_points"], split["special_points"]
    assert [p["kind"] for p in a] == [p["kind"] for p in b] == ["limit_point", "bifurcation_point"]
    for p, q in zip(a, b, strict=True):
        assert q["values"] == pytest.approx(p["values"], rel=1e-9, abs=1e-9)
    for p, q in zip(serial["states"], split["states"], strict=True):
        values = [{k: v["value"] for k, v in s["quantities"].items()} for s in (p, q)]
        assert values[1] == pytest.approx(values[0], rel=1e-9, abs=1e-9)
        for name, column in p["fields"][0]["columns"].items():
            assert q["fields"][0]["columns"][name] == pytest.approx(column, rel=1e-8, abs=1e-9)
    first, second = (r["branches"][0]["columns"] for r in (serial, split))
    assert first["n_negative"] == second["n_negative"]
    for name in ("zw", "V", "r_mid", "Lambda_n0", "Lambda_n1", "LambdaV_n0"):
        assert second[name] == pytest.approx(first[name], rel=1e-8, abs=1e-9)
