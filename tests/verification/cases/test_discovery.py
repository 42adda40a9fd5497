"""Cases are found by their place and selected by expressions that are parsed, never run."""

import ast
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

import weakforms
from weakforms import At, api, tube
from weakforms.errors import InputError
from weakforms.solvers.support import provenance
from weakforms.verification.cases import discovery
from weakforms.verification.cases.discovery import Expression, case_ids, find_cases, get_case, select
from weakforms.verification.run.plan import Plan, case_wants, check_ids
from weakforms.verification.run.solving import SOLVING, solution_key, source_digest

FILE = '"""A case."""\nfrom weakforms import Case\nCASE = Case(title="t", source="s", tags=("Slow",))\n'


@pytest.mark.parametrize(
    ("expression", "matched"),
    [
        ("a", "a ab abc"),
        ("A", "a ab abc"),
        ("a and c", "abc"),
        ("c or d", "abc c d"),
        ("not a", "c d"),
        ("not not a", "a ab abc"),
        ("a and not (b or c)", "a"),
        ("not a and not c", "d"),
        ("not (a and b) and not d", "a c"),
        ("c and d or ab", "ab abc"),
        ("(c)", "abc c"),
        ("android", ""),
        ("a.b", ""),
    ],
)
def test_expressions(expression, matched):
    words = ["a", "ab", "abc", "c", "d"]
    assert [w for w in words if Expression(expression).matches(w)] == matched.split()


@pytest.mark.parametrize(
    "expression", ["", "  ", "and", "a and", "or a", "not", "a b", "(a", "a)", "()", "a and and b", "(" * 999]
)
def test_malformed_expressions(expression):
    with pytest.raises(InputError, match="expression"):
        Expression(expression)


def test_deepest_allowed_expression_is_read():
    Expression("(" * 99 + "a" + ")" * 99).matches("a")
    assert Expression("not " * 198 + "a").matches("a")


def test_cases_are_found_by_their_place(tmp_path):
    for name in (
        "paper2/b.py",
        "paper2/a.py",
        "paper1/z.py",
        "paper2/_shared.py",
        "paper9/x.py",
        "other/y.py",
    ):
        path = tmp_path / "cases" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(FILE)
    found = find_cases(tmp_path)
    assert [c.id for c in found] == ["paper1.z", "paper2.a", "paper2.b"]
    assert found[0].description == "A case."
    assert found[0].words == "paper1.z slow"


def test_ids_need_no_reading_of_the_cases():
    assert case_ids() == api.cases()


def test_selection(monkeypatch):
    assert [c.id for c in select()] == api.cases()
    assert {c.paper for c in select(paper=2)} == {2}
    both = [c.id for c in select(expression="paper2.fig02 or paper2.fig03 or paper2.fig04 or paper2.fig05")]
    assert both == ["paper2.fig02", "paper2.fig03", "paper2.fig04", "paper2.fig05"]
    assert [c.id for c in select(2, "fig03")] == ["paper2.fig03"]
    for arguments in ((6, None), (2, "nothing"), (1, "long_tube")):
        with pytest.raises(InputError, match="no case matches"):
            select(*arguments)


def test_unknown_case_names_those_close_to_it():
    with pytest.raises(InputError, match=r"'paper2\.fig3'; close to it: .*paper2\.fig03"):
        get_case("paper2.fig3")


def test_a_plan_reads_the_tables_before_anything_is_solved():
    """A check whose table is not in order is refused with the plan, although it wants no solution."""

    class Unsound:
        def wants(self, _paper):
            return []

        def names(self, _paper):
            raise InputError("the table is not in order")

    found = get_case("paper2.fig04")
    with pytest.raises(InputError, match="not in order"):
        Plan.of([replace(found, case=replace(found.case, checks=(Unsound(),)))])


