"""What `solve` finds and writes: points with uncertainties, states, files, and what did not converge."""

import csv
import io
import json
import math

import numpy as np
import pytest

from weakforms import api
from weakforms.errors import ConvergenceError
from weakforms.problems.tube import model as tube_module
from weakforms.results import load_result, validate
from weakforms.solvers.continuation.continuation import StepControl
from weakforms.verification.cases import references

TUBE = ("solve", "tube", "--set", "contact=none", "--set", "alpha=0.1", "--set", "delta1=1.1")
COARSE = ("--mesh", "cells=32", "--mesh", "levels=2")
CASE, CURVE = "paper2.fig03", "fig03a_delta1_1.1"
SHORT = ("--set", "u_end=0.5", *COARSE)


# -- solve ---------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def result(weakforms, tmp_path_factory):
    path = tmp_path_factory.mktemp("solve") / "r.json"
    wanted = ("--at", "u_max=2", "--at", "limit_point=1", "--at", "V=20")
    called = weakforms(*TUBE, *wanted, "--out", path)
    assert (called.status, called.out, called.complaints) == (0, "", [])
    assert list(path.parent.iterdir()) == [path]
    return path


def test_solve_gives_both_limit_points_with_uncertainties(result):
    found = load_result(result)  # validated
    table = references.load(2, "limit_points_alpha_0.1")
    rows = np.flatnonzero(table.columns["delta1"] == 1.1)
    points = found.points("limit_point")
    assert len(points) == len(rows) == 2
    for point, row in zip(points, rows, strict=True):
        assert abs(point.values["p"] / table.columns["p"][row] - 1) < 1e-8
        for name in ("p", "u_max", "V"):
            assert 0 < point.uncertainty[name] < 1e-6
    assert found.parameters["contact"] == "none"
    assert found.parameters["lf"] == 6.0  # a default
    assert {"dolfinx", "petsc", "git", "ranks"} <= set(found.provenance)


def test_states_are_solved_for_exactly(result):
    found = load_result(result)
    at_u, at_limit, at_volume = found.states
    assert at_u.quantities["u_max"].value == pytest.approx(2, abs=1e-12)
    assert at_volume.quantities["V"].value == pytest.approx(20, abs=1e-11)
    assert at_limit.quantities["p"].value == found.points("limit_point")[0].values["p"]
    assert at_limit.quantities["n_negative"].value == 0
    profile = at_u.fields[0].columns
    assert profile["rho"][0] == pytest.approx(3, abs=1e-11)
    assert set(at_u.fields[0].uncertainty) == set(profile)


def test_second_crossing_lies_on_the_falling_branch(weakforms, result):
    first, second = load_result(result).points("limit_point")
    p = (first.values["p"] + second.values["p"]) / 2
    called = weakforms(*TUBE, *COARSE, "--at", f"p={p}", "--crossing", 2)
    assert called.status == 0
    (state,) = json.loads(called.out)["states"]
    assert first.values["u_max"] < state["quantities"]["u_max"]["value"] < second.values["u_max"]
    assert state["quantities"]["p"]["value"] == pytest.approx(p, abs=1e-11)
    assert state["quantities"]["n_negative"]["value"] == 1
    assert state["crossing"] == 2


def test_standard_output_is_the_file(weakforms, tmp_path):
    called = weakforms(*TUBE, *SHORT)
    weakforms(*TUBE, *SHORT, "--out", tmp_path / "deep" / "er.json")
    one, two = json.loads(called.out), json.loads((tmp_path / "deep" / "er.json").read_text())
    validate(one)
    for data in (one, two):
        del data["provenance"]["wall_s"]
    assert one == two


def test_csv_holds_the_branch(weakforms):
    rows = list(csv.reader(io.StringIO(weakforms(*TUBE, *SHORT, "--format", "csv").out)))
    columns = json.loads(weakforms(*TUBE, *SHORT).out)["branches"][0]["columns"]
    assert rows[0] == ["branch", *columns]
    assert {row[0] for row in rows[1:]} == {"primary"}
    at = rows[0].index("p")
    assert [float(row[at]) for row in rows[1:]] == pytest.approx(columns["p"], rel=1e-11)


