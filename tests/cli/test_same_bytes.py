"""Two serial runs in separate processes write the same bytes, but for dates and durations."""

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
CASE = "paper5.fig02"
"""A case with curves, claims and tables whose nineteen solutions take a second."""
TIMES = ("seconds", "wall_s", "started")


ALL = """
import json, sys
from weakforms.cli import main
from weakforms.verification.report import report

report._drawn = lambda *_: {}  # the pages show what report.json says
requests, case = json.loads(sys.argv[1]), sys.argv[2]
commands = [["solve", name, *words, "--out", f"{name}.json"] for name, words in requests.items()]
for words in [*commands, ["verify", "-k", case, "--out", "run"]]:
    sys.argv = ["weakforms", *words]
    try:
        main()
    except SystemExit as end:
        if end.code:
            raise
"""
"""Solves and verifies in one process, most of whose time would be the start of the others."""


@pytest.fixture(scope="module")
def twice(tmp_path_factory) -> tuple[Path, Path]:
    """Folders with the results and the run of two processes."""
    folders = tmp_path_factory.mktemp("first"), tmp_path_factory.mktemp("second")
    for folder in folders:
        done = subprocess.run(
            [sys.executable, "-P", "-c", ALL, json.dumps(REQUESTS), CASE],
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
def test_results(problem, twice):
    first, second = (timeless(json.loads((folder / f"{problem}.json").read_text())) for folder in twice)
    (branch, *_) = first["branches"]
    assert all(len(column) > 2 for column in branch["columns"].values())
    assert json.dumps(first) == json.dumps(second)


def verified(out: Path) -> dict[str, object]:
    """The files that a run of a case stores, without dates and durations."""
    stored = sorted((out / "solutions").iterdir())
    found = {path.name: json.loads(path.read_text()) for path in [*stored, out / "report" / "report.json"]}
    return {name: timeless(data) for name, data in found.items()}


def timeless(data: object) -> object:
    if isinstance(data, list):
        return [timeless(item) for item in data]
    if isinstance(data, dict):
        return {key: timeless(value) for key, value in data.items() if key not in TIMES}
    return data


def test_verification(twice):
    first, second = (verified(folder / "run") for folder in twice)
    assert len(first) > 2
    assert json.dumps(second) == json.dumps(first)
