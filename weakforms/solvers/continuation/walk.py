"""Follow a state from one value of a parameter to another, by steps that are halved if they fail."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from weakforms.errors import ConvergenceError

Kept = TypeVar("Kept")

SHORTEST = 1 / 256
"""Shortest step that is tried, as a part of the first one."""


def walk(solve: Callable[[Kept, float], Kept], kept: Kept, at: float, goal: float, step: float) -> Kept:
    """Follow a state to a goal, step by step.

    Args:
        solve: Solves at a value. It starts from its previous result, which it must not change.
        kept: The state at the beginning.
        at: The value there.
        goal: The value wanted.
        step: Largest step, positive.

    Raises:
        ConvergenceError: If even the shortest step does not converge; the message says how far the walk came.
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
