"""What ``solve`` shows a person and what it gives a program; near misses, examples, the version."""

import io
import json
import os
import pty
import re
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from weakforms import __version__
from weakforms.cli import app
from weakforms.results import load_result, validate
from weakforms.terminal import guarded

ROOT = Path(__file__).resolve().parents[3]
TUBE = ("solve", "tube", "delta1=1.1", "--mesh", "cells=32", "--mesh", "levels=2")
VERBS = [info.name or info.callback.__name__ for info in app.registered_commands if not info.hidden]
ANSI = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


class Terminal(io.StringIO):
    """Standard output that says it is a terminal."""

    def isatty(self) -> bool:
        """Yes."""
        return True


def seen(*words: object, columns: int = 100) -> tuple[int, str, str]:
    """Exit status, what a person sees on a terminal, and standard error."""
    out, err = Terminal(), io.StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(err):
        patch.setenv("COLUMNS", str(columns))
        patch.setenv("TERM", "xterm")
        status = guarded(lambda: app([str(word) for word in words], standalone_mode=False))
    return status, ANSI.sub("", out.getvalue()), err.getvalue()


@pytest.fixture(scope="module")
def shown():
    return seen(*TUBE, "k=3", "--at", "p=1.9")


def test_a_person_sees_points_with_their_uncertain_digits(shown):
    status, text, err = shown
    assert (status, err) == (0, "")
    assert re.search(r"limit_point 1 +p = 1\.9144905925\d*\(\d\d?\) +u_max = 1\.355951393\d*\(\d\d?\)", text)
    assert "{" not in text


def test_a_person_sees_where_and_why_the_branch_ends(shown):
    assert re.search(r"branch primary: \d+ points, p from 0 to [\d.]+; ends at u_max = 5 \(u_end\)", shown[1])


def test_a_person_sees_parameters_warnings_crossings_and_time(shown):
    text = shown[1]
    assert "model = mooney_rivlin, alpha = 0.1, delta1 = 1.1, lf = 6.0" in text
    assert "warning: k = 3.0 has no effect here; it needs contact = frictionless or adhesive" in text
    assert (
        "note: p = 1.9 is crossed 3 times on the primary branch; this is crossing 1 (--crossing all" in text
    )
    assert "p = 1.9, crossing 1 of 3   u_max = " in text
    assert "n_negative = 0" in text
    assert re.search(r"solved in [\d.]+ s by DOLFINx", text)
    assert "--out FILE keeps all numbers" in text


def test_no_line_of_numbers_is_wider_than_the_terminal():
    _, text, _ = seen(*TUBE, "--at", "u_max=1", columns=70)
    lines = [line for line in text.splitlines() if re.search(r" = .*\(\d+\)", line)]
    assert len(lines) >= 3
    assert max(map(len, lines)) <= 70
    assert "more: " in text


def test_what_is_not_there_and_what_failed_is_seen(monkeypatch):
    from weakforms.problems import registry
    from weakforms.results import Absence, Failure, Result

    versions = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "0")
    made = Result("tube", {}, {}, {}, versions | {"ranks": 1, "wall_s": 0.0})
    made.failures, made.absent = [Failure("special points", "stuck")], [Absence("contact", "too far")]
    monkeypatch.setattr(type(registry.get("tube")), "solve", lambda *_, **__: made)
    status, text, err = seen("solve", "tube")
    assert (status, err) == (3, "")
    assert "not there: contact: too far\n" in text
    assert "not converged: special points: stuck\n" in text


def test_a_pipe_receives_the_result_and_complaints_go_beside_it(weakforms):
    called = weakforms(*TUBE, "k=3", "--at", "p=1.9", "--crossing", "all")
    data = json.loads(called.out)
    validate(data)
    assert [state["crossing"] for state in data["states"]] == [1, 2, 3]
    assert data["branches"][0]["ended"] == {"by": "u_end", "column": "u_max", "value": 5.0}
    (warning,) = data["warnings"]
    assert called.complaints == [f"weakforms: warning: {warning}"]


def test_a_request_file_may_ask_for_all_crossings(weakforms, tmp_path):
    given = {"problem": "tube", "parameters": {"delta1": 1.1}, "numerics": {"cells": 32, "levels": 2}}
    (tmp_path / "a.json").write_text(json.dumps(given | {"at": {"p": 1.9}, "crossing": "all"}))
    (tmp_path / "b.json").write_text(json.dumps(given | {"at": {"p": 1.9}, "crossing": "every"}))
    assert weakforms("batch", tmp_path).status == 2
    answers = [json.loads((tmp_path / "results" / name).read_text()) for name in ("a.json", "b.json")]
    assert [state["crossing"] for state in answers[0]["states"]] == [1, 2, 3]
    assert answers[1]["exit_status"] == 2


def test_a_person_who_asks_for_json_or_csv_gets_it():
    status, text, _ = seen(*TUBE, "--json")
    assert (status, json.loads(text)["problem"]) == (0, "tube")
    assert seen(*TUBE, "--format", "csv")[1].startswith("branch,p,u_max")


