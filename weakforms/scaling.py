"""Conversion between numbers with units and the papers' non-dimensional numbers.

Every paper divides lengths by one radius and forces per length by one stiffness; all other scales follow. A
code that computes in metres and pascals gives its radius, thickness and modulus, and each of its columns is
divided by its scale.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from weakforms.errors import InputError
from weakforms.problems.about import About
from weakforms.problems.column import DIMENSIONS
from weakforms.problems.registry import abouts


def unit(about: About, column: str, constants: Mapping[str, float]) -> float:
    """One unit of a column, as a number, from the constants' values.

    Raises:
        InputError: If a constant is missing, not a number or not positive.
    """
    dimension = about.dimensions.get(column, "number")
    powers = about.units.powers(dimension)
    values = {name: _constant(name, constants, about) for name in powers}
    try:
        size = math.prod(values[name] ** power for name, power in powers.items())
    except OverflowError:
        size = math.inf
    size *= about.units.turns(dimension)
    if not 0 < size < math.inf:
        stated = ", ".join(f"{name} = {value:g}" for name, value in values.items())
        raise InputError(f"with {stated} a unit of {column} is {size:g}; it must be positive and finite")
    return size


def symbols(problem: str, column: str) -> str:
    """The same unit in symbols, such as ``C1 h_o/R_f``; empty for a column without one."""
    about = abouts().get(problem)
    return "" if about is None else about.units.unit(about.dimensions.get(column, "number"))


def _constant(name: str, constants: Mapping[str, float], about: About) -> float:
    if name not in constants:
        used = [dimension for dimension in DIMENSIONS if dimension in about.dimensions.values()]
        units = "; ".join(f"{dimension} is divided by {about.units.unit(dimension)}" for dimension in used)
        raise InputError(f"the constant {name} is missing: {units}")
    try:
        value = float(constants[name])
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"constant {name} = {str(constants[name])[:40]!r} is not a number") from None
    if not 0 < value < math.inf:
        raise InputError(f"constant {name} = {value:g} must be positive and finite")
    return value


def scaled(problem: str) -> About:
    """A problem whose numbers have units.

    Raises:
        InputError: If there is none of that name.
    """
    known = {name: about for name, about in abouts().items() if about.units.constants}
    if problem not in known:
        raise InputError(f"no scaling is known of problem {problem!r}; known: {', '.join(known)}")
    return known[problem]


def nondimensional(
    problem: str, columns: Mapping[str, Sequence[float]], **constants: float
) -> dict[str, np.ndarray]:
    """Convert columns with units to the paper's numbers: each is divided by its unit.

    Args:
        problem: Problem whose scaling applies, such as ``"tube"``.
        columns: Columns by the problem's names; columns with other names are not changed.
        **constants: Radius, modulus and thickness by the paper's symbols, such as ``R_f``, ``C1``, ``h_o``.

    Raises:
        InputError: If the problem has no scaling, or a constant is missing, unknown or not positive.
    """
    return _converted(problem, columns, constants, -1)


def dimensional(
    problem: str, columns: Mapping[str, Sequence[float]], **constants: float
) -> dict[str, np.ndarray]:
    """Convert the paper's numbers to numbers with units: the inverse of :func:`nondimensional`."""
    return _converted(problem, columns, constants, 1)


def _converted(
    problem: str, columns: Mapping[str, Sequence[float]], constants: Mapping[str, float], power: int
) -> dict[str, np.ndarray]:
    about = scaled(problem)
    unknown = sorted(set(constants) - set(about.units.constants))
    if unknown:
        raise InputError(
            f"{problem} has no constant {unknown[0]!r}; its scaling takes {', '.join(about.units.constants)}"
        )
    for name in constants:
        _constant(name, constants, about)
    return {
        name: np.asarray(values, dtype=float) * unit(about, name, constants) ** power
        for name, values in columns.items()
    }
