"""Curves from other programs: pages of verdicts, our own files, folders of requests."""

import json
import os
import re
from xml.etree import ElementTree

import jsonschema
import numpy as np
import pytest
from curves_of_a_tube import CASE, CURVE, ONLY_P, as_csv, table

from weakforms.results import Branch, Result
from weakforms.results.io import branch_csv
from weakforms.verification.cases import references
from weakforms.verification.run.requests import schema

# -- the verdict as files ------------------------------------------------------------------------


def test_a_page_of_the_verdict(weakforms, tmp_path):
    file = as_csv(tmp_path / "c.csv", table(p=1 + 1e-4))
    out = tmp_path / "verdict"
    called = weakforms(*ONLY_P, file, "--accuracy", "1e-6", "--out", out)
    assert called.status == 1
    assert sorted(path.name for path in out.iterdir()) == ["index.html", "p.svg", "verdicts.json"]
    data = json.loads((out / "verdicts.json").read_text())
    jsonschema.validate(data, schema("verdicts"))
    assert data["verdicts"][0]["where"].startswith("u_max = ")
    ElementTree.parse(out / "p.svg")
    page = (out / "index.html").read_text()
    assert "<svg" in page
    assert "failed" in page
    assert "<script" not in page


def test_a_page_that_cannot_be_written(weakforms, tmp_path):
    (tmp_path / "taken").write_text("")
    file = as_csv(tmp_path / "c.csv", table())
    called = weakforms("compare", CASE, file, "--curve", CURVE, "--out", tmp_path / "taken")
    assert (called.status, called.err.count("\n")) == (2, 1)


@pytest.mark.parametrize("state", ["passed", "failed", "not judged", "unclaimed"])
def test_pages_and_words_of_the_three_verdicts(weakforms, tmp_path, state):
    columns = references.load(2, CURVE).columns
    if state in ("failed", "unclaimed"):
        columns = columns | {"V": columns["V"] * (1 - 1e-3)}
    if state == "not judged":
        columns = {name: values for name, values in columns.items() if name != "p"}
    out, file = tmp_path / "verdict", as_csv(tmp_path / "c.csv", columns)
    claimed = ("--accuracy", "1e-6") if state == "failed" else ()
    called = weakforms("compare", CASE, file, "--curve", CURVE, "--out", out, *claimed)
    status, title, word = {
        "passed": (0, "Within bounds", "within"),
        "failed": (1, "Out of bounds", "OUT OF BOUNDS"),
    }.get(state, (5, "Not judged", "NOT JUDGED"))
    assert (called.status, called.err) == (status, "")
    assert word in called.out
    page = (out / "index.html").read_text()
    assert f"<title>{title}: {CURVE}" in page
    badge = "not judged" if state == "unclaimed" else state
    assert page.count(f"</span> {badge}</span>") == (5 if state == "passed" else 2)
    data = json.loads((out / "verdicts.json").read_text())
    jsonschema.validate(data, schema("verdicts"))
    assert (data["status"], data["passed"]) == (badge, status == 0)
    assert data["missing"] == (["p"] if state == "not judged" else [])
    asked = "claimed" if claimed else "asked of our own code"
    assert page.count(f"Accuracy {asked} ") == (3 if state == "unclaimed" else 4)
    if state in ("failed", "unclaimed"):
        (bad,) = [v for v in data["verdicts"] if v["status"] != "passed"]
        assert bad["signed_error"] == pytest.approx(-1e-3, rel=1e-6)
        assert bad["units"] == "yours / ours = 0.999 in every row: is 2 pi R_f^3 0.1 % too small?"
        assert bad["units"] in page
        assert bad["units"] in called.out
        assert "−1.0e-03" in page or "-1.0e-03" in page
    assert ("stroke-width: 1.8" in page) == (state == "failed"), "the ring at a row where a check fails"
    if state == "unclaimed":
        said = (
            "accuracy is claimed, and the curve does not reach the 5.0e-10 asked of our own code: "
            "it reaches 1.0e-03, which --accuracy 1e-03 claims"
        )
        assert bad["claim"] == f"no {said}"
        assert f"{CURVE}:V: no {said}\n" in called.out
        assert f"<p>No {said}.</p>" in page


def test_help_tells_the_exit_statuses(weakforms):
    for verb in ("compare", "batch"):
        said = " ".join(weakforms(verb, "--help").out.split())
        assert "5 not judged" in said


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--map", "p=u_max", "--map", "p=V"), "p is given twice"),
        (("--constant", "C1=1", "--constant", "C1=2"), "C1 is given twice"),
        (("--map", "p=V", "--map", "lam1_mid=V"), "can stand for one column only"),
    ],
)
def test_nothing_is_named_twice(weakforms, tmp_path, options, said):
    file = as_csv(tmp_path / "c.csv", references.load(2, CURVE).columns)
    called = weakforms("compare", CASE, file, "--curve", CURVE, *options)
    assert (called.status, called.err.count("\n")) == (2, 1)
    assert said in called.err


