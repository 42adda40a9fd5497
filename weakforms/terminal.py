"""Functions that all verbs use: requests, one-line errors, progress on a terminal, output from one rank."""

from __future__ import annotations

import errno
import json
import os
import re
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Event, Thread
from typing import Any

import typer
from rich.console import Console

from weakforms.errors import InputError, WeakformsError, lacking, not_among
from weakforms.world import end_ranks_that_wait, world

_LACKS = (
    *(errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO),
    *(errno.ENOMEM, errno.EMFILE, errno.ENFILE, errno.EAGAIN),
)
"""Errors of the operating system that mean that something is missing or full."""

USAGE_ERROR = next(kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "ClickException")
"""Exceptions for wrong use of the command line; newer releases of typer contain their own click."""

LONGEST_MESSAGE = 600
"""Number of characters after which a message is cut, because it may quote long input."""


def request(
    spec: Path | None, sets: list[str] | None, at: list[str] | None, mesh: list[str] | None
) -> dict[str, Any]:
    """Parameters, states and numerics from a request file, overridden by options."""
    from weakforms.results.io import load_json

    data = load_json(spec, "request") if spec is not None else {}
    unknown = sorted(set(data) - {"parameters", "at", "numerics"})
    if unknown:
        raise InputError(f"request {spec}: unknown entry {unknown[0]!r}; allowed: parameters, at, numerics")
    for key in data:
        if not isinstance(data[key], dict):
            raise InputError(f"request {spec}: {key!r} must be an object of names and values")
    return {
        "parameters": data.get("parameters", {}) | once("parameter", sets),
        "numerics": data.get("numerics", {}) | once("--mesh", mesh),
        "at": [*data.get("at", {}).items(), *_states(pairs("--at", at))],
    }


def _states(given: list[tuple[str, str]]) -> list[tuple[str, Any]]:
    """Requested states; ``NAME=@FILE`` asks for one at every value that column has in a CSV or JSON file.

    Raises:
        InputError: If there is no such file, or it has no such column.
    """
    from weakforms.results import read_curve

    states: list[tuple[str, Any]] = []
    for name, value in given:
        if not value.startswith("@"):
            states.append((name, value))
            continue
        columns = read_curve(Path(value[1:]), "").columns
        if name not in columns:
            raise InputError(
                f"--at {name}={value}: no column {name!r} in {value[1:]}{not_among(name, columns)}"
            )
        states += [(name, float(number)) for number in columns[name]]
    return states


def pairs(option: str, given: list[str] | None) -> list[tuple[str, str]]:
    """Names and values of a repeatable option.

    Raises:
        InputError: If an item does not have the form ``NAME=VALUE``.
    """
    pairs = []
    for item in given or []:
        name, equals, value = item.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise InputError(f"{option} {item!r}: NAME=VALUE is wanted")
        pairs.append((name.strip(), value.strip()))
    return pairs


def once(option: str, given: list[str] | None) -> dict[str, str]:
    """Names and values of a repeatable option in which no name may be repeated.

    Raises:
        InputError: If an item does not have the form ``NAME=VALUE``, or a name is repeated.
    """
    found: dict[str, str] = {}
    for name, value in pairs(option, given):
        if name in found:
            raise InputError(f"{option} {name}={value}: {name} is given twice")
        found[name] = value
    return found


def rank() -> int:
    """The rank of this process; 0 without MPI."""
    try:
        return world().rank
    except ImportError:
        return 0


def free_cores() -> int:
    """Default number of processes: one for each core, or one if MPI ranks share the work already."""
    try:
        ranks = world().size
    except ImportError:
        ranks = 1
    return min(len(os.sched_getaffinity(0)), 64) if ranks == 1 else 1


def console(stderr: bool = False) -> Console:
    """A plain console on standard output or standard error that does not interpret brackets and colons."""
    return Console(stderr=stderr, highlight=False, markup=False, emoji=False)


def plain(text: object) -> str:
    """The text without control characters, which a terminal could take for commands."""
    return re.sub(r"[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]+", "\N{REPLACEMENT CHARACTER}", str(text))


def print_json(data: Any) -> None:
    """Indented JSON on standard output."""
    sys.stdout.write(json.dumps(data, indent=1) + "\n")


PULSE = 15.0
"""Longest silence in a log, in seconds."""

ENOUGH = 0.05
"""Share of a run's work after which a log shows the time that is left."""


class WorkProgress:
    """Progress of long work: a bar on a terminal, lines in a log. This base class prints nothing.

    Calling it reports the progress.
    """

    def __call__(self, what: str, done: float, total: float) -> None:
        """Report that ``what`` is being done now, and that ``done`` of ``total`` is finished."""

    def line(self, text: str) -> None:
        """Report that something is finished: a line in a log; a terminal shows only the bar."""

    def plan(self, text: str) -> None:
        """Say what will be done, before it begins: a line in a log, or above the bar of a terminal."""
        self.line(text)


class _Bar(WorkProgress):
    def __init__(self, bar: Any) -> None:
        self._bar, self._task = bar, bar.add_task("starting", total=None)

    def __call__(self, what: str, done: float, total: float) -> None:
        # As a share: rich forgets the speed, and with it the time that is left, whenever a total changes.
        share = done / total if total else 0.0
        self._bar.update(self._task, description=plain(what), completed=share, total=1.0)

    def plan(self, text: str) -> None:
        self._bar.console.print(plain(text), soft_wrap=True)


