"""Problems of bodies that deform homogeneously: ``sphere``, ``infinite_tube``, ``homogeneous``."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.branch_problem import BranchProblem, Family, from_rest
from weakforms.problems.homogeneous import body as closed_body
from weakforms.problems.homogeneous.about import HOMOGENEOUS, INFINITE_TUBE, SPHERE
from weakforms.problems.homogeneous.body import Body, system_of
from weakforms.problems.homogeneous.material import require_borne, require_reachable
from weakforms.problems.homogeneous.maxwell import maxwell_states
from weakforms.problems.material_choice import Chosen, MaterialChoice
from weakforms.problems.problem import End, Needs, Numerics, Requests, Task
from weakforms.results import Result
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.line import CriticalLine, fold_line
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.uncertainty.family import BranchFamily

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


class ClosedProblem(BranchProblem):
    """Base class of these problems: one branch from rest to an end."""

    numerics = PointNumerics

    def points(self, _parameters: MaterialChoice) -> np.ndarray:
        """One point, because fields are constant."""
        return np.array([0.5])


def branch_of(body: Body, chosen: Chosen, along: str, end: float, step: float) -> EquilibriumBranch:
    """Equilibria from the state of rest, by arc length, until a column passes its end."""
    system = system_of(body, chosen)
    begin = None
    if body.force:
        begin = under_force(system, system.initial, body.unknowns[0], body.force, step)
    return from_rest(system, body.load, along, end, step, begin, USUAL)


def under_force(system: System, rest: State, along: str, force: float, step: float) -> State:
    """The state under an axial force alone, reached from rest in steps, so that it is not inside out.

    Args:
        system: The equilibrium equations, with a load ``force``.
        rest: The state of rest.
        along: The stretch that grows with the force.
        force: The force.
        step: Largest step.

    Raises:
        ConvergenceError: If the force is not reached.
    """
    control = StepControl(first=step / 4, largest=step, usual_load=USUAL)
    continuation = Continuation(ExtendedNewton(system, ["force"]), control=control)
    sign = 1.0 if force > 0 else -1.0
    start = continuation.start(rest, Held("force", 0.0), towards={along: sign})
    pulled = EquilibriumBranch(
        continuation, "force", start, lambda point: sign * (point.state.loads["force"] - force) > 0
    )
    if pulled.stalled:
        raise ConvergenceError(f"force = {force:g} is not reached from rest: {pulled.stalled}")
    return pulled.at("force", force).state


def fold_line_of(
    body: Body, chosen: Chosen, vary: str, to: float, lam_end: float, step: float
) -> CriticalLine:
    """The first limit point, followed in a constant of the law until it returns or reaches an end.

    Raises:
        InputError: If there is no limit point to start from.
    """
    system = system_of(body, chosen, vary)
    along = body.unknowns[0]
    branch = from_rest(system, body.load, along, lam_end, step)
    if not len(branch.turns()):
        raise InputError(f"no limit point up to {along} = {lam_end:g}: no line of them starts there")
    begin = branch.points[0].state.loads[vary]
    size = abs(to - begin)
    largest = min(max(step, size / 50), size / 4)  # constants have different sizes
    steps = StepControl(first=largest / 8, largest=largest)
    low, high = min(begin, to), max(begin, to)

    def stop(point: CurvePoint) -> bool:
        return not low < point.state.loads[vary] < high or point.monitors[along] > lam_end

    return fold_line(branch, vary, float(np.sign(to - begin)), steps, stop)


class SphereParameters(MaterialChoice):
    """A balloon, and the constant in which its limit point is followed."""

    needs: ClassVar[Needs] = {"vary_end": [{"vary": ()}]}
    movable: ClassVar = {"lam_end": "le"}

    lam_end: float = Field(4.0, gt=1.001, le=50, description="stretch at which inflation ends")
    vary: str = Field(
        "", description="constant of the model over which the limit point is followed; '': none"
    )
    vary_end: float | None = Field(None, description="value of that constant at which the fold line ends")


class Sphere(ClosedProblem):
    """Inflation of a spherical balloon of any law."""

    about = SPHERE
    parameters = SphereParameters

    def check(self, parameters: SphereParameters, requests: Requests) -> None:
        """Refuse stretches that the law does not reach, and fold lines in constants that it does not have.

        Raises:
            InputError: With a message that says what is allowed.
        """
        super().check(parameters, requests)
        require_reachable(self.name, parameters, parameters.lam_end, parameters.lam_end, "lam_end")
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

    def ends(self, parameters: SphereParameters, branch: str) -> list[End]:
        """The largest stretch; of the fold line also the ends of its constant."""
        stretch = End("lam_end", "lam", parameters.lam_end, largest=branch == "primary")
        if branch == "primary":
            return [stretch]
        begin = dict(parameters.material.constants).get(parameters.vary)
        start = End("start", parameters.vary, begin, "the line returns to where it starts")
        return [End("vary_end", parameters.vary, parameters.vary_end), stretch, start]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch and, if a constant varies, the fold line of its limit points."""
        parameters, numerics, progress = task.parameters, task.numerics, task.progress
        body, chosen, step = closed_body.sphere(), parameters.material, numerics.step

        def make(level: int) -> EquilibriumBranch:
            progress("branch", level, numerics.levels)
            return branch_of(body, chosen, "lam", parameters.lam_end, step)

        found = {"primary": BranchFamily(make, numerics.levels, ORDER, across=("P", "lam"))}
        if parameters.vary:

            def line(level: int) -> CriticalLine:
                progress("fold", level, numerics.levels)
                ends = parameters.vary_end, parameters.lam_end
                return fold_line_of(body, chosen, parameters.vary, *ends, step)

            across = (parameters.vary, "lam")
            found["fold"] = BranchFamily(line, numerics.levels, ORDER, across=across, name="fold")
        return found


