"""The problem and the cases of the pages "Add a problem" and "Add a case", in a scratch copy of the tree."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PARTS = ("weakforms", "cases", "reference_data", "docs", "pyproject.toml", "README.md", "CONTRIBUTING.md")
PAGES = ("docs/add-a-problem.md", "docs/add-a-case.md")
COMMAND = re.compile(r"^(?:\./run|python3 -m (reference_data\.solvers)) (.*)$", re.M)
BLOCK = re.compile(r"^`([\w/]+\.py)`:\n\n```python\n(.*?)^```", re.S | re.M)
CASES = ("closed_form.half_balloon", "closed_form.half_balloon_curve")


def blocks() -> dict[str, str]:
    return dict(hit for page in PAGES for hit in BLOCK.findall((ROOT / page).read_text("utf-8")))


@pytest.fixture(scope="module")
def tree(tmp_path_factory) -> Path:
    """The tree with the files of the pages, and with nothing else changed."""
    tree = tmp_path_factory.mktemp("tree")
    for part in PARTS:
        if (ROOT / part).is_dir():
            # With what Python has compiled of it, but not what another process is writing there.
            shutil.copytree(ROOT / part, tree / part, ignore=shutil.ignore_patterns("*.pyc.*"))
        else:
            shutil.copy2(ROOT / part, tree / part)
    for name, text in blocks().items():
        assert not (tree / name).exists(), f"{name} exists without the page"
        (tree / name).parent.mkdir(exist_ok=True)
        (tree / name).write_text(text, "utf-8")
    return tree


def python(tree: Path, *words: str, status: int = 0) -> str:
    """What Python prints in the tree."""
    surroundings = os.environ | {"PYTHONPATH": str(tree)}
    done = subprocess.run(
        [sys.executable, *words], cwd=tree, env=surroundings, capture_output=True, text=True, check=False
    )
    assert done.returncode == status, done.stdout + done.stderr
    return done.stdout if status == 0 else done.stderr


def run(tree: Path, *words: str, status: int = 0) -> str:
    return python(tree, "-m", "weakforms", *words, status=status)


ONE_BY_ONE = """
import contextlib, io, json, runpy, sys
said = []
for module, *words in json.loads(sys.argv[1]):
    sys.argv = [module, *words]
    with contextlib.redirect_stdout(io.TextIOWrapper(io.BytesIO(), "utf-8")) as out:
        try:
            runpy.run_module(module, run_name="__main__", alter_sys=True)
        except SystemExit as end:
            if end.code:
                raise SystemExit(f"{words}: status {end.code}")
    out.flush()
    said.append(out.buffer.getvalue().decode())
print(json.dumps(said))
"""


def test_the_example_is_short():
    lines = [
        line
        for name, text in blocks().items()
        for line in text.splitlines()
        if line and name.startswith("weakforms/problems")
    ]
    assert 40 < len(lines) <= 80


def test_the_example_follows_the_style_of_the_code(tree):
    if shutil.which("ruff") is None:
        pytest.skip("ruff is not installed here")
    for command in (("check", "--no-cache"), ("format", "--check", "--no-cache")):
        done = subprocess.run(
            ["ruff", *command, *blocks()], cwd=tree, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr


LIST, SHOW = ("list", "--json"), ("show", "half_balloon", "--json")
DOCS = ("docs", "--no-pictures", "--out", "site")


@pytest.fixture(scope="module")
def said(tree) -> dict[tuple[str, ...], str]:
    """What the commands of the pages and three more print, in one process: most of their time is imports."""
    commands = [("weakforms", *words) for words in (LIST, SHOW, DOCS)]
    for page in PAGES:
        for module, words in COMMAND.findall((ROOT / page).read_text("utf-8")):
            commands.append((module or "weakforms", *words.split()))
    printed = json.loads(python(tree, "-c", ONE_BY_ONE, json.dumps(commands)))
    return dict(zip([tuple(words) for _, *words in commands], printed, strict=True))


def test_it_is_listed_with_its_cases(said):
    entries = json.loads(said[LIST])
    assert {"half_balloon", *CASES} <= {entry["id"] for entry in entries}


def test_it_is_shown_with_the_constants_of_its_units(said):
    facts = json.loads(said[SHOW])
    assert facts["scales"]["P"] == "p r_o/(S h_o)"
    assert facts["scales"]["Pi"] == "total potential over 2 pi S h_o r_o^2"
    assert facts["constants"] == ["r_o", "S", "h_o"]
    assert {"lam_end", "model"} <= {entry["name"] for entry in facts["parameters"]}


def test_it_is_solved_with_uncertainties(tree, said):
    result = json.loads((tree / "balloon.json").read_text("utf-8"))
    (state,) = result["states"]
    pressure = state["quantities"]["P"]
    exact = 4 * (1 / 1.3 - 1.3**-7) * (1 + 0.1 * 1.3**2)
    assert 0 < pressure["uncertainty"] < 1e-8
    assert abs(pressure["value"] - exact) <= 2 * pressure["uncertainty"]
    assert [point["kind"] for point in result["special_points"]] == ["limit_point"]
    assert result["failures"] == []


def test_the_audit_and_the_test_of_uncertainties_find_it(tree, said):
    audit = json.loads((tree / "out/audit.json").read_text("utf-8"))
    assert [draw["status"] for draw in audit["draws"]] == ["answered", "answered"]
    covered = json.loads((tree / "out/coverage.json").read_text("utf-8"))
    (family,) = covered["parts"]["tuned"]["families"]
    assert (family["solved"], family["missed"]) == (2, [])
    assert sum(row["count"] for row in family["rows"]) > 10


def test_its_cases_hold(said):
    outcomes = [" ".join(said["check", case].split()) for case in CASES]
    assert [re.findall(r"all (\d+) checks hold", text) for text in outcomes] == [["3"], ["3"]], outcomes


def test_it_is_documented(tree, said):
    page = (tree / "site/problems/half_balloon.html").read_text("utf-8")
    assert "gas_potential" in page
    assert CASES[0] in page
    guide = (tree / "site/add-a-problem.html").read_text("utf-8")
    assert "def formulation(task: Task, cells: int)" in guide


def test_a_wrong_weak_form_is_noticed_by_the_case(tree, tmp_path):
    """With one percent more load it fails."""
    path = tree / "weakforms/problems/balloon/problem.py"
    right = path.read_text("utf-8")
    path.write_text(right.replace("gas_potential(rho", "1.01 * gas_potential(rho"), "utf-8")
    try:
        done = run(tree, "check", CASES[0], "--out", str(tmp_path), status=1)
    finally:
        path.write_text(right, "utf-8")
    assert "internal error" not in done


def test_a_description_without_a_problem_is_an_error(tree):
    path = tree / "weakforms/problems/balloon/problem.py"
    right = path.read_text("utf-8")
    path.write_text(
        right.replace("    about, parameters, numerics =", "    described, parameters, numerics =")
    )
    try:
        said = run(tree, "show", "half_balloon", status=1)
    finally:
        path.write_text(right, "utf-8")
    assert "no class has about = About('half_balloon', ...)" in said
