"""The functions that other programs call: solve a problem, list cases, compare a curve."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, Literal

from weakforms.errors import EnvironmentLackError, InputError, not_among
from weakforms.results import Result
from weakforms.world import world

States = Mapping[str, float] | Iterable[tuple[str, float]]
"""Requested states: a column and its value, or a kind of special point and its number."""


def require_environment() -> Any:
    """Import the registry of problems, which needs dolfinx.

    Raises:
        EnvironmentLackError: If something is missing; the message says how to get it.
    """
    try:
        import petsc4py

        # This comes first: a .petscrc in the current folder, written by anybody, could load a library.
        petsc4py.init(["weakforms", "-skip_petscrc"], comm=world())
        # The base of most problems imports every library that a solve needs; problems come when asked for.
        from weakforms.problems import branch_problem, registry  # noqa: F401
    except ImportError as error:
        missing = (error.name or str(error)).partition(".")[0]
        raise EnvironmentLackError(
            f"{missing} is not installed here; use ./run, or on Debian trixie: "
            "apt install python3-dolfinx-real python3-petsc4py-real python3-slepc4py-real"
        ) from error
    from weakforms.solvers.support import compat

    low, high = compat.SUPPORTED
    if not low <= compat.version() < high:
        raise EnvironmentLackError(
            f"dolfinx {'.'.join(map(str, compat.version()))} is installed; supported: "
            f"{low[0]}.{low[1]} up to before {high[0]}.{high[1]}"
        )
    return registry


def solve(
    problem: str,
    *,
    at: States = (),
    crossing: int | Literal["all"] = 1,
    branch: str = "primary",
    numerics: Mapping[str, Any] | None = None,
    accuracy: float | None = None,
    progress: Any = None,
    **parameters: Any,
) -> Result:
    """Solve a problem at any parameters.

    Args:
        problem: Name of the problem, such as ``"tube"``.
        at: Requested states: columns and the values at which the state is solved for, with its profile. The
            name of a kind of special point with a number asks for the state at that point.
        crossing: Which crossing of these values along the branch, from 1, or ``"all"``.
        branch: Name of the branch with these states.
        numerics: Meshes and degree, if not the defaults.
        accuracy: Use meshes on which the bound of every number is at most a tenth of this, relative to the
            largest magnitude of its column; they are coarser or finer than the default ones.
        progress: Called with the current step, the amount of work done and the total amount.
        **parameters: Parameters of the problem; those not given keep their defaults.

    Returns:
        Branch, special points and states, every number with its uncertainty. A parameter without effect, or
        one that was changed to reach a state, is a Python warning, and listed in ``warnings`` of the result.

    Raises:
        InputError: For an unknown problem or parameter, or a value out of range; nothing was solved.
        ConvergenceError: If no branch could be started.
        EnvironmentLackError: If dolfinx is missing.
    """
    result = prepare(problem, parameters, numerics or {}, at, crossing, branch, accuracy)(progress)
    for text in result.warnings:
        warnings.warn(f"{problem}: {text}", UserWarning, stacklevel=2)
    return result


def prepare(
    problem: str,
    parameters: Mapping[str, Any],
    numerics: Mapping[str, Any],
    at: States,
    crossing: int | Literal["all"] = 1,
    branch: str = "primary",
    accuracy: float | None = None,
) -> Callable[[Any], Result]:
    """Do everything that :func:`solve` does before solving.

    Returns:
        A function of a progress callback that solves and returns the result.


    Raises:
        InputError: For an unknown problem, parameter or branch, or a value out of range.
        EnvironmentLackError: If dolfinx is missing.
    """
    chosen = require_environment().get(problem)
    from weakforms.problems.problem import StateRequest

    if branch not in (*chosen.about.branches, "primary"):  # the default, which not every problem has
        raise InputError(f"{problem} has no branch {branch!r}{not_among(branch, chosen.about.branches)}")
    if crossing != "all" and crossing < 1:
        raise InputError(f"{problem}: crossing = {crossing} must be 1 or more, or 'all'")
    wanted = at.items() if isinstance(at, Mapping) else at
    states = [StateRequest(name, state_value(name, v), crossing, branch, profile=()) for name, v in wanted]
    if branch != "primary" and not states:
        raise InputError(f"{problem}: branch = {branch!r} is where requested states lie; request one with at")
    return prepared(problem, parameters, numerics, states, ahead=True, accuracy=accuracy)


def solve_requests(
    problem: str,
    parameters: Mapping[str, Any],
    numerics: Mapping[str, Any],
    states: Iterable[Any],
    branch_uncertainty: bool = True,
    drawn: int = 0,
) -> Result:
    """Solve as :func:`solve` does, with requests that give the profile points of each state.

    In addition, ``drawn`` states are solved for at random points of each trace.
    """
    return prepared(problem, parameters, numerics, states, branch_uncertainty, drawn)(None)


def prepared(
    problem: str,
    parameters: Mapping[str, Any],
    numerics: Mapping[str, Any],
    states: Iterable[Any],
    branch_uncertainty: bool = True,
    drawn: int = 0,
    ahead: bool = False,
    accuracy: float | None = None,
) -> Callable[[Any], Result]:
    """Do everything that :func:`solve_requests` does before solving, as :func:`prepare` does.

    Raises:
        InputError: For an unknown problem, parameter or branch, or a value out of range; for an accuracy of a
            problem whose meshes cannot be refined.
        EnvironmentLackError: If dolfinx is missing.
    """
    registry = require_environment()
    from weakforms.problems.accuracy import at_accuracy, on_finer_meshes, require_accuracy
    from weakforms.problems.problem import Requests, silent, validated
    from weakforms.problems.reach import reached, within

    chosen = registry.get(problem)
    _refuse_columns(chosen, parameters)
    values = validated(chosen.parameters, dict(parameters), problem)
    meshes = validated(chosen.numerics, dict(numerics), f"{problem} numerics")
    requests = Requests(tuple(states), branch_uncertainty, drawn, ahead)
    chosen.check(values, requests)
    within(chosen, values, requests)
    if accuracy is not None:
        require_accuracy(accuracy, problem, meshes)

    def run(progress: Any) -> Result:
        once = partial(chosen.solve, requests=requests, comm=world(), progress=progress or silent)
        usual = partial(on_finer_meshes, chosen, meshes, once)
        resolved = partial(at_accuracy, accuracy, chosen, meshes, once)
        result = reached(chosen, values, requests, usual if accuracy is None else resolved)
        result.warnings.extend(values.without_effect())
        return result

    return run


def _refuse_columns(problem: Any, given: Mapping[str, Any]) -> None:
    """Refuse a load or another column that is given as a parameter, and say how to ask for a state there.

    Raises:
        InputError: If there is one.
    """
    columns = {column.name for column in problem.about.columns if not column.derived}
    for name, value in given.items():
        if name in columns - set(problem.parameters.model_fields) - problem.parameters.further():
            raise InputError(
                f"{problem.about.name} has no parameter {name!r}, which is a column: --at {name}={value} "
                f"asks for the state there (in Python: at={{{name!r}: {value}}})"
            )


def state_value(name: str, value: object) -> float:
    """The value of a requested state as a number.

    Raises:
        InputError: If it is none.
    """
    try:
        return float(value if not isinstance(value, bool) else str(value))
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"at {name} = {str(value)[:80]!r}: the value must be a number") from None


def cases() -> list[str]:
    """Ids of all cases."""
    from weakforms.verification.cases.discovery import find_cases

    return [found.id for found in find_cases()]