class InfiniteTubeParameters(MaterialChoice):
    """A long tube with closed ends."""

    movable: ClassVar = {"lam_end": "le"}

    force: float = Field(0.0, ge=-5, le=100, description="axial force of the ends over 2 pi R_o h_o S")
    lam_end: float = Field(6.0, gt=1.001, le=50, description="hoop stretch at which inflation ends")


class InfiniteTube(ClosedProblem):
    """Uniform inflation of a long tube: limit pressure, and the pressure at which two states coexist."""

    about = INFINITE_TUBE
    parameters = InfiniteTubeParameters

    def check(self, parameters: InfiniteTubeParameters, requests: Requests) -> None:
        """Refuse stretches that the law does not reach, and forces that it does not bear."""
        super().check(parameters, requests)
        require_reachable(self.name, parameters, 1.0, parameters.lam_end, "1, lam_end")
        require_borne(self.name, parameters.material, parameters.force)

    def ends(self, parameters: InfiniteTubeParameters, _branch: str) -> list[End]:
        """The largest hoop stretch."""
        return [End("lam_end", "lam2", parameters.lam_end, largest=True)]

    def families(self, task: Task) -> dict[str, Family]:
        """The family of the branch."""
        parameters, numerics, progress = task.parameters, task.numerics, task.progress
        body, chosen = closed_body.infinite_tube(parameters.force), parameters.material

        def make(level: int) -> EquilibriumBranch:
            progress("branch", level, numerics.levels)
            return branch_of(body, chosen, "lam2", parameters.lam_end, numerics.step)

        return {"primary": BranchFamily(make, numerics.levels, ORDER, across=("p", "lam2"))}

    def fill(self, result: Result, task: Task) -> None:
        """Solve for the branch, its limit points, and the Maxwell pressure if there is one."""
        super().fill(result, task)
        body = closed_body.infinite_tube(task.parameters.force)
        result.quantities.update(maxwell_states(body, task.parameters.material, result.branches[0].columns))


class HomogeneousParameters(MaterialChoice):
    """A test piece and its law."""

    movable: ClassVar = {"lam_end": "le"}

    loading: Literal["uniaxial", "equibiaxial", "pure_shear"] = Field("uniaxial", description="loading")
    lam_end: float = Field(
        4.0, gt=0.05, le=50, description="stretch at which the test ends; below 1: compression"
    )


class Homogeneous(ClosedProblem):
    """Uniaxial, equibiaxial and pure-shear tests of any law."""

    about = HOMOGENEOUS
    parameters = HomogeneousParameters

    def check(self, parameters: HomogeneousParameters, requests: Requests) -> None:
        """Refuse stretches that the law does not reach."""
        super().check(parameters, requests)
        if parameters.lam_end == 1:
            raise InputError("homogeneous: lam_end = 1 is the state of rest; allowed: below or above 1")
        end = parameters.lam_end
        across = {"uniaxial": None, "equibiaxial": end, "pure_shear": 1.0}[parameters.loading]
        if across is None:
            chosen = parameters.material
            across = float(chosen.material.width(end, **dict(chosen.constants)))
        require_reachable(self.name, parameters, end, across, "lam_end")

    def ends(self, parameters: HomogeneousParameters, _branch: str) -> list[End]:
        """The last stretch."""
        return [End("lam_end", "lam", parameters.lam_end, largest=parameters.lam_end > 1)]

    def families(self, task: Task) -> dict[str, Family]:
        """The family of the curve."""
        parameters, numerics, progress = task.parameters, task.numerics, task.progress
        body, chosen = closed_body.coupon(parameters.loading), parameters.material

        def make(level: int) -> EquilibriumBranch:
            progress("branch", level, numerics.levels)
            return branch_of(body, chosen, "lam", parameters.lam_end, numerics.step)

        return {"primary": BranchFamily(make, numerics.levels, ORDER, across=("T", "lam"))}
