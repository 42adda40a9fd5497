"""Results are written and read unchanged, follow their schema or are refused, and are written atomically."""

import copy
import json
import os
from pathlib import Path

import numpy as np
import pytest

from weakforms.errors import InputError
from weakforms.results import (
    Absence,
    Branch,
    Failure,
    Field,
    Quantity,
    Result,
    SpecialPoint,
    State,
    load_result,
    read_curve,
    validate,
    write_atomically,
)
from weakforms.results.io import branch_csv, dumps, require_place_for, require_writable, sole_use
from weakforms.results.model import KINDS
from weakforms.results.tables import csv_text, other_rows

VERSIONS = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "1")


def full() -> Result:
    """A result with every optional part."""
    return Result(
        problem="tube",
        parameters={"alpha": 0.1, "contact": "none"},
        scales={"p": "P R/C"},
        numerics={"degree": 4, "meshes": [8, 16]},
        provenance={**VERSIONS, "ranks": 2, "wall_s": 0.5},
        branches=[
            Branch(
                "primary",
                "p",
                {"p": np.array([0.1, 1 / 3, np.nan]), "n_negative": np.array([0, 1, 1])},
                {"p": np.array([1e-12, 2e-12, 3e-12])},
            )
        ],
        special_points=[
            SpecialPoint("limit_point", "primary", "p", {"p": 1 / 3}, {"p": 1e-12}, orders={"p": 8.1})
        ],
        quantities={"count": Quantity(3), "p": Quantity(0.1, 1e-9, 3.9)},
        states=[
            State(
                {"p": 0.1},
                "primary",
                {"u_max": Quantity(2.5, 1e-9)},
                (Field("profile", {"Z": np.array([0.0, 1.5])}, {"Z": 0.0}),),
                2,
            )
        ],
        failures=[Failure("state at p = 9", "not there")],
    )


def test_an_uncertainty_of_each_row_survives_and_must_fit_its_column():
    rows = {"Z": 0.0, "rho": np.array([1e-9, 2e-9])}
    field = Field("profile", {"Z": np.array([0.0, 1.5]), "rho": np.array([1.0, 2.0])}, rows)
    back = Field.from_json(field.to_json())
    assert back.uncertainty["Z"] == 0.0
    assert np.array_equal(back.uncertainty["rho"], rows["rho"])
    assert np.array_equal(back.at(np.array([False, True])).uncertainty["rho"], [2e-9])
    data = full().to_json()
    data["states"][0]["fields"] = [field.to_json()]
    validate(data)
    data["states"][0]["fields"][0]["uncertainty"]["rho"] = [1e-9]
    with pytest.raises(InputError, match="uncertainty of rho': 1"):
        validate(data)


def test_json_round_trip_is_exact(tmp_path):
    data = full().to_json()
    validate(data)
    write_atomically(tmp_path / "r.json", dumps(data))
    back = load_result(tmp_path / "r.json")
    assert back.to_json() == data
    assert back.branch().columns["p"][1] == 1 / 3
    assert np.isnan(back.branch().columns["p"][2])
    assert back.branch().columns["n_negative"].dtype.kind == "i"
    assert (back.states[0].crossing, back.quantities["p"].order) == (2, 3.9)
    assert back.points("limit_point", "other") == []
    with pytest.raises(KeyError, match="primary"):
        back.branch("other")


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["schema"], "weakforms.result/2"),
        (["problem"], ""),
        (["parameters"], []),
        (["provenance", "ranks"], 0),
        (["provenance", "wall_s"], -1),
        (["provenance", "petsc"], None),
        (["branches"], {}),
        (["branches", 0, "columns"], {}),
        (["branches", 0, "columns", "p"], [1, "2"]),
        (["branches", 0, "columns", "p"], 1),
        (["special_points", 0, "kind"], "turning_point"),
        (["special_points", 0, "status"], "guessed"),
        (["special_points", 0, "values", "p"], None),
        (["special_points", 0, "uncertainty", "p"], -1e-9),
        (["quantities", "p", "value"], "1"),
        (["quantities", "p", "uncertainty"], -1),
        (["quantities", "p", "error"], 1),
        (["states", 0, "at"], {}),
        (["states", 0, "crossing"], 0),
        (["states", 0, "fields", 0, "columns"], {}),
        (["failures", 0], {"what": "x"}),
    ],
)
def test_schema_refuses(path, value):
    data = full().to_json()
    *steps, last = path
    place = data
    for step in steps:
        place = place[step]
    if value is None and last == "petsc":
        del place[last]
    else:
        place[last] = value
    with pytest.raises(InputError, match=r"weakforms\.result/1") as refusal:
        validate(data)
    assert "\n" not in str(refusal.value)


