"""The interface of all problems: parameters with ranges, and a method that solves and answers requests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

import numpy as np
from mpi4py import MPI
from pydantic import BaseModel, ConfigDict, ValidationError

from weakforms.errors import InputError
from weakforms.results import Result
from weakforms.solvers.continuation.branch import DIAGNOSTICS


class Parameters(BaseModel):
    """Parameters of a problem with names, defaults and ranges; immutable, without unknown names and NaN."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True)

    @classmethod
    def further(cls) -> frozenset[str]:
        """Names that may be given in addition to the fields' names."""
        return frozenset()


class TogetherError(ValueError):
    """A contradiction between several parameters; its text names them and their values."""


class Numerics(Parameters):
    """Discretisation of a problem; the stated accuracies hold for the defaults."""


@dataclass(frozen=True)
class StateRequest:
    """A requested state: a column, its value, the branch, the crossing, and the profile."""

    name: str
    """A column, or a kind of special point."""
    value: float
    """Value of the column, or number of the special point of that kind, from 1."""
    crossing: int = 1
    branch: str = "primary"
    profile: tuple[float, ...] | None = None
    """Sample points of fields in addition to the default ones; ``None`` for no fields."""


@dataclass(frozen=True)
class Requests:
    """Everything that is requested of one solve."""

    states: tuple[StateRequest, ...] = ()
    branch_uncertainty: bool = True
    """Whether every point of the trace gets an uncertainty (needs a solve for each mesh and point)."""
    drawn: int = 0
    """Number of random points of each trace at which states are solved for in addition."""


Progress = Callable[[str, int, int], None]
"""Called with the current step, the amount of work done and the total amount."""


def silent(_what: str, _done: int, _total: int) -> None:
    """Report no progress."""


class Problem(Protocol):
    """A physical problem of the papers."""

    name: ClassVar[str]
    title: ClassVar[str]
    paper: ClassVar[int]
    source: ClassVar[str]
    energy: ClassVar[str]
    """The functional as text."""
    scales: ClassVar[dict[str, str]]
    """Scaling of every column and parameter."""
    parameters: ClassVar[type[Parameters]]
    numerics: ClassVar[type[Numerics]]
    special_points: ClassVar[tuple[str, ...]]
    columns: ClassVar[tuple[str, ...]]
    branches: ClassVar[tuple[str, ...]]

    def check(self, parameters: Any, requests: Requests) -> None:
        """Refuse, before anything is solved, wrong combinations of parameters and requests."""

    def solve(
        self,
        parameters: Any,
        numerics: Any,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Solve and answer the requests."""


@dataclass
class Registry:
    """Problems by name."""

    problems: dict[str, Problem] = field(default_factory=dict)

    def add(self, problem: Problem) -> Problem:
        """Register one."""
        self.problems[problem.name] = problem
        return problem

    def get(self, name: str) -> Problem:
        """The problem of that name.

        Raises:
            InputError: If there is none.
        """
        if name not in self.problems:
            known = ", ".join(self.problems)
            raise InputError(f"unknown problem {name!r}; the problems are {known}")
        return self.problems[name]


registry = Registry()


def validated(model: type[Parameters], given: dict[str, Any], what: str) -> Any:
    """Validate parameters given by names and values.

    Raises:
        InputError: With one line that names each wrong parameter, its value and the allowed ones.
    """
    unknown = sorted(set(given) - set(model.model_fields) - model.further())
    if unknown:
        known = ", ".join(model.model_fields)
        raise InputError(f"{what} has no parameter {unknown[0]!r}; it has {known}")
    try:
        return model(**given)
    except ValidationError as error:
        parts = []
        for item in error.errors():
            name = ".".join(str(part) for part in item["loc"]) or "parameters"
            message = item["msg"][0].lower() + item["msg"][1:]
            cause = item.get("ctx", {}).get("error")
            together = isinstance(cause, TogetherError)
            parts.append(str(cause) if together else f"{name} = {item['input']!r}: {message}")
        raise InputError(f"{what}: " + "; ".join(parts)) from error


def check_requests(problem: Problem, requests: Requests) -> None:
    """Refuse requests for states that no solution of the problem has.

    Raises:
        InputError: If a column or branch is unknown, a crossing is below one, or a value is not a number.
    """
    barred = (*DIAGNOSTICS, *getattr(problem, "derived", ()))
    allowed = [*(c for c in problem.columns if c not in barred), *problem.special_points]
    for wanted in requests.states:
        if wanted.name not in allowed:
            raise InputError(
                f"{problem.name}: cannot ask for a state at {wanted.name!r}; allowed: {', '.join(allowed)}"
            )
        if wanted.branch not in problem.branches:
            raise InputError(
                f"{problem.name} has no branch {wanted.branch!r}; it has {', '.join(problem.branches)}"
            )
        if not np.isfinite(wanted.value):
            raise InputError(f"{problem.name}: {wanted.name} = {wanted.value} is not a finite number")
        if wanted.crossing < 1:
            raise InputError(f"{problem.name}: crossing = {wanted.crossing} must be 1 or more")
        if wanted.name in problem.special_points and wanted.value not in range(1, 1000):
            raise InputError(
                f"{problem.name}: {wanted.name} = {wanted.value:g} must be a whole number from 1: "
                "the number of the point along the branch"
            )


def sample_points(wanted: tuple[float, ...] | None, default: np.ndarray) -> np.ndarray | None:
    """Sorted sample points of a request: the default ones and those that it adds.

    Raises:
        InputError: If a point is outside the body.
    """
    if wanted is None:
        return None
    points = np.unique(np.concatenate([default, np.asarray(wanted, dtype=float)]))
    if points[0] < default[0] - 1e-9 or points[-1] > default[-1] + 1e-9:
        raise InputError(
            f"profile points must lie in [{default[0]:g}, {default[-1]:g}], "
            f"not in [{points[0]:g}, {points[-1]:g}]"
        )
    return points
