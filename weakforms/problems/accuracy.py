"""Solve on meshes that are only as fine as an accuracy needs.

The first family of meshes is coarser than the default one. It is refined while the bound of some number is
above a tenth of the accuracy, for the uncertainties of coarse meshes are less reliable than those of fine
ones.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from math import ceil, isfinite, log2
from typing import Any

import numpy as np
from pydantic import ValidationError

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.problem import Problem
from weakforms.results import Failure, Result

Solve = Callable[[Any, Any], Result]
"""A function of parameters and numerics."""

FACTORS = (0.25, 0.5, 1, 2, 4)
"""Numbers of cells that are tried, relative to the default meshes."""

SMALLEST, LARGEST = 1e-9, 0.1
"""Accuracies that can be asked. Newton's method leaves errors of 1e-11, and bounds must be ten times smaller
than the accuracy."""

SHARE = 0.1
"""Share of the accuracy that the bound of every number must reach."""

FACTOR = 2.0
"""A bound is this many uncertainties, as for every check."""

NOTHING = 1e-6
"""Magnitude below which all values of a column are zeros; their bounds are then judged against one."""


def require_accuracy(accuracy: float, problem: str, numerics: Any) -> None:
    """Refuse an accuracy that cannot be asked.

    Raises:
        InputError: If it is out of range, the problem has no family of meshes, or its cells are given too.
    """
    if not SMALLEST <= accuracy <= LARGEST:
        raise InputError(f"accuracy = {accuracy!r}: must lie between {SMALLEST:g} and {LARGEST:g}")
    if not isinstance(numerics, MeshNumerics):
        raise InputError(f"{problem}: its meshes are not refined, so that no accuracy can be asked")
    if "cells" in numerics.model_fields_set:
        raise InputError(f"{problem}: cells and an accuracy exclude each other; give one of them")


def at_accuracy(
    accuracy: float, problem: Problem, numerics: MeshNumerics, solve: Solve, parameters: Any
) -> Result:
    """Solve on one family of meshes after the other, until the bounds are small enough.

    What does not converge or is not there on meshes coarser than the default ones is tried on finer ones.

    Args:
        accuracy: What is asked of every number, relative to the largest magnitude of its column.
        problem: The problem.
        numerics: Meshes that are used if no accuracy is asked, except where the problem needs finer ones.
        solve: Solves at parameters on meshes.
        parameters: The parameters.

    Returns:
        The first result whose bounds are small enough, or the last one, with a failure that says which number
        is not accurate enough. ``accuracy`` in its ``numerics`` lists the meshes.

    Raises:
        ConvergenceError: If there is no result on the finest meshes.
        InputError: If a requested state is not there on the default meshes.
    """
    tried: list[list[int]] = []
    default = problem.resolving(parameters, numerics)
    families = _families(default)
    while True:
        numerics = families.pop(0)
        tried.append(numerics.meshes)
        coarse = numerics.meshes[-1] < default.meshes[-1]
        try:
            result = solve(parameters, numerics)
        except (ConvergenceError, InputError):
            if coarse:
                continue
            raise
        bound, of = widest_bound(result)
        record = {"asked": accuracy, "bound": bound, "of": of, "meshes": list(tried)}
        result.numerics["accuracy"] = record
        enough = bound <= SHARE * accuracy
        if enough and not (coarse and (result.failures or result.absent)):
            return result
        if not families:
            break
        if not enough:
            del families[: min(_skipped(bound / (SHARE * accuracy), numerics.degree), len(families) - 1)]
    needs = f"the bound of {of} is {bound:.1e} on the finest meshes, with up to {tried[-1][-1]} cells"
    result.failures.append(Failure("accuracy", f"{accuracy:g} needs a tenth of it as bound; {needs}"))
    return result


def on_finer_meshes(problem: Problem, numerics: Any, solve: Solve, parameters: Any) -> Result:
    """Solve on the default meshes and, if something does not converge there, on finer ones.

    Args:
        problem: The problem, which says which meshes are finer, if there are any.
        numerics: The default meshes.
        solve: Solves at parameters on meshes.
        parameters: The parameters.

    Returns:
        The result with fewer failures. If it is the one on finer meshes, a warning says so.

    Raises:
        ConvergenceError: If there is no result on any mesh; that of the default ones.
    """
    first = stalled = None
    try:
        first = solve(parameters, numerics)
        reasons = [failure.reason for failure in first.failures]
    except ConvergenceError as error:
        stalled, reasons = error, [str(error)]
    finer = problem.finer(parameters, numerics) if reasons else None
    if finer is not None:
        with suppress(ConvergenceError):
            again = solve(parameters, finer)
            if first is None or len(again.failures) < len(reasons):
                again.warnings.append(
                    f"solved with cells = {finer.cells}; on the default meshes: {reasons[0]}"
                )
                return again
    if stalled is not None:
        raise stalled
    return first


def _families(default: MeshNumerics) -> list[MeshNumerics]:
    """The default meshes, coarser and finer ones that the problem allows, coarse to fine."""
    found = []
    for factor in FACTORS:
        with suppress(ValidationError):
            found.append(default.scaled(factor))
    return found


def _skipped(excess: float, degree: int) -> int:
    """Number of families that are not worth trying if a bound is so many times too large.

    The widest bound is usually that of a derivative at a point, which converges with the degree.
    """
    return max(0, ceil(log2(excess) / degree) - 1) if isfinite(excess) else 0


def widest_bound(result: Result) -> tuple[float, str]:
    """The largest bound of all numbers, relative to the largest magnitude of their column, and its number."""
    found = list(_numbers(result))
    scales: dict[str, float] = {}
    for name, _, value, _ in found:
        scales[name] = max(scales.get(name, 0.0), float(np.max(np.abs(value), initial=0.0)))
    widest = 0.0, "every number"
    for name, where, _, uncertainty in found:
        scale = scales[name] if scales[name] > NOTHING else 1.0
        bound = FACTOR * float(np.max(uncertainty, initial=0.0)) / scale
        if not bound <= widest[0]:  # so that a bound that is no number counts
            widest = bound, f"{name} {where}"
    return widest


def _numbers(result: Result) -> Iterator[tuple[str, str, np.ndarray, np.ndarray]]:
    """Name, place, values and uncertainties of all numbers that have an uncertainty."""
    for branch in result.branches:
        for name, spread in branch.uncertainty.items():
            there = np.isfinite(branch.columns[name])  # not all columns have a meaning on all of a branch
            yield name, f"on the {branch.name} branch", branch.columns[name][there], spread[there]
    for point in result.special_points:
        for name, spread in point.uncertainty.items():
            yield name, f"at a {point.kind}", np.array(point.values[name]), np.array(spread)
    for quantities, where in [(result.quantities, "")] + [
        (s.quantities, "in a state") for s in result.states
    ]:
        for name, quantity in quantities.items():
            if quantity.uncertainty is not None:
                yield name, where, np.array(quantity.value), np.array(quantity.uncertainty)
    for state in result.states:
        for field in state.fields:
            for name, spread in field.uncertainty.items():
                yield f"{name} of the {field.name}", "", field.columns[name], np.array(spread)
