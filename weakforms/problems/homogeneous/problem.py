"""Problems of bodies that deform homogeneously: ``sphere``, ``infinite_tube``, ``homogeneous``."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.branch_problem import Family, PathProblem
from weakforms.problems.homogeneous import body as closed_body
from weakforms.problems.homogeneous.body import Body, system_of
from weakforms.problems.homogeneous.material import require_defined
from weakforms.problems.homogeneous.maxwell import maxwell_states
from weakforms.problems.material_choice import Chosen, MaterialChoice
from weakforms.problems.problem import Numerics, Progress, Requests, check_requests, registry, silent
from weakforms.results import Result
from weakforms.solvers.continuation.branch import EquilibriumBranch, FoldLine
from weakforms.solvers.continuation.continuation import Continuation, StepControl
from weakforms.solvers.equilibrium.constraints import Fold, Held
from weakforms.solvers.equilibrium.newton import STOPPING, ExtendedNewton
from weakforms.solvers.equilibrium.system import State, System
from weakforms.solvers.uncertainty.family import BranchFamily

THESIS = "Patil (2016), chapter 3"

DIAGNOSTICS = ("n_negative", "residual", "iterations")

USUAL = 10.0
"""Load up to which the usual step is used."""

ORDER = 2.0
"""Assumed order of convergence; it has no effect, because solutions on all levels are the same."""


class PointNumerics(Numerics):
    """Nothing is discretised; uncertainties come from Newton's stopping rule and from round-off."""

    step: float = Field(0.05, ge=0.005, le=0.5, description="largest arc-length step")
    levels: int = Field(
        2, ge=2, le=4, description="number of solutions compared (they differ by round-off only)"
    )


class ClosedProblem(PathProblem):
    """Base class of these problems: one branch from rest to an end."""

    numerics = PointNumerics
    paper: ClassVar[str] = "closed_form"
    source: ClassVar[str] = THESIS
    branches: ClassVar[tuple[str, ...]] = ("primary",)

    def points(self, _parameters: MaterialChoice) -> np.ndarray:
        """One point, because fields are constant."""
        return np.array([0.5])

    def _result(self, parameters: MaterialChoice, numerics: PointNumerics) -> Result:
        return Result(
            problem=self.name,
            parameters=parameters.model_dump(),
            scales=self.scales,
            numerics={**numerics.model_dump(), "stopping": STOPPING},
            provenance={},
        )


def branch_of(body: Body, chosen: Chosen, along: str, end: float, step: float) -> EquilibriumBranch:
    """Equilibria from the state of rest, by arc length, until a column passes its end."""
    system = system_of(body, chosen)
    control = StepControl(first=step / 4, largest=step, usual_load=USUAL)
    begin = _start_under_force(system, body, control) if body.force else system.state()
    continuation = Continuation(ExtendedNewton(system, [body.load]), control=control)
    rising = 1.0 if end > 1 else -1.0
    start = continuation.start(begin, Held(body.load, 0.0), towards={along: rising})
    return EquilibriumBranch(
        continuation, body.load, start, stop=lambda point: rising * (point.monitors[along] - end) > 0
    )


def _start_under_force(system: System, body: Body, control: StepControl) -> State:
    """The state under the body's force alone, reached from rest in steps, so that it is not inside out.

    Raises:
        ConvergenceError: If the force is not reached.
    """
    continuation = Continuation(ExtendedNewton(system, ["force"]), control=control)
    sign = 1.0 if body.force > 0 else -1.0
    start = continuation.start(system.state(), Held("force", 0.0), towards={body.unknowns[0]: sign})
    pulled = EquilibriumBranch(
        continuation, "force", start, lambda point: sign * (point.state.loads["force"] - body.force) > 0
    )
    if pulled.stalled:
        raise ConvergenceError(f"force = {body.force:g} is not reached from rest: {pulled.stalled}")
    return pulled.at("force", body.force).state


def fold_line(body: Body, chosen: Chosen, vary: str, to: float, lam_end: float, step: float) -> FoldLine:
    """The first limit point, followed in a constant of the law until it returns or reaches an end.

    Raises:
        InputError: If there is no limit point to start from.
    """
    system = system_of(body, chosen, vary)
    solver = ExtendedNewton(system, [body.load])
    plain = Continuation(solver, control=StepControl(first=step / 4, largest=step))
    along = body.unknowns[0]
    start = plain.start(system.state(), Held(body.load, 0.0), towards={along: 1.0})
    branch = EquilibriumBranch(plain, body.load, start, stop=lambda q: q.monitors[along] > lam_end)
    turns = branch.turns()
    if not len(turns):
        raise InputError(f"no limit point up to {along} = {lam_end:g}: no line of them starts there")
    first = branch.special()[0].state
    fold = Fold(body.load, system.mass_times(branch.points[int(turns[0])].tangent.u))
    begin = first.loads[vary]
    size = abs(to - begin)
    largest = min(max(step, size / 50), size / 4)  # constants have different sizes
    steps = StepControl(first=largest / 8, largest=largest)
    line = Continuation(ExtendedNewton(system, [body.load, vary]), [fold], steps, shift=1e-6)
    start = line.start(first, Held(vary, begin), towards={vary: np.sign(to - begin)})
    low, high = min(begin, to), max(begin, to)
    return FoldLine(
        line,
        vary,
        start,
        stop=lambda q: not low < q.state.loads[vary] < high or q.monitors[along] > lam_end,
    )


