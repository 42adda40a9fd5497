"""Files that are huge, deep, cut short or wrongly encoded are refused, or read within bounds."""

import codecs
import json
import math
import os

import pytest
from abuse_tools import COMPARE, CURVE, call, canned, limited, orderly, quickly
from hypothesis import given
from hypothesis import strategies as st

from weakforms.errors import InputError
from weakforms.problems import registry
from weakforms.verification.cases import references

MEMORY = 1500
"""MiB that a hostile file may cost."""

pytestmark = pytest.mark.usefixtures("nothing_is_solved")

ROWS = "\n".join(f"{0.05 * k:g},{k / 9:g}" for k in range(1, 12))
DEEP = 100_000


def result_text() -> str:
    return json.dumps(canned().to_json())


# -- size ----------------------------------------------------------------------------------------


def repeated(path, head: bytes, body: bytes, times: int, tail: bytes = b"") -> None:
    """Write a file of many equal parts without holding it in memory."""
    block = body * 10_000
    with path.open("wb") as stream:
        stream.write(head)
        for _ in range(times // 10_000):
            stream.write(block)
        stream.write(tail)


@pytest.mark.slow
def test_huge_files(tmp_path):
    whole = result_text()
    repeated(tmp_path / "rows.csv", b"u_max,p\n", b"1,2\n", 10_000_000)
    repeated(tmp_path / "blank.csv", b"u_max,p\n", b"\n", 30_000_000)
    repeated(tmp_path / "columns.csv", b"u_max,p", b",a", 30_000_000, b"\n1\n")
    repeated(tmp_path / "cells.csv", b"u_max,p\n1,2", b",12", 5_000_000)
    repeated(tmp_path / "quotes.csv", b'u_max,p\n"', b"x\n", 5_000_000)
    repeated(tmp_path / "larger.csv", b"u_max,p\n", b"1.000000,2.000000\n", 3_800_000)
    repeated(tmp_path / "lists.json", b'{"u_max": [', b"[],", 10_000_000, b"1]}")
    repeated(tmp_path / "numbers.json", b'{"u_max": [', b"1,", 3_000_000, b"1]}")
    repeated(tmp_path / "objects.json", b'{"u_max": [', b"{},", 3_000_000, b"1]}")
    repeated(tmp_path / "deep.json", b'{"u_max": ', b"[", 5_000_000)
    repeated(tmp_path / "spaces.json", b"", b" ", 40_000_000)
    repeated(tmp_path / "result.json", whole[:-1].encode() + b', "more": [', b"1,", 2_000_000, b"1]}")
    repeated(tmp_path / "states.json", whole.replace('"states": [', '"states": [{},').encode(), b"", 0)
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "report.json").symlink_to("/dev/zero")
    requests = tmp_path / "requests"
    requests.mkdir()
    os.link(tmp_path / "lists.json", requests / "lists.json")
    (requests / "deep.json").write_text('{"problem": ' + "[" * 900 + "]" * 900 + "}")
    (requests / "deeper.json").write_text('{"problem": "tube", "parameters": ' + "[" * DEEP)

    names = ("rows.csv", "blank.csv", "columns.csv", "cells.csv", "quotes.csv", "larger.csv")
    names += ("lists.json", "numbers.json", "objects.json", "deep.json", "spaces.json")
    commands = [[*COMPARE, tmp_path / name] for name in names]
    commands += [[*COMPARE, "/dev/zero"], ["solve", "tube", "--spec", tmp_path / "lists.json"]]
    commands += [["shape", tmp_path / name, tmp_path / "s.vtu"] for name in ("result.json", "states.json")]
    commands += [["report", tmp_path / "run"]]
    for words, called in zip(commands, limited(commands, MEMORY), strict=True):
        orderly(called, 0 if "result.json" in str(words[1]) else 2)
        assert called.seconds < 60, (words, called.seconds)
    (batch,) = limited([["batch", requests]], MEMORY)
    assert batch.status == 2
    assert batch.out.count(": 2 ") == 3
    assert "Traceback" not in batch.out + batch.err


def test_a_table_of_as_many_rows_as_allowed(tmp_path):
    columns = references.load(2, CURVE).columns
    low, high = columns["u_max"].min(), columns["u_max"].max()
    step = (high - low) / 300_000
    with (tmp_path / "long.csv").open("w") as stream:
        stream.write("u_max,p\n")
        stream.writelines(f"{low + k * step:.12g},1.5\n" for k in range(300_000))
    (called,) = limited([[*COMPARE, tmp_path / "long.csv"]], MEMORY)
    assert (called.status, called.err) == (1, "")


# -- form ----------------------------------------------------------------------------------------

