"""What other programs call: solve a problem, list cases, compare a curve."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.results import Result

States = Mapping[str, float] | Iterable[tuple[str, float]]
"""States wanted: a column, or a kind of special point, and its value or number."""


def require_environment() -> Any:
    """The registry of problems, which needs dolfinx.

    Raises:
        EnvironmentLackError: Naming what is missing and how to get it.
    """
    try:
        import petsc4py

        # First of all: a .petscrc in the current folder, which may be somebody else's, could load a library.
        petsc4py.init(["weakforms", "-skip_petscrc"])
        from weakforms.problems import registry
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
    crossing: int = 1,
    branch: str = "primary",
    numerics: Mapping[str, Any] | None = None,
    progress: Any = None,
    **parameters: Any,
) -> Result:
    """Solve a problem at any parameters.

    Args:
        problem: Its name, such as ``"tube"``.
        at: States wanted: columns and the values at which the state is solved for, with its profile. The
            name of a kind of special point with a number asks for that point's state.
        crossing: Which crossing of those values along the branch.
        branch: On which branch.
        numerics: Meshes and degree, where the defaults will not do.
        progress: Called with what is being done, how much of it is done, and how much there is.
        **parameters: Parameters of the problem; the others keep their defaults.

    Returns:
        Branch, special points and states, every number with its uncertainty.

    Raises:
        InputError: For an unknown problem or parameter, or a value out of range; nothing was solved.
        ConvergenceError: When no branch could be started.
        EnvironmentLackError: When dolfinx is missing.
    """
    return prepare(problem, parameters, numerics or {}, at, crossing, branch)(progress)


def prepare(
    problem: str,
    parameters: Mapping[str, Any],
    numerics: Mapping[str, Any],
    at: States,
    crossing: int = 1,
    branch: str = "primary",
) -> Callable[[Any], Result]:
    """Everything :func:`solve` does before solving: what it returns solves, and takes a progress callback.

    Raises:
        InputError: For an unknown problem, parameter or branch, or a value out of range.
        EnvironmentLackError: When dolfinx is missing.
    """
    chosen = require_environment().get(problem)
    from weakforms.problems.problem import StateRequest

    if branch not in chosen.branches:
        raise InputError(f"{problem} has no branch {branch!r}; it has {', '.join(chosen.branches)}")
    if crossing < 1:
        raise InputError(f"{problem}: crossing = {crossing} must be 1 or more")
    wanted = at.items() if isinstance(at, Mapping) else at
    states = [StateRequest(name, _number(name, v), crossing, branch, profile=()) for name, v in wanted]
    return _prepared(problem, parameters, numerics, states)


def solve_requests(
    problem: str,
    parameters: Mapping[str, Any],
    numerics: Mapping[str, Any],
    states: Iterable[Any],
    branch_uncertainty: bool = True,
    drawn: int = 0,
) -> Result:
    """As :func:`solve`, with requests that say for each state which profile points it needs.

    ``drawn`` states more are solved for at points of each trace drawn at random.
    """
    return _prepared(problem, parameters, numerics, states, branch_uncertainty, drawn)(None)


def _prepared(
    problem: str,
    parameters: Mapping[str, Any],
    numerics: Mapping[str, Any],
    states: Iterable[Any],
    branch_uncertainty: bool = True,
    drawn: int = 0,
) -> Callable[[Any], Result]:
    registry = require_environment()
    from mpi4py import MPI

    from weakforms.problems.problem import Requests, silent, validated

    chosen = registry.get(problem)
    values = validated(chosen.parameters, dict(parameters), problem)
    meshes = validated(chosen.numerics, dict(numerics), f"{problem} numerics")
    requests = Requests(tuple(states), branch_uncertainty, drawn)
    chosen.check(values, requests)
    return lambda progress: chosen.solve(values, meshes, requests, MPI.COMM_WORLD, progress or silent)


def _number(name: str, value: object) -> float:
    try:
        return float(value if not isinstance(value, bool) else str(value))
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"at {name} = {str(value)[:80]!r}: the value must be a number") from None


def cases() -> list[str]:
    """Ids of all cases."""
    from weakforms.verification.cases.discovery import find_cases

    return [found.id for found in find_cases()]
