"""The entry point of the command line: settings of the process, then one verb with its exit status."""

from __future__ import annotations

import logging
import os
import sys
import tempfile
from contextlib import suppress

from weakforms.cli.app import app
from weakforms.terminal import guarded


def main() -> None:
    """Run the command line."""
    # PETSc's own handlers turn a closed pipe or a termination into a crash report.
    os.environ["PETSC_OPTIONS"] = f"{os.environ.get('PETSC_OPTIONS', '')} -no_signal_handler".strip()
    with suppress(FileNotFoundError):
        os.environ["TMPDIR"] = tempfile.gettempdir()  # MPI fails if it cannot write to its folder
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it warns if it has no folder of its own
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:  # the caller may have closed it
            stream.reconfigure(errors="backslashreplace")
    words = sys.argv[1:]
    debug = "--debug" in words
    words = [word for word in words if word != "--debug"]
    sys.exit(guarded(lambda: app(words, standalone_mode=False), debug))