def test_a_plan_solves_shared_solutions_once_with_all_states_wanted():
    cases = [get_case("paper2.fig04"), get_case("paper2.fig05")]
    plan, alone = Plan.of(cases), [Plan.of([c]) for c in cases]
    shared = tube(alpha=0.1, delta1=1)
    assert all(shared in p.states for p in alone)
    wanted = {
        (at.name, at.value, at.crossing) for c in cases for s, at in case_wants(c) if s == shared and at
    }
    keys = [(at.name, at.value, at.crossing) for at in plan.states[shared]]
    assert sorted(keys) == sorted(wanted)
    points = {p for _, at in case_wants(cases[1]) if at and at.value == 1.5 for p in at.profile or ()}
    merged = next(at for at in plan.states[shared] if (at.name, at.value) == ("p", 1.5))
    assert points <= set(merged.profile)


def test_solution_keys_tell_requests_and_code_apart(monkeypatch):
    one, at = tube(alpha=0.1), At("p", 1.0)
    keys = {
        solution_key(spec, states)
        for spec in (one, tube(alpha=0.2), one.on(degree=2), one.at(lf=7))
        for states in ([], [at], [At("p", 1.0, 2)], [At("p", 1.0, profile=(0.5,))])
    }
    assert len(keys) == 16
    assert solution_key(one, [at]) == solution_key(tube(alpha=0.1), [At("p", 1.0)])
    assert solution_key(tube(lf=6, n=(1, 2)), []) == solution_key(tube(lf=6.0, n=(1.0, 2)), [])
    assert solution_key(tube(lf=True), []) != solution_key(tube(lf=1), [])
    monkeypatch.setattr("weakforms.verification.run.solving.source_digest", lambda: "other code")
    assert solution_key(one, [at]) not in keys


@pytest.mark.parametrize("package", ["dolfinx", "petsc", "slepc", "numpy", "scipy"])
def test_solution_keys_tell_versions_apart(package, monkeypatch):
    before = solution_key(tube(), [])
    found = provenance.versions() | {package: "0"}
    monkeypatch.setattr(provenance, "versions", lambda: found)
    assert solution_key(tube(), []) != before


def test_solution_keys_tell_apart_all_source_that_numbers_come_from(tmp_path):
    package = tmp_path / "weakforms"
    shutil.copytree(Path(weakforms.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))

    def changes(path: Path) -> bool:
        text = path.read_text()
        path.write_text(text + "# changed\n")
        changed = source_digest(package)
        path.write_text(text)
        source_digest.cache_clear()
        return changed != whole

    whole = source_digest()
    assert source_digest(package) == whole
    source_digest.cache_clear()
    parts = [max((p for p in folder.glob("*.py")), default=None) for folder in package.rglob("*/")]
    parts = [*package.glob("*.py"), *filter(None, parts), *map(package.joinpath, SOLVING)]
    told = {path.relative_to(package).as_posix(): changes(path) for path in parts}
    aside = {name for name, tells in told.items() if not tells}
    assert {name for name in aside if "/" not in name} == {
        *("terminal.py", "pytest_plugin.py", "__main__.py", "world.py")
    }
    assert {name.split("/")[0] for name in aside if "/" in name} == {"verification", "docs", "cli"}
    assert {name.split("/")[0] for name in told.keys() - aside} > {"forms", "problems", "solvers", "results"}
    assert told.keys() - aside >= {"api.py", "shapes.py", "scaling.py", *SOLVING}
    (package / "new.py").write_text("")
    assert source_digest(package) != whole


@pytest.mark.parametrize("found", discovery.find_cases(), ids=lambda c: c.id)
def test_names_of_checks_are_known_beforehand_and_told_apart(found):
    names = check_ids(found)
    assert names
    assert len(set(names)) == len(names)


def test_what_a_case_says_of_itself_is_plain_text():
    """The report shows the docstring as text, in which marks of markup would stand."""
    marked = [
        found.id
        for found in find_cases()
        if "``" in (ast.get_docstring(ast.parse(found.path.read_text())) or "")
    ]
    assert marked == []
