"""The verbs that work on stored results: plot, diff, export."""

import csv
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from xml.etree import ElementTree as ET

import meshio
import numpy as np
import pytest
from matplotlib.figure import Figure

from weakforms import export as exporting
from weakforms.results import Branch, Ended, Field, Quantity, Result, SpecialPoint, State, load_result
from weakforms.results.io import dumps
from weakforms.results.plot import save

VERSIONS = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "0")


def made(p: float = 2.0, spread: float = 1e-8, points: int = 5, **parameters: float) -> Result:
    u = np.linspace(0, 4, points)
    columns = {"p": p * u / 4, "u_max": u, "n_negative": np.zeros(points, int)}
    branch = Branch("primary", "p", columns, {"p": np.full(points, spread), "u_max": np.full(points, 1e-9)})
    point = SpecialPoint("limit_point", "primary", "p", {"p": p, "u_max": 1.0}, {"p": spread, "u_max": 1e-9})
    z = np.linspace(0, 3, 4)
    states = [
        State({"u_max": v}, "primary", {"p": Quantity(p, spread)}, (profile(z, v),)) for v in (1.0, 2.0)
    ]
    given = {"delta1": 1.1} | parameters
    return Result(
        "tube", given, {"p": "P"}, {}, VERSIONS | {"ranks": 1, "wall_s": 0.0}, [branch], [point], {}, states
    )


def profile(z: np.ndarray, swelling: float) -> Field:
    return Field("profile", {"Z": z, "rho": 1 + swelling * (3 - z) / 3, "eta": z, "t1": z**2}, {"rho": 1e-9})


@pytest.fixture
def stored(tmp_path):
    def write(name: str, result: Result | None = None) -> str:
        path = tmp_path / name
        path.write_text(dumps((result or made()).to_json()))
        return str(path)

    return write


def test_stored_results_are_looked_at_without_dolfinx(stored, tmp_path):
    """As after ``pip install`` alone, also without pandas and xarray."""
    for words in (
        ["show", stored("a.json")],
        ["plot", stored("a.json"), "--out", str(tmp_path / "a.png")],
        ["diff", stored("a.json"), stored("b.json")],
        ["export", stored("a.json"), str(tmp_path / "out")],
    ):
        missing = "sys.modules.update(dict.fromkeys(['dolfinx', 'petsc4py', 'mpi4py', 'pandas', 'xarray']))"
        code = f"import sys; {missing}; from weakforms.cli import main; main()"
        done = subprocess.run(
            [sys.executable, "-c", code, *words], capture_output=True, text=True, check=False
        )
        assert (done.returncode, done.stderr) == (0, ""), words


# -- plot ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("suffix", "begins"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_a_picture_is_written_in_the_format_of_its_name(weakforms, stored, tmp_path, suffix, begins):
    out = tmp_path / f"a.{suffix}"
    called = weakforms("plot", stored("a.json"), stored("b.json", made(delta1=1.2)), "--out", out)
    assert (called.status, called.err, called.out) == (0, "", f"picture: {out}\n")
    assert out.read_bytes().startswith(begins)
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(["a.json", "b.json", out.name])