class SphereParameters(MaterialChoice):
    """A balloon, and the constant in which its limit point is followed."""

    lam_end: float = Field(4.0, gt=1.001, le=50, description="stretch at which inflation ends")
    vary: str = Field(
        "", description="constant of the model over which the limit point is followed; '': none"
    )
    vary_end: float | None = Field(None, description="value of that constant at which the fold line ends")


class Sphere(ClosedProblem):
    """Inflation of a spherical balloon of any law."""

    name: ClassVar[str] = "sphere"
    title: ClassVar[str] = "Inflation of a spherical balloon of any material law"
    energy: ClassVar[str] = "Pi = w(lam, lam) - P lam^3/3,  P = 2 w1(lam, lam)/lam^2"
    scales: ClassVar[dict[str, str]] = {
        "P": "p r_o/(S h_o), S the model's stress (C1 for neo_hookean and mooney_rivlin)",
        "lam": "radius over its value at rest",
        "Pi": "potential per reference area over S h_o",
    }
    parameters = SphereParameters
    columns = ("P", "lam", "lam1", "lam2", "Pi", *DIAGNOSTICS)
    derived = ("lam1", "lam2")
    special_points = ("limit_point", "cusp_point")
    branches: ClassVar[tuple[str, ...]] = ("primary", "fold")
    control: ClassVar[str] = "P (past a limit point compare over lam); branch fold: a constant of the model"

    def check(self, parameters: SphereParameters, requests: Requests) -> None:
        """Refuse stretches that the law does not reach, and fold lines in constants that it does not have.

        Raises:
            InputError: With a message that says what is allowed.
        """
        check_requests(self, requests)
        require_defined(self.name, parameters, parameters.lam_end, parameters.lam_end, "lam_end")
        chosen = parameters.material
        if not parameters.vary:
            if any(r.branch == "fold" or r.name == "cusp_point" for r in requests.states):
                raise InputError("sphere: the branch fold and its cusp_point need vary, a constant's name")
            return
        known = chosen.material.constants
        if parameters.vary not in known:
            allowed = ", ".join(known) or "none"
            raise InputError(f"sphere: vary = {parameters.vary!r}: model = {chosen.model!r} has: {allowed}")
        limits = known[parameters.vary]
        begin, end = dict(chosen.constants)[parameters.vary], parameters.vary_end
        if end is None or not limits.contains(end) or end == begin:
            raise InputError(
                f"sphere: vary_end = {end}: must be a number {limits.allowed}, other than {begin:g}"
            )

    def families(
        self,
        parameters: SphereParameters,
        numerics: PointNumerics,
        _requests: Requests,
        _comm: MPI.Intracomm,
        progress: Progress,
    ) -> dict[str, Family]:
        """The branch and, if a constant varies, the fold line of its limit points."""
        body, chosen, step = closed_body.sphere(), parameters.material, numerics.step

        def make(level: int) -> EquilibriumBranch:
            progress("branch", level, numerics.levels)
            return branch_of(body, chosen, "lam", parameters.lam_end, step)

        found = {"primary": BranchFamily(make, numerics.levels, ORDER, across=("P", "lam"))}
        if parameters.vary:

            def line(level: int) -> FoldLine:
                progress("fold", level, numerics.levels)
                return fold_line(body, chosen, parameters.vary, parameters.vary_end, parameters.lam_end, step)

            across = (parameters.vary, "lam")
            found["fold"] = BranchFamily(line, numerics.levels, ORDER, across=across, name="fold")
        return found


class InfiniteTubeParameters(MaterialChoice):
    """A long tube with closed ends."""

    force: float = Field(0.0, ge=-5, le=100, description="axial force of the ends over 2 pi R_o h_o S")
    lam_end: float = Field(6.0, gt=1.001, le=50, description="hoop stretch at which inflation ends")