# -- our own files -------------------------------------------------------------------------------


def own_csv(path, branches):
    """A file of columns given by branch, as ``solve --format csv`` writes it."""
    made = Result("tube", {}, {}, {}, {}, [Branch(name, "p", found) for name, found in branches.items()])
    path.write_text(branch_csv(made))
    return path


def test_our_own_csv_is_a_curve(weakforms, tmp_path):
    right = references.load(2, CURVE).columns
    wrong = right | {"p": 2 * right["p"]}
    other = {name: values for name, values in right.items() if name != "V"}
    file = own_csv(tmp_path / "c.csv", {"secondary": wrong, "primary": right, "third": other})
    words = ("compare", CASE, file, "--curve", CURVE)
    assert weakforms(*words).status == 0
    assert weakforms(*words, "--branch", "primary").status == 0
    assert weakforms(*words, "--branch", "secondary").status == 1
    assert weakforms(*words, "--branch", "third").status == 5, "a column that it leaves empty is missing"
    called = weakforms(*words, "--branch", "fourth")
    assert called.status == 2
    assert "has no branch 'fourth'; it has secondary, primary, third" in called.err


def test_where_a_column_of_ours_has_no_meaning_it_need_not_have_a_number(weakforms, tmp_path):
    """The contact radius has no value before contact; within the table's range it must have one."""
    columns = {name: np.r_[np.nan, values] for name, values in references.load(2, CURVE).columns.items()}
    columns["u_max"][0] = 1e-3
    words = ("compare", CASE, own_csv(tmp_path / "c.csv", {"primary": columns}), "--curve", CURVE)
    assert weakforms(*words).status == 0
    columns["p"][5] = np.nan
    own_csv(tmp_path / "c.csv", {"primary": columns})
    called = weakforms(*words)
    assert (called.status, "column 'p' has no number in row 6" in called.err) == (2, True)
    assert weakforms("compare", CASE, as_csv(tmp_path / "d.csv", columns), "--curve", CURVE).status == 2


def test_what_has_no_table_is_not_offered(weakforms):
    called = weakforms("compare", "closed_form.disk", "c.csv")
    assert (called.status, called.err.count("\n")) == (2, 1)
    assert "closed_form.disk has no table of a curve to compare with" in called.err
    assert "closed_form.sphere, closed_form.test_pieces" in called.err
    curves = {entry["id"]: entry.get("curves") for entry in json.loads(weakforms("list", "--json").out)}
    assert (curves["closed_form.disk"], CURVE in curves[CASE]) == ([], True)
    shown = weakforms("show", "closed_form.disk").out
    assert "curves to compare with: none" in shown
    assert "accuracy asked (relative): each check has its own" in shown
    assert re.search(r"accuracy asked \(relative\): \w+ \d", weakforms("show", CASE).out)


# -- folders of requests -------------------------------------------------------------------------


@pytest.fixture
def requests(tmp_path):
    folder = tmp_path / "requests"
    folder.mkdir()
    as_csv(folder / "curve.csv", table())
    curve = {name: values.tolist() for name, values in table(p=1 + 1e-3).items()}
    written = {
        "good": {"case": CASE, "curve": "curve.csv", "name": CURVE, "columns": ["p"]},
        "missing": {"case": CASE, "curve": "curve.csv", "name": CURVE},
        "bad": {"case": CASE, "curve": curve, "name": CURVE, "accuracy": 1e-6},
        "coarse": {"case": CASE, "curve": curve, "name": CURVE, "columns": ["p"]},
        "solved": {"problem": "tube", "parameters": {"alpha": 0.2}, "at": {"u_max": 1.0}},
        "unknown": {"problem": "cube"},
        "escaping": {"case": CASE, "curve": "../secret.csv", "name": CURVE},
        "mixed": {"problem": "tube", "case": CASE, "curve": curve},
    }
    for name, data in written.items():
        (folder / f"{name}.json").write_text(json.dumps(data))
    (folder / "broken.json").write_text("{")
    return folder


STATUS = {"good": 0, "missing": 5, "bad": 1, "coarse": 5, "solved": 0}
STATUS |= dict.fromkeys(("unknown", "escaping", "mixed", "broken"), 2)


