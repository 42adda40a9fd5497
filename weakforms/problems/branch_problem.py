"""Base class of problems whose results are branches, traced on a family of meshes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, replace
from math import inf
from typing import Any, ClassVar, Protocol, Self

import numpy as np
from pydantic import Field, ValidationError, model_validator

from weakforms.errors import AbsentError, ConvergenceError, InputError, not_among
from weakforms.problems.problem import Numerics, Problem, Progress, StateRequest, Task, ended, sample_points
from weakforms.problems.reach import BeyondEndError, farthest, limit_points_beyond
from weakforms.results import Absence, Branch, Failure, Result, SpecialPoint, State
from weakforms.results.drawing import critical, draw, seed_of
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import STOPPING, ExtendedNewton
from weakforms.solvers.equilibrium.state import State as Equilibrium
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.uncertainty.family import BranchFamily


class MeshNumerics(Numerics):
    """A family of meshes: ``cells`` on the finest one, half as many on each coarser level."""

    degree: int = Field(4, ge=1, le=6, description="polynomial degree of the unknowns")
    cells: int = Field(96, ge=8, le=20_000, description="cells on the finest mesh")
    levels: int = Field(3, ge=2, le=4, description="meshes, each twice as fine as the one before")
    step: float = Field(0.08, ge=0.01, le=0.5, description="largest arc-length step")

    @model_validator(mode="after")
    def _nested(self) -> Self:
        coarsest = 2 ** (self.levels - 1)
        if self.cells % coarsest:
            raise ValueError(f"cells must be a multiple of {coarsest} for {self.levels} levels")
        return self

    @property
    def meshes(self) -> list[int]:
        """Number of cells of each mesh, coarse to fine."""
        return [self.cells // 2**k for k in reversed(range(self.levels))]

    def scaled(self, factor: float) -> Self:
        """The same with so many times as many cells.

        Raises:
            ValidationError: If there are no such meshes.
        """
        return type(self)(**self.model_dump() | {"cells": int(factor * self.cells)})

    def described(self) -> dict[str, Any]:
        """Entries of a result that describe the discretisation."""
        return {**super().described(), "meshes": self.meshes}


class Family(Protocol):
    """A branch on a family of meshes: numbers with their uncertainties."""

    name: str
    progress: Progress

    @property
    def quadrature_degree(self) -> int:
        """Quadrature degree of the form that is solved."""

    @property
    def absent(self) -> Sequence[Absence]:
        """What was asked for and is not there."""

    @property
    def failures(self) -> list[Failure]:
        """Solves that did not converge."""

    @property
    def warnings(self) -> Sequence[str]:
        """What to know of the numbers, such as a mesh that was left out."""

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """The branch with all its columns."""

    def special_points(self) -> list[SpecialPoint]:
        """Special points in their order along the branch."""

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """Solve for a state."""


def from_rest(
    system: System,
    load: str,
    along: str,
    end: float,
    step: float,
    begin: Equilibrium | None = None,
    usual_load: float = inf,
    kind: Callable[..., EquilibriumBranch] = EquilibriumBranch,
    gives_way: Callable[[CurvePoint], str] = lambda _point: "",
) -> EquilibriumBranch:
    """Equilibria by arc length from the state without load, or with little, until a column passes its end.

    Args:
        system: The equilibrium equations.
        load: The load.
        along: A column that changes along the whole branch.
        end: Its value at which the branch ends.
        step: Largest step.
        begin: Guess of the first state, at its load; by default the state of rest.
        usual_load: Load above which steps grow in proportion to it.
        kind: The class of the curve.
        gives_way: Why there is no solution beyond a point, where the branch ends too; empty if there may be.
    """
    steps = StepControl(first=step / 4, largest=step, usual_load=usual_load)
    continuation = Continuation(ExtendedNewton(system, [load]), control=steps)
    begin = begin or system.initial
    with system.at(begin):
        rising = 1.0 if end > system.monitor(along) else -1.0
    start = continuation.start(begin, Held(load, begin.loads[load]), towards={along: rising})

    def stop(point: CurvePoint) -> bool:
        return rising * (point.monitors[along] - end) > 0 or bool(gives_way(point))

    return kind(continuation, load, start, stop)


class BranchProblem(Problem):
    """A problem whose results are branches and their states; a subclass defines the branches."""

    def families(self, task: Task) -> dict[str, Family]:
        """The branches by name, in the order of the results."""
        raise NotImplementedError

    surfaces: ClassVar[bool] = False
    """Whether meshes are of surfaces, where twice as many cells along an edge cost many times as much."""

    def finer(self, parameters: Any, numerics: Any) -> Any:
        """Meshes with twice as many cells; none if their number was asked for, or may not be higher."""
        known = isinstance(numerics, MeshNumerics) and "cells" not in numerics.model_fields_set
        if self.surfaces or not known:
            return None
        with suppress(ValidationError):
            return MeshNumerics.scaled(self.resolving(parameters, numerics), 2.0)
        return None

    def points(self, parameters: Any) -> np.ndarray:
        """Default sample points of fields, from one end of the body to the other."""
        raise NotImplementedError

    def fill(self, result: Result, task: Task) -> None:
        """Trace the branches on all meshes, locate their special points, solve for the requested states."""
        result.numerics["stopping"] = STOPPING
        try:
            families = self.families(task)
        except AbsentError as error:
            if task.requests.states:
                raise
            result.absent.append(Absence(error.what, str(error)))
        else:
            self._answer(result, families, task)

    def _answer(self, result: Result, families: dict[str, Family], task: Task) -> None:
        """Put branches, special points and the requested states into a result, which also lists failures."""
        requests, progress, default_points = task.requests, task.progress, self.points(task.parameters)
        degrees = {name: family.quadrature_degree for name, family in families.items()}
        alike = len(set(degrees.values())) == 1
        result.numerics["quadrature_degree"] = next(iter(degrees.values())) if alike else degrees
        for family in families.values():
            family.progress = progress
            result.branches.append(family.branch(requests.branch_uncertainty))
            try:
                result.special_points.extend(family.special_points())
            except ConvergenceError as error:
                result.failures.append(Failure("special points", str(error)))
        for i, wanted in enumerate(requests.states):
            progress("states", i, len(requests.states))
            points = sample_points(wanted.profile, default_points)
            if wanted.branch not in families:  # a line of another kind, or of a higher number than there is
                what = f"{self.name} at these parameters has no branch {wanted.branch!r}"
                raise InputError(what + not_among(wanted.branch, families))
            family = families[wanted.branch]
            for crossing, count in asked_crossings(result.branch(wanted.branch), wanted):
                try:
                    state = family.state(wanted.name, wanted.value, crossing, points)
                    result.states.append(replace(state, crossings=count))
                except ConvergenceError as error:
                    result.failures.append(Failure(f"state at {wanted.name} = {wanted.value:g}", str(error)))
                except InputError as error:
                    raise self._not_reached(str(error), result, wanted.branch) from error
        for name, family in families.items():
            self._solve_drawn(result, name, family, requests.drawn, default_points)
        for family in families.values():
            result.failures.extend(family.failures)
            result.absent.extend(family.absent)
            result.warnings.extend(family.warnings)
        result.warnings.extend(self.remarks(task.parameters, task.numerics, families))
        if requests.ahead:  # last, so that no other number depends on it
            result.branches[:] = [self._with_end(b, families[b.name], task) for b in result.branches]

    def remarks(self, _parameters: Any, _numerics: Any, _families: Mapping[str, Family]) -> list[str]:
        """What to know of branches beside their numbers."""
        return []

    def _not_reached(self, what: str, result: Result, name: str) -> InputError:
        """The error of a state that a branch does not have, which says where and why the branch ends."""
        branch = result.branch(name)
        parameters = self.parameters.model_validate(result.parameters)
        end = branch.ended or ended(branch, self.ends(parameters, name), result)
        return BeyondEndError(f"{what}; the branch ends at {end}", end.by) if end else InputError(what)

    def _with_end(self, branch: Branch, family: Family, task: Task) -> Branch:
        """A branch with its end, if it ends before a limit point."""
        for end in self.ends(task.parameters, branch.name):
            last = farthest(task.parameters, end)
            found = ended(branch, [end], Result(self.name, {}, {}, {}, {}))
            if found and end.largest and last is not None and isinstance(family, BranchFamily):
                reason = limit_points_beyond(family.levels[0], end, last)
                return replace(branch, ended=replace(found, reason=reason)) if reason else branch
        return branch

    def _solve_drawn(
        self, result: Result, name: str, family: Family, count: int, default_points: np.ndarray
    ) -> None:
        """Solve for states at random points of a trace, for the first one with its profile.

        The result's ``numerics`` lists the points. A point without a state on all meshes is listed there with
        the reason, and another point is drawn.
        """
        if not count:
            return
        seed = seed_of(f"{self.name} {name} {sorted(result.parameters.items())}")
        columns = [column.name for column in self.about.columns if not column.derived]
        record = {"seed": seed, "points": [], "left_out": []}
        branch = result.branch(name)
        for drawn in draw(branch, columns, seed, critical(branch, result.special_points)):
            if len(record["points"]) == count or len(record["left_out"]) > count:
                break
            profile = default_points if not record["points"] else None
            try:
                result.states.append(family.state(drawn.column, drawn.value, 1, profile))
            except (ConvergenceError, InputError) as error:
                record["left_out"].append({**asdict(drawn), "reason": str(error)})
            else:
                record["points"].append(asdict(drawn))
        result.numerics.setdefault("drawn", {})[name] = record


def asked_crossings(branch: Branch, wanted: StateRequest) -> list[tuple[int, int | None]]:
    """The crossings that a request asks for, each with their number along the branch if that is known."""
    known = wanted.name in branch.columns
    count = (branch.crossings(wanted.name, wanted.value) or None) if known else None
    every = range(1, (count or 1) + 1) if wanted.crossing == "all" else [wanted.crossing]
    return [(crossing, count) for crossing in every]
