"""``sweep``: all combinations of parameters, one table, resumable."""

import csv
import json
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import weakforms as package
from weakforms import InputError, solve
from weakforms.problems import registry
from weakforms.verification.cases.specs import At
from weakforms.verification.run import sweep as sweeps

MESH = ("--mesh", "cells=32", "--mesh", "levels=2")
FEW = {"cells": 32, "levels": 2}


def table(folder: Path) -> list[dict[str, str]]:
    with (folder / "sweep.csv").open() as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def swept(weakforms, tmp_path_factory):
    out = tmp_path_factory.mktemp("sweep") / "out"
    called = weakforms(
        "sweep", "tube", "delta1=1.1:1.2:0.1", "u_end=3", "--at", "u_max=1", *MESH, "--out", out
    )
    return called, out


def test_each_special_point_and_state_of_each_combination_is_a_row(swept):
    called, out = swept
    assert (called.status, called.complaints) == (0, [])
    rows = [(row["delta1"], row["what"], row["number"]) for row in table(out) if row["what"] != "end"]
    assert rows == [
        ("1.1", "limit_point", "1"),
        ("1.1", "limit_point", "2"),
        ("1.1", "state at u_max = 1", "1"),
        ("1.2", "state at u_max = 1", "1"),
    ]
    assert "2 combinations, 0 failed" in called.out


def test_the_numbers_are_those_of_single_solves(swept):
    alone = solve("tube", delta1=1.1, u_end=3, at={"u_max": 1}, numerics=FEW)
    rows = [row for row in table(swept[1]) if row["delta1"] == "1.1"]
    points = [row for row in rows if row["what"] == "limit_point"]
    assert [float(row["p"]) for row in points] == [q.values["p"] for q in alone.points("limit_point")]
    assert [float(row["p_uncertainty"]) for row in points] == [
        q.uncertainty["p"] for q in alone.points("limit_point")
    ]
    (state,) = [row for row in rows if row["what"].startswith("state")]
    assert float(state["V"]) == alone.states[0].quantities["V"].value


def test_the_end_of_every_branch_is_a_row(swept):
    ends = [row["reason"] for row in table(swept[1]) if row["what"] == "end"]
    assert ends == ["u_max = 3 (u_end)"] * 2


def test_an_interrupted_sweep_continues(weakforms, swept, monkeypatch):
    _, out = swept
    before = (out / "sweep.csv").read_text()
    stored = sorted((out / "solutions").glob("*.json"))
    stored[0].unlink()
    tasks = []
    task = sweeps._task
    monkeypatch.setattr(sweeps, "_task", lambda *given: tasks.append(given) or task(*given))
    words = ("sweep", "tube", "delta1=1.1:1.2:0.1", "u_end=3", "--at", "u_max=1", *MESH, "--out", out)
    assert weakforms(*words, "--resume").status == 0
    assert len(tasks) == 1
    assert (out / "sweep.csv").read_text() == before


def test_a_sweep_in_parallel_gives_the_same_table(weakforms, swept, tmp_path):
    words = (
        "sweep",
        "tube",
        "delta1=1.1:1.2:0.1",
        "u_end=3",
        "--at",
        "u_max=1",
        *MESH,
        "--out",
        tmp_path / "o",
    )
    assert weakforms(*words, "-j", 2).status == 0
    assert (tmp_path / "o" / "sweep.csv").read_text() == (swept[1] / "sweep.csv").read_text()


