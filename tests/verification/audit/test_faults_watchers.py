"""Who sees a changed line: tests that were measured to run it, and tests that probably do."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from weakforms.verification.audit.faults import lines
from weakforms.verification.audit.faults.children import Answer, Children
from weakforms.verification.audit.faults.lines import Measured, Watchers, digest, measure, measured, using
from weakforms.verification.cases.references import ROOT

BOUNDS = "tests/verification/judging/test_bounds.py"


def test_lines_are_noted_once_and_kept(tmp_path, monkeypatch):
    assert measure([BOUNDS], tmp_path, False, lambda *_: None) == 0
    (found,) = measured(tmp_path)
    assert (found.unit, found.passed) == (BOUNDS, True)
    test = f"{BOUNDS}::test_two_numbers"
    source = (ROOT / "weakforms/verification/judging/bounds.py").read_text().split("\n")
    line = next(k for k, text in enumerate(source, 1) if "bound = FACTOR * np.hypot" in text)
    assert found.sees(test, "weakforms/verification/judging/bounds.py", line, ROOT)
    docstring = next(k for k, text in enumerate(source, 1) if text.strip().startswith('r"""'))
    assert not found.sees(test, "weakforms/verification/judging/bounds.py", docstring, ROOT)
    assert 0 < found.seconds[test] < 60
    monkeypatch.setattr(Children, "run", lambda *_: pytest.fail("it was run again"))
    assert measure([BOUNDS], tmp_path, True, lambda *_: None) == 0
    nothing = SimpleNamespace(watching=lambda *_: iter([]), reach=lambda _: {}, first=lambda *_: [])
    monkeypatch.setattr(lines, "Imports", lambda _: nothing)
    first = Watchers(tmp_path).of("weakforms/verification/judging/bounds.py", line)
    assert test in [text for text, _ in first[:4]]


def test_units_measured_side_by_side_are_all_kept_and_failures_counted(tmp_path, monkeypatch):
    def run(_self, _root, units, *_args, **_kwargs):
        return [Answer(units[0], "failed" if units[0] == "b" else "passed", 1.0, [], [])], ""

    monkeypatch.setattr(Children, "run", run)
    monkeypatch.setattr(lines, "digest", lambda _: "")
    told = []
    assert measure(list("abcd"), tmp_path, False, lambda *said: told.append(said), jobs=2) == 1
    failing = {found.unit for found in measured(tmp_path) if not found.passed}
    assert (len(measured(tmp_path)), failing) == (4, {"b"})
    assert [k for k, *_ in told] == [1, 2, 3, 4]
    assert sorted(unit for *_, unit in told) == list("abcd")


def known(unit, own=None, **seen):
    seconds = {f"{unit}::{name}": float(k) for k, name in enumerate(seen, 1)}
    noted = {f"{unit}::{name}": {"weakforms/x.py": numbers} for name, numbers in seen.items()}
    noted |= {"": {"weakforms/x.py": own or []}}
    return Measured(unit, True, seconds, noted, {"weakforms/x.py": digest(ROOT / "weakforms/x.py")})


def test_the_fastest_that_run_a_line_come_first_then_those_beside_them(tmp_path, monkeypatch):
    here = known("tests/a.py", slow=[3], quick=[4], other=[3])
    there = known("tests/b.py", elsewhere=[9])
    monkeypatch.setattr(lines, "measured", lambda _: [there, here])
    near = SimpleNamespace(
        watching=lambda *_: iter(["tests/c.py::guessed", "tests/d.py::contract"]),
        reach=lambda _: {},
        first=lambda *_: ["tests/d.py::contract"],
    )
    monkeypatch.setattr(lines, "Imports", lambda _: near)
    watchers = Watchers(tmp_path)
    here.seconds["tests/a.py::elsewhere"] = 0.1  # the fastest, and it runs nothing of the file
    order = ["slow", "other", "quick", "elsewhere"]
    found = [text for text, _ in watchers.of("weakforms/x.py", 3)]
    tests = [*(f"tests/a.py::{name}" for name in order), "tests/c.py::guessed"]
    assert found == ["tests/d.py::contract", *tests]
    monkeypatch.setattr(lines.tables, "watching", lambda *_: ["table t"])
    found = [text for text, _ in watchers.of("weakforms/x.py", 3)]
    assert found.index("tests/a.py::quick") < found.index("table t") < found.index("tests/a.py::elsewhere")
    changed = replace(here, digests={"weakforms/x.py": "another"})
    assert changed.sees("tests/a.py::quick", "weakforms/x.py", 3, ROOT), "any line of a file that changed"


def test_a_line_that_no_measured_unit_ran_is_guessed_at_by_imports_of_all_units(tmp_path, monkeypatch):
    monkeypatch.setattr(lines, "measured", lambda _: [known("tests/a.py", quick=[4])])
    near = SimpleNamespace(
        watching=lambda _, _line, known: iter(sorted(known) or ["all"]),
        reach=lambda _: {},
        first=lambda *_: [],
    )
    monkeypatch.setattr(lines, "Imports", lambda _: near)
    watchers = Watchers(tmp_path)
    assert [text for text, _ in watchers.of("weakforms/x.py", 4)][-1] == "tests/a.py"
    assert [text for text, _ in watchers.of("weakforms/x.py", 20)] == ["all"]


