"""Comparison of all numbers of two solutions, such as on other ranks or another release.

Verdicts do not show changes within a bound. This module compares every number: columns of branches, special
points, quantities, states and fields with their uncertainties, and failures. The scale of a number is the
largest magnitude of all numbers with its name (``p``, ``rho``, ``eigenvalue_1``) in the two solutions. If all
of these are zero, up to round-off or within their uncertainty (the split of a double eigenvalue), the scale
is 1. It is at least 1e-5, because all these problems are of order one and have round-off.

``python3 -m weakforms.verification.audit.same OUT OUT`` compares two output folders of ``weakforms verify``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from weakforms.errors import InputError
from weakforms.results import Quantity, Result, load_result
from weakforms.results.io import MAX_REPORT_BYTES, load_json
from weakforms.results.model import COUNTS

EFFORT = ("residual", "iterations")
"""Columns that describe how a state was found, which depend on round-off."""

ZERO = 1e-11
"""Magnitude of round-off in numbers of order one."""

SMALLEST_SCALE = 1e-5
"""Smallest scale; smaller numbers are compared to 1e-14."""

SCALED_BY_ONE = ("line_force", "line_force_membrane", "traction_front", "traction_max", "f_t")
"""Columns whose scale is at least 1. Without friction, and for line forces in inflation, they are zero, and
their computed values are derivatives of round-off."""

EIGENVALUES, USUAL = "Lambda", 1e-2
"""Names of columns and their smallest scale. At a change of stability they are zero up to the width of an
interval, with the round-off of matrices whose other eigenvalues are of order one or more."""

DIGITS = 1e-3
"""Relative difference of two uncertainties that is accepted, because they are estimates."""

NOISE = 1e-7
"""Uncertainties below this, relative to the number's scale, are not compared, because they are differences of
numbers that agree to seven digits and contain round-off."""


@dataclass(frozen=True)
class Number:
    """One stored column or number, with its uncertainty."""

    place: str
    name: str
    values: np.ndarray
    uncertainty: np.ndarray


@dataclass(frozen=True)
class Difference:
    """Difference of a number of two solutions, at the worst entry of its column."""

    place: str
    first: float
    second: float
    relative: float
    """Difference relative to the number's scale; infinite if one of the two is missing."""

    def __str__(self) -> str:
        return f"{self.place}: {self.first:.15g} and {self.second:.15g}, {self.relative:.1e} of its scale"


def numbers(result: Result) -> dict[str, Number]:
    """Every number of a solution, by its position in it."""
    return {number.place: number for number in _numbers(result)}


def _numbers(result: Result) -> Iterator[Number]:
    for branch in result.branches:
        for name, values in branch.columns.items():
            if name not in EFFORT:
                spread = branch.uncertainty.get(name, np.zeros(1))
                yield Number(f"branch {branch.name}, {name}", name, values, spread)
    for i, point in enumerate(result.special_points, start=1):
        for name, value in point.values.items():
            place = f"special point {i} ({point.kind}, {point.branch}), {name}"
            yield _single(place, name, value, point.uncertainty.get(name))
    yield from _quantities("quantity ", result.quantities)
    for state in result.states:
        at = ", ".join(f"{name} = {value:g}" for name, value in state.at.items())
        place = f"state {at} (crossing {state.crossing}, {state.branch}), "
        yield from _quantities(place, state.quantities)
        for field in state.fields:
            for name, values in field.columns.items():
                spread = np.atleast_1d(field.uncertainty.get(name, 0.0))
                yield Number(f"{place}{field.name} {name}", name, values, spread)


def _quantities(place: str, quantities: dict[str, Quantity]) -> Iterator[Number]:
    for name, quantity in quantities.items():
        if name not in EFFORT:
            yield _single(place + name, name, quantity.value, quantity.uncertainty)


def _single(place: str, name: str, value: float, uncertainty: float | None) -> Number:
    return Number(place, name, np.atleast_1d(float(value)), np.atleast_1d(uncertainty or 0.0))


def scales(*results: Result) -> dict[str, float]:
    """Scale of every name in some solutions."""
    largest: dict[str, float] = {}
    known: dict[str, bool] = {}
    for number in (number for result in results for number in _numbers(result)):
        magnitudes = np.abs(number.values[np.isfinite(number.values)])
        top = float(magnitudes.max(initial=0.0))
        largest[number.name] = max(top, largest.get(number.name, 0.0))
        beyond = top > max(ZERO, float(np.nanmax(number.uncertainty, initial=0.0)))
        known[number.name] = beyond or known.get(number.name, False)
    return {name: max(top, _least(name)) if known[name] else 1.0 for name, top in largest.items()}


def _least(name: str) -> float:
    """Smallest scale of a number by its name."""
    if name in SCALED_BY_ONE:
        return 1.0
    return USUAL if name.startswith(EIGENVALUES) else SMALLEST_SCALE


def differences(first: Result, second: Result) -> list[Difference]:
    """Differences of every column or number of two solutions of one problem, the worst first."""
    of, a, b = scales(first, second), numbers(first), numbers(second)
    found = [_difference(a.get(place), b.get(place), of) for place in dict.fromkeys([*a, *b])]
    failed = [[f"failure: {item.what}" for item in result.failures] for result in (first, second)]
    for names, result in zip(failed, (first, second), strict=True):
        names += [f"not there: {item.what}" for item in result.absent]
    for what in sorted(set(failed[0]) ^ set(failed[1])):
        found.append(Difference(what, float(what in failed[0]), float(what in failed[1]), np.inf))
    return sorted(found, key=lambda difference: -difference.relative)