def test_a_state_that_some_combinations_lack_keeps_their_special_points(weakforms, tmp_path):
    at = ("--at", "p=1.9", "--crossing", 2)
    called = weakforms("sweep", "tube", "delta1=1.1:1.15:0.05", *at, *MESH, "--out", tmp_path / "o")
    assert called.status == 3
    rows = [(row["delta1"], row["what"]) for row in table(tmp_path / "o") if row["what"] != "end"]
    both = ["limit_point", "limit_point"]
    assert rows == [
        *(("1.1", what) for what in [*both, "state at p = 1.9"]),
        *(("1.15", what) for what in [*both, "failed"]),
    ]
    assert "taken once on this branch" in called.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("tube delta1=1.1", "at least one parameter several values"),
        ("tube delta1=1:2", "range '1:2': FIRST:LAST:STEP is wanted"),
        ("tube delta1=1:2:0", "FIRST:LAST:STEP"),
        ("tube delta1=2:1:0.1", "FIRST:LAST:STEP"),
        ("tube delta1=1:nan:0.1", "FIRST:LAST:STEP"),
        ("tube delta1=1:2:1e-9", "allowed: up to 10000"),
        ("tube delta1=1:2:0.01 lf=4:6:0.01", "more than 10000 combinations"),
        ("tube delta1=4:6:1", "delta1 = 6.0"),
        ("tube delta=1:2:0.5", "did you mean 'delta1'?"),
        ("tub delta1=1:2:0.5", "did you mean 'tube'?"),
        ("tube delta1=1:2:0.5 delta1=3", "delta1 is given twice"),
        ("tube delta1=1:2:0.5 lf", "NAME=VALUE is wanted"),
        ("tube delta1=1:2:0.5 --at p=x", "must be a number"),
        ("tube u_end=1:2:0.5 --at u_max=1.2", "u_max = 1.2 lies beyond u_end = 1"),
    ],
)
def test_every_combination_is_checked_before_anything_is_solved(
    weakforms, tmp_path, monkeypatch, words, said
):
    monkeypatch.setattr(type(registry.get("tube")), "solve", lambda *_, **__: pytest.fail("it was solved"))
    called = weakforms("sweep", *words.split(), "--out", tmp_path / "o")
    assert (called.status, called.out) == (2, "")
    assert len(called.complaints) == 1
    assert said in called.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("1:1.2:0.1", [1.0, 1.1, 1.2]),
        ("0:1:0.3", [0.0, 0.3, 0.6, 0.9]),
        ("2:1:-0.5", [2.0, 1.5, 1.0]),
        ("1:1:1", [1.0]),
        ("0.1:0.7:0.1", [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]),
        ("adhesive", None),
    ],
)
def test_a_range_holds_both_ends(text, values):
    assert sweeps.span(text) == values


def test_python_sweeps_lists_and_arrays_and_stores_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = package.sweep("material", l1=[1.2, 1.4], l2=np.array([1.5]), at=())
    assert done.complete
    assert sorted(done.results) == [(1.2, 1.5), (1.4, 1.5)]
    assert {row["what"] for row in done.rows()} == {"quantities"}
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(InputError, match="several values"):
        package.sweep("material", l1=[])


def test_python_names_states_as_cases_do():
    done = package.sweep("sphere", lam_end=[2.0, 3.0], at=[At("lam", 1.5)])
    assert [row["lam"] for row in done.rows() if row["what"].startswith("state")] == pytest.approx([1.5, 1.5])


def test_parquet_is_written_where_it_can_be(tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    package.sweep("material", tmp_path, l1=[1.2, 1.4])
    assert list(pandas.read_parquet(tmp_path / "sweep.parquet")["l1"]) == [1.2, 1.4]


def test_parquet_appears_only_when_it_is_complete(tmp_path, monkeypatch):
    """With a writer that stands in for pyarrow's, which Debian does not have."""
    pandas, seen = pytest.importorskip("pandas"), []

    def to_parquet(frame, path):
        seen.append((path.name, sorted(p.name for p in tmp_path.iterdir() if "parquet" in p.name)))
        path.write_text(frame["l1"].to_json())

    monkeypatch.setitem(sys.modules, "pyarrow", ModuleType("pyarrow"))
    monkeypatch.setattr(pandas.DataFrame, "to_parquet", to_parquet)
    package.sweep("material", tmp_path, l1=[1.2, 1.4])
    assert seen == [(".sweep.parquet.part", [])]
    assert json.loads((tmp_path / "sweep.parquet").read_text()) == {"0": 1.2, "1": 1.4}


def test_without_pandas_the_table_is_csv_alone(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    package.sweep("material", tmp_path, l1=[1.2, 1.4])
    assert sorted(p.name for p in tmp_path.iterdir()) == ["solutions", "sweep.csv", "times.json"]
