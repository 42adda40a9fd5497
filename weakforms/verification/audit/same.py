"""All the numbers of two solutions held against each other: other ranks, another release, another day.

Verdicts hide what changed within a bound. Here every number counts: columns of branches, special points,
quantities, states and fields with their uncertainties, and what did not converge. A number's scale is the
largest magnitude that its name (``p``, ``rho``, ``eigenvalue_1``) has anywhere in the two solutions; where
all of them are zero, to round-off or to within their own uncertainty (the split of a double eigenvalue), the
scale is 1; and never less than 1e-5, for no number of these problems, all of order one, is free of round-off.

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

EFFORT = ("residual", "iterations")
"""Columns that say how a state was found, not what it is: round-off decides about them."""

ZERO = 1e-11
"""Magnitude, of numbers of order one, that is round-off."""

LEAST = 1e-5
"""Smallest scale: what is smaller is told apart to 1e-14 and no further."""

FRICTION = ("line_force", "line_force_membrane", "traction_front", "traction_max", "f_t")
"""Their scale is 1 at least, that of a patch that sticks and is let go: without friction, and of line forces
in inflation, there are none, and what shows is derivatives of round-off."""

EIGENVALUES, USUAL = "Lambda", 1e-2
"""Their names and least scale: at a change of stability they are zero to what a bracket leaves, and their
round-off is that of matrices whose other eigenvalues are of order one and more."""

DIGITS = 1e-3
"""Relative difference of two uncertainties that is none: they are estimates."""

NOISE = 1e-7
"""Uncertainty, relative to a number's scale, below which round-off has a part in it: a difference of two
meshes' numbers that agree to seven digits. Below, uncertainties are not compared."""

COUNTS = ("n_negative",)
"""Names that start so are counts of eigenvalues: they are the same or they are not."""


@dataclass(frozen=True)
class Number:
    """One stored column, or one stored number, and what is known of its accuracy."""

    place: str
    name: str
    values: np.ndarray
    uncertainty: np.ndarray


@dataclass(frozen=True)
class Difference:
    """How far a number of one solution is from the other's, at the worst entry of its column."""

    place: str
    first: float
    second: float
    relative: float
    """To the number's scale; infinite where one of the two is not there."""

    def __str__(self) -> str:
        return f"{self.place}: {self.first:.15g} and {self.second:.15g}, {self.relative:.1e} of its scale"


def numbers(result: Result) -> dict[str, Number]:
    """Every number of a solution, by its place in it."""
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
    """Scale of every name that stands anywhere in some solutions."""
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
    if name in FRICTION:
        return 1.0
    return USUAL if name.startswith(EIGENVALUES) else LEAST


def differences(first: Result, second: Result) -> list[Difference]:
    """Every column or number of two solutions of one problem, the worst first."""
    of, a, b = scales(first, second), numbers(first), numbers(second)
    found = [_difference(a.get(place), b.get(place), of) for place in dict.fromkeys([*a, *b])]
    failed = [[f"failure: {item.what}" for item in result.failures] for result in (first, second)]
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
    """Their uncertainties, which have the unit of the number and so its scale, where they are no noise."""
    place = f"{a.place}, uncertainty"
    if a.uncertainty.shape != b.uncertainty.shape:
        return Difference(place, np.nan, np.nan, np.inf)
    apart = _apart(a.uncertainty, b.uncertainty)
    largest = np.maximum(a.uncertainty, b.uncertainty)
    apart[(largest < NOISE * scale) | (apart < DIGITS * largest)] = 0.0
    i = int(np.argmax(apart))
    return Difference(place, float(a.uncertainty[i]), float(b.uncertainty[i]), float(apart[i] / scale))


def _apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Magnitude of the difference; a number that is missing on one side only is infinitely far."""
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
    """What was asked for."""
    found: tuple[Difference, ...]
    """Every column and number, the worst first."""

    @property
    def worst(self) -> Difference:
        """What differs most."""
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
        """A solution by what was asked for; ``None`` where it was not solved."""
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


HEAD = "| case | numbers | verdicts that differ | largest difference | where |"


@dataclass(frozen=True)
class CaseRow:
    """One case in two runs."""

    case: str
    numbers: int
    """Compared: every stored one."""
    changed: tuple[str, ...]
    """Checks whose verdicts differ."""
    largest: float | None
    """Difference relative to a number's scale; ``None`` where one of the two has no such number."""
    where: str


def rows(first: Run, second: Run) -> list[CaseRow]:
    """For every case of the first run its verdicts and the worst of all its numbers."""
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
    """The same as a Markdown table."""
    lines = [HEAD, "|---|---|---|---|---|"]
    for row in rows(first, second):
        changed, where = ", ".join(row.changed) or "none", f"`{row.where}`" if row.where else ""
        largest = "missing in one" if row.largest is None else f"{row.largest:.1e}"
        lines.append(f"| {row.case} | {row.numbers} | {changed} | {largest} | {where} |")
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    """Print the table of two output folders; with ``--worst`` the solutions one by one, in full."""
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
