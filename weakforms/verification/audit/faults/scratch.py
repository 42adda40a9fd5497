"""Scratch copies of the tree: a fault is put into a copy, and the copy always goes."""

from __future__ import annotations

import hashlib
import shutil
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from weakforms.errors import EnvironmentLackError
from weakforms.verification.audit.faults.catalogue import Fault
from weakforms.verification.cases.references import ROOT

PARTS = ("weakforms", "cases", "reference_data", "tests", "pyproject.toml")
"""What of the tree is copied; an installed package has no tests and no ``pyproject.toml``."""

PREFIX = "weakforms-faults-"
"""What the names of scratch folders begin with."""


def tree_digest(root: Path = ROOT) -> str:
    """Digest of all that a run of the catalogue depends on."""
    digest = hashlib.sha256()
    for part in PARTS:
        paths = sorted((root / part).rglob("*")) if (root / part).is_dir() else [root / part]
        for path in paths:
            if path.is_file() and path.suffix in (".py", ".toml", ".csv", ".json"):
                digest.update(path.relative_to(root).as_posix().encode())
                digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """A folder that is gone afterwards, also when the run is interrupted or told to end (SIGTERM)."""

    def end(_number: int, _frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, end)
    folder = Path(tempfile.mkdtemp(prefix=PREFIX))
    try:
        yield folder
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # nothing cuts the tidying short
        shutil.rmtree(folder, ignore_errors=True)
        signal.signal(signal.SIGTERM, before)


def copy_tree(to: Path, fault: Fault | None = None, root: Path = ROOT) -> Path:
    """A copy of the tree, with a fault in it if one is given; the tree itself is only read.

    Raises:
        EnvironmentLackError: When there is no space for it.
        InputError: When the fault does not fit the tree.
    """
    try:
        for part in PARTS:
            if (root / part).is_dir():
                shutil.copytree(root / part, to / part)
            elif (root / part).is_file():
                shutil.copy2(root / part, to / part)
    except (OSError, shutil.Error) as error:
        raise EnvironmentLackError(
            f"no scratch copy of the tree in {to.parent}: {error}; TMPDIR names another folder"
        ) from error
    if fault is not None:
        path = to / fault.file
        path.write_text(fault.applied(path.read_text("utf-8")), "utf-8")
        # Byte code is told apart by time and size of its source: do not rest on either.
        for compiled in path.parent.glob(f"__pycache__/{path.stem}.*.pyc"):
            compiled.unlink()
    return to
