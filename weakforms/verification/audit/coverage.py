r"""Test of uncertainties against true errors of coarse solutions, over many sets of parameters.

A problem is solved on coarse meshes at parameters drawn from a Sobol sequence, and again on meshes four times
as fine with polynomials two degrees higher: the difference is the true error of the coarse solution, which
states the uncertainty :math:`u`. The uncertainty :math:`u_t` of the fine solution is smaller by orders. The
claims for every number are:

* its true error is within :math:`u + u_t` for 95 % of all numbers, and within the bound that verdicts use,
  :math:`2u + u_t`, for all of them;
* for each column, over the sets, :math:`u` is at most 30 times the error (:func:`statistics`), where an error
below a floor counts as the floor: ten times
  :data:`~weakforms.solvers.uncertainty.refinement.ALGEBRAIC` of the number or of 1,
  the part of each uncertainty that covers round-off, which differences between meshes do not show.

``python3 -m weakforms.verification.audit.coverage [--wide]`` prints the statistics.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.results import Result
from weakforms.verification.audit.coverage_families import FAMILIES, QUICK, WIDE, Family
from weakforms.verification.audit.same import Number, numbers

FLOOR = 1e-10
"""Errors below this, relative to the number or to 1, cannot be distinguished from round-off."""


@dataclass(frozen=True)
class Judged:
    """One number, or a column of a field at its worst point, compared with the true value."""

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

    states = [StateRequest(name, value, profile=()) for name, value in family.at]
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
    error = float(np.max(np.abs(number.values - truth.values)))
    size = float(np.max(np.abs(truth.values)))
    return Judged(
        family,
        given,
        number.place,
        _kind(number),
        number.name,
        error,
        float(number.uncertainty.max()),
        float(truth.uncertainty.max()),
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
    median: float
    """Median overestimate of the columns."""
    largest: float
    """Largest overestimate of the columns."""


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
    ratios = [_overestimate(column) for column in columns.values()] or [np.nan]  # all of them round-off
    return Statistics(
        family,
        kind,
        len(items),
        float(np.mean([item.within for item in items])),
        float(np.mean([item.bounded for item in items])),
        float(np.median(ratios)),
        float(np.max(ratios)),
    )


def _overestimate(column: list[Judged]) -> float:
    stated = np.array([item.uncertainty for item in column])
    true = np.array([max(item.error, item.floor) for item in column])
    return float(np.sqrt(np.mean(stated**2) / np.mean(true**2)))


def table(rows: Iterable[Statistics]) -> str:
    """Markdown table of statistics."""
    lines = [
        "| problem | kind of number | numbers | within u | within 2u | overestimate, median | largest |",
        "|---|---|---|---|---|---|---|",
    ]
    lines += [
        f"| {r.family} | {r.kind} | {r.count} | {r.within:.1%} | {r.bounded:.1%} | {r.median:.1f} "
        f"| {r.largest:.1f} |"
        for r in rows
    ]
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    """Print the table for the quick sets, or with ``--wide`` for all sets."""
    found = []
    for family in FAMILIES:
        for given in family.sets(WIDE if "--wide" in arguments else QUICK.get(family.name, 1)):
            print(f"{family.name}: {given}", file=sys.stderr)
            found += judged(family, given)
    print(table(statistics(found)), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