def test_a_folder_of_requests(weakforms, requests, solves):
    called = weakforms("batch", requests)
    assert (called.status, called.err) == (5, "")
    lines = dict(line.split(":", 1) for line in called.out.splitlines())
    assert {name: int(text.split()[0]) for name, text in lines.items()} == STATUS
    assert solves == ["tube"]
    for name, status in STATUS.items():
        data = json.loads((requests / "results" / f"{name}.json").read_text())
        kind = data["schema"].removeprefix("weakforms.").removesuffix("/1")
        assert kind == ("error" if status == 2 else "result" if name == "solved" else "verdicts")
        if kind != "result":
            jsonschema.validate(data, schema(kind))
        if kind == "error":
            assert data["exit_status"] == status
        if name == "coarse":
            assert data["verdicts"][0]["claim"].endswith("it reaches 1.0e-03, which --accuracy 1e-03 claims")
        if name == "mixed":
            assert "either a problem, or a case and a curve" in data["message"]


def test_resume_answers_only_what_is_missing_or_newer(weakforms, requests, solves):
    weakforms("batch", requests)
    (requests / "results" / "good.json").write_text("{}")
    assert weakforms("batch", requests, "--resume").status == 5
    assert solves == ["tube"]
    assert json.loads((requests / "results" / "good.json").read_text())["passed"]
    os.utime(requests / "solved.json", (4e9, 4e9))
    weakforms("batch", requests, "--resume")
    assert solves == ["tube", "tube"]


@pytest.mark.parametrize("what", ["missing", "empty", "itself", "file"])
def test_a_folder_that_will_not_do(weakforms, tmp_path, requests, what):
    (tmp_path / "empty").mkdir()
    (tmp_path / "file").write_text("")
    words = {"itself": (requests, "--out", requests)}.get(what, (tmp_path / what,))
    called = weakforms("batch", *words)
    assert (called.status, called.out, called.err.count("\n")) == (2, "", 1)


def test_schemas_are_sound():
    for name in ("request", "verdicts", "error"):
        jsonschema.Draft202012Validator.check_schema(schema(name))


@pytest.mark.parametrize("option", ["--name", "--curve"])
def test_the_table_has_one_name_in_python_and_in_a_shell(weakforms, tmp_path, option):
    columns = references.load(2, CURVE).columns
    wrong = as_csv(tmp_path / "c.csv", columns | {"p": 1.001 * columns["p"]})
    called = weakforms("compare", CASE, wrong, option, CURVE, "--column", "p", "--accuracy", "1e-6")
    assert (called.status, called.out.splitlines()[-1]) == (1, "verdict: failed")


def test_what_is_asked_of_our_own_code_is_no_claim_of_another(weakforms, tmp_path):
    columns = references.load(2, CURVE).columns
    path = as_csv(tmp_path / "c.csv", columns | {"p": columns["p"] * (1 + 1e-4 * columns["u_max"])})
    called = weakforms("compare", CASE, path, "--name", CURVE, "--column", "p")
    assert called.status == 5
    assert "does not reach the 1.0e-09 asked of our own code: it reaches 5.0e-04, which" in called.out
    called = weakforms("compare", CASE, path, "--name", CURVE, "--column", "p", "--accuracy", "1e-5")
    assert (called.status, "asked of our own code" in called.out) == (1, False)
    assert "the curve reaches 5.0e-04, not 1.0e-05" in called.out


def test_the_words_of_compare_with_a_solution(weakforms, tmp_path):
    lam = np.linspace(1.1, 2.0, 4)
    pressure = 4 * (lam - lam**-5 + 0.2 * (lam**3 - lam**-3)) / lam**2
    path = tmp_path / "mine.csv"
    path.write_text(
        "lam,P\n" + "\n".join(f"{a!r},{b!r}" for a, b in zip(lam.tolist(), pressure.tolist(), strict=True))
    )
    words = ("compare", "sphere", path, "--with", "solve", "--accuracy", "1e-9")
    assert weakforms(*words, "alpha=0.2").status == 0
    wrong = weakforms(*words, "alpha=0.1", "--cause")
    assert wrong.status == 1
    assert "sphere, solve" in wrong.out
    assert "the curve reaches" in wrong.out
    assert weakforms("compare", CASE, path, "alpha=0.2").status == 2
    stored = tmp_path / "r.json"
    assert weakforms("solve", "sphere", "alpha=0.2", "--at", f"lam=@{path}", "--out", stored).status == 0
    assert len(json.loads(stored.read_text())["states"]) == 4
    given = ("compare", "sphere", path, "--with", stored, "--over", "lam")
    assert weakforms(*given, "--accuracy", "1e-4").status == 0
    unclaimed = weakforms(*given)
    assert (unclaimed.status, "no accuracy is claimed" in unclaimed.out) == (5, True)
    assert unclaimed.out.splitlines()[-1] == "verdict: not judged"
    assert "no column 'P_'" in weakforms("solve", "sphere", "--at", f"P_=@{path}").err
