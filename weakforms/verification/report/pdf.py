"""The report as one PDF, printed by a browser without a window."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render_whole

NAME = "report.pdf"
"""Name of the file."""
BROWSERS = (
    "chromium-headless-shell",
    "chromium",
    "chromium-browser",
    "google-chrome-stable",
    "google-chrome",
    "microsoft-edge",
)
"""Browsers that can print a page; the first one that is installed is used."""
QUIET = (
    "--headless",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--hide-scrollbars",
)
PATIENCE = 600
"""Time limit of the browser in seconds."""


def browser() -> str:
    """Path of an installed browser.

    Raises:
        EnvironmentLackError: If there is none; the message says how to install one.
    """
    for name in BROWSERS:
        if path := shutil.which(name):
            return path
    raise EnvironmentLackError(
        "no Chromium, Chrome or Edge is here to print the report with; on Debian: apt install chromium "
        "(./run report DIR --pdf brings its own)"
    )


def require_pdf_name(path: Path) -> None:
    """Make sure that a PDF can be written under a name.

    Raises:
        InputError: For another ending, or a folder that is not there or not writable.
    """
    if path.suffix.lower() != ".pdf":
        raise InputError(f"cannot write a PDF to {path}: the name must end in .pdf")
    if path.is_dir() or not os.access(path.parent, os.W_OK):
        raise InputError(f"cannot write {path}: no such folder, or it cannot be written to")


def write_pdf(run: RunOutcome, path: Path) -> Path:
    """Print all pages of a report into one PDF, which appears only when it is complete.

    Args:
        run: What :func:`weakforms.verification.report.report.load_run` returned.
        path: The file; its folder must exist.

    Raises:
        InputError: If the place cannot be written to.
        EnvironmentLackError: If there is no browser, or it fails.
    """
    path = Path(path).absolute()
    require_pdf_name(path)
    program = browser()
    with tempfile.TemporaryDirectory(prefix="weakforms-pdf-") as name:
        folder = Path(name)
        page, printed = folder / "report.html", folder / "report.pdf"
        whole = render_whole(run, Beside.read(path.parent))
        page.write_text(whole, encoding="utf-8")
        command = [program, *QUIET, f"--user-data-dir={folder / 'profile'}", "--no-pdf-header-footer"]
        # A browser's own sandbox does not work for root; the page has no script to guard against.
        command += ["--no-sandbox"] * (hasattr(os, "geteuid") and os.geteuid() == 0)
        command += [f"--print-to-pdf={printed}", page.as_uri()]
        environment = os.environ | {"HOME": name, "XDG_CONFIG_HOME": name, "XDG_CACHE_HOME": name}
        try:
            done = subprocess.run(
                command, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            raise EnvironmentLackError(f"{program} did not print the report: {error}") from error
        if done.returncode or not printed.exists():
            said = " ".join(done.stderr.split())[-300:]
            raise EnvironmentLackError(
                f"{program} did not print the report (status {done.returncode}): {said}"
            )
        partial = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            shutil.copyfile(printed, partial)
            os.replace(partial, path)
        except OSError as error:
            raise InputError(f"cannot write {path}: {error.strerror}") from error
        finally:
            partial.unlink(missing_ok=True)
    return path
