"""The benchmark's table: its stages, its least possible times, and unknown names."""

import json
import time

import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.problems.triangles.branch import SurfaceRun
from weakforms.problems.triangles.meshes import tube
from weakforms.problems.triangles.model import Body, SurfaceModel
from weakforms.problems.wrinkled.problem import PAPER_GAMMA
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.verification.audit import bench, bench_ranks, bench_surface, bench_work


@pytest.fixture
def small(monkeypatch):
    """The tube on a coarse mesh, measured in this process."""
    monkeypatch.setattr(bench_work.Tube, "cells", 16)
    monkeypatch.setattr(
        bench, "_in_a_process", lambda name, kind: bench.measure(name, time.time(), kind != "whole")
    )


def test_bench_has_its_stages(weakforms, small):
    called = weakforms("bench", "--json", "--only", "tube")
    data = json.loads(called.out)
    (row,) = data["problems"]
    assert (called.status, data["ranks"], row["name"]) == (0, 1, "tube")
    assert row["points"] > 50
    assert set(row["stages"]) == set(bench.STAGES)
    assert all(stage["seconds"] > 0 and stage["calls"] >= 50 for stage in row["stages"].values())
    assert row["ratio"] == pytest.approx(row["run_seconds"] / row["floor_seconds"])
    assert row["ratio"] > 0.7
    assert {"imports", "set_up", "first_run", "total"} == set(row["start"]) == set(row["cold"])
    shown = " ".join(weakforms("bench", "--only", "tube", "--no-cold").out.split())
    assert "factorisation" in shown
    assert "floor" in shown


def test_a_run_is_held_against_the_last_one_by_its_ratios(weakforms, small, monkeypatch, tmp_path):
    row = bench.measure("tube", time.time(), False) | {"ratio": 2.0, "ratio_spread": 0.1}
    monkeypatch.setattr(bench, "_in_a_process", lambda *_: dict(row))
    file, words = tmp_path / "bench.jsonl", ("bench", "--only", "tube", "--no-cold")
    assert weakforms(*words, "--history", str(file)).status == 0
    (line,) = map(json.loads, file.read_text("utf-8").splitlines())
    assert line["machine"]["cores"]
    assert "petsc" in line["versions"]
    known = line["problems"]["tube"]
    for factor, status, word in ((0.5, 1, "slower"), (1.0, 0, "as before"), (2.0, 0, "faster")):
        line["problems"]["tube"] = known | {"ratio": factor * known["ratio"], "ratio_spread": 0.0}
        file.write_text(json.dumps(line) + "\n", "utf-8")
        called = weakforms(*words, "--against", str(file))
        assert (called.status, f"now: {word}" in " ".join(called.out.split())) == (status, True)
    file.write_text("{}\n", "utf-8")
    called = weakforms(*words, "--against", str(file))
    assert (called.status, "is no history of the benchmark" in called.err) == (2, True)


def test_the_surface_is_measured_at_the_level_that_is_stated(monkeypatch):
    monkeypatch.setattr(bench_surface.Tube, "FIRST", (8, 12))
    table = bench_surface.run_surface_bench(1)
    (row,) = table["rows"]
    body = Body(tube(8.0, 8, 12), M=1.5, delta=3.0, Af=0.4362, c2=0.01, gamma=PAPER_GAMMA)
    run = SurfaceRun(SurfaceModel(MPI.COMM_SELF, body), "zw", {"p": 0.0, "zw": 0.0})
    for level in (2.0, 4.0):
        point = run.at(level)
    assert table["title"].endswith("zw = 4")
    assert row["V"] == pytest.approx(run.columns(point, 0)["V"], rel=1e-9)


def test_the_square_is_measured_at_the_height_that_is_stated(monkeypatch):
    monkeypatch.setattr(bench_surface.Square, "FIRST", 4)
    table = bench_surface.run_surface_bench(2100, body="square")
    assert [row["mesh"] for row in table["rows"]] == ["4 x 4", "8 x 8", "9 x 9"]
    assert [row["unknowns"] for row in table["rows"]] == [435, 1635, 2055]
    mesh = {"cells": 8, "levels": 2, "step": 0.4}
    solved = solve("rectangle", load="gas", w_end=0.9, at=[("w_c", 0.8)], numerics=mesh)
    (state,) = solved.states
    row = table["rows"][1]
    assert table["title"].endswith("w_c = 0.8")
    assert row["V"] == pytest.approx(state.quantities["V"].value, rel=1e-9)
    assert row["n_negative"] == state.quantities["n_negative"].value == 0


def test_a_run_of_surfaces_is_added_to_a_file(weakforms, tmp_path, monkeypatch):
    monkeypatch.setattr(bench_surface.Square, "FIRST", 2)
    path = tmp_path / "scaling.jsonl"
    called = weakforms("bench", "--surface", "500", "--body", "square", "--history", str(path))
    assert (called.status, len(path.read_text().splitlines())) == (0, 1)
    (run,) = bench_ranks.load(path)
    assert run.rows[0].unknowns == json.loads(path.read_text())["rows"][0]["unknowns"]
    assert run.machine["cores"]


def test_unknown_problem_is_one_line(weakforms):
    called = weakforms("bench", "--only", "bridge")
    assert (called.status, called.err.count("\n")) == (2, 1)
    assert "'bridge'; it has tube, bent" in called.err


def test_the_floor_factorises_as_often_as_the_run(small, monkeypatch):
    work = bench_work.Tube()
    work.set_up(MPI.COMM_WORLD)
    with bench_work.metered(work.primitives) as meter:
        work.run()
    done, right = [], Factorization.refactor
    states = []

    def watched(self: Factorization) -> None:
        states.append(self.system.matrix.stateGet())
        done.append(right(self))

    for key, (count, _) in list(meter.again.items()):
        if key[0] is right:
            given = next(
                cell.cell_contents
                for cell in meter.again[key][1].__closure__
                if isinstance(cell.cell_contents, tuple)
            )
            meter.again[key] = (count, meter._repeated("factorisation", watched, given, {}))
    meter.floor()
    assert len(done) == meter.calls["factorisation"] > 100
    assert len(set(states)) == len(states), "PETSc factorises only a matrix that has changed"
