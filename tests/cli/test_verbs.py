"""Every command does what its help says and ends with a documented exit status."""

import csv
import io
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from weakforms import api
from weakforms.errors import ConvergenceError
from weakforms.problems import registry
from weakforms.problems.tube import model as tube_module
from weakforms.results import load_result, validate
from weakforms.solvers.continuation.continuation import StepControl
from weakforms.verification.cases import references
from weakforms.verification.crosscheck.rows import interpolated

TUBE = ("solve", "tube", "--set", "contact=none", "--set", "alpha=0.1", "--set", "delta1=1.1")
COARSE = ("--mesh", "cells=32", "--mesh", "levels=2")
SHORT = ("--set", "u_end=0.5", *COARSE)
CASE, CURVE = "paper2.fig03", "fig03a_delta1_1.1"
HARD = "solve tube --set alpha=0 --set lf=20 --set u_end=3 --mesh degree=1 --mesh cells=8 --mesh levels=2"
"""Two coarse meshes of linear elements on a long tube: spurious limit points, and no end in sight."""


def shell(*words: str, before: str = "pass", **options: object) -> subprocess.CompletedProcess:
    """The console script in a separate process; ``before`` is Python code that runs first."""
    code = f"import sys; {before}; sys.argv[0] = 'weakforms'; from weakforms.cli import main; main()"
    command = [sys.executable, "-c", code, *words]
    return subprocess.run(command, text=True, timeout=60, check=False, **{"capture_output": True} | options)


# -- list and show -------------------------------------------------------------------------------


def test_list_names_every_problem_and_case(weakforms):
    entries = json.loads(weakforms("list", "--json").out)
    assert {e["id"] for e in entries if e["kind"] == "problem"} >= {"tube", "tube_fold"}
    assert [e["id"] for e in entries if e["kind"] == "case"] == api.cases()
    lines = weakforms("list").out.splitlines()
    assert [line.split()[:2] for line in lines] == [[e["kind"], e["id"]] for e in entries]
    assert {e["paper"] for e in json.loads(weakforms("list", "--paper", 2, "--json").out)} == {2}


def test_show_problem_says_what_is_admissible(weakforms):
    facts = json.loads(weakforms("show", "tube", "--json").out)
    parameters = {p["name"]: p for p in facts["parameters"]}
    assert parameters["alpha"]["allowed"] == ">= 0 and <= 1"
    assert parameters["delta1"]["default"] == 1.0
    assert "none" in parameters["contact"]["allowed"]
    assert parameters["k"]["needs"] == "contact = frictionless or adhesive"
    assert "needs" not in parameters["alpha"]
    assert {p["name"] for p in facts["numerics"]} >= {"degree", "cells", "levels"}
    text = " ".join(weakforms("show", "tube").out.split())
    expected = ["w(lam1, lam2)", ">= 1 and <= 5", "needs contact =", *facts["columns"], *facts["scales"]]
    expected += [facts["control"], *facts["special_points"]]
    assert [word for word in expected if word not in text] == []


def test_show_material_says_which_constants_are_admissible(weakforms):
    laws = json.loads(weakforms("show", "material", "--json").out)["materials"]
    text = weakforms("show", "material").out
    expected = [law["energy"] for law in laws] + [
        f"{c['name']} = {c['default']:g}, allowed {c['allowed']}: {c['description']}"
        for law in laws
        for c in law["constants"]
    ]
    assert len(expected) > 50
    assert [words for words in expected if words not in text] == []


def test_show_case_lists_checks_and_references(weakforms):
    facts = json.loads(weakforms("show", CASE, "--json").out)
    tables = {t["name"]: t for t in facts["references"]}
    assert tables[CURVE]["abscissa"] == "u_max"
    assert tables[CURVE]["uncertainty"]["p"] == references.load(2, CURVE).uncertainty["p"]
    assert len(facts["checks"]) == 7
    text = weakforms("show", CASE).out
    assert [name for name in [*tables, "figure 3", "both limit pressures fall"] if name not in text] == []
    for table in facts["references"]:
        columns, largest = ", ".join(table["uncertainty"]), max(table["uncertainty"].values())
        said = f"{table['type']}, {table['rows']} rows of {columns}, uncertainty up to {largest:.1e}"
        assert f"reference {table['name']}: {said}\n" in text


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


