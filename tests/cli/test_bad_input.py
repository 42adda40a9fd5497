"""Bad input: exit status 2, one line that names the error and what is allowed, and nothing done."""

import json
import os
import re
import shutil
from pathlib import Path

import pytest

from weakforms.errors import InputError
from weakforms.verification.cases import discovery, references
from weakforms.verification.cases.references import checksum
from weakforms.verification.run import solving

CASE, CURVE = "paper2.fig03", "fig03a_delta1_1.1"
TUBE = "solve tube --out new/r.json"
COMPARE = f"compare {CASE} --curve {CURVE}"


# -- words ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("bogus", "'bogus'"),
        ("solve", "'PROBLEM'"),
        ("solve tube --bogus", "--bogus"),
        ("solve nope --out new/r.json", "'nope' tube tube_fold"),
        (f"{TUBE} --set beta=1", "'beta' alpha delta1 lf"),
        (f"{TUBE} --set problem=1", "'problem' alpha"),
        (f"{TUBE} --set at=1", "'at' alpha"),
        (f"{TUBE} --set alpha=nan", "alpha 'nan' finite"),
        (f"{TUBE} --set alpha=inf", "alpha 'inf'"),
        (f"{TUBE} --set alpha=-0.001", "alpha '-0.001' greater than or equal to 0"),
        (f"{TUBE} --set delta1=0.99", "delta1 '0.99' greater than or equal to 1"),
        (f"{TUBE} --set lf=0.9", "lf '0.9' greater than or equal to 1"),
        (f"{TUBE} --set delta1=5.01", "delta1 '5.01' less than or equal to 5"),
        (f"{TUBE} --set alpha=much", "alpha 'much' number"),
        (f"{TUBE} --set alpha", "parameter 'alpha' NAME=VALUE"),
        (f"{TUBE} --set =1", "parameter '=1' NAME=VALUE"),
        (f"{TUBE} --set phase=deflation", "phase 'deflation' allowed"),
        (f"{TUBE} --set contact=glue", "contact 'glue' 'none'"),
        (f"{TUBE} --mesh cells=4", "cells '4' greater than or equal to 8"),
        (f"{TUBE} --mesh cells=97", "cells multiple of 4"),
        (f"{TUBE} --mesh degree=2.5", "degree '2.5' integer"),
        (f"{TUBE} --mesh levels=1", "levels '1' greater than or equal to 2"),
        (f"{TUBE} --mesh nodes=4", "'nodes' degree cells levels"),
        (f"{TUBE} --at rho=1", "'rho' p u_max"),
        (f"{TUBE} --at residual=0", "'residual' p u_max"),
        (f"{TUBE} --at p=high", "p 'high' number"),
        (f"{TUBE} --at p=nan", "p nan finite"),
        (f"{TUBE} --at limit_point=0", "limit_point 0 whole number from 1"),
        (f"{TUBE} --at limit_point=1.5", "limit_point 1.5 whole number from 1"),
        (f"{TUBE} --at p=1 --crossing 0", "crossing 0 1 or more"),
        (f"{TUBE} --crossing -1", "crossing -1 1 or more"),
        (f"{TUBE} --crossing two", "'two' whole number"),
        (f"{TUBE} --branch other", "'other' primary"),
        (f"{TUBE} --at p=1 --branch secondary", "secondary = true"),
        (f"{TUBE} --branch secondary", "'secondary' at"),
        (f"{TUBE} --format xml", "'xml' json csv"),
        (f"{TUBE} --spec missing.json", "missing.json No such file"),
        ("check paper2.fig99 --out new", "'paper2.fig99' paper2.fig09"),
        ("check paper2.fig02 nope --out new", "'nope' list"),
        ("verify -k fig99 --out new", "'fig99' weakforms list"),
        ("verify -k not --out new", "'not'"),
        ("verify --paper 6 --out new", "--paper 6"),
        ("verify --paper 6 --out new", "6 1<=x<=5"),
        ("verify --profile slow --out new", "'slow' quick full"),
        ("verify -j 0 --out new", "-j 0 1<=x<=64"),
        ("show tubes", "'tubes' tube list"),
        ("list --paper 0", "0 1<=x<=5"),
        ("report missing", "missing report.json"),
        (f"compare {CASE} c.csv", f"which curve? {CURVE}"),
        (f"compare {CASE} c.csv --curve nope", f"'nope' {CURVE}"),
        ("compare paper2.figure03 c.csv", "'paper2.figure03' paper2.fig03"),
        (f"{COMPARE} c.csv --accuracy 0", "accuracy 0.0 between 0 and 1"),
        (f"{COMPARE} c.csv --accuracy nan", "accuracy nan between 0 and 1"),
        (f"{COMPARE} c.csv --accuracy little", "accuracy 'little'"),
    ],
)
def test_words(refused, words, said):
    refused(words, *said.split())