class InfiniteTube(ClosedProblem):
    """Uniform inflation of a long tube: limit pressure, and the pressure at which two states coexist."""

    name: ClassVar[str] = "infinite_tube"
    title: ClassVar[str] = "Uniform inflation of an infinite tube: limit and Maxwell pressures"
    energy: ClassVar[str] = "Pi = w(lam1, lam2) - (p/2) lam1 lam2^2 - F lam1"
    scales: ClassVar[dict[str, str]] = {
        "p": "P R_o/(S h_o), S the model's stress",
        "force": "axial force in addition to the pressure over 2 pi R_o h_o S",
        "lam1": "axial stretch",
        "lam2": "hoop stretch",
        "V": "volume over its value at rest",
        "Pi": "potential per reference area over S h_o",
        "p_maxwell": "pressure at which a thin and a thick state have the same Pi, if there is one",
        "lam1_thin": "axial stretch of the thin state at that pressure (and so on)",
    }
    parameters = InfiniteTubeParameters
    columns = ("p", "lam1", "lam2", "V", "Pi", *DIAGNOSTICS)
    special_points = ("limit_point", "bifurcation_point")
    control: ClassVar[str] = "p (past a limit point compare over lam2)"

    def check(self, parameters: InfiniteTubeParameters, requests: Requests) -> None:
        """Refuse stretches that the law does not reach."""
        check_requests(self, requests)
        require_defined(self.name, parameters, 1.0, parameters.lam_end, "1, lam_end")

    def families(
        self,
        parameters: InfiniteTubeParameters,
        numerics: PointNumerics,
        _requests: Requests,
        _comm: MPI.Intracomm,
        progress: Progress,
    ) -> dict[str, Family]:
        """The family of the branch."""
        body, chosen = closed_body.infinite_tube(parameters.force), parameters.material

        def make(level: int) -> EquilibriumBranch:
            progress("branch", level, numerics.levels)
            return branch_of(body, chosen, "lam2", parameters.lam_end, numerics.step)

        return {"primary": BranchFamily(make, numerics.levels, ORDER, across=("p", "lam2"))}

    def solve(
        self,
        parameters: InfiniteTubeParameters,
        numerics: PointNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Solve for the branch, its limit points, and the Maxwell pressure if there is one."""
        result = super().solve(parameters, numerics, requests, comm, progress)
        body = closed_body.infinite_tube(parameters.force)
        found = maxwell_states(body, parameters.material, result.branches[0].columns)
        result.quantities.update(found)
        return result


class HomogeneousParameters(MaterialChoice):
    """A test piece and its law."""

    loading: Literal["uniaxial", "equibiaxial", "pure_shear"] = Field("uniaxial", description="loading")
    lam_end: float = Field(
        4.0, gt=0.05, le=50, description="stretch at which the test ends; below 1: compression"
    )


class Homogeneous(ClosedProblem):
    """Uniaxial, equibiaxial and pure-shear tests of any law."""

    name: ClassVar[str] = "homogeneous"
    title: ClassVar[str] = "Test pieces of any material law: uniaxial, equibiaxial, pure shear"
    energy: ClassVar[str] = (
        "Pi = w(lam1, lam2) - T lam1 (uniaxial), w(lam, lam) - 2 T lam (equibiaxial), w(lam, 1) - T lam "
        "(pure shear)"
    )
    scales: ClassVar[dict[str, str]] = {
        "T": "nominal stress over S, the model's stress",
        "lam": "stretch along the load",
        "lam2": "the other stretch of the sheet",
        "Pi": "potential per reference volume over S",
    }
    parameters = HomogeneousParameters
    columns = ("T", "lam", "lam1", "lam2", "lam_across", "Pi", *DIAGNOSTICS)
    derived = ("lam1", "lam2")
    special_points = ("limit_point", "bifurcation_point")
    control: ClassVar[str] = "T (past a limit point compare over lam)"

    def check(self, parameters: HomogeneousParameters, requests: Requests) -> None:
        """Refuse stretches that the law does not reach."""
        check_requests(self, requests)
        if parameters.lam_end == 1:
            raise InputError("homogeneous: lam_end = 1 is the state of rest; allowed: below or above 1")
        end = parameters.lam_end
        across = {"uniaxial": None, "equibiaxial": end, "pure_shear": 1.0}[parameters.loading]
        if across is None:
            chosen = parameters.material
            across = float(chosen.material.width(end, **dict(chosen.constants)))
        require_defined(self.name, parameters, end, across, "lam_end")

    def families(
        self,
        parameters: HomogeneousParameters,
        numerics: PointNumerics,
        _requests: Requests,
        _comm: MPI.Intracomm,
        progress: Progress,
    ) -> dict[str, Family]:
        """The family of the curve."""
        body, chosen = closed_body.coupon(parameters.loading), parameters.material

        def make(level: int) -> EquilibriumBranch:
            progress("branch", level, numerics.levels)
            return branch_of(body, chosen, "lam", parameters.lam_end, numerics.step)

        return {"primary": BranchFamily(make, numerics.levels, ORDER, across=("T", "lam"))}


registry.add(Sphere())
registry.add(InfiniteTube())
registry.add(Homogeneous())