def test_a_line_that_runs_on_import_is_seen_by_those_who_use_what_it_defines(tmp_path):
    (tmp_path / "x.py").write_text(SOURCE)
    for line, users in ((1, {11}), (4, {7}), (2, {7, 11}), (10, {11}), (7, {7}), (9, {7, 11})):
        assert using(tmp_path / "x.py", line) == users, line
    assert using(tmp_path / "none.py", 3) == {3}


SOURCE = """\
LIMIT = 1.5
call()
class Kept:
    size: int = 2

    def twice(self):
        return 2 * self.size

OTHER = 3
def limited(x, least=0.0):
    return max(min(x, LIMIT), least)
"""


def test_a_changed_test_file_is_guessed_at_although_it_was_measured(tmp_path, monkeypatch):
    monkeypatch.setattr(lines, "measured", lambda _: [known("tests/a.py", quick=[4])])
    near = SimpleNamespace(
        watching=lambda _, _line, known: iter(["tests/a.py::new"] if "tests/a.py" not in known else []),
        reach=lambda _: {},
        first=lambda *_: [],
    )
    monkeypatch.setattr(lines, "Imports", lambda _: near)
    changed = tmp_path / "tests" / "a.py"
    changed.parent.mkdir()
    changed.write_text("")
    for root, expected in ((ROOT, ["quick"]), (tmp_path, ["quick", "new"])):
        seen = [text for text, _ in Watchers(tmp_path, root).of("weakforms/x.py", 4)]
        assert seen == [f"tests/a.py::{name}" for name in expected]


def test_tests_named_as_the_file_come_before_all_others(tmp_path):
    found = [text for text, _ in Watchers(tmp_path).of("weakforms/solvers/support/jit_cache.py", 69)]
    assert found[0].startswith("tests/solvers/test_jit_cache.py::")
    watchers = Watchers(tmp_path)
    watchers._measured = [known("tests/a.py", quick=[69])]
    again = [text for text, _ in watchers.of("weakforms/solvers/support/jit_cache.py", 69)]
    assert again[0] == found[0]


def test_without_a_measurement_imports_say_who_may_see_it(tmp_path):
    found = [text for text, _ in Watchers(tmp_path).of("weakforms/solvers/uncertainty/refinement.py", 1)]
    assert found[0].startswith("tests/solvers/test_refinement.py::")
    assert any(text.startswith("paper") for text in found)
    tables = [
        text for text, _ in Watchers(tmp_path).of("reference_data/solvers/paper5/tables_hemisphere.py", 1)
    ]
    assert (
        "tests/references/paper2/test_tube_methods.py::test_regenerated_table_equals_the_committed_one"
        in tables
    )
    assert not any("test_faults" in text for text in found)


def test_files_that_few_words_of_the_line_point_to_are_guessed_first(tmp_path):
    about = "weakforms/problems/wrinkled/sheets/about.py"
    lines_ = (ROOT / about).read_text("utf-8").split("\n")
    line = next(k for k, text in enumerate(lines_, 1) if "held_out=" in text)
    found = [text for text, _ in Watchers(tmp_path).of(about, line)]
    assert found[0].startswith("tests/house/test_contract.py::")
    assert "audit/test_coverage.py" in next(text for text in found if "test_contract" not in text)


def test_a_line_of_a_reference_solver_is_first_tried_on_what_tables_ask_for(tmp_path):
    found = [text for text, _ in Watchers(tmp_path).of("reference_data/solvers/paper2/tables_free.py", 176)]
    assert found[0] == "tests/references/test_tables_asked.py::test_tables_ask_for_what_is_committed"


@pytest.mark.parametrize(
    ("file", "said", "on_ranks"),
    [
        ("weakforms/solvers/equilibrium/state.py", "scatter_forward()", True),
        ("weakforms/problems/triangles/readings.py", "comm.", True),
        ("weakforms/solvers/uncertainty/refinement.py", "spread = float", False),
    ],
)
def test_a_line_that_speaks_of_ranks_is_tried_on_ranks(file, said, on_ranks, tmp_path):
    rows = (ROOT / file).read_text("utf-8").split("\n")
    line = next(k for k, text in enumerate(rows, 1) if said in text)
    before = ("test_contract.py", "test_" + file.split("/")[-1])
    found = [text for text, _ in Watchers(tmp_path).of(file, line)]
    after = [text for text in found if not any(name in text for name in before)]
    assert after[0].startswith("tests/mpi/") == on_ranks
    assert not any(text.startswith("tests/mpi/test_every_kind") for text in found)
    assert len(found) == len(set(found))


@pytest.mark.parametrize(
    ("file", "test"),
    [
        ("weakforms/problems/triangles/model.py", "test_relaxed_surface_ranks.py::test_surface"),
        ("weakforms/problems/triangles/readings.py", "test_rectangle_ranks.py::test_rectangle"),
        ("weakforms/problems/wrinkled/state.py", "test_relaxed_ranks.py::test_waves_around_the_cylinder"),
    ],
)
def test_tests_on_ranks_are_those_of_what_uses_the_file(file, test, tmp_path):
    rows = (ROOT / file).read_text("utf-8").split("\n")
    line = next(k for k, text in enumerate(rows, 1) if "comm" in text)
    found = [text for text, _ in Watchers(tmp_path).of(file, line)]
    assert f"tests/mpi/{test}" in found
