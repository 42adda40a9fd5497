"""Random points of a trace, at which its columns are compared with states solved for separately."""

from __future__ import annotations

import zlib
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from weakforms.results.model import Branch, SpecialPoint

DESCRIBE = ("residual", "iterations")
"""Columns that describe how a point was solved for, not the state itself."""


@dataclass(frozen=True)
class Drawn:
    """A point of a trace and a column whose value identifies it."""

    index: int
    column: str
    value: float


def seed_of(text: str) -> int:
    """A seed that depends on the solution only: the same in every run of it."""
    return zlib.crc32(text.encode())


ROUND_OFF = 1e-11
"""A column whose value is smaller counts as zero. Round-off, which depends on the processor and on the number
of ranks, must not choose the points."""

AT = 1e-6
"""Relative to the range of each column, how near a point of a trace is to a special point that is meant."""


def nearest(branch: Branch, point: SpecialPoint) -> tuple[int, float]:
    """Index of the point of a branch nearest to a special point, and their distance in the worst column.

    The distance is relative to the range of each column; infinite where they share no column.
    """
    apart = [
        np.abs(values - point.values[name]) / (np.ptp(values) or 1.0)
        for name, values in branch.columns.items()
        if name in point.values and name not in DESCRIBE and np.isfinite(values).all()
    ]
    if not apart:
        return 0, float("inf")
    worst = np.max(apart, axis=0)
    i = int(np.argmin(worst))
    return i, float(worst[i])


def critical(branch: Branch, points: Sequence[SpecialPoint]) -> set[int]:
    """Points of a branch at special points, where the number of negative eigenvalues jumps."""
    found = [nearest(branch, point) for point in points if point.branch == branch.name]
    return {i for i, distance in found if distance <= AT}


def draw(branch: Branch, columns: Sequence[str], seed: int, without: Container[int] = ()) -> Iterator[Drawn]:
    """Inner points of a branch in random order, each with the first column that can be prescribed there.

    A column can be prescribed at a point if all its values before the point are on one side of its value
    there, and all values after it on the other side. The state with that value is then this point.

    Args:
        branch: The trace.
        columns: Columns that can be prescribed, the best first.
        seed: Seed of the random order.
        without: Points that are not drawn.
    """
    inner = np.arange(1, len(branch) - 1)
    left = np.random.default_rng(seed).permutation([i for i in inner if i not in without]).tolist()
    silent = {name for name in branch.columns if name not in DESCRIBE}
    while left:
        # Prefer a point at which many columns have a value for the first time, for example columns of contact
        # or of a front.
        i = max(left, key=lambda at: sum(_has_value(branch.columns[name][at]) for name in silent))
        left.remove(i)
        for name in columns:
            values = branch.columns.get(name)
            if values is not None and _separates(values, i):
                silent = {name for name in silent if not _has_value(branch.columns[name][i])}
                yield Drawn(i, name, float(values[i]))
                break


def _has_value(value: float) -> bool:
    return bool(np.isfinite(value) and abs(value) > ROUND_OFF)


def _separates(values: np.ndarray, i: int) -> bool:
    before, here, after = values[:i], values[i], values[i + 1 :]
    rises = np.all(before < here) and np.all(after > here)
    return bool(rises or (np.all(before > here) and np.all(after < here)))