class _Log(WorkProgress):
    """Lines on standard error, at least one in :data:`PULSE` seconds during the work."""

    def __init__(self) -> None:
        self._begun, self._latest, self._ended = time.monotonic(), "starting", Event()
        self._share, self._first = 0.0, None
        # Keep the current stream: it may be redirected later.
        self._stream = sys.stderr

    def __call__(self, what: str, done: float, total: float) -> None:
        self._latest, self._share = what, done / total if total else 0.0
        # What an earlier run did is done at the first report.
        self._first = self._first or (time.monotonic(), self._share)

    def line(self, text: str) -> None:
        if self._stream is None:
            return
        minutes, seconds = divmod(int(time.monotonic() - self._begun), 60)
        with suppress(OSError, ValueError):  # the work continues if nobody reads the log
            self._stream.write(f"[{minutes}:{seconds:02}] {plain(text)}\n")
            self._stream.flush()

    def beat(self) -> None:
        while not self._ended.wait(PULSE):
            self.line(self._latest + self._left())

    def _left(self) -> str:
        """The time that is left at the speed so far, once there is enough to tell it from."""
        since, before = self._first or (0.0, 0.0)
        gained = self._share - before
        if gained < ENOUGH * (1 - before) or self._share >= 1:
            return ""
        left = (time.monotonic() - since) * (1 - self._share) / gained
        return f"; about {left / 60:.0f} min left" if left >= 90 else f"; about {left:.0f} s left"

    def end(self) -> None:
        self._ended.set()


@contextmanager
def progress_bar() -> Iterator[WorkProgress]:
    """Yield an object for progress reports: a bar on a terminal, lines in a log, from the first rank only."""
    from rich.progress import (
        BarColumn,
        Progress,
        TaskProgressColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    if rank() != 0:
        yield WorkProgress()
        return
    screen = console(stderr=True)
    if not screen.is_terminal:
        log = _Log()
        Thread(target=log.beat, daemon=True).start()
        try:
            yield log
        finally:
            log.end()
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        TextColumn("left:"),
        TimeRemainingColumn(),
    )
    # One solution may take minutes: the speed is averaged over the last hour, not over the last 30 s.
    with Progress(*columns, console=screen, transient=True, speed_estimate_period=3600) as bar:
        yield _Bar(bar)


def complain(text: str) -> None:
    """Print one line on standard error from one rank; long lines are cut, control characters removed."""
    if rank() != 0:
        return
    line = plain(" ".join(text.split()))
    if len(line) > LONGEST_MESSAGE:
        line = f"{line[: LONGEST_MESSAGE // 2]} ... {line[-LONGEST_MESSAGE // 4 :]}"
    sys.stderr.write(f"weakforms: {line}\n")


def require_one_rank(verb: str) -> None:
    """Refuse to run a verb on several ranks, each of which would do all of its work.

    Raises:
        InputError: In a run on several ranks.
    """
    from mpi4py import MPI

    if MPI.COMM_WORLD.size > 1:
        raise InputError(f"{verb} runs on one rank, not on {MPI.COMM_WORLD.size}: start it without mpirun")


def guarded(run: Callable[[], Any], debug: bool = False) -> int:
    """Run a command and return its exit status. Errors become one line; ``debug`` adds the traceback."""
    try:
        outcome = run()
        sys.stdout.flush()
    except (Exception, KeyboardInterrupt, SystemExit) as error:
        if debug:
            traceback.print_exc()
        status, text = _verdict_on(error)
        if text:
            complain(text)
        if status:  # a completed word ends a process without an error, and should not wait for MPI
            end_ranks_that_wait(status, text)
        return status
    return outcome if isinstance(outcome, int) else 0


def _verdict_on(error: BaseException) -> tuple[int, str]:
    """Exit status and message for an exception that ends a command."""
    if isinstance(error, ImportError):
        error = lacking(error) or error
    if isinstance(error, WeakformsError):
        return error.exit_status, str(error)
    if isinstance(error, USAGE_ERROR):
        return 2, error.format_message()
    if isinstance(error, typer.Abort | KeyboardInterrupt):
        return 130, "interrupted"
    if isinstance(error, SystemExit):  # of the completion of a shell, and of click and rich on a closed pipe
        _stdout_is_gone()
        return (0 if error.code in (0, None) else 2), ""
    # Anything else is a defect of this program: still one line, and a hint to the traceback.
    defect = 1, f"internal error, please report it ({type(error).__name__}: {error}); see --debug"
    return _refused_by_the_system(error) or defect


def _refused_by_the_system(error: BaseException) -> tuple[int, str] | None:
    """Exit status and message if the machine, not the program, ended a command."""
    if isinstance(error, MemoryError):
        return 4, "there is not enough memory for this"
    if not isinstance(error, OSError):
        return None
    written = error.filename is None and error.errno in (errno.ENOSPC, errno.EPIPE)
    if _stdout_is_gone() or written:
        left = error.errno == errno.EPIPE  # as "| head" does, which has read enough
        return 2, "" if left else f"cannot write to standard output: {error.strerror}"
    if error.errno not in _LACKS:
        return None
    place = f" ({error.filename})" if error.filename else ""
    return 4, f"this machine does not allow it to continue: {error.strerror}{place}"


def _stdout_is_gone() -> bool:
    """Whether standard output accepts nothing more; then close it, so that the exit prints no error."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return True
    return False
