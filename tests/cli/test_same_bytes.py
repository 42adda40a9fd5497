"""Two serial runs in separate processes write the same bytes."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SMALL = ["--mesh", "cells=16", "--mesh", "levels=2", "--mesh", "step=0.3"]
FLUID = ["--mesh", "cells=24", "--mesh", "levels=2", "--mesh", "step=1"]
BLOCKS = ["--mesh", "cells=4", "--mesh", "levels=2"]
STEP = ["--mesh", "step=0.3"]
REQUESTS = {
    "tube": [*SMALL, "--set", "u_end=2"],
    "tube_fold": [*SMALL, "--set", "delta1_end=1.3"],
    "circular": [*SMALL, "--set", "t_end=1"],
    "fluid_tube": [*FLUID, "--set", "n_max=1", "--set", "zw_end=0.7"],
    "wrinkled_tube": [*BLOCKS, "--set", "load=gas", "--set", "load_end=0.1"],
    "hemisphere": [*BLOCKS, "--set", "low_end=-0.82"],
    "wrinkled_patch": [],
    "sphere": STEP,
    "infinite_tube": STEP,
    "homogeneous": STEP,
}
"""Every problem with branches that takes seconds."""
TIMES = ("seconds", "wall_s", "started")


SOLVE_ALL = """
import json, sys
from weakforms.cli import main
requests = json.loads(sys.argv[1])
for problem, words in requests.items():
    sys.argv = ["weakforms", "solve", problem, *words, "--format", "csv", "--out", f"{problem}.csv"]
    try:
        main()
    except SystemExit as end:
        if end.code:
            raise
"""


@pytest.fixture(scope="module")
def twice(tmp_path_factory) -> tuple[Path, Path]:
    """Folders with the curves of two processes."""
    folders = tmp_path_factory.mktemp("first"), tmp_path_factory.mktemp("second")
    for folder in folders:
        done = subprocess.run(
            [sys.executable, "-P", "-c", SOLVE_ALL, json.dumps(REQUESTS)],
            cwd=folder,
            env=os.environ | {"PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
        )
        assert done.returncode == 0, done.stderr
    return folders


@pytest.mark.parametrize("problem", REQUESTS)
def test_curves(problem, twice):
    first, second = (folder / f"{problem}.csv" for folder in twice)
    assert first.read_bytes().count(b"\n") > 3
    assert first.read_bytes() == second.read_bytes()


def verified(out: Path) -> dict[str, object]:
    """The files that a run of a case stores, without dates and durations."""
    command = [sys.executable, "-P", "-m", "weakforms", "verify", "-k", "paper2.fig05", "--out", str(out)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    stored = sorted((out / "solutions").iterdir())
    found = {path.name: json.loads(path.read_text()) for path in [*stored, out / "report" / "report.json"]}
    return {name: timeless(data) for name, data in found.items()}


def timeless(data: object) -> object:
    if isinstance(data, list):
        return [timeless(item) for item in data]
    if isinstance(data, dict):
        return {key: timeless(value) for key, value in data.items() if key not in TIMES}
    return data


def test_verification(tmp_path):
    first = verified(tmp_path / "first")
    assert len(first) > 2
    assert json.dumps(verified(tmp_path / "second")) == json.dumps(first)
