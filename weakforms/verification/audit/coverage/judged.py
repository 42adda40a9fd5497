"""Compare every number of a coarse solution with a fine one, and give statistics of many numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.about import Family
from weakforms.results import Result
from weakforms.verification.audit.same import Number, numbers

FLOOR = 1e-10
"""Errors below this, relative to the number or to 1, cannot be distinguished from round-off."""


@dataclass(frozen=True)
class Judged:
    """One number, or a column of a field where its error is largest in uncertainties, and its true value."""

    family: str
    parameters: tuple[tuple[str, Any], ...]
    place: str
    kind: str
    name: str
    error: float
    uncertainty: float
    truth: float
    """Uncertainty of the true value."""
    floor: float

    @property
    def within(self) -> bool:
        """Whether the error is within the uncertainty."""
        return self.error <= self.uncertainty + self.truth

    @property
    def bounded(self) -> bool:
        """Whether the error is within the bound of verdicts."""
        return self.error <= 2 * self.uncertainty + self.truth

    @property
    def sharp(self) -> bool:
        """Whether the true value is accurate enough to compute the overestimate."""
        return self.truth <= max(self.uncertainty / 30, self.floor)

    @property
    def ratio(self) -> float:
        """Uncertainty over error, where the error is above the floor."""
        return self.uncertainty / max(self.error, self.floor)


def solved(family: Family, parameters: Mapping[str, Any], numerics: Mapping[str, Any]) -> Result:
    """The problem at a set of parameters, without uncertainties of the trace."""
    from weakforms import api
    from weakforms.problems.problem import StateRequest

    states = [StateRequest(name, value, branch=family.branch, profile=()) for name, value in family.at]
    result = api.solve_requests(family.problem, parameters, numerics, states, branch_uncertainty=False)
    for failure in result.failures:
        raise ConvergenceError(f"{family.name} at {dict(parameters)}: {failure.what}: {failure.reason}")
    return result


def judged(family: Family, parameters: Mapping[str, Any]) -> list[Judged]:
    """Every number of the coarse solution that has an uncertainty, compared with the fine one."""
    coarse = numbers(solved(family, parameters, family.coarse))
    fine = numbers(solved(family, parameters, family.fine))
    given = tuple(parameters.items())
    out = []
    for place, number in coarse.items():
        truth = fine.get(place)
        if place.startswith("branch") or truth is None or not number.uncertainty.max() > 0:
            continue
        out.append(_judged(family.name, given, number, truth))
    return out


def _judged(family: str, given: tuple, number: Number, truth: Number) -> Judged:
    errors = np.abs(number.values - truth.values)
    spread, known = (np.broadcast_to(n.uncertainty, errors.shape) for n in (number, truth))
    worst = int(np.argmax(errors / np.maximum(spread, np.finfo(float).tiny)))
    size = float(np.max(np.abs(truth.values)))
    return Judged(
        family,
        given,
        number.place,
        _kind(number),
        number.name,
        float(errors[worst]),
        float(spread[worst]),
        float(known[worst]),
        FLOOR * max(size, 1.0),
    )


def _kind(number: Number) -> str:
    if number.name.startswith(("eigenvalue", "Lambda")):
        return "eigenvalue"
    if len(number.values) > 1:
        return "field"
    return "special point" if number.place.startswith("special") else "quantity"


@dataclass(frozen=True)
class Statistics:
    """Statistics of all numbers of one kind of a family."""

    family: str
    kind: str
    count: int
    within: float
    """Fraction within the uncertainty."""
    bounded: float
    """Fraction within the bound of verdicts."""
    median: float | None
    """Median overestimate of the columns; ``None`` if all errors are round-off."""
    largest: float | None
    """Largest overestimate of the columns; ``None`` if all errors are round-off."""


def statistics(found: Iterable[Judged]) -> list[Statistics]:
    """Statistics with one row for each family and kind.

    An error may change its sign between two sets of parameters, so that a single small error does not show
    that an uncertainty is too wide. The overestimate of a column, such as ``p`` at the limit points, is
    therefore its uncertainty over its error, both in the mean square over all sets.
    """
    groups: dict[tuple[str, str], list[Judged]] = {}
    for item in found:
        groups.setdefault((item.family, item.kind), []).append(item)
    return [_row(family, kind, items) for (family, kind), items in groups.items()]


def _row(family: str, kind: str, items: list[Judged]) -> Statistics:
    columns: dict[str, list[Judged]] = {}
    for item in items:
        if item.sharp:
            columns.setdefault(item.name, []).append(item)
    ratios = [_overestimate(column) for column in columns.values()]
    return Statistics(
        family,
        kind,
        len(items),
        float(np.mean([item.within for item in items])),
        float(np.mean([item.bounded for item in items])),
        float(np.median(ratios)) if ratios else None,
        max(ratios, default=None),
    )


def _overestimate(column: list[Judged]) -> float:
    stated = np.array([item.uncertainty for item in column])
    true = np.array([max(item.error, item.floor) for item in column])
    return float(np.sqrt(np.mean(stated**2) / np.mean(true**2)))
