"""Every input gives a documented exit status and at most one line, never a traceback."""

import json
import os
import string
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mpi4py import MPI

from weakforms.verification.cases import references
from weakforms.verification.judging.outcome import Printed, Verdict
from weakforms.verification.run import verbs

CURVE = ("compare", "paper2.fig03", "--curve", "fig03a_delta1_1.1", "--column", "p")
quickly = settings(
    derandomize=True,
    database=None,
    deadline=2000,
    max_examples=int(os.environ.get("WEAKFORMS_EXAMPLES", "20")),
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
numbers = st.one_of(
    st.floats().map(repr),
    st.integers().map(str),
    st.integers(10**300, 10**400).map(str),
    st.sampled_from(
        ["nan", "-inf", "1e999", "0x1", "1_0", "", " ", "١", "True", "none", "1,5", "--debug", "[1]"]
    ),
    st.text(max_size=12),
)


def orderly(called: object, *allowed: int) -> None:
    assert called.status in allowed
    assert "internal error" not in called.err
    assert "Traceback" not in called.err + called.out
    assert called.err.count("\n") == (1 if called.status in (2, 4) else 0)
    if called.status == 2:
        assert called.out == ""
        assert called.err.startswith("weakforms: ")
        assert called.err[11:].strip()


@pytest.fixture(scope="module", autouse=True)
def nothing_is_solved(canned_solves):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(verbs, "verify", lambda *_: None)
        yield


def given_names(*known: str) -> st.SearchStrategy:
    return st.one_of(st.sampled_from(known), st.text(max_size=8))


pairs = st.one_of(
    st.text(max_size=20),
    st.builds(
        "{}={}".format,
        given_names(
            "alpha", "delta1", "lf", "contact", "extent", "p", "u_max", "limit_point", "V", "cells", "degree"
        ),
        numbers,
    ),
)


@quickly
@given(
    st.sampled_from(["tube", "tube_fold"]),
    st.lists(st.tuples(st.sampled_from(["--set", "--at", "--mesh"]), pairs)),
)
def test_solve_options(weakforms, problem, options):
    orderly(weakforms("solve", problem, *(f"{name}={value}" for name, value in options)), 0, 2)


@quickly
@given(st.text(max_size=20), st.text(max_size=20), st.integers())
def test_solve_words(weakforms, problem, branch, crossing):
    words = [f"--branch={branch}", f"--crossing={crossing}", "--", problem]
    orderly(weakforms("solve", *words), 0, 2)


json_values = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.just(10**400)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=5), inner, max_size=4)
    ),
    max_leaves=12,
)
requests = st.dictionaries(
    given_names("parameters", "at", "numerics"),
    st.one_of(
        json_values, st.dictionaries(given_names("alpha", "p", "u_max", "cells", "degree"), json_values)
    ),
)


@quickly
@given(st.one_of(requests.map(lambda value: json.dumps(value).encode()), st.binary(max_size=60)))
def test_request_files(weakforms, tmp_path, content):
    (tmp_path / "s.json").write_bytes(content)
    orderly(weakforms("solve", "tube", "--spec", tmp_path / "s.json"), 0, 2)


words = st.sampled_from(
    ["and", "or", "not", "(", ")", "paper2", "fig03", "fig", "x", "AND", "'", "__import__('os')"]
)


@quickly
@given(st.one_of(st.lists(words, max_size=30).map(" ".join), st.text(max_size=40)))
def test_expressions(weakforms, expression):
    called = weakforms("verify", f"-k={expression}")
    orderly(called, 0, 2)


@quickly
@given(st.text(string.printable, max_size=20))
def test_names(weakforms, name):
    for words in (("show", "--", name), ("check", "--", name), ("compare", "--", name, name), (name,)):
        orderly(weakforms(*words), 0, 2)


header = st.lists(given_names("u_max", "p", "V", "lam1_mid", "x"), min_size=1, max_size=4)
cells = st.one_of(numbers, st.floats(0, 5).map(repr))
tables = st.builds(
    lambda names, rows, separator, end: end.join(
        [separator.join(names), *(separator.join(row) for row in rows)]
    ),
    header,
    st.lists(st.lists(cells, max_size=4), max_size=8),
    st.sampled_from([",", ",", ";", "\t"]),
    st.sampled_from(["\n", "\r\n", "\n\n", "\r", "\x0b"]),
)
monotone = st.lists(st.floats(-1, 6), min_size=1, max_size=8, unique=True).map(
    lambda x: "u_max,p\n" + "\n".join(f"{v!r},{v * 2!r}" for v in sorted(x))
)


@quickly
@given(
    st.one_of(
        tables.map(lambda text: text.encode("utf-8", "surrogatepass")),
        monotone.map(str.encode),
        st.binary(max_size=80),
    )
)
def test_csv_curves(weakforms, tmp_path, content):
    (tmp_path / "c.csv").write_bytes(content)
    orderly(weakforms(*CURVE, tmp_path / "c.csv"), 0, 1, 2, 5)


