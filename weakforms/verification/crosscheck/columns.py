"""Columns of another code in our form: read from a file, for the same parameters, renamed, without units."""

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
"""A curve: a CSV or JSON file, or columns by name."""


def read(curve: CurveLike, branch: str) -> CurveFile:
    """Read a curve.

    Args:
        curve: The file or the columns.
        branch: Branch of a file that has several; by default the primary one.

    Raises:
        InputError: If the file or the columns are not a curve.
    """
    if isinstance(curve, str | Path):
        return read_curve(Path(curve), branch)
    if branch:
        raise InputError(f"branch {branch!r}: only files have branches, not columns")
    return CurveFile(_checked(curve))


def require_same_parameters(own: CurveFile, table: Reference, drawn: Curve) -> None:
    """Make sure that a result has the problem and parameters of a table.

    This compares the problem, the parameters that the table states, and parameters that are words, such as
    the model or the kind of contact. The case states the latter or leaves them at their defaults (known only
    if DOLFINx is installed). The end of a branch (``p_end``) matters only if a deflation starts there.

    Args:
        own: The curve; nothing is compared if it is not a result.
        table: The reference.
        drawn: The curve of the case for which the table was made.

    Raises:
        InputError: If parameters differ; the message names them.
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
    """Whether a parameter is the table's, or one of them if the table is for several values together."""
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
    """The columns of a curve with our names and our scaling.

    Args:
        columns: Columns of the curve.
        wanted: Names of the table's columns that are compared; no other may be renamed or scaled.
        names: Names in the curve by names in the table; a column that is not listed has the same name.
        constants: Radius, modulus and thickness, if the curve has units.
        problem: Problem whose scaling applies.

    Raises:
        InputError: If a name is unknown, a column stands for two columns, or a constant is missing.
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
    # A column that is renamed does not also count under its own name.
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
