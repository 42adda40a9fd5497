"""The interface of all problems: parameters with ranges, and a method that solves and answers requests."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import BaseModel, ConfigDict, ValidationError

from weakforms.errors import InputError, closest, not_among
from weakforms.problems.about import About
from weakforms.results import Branch, Ended, Result
from weakforms.solvers.support.memory import release
from weakforms.solvers.support.provenance import provenance

Needs = Mapping[str, Sequence[Mapping[str, tuple[Any, ...]]]]
"""For each parameter the values of others without which it has no effect."""


class Parameters(BaseModel):
    """Parameters of a problem with names, defaults and ranges; immutable, without unknown names and NaN."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True)

    needs: ClassVar[Needs] = {}
    """Parameters that have an effect only with some values of others: for each name the alternatives, each
    of which gives the values that others must have; no values stand for any other than the default."""

    movable: ClassVar[Mapping[str, Literal["le", "ge"]]] = {}
    """Parameters that end a branch, and the side of their range towards which states that are asked for move
    them, unless they are set."""

    @classmethod
    def further(cls) -> frozenset[str]:
        """Names that may be given in addition to the fields' names."""
        return frozenset()

    def without_effect(self) -> list[str]:
        """A sentence about each parameter that was given and that changes nothing (:attr:`needs`)."""
        out = []
        for name in self.model_fields_set & set(self.needs):
            if not any(all(self._has(*item) for item in needed.items()) for needed in self.needs[name]):
                given = f"{name} = {getattr(self, name)}"
                out.append(f"{given} has no effect here; it needs {self.needed_by(name)}")
        return sorted(out)

    @classmethod
    def needed_by(cls, name: str) -> str:
        """The values of others without which a parameter has no effect, as text; empty if there are none."""
        return " or ".join(_needed(item) for item in cls.needs.get(name, ()))

    def _has(self, name: str, values: tuple[Any, ...]) -> bool:
        value = getattr(self, name)
        return value in values if values else value != type(self).model_fields[name].default


def _needed(needed: Mapping[str, tuple[Any, ...]]) -> str:
    """Values that other parameters must have, as text."""
    return " and ".join(
        f"{name} = {' or '.join(map(str, values))}" if values else name for name, values in needed.items()
    )


class TogetherError(ValueError):
    """A contradiction between several parameters; its text names them and their values."""


@dataclass(frozen=True)
class End:
    """One of the reasons for which a branch of a problem ends."""

    by: str
    """The parameter that says where, or another short word."""
    column: str
    """The column that takes a value there."""
    value: float | Callable[[Mapping[str, np.ndarray]], float] | None
    """The value, possibly as a function of the branch's columns; ``None`` for an end of which nothing else is
    known than that no other end was reached."""
    reason: str = ""
    """More about it, if no parameter ends the branch."""
    largest: bool = False
    """Whether no state of the branch has a larger value."""
    begins: bool = False
    """Whether the branch begins there, so that it is another branch for another value."""


class Numerics(Parameters):
    """Discretisation of a problem; the stated accuracies hold for the defaults."""

    def described(self) -> dict[str, Any]:
        """Entries of a result that describe the discretisation."""
        return self.model_dump()


@dataclass(frozen=True)
class StateRequest:
    """A requested state: a column, its value, the branch, the crossing, and the profile."""

    name: str
    """A column, or a kind of special point."""
    value: float
    """Value of the column, or number of the special point of that kind, from 1."""
    crossing: int | Literal["all"] = 1
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
    ahead: bool = False
    """Whether limit points are looked for beyond the end of a branch, up to the end of its range."""


Progress = Callable[[str, int, int], None]
"""Called with the current step, the amount of work done and the total amount."""


def silent(_what: str, _done: int, _total: int) -> None:
    """Report no progress."""


@dataclass(frozen=True)
class Task:
    """One solve of a problem."""

    parameters: Any
    numerics: Any
    requests: Requests
    comm: MPI.Intracomm
    progress: Progress


