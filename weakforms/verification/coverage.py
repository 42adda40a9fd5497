r"""Are the stated uncertainties right? True errors of coarse solutions over many sets of parameters.

A problem is solved on coarse meshes at parameters drawn from a Sobol sequence, and again on meshes four times
as fine with polynomials two degrees higher: against the coarse uncertainty :math:`u` the fine solution is the
truth, its own :math:`u_t` being known and smaller by orders. What is claimed of every number:

* its true error is within :math:`u + u_t` for 95 % of all numbers, and within the bound that verdicts use,
  :math:`2u + u_t`, for all of them;
* for each column, over the sets, :math:`u` is at most 30 times the error (:func:`statistics`), where an error
  below the floor counts as the floor: ten times :data:`~weakforms.solvers.refinement.ALGEBRAIC` of the number
  or of 1, the part of each uncertainty that is there for round-off, which no mesh can show.

``python3 -m weakforms.verification.coverage [--wide]`` prints the statistics.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.stats import qmc

from weakforms.errors import ConvergenceError
from weakforms.results import Result
from weakforms.verification.same import Number, numbers

SEED = 2016
FLOOR = 1e-10
"""Relative error, of the number or of 1, below which nothing can be told from round-off."""


@dataclass(frozen=True)
class Family:
    """Sets of parameters of a problem, and the meshes whose uncertainties are tested.

    The states asked for may depend on the parameters: a value may be the name of one of ``ranges``.
    """

    problem: str
    ranges: Mapping[str, tuple[float, float]]
    coarse: Mapping[str, Any]
    fine: Mapping[str, Any]
    fixed: Mapping[str, Any] = field(default_factory=dict)
    at: tuple[tuple[str, float], ...] = ()
    label: str = ""

    def sets(self, count: int) -> list[dict[str, Any]]:
        """The first of a scrambled Sobol sequence over the ranges: the same in every run."""
        sobol = qmc.Sobol(len(self.ranges), seed=SEED)
        draws = sobol.random_base2(int(np.ceil(np.log2(count))))[:count]
        low, high = (np.array(ends) for ends in zip(*self.ranges.values(), strict=True))
        rows = low + draws * (high - low)
        return [dict(self.fixed) | dict(zip(self.ranges, row.tolist(), strict=True)) for row in rows]

    @property
    def name(self) -> str:
        """What it is called in the table."""
        return self.label or self.problem


@dataclass(frozen=True)
class Judged:
    """One number, or a column of a field at its worst place, against the truth."""

    family: str
    parameters: tuple[tuple[str, Any], ...]
    place: str
    kind: str
    name: str
    error: float
    uncertainty: float
    truth: float
    """Uncertainty of what counts as the truth."""
    floor: float

    @property
    def within(self) -> bool:
        """Inside the uncertainty."""
        return self.error <= self.uncertainty + self.truth

    @property
    def bounded(self) -> bool:
        """Inside the bound of verdicts."""
        return self.error <= 2 * self.uncertainty + self.truth

    @property
    def sharp(self) -> bool:
        """Whether the truth is known well enough to tell how much too wide the uncertainty is."""
        return self.truth <= max(self.uncertainty / 30, self.floor)

    @property
    def ratio(self) -> float:
        """Uncertainty over error, above the floor."""
        return self.uncertainty / max(self.error, self.floor)


def solved(family: Family, parameters: Mapping[str, Any], numerics: Mapping[str, Any]) -> Result:
    """The problem at a set of parameters, without uncertainties of the trace."""
    from weakforms import api
    from weakforms.problems.base import StateRequest

    states = [StateRequest(name, value, profile=()) for name, value in family.at]
    result = api.solve_requests(family.problem, parameters, numerics, states, branch_uncertainty=False)
    for failure in result.failures:
        raise ConvergenceError(f"{family.name} at {dict(parameters)}: {failure.what}: {failure.reason}")
    return result


def judged(family: Family, parameters: Mapping[str, Any]) -> list[Judged]:
    """Every number with an uncertainty that the coarse solution states, against the fine one."""
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


# -- what is tested ------------------------------------------------------------------------------

LINE = {"coarse": {"cells": 16, "degree": 3}, "fine": {"cells": 48, "degree": 5, "levels": 2}}
MORE = {"coarse": {"cells": 32, "degree": 3}, "fine": {"cells": 64, "degree": 5, "levels": 2}}
BLOCKS = {"coarse": {"cells": 8, "degree": 3}, "fine": {"cells": 12, "degree": 6, "levels": 2}}
FAMILIES = (
    Family(
        "tube",
        {"alpha": (0.02, 0.3), "delta1": (1.0, 1.6), "lf": (4.0, 8.0)},
        **LINE,
        fixed={"u_end": 1.6},
        at=(("u_max", 0.6), ("u_max", 1.5)),
    ),
    Family(
        "circular",
        {"alpha": (0.02, 0.3), "beta": (1.0, 2.0)},
        **LINE,
        fixed={"t_end": 1.3},
        at=(("t0", 0.6), ("t0", 1.2)),
    ),
    Family(
        "tube",
        {"alpha": (0.05, 0.3), "k": (5.0, 40.0)},
        **LINE,
        fixed={"contact": "frictionless", "delta1": 1.2, "p_end": 1.95},
        at=(("p", 1.9),),
        label="tube, contact",
    ),
    Family(
        "circular",
        {"k": (10.0, 60.0), "l": (0.35, 0.55)},
        **MORE,
        fixed={"contact": "frictionless"},
        at=(("p", 3.3),),
        label="circular, contact",
    ),
    Family(
        "tube",
        {"alpha": (0.05, 0.15), "k": (5.0, 40.0)},
        **LINE,
        fixed={"contact": "adhesive", "delta1": 1.2, "p_end": 2.45},
        at=(("p", 2.4),),
        label="tube, adhesive",
    ),
    Family(
        "tube",
        {"alpha": (0.05, 0.15), "k": (5.0, 40.0)},
        **LINE,
        fixed={"contact": "adhesive", "phase": "deflation", "delta1": 1.2, "p_end": 2.4},
        at=(("p", 2.2),),
        label="tube, deflation",
    ),
    Family(
        "circular",
        {"alpha": (0.06, 0.15), "beta": (1.0, 1.2)},
        **MORE,
        fixed={"contact": "adhesive", "p_end": 4.05},
        at=(("p", 4.0),),
        label="circular, adhesive",
    ),
    Family(
        "circular",
        {"alpha": (0.06, 0.15), "beta": (1.0, 1.2)},
        **MORE,
        fixed={"contact": "adhesive", "phase": "peeling", "p_end": 4.0, "p": 2.4},
        label="circular, peeling",
    ),
    Family(
        "fluid_tube",
        {"delta": (1.6, 2.4), "gamma": (0.05, 0.11)},
        **MORE,
        fixed={"n_max": 1},
        at=(("zw", 6.0),),
    ),
    Family(
        "wrinkled_tube",
        {"M": (0.8, 0.95), "delta": (1.9, 2.2)},
        **BLOCKS,
        fixed={"load": "gas", "load_end": 0.15, "Af": 1.0},
        at=(("p", 0.1),),
        label="wrinkled_tube, gas",
    ),
    Family(
        "wrinkled_tube",
        {"M": (1.3, 1.6), "delta": (1.9, 2.2)},
        **BLOCKS,
        fixed={"load_end": 7.0, "Af": 0.6},
        at=(("zw", 6.0),),
        label="wrinkled_tube, fluid",
    ),
    Family(
        "wrinkled_tube",
        {"M": (1.3, 1.6), "delta": (1.9, 2.2)},
        **BLOCKS,
        fixed={"load_end": 7.0},
        at=(("zw", 6.0),),
        label="wrinkled_tube, critical",
    ),
    Family(
        "hemisphere",
        {"c2": (0.0, 0.2), "gamma": (1.5, 4.0)},
        **BLOCKS,
        at=(("zw", -0.9),),
    ),
)
"""Parameters over which uncertainties are tested, chosen so that each has the states asked for."""


QUICK = {"tube": 4, "circular": 2, "circular, contact": 2, "wrinkled_tube, gas": 1, "wrinkled_tube, fluid": 1}
"""How many sets of which family are tested in a minute or two ..."""

WIDE = 16
"""... and of every family, where there is time."""


@dataclass(frozen=True)
class Statistics:
    """Of all numbers of one kind of a family."""

    family: str
    kind: str
    count: int
    within: float
    """Share inside the uncertainty."""
    bounded: float
    """Share inside the bound of verdicts."""
    median: float
    """Of the overestimates of the columns ..."""
    largest: float
    """... and the largest of them."""


def statistics(found: Iterable[Judged]) -> list[Statistics]:
    """One row a family and kind.

    An error has a sign, and somewhere between two sets of parameters it is zero: one number alone says little
    about how wide its uncertainty is. The overestimate of a column, such as ``p`` at the limit points, is its
    uncertainty over its error, both in the mean square of all sets.
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
    """Print the table of the quick sets, with ``--wide`` that of all."""
    found = []
    for family in FAMILIES:
        for given in family.sets(WIDE if "--wide" in arguments else QUICK.get(family.name, 1)):
            print(f"{family.name}: {given}", file=sys.stderr)
            found += judged(family, given)
    print(table(statistics(found)), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
