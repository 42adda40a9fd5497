"""Points of a trace drawn at random, at which its columns are held against states solved for."""

from __future__ import annotations

import zlib
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from weakforms.results.model import Branch, SpecialPoint

DESCRIBE = ("residual", "iterations")
"""Columns that describe how a point was solved for, not what it is."""


@dataclass(frozen=True)
class Drawn:
    """A point of a trace and the column that tells it from all others."""

    index: int
    column: str
    value: float


def seed_of(text: str) -> int:
    """A seed that is the same in every run of the same solution, and another one in any other."""
    return zlib.crc32(text.encode())


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

    A column will do that has all values of the points before on one side of its value, and all values of
    those after on the other: the state at it is the point, whatever the column does elsewhere.

    Args:
        branch: The trace.
        columns: Columns that can be prescribed, the best first.
        seed: Of the random order.
        without: Points that are not drawn.
    """
    inner = np.arange(1, len(branch) - 1)
    left = np.random.default_rng(seed).permutation([i for i in inner if i not in without]).tolist()
    silent = {name for name in branch.columns if name not in DESCRIBE}
    while left:
        # One at which most columns have something to say that have not had: of contact, of a front.
        i = max(left, key=lambda at: sum(_speaks(branch.columns[name][at]) for name in silent))
        left.remove(i)
        for name in columns:
            values = branch.columns.get(name)
            if values is not None and _separates(values, i):
                silent = {name for name in silent if not _speaks(branch.columns[name][i])}
                yield Drawn(i, name, float(values[i]))
                break


def _speaks(value: float) -> bool:
    return bool(np.isfinite(value) and value != 0)


def _separates(values: np.ndarray, i: int) -> bool:
    before, here, after = values[:i], values[i], values[i + 1 :]
    rises = np.all(before < here) and np.all(after > here)
    return bool(rises or (np.all(before > here) and np.all(after < here)))
