"""Points that are added to a trace where several eigenvalues change sign within one of its steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from weakforms.solvers.equilibrium.state import State

if TYPE_CHECKING:
    from weakforms.solvers.continuation.curve import SolutionCurve

BETWEEN = (0.25, 0.5, 0.75)
"""Fractions of the interval between two points of a trace at which eigenvalues are counted again."""

HALVINGS = 6
"""How often an interval in which several eigenvalues change sign is cut. Eigenvalues that are equal by a
symmetry change sign together in any interval."""


def tell_apart(
    curve: SolutionCurve, count: Callable[[State], int], counts: Sequence[int], unseen: bool = False
) -> bool:
    """Add points to a trace, so that at most one eigenvalue changes sign from each to the next.

    Args:
        curve: The curve; its points are changed.
        count: Number of negative eigenvalues of a state.
        counts: The number at each point.
        unseen: Whether eigenvalues are also counted between neighbours with the same number. If two of them
            cross zero in opposite directions within a step, or one crosses it and returns, the number at both
            ends is the same.

    Returns:
        Whether points were added.
    """
    ends = list(pairwise(counts))
    added = [_cut(curve, count, i, *ends[i], unseen, HALVINGS) for i in reversed(range(len(ends)))]
    return any(added)


def _cut(
    curve: SolutionCurve,
    count: Callable[[State], int],
    i: int,
    before: int,
    after: int,
    unseen: bool,
    halvings: int,
) -> bool:
    """Cut the interval after a point until one eigenvalue changes sign in each part; whether it was cut.

    An interpolated state is near the branch, not on it. If its number differs, the state is solved for and
    counted again.
    """
    if not halvings or abs(after - before) == 1 or (before == after and not unseen):
        return False
    for fraction in BETWEEN if before == after else (0.5,):
        if before == after and count(curve.between(i, fraction)) == before:
            continue
        point = curve.point_between(i, fraction)
        found = count(point.state)
        if before == after == found:
            continue
        curve.insert(i, point)
        _cut(curve, count, i + 1, found, after, unseen, halvings - 1)
        _cut(curve, count, i, before, found, unseen, halvings - 1)
        return True
    return False
