"""Run commands in this process or in limited processes, and check what each must leave behind."""

import io
import json
import os
import re
import signal
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from weakforms.cli import app
from weakforms.results import Branch, Field, Result, State
from weakforms.terminal import guarded
from weakforms.verification.cases import catalogue, discovery
from weakforms.verification.run import solving

ROOT = Path(__file__).resolve().parents[2]
CASE, CURVE = "paper2.fig03", "fig03a_delta1_1.1"
COMPARE = ("compare", CASE, "--curve", CURVE, "--column", "p")

settings.register_profile(
    "abuse",
    derandomize=True,
    database=None,
    deadline=None,
    max_examples=int(os.environ.get("WEAKFORMS_EXAMPLES", "12")),
    suppress_health_check=[
        HealthCheck.function_scoped_fixture,
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
    ],
)
quickly = settings.get_profile("abuse")
"""The same examples every time; more of them with WEAKFORMS_EXAMPLES, as the slow tests have it."""


@dataclass(frozen=True)
class Called:
    """Exit status and output of a command."""

    status: int
    out: str
    err: str
    megabytes: float = 0.0
    seconds: float = 0.0


def call(*words: object) -> Called:
    """Run a command in this process, as the console script does."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        status = guarded(lambda: app([str(word) for word in words], standalone_mode=False))
    return Called(status, out.getvalue(), err.getvalue())


def orderly(called: Called, *allowed: int) -> Called:
    """Assert that the exit status is one of those named, with at most one clear line of error."""
    assert called.status in allowed, called
    for text in (called.out, called.err):
        assert "Traceback" not in text
        assert "internal error" not in text
        assert "\x1b" not in text, "a command to the terminal"
    if called.status in (2, 4):
        assert called.out == ""
        signs_of_life = r"\[\d+:\d\d\] "
        (complaint,) = [x for x in called.err.splitlines() if not re.match(signs_of_life, x)]
        assert complaint.startswith("weakforms: ")
        assert 11 < len(complaint) < 700
    return called


DRIVER = """
import io, json, os, resource, sys, time
from contextlib import redirect_stderr, redirect_stdout
limit, commands = json.load(sys.stdin)
import weakforms.problems
from weakforms.cli import app
from weakforms.terminal import guarded
if limit:
    used = int(open("/proc/self/statm").read().split()[0]) * os.sysconf("SC_PAGESIZE")
    resource.setrlimit(resource.RLIMIT_AS, (used + limit, used + limit))
for words in commands:
    out, err, begun = io.StringIO(), io.StringIO(), time.monotonic()
    with redirect_stdout(out), redirect_stderr(err):
        status = guarded(lambda: app(words, standalone_mode=False))
    said = out.getvalue()[:5000], err.getvalue()[:5000]
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps([status, *said, most, time.monotonic() - begun]), flush=True)
"""


def limited(commands: list[list[str]], megabytes: int, timeout: float = 240) -> list[Called]:
    """Run commands one after the other in one process that may use only so much memory beyond its start."""
    given = json.dumps([megabytes * 2**20, [[str(word) for word in words] for words in commands]])
    done = subprocess.run(
        [sys.executable, "-c", DRIVER],
        input=given,
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )
    answers = [Called(*json.loads(line)) for line in done.stdout.splitlines()]
    assert len(answers) == len(commands), done.stderr
    return answers


@dataclass
class Program:
    """A command in a separate process, as a user starts it."""

    process: subprocess.Popen

    def wait(self, timeout: float = 180) -> Called:
        """Wait for the end of the process."""
        out, err = self.process.communicate(timeout=timeout)
        return Called(self.process.returncode, out, err)

    def kill(self, how: int = signal.SIGKILL) -> None:
        """Send a signal to the process and to all processes it started."""
        os.killpg(self.process.pid, how)


def start(*words: object, before: str = "", after: str = "", **more: object) -> Program:
    """Start a command; ``before`` is Python code that its process runs first, ``after`` at the end."""
    code = f"import sys; sys.argv[0] = 'weakforms'\n{before}\nfrom weakforms.cli import main\n"
    code += f"try:\n    main()\nfinally:\n    {after}\n" if after else "main()\n"
    environment = os.environ | {"PYTHONPATH": str(ROOT)} | more.pop("env", {})
    return Program(
        subprocess.Popen(
            [sys.executable, "-P", "-c", code, *map(str, words)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env=environment,
            **more,
        )
    )


def canned() -> Result:
    """A small result that fits the schema, with a meridian."""
    versions = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "0")
    meridian = {"Z": [0.0, 0.5, 1.0], "rho": [1.0, 1.2, 1.3], "eta": [0.0, 0.6, 1.1], "lam1": [1.0, 1.1, 1.2]}
    profile = Field("profile", {name: np.array(values) for name, values in meridian.items()})
    return Result(
        problem="tube",
        parameters={},
        scales={},
        numerics={},
        provenance={**versions, "ranks": 1, "wall_s": 0.0},
        branches=[Branch("primary", "p", {"p": np.array([0.0, 1.0])})],
        states=[State({"p": 0.5}, "primary", {}, (profile,))],
    )


CASES = '''"""Short branches."""
from weakforms import At, Axis, Case, Claim, Curve, Panel, tube

TUBES = [tube(delta1=1.5 + i / 24, u_end=0.3).on(cells=16, levels=2) for i in range({first}, {last})]

def wider(solutions):
    u = [solutions.value(spec, At("p", 0.5), "u_max") for spec in TUBES]
    return min(u) > 0, f"{{u}}"

CASE = Case(
    title="short",
    source="tests",
    panels=(Panel("a", x=Axis("p", 0, 2), y=Axis("u_max", 0, 1), curves=(Curve(TUBES[0], "first"),)),),
    checks=(Claim("wider", "bulges", tuple((spec, At("p", 0.5)) for spec in TUBES), wider),),
)
'''
COUNT = 6


def verified(tree: Path, out: Path, *words: object) -> Called:
    """Run ``verify`` of the cases of that tree in this process, which has loaded what it needs."""
    find = discovery.find_cases
    with pytest.MonkeyPatch.context() as patch:
        for module in (discovery, catalogue):
            patch.setattr(module, "find_cases", lambda: find(tree))
        patch.setattr(solving, "source_digest", lambda: "as it was")
        return call("verify", "--out", out, *words)


def verify(tree: Path, out: Path, *words: object, before: str = "", **more: object) -> Program:
    """Start ``verify`` of the cases of that tree in a separate process."""
    only = (
        "from pathlib import Path; from weakforms.verification.cases import discovery\n"
        f"find = discovery.find_cases; discovery.find_cases = lambda: find(Path({str(tree)!r}))\n"
        "from weakforms.verification.run import solving; solving.source_digest = lambda: 'as it was'\n"
    )
    return start("verify", "--out", out, *words, before=only + before, **more)
