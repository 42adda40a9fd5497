"""From a state at one value of a parameter to that at another, by steps that shorten where they fail."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from weakforms.errors import ConvergenceError

Kept = TypeVar("Kept")

SHORTEST = 1 / 256
"""Of the first step; a shorter one is not tried."""


def walk(solve: Callable[[Kept, float], Kept], kept: Kept, at: float, goal: float, step: float) -> Kept:
    """What ``solve`` leaves at a goal, from what there is at another value.

    Args:
        solve: Solves at a value, from what it left before, which it must not change.
        kept: What there is at the beginning.
        at: The value there.
        goal: The value wanted.
        step: Largest step, positive.

    Raises:
        ConvergenceError: When even the shortest step does not converge; says how far it went.
    """
    length = step
    while at != goal:
        to = goal if abs(goal - at) <= length * (1 + 1e-9) else at + length * (1 if goal > at else -1)
        try:
            kept = solve(kept, to)
        except ConvergenceError as error:
            length = min(length, abs(goal - at)) / 2
            if length < SHORTEST * step:
                raise ConvergenceError(f"followed to {at:.6g}, not {goal:.6g}: {error}") from error
        else:
            at = to
    return kept
