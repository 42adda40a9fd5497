"""Reference tables: read, held against their checksums, and never written from here."""

from __future__ import annotations

import hashlib
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from weakforms.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
"""The folder that holds ``weakforms``, ``cases`` and ``reference_data`` side by side."""

KINDS = ("exact", "independent", "printed", "other-code")


@dataclass(frozen=True)
class Reference:
    """A table of numbers from somewhere else, with what is known of their accuracy."""

    name: str
    kind: str
    source: str
    method: str
    abscissa: str | None
    columns: dict[str, np.ndarray]
    uncertainty: dict[str, float]
    parameters: dict[str, Any]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    @property
    def ordinates(self) -> list[str]:
        """Columns other than the abscissa."""
        return [name for name in self.columns if name != self.abscissa]


@cache
def load(paper: int, name: str, root: Path = ROOT) -> Reference:
    """The table ``reference_data/paperN/NAME``.

    Raises:
        InputError: When it is missing, incomplete, altered (by its checksum) or no table.
    """
    folder = root / "reference_data" / f"paper{paper}"
    facts = _facts(folder / f"{name}.toml")
    path = folder / f"{name}.csv"
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise InputError(f"reference table {path.name}: {error.strerror}") from error
    if hashlib.sha256(raw).hexdigest() != facts.get("sha256"):
        raise InputError(
            f"reference table {path} is truncated or altered: its checksum is not the one in {name}.toml; "
            f"restore it, or regenerate it: {facts.get('regenerate', 'python -m reference_data.solvers')}"
        )
    columns = _columns(path.name, raw.decode("ascii"))
    described = facts.get("columns", {})
    missing = [column for column in columns if "uncertainty" not in described.get(column, {})]
    if missing or facts.get("type") not in KINDS:
        raise InputError(f"reference table {name}.toml: no uncertainty for {missing}, or unknown type")
    return Reference(
        name=name,
        kind=facts["type"],
        source=facts.get("source", ""),
        method=facts.get("method", ""),
        abscissa=facts.get("abscissa"),
        columns=columns,
        uncertainty={column: float(described[column]["uncertainty"]) for column in columns},
        parameters=dict(facts.get("parameters", {})),
    )


def _facts(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text("utf-8"))
    except OSError as error:
        raise InputError(f"reference table {path.name}: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"reference table {path.name} is not TOML: {error}") from error


def _columns(name: str, text: str) -> dict[str, np.ndarray]:
    lines = text.splitlines()
    header = lines[0].split(",")
    try:
        rows = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    except ValueError as error:
        raise InputError(f"reference table {name}: {error}") from error
    if rows.ndim != 2 or rows.shape[1] != len(header):
        raise InputError(f"reference table {name}: rows do not fit the header {header}")
    return dict(zip(header, rows.T, strict=True))