def test_options_override_the_request_file(weakforms, tmp_path):
    spec = {
        "parameters": {"alpha": 0.2, "delta1": 1.5, "u_end": 0.5},
        "at": {"u_max": 0.25},
        "numerics": {"cells": 16, "levels": 2},
    }
    (tmp_path / "s.json").write_text(json.dumps(spec))
    called = weakforms("solve", "tube", "--spec", tmp_path / "s.json", "--set", "delta1=2")
    data = json.loads(called.out)
    assert (data["parameters"]["alpha"], data["parameters"]["delta1"]) == (0.2, 2.0)
    assert data["numerics"]["meshes"] == [8, 16]
    assert data["states"][0]["at"] == {"u_max": 0.25}


def test_the_fold_line_holds_the_cusp(weakforms):
    called = weakforms("solve", "tube_fold", "--set", "alpha=0.1")
    data = json.loads(called.out)
    validate(data)
    (cusp,) = data["special_points"]
    assert (called.status, cusp["kind"], round(cusp["values"]["delta1"], 3)) == (0, "cusp_point", 1.163)
    assert 0 < cusp["uncertainty"]["delta1"] < 1e-7


def test_python_gives_what_the_command_gives(weakforms):
    called = json.loads(weakforms(*TUBE, *SHORT, "--at", "u_max=0.3").out)
    found = api.solve(
        "tube", delta1=1.1, u_end=0.5, numerics={"cells": 32, "levels": 2}, at={"u_max": 0.3}
    ).to_json()
    assert called["branches"] == found["branches"]
    assert called["states"] == found["states"]


def test_our_own_result_passes_as_a_curve(weakforms, result):
    called = weakforms("compare", CASE, result, "--curve", CURVE, "--accuracy", "1e-6", "--json")
    data = json.loads(called.out)
    assert (called.status, len(data["verdicts"])) == (0, 4)
    # Near p = 0 the table is too coarse for rows between its own: said, not passed over.
    assert 0 < data["unjudged_rows"]["p"] < data["rows"] / 2
    assert data["partial"]


# -- solves that do not converge -----------------------------------------------------------------


def test_what_converged_is_kept_and_the_rest_is_named(weakforms, tmp_path, monkeypatch):
    monkeypatch.setattr(StepControl, "max_points", 8)
    usual = (0.05, 0.1, 1e-7, 2e-3, 0.85, 0.1, 8, math.inf, ())
    monkeypatch.setattr(StepControl.__init__, "__defaults__", usual)
    called = weakforms(*TUBE, *COARSE, "--out", tmp_path / "r.json")
    assert called.status == 3
    assert "did not end within 8 points" in called.err
    kept = load_result(tmp_path / "r.json")
    assert len(kept.branch()) == 9
    assert [f.what for f in kept.failures] == ["branch primary"]


def test_nothing_is_written_when_nothing_converged(weakforms, tmp_path, monkeypatch):
    def stuck(*_: object) -> None:
        raise ConvergenceError("no first state")

    monkeypatch.setattr(tube_module, "first_state", stuck)
    called = weakforms(*TUBE, "--out", tmp_path / "r.json")
    assert (called.status, called.out, called.err) == (3, "", "weakforms: no first state\n")
    assert list(tmp_path.iterdir()) == []


def test_a_state_that_is_not_there_is_named_with_the_range(weakforms):
    called = weakforms(*TUBE, *SHORT, "--at", "u_max=99")
    assert (called.status, called.out, called.err.count("\n")) == (2, "", 1)
    assert (
        called.err == "weakforms: tube: u_max = 99 lies beyond u_end = 0.5; raise u_end (allowed: up to 10)\n"
    )
    called = weakforms(*TUBE, *SHORT, "--at", "u_max=0.4", "--crossing", 2)
    assert (called.status, called.out, called.err.count("\n")) == (2, "", 1)
    assert (
        "u_max = 0.4 is taken once on this branch, so there is no crossing 2; u_max ranges over" in called.err
    )
