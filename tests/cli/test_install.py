"""The package without its source tree: a wheel in a separate environment, as ``pip install`` creates it."""

import csv
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from weakforms.verification.cases import references

ROOT = Path(__file__).resolve().parents[2]
NAME = "fig03a_delta1_1.1"
PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
TESTS = f"""
import pathlib

def test_right(weakforms_check):
    assert weakforms_check("paper2.fig03", pathlib.Path("right.csv"), name={NAME!r}).passed

def test_wrong(weakforms_check):
    weakforms_check("paper2.fig03", pathlib.Path("wrong.csv"), name={NAME!r})
"""


def run(*command: object, cwd: Path | None = None) -> subprocess.CompletedProcess:
    """Run a command that sees neither the source tree nor the settings of pip and pytest outside."""
    hidden = ("PYTHONPATH", "PYTEST_ADDOPTS", "PIP_FIND_LINKS")
    environment = {name: value for name, value in os.environ.items() if name not in hidden}
    words = [str(word) for word in command]
    return subprocess.run(
        words, cwd=cwd, env=environment, capture_output=True, text=True, timeout=600, check=False
    )


def pip(*words: object) -> None:
    done = run(*PIP, *words)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """A wheel built from a copy of the tree, because setuptools writes beside the source."""
    folder = tmp_path_factory.mktemp("wheel")
    skipped = shutil.ignore_patterns("__pycache__", "*.egg-info")
    for name in ("weakforms", "cases", "reference_data"):
        shutil.copytree(ROOT / name, folder / "tree" / name, ignore=skipped)
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, folder / "tree")
    pip("wheel", "--no-deps", "--no-index", "--no-build-isolation", "-w", folder, folder / "tree")
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module", params=["as here", "newest of everything"])
def installed(request, wheel, tmp_path_factory):
    """The scripts of an environment in which the wheel is installed."""
    folder = tmp_path_factory.mktemp("environment")
    here = request.param == "as here"
    options = ["--system-site-packages"] if here else []
    assert run(sys.executable, "-m", "venv", "--without-pip", *options, folder).returncode == 0
    into = ["--python", folder / "bin" / "python"]
    if here:
        pip(*into, "install", "--no-deps", "--no-index", wheel)
        return folder / "bin"
    asked = run(*PIP, *into, "install", "--dry-run", "--retries", "1", "--timeout", "20", "rich")
    if asked.returncode:
        pytest.skip(f"no package index answers here: {asked.stderr.splitlines()[-1]}")
    pip(*into, "install", "--no-compile", wheel, "pytest")
    return folder / "bin"


@pytest.fixture
def folder(tmp_path):
    """A user's folder: subfolders with the names of ours, one correct curve and one wrong curve."""
    for name in ("cases", "reference_data"):
        (tmp_path / name / "paper2").mkdir(parents=True)
        (tmp_path / name / "__init__.py").touch()
    columns = references.load(2, NAME).columns
    for name, factor in (("right", 1.0), ("wrong", 1.001)):
        with (tmp_path / f"{name}.csv").open("w") as stream:
            rows = zip(*(columns | {"p": factor * columns["p"]}).values(), strict=True)
            csv.writer(stream).writerows([columns, *rows])
    (tmp_path / "test_mine.py").write_text(TESTS)
    return tmp_path


def test_the_wheel_has_everything_under_one_name(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    info = {name for name in names if name.split("/")[0].endswith(".dist-info")}
    assert {name.split("/")[0] for name in names - info} == {"weakforms"}

    def files(part: str, *endings: str) -> set[str]:
        paths = (path for ending in endings for path in (ROOT / part).rglob(f"*{ending}"))
        return {path.relative_to(ROOT).as_posix() for path in paths}

    own = files("weakforms", ".py", ".json", ".html", ".css", ".js", ".toml", ".typed")
    cases = {f"weakforms/_{name}" for name in files("cases", ".py")}
    tables = {f"weakforms/_{name}" for name in files("reference_data", ".csv", ".toml")}
    assert min(len(own), len(cases), len(tables)) > 80
    assert names - info == own | cases | tables | {"weakforms/_reference_data/__init__.py"}


def test_statuses_of_the_command_line(installed, folder):
    command = installed / "weakforms"
    curve = ("--curve", NAME)
    for words, status, said in (
        (["list"], 0, "paper2.fig03"),
        (["compare", "paper2.fig03", "right.csv", *curve], 0, "within"),
        (["compare", "paper2.fig03", "wrong.csv", *curve], 1, "OUT OF BOUNDS"),
        (["compare", "paper2.fig03"], 2, "Missing argument"),
        (["compare", "paper2.fig03", "right.csv", *curve, "--accuracy", "much"], 2, "--accuracy"),
        (["no-such-verb"], 2, "no-such-verb"),
        (["compare", "paper2.fig03", "absent.csv", *curve], 2, "absent.csv"),
    ):
        done = run(command, *words, cwd=folder)
        assert done.returncode == status, (words, done.stdout, done.stderr)
        assert said in done.stdout + done.stderr
        assert "Traceback" not in done.stderr


def test_the_fixture_shows_the_table_of_verdicts(installed, folder):
    done = run(installed / "python", "-m", "pytest", "-p", "no:cacheprovider", folder, cwd=folder)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "1 failed, 1 passed" in done.stdout
    assert "OUT OF BOUNDS" in done.stdout
    assert "ImportError" not in done.stdout


def test_nothing_of_ours_takes_a_users_names(installed, folder):
    code = "import cases, reference_data, weakforms; print(cases.__file__, reference_data.__file__)"
    done = run(installed / "python", "-c", code, cwd=folder)
    assert done.stdout.split() == [str(folder / name / "__init__.py") for name in ("cases", "reference_data")]
    done = run(installed / "python", "-P", "-c", "import cases", cwd=folder)
    assert "No module named 'cases'" in done.stderr