PLACES = {
    "parameters": '{"parameters": {"alpha": %s}}',
    "at": '{"at": {"p": %s}}',
    "numerics": '{"numerics": {"cells": %s}}',
    "whole": "%s",
}
VALUES = ["1e400", "-1e400", "NaN", "Infinity", "-Infinity", "1" + "0" * 400, "0" * 50, "1e-400", "[[1]]"]
VALUES += [
    "\"__import__('os')\"",
    '"\\ud800"',
    '"\\u0000"',
    '{"a": {"a": 1}}',
    "1 1",
    "'1'",
    "01",
    "+1",
    ".5",
]
VALUES += ["[" * DEEP, "[" * DEEP + "]" * DEEP, '{"a":' * DEEP + "1" + "}" * DEEP]


@pytest.mark.parametrize("value", VALUES, ids=range(len(VALUES)))
def test_values_in_requests(tmp_path, value):
    for name, text in PLACES.items():
        (tmp_path / f"{name}.json").write_text(text % value)
        tiny = value == "1e-400" and name in ("parameters", "at")  # zero, like any other
        orderly(call("solve", "tube", "--spec", tmp_path / f"{name}.json"), 0 if tiny else 2)


def test_the_last_of_two_equal_keys_counts(tmp_path):
    (tmp_path / "s.json").write_text('{"parameters": {"alpha": 0.1, "alpha": "much"}}')
    assert "'much'" in orderly(call("solve", "tube", "--spec", tmp_path / "s.json"), 2).err


ENCODINGS = ("utf-16", "utf-16-le", "utf-32", "utf-7", "cp037", "latin-1", "utf-8-sig")


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("door", ["csv", "json", "request", "result", "report"])
def test_encodings(tmp_path, encoding, door):
    columns = {"u_max": [0.1, 0.2], "p": [1, 2], "größe": [1, 2]}
    texts = {
        "csv": f"u_max,p,größe\n{ROWS.replace(chr(10), ',1' + chr(10))},1\n",
        "json": json.dumps(columns, ensure_ascii=False),
        "request": json.dumps({"parameters": {"alpha": 0.1, "größe": 1}}, ensure_ascii=False),
        "result": json.dumps(canned().to_json() | {"größe": "ß"}, ensure_ascii=False),
        "report": json.dumps({"schema": "größe"}, ensure_ascii=False),
    }
    file = tmp_path / ("report.json" if door == "report" else f"c.{'csv' if door == 'csv' else 'json'}")
    file.write_bytes(texts[door].encode(encoding))
    words = {
        "request": ("solve", "tube", "--spec", file),
        "result": ("shape", file, tmp_path / "s.stl"),
        "report": ("report", tmp_path),
    }.get(door, (*COMPARE, file))
    if encoding not in ("utf-8-sig", "utf-7"):
        assert "is not UTF-8 text (byte " in orderly(call(*words), 2).err
        return
    # A byte order mark is no fault, and UTF-7 is ASCII: these are read, and judged by what they say.
    name = "größe" if encoding == "utf-8-sig" else "größe".encode(encoding).decode()
    status, said = {
        "csv": (1, ""),
        "json": (1, ""),
        "request": (2, f"tube has no parameter {name!r}; it has model"),
        "result": (0, ""),
        "report": (2, f"schema is {name!r}, expected 'weakforms.report/1'"),
    }[door]
    called = orderly(call(*words), status)
    assert said in called.err
    assert ("OUT OF BOUNDS" in called.out) == (status == 1)


@quickly
@given(
    st.integers(0, 10**9), st.sampled_from([b"", b"\0", b"\xff\xfe", b"\x1a", b'"', b"}", b"\r", b"1e999"])
)
def test_cut_and_spliced(tmp_path, place, splice):
    """Every file that is read may be cut at any place and have bytes inserted there."""
    request = json.dumps({"problem": "tube", "parameters": {"alpha": 0.1}, "at": {"p": 0.5}})
    folder = tmp_path / "requests"
    folder.mkdir(exist_ok=True)
    doors = {
        tmp_path / "c.csv": (f"u_max,p\n{ROWS}\n", (*COMPARE, tmp_path / "c.csv")),
        tmp_path / "r.json": (result_text(), ("shape", tmp_path / "r.json", tmp_path / "s.xdmf")),
        tmp_path / "s.json": (request, ("solve", "tube", "--spec", tmp_path / "s.json")),
        folder / "q.json": (request, ("batch", folder)),
    }
    for path, (text, words) in doors.items():
        raw = text.encode()
        at = place % (len(raw) + 1)
        for damaged in (raw[:at] + splice, raw[:at] + splice + raw[at:]):
            path.write_bytes(damaged)
            called = call(*words)
            assert called.status in (0, 1, 2, 5), "a request is solved, anything else is refused"
            assert "internal error" not in called.err + called.out
            if words[0] != "batch":
                orderly(called, 0, 1, 2, 5)


# -- shapes --------------------------------------------------------------------------------------

numbers = st.one_of(st.floats(), st.integers(-5, 5), st.integers(10**300, 10**310), st.none())
column = st.lists(numbers, max_size=4)
fields = st.lists(
    st.fixed_dictionaries(
        {
            "name": st.sampled_from(["profile", "triangles", ""]),
            "columns": st.dictionaries(
                st.sampled_from(
                    ["x", "y", "z", "r", "rho", "eta", "a", "b", "c", "Z", "Theta", "<&\"'\x1b]]>"]
                ),
                column,
                min_size=1,
            ),
        }
    ),
    max_size=3,
)