def test_schema_has_every_kind_of_point():
    data = full().to_json()
    data["special_points"] = [data["special_points"][0] | {"kind": kind} for kind in KINDS]
    validate(data)


@pytest.mark.parametrize("key", sorted(set(full().to_json()) - {"schema"}))
def test_schema_wants_every_part(key):
    data = full().to_json()
    del data[key]
    with pytest.raises(InputError, match=key):
        validate(data)


def test_what_is_not_finite_is_never_written():
    data = full().to_json()
    data["quantities"]["p"]["value"] = float("nan")
    with pytest.raises(ValueError, match="not JSON compliant"):
        dumps(data)


def test_other_rows_hold_quantities_ends_and_what_is_missing():
    result = full()
    result.absent.append(Absence("cusp", "looked for between 1 and 3"))
    quantities, end, absent, failed = other_rows(result)
    assert quantities == {"what": "quantities", "count": 3, "p": 0.1, "p_uncertainty": 1e-9}
    assert (end["what"], end["branch"], end["n_negative"]) == ("end", "primary", 1)
    assert absent == {"what": "not there", "reason": "cusp: looked for between 1 and 3"}
    lines = csv_text([quantities, failed]).split("\n")
    assert lines[0] == "what,count,p,p_uncertainty,reason"
    assert len(lines) == 4, "one line end a row, on every system"
    assert failed == {"what": "failed", "reason": "state at p = 9: not there"}


def test_csv_has_every_branch_and_column():
    result = full()
    result.branches.append(Branch("secondary", "p", {"p": np.array([2.0]), "q": np.array([5])}))
    lines = branch_csv(result).splitlines()
    assert lines[0] == "branch,p,n_negative,q"
    assert lines[1:] == ["primary,0.1,0,", "primary,0.333333333333,1,", "primary,nan,1,", "secondary,2,,5"]


# -- files ---------------------------------------------------------------------------------------


def test_failed_write_leaves_nothing_and_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "r.json"
    write_atomically(path, "old")

    def full_disk(*_: object) -> None:
        raise OSError(28, "No space left on device")

    for name in ("replace", "chmod"):
        with monkeypatch.context() as patch:
            patch.setattr(os, name, full_disk)
            with pytest.raises(InputError, match=r"cannot write .*r\.json: No space left on device"):
                write_atomically(path, "new")
        assert [p.name for p in tmp_path.iterdir()] == ["r.json"]
        assert path.read_text() == "old"


def test_interrupted_write_leaves_nothing(tmp_path, monkeypatch):
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(tmp_path / "r.json", "new")
    assert list(tmp_path.iterdir()) == []


def test_written_files_have_the_usual_permissions_and_line_ends(tmp_path):
    write_atomically(tmp_path / "a" / "b" / "r.txt", "one\ntwo λ\n")
    path = tmp_path / "a" / "b" / "r.txt"
    assert path.read_bytes() == "one\ntwo λ\n".encode()
    mask = os.umask(0)
    os.umask(mask)
    assert path.stat().st_mode & 0o777 == 0o666 & ~mask


def test_json_keeps_letters_beyond_ascii_as_they_are():
    assert dumps({"λ": "Åbo"}) == '{\n "λ": "Åbo"\n}\n'


def test_links_are_followed_and_devices_are_not_replaced(tmp_path):
    (tmp_path / "real").write_text("old")
    (tmp_path / "link").symlink_to("real")
    write_atomically(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_text() == "new"
    (tmp_path / "null").symlink_to(os.devnull)
    require_place_for(tmp_path / "null")
    write_atomically(tmp_path / "null", "gone")
    assert (tmp_path / "null").is_symlink()
    assert (tmp_path / "null").is_char_device()


def test_a_folder_is_locked_only_while_it_is_written_to(tmp_path):
    with sole_use(tmp_path), pytest.raises(InputError, match="another run is writing"), sole_use(tmp_path):
        pass
    with sole_use(tmp_path):
        pass


def test_a_file_is_written_beside_its_place(tmp_path, monkeypatch):
    """Elsewhere, the folder for temporary files for instance, may be another file system."""
    moved, replaced = [], os.replace
    monkeypatch.setattr(os, "replace", lambda *paths: moved.append(paths) or replaced(*paths))
    write_atomically(tmp_path / "new" / "r.json", "{}")
    ((temporary, place),) = moved
    assert Path(temporary).parent == Path(place).parent == tmp_path / "new"
    assert Path(temporary).name.startswith(".r.json.")


def test_only_half_written_files_of_an_ended_run_are_removed(tmp_path):
    cases = tmp_path / "cases"
    cases.mkdir()
    left = [cases / f".result.{name}" for name in ("json.k2_9abcd", "html.12.part", "vtu.x0000000")]
    kept = [cases / name for name in (".result.json", ".result.txt.k2_9abcd", "result.json.k2_9abcd")]
    for path in (*left, *kept):
        path.write_text("")
    (cases / ".folder.json.abcdefgh").mkdir()
    with sole_use(tmp_path):
        assert not any(path.exists() for path in left)
    assert sorted(cases.iterdir()) == sorted([*kept, cases / ".folder.json.abcdefgh"])


def test_places_are_tried_before_solving(tmp_path):
    (tmp_path / "file").write_text("")
    require_place_for(tmp_path / "file")
    require_place_for(tmp_path / "new" / "r.json")
    require_place_for(tmp_path / "new" / "far" / "inside" / "r.json")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "new"]
    assert [p.name for p in (tmp_path / "new").iterdir()] == ["far"]
    for bad in (tmp_path, tmp_path / "file" / "x", tmp_path / ("x" * 300), tmp_path / ("x" * 300) / "y"):
        with pytest.raises(InputError, match="cannot write"):
            require_place_for(bad)
    with pytest.raises(InputError, match="cannot write to folder"):
        require_writable(tmp_path / "file")