@pytest.mark.parametrize(("option", "said"), [("--set", "parameter"), ("--at", "--at"), ("--mesh", "--mesh")])
def test_empty_values(refused, option, said):
    for value in ("", " ", "=", "alpha= "):
        refused([*TUBE.split(), option, value], said, "NAME=VALUE")


@pytest.mark.parametrize(
    "expression", ["", "(" * 5000, "(" * 3000 + "a" + ")" * 3000, "a b", "a or", ")", "not " * 900]
)
def test_expressions(refused, expression):
    refused(["verify", "-k", expression, "--out", "new"], "expression")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[1]", "object list"),
        ("{", "not JSON"),
        ('{"parameter": {}}', "'parameter' parameters at numerics"),
        ('{"parameters": [1]}', "'parameters' object"),
        ('{"at": {"p": null}}', "p None number"),
        ('{"at": {"p": true}}', "p True number"),
        ('{"at": {"p": ' + "9" * 400 + "}}", "p number"),
        ('{"parameters": {"alpha": ' + "9" * 400 + "}}", "alpha number"),
        ('{"parameters": {"alpha": ' + "9" * 5000 + "}}", "not JSON"),
        ('{"parameters": {"alpha": NaN}}', "alpha nan finite"),
        ('{"parameters": {"alpha": ' + "[" * 900 + "]" * 900 + "}}", "alpha number"),
        ('{"parameters": ' + "[" * 100_000, "not JSON"),
    ],
)
def test_request_files(refused, text, said):
    Path("s.json").write_text(text)
    refused(f"{TUBE} --spec s.json", *said.split())


# -- places to write -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("solve tube --out file/r.json", "file"),
        ("solve tube --out folder", "folder a folder"),
        ("solve tube --out " + "x" * 250, "File name too long"),
        ("solve tube --out folder/" + "x/" * 9 + "y" * 300 + "/r.json", "File name too long"),
        ("verify -k fig05 --out file", "file"),
        ("verify -k fig05 --out file/below", "file"),
        ("check paper2.fig05 --out file/below", "file"),
        ("check paper2.fig05 --out folder/1", "solutions"),
        ("check paper2.fig05 --out folder/2", "report"),
        ("report run --out file", "file"),
    ],
)
def test_places_that_cannot_be_written(refused, weakforms, words, said):
    Path("file").write_text("mine")
    for folder, taken in (("1", "solutions"), ("2", "report")):
        Path("folder", folder).mkdir(parents=True)
        Path("folder", folder, taken).write_text("mine")
    Path("folder", "2", "solutions").mkdir()
    Path("run").mkdir()
    Path("run/report.json").write_text(json.dumps(RUN))
    if "x/x" in words:
        Path("folder", *"x" * 9).mkdir(parents=True)
    refused(words, *said.split())


RUN = {
    "schema": "weakforms.report/1",
    "status": "passed",
    "profile": "full",
    "selection": "",
    "started": "2024-01-01T00:00:00+00:00",
    "seconds": 0.0,
    "environment": {},
    "cases": [],
}


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_folder_without_permission(refused):
    Path("locked").mkdir(mode=0o500)
    refused("solve tube --out locked/r.json", "locked", "Permission denied")


@pytest.mark.parametrize("damage", [b"", b"{", b"[]", b"{}", b"\xff\xfe", b"[" * 100_000, b"1" * 5000])
def test_stored_reports(refused, damage):
    Path("run").mkdir()
    Path("run/report.json").write_bytes(damage)
    refused("report run --out new", "report.json")


# -- reference tables and case files -------------------------------------------------------------


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """A copy of one case and its tables that the program uses instead of the original."""
    source = references.ROOT
    for part in ("cases/paper2/fig03.py", "reference_data/paper2"):
        (tmp_path / part).parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if (source / part).is_dir() else shutil.copy)(source / part, tmp_path / part)
    find, load = discovery.find_cases, references.load
    monkeypatch.setattr(discovery, "find_cases", lambda: find(tmp_path))
    monkeypatch.setattr(references, "load", lambda paper, name: load(paper, name, tmp_path))
    yield tmp_path / "reference_data" / "paper2" / CURVE
    find.cache_clear()
    load.cache_clear()