@quickly
@given(fields, st.sampled_from(["vtu", "xdmf", "stl"]))
def test_shapes_of_hostile_results(tmp_path, given_fields, suffix):
    data = canned().to_json()
    data["states"][0]["fields"] = given_fields
    (tmp_path / "r.json").write_text(json.dumps(data))
    file = tmp_path / f"s.{suffix}"
    called = orderly(call("shape", tmp_path / "r.json", file), 0, 2)
    assert file.exists() == (called.status == 0)
    file.unlink(missing_ok=True)
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")], "nothing half-written"


@quickly
@given(st.integers(0, 10**6), st.binary(max_size=6), st.sampled_from(["msh", "vtu", "stl"]), st.booleans())
def test_meshes_of_users(tmp_path, place, splice, suffix, cut):
    whole = (tmp_path / f"whole.{suffix}").absolute()
    if not whole.exists():
        write_mesh(whole)
    raw = whole.read_bytes()
    at = place % (len(raw) + 1)
    (tmp_path / f"m.{suffix}").write_bytes(raw[:at] + splice + (b"" if cut else raw[at + len(splice) :]))
    values = ("M=1", "delta=1", "load_start=0.1", "load_end=0.2")
    words = [word for value in values for word in ("--set", value)]
    orderly(call("solve", "surface", "--set", f"geometry={tmp_path}/m.{suffix}", *words), 0, 2)


def write_mesh(path) -> None:
    """A coarse tube as a user's file."""
    import meshio

    from weakforms.problems.triangles.meshes import tube

    found = tube(2.0, 3, 6)
    form = {"msh": "gmsh22", "vtu": "vtu", "stl": "stl"}[path.suffix[1:]]
    options = {"binary": False} if form != "vtu" else {"binary": True}
    meshio.write(path, meshio.Mesh(found.points, [("triangle", found.triangles)]), form, **options)


# -- options -------------------------------------------------------------------------------------

constants = st.dictionaries(
    st.sampled_from(["R_f", "C1", "h_o", "h", ""]),
    st.one_of(st.floats().map(repr), st.sampled_from(["1e308", "1e-308", "5e-324", "0", "x", "1e154"])),
)


@quickly
@given(constants, st.dictionaries(st.sampled_from(["p", "u_max", "V", "x"]), st.text(max_size=5), max_size=3))
def test_names_and_constants_of_curves(tmp_path, values, names):
    (tmp_path / "c.csv").write_text(f"u_max,p\n{ROWS}")
    words = [word for k, v in values.items() for word in ("--constant", f"{k}={v}")]
    words += [word for k, v in names.items() for word in ("--map", f"{k}={v}")]
    orderly(call(*COMPARE, tmp_path / "c.csv", *words), 0, 1, 2, 5)


@pytest.mark.parametrize("problem", registry.abouts())
def test_no_mesh_is_without_bounds(problem):
    """An unreasonable value of any numerical option is refused before memory is taken."""
    for name, field in registry.get(problem).numerics.model_fields.items():
        if field.annotation not in (int, int | None):
            continue
        for value in (10**9, 10**30, -1, math.nan):
            called = orderly(call("solve", problem, "--mesh", f"{name}={value}"), 2)
            assert name in called.err


# -- reference tables ----------------------------------------------------------------------------


@quickly
@given(st.integers(0, 10**6), st.binary(max_size=4), st.sampled_from([".csv", ".toml"]))
def test_tables(tmp_path, place, splice, suffix):
    source = references.ROOT / "reference_data" / "paper2" / CURVE
    folder = tmp_path / "reference_data" / "paper2"
    folder.mkdir(parents=True, exist_ok=True)
    for ending in (".csv", ".toml"):
        raw = source.with_name(CURVE + ending).read_bytes()
        if ending == suffix:
            at = place % (len(raw) + 1)
            raw = raw[:at] + splice + raw[at + len(splice) :]
        (folder / f"{CURVE}{ending}").write_bytes(raw)
    references.load.cache_clear()
    try:
        table = references.load(2, CURVE, tmp_path)
        assert set(table.uncertainty) == set(table.columns)
    except InputError:
        pass
    finally:
        references.load.cache_clear()


@pytest.mark.parametrize(
    "text",
    [
        "[" * 5000,
        "a = " + "[" * 5000,
        "a" * 10**6 + " = 1",
        ".".join("a" * 5000) + " = 1",
        codecs.BOM_UTF8.decode() + "a = 1",
        "sha256 = 1e400",
    ],
    ids=range(6),
)
def test_tables_of_toml_that_is_none(tmp_path, text):
    folder = tmp_path / "reference_data" / "paper2"
    folder.mkdir(parents=True)
    (folder / "x.toml").write_text(text)
    (folder / "x.csv").write_text("a,b\n1,2\n")
    with pytest.raises(InputError):
        references.load(2, "x", tmp_path)