# -- compare -------------------------------------------------------------------------------------


@pytest.fixture
def written(tmp_path):
    """Writes columns as a CSV file."""

    def write(columns: dict) -> Path:
        path = tmp_path / "curve.csv"
        rows = zip(*columns.values(), strict=True)
        lines = [",".join(columns), *(",".join(repr(float(v)) for v in row) for row in rows)]
        path.write_text("\n".join(lines))
        return path

    return write


def table_columns(*names: str, part: slice = slice(None), **factors: float) -> dict:
    columns = references.load(2, CURVE).columns
    return {n: columns[n][part] * factors.get(n, 1.0) for n in names or columns}


@pytest.mark.parametrize(
    ("columns", "options", "status", "said"),
    [
        (table_columns(p=1 + 1e-9), (), 0, "all of it is judged"),
        (table_columns("V", "lam1_mid", "u_max", "t1_mid", "p"), (), 0, "all of it is judged"),
        (table_columns("u_max", "p", "V"), (), 5, "NOT JUDGED"),
        (table_columns("u_max", "p"), ("--column", "p"), 0, "left out: lam1_mid, t1_mid, V"),
        (table_columns(part=slice(None, None, -1)), (), 0, "all of it is judged"),
        (table_columns(part=slice(20, 60)), (), 0, "part of it is judged"),
        (table_columns(p=1 + 3e-7), (), 5, "p: no accuracy is claimed"),
        (table_columns(p=1 + 3e-7), ("--accuracy", "1e-7"), 1, "OUT OF BOUNDS"),
        (table_columns(V=-1), (), 1, "OUT OF BOUNDS"),
        (table_columns("u_max", "p", p=1 + 3e-7), ("--accuracy", "1e-6", "--column", "p"), 0, "within"),
        (table_columns("u_max", "p", p=1 + 3e-9), ("--accuracy", "1e-9"), 1, "OUT OF BOUNDS"),
        (table_columns(u_max=1 + 1e-5), (), 5, "NOT JUDGED"),
        (table_columns(u_max=1 + 1e-5), ("--accuracy", "1e-6"), 1, "OUT OF BOUNDS"),
    ],
)
def test_compare(weakforms, written, columns, options, status, said):
    called = weakforms("compare", CASE, written(columns), "--curve", CURVE, *options)
    assert (called.status, called.err) == (status, "")
    assert said in called.out


def test_verdicts_as_json(weakforms, written):
    columns = table_columns(part=slice(5, 50), p=1 + 1e-4)
    words = ("compare", CASE, written(columns), "--curve", CURVE, "--json")
    called = weakforms(*words, "--accuracy", "1e-6")
    data = json.loads(called.out)
    assert (called.status, data["schema"], data["passed"]) == (1, "weakforms.verdicts/1", False)
    assert (data["case"], data["curve"], data["abscissa"]) == (CASE, CURVE, "u_max")
    assert (data["rows"], data["ignored_rows"], data["partial"]) == (45, 0, True)
    assert data["covered"] == [columns["u_max"][0], columns["u_max"][-1]]
    wrong, *_, right = data["verdicts"]
    assert (wrong["check"], wrong["passed"]) == (f"{CURVE}:p", False)
    assert wrong["error"] == pytest.approx(1e-4, rel=0.1)
    assert wrong["bound"] == pytest.approx(wrong["asked"] + 2 * wrong["reference_uncertainty"])
    assert wrong["claim"] == ""
    assert (right["check"], right["passed"]) == (f"{CURVE}:V", True)
    called = weakforms(*words)
    data = json.loads(called.out)
    assert (called.status, data["status"], data["claimed"]) == (5, "not judged", None)
    assert [v["status"] for v in data["verdicts"]] == ["not judged", *["passed"] * 3]
    wrong, right = data["verdicts"][0], data["verdicts"][-1]
    assert (wrong["asked"], right["asked"], right["claim"]) == (None, 5e-10, "")
    assert wrong["claim"].endswith(", which --accuracy 1e-04 claims")


