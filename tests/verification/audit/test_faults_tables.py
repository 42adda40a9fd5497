"""Reference tables computed again notice a change of the reference solvers."""

import pytest

from weakforms.verification.audit.faults import tables
from weakforms.verification.audit.faults.children import Answer
from weakforms.verification.audit.faults.findings import finding
from weakforms.verification.audit.faults.lines import Watchers
from weakforms.verification.audit.faults.tables import Source, compared, run_table, sources, watching
from weakforms.verification.cases.references import ROOT

TOML = "[columns.x]\nuncertainty = 0.0\n[columns.y]\nuncertainty = 1e-6\n"
SMALL = "sphere_limits_varga"


@pytest.fixture
def pair(tmp_path):
    """The verdicts on a table against another one with an uncertainty of 1e-6 in y."""

    def judge(new, committed="x,y\n1,2\n2,3\n", said="", toml=TOML, known=""):
        old = ("old.csv", committed), ("old.toml", known + TOML)
        texts = (("new.csv", new), ("new.toml", said + toml), *old)
        for name, text in texts:
            (tmp_path / name).write_text(text)
        found = compared(tmp_path / "new.csv", tmp_path / "old.csv")
        return [verdict["check"] for verdict in found if not verdict["passed"]]

    return judge


@pytest.mark.parametrize(
    ("new", "wrong"),
    [
        ("x,y\n1,2\n2,3\n", []),
        ("x,y\n1,2\n2,3.0000009\n", []),
        ("x,y\n1,2\n2,3.0000011\n", ["y"]),
        ("x,y\n1,2\n2.00001,3\n", ["x"]),
        ("x,y\n1,2\n", ["the table"]),
        ("x,z\n1,2\n2,3\n", ["the table"]),
        ("x,y\n1,2\n2,nan\n", ["y"]),
    ],
)
def test_columns_must_agree_within_the_stated_uncertainty(pair, new, wrong):
    assert pair(new) == wrong


def test_texts_of_a_table_must_agree(pair):
    assert pair("x,y\n1,2\n2,3\n", said='regenerate = "otherwise"\n') == []
    assert pair("x,y\n1,2\n2,3\n", said='notes = "another method"\n') == ["the table"]


@pytest.mark.parametrize(
    ("values", "wrong"),
    [
        ("V = 116.75352768405318\nn = 3", []),
        ("V = 116.7535\nn = 3", []),
        ("V = 116.755\nn = 3", ["the table"]),
        ("V = 116.75352768405318\nn = 4", ["the table"]),
        ("V = 116.75352768405318", ["the table"]),
    ],
)
def test_solved_numbers_among_the_parameters_may_differ_by_round_off_only(pair, values, wrong):
    known = "[parameters]\nV = 116.75352768405317\nn = 3\n"
    assert pair("x,y\n1,2\n2,3\n", said=f"[parameters]\n{values}\n", known=known) == wrong


@pytest.mark.parametrize(
    ("y", "x", "wrong"),
    [("1e-6", "0.0", []), ("2.9e-6", "0.0", []), ("3.4e-7", "0.0", []), ("3.1e-6", "0.0", ["y"]),
     ("3.3e-7", "0.0", ["y"]), ("0.0", "0.0", ["y"]), ("1e-6", "1e-300", ["x"])],
)  # fmt: skip
def test_uncertainties_must_be_of_the_committed_size(pair, y, x, wrong):
    toml = f"[columns.x]\nuncertainty = {x}\n[columns.y]\nuncertainty = {y}\n"
    assert pair("x,y\n1,2\n2,3\n", toml=toml) == wrong


def test_a_small_table_of_every_function_comes_first(monkeypatch):
    known = [Source(f"{name}{k}", name, 10, 20, k) for k in range(3) for name in ("near", "far", "other")]
    known.append(Source("inner", "near", 30, 40, 99))
    file = f"{tables.SOLVERS}core/x.py"
    assert watching(file, 5, {file: 0, "near": 1, "far": 2}, known) == [
        f"table {name}" for name in ("near0", "inner", "far0", "near1", "far1", "near2", "far2")
    ]
    monkeypatch.setattr(tables, "MOST", 2)
    assert watching(file, 5, {file: 0, "near": 1, "far": 2}, known) == ["table near0", "table inner"]
    here = {f"{tables.SOLVERS}near": 0}
    known = [Source(s.name, f"{tables.SOLVERS}{s.file}", s.first, s.last, s.size) for s in known]
    assert watching(f"{tables.SOLVERS}near", 33, here, known)[0] == "table inner"
    assert watching(f"{tables.SOLVERS}near", 12, here, known)[0] == "table near0"
    assert watching("weakforms/api.py", 5, {"near": 1}, known) == []


def test_every_table_has_a_function_in_the_reference_solvers():
    found = {source.name: source for source in sources()}
    assert set(found) == {path.stem for path in (ROOT / "reference_data").glob("*/*.csv")}
    source = found["primary_L_8_delta_2"]
    assert source.file == "reference_data/solvers/paper3/tables_primary.py"
    text = (ROOT / source.file).read_text().split("\n")
    assert text[source.first - 1].startswith("def ")


def test_the_tables_of_a_changed_line_are_among_what_is_run(tmp_path):
    file = "reference_data/solvers/closed_form/bodies.py"
    assert any(text.startswith("table sphere") for text, _ in Watchers(tmp_path).of(file, 1))


def test_a_table_computed_again_is_judged(tmp_path, monkeypatch):
    good = run_table(SMALL, tmp_path, ROOT)
    assert (good["status"], good["errors"]) == ("passed", [])
    assert len(good["verdicts"]) > 1
    gone = run_table("nothing", tmp_path, ROOT)
    answer = Answer("table nothing", gone["status"], 1.0, gone["verdicts"], gone["errors"])
    assert (gone["status"], finding(answer, False).kind) == ("failed", "comparison")
    monkeypatch.setattr(tables, "LONGEST", 0)  # the system ends it after a second
    assert run_table("coincidence", tmp_path, ROOT) == {"status": "passed", "verdicts": [], "errors": []}


@pytest.mark.parametrize(
    ("said", "kind"),
    [("difference 1e-3, combined uncertainty 1e-9", "comparison"), ("Newton: 1e-3", "not solved")],
)
def test_methods_that_disagree_are_a_verdict_and_a_stall_is_none(said, kind, tmp_path, monkeypatch):
    done = type("Done", (), {"returncode": 3, "stderr": f"[1/1] T: {said}"})
    monkeypatch.setattr(tables.subprocess, "run", lambda *_, **__: done)
    found = run_table("T", tmp_path, ROOT)
    answer = Answer("table T", found["status"], 1.0, found["verdicts"], found["errors"])
    assert finding(answer, False).kind == kind
