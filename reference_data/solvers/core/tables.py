"""Reference tables: agreement of two methods, plain CSV, and the TOML that documents it.

A column is written only after its two independent values agree within their own combined
uncertainty in every row. The uncertainty stored with it is the refinement uncertainty of the
written method, plus the largest difference of the two methods, plus half a unit of the last
printed digit.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

Array = np.ndarray
DIGITS = 12
TWO_GRIDS = 3.0
"""Safety factor on the difference of two grids without a third one for the order (Roache 1994)."""


@dataclass
class Estimate:
    """A value per row, its uncertainty, and the observed order of convergence where there is one."""

    value: Array
    uncertainty: Array
    order: Array | None = None


@dataclass
class Levels:
    """Coarse and fine values of one method; the fine ones count.

    Attributes:
        coarse: Values at the coarser resolution.
        fine: Values at the finer one.
        floor: Absolute part of the uncertainty that does not depend on the resolution.
        rounding: The same, relative to values larger than one.
    """

    coarse: Array
    fine: Array
    floor: Array | float = 0.0
    rounding: float = 0.0

    def __post_init__(self) -> None:
        self.coarse, self.fine = (np.asarray(x, dtype=float) for x in (self.coarse, self.fine))

    @property
    def value(self) -> Array:
        """The values."""
        return self.fine

    @property
    def uncertainty(self) -> Array:
        """Difference of the two resolutions, rounding and floor."""
        rest = self.rounding * np.maximum(1.0, np.abs(self.fine)) + self.floor
        return np.abs(self.fine - self.coarse) + rest


def rule(written: str) -> str:
    """What the values and uncertainties of a table are, for its method: ``written`` is (a) or (b)."""
    return (
        f"The values are ({written}); a table is written only if |a - b| <= hypot(u_a, u_b) in every row. "
        f"The uncertainty of a column is u_{written} + max |a - b| + half a unit of the last digit; "
        "largest_difference_of_methods is max |a - b|."
    )


class DisagreementError(RuntimeError):
    """Two methods differ by more than their combined uncertainty."""


@dataclass
class Column:
    """One column: values, one absolute uncertainty, and what they are.

    Attributes:
        name: Header in the CSV.
        values: One number per row.
        uncertainty: Absolute; 0 for prescribed values.
        scaling: Scaling that makes the number non-dimensional.
        meaning: Description of the column.
        extra: Additional metadata, such as the difference between the two methods.
    """

    name: str
    values: Array
    uncertainty: float
    scaling: str
    meaning: str
    extra: dict[str, float] = field(default_factory=dict)


@dataclass
class Table:
    """A table and its documentation."""

    name: str
    paper: int | str
    title: str
    source: str
    method: str
    grid: str
    tolerance: str
    parameters: dict[str, object]
    abscissa: str
    columns: list[Column]
    kind: str = "independent"
    notes: str = ""
    extra: dict[str, object] = field(default_factory=dict)


def round_up(x: float) -> float:
    """Round up to two significant digits."""
    if x <= 0:
        return 0.0
    scale = 10.0 ** (math.floor(math.log10(x)) - 1)
    return float(f"{math.ceil(x / scale - 1e-9) * scale:.1e}")


def last_digit(values: Array) -> float:
    """Half a unit of the last of DIGITS significant digits of the largest value."""
    top = float(np.max(np.abs(values), initial=0.0))
    return 0.5 * 10.0 ** (math.floor(math.log10(top)) + 1 - DIGITS) if top else 0.0


def agreed(
    table: str,
    name: str,
    first: Estimate | Levels,
    second: Estimate | Levels,
    about: tuple[str, str],
    other: str = "finite differences",
    written: str = "collocation",
) -> Column:
    """Column of the values of the second, written method, after a check that the first one agrees.

    Raises:
        DisagreementError: If it does not; the message names table, column and worst row.
    """
    gap, room = np.abs(first.value - second.value), np.hypot(first.uncertainty, second.uncertainty)
    if not np.all(gap <= room):
        row = int(np.nanargmax(np.where(np.isfinite(gap), gap / room, np.inf)))
        one, two = (float(np.ravel(x.value)[row]) for x in (first, second))
        raise DisagreementError(
            f"table {table}, column {name}, row {row}: {other} {one:.14g}, {written} {two:.14g}, "
            f"difference {np.ravel(gap)[row]:.2e}, combined uncertainty {np.ravel(room)[row]:.2e}"
        )
    widest = float(np.max(gap, initial=0))
    own, others = (float(np.max(x.uncertainty, initial=0)) for x in (second, first))
    extra = {
        "largest_difference_of_methods": round_up(widest),
        f"uncertainty_{written.replace(' ', '_')}": round_up(own),
        f"uncertainty_{other.replace(' ', '_')}": round_up(others),
    }
    order = getattr(first, "order", None)
    if order is not None and np.isfinite(order).any():
        extra["observed_order_finite_differences"] = round(float(np.nanmedian(order)), 4)
    return Column(name, second.value, round_up(own + widest + last_digit(second.value)), *about, extra)


def prescribed(name: str, values: Array, about: tuple[str, str]) -> Column:
    """Column of values that are chosen, not computed."""
    return Column(name, np.asarray(values, dtype=float), 0.0, *about)


@dataclass(frozen=True)
class Series:
    """What the tables of a paper, or of another group, have in common.

    Attributes:
        paper: Number of the paper, or name of the group.
        source: Beginning of the source.
        columns: Scaling and meaning of columns, by name.
        method: How the numbers are computed.
        grid: Resolutions.
        tolerance: When iterations stop.
    """

    paper: int | str
    source: str
    columns: dict[str, tuple[str, str]]
    method: str
    grid: str
    tolerance: str

    def keys(self, **values: object) -> list[Column]:
        """Columns of chosen values, by their names."""
        return [prescribed(name, v, self.columns[name]) for name, v in values.items()]

    def table(
        self,
        name: str,
        title: str,
        source: str,
        parameters: dict[str, object],
        columns: list[Column],
        **more: Any,
    ) -> Table:
        """A table whose abscissa is its first column; ``more`` replaces what the series says."""
        said = {"paper": self.paper, "method": self.method, "grid": self.grid, "tolerance": self.tolerance}
        given = {"parameters": parameters, "abscissa": columns[0].name, "columns": columns}
        return Table(
            name=name,
            title=title,
            source=f"{self.source}, {source}".removesuffix(", "),
            **(said | given | more),
        )


def steps(start: float, stop: float, step: float) -> Array:
    """Round numbers start, start + step, ..., stop."""
    return np.round(start + step * np.arange(round((stop - start) / step) + 1), 10)


def plain(x: float) -> str:
    """Decimal number with DIGITS significant digits and no exponent."""
    if x == 0 or abs(x) < 1e-15:
        return "0"
    return np.format_float_positional(x, precision=DIGITS, unique=False, fractional=False, trim="-")


def csv_text(table: Table) -> str:
    """Header row and numbers."""
    lines = [",".join(c.name for c in table.columns)]
    rows = zip(*(c.values for c in table.columns), strict=True)
    lines += [",".join(plain(float(x)) for x in row) for row in rows]
    return "\n".join(lines) + "\n"


def _toml(value: object) -> str:
    """A TOML value; strings, numbers and lists of JSON are valid TOML."""
    if isinstance(value, float):
        return repr(value)
    return json.dumps(value, ensure_ascii=False)


def toml_text(table: Table, sha256: str) -> str:
    """Description of a table, with the checksum of :func:`sealed`."""
    head: dict[str, object] = {
        "title": table.title,
        "source": table.source,
        "type": table.kind,
        "method": table.method,
        "grid": table.grid,
        "tolerance": table.tolerance,
        "abscissa": table.abscissa,
        "regenerate": f"python -m reference_data.solvers {table.name}",
        "sha256": sha256,
    }
    if table.notes:
        head["notes"] = table.notes
    lines = [f"{key} = {_toml(value)}" for key, value in (head | table.extra).items()]
    lines += ["", "[parameters]"]
    lines += [f"{key} = {_toml(value)}" for key, value in table.parameters.items()]
    for c in table.columns:
        key = (
            json.dumps(c.name) if "." in c.name else c.name
        )  # a dot without quotes would start a nested table
        lines += ["", f"[columns.{key}]"]
        about = {"scaling": c.scaling, "meaning": c.meaning, "uncertainty": c.uncertainty}
        lines += [f"{key} = {_toml(value)}" for key, value in (about | c.extra).items()]
    return "\n".join(lines) + "\n"


def sealed(table: Table, data: bytes) -> str:
    """Description of a table with a checksum of its numbers and of all other lines of the description."""
    first, rest = toml_text(table, "\0").split('sha256 = "\\u0000"\n')
    return toml_text(table, hashlib.sha256(data + (first + rest).encode()).hexdigest())


def folder_of(paper: int | str) -> str:
    """Name of the folder of a paper's tables; a group has its own name."""
    return f"paper{paper}" if isinstance(paper, int) else paper


def write(table: Table, root: Path) -> Path:
    """Write NAME.csv and NAME.toml under root/paperN, or its group; each appears only when it is complete."""
    for c in table.columns:
        if not np.all(np.isfinite(c.values)):
            raise ValueError(f"table {table.name}, column {c.name}: not a finite number")
    folder = root / folder_of(table.paper)
    folder.mkdir(parents=True, exist_ok=True)
    data = csv_text(table).encode()
    texts = {"csv": data, "toml": sealed(table, data).encode()}
    for suffix, content in texts.items():
        target = folder / f"{table.name}.{suffix}"
        partial = target.with_name(target.name + ".part")
        partial.write_bytes(content)
        os.replace(partial, target)
    return folder / f"{table.name}.csv"