def test_our_own_result_passes_as_a_curve(weakforms, result):
    called = weakforms("compare", CASE, result, "--curve", CURVE, "--accuracy", "1e-6", "--json")
    data = json.loads(called.out)
    assert (called.status, len(data["verdicts"])) == (0, 4)
    # Near p = 0 the table is too coarse for rows between its own: said, not passed over.
    assert 0 < data["unjudged_rows"]["p"] < data["rows"] / 2
    assert data["partial"]


def test_a_wide_interpolation_error_does_not_pass_for_agreement(weakforms, written):
    u = np.linspace(0.055, 0.095, 5)
    columns = references.load(2, CURVE).columns
    p, slack = interpolated(columns["u_max"], columns["p"], u)
    assert slack.max() > 1e-6  # beyond the 1e-7 asked: nobody could tell these from the right numbers
    words = ("compare", CASE, "--curve", CURVE, "--column", "p")
    called = weakforms(*words, written({"u_max": u, "p": p + slack / 4}))
    assert called.status == 5
    assert "NOT JUDGED" in called.out
    assert "give the curve at the table's own u_max" in called.out
    # Halfway between rows of the smooth part it is sharp enough to tell 1e-6.
    x, y = columns["u_max"][60:], columns["p"][60:]
    middle = {"u_max": (x[1:] + x[:-1]) / 2}
    middle["p"] = np.interp(middle["u_max"], x, y) + 1e-5
    assert weakforms(*words, written(middle), "--accuracy", "1e-6").status == 1


# -- the whole program ---------------------------------------------------------------------------


def test_status_0_and_help():
    done = shell("list", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    assert "tube" in done.stdout


def test_status_1(written):
    done = shell("compare", CASE, str(written(table_columns(p=2))), "--curve", CURVE)
    assert (done.returncode, done.stderr) == (1, "")


def test_status_2_and_debug():
    plain, debug = shell("solve", "nope"), shell("solve", "nope", "--debug")
    assert (plain.returncode, plain.stdout) == (2, "")
    known = ", ".join(registry.abouts())
    assert plain.stderr == f"weakforms: unknown problem 'nope'; the problems are {known}\n"
    assert debug.returncode == 2
    assert "Traceback" in debug.stderr
    assert debug.stderr.endswith(plain.stderr)


def test_status_3_for_a_problem_that_is_too_hard(tmp_path):
    done = shell(*HARD.split(), "--out", str(tmp_path / "r.json"))
    assert (done.returncode, done.stdout) == (3, "")
    kept = load_result(tmp_path / "r.json")
    assert len(kept.branch()) > 100
    assert kept.special_points == []
    assert "special points" in {f.what for f in kept.failures}
    # A machine that is slow shows progress too, as "[0:15] states".
    lines = [line for line in done.stderr.splitlines() if not line.startswith("[")]
    assert len(lines) == len(kept.failures) + len(kept.warnings)
    failed = [line for line in lines if not line.startswith("weakforms: warning: ")]
    assert len(failed) == len(kept.failures)
    assert all(line.startswith("weakforms: not converged: ") and len(line) < 700 for line in failed)


def test_status_4_without_dolfinx_but_curves_can_be_compared(written):
    missing = "sys.modules['dolfinx'] = None"
    done = shell("solve", "tube", before=missing)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (4, "", 1)
    assert "dolfinx is not installed" in done.stderr
    assert "apt install" in done.stderr
    path = str(written(table_columns()))
    assert shell("compare", CASE, path, "--curve", CURVE, before=missing).returncode == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_output_that_cannot_be_written_is_one_line():
    with open("/dev/full", "w") as full:
        done = shell("list", capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert done.returncode == 2
    assert done.stderr.startswith("weakforms: cannot write to standard output: ")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("words", ["show tube", "solve material --json", "list --json"])
def test_a_reader_that_closes_the_pipe_ends_the_command_without_a_word(words):
    reading, writing = os.pipe()
    os.close(reading)
    try:  # what is printed in lines, kept to the end, or too long to be kept; two of them start PETSc
        done = shell(*words.split(), capture_output=False, stdout=writing, stderr=subprocess.PIPE)
    finally:
        os.close(writing)
    assert (done.returncode, done.stderr) == (2, "")