json_curves = st.dictionaries(
    given_names("u_max", "p", "columns", "schema"),
    st.one_of(
        json_values,
        st.lists(st.floats(0, 5), max_size=6),
        st.just("weakforms.result/1"),
        st.dictionaries(given_names("u_max", "p"), st.lists(st.floats(0, 5), max_size=4)),
    ),
)


@quickly
@given(st.one_of(json_curves.map(lambda value: json.dumps(value).encode()), st.binary(max_size=60)))
def test_json_curves(weakforms, tmp_path, content):
    (tmp_path / "c.json").write_bytes(content)
    orderly(weakforms(*CURVE, tmp_path / "c.json", "--json"), 0, 1, 2, 5)


@quickly
@given(
    st.sampled_from(["nan", "1e-300", "0.999999", "0.1", "1", "-1", "1e-7"]),
    st.integers(0, 99),
    st.integers(1, 100),
)
def test_accuracies_and_parts(weakforms, tmp_path, accuracy, first, length):
    columns = references.load(2, "fig03a_delta1_1.1").columns
    part = slice(first, first + length)
    curve = {name: columns[name][part].tolist() for name in ("u_max", "p")}
    (tmp_path / "c.json").write_text(json.dumps(curve))
    called = weakforms(*CURVE, tmp_path / "c.json", f"--accuracy={accuracy}")
    orderly(called, 0, 1, 2, 5)
    # The table's own numbers agree; nobody can tell to 1e-300, and two rows are no curve.
    unjudged = accuracy == "1e-300" or len(curve["p"]) < 3
    assert called.status == (2 if accuracy in ("nan", "0.999999", "1", "-1") else 5 if unjudged else 0)


def damaged(value: object, path: list[int], new: object) -> object:
    """The value with one leaf or branch replaced."""
    if not path or not isinstance(value, dict | list) or not value:
        return new
    keys = list(value) if isinstance(value, dict) else list(range(len(value)))
    key = keys[path[0] % len(keys)]
    copy = dict(value) if isinstance(value, dict) else list(value)
    copy[key] = damaged(value[key], path[1:], new)
    return copy


@quickly
@given(st.lists(st.integers(0, 20), max_size=6), json_values)
def test_damaged_results(weakforms, tmp_path, path, new):
    result = json.loads(weakforms("solve", "tube").out)
    curve = references.load(2, "fig03a_delta1_1.1").columns
    result["branches"][0]["columns"] = {name: curve[name][:9].tolist() for name in ("u_max", "p")}
    (tmp_path / "c.json").write_text(json.dumps(damaged(result, path, new)))
    orderly(weakforms(*CURVE, tmp_path / "c.json"), 0, 1, 2, 5)


@quickly
@given(st.lists(st.integers(0, 20), max_size=8), json_values)
def test_damaged_reports(weakforms, tmp_path, path, new):
    run = {
        "schema": "weakforms.report/1",
        "status": "passed",
        "profile": "full",
        "selection": "",
        "started": "2024-01-01T00:00:00+00:00",
        "seconds": 0.0,
        "environment": {"dolfinx": "0"},
        "cases": [CASE],
    }
    (tmp_path / "report.json").write_text(json.dumps(damaged(run, path, new)))
    orderly(weakforms("report", tmp_path, "--out", tmp_path / "new"), 0, 2)


CASE = {
    "id": "paper2.x",
    "title": "t",
    "source": "s",
    "description": "d",
    "status": "passed",
    "verdicts": [vars(Verdict("c:p", "curve", True, "s", "d", 1e-9, 2e-9, 1e-8, reference="c"))],
    "panels": [],
    "printed": [vars(Printed("w", "1.0", 1.0, 1e-3, "reproduced"))],
    "convergence": [],
    "errors": [],
    "seconds": 1.0,
    "solutions": [{"spec": "tube()", "provenance": {"dolfinx": "0"}}],
}


@pytest.mark.parametrize(
    "words",
    [
        ("faults", "--only", "load-stiffness-dropped"),
        ("faults", "--random", "1"),
        ("faults", "--measure", "-k", "bounds"),
        ("audit", "--problem", "tube"),
        ("coverage", "--sets", "1"),
    ],
)
def test_what_starts_processes_of_its_own_is_refused_on_several_ranks(
    weakforms, words, tmp_path, monkeypatch
):
    ended = []
    two = SimpleNamespace(size=2, rank=0, Get_rank=lambda: 0, Get_size=lambda: 2, Abort=ended.append)
    two.Isend = two.Irecv = lambda *_: SimpleNamespace(Test=lambda: True)  # the other rank refuses it too
    monkeypatch.setattr(MPI, "COMM_WORLD", two)
    called = weakforms(*words, "--out", tmp_path / "out")
    monkeypatch.undo()
    assert called.status == 2
    assert "runs on one rank, not on 2: start it without mpirun" in called.err
    assert not ended, "every rank refuses it by itself"
    assert not list(tmp_path.iterdir())
