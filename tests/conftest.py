"""Settings for all tests: how crashes and interrupts are reported, and how tests run in parallel.

``pyproject.toml`` requests one process (a worker) per core. A worker receives a case with all its checks, or
a whole file, so that module fixtures are set up in one worker only.
"""

import gc
import os
import re
import signal
import time
from pathlib import Path
from threading import Event, Thread

# PETSc takes over the signals of a crash when it starts. Started here, before pytest does, it leaves them to
# pytest, which says what Python was doing.
import pytest
from petsc4py import PETSc  # noqa: F401

# Started in the background, as a job of a build server may be, a process ignores interrupts, and so do its
# children: the tests that interrupt some need them to listen.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Tests call the verbs within their own process and look at what is solved there: one process, unless -j says
# more.
os.environ.setdefault("WEAKFORMS_JOBS", "1")

# PETSc would end all tests when a worker is gone while something is sent to it.
signal.signal(signal.SIGPIPE, signal.SIG_IGN)

CASE = re.compile(r"test_cases\.py::\w+\[([^]:]+)")
RANKS = "tests/mpi"
"""Two ranks each: one worker runs all of them, and they come last. Ranks wait for one another at every step;
they are alone then, and most of their forms are compiled."""
LONG = ("paper3.secondary", "paper3.fig06")
"""What takes minutes begins first, so that no worker is left to be waited for."""
SILENCE = 60.0
"""Seconds after which a log shows how far the tests are."""


def pytest_xdist_auto_num_workers(config) -> int:
    """One worker per core; none for a single file, so that its output and debugger are available."""
    files = {Path(str(name).split("::")[0]) for name in config.args}
    if len(files) == 1 and all(path.is_file() and path.name != "test_cases.py" for path in files):
        return 0
    return len(os.sched_getaffinity(0))


def groups_of_cases() -> dict[str, str]:
    """The group of each case: cases that share a solution are in one, and one worker solves for it once."""
    from weakforms.verification.cases.discovery import select
    from weakforms.verification.run.plan import case_wants

    groups, owner = {}, {}
    for found in select(None, None):
        groups[found.id] = found.id
        for spec, _ in case_wants(found):
            mine, other = groups[found.id], groups[owner.setdefault(spec, found.id)]
            groups = {case: other if group == mine else group for case, group in groups.items()}
    return groups


def pytest_xdist_make_scheduler(config, log):
    """Distribute cases and files; another ``--dist`` than ours is left alone."""
    from xdist.scheduler import LoadScopeScheduling

    groups = groups_of_cases()
    long = [groups.get(name, name) for name in LONG]

    class CasesAndFiles(LoadScopeScheduling):
        def _split_scope(self, nodeid):
            if case := CASE.search(nodeid):
                return groups.get(case[1], case[1])
            return RANKS if nodeid.startswith(f"{RANKS}/") else nodeid.split("::")[0]

        def _assign_work_unit(self, node):
            for scope in reversed(long):
                if scope in self.workqueue:
                    self.workqueue.move_to_end(scope, last=False)
            if RANKS in self.workqueue:
                self.workqueue.move_to_end(RANKS)
            super()._assign_work_unit(node)

        def remove_node(self, node):
            """Name the test in which a worker died, and do not run it again, as xdist would."""
            units = self.assigned_work[node].values()
            left = ((unit, nodeid) for unit in units for nodeid, done in unit.items() if not done)
            unit, crashed = next(left, ({}, None))
            unit[crashed] = True
            super().remove_node(node)
            return crashed

    return CasesAndFiles(config, log) if config.getoption("dist") == "loadscope" else None


def pytest_collection_finish(session) -> None:
    """Leave what is loaded out of the garbage collections that follow, one after each solve."""
    gc.collect()
    gc.freeze()


class SignOfLife:
    """Write to a log each minute how many tests are done and which run, and each failure at once."""

    def __init__(self, reporter, session) -> None:
        self.reporter, self.session = reporter, session
        self.begun, self.done, self.running = time.monotonic(), 0, {}
        self.over = Event()
        Thread(target=self.watch, daemon=True).start()

    def pytest_runtest_logstart(self, nodeid):  # noqa: D102
        self.running[nodeid] = None

    def pytest_runtest_logfinish(self, nodeid):  # noqa: D102
        self.running.pop(nodeid, None)
        self.done += 1

    def pytest_runtest_logreport(self, report):  # noqa: D102
        if report.failed:
            self.say(f"failed: {report.nodeid}")

    def pytest_sessionfinish(self):  # noqa: D102
        self.over.set()

    def watch(self) -> None:
        """Print progress lines until the session ends."""
        while not self.over.wait(SILENCE):
            minutes = (time.monotonic() - self.begun) / 60
            done = f"{minutes:.0f} min, {self.done} of {self.session.testscollected} tests done"
            self.say(f"{done}; now {', '.join(list(self.running)) or 'none'}")

    def say(self, text: str) -> None:
        """Print a line and flush it; output to a file is buffered otherwise."""
        self.reporter.write_line(f"\n{text}")
        self.reporter.flush()


def compiled_forms() -> int:
    """Number of modules in the cache of compiled forms."""
    from dolfinx.jit import DOLFINX_DEFAULT_JIT_OPTIONS

    folder, _ = DOLFINX_DEFAULT_JIT_OPTIONS["cache_dir"]
    return sum(1 for _ in Path(folder).glob("*.c.cached"))


def pytest_terminal_summary(terminalreporter, config) -> None:
    """Say how much of the time went into the compiler."""
    found = config.stash[FORMS]
    terminalreporter.write_line(f"{compiled_forms() - found} modules of forms were compiled, {found} found")


FORMS = pytest.StashKey[int]()
"""Number of modules of forms that were compiled before the session."""


def pytest_sessionstart(session) -> None:
    """The printing process writes progress lines, unless it has a terminal for its dots."""
    config = session.config
    config.stash[FORMS] = compiled_forms()
    reporter = config.pluginmanager.getplugin("terminalreporter")
    if not (reporter is None or reporter.isatty or hasattr(config, "workerinput")):
        config.pluginmanager.register(SignOfLife(reporter, session))