class Problem:
    """A physical problem: its description, its parameters, and how it is solved."""

    about: ClassVar[About]
    parameters: ClassVar[type[Parameters]]
    numerics: ClassVar[type[Numerics]]

    @property
    def name(self) -> str:
        """Name of the problem."""
        return self.about.name

    @property
    def scales(self) -> dict[str, str]:
        """Meaning and scaling of every number of the results."""
        return self.about.scales

    def check(self, parameters: Any, requests: Requests) -> None:
        """Refuse, before anything is solved, wrong combinations of parameters and requests.

        Raises:
            InputError: For a state that no solution has; subclasses refuse more.
        """
        check_requests(self.about, requests, self.computed(parameters))

    def computed(self, _parameters: Any) -> Sequence[str]:
        """Names besides the columns by which a state can be requested; eigenvalues, for instance."""
        return ()

    def resolving(self, _parameters: Any, numerics: Any) -> Any:
        """Numerics that resolve the problem at its parameters, if the default does not."""
        return numerics

    def finer(self, _parameters: Any, _numerics: Any) -> Any:
        """Finer numerics for what does not converge with the default ones; ``None`` if there are none."""
        return None

    def ends(self, _parameters: Any, _branch: str) -> Sequence[End]:
        """The reasons for which a branch may end, the first that applies first."""
        return ()

    def solve(
        self,
        parameters: Any,
        numerics: Any,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Solve and answer the requests.

        Raises:
            AbsentError: If states are requested and there is no branch.
        """
        begun = time.perf_counter()
        task = Task(parameters, self.resolving(parameters, numerics), requests, comm, progress)
        result = Result(
            problem=self.name,
            parameters=parameters.model_dump(),
            scales=self.scales,
            numerics=task.numerics.described(),
            provenance={},
        )
        self.fill(result, task)
        for k, branch in enumerate(result.branches):
            end = branch.ended or ended(branch, self.ends(parameters, branch.name), result)
            result.branches[k] = replace(branch, ended=end)
        release(comm)
        result.provenance = provenance(comm, time.perf_counter() - begun)
        return result

    def fill(self, result: Result, task: Task) -> None:
        """Put what is solved for into a result."""
        raise NotImplementedError


def validated(model: type[Parameters], given: dict[str, Any], what: str) -> Any:
    """Validate parameters given by names and values.

    Raises:
        InputError: With one line that names each wrong parameter, its value and the allowed ones.
    """
    unknown = sorted(set(given) - set(model.model_fields) - model.further())
    if unknown:
        names = [name for name in model.model_fields if name != "constants"]
        raise InputError(f"{what} has no parameter {unknown[0]!r}{not_among(unknown[0], names)}")
    try:
        return model(**given)
    except ValidationError as error:
        parts = []
        for item in error.errors():
            name = ".".join(str(part) for part in item["loc"]) or "parameters"
            message = item["msg"].removeprefix("Value error, ")
            message = message[0].lower() + message[1:]
            if item["type"] == "literal_error":
                message += _nearest_of(item["input"], item["ctx"]["expected"])
            cause = item.get("ctx", {}).get("error")
            together = isinstance(cause, TogetherError)
            parts.append(str(cause) if together else f"{name} = {item['input']!r}: {message}")
        raise InputError(f"{what}: " + "; ".join(parts)) from error


def _nearest_of(given: object, expected: str) -> str:
    """A question whether the allowed value nearest to a wrong one is meant; empty if none is near."""
    similar = closest(given, re.findall(r"'([^']*)'", expected))
    return f"; did you mean {similar!r}?" if similar else ""


def check_requests(about: About, requests: Requests, computed: Sequence[str] = ()) -> None:
    """Refuse requests for states that no solution of the problem has.

    Args:
        about: The problem in words.
        requests: The requests.
        computed: Further names by which a state can be requested.

    Raises:
        InputError: If a column or branch is unknown, a crossing is below one, or a value is not a number.
    """
    columns = (column.name for column in about.columns if not column.derived)
    allowed = [*columns, *computed, *about.special_points]
    for wanted in requests.states:
        if wanted.name not in allowed:
            raise InputError(
                f"{about.name}: cannot ask for a state at {wanted.name!r}"
                f"{not_among(wanted.name, allowed, 'allowed:')}"
            )
        if wanted.branch not in about.branches:
            raise InputError(
                f"{about.name} has no branch {wanted.branch!r}{not_among(wanted.branch, about.branches)}"
            )
        if not np.isfinite(wanted.value):
            raise InputError(f"{about.name}: {wanted.name} = {wanted.value} is not a finite number")
        if wanted.crossing != "all" and wanted.crossing < 1:
            raise InputError(f"{about.name}: crossing = {wanted.crossing} must be 1 or more")
        if wanted.name in about.special_points and wanted.value not in range(1, 1000):
            raise InputError(
                f"{about.name}: {wanted.name} = {wanted.value:g} must be a whole number from 1: "
                "the number of the point along the branch"
            )


NEAR = 1e-9
"""Relative distance from a value within which the last point of a branch has it."""


def ended(branch: Branch, ends: Sequence[End], result: Result) -> Ended | None:
    """Why a branch ends: the first of the reasons that its last step meets, else what a result says of it."""
    for end in ends:
        value = end.value(branch.columns) if callable(end.value) else end.value
        if value is not None and _reaches(branch.columns.get(end.column, ()), value):
            return Ended(end.by, end.column, float(value), end.reason)
    # The control of a peeling curve, the front, is not shown.
    column = branch.control if branch.control in branch.columns else next(iter(branch.columns))
    last = column, float(branch.columns[column][-1])
    absent = [a.reason for a in result.absent if a.what == f"rest of branch {branch.name}"]
    failed = [f.reason for f in result.failures if f.what.startswith(f"branch {branch.name}")]
    for by, reasons in (("absent", absent), ("failure", failed)):
        if reasons:
            return Ended(by, *last, reasons[0])
    other = [end for end in ends if end.value is None and end.column in branch.columns]
    for end in other[:1]:
        return Ended(end.by, end.column, float(branch.columns[end.column][-1]), end.reason)
    return None


def _reaches(values: Sequence[float], value: float) -> bool:
    """Whether a column has a value at its last point, or passes it in its last step."""
    if not len(values):
        return False
    beyond = [v - value for v in values[-2:]]
    return abs(beyond[-1]) <= NEAR * max(1.0, abs(value)) or beyond[0] * beyond[-1] < 0


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
