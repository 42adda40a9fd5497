"""The package without its source tree: a wheel in separate environments, as ``pip install`` creates them."""

import csv
import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

from weakforms.verification.cases import references

ROOT = Path(__file__).resolve().parents[2]
NAME = "fig03a_delta1_1.1"
LARGEST = 6_000_000
"""Bytes of a distribution: a tenth of what package indexes accept, and seconds on a slow line."""
COMPILED = {
    (3, 12): {"numpy": "1.26.0", "scipy": "1.11.2"},
    (3, 13): {"numpy": "2.1.0", "scipy": "1.14.1", "pydantic": "2.8.0"},
    (3, 14): {"numpy": "2.3.2", "scipy": "1.16.1", "pydantic": "2.12.0"},
}
"""The first versions with wheels for a release of Python, where these are later than the oldest allowed."""
PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
TESTS = f"""
import pathlib

def test_right(weakforms_check):
    assert weakforms_check("paper2.fig03", pathlib.Path("right.csv"), name={NAME!r}).passed

def test_wrong(weakforms_check):
    weakforms_check("paper2.fig03", pathlib.Path("wrong.csv"), name={NAME!r}, accuracy=1e-6)
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
def built(tmp_path_factory):
    """The source distribution and the wheel made from it; setuptools writes beside a copy of the tree."""
    folder = tmp_path_factory.mktemp("built")
    skipped = shutil.ignore_patterns("__pycache__", "*.egg-info")
    for name in ("weakforms", "cases", "reference_data"):
        shutil.copytree(ROOT / name, folder / "tree" / name, ignore=skipped)
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, folder / "tree")
    code = f"from setuptools.build_meta import build_sdist; build_sdist({str(folder)!r})"
    done = run(sys.executable, "-c", code, cwd=folder / "tree")
    assert done.returncode == 0, done.stderr
    (source,) = folder.glob("*.tar.gz")
    pip("wheel", "--no-deps", "--no-index", "--no-build-isolation", "-w", folder, source)
    (wheel,) = folder.glob("*.whl")
    return source, wheel


@pytest.fixture(scope="module")
def wheel(built):
    return built[1]


def declared() -> list[str]:
    """What a plain installation needs, as ``pyproject.toml`` says."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]


def oldest() -> list[str]:
    """The oldest version of each of them; of compiled ones, the oldest that is built for this Python."""
    lowest = dict(text.split(">=") for text in declared())
    return [f"{name}=={COMPILED.get(sys.version_info[:2], {}).get(name, v)}" for name, v in lowest.items()]


@pytest.fixture(scope="module", params=["as here", "newest", "oldest"])
def installed(request, wheel, tmp_path_factory):
    """The scripts of an environment in which the wheel is installed, without extras unless they are here."""
    folder = tmp_path_factory.mktemp("environment")
    here = request.param == "as here"
    options = ["--system-site-packages"] if here else []
    assert run(sys.executable, "-m", "venv", "--without-pip", *options, folder).returncode == 0
    into = ["--python", folder / "bin" / "python"]
    if here:
        pip(*into, "install", "--no-deps", "--no-index", wheel)
        return folder / "bin"
    require_index(into)
    pip(*into, "install", "--no-compile", wheel, "pytest", *(oldest() if request.param == "oldest" else ()))
    return folder / "bin"


def require_index(into: list) -> None:
    asked = run(*PIP, *into, "install", "--dry-run", "--retries", "1", "--timeout", "20", "rich")
    if asked.returncode:
        pytest.skip(f"no package index answers here: {asked.stderr.splitlines()[-1]}")


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


def test_the_wheel_has_everything_under_one_name(built):
    source, wheel = built
    assert max(source.stat().st_size, wheel.stat().st_size) < LARGEST
    names = set(zipfile.ZipFile(wheel).namelist())
    info = {name for name in names if name.split("/")[0].endswith(".dist-info")}
    assert {name.split("/")[0] for name in names - info} == {"weakforms"}

    def files(part: str, *endings: str) -> set[str]:
        paths = (path for ending in endings for path in (ROOT / part).rglob(f"*{ending}"))
        return {path.relative_to(ROOT).as_posix() for path in paths}

    own = files("weakforms", ".py", ".pyi", ".json", ".jsonl", ".html", ".css", ".js", ".toml", ".typed")
    cases = {f"weakforms/_{name}" for name in files("cases", ".py")}
    tables = {f"weakforms/_{name}" for name in files("reference_data", ".csv", ".toml")}
    assert min(len(own), len(cases), len(tables)) > 80
    assert names - info == own | cases | tables | {"weakforms/_reference_data/__init__.py"}


def test_the_source_distribution_has_what_builds_it(built):
    with tarfile.open(built[0]) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {"pyproject.toml", "setup.py", "README.md", "LICENSE", "cases/paper2/fig03.py"} <= names
    assert f"reference_data/paper2/{NAME}.toml" in names


def test_a_package_index_would_accept_them(built, tmp_path):
    assert run(sys.executable, "-m", "venv", "--without-pip", tmp_path).returncode == 0
    into = ["--python", tmp_path / "bin" / "python"]
    require_index(into)
    pip(*into, "install", "--no-compile", "twine")
    done = run(tmp_path / "bin" / "python", "-m", "twine", "check", "--strict", *built)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("PASSED") == 2


def test_what_an_extra_brings_is_refused_before_anything_is_compared(installed, folder):
    if run(installed / "python", "-c", "import jinja2").returncode == 0:
        pytest.skip("the extras are installed here")
    names = run(installed / "python", "-c", "import matplotlib, markdown_it")
    assert "ModuleNotFoundError" in names.stderr
    for words, package, extra in (
        (["compare", "paper2.fig03", "right.csv", "--curve", NAME, "--out", "v"], "markupsafe", "pictures"),
        (["report", "out"], "jinja2", "pictures"),
    ):
        done = run(installed / "weakforms", *words, cwd=folder)
        assert done.returncode == 4, done.stdout + done.stderr
        assert done.stdout == ""
        assert (
            f"{package} is not installed here. Get it with: pip install 'weakforms[{extra}]'" in done.stderr
        )
    code = "import weakforms; weakforms.Result('tube', {}, {}, {}, {}).plot()"
    done = run(installed / "python", "-c", code, cwd=folder)
    assert "EnvironmentLackError: matplotlib is not installed here" in done.stderr, done.stderr


def test_statuses_of_the_command_line(installed, folder):
    command = installed / "weakforms"
    curve = ("--curve", NAME)
    for words, status, said in (
        (["list"], 0, "paper2.fig03"),
        (["compare", "paper2.fig03", "right.csv", *curve], 0, "within"),
        (["compare", "paper2.fig03", "wrong.csv", *curve, "--accuracy", "1e-6"], 1, "OUT OF BOUNDS"),
        (["compare", "paper2.fig03", "wrong.csv", *curve], 5, "no accuracy is claimed"),
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


def test_a_library_that_a_problem_needs_is_named_before_anything_is_solved():
    code = "import sys; sys.modules['slepc4py'] = None; from weakforms import api; api.require_environment()"
    done = run(sys.executable, "-c", code)
    assert "EnvironmentLackError: slepc4py is not installed here" in done.stderr
