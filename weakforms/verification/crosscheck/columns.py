"""Somebody else's columns as ours: read from a file, for the same parameters, renamed, and without units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.results import CurveFile, read_curve
from weakforms.scaling import nondimensional
from weakforms.verification.cases.references import Reference
from weakforms.verification.judging.checks.curve import Curve

CurveLike = str | Path | Mapping[str, Sequence[float]]
"""A CSV or JSON file, or columns by name."""


def read(curve: CurveLike, branch: str) -> CurveFile:
    """A curve as it was given.

    Args:
        curve: The file or the columns.
        branch: Which branch of a file that has several; by default the primary one.

    Raises:
        InputError: For a file or columns that are none.
    """
    if isinstance(curve, str | Path):
        return read_curve(Path(curve), branch)
    if branch:
        raise InputError(f"branch {branch!r}: columns have none; it chooses one of a file's")
    return CurveFile(_checked(curve))


def require_same_parameters(own: CurveFile, table: Reference, drawn: Curve) -> None:
    """Make sure that a result was solved for what the table holds.

    Compared are the problem, the parameters that the table states, and words, such as the model or the kind
    of contact, that the case states or leaves at their defaults (the latter where DOLFINx is installed, for
    the problem knows them). How far a branch was followed (``p_end``) matters only where a deflation starts
    from there.

    Args:
        own: What was read; nothing is known of a curve that is no result.
        table: The reference.
        drawn: The curve of the case that it belongs to.

    Raises:
        InputError: Naming the parameters that differ.
    """
    if not own.problem:
        return
    if own.problem != drawn.of.problem:
        raise InputError(
            f"the curve is a result of {own.problem}, table {table.name} is for {drawn.of.problem}"
        )
    stated = {name: value for name, value in drawn.of.parameters if isinstance(value, str)}
    wanted = _default_words(own.problem) | stated | table.parameters
    if wanted.get("phase", "inflation") == "inflation":
        wanted = {name: value for name, value in wanted.items() if not name.endswith("_end")}
    differences = [
        f"{name} = {own.parameters[name]} (the table's: {value})"
        for name, value in wanted.items()
        if own.parameters.get(name) is not None and not _same(own.parameters[name], value)
    ]
    if differences:
        raise InputError(
            f"the curve is a result for other parameters than table {table.name}: {', '.join(differences)}"
        )


def _default_words(problem: str) -> dict[str, Any]:
    from weakforms.api import require_environment

    try:
        fields = require_environment().get(problem).parameters.model_fields
    except EnvironmentLackError:
        return {}
    return {name: field.default for name, field in fields.items() if isinstance(field.default, str)}


def _same(own: object, value: object) -> bool:
    """Whether a parameter is the table's; of several solved for together, whether it is among them."""
    if isinstance(own, list):
        return any(_same(item, value) for item in own)
    if isinstance(own, int | float) and isinstance(value, int | float):
        return bool(np.isclose(own, value, rtol=1e-9, atol=0))
    return own == value


def our_columns(
    columns: Mapping[str, np.ndarray],
    wanted: Sequence[str],
    names: Mapping[str, str] | None,
    constants: Mapping[str, float] | None,
    problem: str,
) -> dict[str, np.ndarray]:
    """Columns under our names and in our scaling.

    Args:
        columns: Theirs.
        wanted: Our columns that are compared; nothing else may be renamed or scaled.
        names: Theirs, by ours; a column that is not listed has our name.
        constants: Radius, modulus and thickness, where the curve has units.
        problem: Whose scaling.

    Raises:
        InputError: For a name that is nobody's, a column that stands for two, a constant that is missing.
    """
    for ours, theirs in (names or {}).items():
        if ours not in wanted:
            raise InputError(f"--map {ours}={theirs}: the table has no {ours!r}; it has {', '.join(wanted)}")
        if theirs not in columns:
            raise InputError(
                f"--map {ours}={theirs}: the curve has no column {theirs!r}; it has {', '.join(columns)}"
            )
        if list((names or {}).values()).count(theirs) > 1:
            raise InputError(f"--map {ours}={theirs}: the curve's {theirs!r} can stand for one column only")
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