def _difference(a: Number | None, b: Number | None, of: dict[str, float]) -> Difference:
    if a is None or b is None:
        there = (a or b).place
        return Difference(there, np.nan if a is None else 1.0, np.nan if b is None else 1.0, np.inf)
    if a.values.shape != b.values.shape:
        return Difference(f"{a.place}, length", len(a.values), len(b.values), np.inf)
    apart = _apart(a.values, b.values)
    worst = int(np.argmax(apart)) if len(apart) else 0
    if not len(apart):
        return Difference(a.place, np.nan, np.nan, 0.0)
    scale = of[a.name]
    different = np.inf if a.name.startswith(COUNTS) and apart[worst] else apart[worst] / scale
    values = Difference(a.place, float(a.values[worst]), float(b.values[worst]), float(different))
    return max(values, _spread(a, b, scale), key=lambda difference: difference.relative)


def _spread(a: Number, b: Number, scale: float) -> Difference:
    """Difference of their uncertainties, with the scale of the number, unless they are round-off."""
    place = f"{a.place}, uncertainty"
    if a.uncertainty.shape != b.uncertainty.shape:
        return Difference(place, np.nan, np.nan, np.inf)
    apart = _apart(a.uncertainty, b.uncertainty)
    largest = np.maximum(a.uncertainty, b.uncertainty)
    apart[(largest < NOISE * scale) | (apart < DIGITS * largest)] = 0.0
    i = int(np.argmax(apart))
    return Difference(place, float(a.uncertainty[i]), float(b.uncertainty[i]), float(apart[i] / scale))


def _apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Magnitude of the difference; infinite if a number is missing on one side."""
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    out = np.abs(a - b)
    out[np.isnan(a) & np.isnan(b)] = 0.0
    out[np.isnan(a) != np.isnan(b)] = np.inf
    return out


# -- whole runs ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Compared:
    """One solution in two runs."""

    spec: str
    """The spec of the solution."""
    found: tuple[Difference, ...]
    """Differences of every column and number, the worst first."""

    @property
    def worst(self) -> Difference:
        """The largest difference."""
        return self.found[0] if self.found else Difference("nothing stored", 0.0, 0.0, 0.0)


class Run:
    """An output folder of ``weakforms verify``.

    Raises:
        InputError: If it has no report.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder)
        report = load_json(self.folder / "report" / "report.json", "report", MAX_REPORT_BYTES)
        cases = report["cases"]
        self.environment: dict[str, str] = report.get("environment", {})
        self.specs = {case["id"]: [item["spec"] for item in case["solutions"]] for case in cases}
        self.files = {item["spec"]: self.folder / item["file"] for c in cases for item in c["solutions"]}
        self.verdicts = {case["id"]: {v["check"]: v["passed"] for v in case["verdicts"]} for case in cases}

    def result(self, spec: str) -> Result | None:
        """The solution of a spec; ``None`` if it was not solved."""
        path = self.files.get(spec)
        return load_result(path) if path is not None and path.exists() else None


def runs(first: Run, second: Run) -> list[Compared]:
    """Every solution of two runs of the same cases, the worst first.

    Raises:
        InputError: If a stored solution is damaged.
    """
    specs = {**first.files, **second.files}
    found = [_compared(spec, first.result(spec), second.result(spec)) for spec in specs]
    return sorted(found, key=lambda item: -item.worst.relative)


def _compared(spec: str, first: Result | None, second: Result | None) -> Compared:
    if first is None or second is None:
        there = (float(first is not None), float(second is not None))
        whole = Difference("the whole solution", *there, np.inf if there[0] != there[1] else 0.0)
        return Compared(spec, (whole,))
    return Compared(spec, tuple(differences(first, second)))


TABLE_HEAD = "| case | numbers | verdicts that differ | largest difference | where |"


@dataclass(frozen=True)
class CaseRow:
    """One case in two runs."""

    case: str
    numbers: int
    """Number of stored numbers that were compared."""
    changed: tuple[str, ...]
    """Checks whose verdicts differ."""
    largest: float | None
    """Largest difference relative to a number's scale; ``None`` if a number is missing in one run."""
    where: str


def rows(first: Run, second: Run) -> list[CaseRow]:
    """For every case of the first run, the changed verdicts and the largest difference."""
    found = {item.spec: item for item in runs(first, second)}
    out = []
    for case, specs in first.specs.items():
        here = [found[spec] for spec in specs]
        worst = max(here, key=lambda item: item.worst.relative)
        own, others = first.verdicts[case], second.verdicts.get(case, {})
        changed = tuple(sorted(name for name in {**own, **others} if own.get(name) != others.get(name)))
        where = f"{worst.spec}: {worst.worst.place}" if worst.worst.relative else ""
        count = sum(len(item.found) for item in here)
        largest = worst.worst.relative
        out.append(CaseRow(case, count, changed, largest if np.isfinite(largest) else None, where))
    return out


def table(first: Run, second: Run) -> str:
    """The comparison as a Markdown table."""
    lines = [TABLE_HEAD, "|---|---|---|---|---|"]
    for row in rows(first, second):
        changed, where = ", ".join(row.changed) or "none", f"`{row.where}`" if row.where else ""
        largest = "missing in one" if row.largest is None else f"{row.largest:.1e}"
        lines.append(f"| {row.case} | {row.numbers} | {changed} | {largest} | {where} |")
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    """Print the table for two output folders; with ``--worst`` print every solution in full."""
    folders = [Path(argument) for argument in arguments if argument != "--worst"]
    try:
        if len(folders) != 2:
            raise InputError("usage: python3 -m weakforms.verification.audit.same [--worst] OUT OUT")
        both = Run(folders[0]), Run(folders[1])
        listed = [f"{item.spec}: {item.worst}" for item in runs(*both)]
        print("\n".join(listed) if "--worst" in arguments else table(*both).rstrip())
    except InputError as error:
        print(f"weakforms: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
