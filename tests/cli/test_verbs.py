"""Every command does what its help says and ends with a documented exit status."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from weakforms import api
from weakforms.problems import registry
from weakforms.results import load_result
from weakforms.verification.cases import references
from weakforms.verification.crosscheck.rows import interpolated

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