def test_a_person_may_keep_the_result_and_see_it_again(tmp_path):
    path = tmp_path / "r.json"
    text = seen(*TUBE, "--out", path)[1]
    assert f"all numbers: {path}" in text
    assert seen("show", path)[1] == text
    assert json.loads(seen("show", path, "--json")[1]) == json.loads(path.read_text())


def test_parameters_need_no_option(weakforms):
    plain, option = (
        weakforms("solve", "material", *words, "--json") for words in (["l1=2"], ["--set", "l1=2"])
    )
    a, b = json.loads(plain.out), json.loads(option.out)
    assert a["parameters"]["l1"] == 2.0
    assert a["quantities"] == b["quantities"]
    assert weakforms("solve", "material", "l1").complaints == [
        "weakforms: parameter 'l1': NAME=VALUE is wanted"
    ]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("solv tube", "there is no verb 'solv'; did you mean 'solve'?"),
        ("solve tub", "unknown problem 'tub'; did you mean 'tube'?"),
        ("solve tube delta=2", "no parameter 'delta'; did you mean 'delta1'?"),
        ("solve tube alfa=2", "no parameter 'alfa'; did you mean 'alpha'?"),
        ("solve tube --at umax=2", "a state at 'umax'; did you mean 'u_max'?"),
        ("solve tube --at limit_points=2", "did you mean 'limit_point'?"),
        ("solve fluid_tube --branch secundary", "no branch 'secundary'; did you mean 'secondary'?"),
        ("solve tube --mesh cell=8", "no parameter 'cell'; did you mean 'cells'?"),
        ("check paper2.fig3", "close to it: paper2.fig03, paper2.fig13"),
        ("compare paper2.fig2 c.csv", "close to it: paper2.fig02,"),
        ("solve tube model=neohookean", "'harmonic'; did you mean 'neo_hookean'?"),
        ("solve tube p=1.9", "no parameter 'p', which is a column: --at p=1.9 asks for the state there"),
        ("solve tube alpha=0.1 --set alpha=0.2", "parameter alpha=0.2: alpha is given twice"),
        ("solve tube --mesh cells=8 --mesh cells=9", "--mesh cells=9: cells is given twice"),
        ("solve paper2.fig03", "if it is a case: weakforms check paper2.fig03"),
        ("check tube", "it is a problem: weakforms solve tube"),
        ("solve tube --crossing many", "--crossing 'many': a whole number from 1, or all"),
    ],
)
def test_a_near_miss_is_answered_with_the_right_name(weakforms, words, said):
    called = weakforms(*words.split())
    assert (called.status, called.out, called.err.count("\n")) == (2, "", 1)
    assert said in called.err


def test_a_name_like_no_other_is_answered_with_all_names(weakforms):
    assert "no parameter 'qqq'; it has model, alpha, delta1" in weakforms("solve", "tube", "qqq=2").err


def test_a_long_list_of_names_is_shortened_where_they_differ_in_numbers_only(weakforms):
    said = weakforms("solve", "tube", "--at", "q=5").err
    assert "Z_t_min, Lambda_n0_1 to Lambda_n" in said
    assert "limit_point, " in said
    assert " ... " not in said


def test_the_version_is_shown(weakforms):
    assert weakforms("--version").out == f"weakforms {__version__}\n"


def test_the_help_of_the_script_names_every_verb():
    said = subprocess.run([ROOT / "run", "--help"], capture_output=True, text=True, check=True).stdout
    assert set(VERBS) <= set(re.findall(r"[a-z]+", said.partition("Where the command runs")[0]))


@pytest.mark.parametrize("verb", VERBS)
def test_every_help_ends_with_examples_that_the_command_line_accepts(weakforms, verb):
    (command,) = [info for info in app.registered_commands if (info.name or info.callback.__name__) == verb]
    lines = [line.strip() for line in command.epilog.split("\n\n")[1:]]
    assert lines
    assert "Examples:" in weakforms(verb, "--help").out
    assert all(line.startswith(f"weakforms {verb}") for line in lines)
    for word in (word for line in lines for word in line.split() if word.startswith("--")):
        assert word in weakforms(verb, "--help").out, f"{word} is no option of {verb}"


def test_help_shows_no_default_where_there_is_none(weakforms):
    assert "default: None" not in weakforms("solve", "--help").out
    assert "default: 1" in weakforms("solve", "--help").out


COMPLETE = """
import io, json, os, sys
from contextlib import redirect_stdout
sys.argv[0] = "weakforms"
from weakforms.cli import main
said = []
for words in json.loads(sys.argv.pop()):
    os.environ |= {"COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    with redirect_stdout(io.TextIOWrapper(io.BytesIO())) as out:
        try:
            main()
        except SystemExit as end:
            assert not end.code
    out.flush()
    said.append(out.buffer.getvalue().decode().split())
print(json.dumps([said, list(sys.modules)]))
"""
"""Completes words as bash asks for it, one after the other: a start of Python takes longer than they do."""


