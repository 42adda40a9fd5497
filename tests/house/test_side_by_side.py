"""The tests' own set-up: parallel runs lose nothing, and a crash or an interrupt is reported."""

import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

CONFTEST = Path(__file__).parents[1] / "conftest.py"
CASES = """
import os, pathlib, pytest
@pytest.mark.parametrize("case", ["paper1.a", "paper1.a:one", "paper1.a:two [m]", "paper2.b", "paper2.b:one"])
def test_check(case):
    print("ran", case.split(":")[0], os.getpid())
"""
FILE = """
import os
def test_first(): print("ran", __name__, os.getpid())
def test_second(): print("ran", __name__, os.getpid())
"""
CRASH = """
import ctypes
def test_before(): pass
def test_crash(): ctypes.string_at(0)
def test_after(): pass
"""
WAIT = """
import pathlib, time
def test_wait():
    pathlib.Path("waits").touch()
    time.sleep(60)
"""


@pytest.fixture
def start(tmp_path):
    """Start pytest with our conftest and two workers; its output goes to a log."""
    text = CONFTEST.read_text()
    assert "SILENCE = 60.0" in text
    (tmp_path / "tests" / "cases").mkdir(parents=True)
    (tmp_path / "tests" / "conftest.py").write_text(text.replace("SILENCE = 60.0", "SILENCE = 0.5"))

    def started(files: dict[str, str], *words: str) -> subprocess.Popen:
        for name, code in files.items():
            (tmp_path / "tests" / name).write_text(code)
        command = [sys.executable, "-m", "pytest", "--rootdir", str(tmp_path), "--dist", "loadscope", *words]
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "stdin": subprocess.DEVNULL}
        running.append(
            subprocess.Popen(
                command, cwd=tmp_path, env=environment, text=True, start_new_session=True, **pipes
            )
        )
        return running[-1]

    running: list[subprocess.Popen] = []
    yield started
    for process in running:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


def test_a_case_and_a_file_stay_in_one_worker(start):
    files = {"cases/test_cases.py": CASES, "test_one.py": FILE, "test_two.py": FILE}
    run = start(files, "-n", "2", "-rP", "tests")
    said, _ = run.communicate(timeout=180)
    assert run.returncode == 0, said
    ran = set(re.findall(r"^ran (\S+) (\d+)$", said, re.M))
    assert sorted(name for name, _ in ran) == ["paper1.a", "paper2.b", "test_one", "test_two"]
    assert len({worker for _, worker in ran}) == 2


def test_cases_that_share_solutions_stay_in_one_worker(start):
    names = ["paper3.fig06", "paper3.fig08", "paper1.fig11", "paper2.fig12"]
    case = CASES.replace(
        '"paper1.a", "paper1.a:one", "paper1.a:two [m]", "paper2.b", "paper2.b:one"', str(names)[1:-1]
    )
    run = start({"cases/test_cases.py": case}, "-n", "2", "-rP", "tests")
    said, _ = run.communicate(timeout=180)
    assert run.returncode == 0, said
    worker = dict(re.findall(r"^ran (\S+) (\d+)$", said, re.M))
    assert sorted(worker) == sorted(names)
    assert worker["paper3.fig06"] == worker["paper3.fig08"] != worker["paper1.fig11"]


def test_a_crash_of_a_worker_is_said_and_the_rest_goes_on(start):
    run = start({"test_crash.py": CRASH, "test_one.py": FILE}, "-n", "2", "tests")
    said, _ = run.communicate(timeout=180)
    assert run.returncode == 1, said
    assert "crashed while running 'tests/test_crash.py::test_crash'" in said
    assert "Segmentation fault" in said
    assert "1 failed, 4 passed" in said


def test_an_interrupt_is_said_and_ends_every_worker(start, tmp_path):
    run = start({"test_wait.py": WAIT, "test_one.py": FILE}, "-n", "2", "tests")
    end = time.monotonic() + 60
    while not (tmp_path / "waits").exists() and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(1.2)
    run.send_signal(signal.SIGINT)
    said, _ = run.communicate(timeout=180)  # the pipe closes when the last of them is gone
    assert run.returncode == 2, said
    assert "KeyboardInterrupt" in said
    assert "2 of 3 tests done; now tests/test_wait.py::test_wait" in said


@pytest.mark.parametrize(("word", "workers"), [("tests", True), ("tests/test_one.py", False)])
def test_one_file_needs_no_worker(start, word, workers):
    run = start({"test_one.py": FILE, "test_two.py": FILE}, "-n", "auto", word)
    said, _ = run.communicate(timeout=180)
    assert run.returncode == 0, said
    assert bool(re.search(r"^\d+ workers? \[", said, re.M)) == workers
