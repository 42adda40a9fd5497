"""Base class of problems whose results are branches, traced on a family of meshes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, ClassVar, Protocol, Self

import numpy as np
from mpi4py import MPI
from pydantic import Field, model_validator

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.problem import Numerics, Parameters, Progress, Requests, sample_points, silent
from weakforms.results import Absence, Branch, Failure, Result, SpecialPoint, State
from weakforms.results.drawing import critical, draw, seed_of
from weakforms.solvers.continuation.branch import DIAGNOSTICS
from weakforms.solvers.equilibrium.newton import STOPPING
from weakforms.solvers.support.provenance import provenance


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


class Family(Protocol):
    """A branch on a family of meshes: numbers with their uncertainties."""

    name: str

    @property
    def quadrature_degree(self) -> int:
        """Quadrature degree of the form that is solved."""

    @property
    def absent(self) -> Sequence[Absence]:
        """What was asked for and is not there."""

    @property
    def failures(self) -> list[Failure]:
        """Solves that did not converge."""

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """The branch with all its columns."""

    def special_points(self) -> list[SpecialPoint]:
        """Special points in their order along the branch."""

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """Solve for a state."""


class PathProblem:
    """A problem whose results are branches and their states; a subclass defines the branches."""

    name: ClassVar[str]
    scales: ClassVar[dict[str, str]]
    columns: ClassVar[tuple[str, ...]]
    derived: ClassVar[tuple[str, ...]] = ()
    """Columns that cannot be prescribed."""

    def families(
        self, parameters: Any, numerics: Any, requests: Requests, comm: MPI.Intracomm, progress: Progress
    ) -> dict[str, Family]:
        """The branches by name, in the order of the results."""
        raise NotImplementedError

    def resolving(self, _parameters: Any, numerics: Any) -> Any:
        """Numerics that resolve the problem at its parameters, if the default does not."""
        return numerics

    def points(self, parameters: Any) -> np.ndarray:
        """Default sample points of fields, from one end of the body to the other."""
        raise NotImplementedError

    def solve(
        self,
        parameters: Any,
        numerics: Any,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Trace the branches on all meshes, locate their special points, solve for the requested states.

        Raises:
            AbsentError: If states are requested and there is no branch.
        """
        begun = time.perf_counter()
        numerics = self.resolving(parameters, numerics)
        result = self._result(parameters, numerics)
        try:
            families = self.families(parameters, numerics, requests, comm, progress)
        except AbsentError as error:
            if requests.states:
                raise
            result.absent.append(Absence(error.what, str(error)))
        else:
            self._answer(result, families, requests, self.points(parameters), progress)
        result.provenance = provenance(comm, time.perf_counter() - begun)
        return result

    def _result(self, parameters: Parameters, numerics: MeshNumerics) -> Result:
        return Result(
            problem=self.name,
            parameters=parameters.model_dump(),
            scales=self.scales,
            numerics={
                **numerics.model_dump(),
                "meshes": numerics.meshes,
                "stopping": STOPPING,
            },
            provenance={},
        )

    def _answer(
        self,
        result: Result,
        families: dict[str, Family],
        requests: Requests,
        default_points: np.ndarray,
        progress: Progress,
    ) -> None:
        """Put branches, special points and the requested states into a result, which also lists failures."""
        degrees = {name: family.quadrature_degree for name, family in families.items()}
        alike = len(set(degrees.values())) == 1
        result.numerics["quadrature_degree"] = next(iter(degrees.values())) if alike else degrees
        for name, family in families.items():
            if requests.branch_uncertainty:
                progress(f"uncertainty of the {name} branch", 0, 1)
            result.branches.append(family.branch(requests.branch_uncertainty))
            try:
                result.special_points.extend(family.special_points())
            except ConvergenceError as error:
                result.failures.append(Failure("special points", str(error)))
        for i, wanted in enumerate(requests.states):
            progress("states", i, len(requests.states))
            points = sample_points(wanted.profile, default_points)
            try:
                family = families[wanted.branch]
                result.states.append(family.state(wanted.name, wanted.value, wanted.crossing, points))
            except ConvergenceError as error:
                result.failures.append(Failure(f"state at {wanted.name} = {wanted.value:g}", str(error)))
        for name, family in families.items():
            self._solve_drawn(result, name, family, requests.drawn, default_points)
        for family in families.values():
            result.failures.extend(family.failures)
            result.absent.extend(family.absent)

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
        barred = (*DIAGNOSTICS, *self.derived)
        columns = [column for column in self.columns if column not in barred]
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
