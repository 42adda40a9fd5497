"""Somebody else's columns as ours: read from a file, renamed, and without units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from weakforms.errors import InputError
from weakforms.results import read_curve
from weakforms.scaling import nondimensional

CurveLike = str | Path | Mapping[str, Sequence[float]]
"""A CSV or JSON file, or columns by name."""


def foreign_columns(
    curve: CurveLike,
    wanted: Sequence[str],
    names: Mapping[str, str] | None,
    constants: Mapping[str, float] | None,
    problem: str,
) -> dict[str, np.ndarray]:
    """Columns under our names and in our scaling.

    Args:
        curve: The file or the columns.
        wanted: Our columns that are compared; nothing else may be renamed or scaled.
        names: Theirs, by ours; a column that is not listed has our name.
        constants: Radius, modulus and thickness, where the curve has units.
        problem: Whose scaling.

    Raises:
        InputError: For a file or columns that are none, a name that is nobody's, a constant that is missing.
    """
    columns = read_curve(Path(curve)) if isinstance(curve, str | Path) else _checked(curve)
    for ours, theirs in (names or {}).items():
        if ours not in wanted:
            raise InputError(f"--map {ours}={theirs}: the table has no {ours!r}; it has {', '.join(wanted)}")
        if theirs not in columns:
            raise InputError(
                f"--map {ours}={theirs}: the curve has no column {theirs!r}; it has {', '.join(columns)}"
            )
    renamed = {ours: columns[theirs] for ours, theirs in (names or {}).items()}
    # A column that stands for one of ours under its own name is not also another of ours.
    taken = set((names or {}).values())
    shown = {name: values for name, values in columns.items() if name not in taken} | renamed
    if not constants:
        return shown
    scaled = {name: values for name, values in shown.items() if name in wanted}
    return shown | nondimensional(problem, scaled, **constants)


def _checked(curve: Mapping[str, Sequence[float]]) -> dict[str, np.ndarray]:
    out = {}
    for name, values in curve.items():
        try:
            array = np.asarray(values, dtype=float)
        except (TypeError, ValueError, OverflowError) as error:
            raise InputError(f"column {name!r}: {error}") from error
        if array.ndim != 1 or not len(array) or not np.all(np.isfinite(array)):
            raise InputError(f"column {name!r} must be a list of finite numbers")
        out[str(name)] = array
    if len({len(values) for values in out.values()}) > 1:
        raise InputError("the curve's columns differ in length")
    return out
