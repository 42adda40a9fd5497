"""What lies beyond the end of a branch: states that are asked for there, and limit points."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from itertools import count
from typing import TYPE_CHECKING, Any

from weakforms.errors import ConvergenceError, InputError
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import CurvePoint

if TYPE_CHECKING:
    from weakforms.problems.problem import End, Parameters, Problem, Requests
    from weakforms.results import Result

FACTORS = (2.0, 1.5, 1.25, 1.1)
"""A branch that does not have a state is followed this much further at a time: by the first factor that the
law allows."""

MOST = 400
"""Largest number of points after the end of a branch at which limit points are looked for."""


class BeyondEndError(InputError):
    """A branch does not have a state up to where the parameter ``by`` ends it."""

    def __init__(self, reason: str, by: str) -> None:
        super().__init__(reason)
        self.by = by

    def __reduce__(self) -> tuple:
        return type(self), (str(self), self.by)  # as it comes back from a worker


def farthest(parameters: Parameters, end: End) -> float | None:
    """The last value to which a parameter may move the end of a branch; ``None`` if it may not."""
    side = parameters.movable.get(end.by)
    if side is None or end.begins:
        return None
    metadata = type(parameters).model_fields[end.by].metadata
    return next(float(getattr(item, side)) for item in metadata if hasattr(item, side))


def moved(
    asked: Parameters, here: Parameters, end: End, to: float | None = None, factor: float = FACTORS[0]
) -> Parameters | None:
    """Parameters with which a branch ends at a value, or some times as far as it does.

    Args:
        asked: The parameters that were asked for; an end that they set stays there.
        here: Those with which the branch ends as it does.
        end: The end.
        to: The value.
        factor: How many times as far, if no value is given.

    Returns:
        ``None`` if the end must stay, or is at the end of its range.
    """
    last = farthest(asked, end)
    if last is None or end.by in asked.model_fields_set:
        return None
    at = getattr(here, end.by)
    wanted = to if to is not None else min(at * factor, last) if last > at else max(at / factor, last)
    if wanted == at or (wanted - last) * (last - at) > 0:
        return None
    return here.model_copy(update={end.by: wanted})


def within(problem: Problem, parameters: Parameters, requests: Requests) -> Parameters:
    """Parameters with which branches reach the states that are asked for, as far as that is known.

    Raises:
        InputError: For a state beyond an end that was set, or that may not move so far.
    """
    found = parameters
    for wanted in requests.states:
        for end in problem.ends(found, wanted.branch):
            if not end.largest or wanted.name != end.column or wanted.value <= end.value:
                continue
            longer = moved(parameters, found, end, wanted.value)
            if longer is None:
                last = farthest(parameters, end)
                most = f" (allowed: up to {last:g})" if last is not None else ""
                raise InputError(
                    f"{problem.name}: {wanted.name} = {wanted.value:g} lies beyond {end.by} = {end.value:g}; "
                    f"raise {end.by}{most}"
                )
            found = longer
    return found


def reached(
    problem: Problem, parameters: Parameters, requests: Requests, solve: Callable[[Any], Result]
) -> Result:
    """The result with the states that are asked for: a branch that lacks one is followed further.

    It says in ``warnings`` which parameter was changed. A parameter that was set stays.

    Raises:
        BeyondEndError: For a state that a branch does not have up to the end of the parameter's range.
    """
    here = within(problem, parameters, requests)
    if here is not parameters:
        problem.check(here, requests)
    result = None
    while result is None:
        try:
            result = solve(here)
        except BeyondEndError as error:
            here = _longer(problem, parameters, here, requests, error)
    for name in parameters.movable:
        before, now = getattr(parameters, name), getattr(here, name)
        if before != now:
            result.warnings.append(
                f"{name} = {now:g} instead of the default {before:g}: the branch was followed further, to "
                "the states asked for"
            )
    return result


def _longer(
    problem: Problem, asked: Parameters, here: Parameters, requests: Requests, error: BeyondEndError
) -> Parameters:
    """Parameters with which a branch that lacks a state is longer; else the error is raised."""
    branches = {wanted.branch for wanted in requests.states}
    found = [end for name in branches for end in problem.ends(here, name) if end.by == error.by]
    ends = [end for end in found if farthest(asked, end) is not None]
    for factor in FACTORS if ends else ():
        longer = moved(asked, here, ends[0], factor=factor)
        if longer is None:
            break
        with suppress(InputError):  # the law does not reach so far
            problem.check(longer, requests)
            return longer
    if ends and getattr(here, error.by) == farthest(asked, ends[0]):
        raise BeyondEndError(f"{error}, the end of its range", error.by)
    raise error


def limit_points_beyond(branch: Any, end: End, last: float) -> str:
    """Whether a branch has limit points between its end and the last value of its parameter, as text.

    Args:
        branch: The branch on one mesh.
        end: Its end.
        last: The last value that the end's parameter may have.
    """
    if not isinstance(branch, EquilibriumBranch):
        return ""

    followed = count()

    def stop(point: CurvePoint) -> bool:
        return (point.monitors | point.state.loads)[end.column] > last or next(followed) > MOST

    beyond = EquilibriumBranch(branch.continuation, branch.control, branch.points[-1], stop)
    try:
        found = [p for p in beyond.special() if p.kind == "limit_point"]
    except ConvergenceError:
        return ""
    places = ", ".join(f"{(p.values | p.state.loads)[end.column]:.4g}" for p in found)
    many = "limit points" if len(found) > 1 else "a limit point"
    return f"before {many} at {end.column} = {places}; raise {end.by}" if found else ""
