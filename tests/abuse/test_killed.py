"""Runs that are killed, lack space or permission, or run twice at once lose at most one solution."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from xml.etree import ElementTree

import pytest
from abuse_tools import COUNT, orderly, start, verified, verify

from weakforms.results import load_result


@pytest.fixture(scope="module")
def undisturbed(tree, tmp_path_factory) -> dict:
    """The report of an undisturbed run."""
    out = tmp_path_factory.mktemp("undisturbed")
    called = verified(tree, out)
    assert called.status == 0, called.err
    assert len(stored(out)) == COUNT
    return report(out)


TIMES = ("seconds", "started", "wall_s")


def report(out: Path) -> dict:
    """The content of ``report.json`` without times, which differ between runs."""

    def without(value: object) -> object:
        if isinstance(value, dict):
            return {k: without(v) for k, v in value.items() if k not in TIMES}
        return [without(v) for v in value] if isinstance(value, list) else value

    return without(json.loads((out / "report" / "report.json").read_text()))


def stored(out: Path) -> list[Path]:
    return sorted((out / "solutions").glob("*.json"))


def whole(out: Path) -> None:
    """Assert that every file with a final name is complete."""
    for path in stored(out):
        load_result(path)
    for path in (out / "report").glob("*"):
        if path.suffix == ".json":
            json.loads(path.read_text())
        elif path.suffix == ".xml":
            ElementTree.parse(path)
        elif path.suffix == ".html":
            assert path.read_text().rstrip().endswith("</html>")


def resumed(tree: Path, out: Path, undisturbed: dict) -> None:
    """Assert that the run can be continued to the same report and that no partly written file remains."""
    called = verified(tree, out, "--resume")
    assert called.status == 0, called.err
    whole(out)
    assert report(out) == undisturbed
    assert not [path for path in out.rglob(".*")], "remains of what was killed"


def interrupted_at(tree: Path, out: Path, rng: random.Random, how: int, *words: object) -> int:
    """Start a run, kill it at a random time, check what is left, return the number of stored solutions."""
    had = len(stored(out))
    running = verify(tree, out, "--resume", *words)
    wanted, end = rng.randint(had, COUNT), time.monotonic() + 60
    while len(stored(out)) < wanted and running.process.poll() is None and time.monotonic() < end:
        time.sleep(0.002)
    time.sleep(rng.uniform(0, 0.2))
    if running.process.poll() is None:
        running.kill(how)
    called = running.wait()
    assert called.status in (0, -how)
    assert "Traceback" not in called.err
    whole(out)
    assert len(stored(out)) >= had, "what was stored stays"
    return len(stored(out))


def test_killed_at_random_moments(tree, tmp_path, undisturbed):
    rng = random.Random(10)
    interrupted_at(tree, tmp_path, rng, signal.SIGKILL)
    interrupted_at(tree, tmp_path, rng, signal.SIGTERM)
    resumed(tree, tmp_path, undisturbed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("jobs", [1, 2])
def test_killed_at_many_moments(tree, tmp_path, undisturbed, seed, jobs):
    rng = random.Random(seed)
    for how in (
        signal.SIGKILL,
        signal.SIGTERM,
        signal.SIGKILL,
        signal.SIGTERM,
    ):
        interrupted_at(tree, tmp_path, rng, how, "-j", jobs)
    resumed(tree, tmp_path, undisturbed)


SLOWLY = """
from weakforms.results import io
from weakforms.verification.report import report
from weakforms.verification.run import solving
import os, time
def halfway(path, text, *_):
    path = os.fspath(path)
    partial = os.path.join(os.path.dirname(path), "." + os.path.basename(path) + ".12345678")
    with open(partial, "w") as stream:
        stream.write(text[: len(text) // 2])
    print("half", flush=True)
    time.sleep(60)
right, count = solving.write_atomically, []
def third(path, text, *more):
    count.append(path)
    (halfway if len(count) == 3 else right)(path, text, *more)
"""


@pytest.mark.parametrize("what", ["solution", "report"])
def test_killed_while_writing(tree, tmp_path, undisturbed, what):
    patched = {
        "solution": "solving.write_atomically = third\n",
        "report": "report._replace = lambda p, t: halfway(p.with_name(p.name), t)\n",
    }[what]
    running = verify(tree, tmp_path, before=SLOWLY + patched)
    assert running.process.stdout.readline() == "half\n"
    running.kill()
    running.wait()
    whole(tmp_path)
    assert len(stored(tmp_path)) == (2 if what == "solution" else COUNT)
    resumed(tree, tmp_path, undisturbed)


# -- no room, no permission ----------------------------------------------------------------------


NO_FILE_ABOVE = """
import resource
from mpi4py import MPI  # it has files of its own, which are not in question
resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))
"""


@pytest.mark.parametrize("size", [2000, pytest.param(20_000, marks=pytest.mark.slow)])
def test_a_disk_that_is_full(tree, tmp_path, undisturbed, size):
    """The disk is full before the first solution, or before the report."""
    called = orderly(verify(tree, tmp_path, before=NO_FILE_ABOVE.format(size=size)).wait(), 2)
    assert "File too large" in called.err
    whole(tmp_path)
    assert len(stored(tmp_path)) == (0 if size == 2000 else COUNT)
    resumed(tree, tmp_path, undisturbed)


def test_standard_output_and_files_that_are_full(tmp_path):
    words = ("solve", "tube", "--mesh", "cells=16", "--mesh", "levels=2", "--set", "u_end=0.3")
    code = "import sys; from weakforms.cli import main; main()"
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-c", code, *words], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    assert done.stderr == "weakforms: cannot write to standard output: No space left on device\n"
    called = orderly(start(*words, "--out", "/dev/full").wait(), 2)
    assert "/dev/full: No space left" in called.err


@pytest.fixture
def ours():
    """A folder that every user may read, unlike pytest's own."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o755)
    yield folder
    shutil.rmtree(folder)


