"""Two results side by side: which numbers agree within their uncertainties.

Two numbers agree if they differ by no more than twice their combined uncertainty, the rule of all checks
(:mod:`weakforms.verification.judging.bounds`), or by round-off. Counts must be equal. Columns of branches are
compared point by point, and only if both branches have the same number of points; otherwise their points lie
elsewhere on the curve.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from weakforms.errors import InputError
from weakforms.results import Result
from weakforms.results.model import COUNTS
from weakforms.results.uncertain import uncertain
from weakforms.verification.audit.same import ZERO, Number, numbers, scales

SCHEMA = "weakforms.diff/1"


def _finite(value: float | None) -> float | None:
    return value if value is not None and np.isfinite(value) else None


@dataclass(frozen=True)
class Pair:
    """A number of both results, or of one of them; of a column its entry with the largest difference."""

    place: str
    first: float | None
    second: float | None
    first_uncertainty: float = 0.0
    second_uncertainty: float = 0.0
    bound: float = 0.0
    """Twice the combined uncertainty, and round-off."""

    @property
    def agrees(self) -> bool:
        """Whether both are there and within the bound; a number that is not finite agrees with none."""
        if self.first is None or self.second is None:
            return False
        return abs(self.first - self.second) <= self.bound

    @property
    def cells(self) -> tuple[str, str, str, str, str]:
        """Place, both numbers, their difference and the bound as text."""
        if self.first is None or self.second is None:
            one, two = ("missing" if value is None else "there" for value in (self.first, self.second))
            return self.place, one, two, "", ""
        first = uncertain(self.first, self.first_uncertainty)
        second = uncertain(self.second, self.second_uncertainty)
        return self.place, first, second, f"{self.second - self.first:+.1e}", f"{self.bound:.1e}"

    def to_json(self) -> dict[str, Any]:
        """JSON object."""
        return {
            "place": self.place,
            "first": _finite(self.first),
            "second": _finite(self.second),
            "first_uncertainty": _finite(self.first_uncertainty),
            "second_uncertainty": _finite(self.second_uncertainty),
            "bound": _finite(self.bound),
            "agrees": self.agrees,
        }


@dataclass(frozen=True)
class Diff:
    """What two results have in common and what differs."""

    settings: dict[str, tuple[Any, Any]]
    """Parameters and numerical settings that are different."""
    pairs: list[Pair]
    """All numbers, those that differ first."""
    left_out: tuple[str, ...] = ()
    """Branches that were not compared."""

    @property
    def same(self) -> bool:
        """Whether all numbers agree."""
        return all(pair.agrees for pair in self.pairs)

    @property
    def different(self) -> list[Pair]:
        """The numbers that differ."""
        return [pair for pair in self.pairs if not pair.agrees]

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.diff/1``."""
        return {
            "schema": SCHEMA,
            "same": self.same,
            "settings": {name: list(values) for name, values in self.settings.items()},
            "numbers": [pair.to_json() for pair in self.pairs],
            "left_out": list(self.left_out),
        }


def diff(first: Result, second: Result) -> Diff:
    """Compare two results of one problem number by number.

    Raises:
        InputError: If they are of different problems, or have no number in common.
    """
    if first.problem != second.problem:
        raise InputError(f"these are results of different problems: {first.problem} and {second.problem}")
    settings = {}
    for one, two in ((first.parameters, second.parameters), (first.numerics, second.numerics)):
        for name in {**one, **two}:
            if one.get(name) != two.get(name) and name != "drawn":
                settings[name] = (one.get(name), two.get(name))
    left_out = tuple(_other_points(first, second))
    of, a, b = scales(first, second), numbers(first), numbers(second)
    skipped = tuple(f"branch {name}, " for name in left_out)
    places = [place for place in dict.fromkeys([*a, *b]) if not place.startswith(skipped or "\0")]
    pairs = [_pair(place, a.get(place), b.get(place), of) for place in places]
    if not any(pair.first is not None and pair.second is not None for pair in pairs):
        raise InputError("these results have no number in common")
    return Diff(settings, sorted(pairs, key=lambda pair: pair.agrees), left_out)


def _other_points(first: Result, second: Result) -> Iterator[str]:
    """Branches of both results with different numbers of points."""
    lengths = {branch.name: len(branch) for branch in second.branches}
    for branch in first.branches:
        if lengths.get(branch.name, len(branch)) != len(branch):
            yield branch.name


def _pair(place: str, a: Number | None, b: Number | None, of: dict[str, float]) -> Pair:
    if a is None or b is None or a.values.shape != b.values.shape:
        there = [None if number is None else float(len(number.values)) for number in (a, b)]
        return Pair(place, *there) if None in there else Pair(f"{place}, length", *there)
    values = [np.asarray(number.values, float) for number in (a, b)]
    spread = [np.broadcast_to(np.asarray(n.uncertainty, float), values[0].shape) for n in (a, b)]
    bound = 2 * np.hypot(*spread) + (0.0 if a.name.startswith(COUNTS) else ZERO * of[a.name])
    apart = np.abs(values[0] - values[1])
    apart[np.isnan(values[0]) & np.isnan(values[1])] = 0.0
    i = int(np.argmax(np.nan_to_num(apart - bound, nan=np.inf)))
    both_missing = np.isnan(values[0][i]) and np.isnan(values[1][i])
    one, two = (0.0, 0.0) if both_missing else (float(v[i]) for v in values)
    return Pair(place, one, two, float(spread[0][i]), float(spread[1][i]), float(bound[i]))
