"""A run that is interrupted or killed goes on where it was."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

from weakforms.verification.cases import catalogue, discovery

COUNT = 8
MANY = f'''"""Many short branches."""
from weakforms import At, Case, Claim, tube

TUBES = [tube(delta1=1.5 + i / 16, u_end=0.3).on(cells=16, levels=2) for i in range({COUNT})]

def wider(solutions):
    u = [solutions.value(spec, At("p", 0.5), "u_max") for spec in TUBES]
    return min(u) > 0, f"{{u}}"

CASE = Case(
    title="many",
    source="tests",
    checks=(Claim("wider", "bulges", tuple((spec, At("p", 0.5)) for spec in TUBES), wider),),
)
'''


def starter(tree):
    """How to start ``verify`` in a separate process on a tree whose only case has many branches."""
    path = tree / "cases" / "paper2" / "many.py"
    path.parent.mkdir(parents=True)
    path.write_text(MANY)
    code = (
        "import sys; from pathlib import Path; from weakforms.verification.cases import discovery\n"
        f"find = discovery.find_cases; discovery.find_cases = lambda: find(Path({str(tree)!r}))\n"
        "sys.argv[0] = 'weakforms'; from weakforms.cli import main; main()"
    )

    def start(*words: object) -> subprocess.Popen:
        command = [sys.executable, "-c", code, "verify", *map(str, words)]
        return subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
        )

    return start


@pytest.fixture
def many(tmp_path, monkeypatch):
    """That tree's cases for runs in this process."""
    find = discovery.find_cases
    for module in (discovery, catalogue):
        monkeypatch.setattr(module, "find_cases", lambda: find(tmp_path))
    yield
    find.cache_clear()


undisturbed: list[str] = []
"""The results of an uninterrupted run."""


def details(out) -> list[str]:
    """The results of the checks with all digits."""
    data = json.loads((out / "report" / "report.json").read_text())
    return [v["detail"] for case in data["cases"] for v in case["verdicts"]]


@pytest.mark.parametrize(
    ("ending", "jobs", "status"),
    [
        (signal.SIGINT, 1, 130),
        pytest.param(signal.SIGKILL, 1, -signal.SIGKILL, marks=pytest.mark.slow),
        (signal.SIGKILL, 2, -signal.SIGKILL),
    ],
)
def test_an_interrupted_run_goes_on_where_it_was(weakforms, many, tmp_path, ending, jobs, status):
    start, out = starter(tmp_path), tmp_path / "out"
    running = start("-j", jobs, "--out", out)
    stored, end = out / "solutions", time.monotonic() + 300
    while len(list(stored.glob("tube-*.json"))) < 2 and time.monotonic() < end:
        time.sleep(0.002)
    os.killpg(running.pid, ending) if jobs == 1 else running.send_signal(ending)
    _, said = running.communicate(timeout=120)
    assert running.returncode == status, said
    assert ("--resume" in said) == (ending == signal.SIGINT)
    assert said.count("weakforms:") <= 1  # Python may say something about a killed process of its own
    kept = {p: p.read_bytes() for p in stored.glob("tube-*.json")}
    assert 2 <= len(kept) < COUNT, "the run was over before it could be interrupted"
    assert not (out / "report" / "index.html").exists()

    assert weakforms("verify", "--out", out, "--resume").status == 0
    assert {p: p.read_bytes() for p in kept} == kept, "what was stored is not solved again"
    assert len(list(stored.glob("tube-*.json"))) == COUNT
    if not undisturbed:
        assert weakforms("verify", "--out", tmp_path / "undisturbed").status == 0
        undisturbed.extend(details(tmp_path / "undisturbed"))
    assert details(out) == undisturbed