def test_an_output_folder_that_may_not_be_written(tree, ours):
    ordinary = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
    shutil.copytree(tree / "cases", ours / "cases")
    for path in (ours, *ours.rglob("*")):
        path.chmod(0o755)
    locked = ours / "locked"
    locked.mkdir(mode=0o555)
    called = orderly(verify(ours, locked, env={"HOME": "/nonexistent"}, **ordinary).wait(), 2)
    assert "Permission denied" in called.err
    assert list(locked.iterdir()) == []


# -- two at once ---------------------------------------------------------------------------------


def test_two_runs_in_one_folder(tree, tmp_path, undisturbed):
    first = verify(tree, tmp_path, before=SLOWLY + "solving.write_atomically = third\n")
    assert first.process.stdout.readline() == "half\n"
    second = orderly(verify(tree, tmp_path, "--resume").wait(), 2)
    assert "another run is writing to folder" in second.err
    first.kill()
    first.wait()
    resumed(tree, tmp_path, undisturbed)  # the lock of a dead run is nobody's


FORM = """
import sys, ufl, weakforms.solvers
from dolfinx import fem, mesh
from mpi4py import MPI
domain = mesh.create_interval(MPI.COMM_WORLD, 2, [0, 1])
x = ufl.SpatialCoordinate(domain)
value = fem.assemble_scalar(fem.form((2.0 + ufl.exp(ufl.sin(x[0]))) * ufl.dx))
print(f"{value:.12g}")
"""


def compile_form(cache: Path, code: str = FORM, **more: object) -> subprocess.Popen:
    environment = os.environ | {"XDG_CACHE_HOME": str(cache)}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "start_new_session": True}
    return subprocess.Popen([sys.executable, "-c", code], env=environment, **pipes, **more)


def compiled(process: subprocess.Popen) -> str:
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0, err
    return out


def made(cache: Path, ending: str) -> list[Path]:
    return [path for path in (cache / "fenics").glob("*") if path.name.endswith(ending)]


def test_compiled_forms(tmp_path):
    """One process compiles while others wait; what a killed compiler or a crash left is compiled again."""
    several = [compile_form(tmp_path) for _ in range(3)]
    values = {compiled(process) for process in several}
    assert len(values) == 1
    (ready,) = made(tmp_path, ".c.cached")
    (library,) = made(tmp_path, ".so")
    (place,) = made(tmp_path, ".form")
    assert {path.name for path in (tmp_path / "fenics").iterdir()} == {
        ready.name,
        library.name,
        place.name,
        ready.name.removesuffix(".cached"),
    }, "nothing else is left"

    ready.unlink()  # as a process killed before the end of ffcx's own way leaves it
    library.unlink()
    begun = time.monotonic()
    assert {compiled(compile_form(tmp_path))} == values
    assert time.monotonic() - begun < 30
    library.write_bytes(b"")  # as a machine that went down may leave it
    assert {compiled(compile_form(tmp_path))} == values


def test_a_process_killed_while_it_compiles(tmp_path):
    slow = "import time\nfrom ffcx.codegeneration import jit\nright = jit._compile_objects\n"
    slow += "def late(*a, **k):\n    print('begun', flush=True)\n    time.sleep(60)\n"
    slow += "jit._compile_objects = late\n"
    running = compile_form(tmp_path, slow + FORM)
    assert running.stdout.readline() == "begun\n"
    waiting = compile_form(tmp_path)
    time.sleep(3)
    assert waiting.poll() is None, "another compiles: it waits"
    os.killpg(running.pid, signal.SIGKILL)
    running.communicate()
    begun = time.monotonic()
    assert compiled(waiting).startswith("3.6")
    assert time.monotonic() - begun < 30
    assert len(made(tmp_path, ".c.cached")) == 1
    assert made(tmp_path, ".lock") == []


def test_forms_that_cannot_be_stored(tmp_path):
    """If the cache is a file or its disk is full, one line is printed and the exit status is 4."""
    words = ("solve", "tube", "--mesh", "cells=16", "--mesh", "levels=2", "--set", "u_end=0.3")
    (tmp_path / "file").write_text("")
    called = orderly(start(*words, env={"XDG_CACHE_HOME": str(tmp_path / "file")}).wait(), 4)
    assert "XDG_CACHE_HOME" in called.err
    small = {"before": NO_FILE_ABOVE.format(size=10_000), "env": {"XDG_CACHE_HOME": str(tmp_path / "small")}}
    called = orderly(start(*words, **small).wait(), 4)
    assert "XDG_CACHE_HOME" in called.err