def test_a_picture_is_made_beside_its_place(tmp_path, monkeypatch):
    """The folder for temporary files may lie on another disk, from which nothing can be renamed."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "not there"))
    save(Figure(), tmp_path / "a.png")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_columns_of_profiles_are_drawn_as_profiles(weakforms, stored, tmp_path):
    out = tmp_path / "a.svg"
    assert weakforms("plot", stored("a.json"), "--x", "Z", "--y", "rho", "--out", out).status == 0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--x", "umax"], "there is no column 'umax'; did you mean 'u_max'?"),
        (["--x", "Z", "--y", "p"], "no branch and no profile has both columns Z and p"),
        (["--out", "a.gif"], "the name must end in .png, .svg, .pdf"),
        (["--out", "/dev/null/a.png"], "cannot write /dev/null/a.png"),
    ],
)
def test_a_picture_that_cannot_be_drawn_is_one_line(weakforms, stored, tmp_path, monkeypatch, options, said):
    monkeypatch.chdir(tmp_path)
    called = weakforms("plot", stored("r.json"), *options)
    assert (called.status, called.out, called.err.count("\n")) == (2, "", 1)
    assert said in called.err
    assert [path.name for path in tmp_path.iterdir()] == ["r.json"]


def test_names_from_a_file_are_no_formulas(weakforms, stored, tmp_path):
    odd = made()
    odd.problem = odd.scales["p"] = "$\\frac{"
    odd.branches[0] = Branch("$\\sqrt{", "p", odd.branches[0].columns, ended=Ended("$^^$", "p", 2.0))
    called = weakforms("plot", stored("odd.json", odd), "--out", tmp_path / "odd.svg")
    assert (called.status, called.err) == (0, "")


def test_a_file_that_is_no_result_is_not_drawn(weakforms, tmp_path):
    (tmp_path / "x.json").write_text("{}")
    called = weakforms("plot", tmp_path / "x.json", "--out", tmp_path / "x.png")
    assert (called.status, called.err.count("\n")) == (2, 1)


# -- diff ----------------------------------------------------------------------------------------


def test_results_that_agree_within_their_uncertainties_are_the_same(weakforms, stored):
    called = weakforms("diff", stored("a.json"), stored("b.json", made(2.0 + 2e-8)))
    assert (called.status, called.err) == (0, "")
    assert "15 of 15 numbers agree" in called.out


@pytest.mark.parametrize(("shift", "status"), [(2.8e-8, 0), (2.9e-8, 1)])
def test_the_bound_is_twice_the_combined_uncertainty(weakforms, stored, shift, status):
    """2 sqrt(1e-16 + 1e-16) = 2.83e-8."""
    one, two = stored("a.json"), stored("b.json", made(2.0 + shift))
    called = weakforms("diff", one, two, "--json")
    data = json.loads(called.out)
    assert (called.status, data["same"], data["schema"]) == (status, status == 0, "weakforms.diff/1")
    (place,) = [n for n in data["numbers"] if n["place"] == "special point 1 (limit_point, primary), p"]
    assert place["bound"] == pytest.approx(2.83e-8, rel=1e-2)
    assert place["agrees"] == (status == 0)


def test_numbers_that_differ_are_shown_with_their_difference_and_bound(weakforms, stored):
    called = weakforms("diff", stored("a.json"), stored("b.json", made(2.1, delta1=1.2)))
    assert called.status == 1
    assert "delta1: 1.1 and 1.2" in called.out
    assert "special point 1 (limit_point, primary), p   2.000000000(10)" in called.out
    assert "+1.0e-01" in called.out


def test_a_count_must_be_equal_and_a_missing_number_differs(weakforms, stored):
    other = made()
    other.branches[0].columns["n_negative"][2] = 1
    assert weakforms("diff", stored("a.json"), stored("b.json", other)).status == 1
    other = made()
    other.special_points.clear()
    called = weakforms("diff", stored("a.json"), stored("b.json", other))
    assert called.status == 1
    assert "there" in called.out
    assert "missing" in called.out


def test_a_number_that_is_not_finite_on_one_side_differs(weakforms, stored):
    other = made()
    other.branches[0].columns["p"][2] = np.nan
    one, two = stored("a.json"), stored("b.json", other)
    assert weakforms("diff", one, two).status == 1
    assert weakforms("diff", two, two).status == 0
    assert weakforms("diff", one, two, "--json").status == 1


def test_branches_with_other_points_are_left_out_and_named(weakforms, stored):
    called = weakforms("diff", stored("a.json"), stored("b.json", made(points=6)))
    assert called.status == 0
    assert "branch primary: different numbers of points" in called.out
    assert "12 of 12 numbers agree" in called.out


def test_results_of_different_problems_are_not_compared(weakforms, stored):
    other = made()
    other.problem = "circular"
    called = weakforms("diff", stored("a.json"), stored("b.json", other))
    assert (called.status, called.out) == (2, "")
    assert "different problems: tube and circular" in called.err


# -- export --------------------------------------------------------------------------------------


def rows(path) -> list[dict[str, str]]:
    with path.open() as stream:
        return list(csv.DictReader(stream))


def test_a_result_becomes_tables_and_shapes(weakforms, stored, tmp_path):
    out = tmp_path / "out"
    called = weakforms("export", stored("r.json"), out)
    assert (called.status, called.err) == (0, "")
    names = ["branches.csv", "fields.csv", "shapes.pvd", "special_points.csv", "states.csv"]
    assert called.out.split() == [str(out / name) for name in names]
    assert sorted(os.listdir(out)) == sorted([*names, "shape_0000.vtu", "shape_0001.vtu"])
    (point,) = rows(out / "special_points.csv")
    assert (point["what"], point["p"], point["p_uncertainty"]) == ("limit_point", "2.0", "1e-08")
    fields = rows(out / "fields.csv")
    assert [row["at"] for row in fields] == ["u_max = 1"] * 4 + ["u_max = 2"] * 4
    assert float(fields[4]["rho"]) == 3.0
    assert [row["p"] for row in rows(out / "states.csv")] == ["2.0", "2.0"]


def test_the_series_lists_every_shape_in_order(weakforms, stored, tmp_path):
    weakforms("export", stored("r.json"), tmp_path / "out")
    sets = ET.parse(tmp_path / "out" / "shapes.pvd").getroot().findall("Collection/DataSet")
    assert [float(item.get("timestep")) for item in sets] == [1.0, 2.0]
    radii = [
        np.hypot(*meshio.read(tmp_path / "out" / item.get("file")).points[:, :2].T).max() for item in sets
    ]
    assert radii == pytest.approx([2.0, 3.0])


def test_a_whole_branch_becomes_a_series(weakforms, tmp_path):
    path, out = tmp_path / "r.json", tmp_path / "out"
    mesh = ("--mesh", "cells=16", "--mesh", "levels=2")
    assert weakforms("solve", "tube", "delta1=1.1", "u_end=2", *mesh, "--out", path).status == 0
    called = weakforms("export", path, out, "--frames", 5)
    assert called.status == 0
    heights = [float(row["u_max"]) for row in rows(out / "states.csv")]
    assert heights == pytest.approx(np.linspace(0, 2, 5), abs=1e-5)
    assert len(list(out.glob("shape_*.vtu"))) == 5
    pressures = [float(row["p"]) for row in rows(out / "states.csv")]
    branch = load_result(path).branch()
    assert pressures[1:] == pytest.approx(np.interp(heights, branch["u_max"], branch["p"])[1:], abs=2e-2)


def test_states_that_were_asked_for_stay_in_the_tables_beside_those_along_a_branch(tmp_path):
    result = made()
    frames = [replace(state, at={"u_max": 3.0 + k}) for k, state in enumerate(result.states)]
    exporting.export(result, tmp_path, frames=frames)
    every = [f"u_max = {k}" for k in (1, 2, 3, 4)]
    assert [row["what"] for row in rows(tmp_path / "states.csv")] == [f"state at {at}" for at in every]
    numbers = {row["state"]: row["at"] for row in rows(tmp_path / "fields.csv")}
    assert numbers == dict(zip("1234", every, strict=True))
    sets = ET.parse(tmp_path / "shapes.pvd").getroot().findall("Collection/DataSet")
    assert [float(item.get("timestep")) for item in sets] == [3.0, 4.0]


def test_a_branch_of_which_every_column_turns_is_refused():
    turning = made()
    turning.branches[0] = Branch("primary", "p", {"p": np.array([0.0, 1.0, 0.5])})
    with pytest.raises(exporting.InputError, match="every column turns"):
        exporting.along(turning, "primary", 3)


@pytest.mark.parametrize(
    ("change", "options", "said"),
    [
        (lambda r: (r.branches.clear(), r.special_points.clear(), r.states.clear()), [], "nothing to export"),
        (lambda r: None, ["--frames", "1"], "two states or more"),
        (lambda r: None, ["--frames", "4", "--branch", "secondary"], "no branch 'secondary'"),
    ],
)
def test_what_cannot_be_exported_is_one_line_and_leaves_nothing(
    weakforms, stored, tmp_path, change, options, said
):
    result = made()
    change(result)
    called = weakforms("export", stored("r.json", result), tmp_path / "out", *options)
    assert (called.status, called.out) == (2, "")
    assert len(called.complaints) == 1
    assert said in called.err
    assert list(tmp_path.glob("out/*")) == []


def test_nothing_is_half_written_when_a_shape_fails(stored, tmp_path, monkeypatch):
    def fails(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(exporting, "write_shape", fails)
    with pytest.raises(exporting.InputError, match=r"cannot write to folder .*No space left"):
        exporting.export(made(), tmp_path / "out")
    assert list((tmp_path / "out").iterdir()) == []
