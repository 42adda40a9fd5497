"""What the verbs share: request parsing, one-line errors, progress on a terminal, output from one rank."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from weakforms.errors import InputError, WeakformsError


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
    states = [(str(k), _number(str(k), v)) for k, v in data.get("at", {}).items()]
    states += [(name, _number(name, value)) for name, value in _pairs("--at", at)]
    return {
        "parameters": data.get("parameters", {}) | dict(_pairs("--set", sets)),
        "numerics": data.get("numerics", {}) | dict(_pairs("--mesh", mesh)),
        "at": states,
    }


def _pairs(option: str, given: list[str] | None) -> list[tuple[str, str]]:
    pairs = []
    for item in given or []:
        name, equals, value = item.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise InputError(f"{option} {item!r}: NAME=VALUE is wanted")
        pairs.append((name.strip(), value.strip()))
    return pairs


def _number(name: str, value: object) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"--at {name}={value}: the value must be a number") from None


def rank() -> int:
    """This process's rank; 0 where MPI is not there."""
    try:
        from mpi4py import MPI
    except ImportError:
        return 0
    return MPI.COMM_WORLD.rank


def console(stderr: bool = False) -> Console:
    """A plain console on standard output or standard error."""
    return Console(stderr=stderr, highlight=False)


def print_json(data: Any) -> None:
    """Indented JSON on standard output."""
    sys.stdout.write(json.dumps(data, indent=1, ensure_ascii=False) + "\n")


@contextmanager
def progress_bar() -> Any:
    """A bar on a terminal, nothing elsewhere; yields the callback solvers report to."""
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    screen = console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    if not screen.is_terminal or rank() != 0:
        yield lambda _what, _done, _total: None
        return
    with Progress(*columns, console=screen, transient=True) as bar:
        task = bar.add_task("starting", total=None)

        def report(what: str, done: int, total: int) -> None:
            bar.update(task, description=what, completed=done, total=total)

        yield report


def complain(text: str) -> None:
    """One line on standard error, from one rank."""
    if rank() == 0:
        sys.stderr.write(f"weakforms: {' '.join(text.split())}\n")


def guarded(run: Callable[[], Any]) -> int:
    """Exit status of a command; deliberate errors become one line."""
    try:
        outcome = run()
    except WeakformsError as error:
        complain(str(error))
        return error.exit_status
    except click.ClickException as error:
        complain(error.format_message())
        return 2
    except (click.Abort, KeyboardInterrupt):
        complain("interrupted")
        return 130
    except BrokenPipeError:
        return 0
    except Exception as error:
        # A defect of ours: still one line, and a way to the traceback.
        complain(f"internal error, please report it ({type(error).__name__}: {error}); see --debug")
        return 1
    return outcome if isinstance(outcome, int) else 0