@pytest.fixture(scope="module")
def completed():
    """The completions of some words, and the modules that they need."""
    ends = ("sol", "solve tube", "check paper2.fig0", "compare paper2.fig03", "show t", "deck t", "diagram t")
    done = subprocess.run(
        [sys.executable, "-c", COMPLETE, json.dumps([f"weakforms {words}" for words in ends])],
        env=os.environ | {"_WEAKFORMS_COMPLETE": "complete_bash"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stderr == ""
    said, modules = json.loads(done.stdout)
    return dict(zip(ends, said, strict=True)), modules


def test_a_shell_completes_verbs_problems_and_cases(completed):
    said, _ = completed
    assert said["sol"] == ["solve"]
    assert set(said["solve tube"]) == {"tube", "tube_fold", "tube_scheme"}
    assert "paper2.fig03" in said["check paper2.fig0"]
    assert said["compare paper2.fig03"] == ["paper2.fig03"]
    assert {"tube", "tube_fold"} < set(said["show t"])
    assert said["deck t"] == said["diagram t"] == ["tube"]


def test_a_shell_that_completes_a_word_waits_for_no_large_library(completed):
    _, modules = completed
    assert {"weakforms", "numpy"} <= set(modules)
    assert not {"dolfinx", "petsc4py", "gmsh", "scipy", "matplotlib", "jsonschema"} & set(modules)


def test_the_reader_of_a_pipe_may_leave_without_a_word():
    code = "import sys; sys.argv[0] = 'weakforms'; from weakforms.cli import main; main()"
    done = subprocess.run(
        ["bash", "-c", f'"{sys.executable}" -c "{code}" list --json | head -n 1'],
        capture_output=True,
        text=True,
        check=True,
    )
    assert (done.stdout, done.stderr) == ("[\n", "")


def test_a_real_terminal_is_recognised():
    """On a pseudo-terminal the summary appears, not JSON."""
    code = "import sys; sys.argv[0] = 'weakforms'; from weakforms.cli import main; main()"
    master, slave = pty.openpty()
    with os.fdopen(slave, "wb") as stream:
        done = subprocess.run(
            [sys.executable, "-c", code, "solve", "material"],
            stdout=stream,
            stderr=subprocess.DEVNULL,
            check=False,
        )
    text = os.read(master, 65536).decode()
    os.close(master)
    assert done.returncode == 0
    assert "quantities" in text
    assert '"schema"' not in text


# -- diagram -------------------------------------------------------------------------------------

COARSE = ("--mesh", "cells=16", "--mesh", "levels=2")


@pytest.fixture(scope="module")
def drawn(weakforms, tmp_path_factory):
    """One small diagram from the command line, with its picture and its result."""
    folder = tmp_path_factory.mktemp("diagram")
    given = ("diagram", "tube", "--plane", "alpha", "p", "high=0.02", "--set", "u_end=1.2", "--kind", "fold")
    called = weakforms(*given, *COARSE, "--out", folder / "d.json", "--picture", folder / "d.svg")
    return called, folder


def test_diagram_solves_its_problem_and_stores_its_result(drawn):
    called, folder = drawn
    assert called.status == 0, called.err
    result = load_result(folder / "d.json")
    assert result.problem == "diagram"
    assert result.parameters["body"] == "tube"
    assert (result.parameters["x"], result.parameters["y"]) == ("alpha", "p")
    assert {branch.name for branch in result.branches} == {"fold", "end"}
    assert sorted(result.branch("fold").columns["alpha"][[0, -1]]) == pytest.approx([0.0, 0.02])


def test_diagram_draws_its_picture_and_says_where_it_is(drawn):
    called, folder = drawn
    assert (folder / "d.svg").read_text().startswith("<?xml")
    assert f"picture: {folder / 'd.svg'}" in called.out.replace("\n", "")
    assert "branch fold" in called.out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("tube", "--plane", "p", "p"), "x = y = 'p'"),
        (("tube", "--plane", "alpha", "p", "--kind", "n7"), "kind = 'n7'"),
        (("circular", "--plane", "alpha", "p", "--kind", "n1"), "body = 'circular' has no lines of waves"),
        (("tube", "--plane", "alpha", "p", "--set", "x=lf"), "--set x: the verb's argument or option"),
        (("tube", "--plane", "alpha", "p", "--picture", "d.txt"), "cannot draw into d.txt"),
        (("torus", "--plane", "alpha", "p"), "body = 'torus'"),
        (("sphere", "--plane", "alpha", "p", "--kind", "mirror"), "body = 'sphere' has no mirror"),
    ],
)
def test_diagram_refuses_bad_input_in_one_line(weakforms, solves, words, message):
    called = weakforms("diagram", *words)
    assert called.status == 2
    assert len(called.complaints) == 1
    assert message in called.complaints[0]
    assert solves == []