# -- curves --------------------------------------------------------------------------------------

COLUMNS = {"u": [1.0, 2.5], "p": [3.0, -4e-3]}


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("c.csv", "u,p\n1,3\n2.5,-4e-3\n"),
        ("c.csv", "\ufeffu , p\r\n1, 3\r\n\r\n2.5, -4e-3"),
        ("c.txt", '"u","p"\n"1","3"\n2.5,-0.004'),
        ("c.json", json.dumps(COLUMNS)),
        ("c.JSON", json.dumps({"columns": COLUMNS, "by": "somebody"})),
        ("c.json", json.dumps(full().to_json() | {"branches": [Branch("b", "p", COLUMNS).to_json()]})),
    ],
)
def test_curves_are_read(tmp_path, name, content):
    (tmp_path / name).write_text(content)
    found = read_curve(tmp_path / name).columns
    assert {key: values.tolist() for key, values in found.items()} == COLUMNS


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("u,p\n1,3\n2,x\n", r"column 'p', row 2: 'x' is not a finite number"),
        ("u,p\n1,3\n2\n", r"line 3: 1 cells under 2 column names"),
        ("u,p\n", "at least one row"),
        ("u,u\n1,2\n", "a column name is repeated"),
        ("branch,p,q\na,1,\nb,2,5\na,3,4\n", r"column 'q', row 3: rows before are empty"),
        ("branch,p\na,1\nb,2\n", "has no branch 'c'; it has a, b"),
        ("u," + 1000 * "x," + "p\n1,2\n", "more than 1000 columns"),
        ("u,p\n1," + 50 * "x" + "\n", f"row 1: '{40 * 'x'}' is"),
    ],
)
def test_what_is_wrong_with_a_table_is_named_with_its_row(tmp_path, content, said):
    (tmp_path / "c.csv").write_text(content)
    with pytest.raises(InputError, match=said):
        read_curve(tmp_path / "c.csv", "c" if "'c'" in said else "a" if "branch" in content else "")


def test_one_row_is_a_table_and_a_branch_is_read_without_the_columns_of_others(tmp_path):
    (tmp_path / "c.csv").write_text("u,p\n1,3\n")
    assert {name: v.tolist() for name, v in read_curve(tmp_path / "c.csv").columns.items()} == {
        "u": [1],
        "p": [3],
    }
    (tmp_path / "c.csv").write_text("branch,p,q\na,1,\nb,2,5\na,3,\nb,4,6\n")
    for branch, columns in (("a", {"p": [1, 3]}), ("b", {"p": [2, 4], "q": [5, 6]})):
        found = read_curve(tmp_path / "c.csv", branch).columns
        assert {name: values.tolist() for name, values in found.items()} == columns


def test_the_first_branch_of_a_result_is_the_curve(tmp_path):
    other = {name: [2.0 * value for value in values] for name, values in COLUMNS.items()}
    branches = [Branch("primary", "p", COLUMNS).to_json(), Branch("secondary", "p", other).to_json()]
    (tmp_path / "c.json").write_text(json.dumps(full().to_json() | {"branches": branches}))
    assert {
        key: values.tolist() for key, values in read_curve(tmp_path / "c.json").columns.items()
    } == COLUMNS


def test_validation_does_not_change_what_it_sees():
    data = full().to_json()
    before = copy.deepcopy(data)
    validate(data)
    assert data == before


def test_what_is_wrong_with_a_result_is_named_with_its_place():
    for data, place in (({}, "top level"), ({**full().to_json(), "branches": [1]}, "branches/0")):
        with pytest.raises(InputError, match=f"at {place}: "):
            validate(data)