@pytest.mark.parametrize(
    ("suffix", "change", "said"),
    [
        (".csv", lambda raw: raw[: len(raw) // 2], "truncated or altered checksum regenerate"),
        (".csv", lambda raw: raw.replace(b"0.338", b"0.339"), "truncated or altered checksum regenerate"),
        (".csv", lambda raw: b"", "truncated or altered"),
        (".csv", lambda raw: None, "No such file"),
        (".toml", lambda raw: raw[:100], "TOML"),
        (".toml", lambda raw: b"\xff", "TOML"),
        (".toml", lambda raw: None, "No such file"),
        (
            ".toml",
            lambda raw: raw.replace(b'"independent"', b'"guessed"'),
            "'guessed' exact independent printed",
        ),
        (".toml", lambda raw: raw.replace(b"5.5e-12", b"nan"), "uncertainty of p nan"),
        (".toml", lambda raw: raw.replace(b"5.5e-12", b'"small"'), "uncertainty of p 'small'"),
        (".toml", lambda raw: raw.replace(b"[columns.p]", b"[columns.q]"), "uncertainty of p None"),
        (".toml", lambda raw: raw.replace(b'abscissa = "u_max"', b'abscissa = "x"'), "abscissa 'x' u_max, p"),
        (".toml", lambda raw: raw.replace(b"delta1 = 1.1\n", b"delta1 = 1.2\n"), "delta1 1.2 1.1"),
    ],
)
def test_damaged_table(refused, tree, suffix, change, said):
    path = tree.with_name(tree.name + suffix)
    raw = path.read_bytes()
    damaged = change(raw)
    assert damaged != raw
    if damaged is None:
        path.unlink()
    else:
        path.write_bytes(damaged if suffix == ".csv" else sealed(damaged, tree.with_name(f"{tree.name}.csv")))
    refused("verify -k fig03 --out new", tree.name, *said.split())


def sealed(about: bytes, numbers: Path) -> bytes:
    """A description with the checksum that belongs to it."""
    return re.sub(rb'"[0-9a-f]{64}"', b'"%s"' % checksum(numbers.read_bytes(), about).encode(), about)


@pytest.mark.parametrize(
    ("before", "after"), [(b"5.5e-12", b"5.5e-2"), (b"delta1 = 1.1\n", b"delta1 = 1.2\n")]
)
def test_a_description_that_was_altered_is_refused(refused, tree, before, after):
    """An uncertainty that is too large would let a wrong curve pass."""
    path = tree.with_name(tree.name + ".toml")
    assert before in path.read_bytes()
    path.write_bytes(path.read_bytes().replace(before, after))
    refused("verify -k fig03 --out new", tree.name, "altered", "checksum", "regenerate")


def test_the_copied_tree_itself_is_sound(tree, monkeypatch, weakforms):
    def first_solve(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(solving, "solve_spec", first_solve)
    called = weakforms("verify", "-k", "fig03", "--out", tree.parents[2] / "out")
    assert (called.status, called.out) == (130, "")
    assert called.complaints == ["weakforms: interrupted; the same command with --resume continues"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("CASE = 3", "no CASE"),
        ("CASE = (", "SyntaxError"),
        ("raise SystemExit(0)", "SystemExit"),
        ("import no_such_module", "no_such_module"),
        ("\0", "fig03.py"),
    ],
)
def test_damaged_case_file(refused, tree, text, said):
    tree.parents[2].joinpath("cases", "paper2", "fig03.py").write_text(text)
    refused("verify --out new", "fig03.py", said)


def test_python_refuses_what_the_command_refuses(solves):
    from weakforms import compare, solve

    for call in (
        lambda: solve("tube", alpha=float("nan")),
        lambda: solve("tube", beta=1),
        lambda: solve("tube", at={"p": "x"}),
        lambda: compare(CASE, {"u_max": [1, 2], "p": [1]}, CURVE),
        lambda: compare(CASE, {"u_max": [1, 2], "p": [1, 10**400]}, CURVE),
        lambda: compare(CASE, {"u_max": [[1, 2]], "p": [[1, 2]]}, CURVE),
        lambda: compare(CASE, {}, CURVE),
    ):
        with pytest.raises(InputError):
            call()
    assert solves == []
