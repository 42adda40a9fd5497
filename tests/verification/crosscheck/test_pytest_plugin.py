"""Another package's tests compare its curves by the fixture ``weakforms_check``."""

import json

import pytest

from weakforms.verification.cases import references

pytest_plugins = ["pytester"]

TESTS = """
import json, pathlib, pytest

TABLE = json.loads(pathlib.Path("table.json").read_text())
NAME = "fig03a_delta1_1.1"

ONLY = ["p", "V"]
WRONG = TABLE | {"p": [1.0001 * p for p in TABLE["p"]]}

def test_right(weakforms_check):
    verdicts = weakforms_check("paper2.fig03", TABLE, NAME, only=ONLY)
    assert verdicts.passed and verdicts.curve == NAME

def test_file(weakforms_check):
    weakforms_check("paper2.fig03", pathlib.Path("table.json"), name=NAME, only=ONLY)

def test_accuracy(weakforms_check):
    weakforms_check("paper2.fig03", WRONG, NAME, accuracy=1e-3, only=ONLY)

def test_let_through(weakforms_check):
    verdicts = weakforms_check("paper2.fig03", TABLE, NAME, unjudged=True)
    assert verdicts.status == "not judged" and verdicts.missing == ("lam1_mid", "t1_mid")

def test_unclaimed_let_through(weakforms_check):
    verdicts = weakforms_check("paper2.fig03", WRONG, NAME, only=ONLY, unjudged=True)
    assert verdicts.status == "not judged" and not verdicts.missing

def test_wrong(weakforms_check):
    weakforms_check("paper2.fig03", WRONG, NAME, accuracy=1e-9, only=ONLY)

def test_unclaimed(weakforms_check):
    weakforms_check("paper2.fig03", WRONG, NAME, only=ONLY)

def test_wrong_and_missing(weakforms_check):
    weakforms_check("paper2.fig03", WRONG, NAME, accuracy=1e-9, unjudged=True)

def test_missing(weakforms_check):
    weakforms_check("paper2.fig03", TABLE, NAME)

def test_unclear(weakforms_check):
    weakforms_check("paper2.fig03", TABLE)
"""


@pytest.fixture
def project(pytester):
    columns = references.load(2, "fig03a_delta1_1.1").columns
    (pytester.path / "table.json").write_text(
        json.dumps({n: columns[n].tolist() for n in ("u_max", "p", "V")})
    )
    pytester.makepyfile(TESTS)
    return pytester


def test_fixture(project):
    done = project.runpytest_inprocess("-p", "weakforms.pytest_plugin")
    done.assert_outcomes(passed=5, failed=5)
    done.stdout.fnmatch_lines(
        [
            "paper2.fig03, fig03a_delta1_1.1: 100 rows over u_max in *all of it is judged",
            "*p *OUT OF BOUNDS*1.0e-04*1.0e-09*u_max = *",
            "*V *within*",
            "left out: lam1_mid, t1_mid",
            "*p *NOT JUDGED*1.0e-04*1.0e-04*u_max = *",
            "*p: no accuracy is claimed, and *: it reaches 1.0e-04, which --accuracy 1e-04 claims",
            "verdict: not judged",
            "*p *OUT OF BOUNDS*",
            "*lam1_mid *NOT JUDGED*missing*",
            "*p *within*",
            "*lam1_mid *NOT JUDGED*missing*",
            "*the curve has no column lam1_mid: add it, or name the columns to judge with --column",
            "nothing was compared: paper2.fig03: which curve?*",
        ]
    )
    done.stdout.no_fnmatch_line("*Traceback*")
    done.stdout.no_fnmatch_line("*pytest_plugin.py*")


def test_fixture_is_announced_with_its_use(project):
    done = project.runpytest_inprocess("-p", "weakforms.pytest_plugin", "--fixtures")
    done.stdout.fnmatch_lines(
        ["weakforms_check*", "*weakforms_check(case, curve, name=None, accuracy=None)*"]
    )
