"""Solves handed to an engine: the same answers, one writer, and a clear word if the engine is not there."""

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.verification.run import executors
from weakforms.verification.run.executors import executor
from weakforms.verification.run.requests import run_batch
from weakforms.verification.run.workers import at_once, handed_to, in_this_process, workers

STRETCHES = (1.1, 1.2, 1.3, 1.4)


@pytest.fixture
def requests(tmp_path):
    folder = tmp_path / "requests"
    folder.mkdir()
    for k, l1 in enumerate(STRETCHES):
        request = {
            "schema": "weakforms.request/1",
            "problem": "material",
            "parameters": {"l1": l1, "l2": 1.2},
        }
        (folder / f"r{k}.json").write_text(json.dumps(request), "utf-8")
    return folder


def energies(folder):
    answers = [json.loads(path.read_text("utf-8")) for path in sorted(folder.glob("r*.json"))]
    return [answer["quantities"]["W"]["value"] for answer in answers]


class Counting(ThreadPoolExecutor):
    """An engine that counts what it is given; one thread, as PETSc allows no more."""

    def __init__(self):
        super().__init__(1)
        self.given = 0

    def submit(self, *args, **kwargs):  # noqa: D102
        self.given += 1
        return super().submit(*args, **kwargs)


def test_a_batch_goes_to_the_engine_and_only_this_process_writes(requests, tmp_path, monkeypatch):
    run_batch(requests, tmp_path / "here")
    with Counting() as pool, handed_to(pool, 1):
        found = run_batch(requests, tmp_path / "there")
    assert pool.given == len(STRETCHES)
    assert [answer.status for answer in found] == [0] * len(STRETCHES)
    assert energies(tmp_path / "there") == energies(tmp_path / "here")
    with Counting() as pool, handed_to(pool, 1):
        run_batch(requests, tmp_path / "nothing", writes=False)
        assert not list((tmp_path / "nothing").glob("*.json"))


def test_a_resumed_batch_gives_the_engine_only_what_is_left(requests, tmp_path):
    run_batch(requests, tmp_path / "out")
    (tmp_path / "out" / "r2.json").unlink()
    with Counting() as pool, handed_to(pool, 1):
        found = run_batch(requests, tmp_path / "out", resume=True)
    assert pool.given == 1
    assert [answer.message for answer in found] == ["kept", "kept", "", "kept"]


def test_outside_of_an_engine_work_stays_here():
    with ThreadPoolExecutor(1) as pool:
        with handed_to(pool, 3), workers(2) as given:
            assert given is pool
            assert at_once(2) == 3
            assert not in_this_process(1)
        assert at_once(2) == 2
        assert in_this_process(1)
        assert pool.submit(abs, -1).result() == 1  # it belongs to the caller and stays open


@pytest.mark.parametrize("name", ["threads", "dask", "dask:", "mpi:3", "processes:2", ""])
def test_an_unknown_engine_is_refused(name):
    with pytest.raises(InputError, match="allowed are processes, mpi and dask:ADDRESS"), executor(name):
        pass


def test_one_rank_is_not_enough_for_mpi():
    with pytest.raises(InputError, match="at least two ranks"), executor("mpi"):
        pass


def test_dask_is_used_only_if_it_is_there(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(EnvironmentLackError, match="python3-distributed"), executor("dask:tcp://127.0.0.1:1"):
        pass


@pytest.mark.parametrize(
    ("threads", "source", "said"),
    [
        ([1, 1], "same", ""),
        ([], "same", "the scheduler at HERE has no workers"),
        ([1, 2], "same", "workers with one thread each"),
        ([1, 1], "other", "another version of weakforms"),
    ],
)
def test_workers_of_a_cluster_have_one_thread_and_the_same_source(threads, source, said):
    workers = {f"w{k}": {"nthreads": n} for k, n in enumerate(threads)}
    client = SimpleNamespace(
        scheduler_info=lambda n_workers: {"workers": workers if n_workers == -1 else {}},
        run=lambda digest: {name: digest() if source == "same" else "0" for name in workers},
    )
    if not said:
        assert executors._require_alike(client, "HERE") == 2
        return
    with pytest.raises(InputError, match=said):
        executors._require_alike(client, "HERE")


def test_ranks_answer_a_batch_as_one_process_does(requests, tmp_path):
    run_batch(requests, tmp_path / "here")
    words = ["mpirun", "--oversubscribe", "-n", "3", sys.executable, "-m", "weakforms"]
    words += ["batch", str(requests), "--out", str(tmp_path / "there"), "--executor", "mpi"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [f"r{k}: 0" for k in range(len(STRETCHES))]
    assert energies(tmp_path / "there") == energies(tmp_path / "here")


@pytest.mark.slow
def test_ranks_check_a_case(tmp_path):
    """The ranks that solve must not wait for each other: rank 0 imports the solvers later than they do."""
    words = ["mpirun", "--oversubscribe", "-n", "3", sys.executable, "-m", "weakforms"]
    words += ["check", "closed_form.infinite_tube", "--executor", "mpi", "--out", str(tmp_path / "out")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "out" / "report" / "report.json").read_text("utf-8"))
    assert [case["status"] for case in report["cases"]] == ["passed"]


@pytest.mark.slow
def test_a_killed_rank_ends_the_run_and_a_resumed_run_keeps_what_was_stored(tmp_path):
    check = [sys.executable, "-m", "weakforms", "check", "paper2.fig03", "--out", str(tmp_path / "out")]
    words = ["mpirun", "--oversubscribe", "-n", "3", *check, "--executor", "mpi"]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as run:
        while not (stored := list((tmp_path / "out" / "solutions").glob("*.json"))):
            assert run.poll() is None, run.stderr.read()
            time.sleep(0.1)
        ranks = subprocess.run(
            ["pgrep", "-P", str(run.pid)], capture_output=True, text=True, check=True
        ).stdout.split()
        os.kill(int(ranks[-1]), signal.SIGKILL)
        assert run.wait(timeout=60) != 0
    before = {path: path.stat().st_mtime_ns for path in stored}
    done = subprocess.run([*check, "--resume"], capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    assert {path: path.stat().st_mtime_ns for path in stored} == before
