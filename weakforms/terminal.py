"""What the verbs share: request parsing, one-line errors, progress on a terminal, output from one rank."""

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

from weakforms.errors import InputError, WeakformsError

_LACKS = (
    *(errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO),
    *(errno.ENOMEM, errno.EMFILE, errno.ENFILE, errno.EAGAIN),
)
"""What the system refuses for want of something."""

COMPLAINT = next(kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "ClickException")
"""What a wrong use of the command line raises; newer releases of typer bring a click of their own."""

LONGEST_COMPLAINT = 600
"""Characters after which a complaint is cut: a message may quote what it was given."""


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
        "parameters": data.get("parameters", {}) | dict(pairs("--set", sets)),
        "numerics": data.get("numerics", {}) | dict(pairs("--mesh", mesh)),
        "at": [*data.get("at", {}).items(), *pairs("--at", at)],
    }


def pairs(option: str, given: list[str] | None) -> list[tuple[str, str]]:
    """Names and values of a repeatable option.

    Raises:
        InputError: For an item that is no ``NAME=VALUE``.
    """
    pairs = []
    for item in given or []:
        name, equals, value = item.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise InputError(f"{option} {item!r}: NAME=VALUE is wanted")
        pairs.append((name.strip(), value.strip()))
    return pairs


def once(option: str, given: list[str] | None) -> dict[str, str]:
    """Names and values of a repeatable option in which no name stands twice.

    Raises:
        InputError: For an item that is no ``NAME=VALUE``, or a name that comes again.
    """
    found: dict[str, str] = {}
    for name, value in pairs(option, given):
        if name in found:
            raise InputError(f"{option} {name}={value}: {name} is given twice")
        found[name] = value
    return found


def rank() -> int:
    """This process's rank; 0 where MPI is not there."""
    try:
        from mpi4py import MPI
    except ImportError:
        return 0
    return MPI.COMM_WORLD.rank


def free_cores() -> int:
    """Processes that work side by side by default: one a core, and one where ranks share the work already."""
    try:
        from mpi4py import MPI
    except ImportError:
        ranks = 1
    else:
        ranks = MPI.COMM_WORLD.size
    return min(len(os.sched_getaffinity(0)), 64) if ranks == 1 else 1


def console(stderr: bool = False) -> Console:
    """A plain console on standard output or standard error; square brackets and colons mean themselves."""
    return Console(stderr=stderr, highlight=False, markup=False, emoji=False)


def plain(text: object) -> str:
    """The text as a terminal may have it: without control characters, which could be commands to it."""
    return re.sub(r"[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]+", "\N{REPLACEMENT CHARACTER}", str(text))


def print_json(data: Any) -> None:
    """Indented JSON on standard output."""
    sys.stdout.write(json.dumps(data, indent=1) + "\n")


PULSE = 15.0
"""Longest silence in a log, in seconds."""


class WorkProgress:
    """What long work says of itself: a bar on a terminal, lines in a log; this one keeps silent.

    Calling it says where the work is.
    """

    def __call__(self, what: str, done: float, total: float) -> None:
        """The work is at ``what``; ``done`` of ``total`` is behind it."""

    def line(self, text: str) -> None:
        """Something came to its end: a line in a log; a terminal shows the bar alone."""


class _Bar(WorkProgress):
    def __init__(self, bar: Any) -> None:
        self._bar, self._task = bar, bar.add_task("starting", total=None)

    def __call__(self, what: str, done: float, total: float) -> None:
        self._bar.update(self._task, description=plain(what), completed=done, total=total)


class _Log(WorkProgress):
    """Lines on standard error; one at least every :data:`PULSE` seconds while the work goes on."""

    def __init__(self) -> None:
        self._begun, self._latest, self._ended = time.monotonic(), "starting", Event()
        # The stream of now: what is redirected later belongs to others.
        self._stream = sys.stderr

    def __call__(self, what: str, done: float, total: float) -> None:
        self._latest = what

    def line(self, text: str) -> None:
        if self._stream is None:
            return
        minutes, seconds = divmod(int(time.monotonic() - self._begun), 60)
        with suppress(OSError, ValueError):  # a reader that went away is no reason to end the work
            self._stream.write(f"[{minutes}:{seconds:02}] {plain(text)}\n")
            self._stream.flush()

    def beat(self) -> None:
        while not self._ended.wait(PULSE):
            self.line(self._latest)

    def end(self) -> None:
        self._ended.set()


@contextmanager
def progress_bar() -> Iterator[WorkProgress]:
    """A bar on a terminal, lines in a log, silence on all ranks but the first; yields what to report to."""
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
    # One solution may take minutes: the speed is that of the last hour, not of the last 30 s.
    with Progress(*columns, console=screen, transient=True, speed_estimate_period=3600) as bar:
        yield _Bar(bar)


def complain(text: str) -> None:
    """One line on standard error, from one rank; cut where it is very long, without control characters."""
    if rank() != 0:
        return
    line = plain(" ".join(text.split()))
    if len(line) > LONGEST_COMPLAINT:
        line = f"{line[: LONGEST_COMPLAINT // 2]} ... {line[-LONGEST_COMPLAINT // 4 :]}"
    sys.stderr.write(f"weakforms: {line}\n")


def _abort_other_ranks() -> None:
    """End ranks that would wait for this one for ever."""
    from mpi4py import MPI

    if MPI.COMM_WORLD.size > 1:
        MPI.COMM_WORLD.Abort(1)


def guarded(run: Callable[[], Any], debug: bool = False) -> int:
    """Exit status of a command; deliberate errors become one line, with ``debug`` after their traceback."""
    try:
        outcome = run()
        sys.stdout.flush()
    except (Exception, KeyboardInterrupt, SystemExit) as error:
        if debug:
            traceback.print_exc()
        status, text = _verdict_on(error)
        complain(text)
        return status
    return outcome if isinstance(outcome, int) else 0


def _verdict_on(error: BaseException) -> tuple[int, str]:
    """Exit status and message an exception ends a command with."""
    if isinstance(error, WeakformsError):
        return error.exit_status, str(error)
    if isinstance(error, COMPLAINT):
        return 2, error.format_message()
    if isinstance(error, typer.Abort | KeyboardInterrupt):
        return 130, "interrupted"
    if isinstance(error, SystemExit):  # what click and rich make of a reader that went away
        return 2, "cannot write to standard output: Broken pipe"
    # What is left is a defect of ours: still one line, and a way to the traceback.
    defect = 1, f"internal error, please report it ({type(error).__name__}: {error}); see --debug"
    return _refused_by_the_system(error) or defect


def _refused_by_the_system(error: BaseException) -> tuple[int, str] | None:
    """Exit status and message where the machine, not the program, ended a command."""
    if isinstance(error, MemoryError):
        return 4, "there is not enough memory for this"
    if not isinstance(error, OSError):
        return None
    if _stdout_is_gone() or (error.filename is None and error.errno in (errno.ENOSPC, errno.EPIPE)):
        return 2, f"cannot write to standard output: {error.strerror}"
    if error.errno not in _LACKS:
        return None
    place = f" ({error.filename})" if error.filename else ""
    return 4, f"this machine does not let it go on: {error.strerror}{place}"


def _stdout_is_gone() -> bool:
    """Whether standard output takes nothing more; then it is closed for good, so that the exit is quiet."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return True
    return False
