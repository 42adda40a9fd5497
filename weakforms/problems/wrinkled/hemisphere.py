"""Problem ``hemisphere`` (Paper 5): a membrane that hangs from its equator and holds a liquid or a gas.

Patil, Nordmark & Eriksson (2016), J. Mech. Phys. Solids 94, 298-315. Lengths are divided by the radius
``Ao``, energies by ``2 pi C1 h Ao^2``; ``t`` in ``[0, pi/2]`` is the reference angle from the pole, heights
are measured upwards from the plane of the equator, so that the level ``zw`` is negative.

Under gas the hemisphere is taut at every pressure. Its middle becomes a part of a larger sphere; the equator
does not grow, so that there is a layer of width ``sqrt(p/12)`` at small pressures ``p``, in which the
meridional tension bends the meridian outwards.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import Field, model_validator

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.branch_problem import BranchProblem, Family
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.meridian.limits import relative_stiffness
from weakforms.problems.meridian.thickness import Thickness, require_thickness, text_over
from weakforms.problems.problem import End, Needs, Requests, Task
from weakforms.problems.wave_numbers import WaveNumbers, eigenvalue_names, require_waves
from weakforms.problems.wrinkled import body
from weakforms.problems.wrinkled.about import HEMISPHERE
from weakforms.problems.wrinkled.branch import WrinkledBranch
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.problem import LOAD, PAPER_GAMMA, TREATMENT, Energy, WrinkledNumerics
from weakforms.problems.wrinkled.readings import Readings
from weakforms.results import Result
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.equilibrium import constraints as fixed
from weakforms.solvers.equilibrium.state import State

GAMMA = 100 * PAPER_GAMMA
"""The paper's weight of the liquid: ten times the cylinder's radius, with all other data the same."""

START, GAS_EASY = -0.8, 0.5
"""Level, and gas pressure, at which the trace starts, in a stable range."""

LOWER = -0.9, -1.0, -1.1
"""Levels at which the trace of a heavier liquid starts, which has no state at the level above."""

COMPRESSED = -0.9
"""Lowest level of the full energy. Below it most of the membrane is compressed, where it has no stiffness."""

HANGING = 1.0, 8.0
"""Smallest and largest weight of the liquid for a neo-Hookean law with ``C1 = 1``. A lighter one hardly
stretches the membrane; a heavier one has states at the lowest levels only."""

LOWEST_LEVEL, LOW_END = -1.18, -1.1
"""Lowest level that can be requested, and default level at which the branch starts. The empty sheet can hang
as a cone of depth ``sqrt(pi^2/4 - 1) = 1.2114``, whose taut zone is a point at the pole."""

GAS_START, GAS_LEAST = 0.01, 0.002
"""Gas pressure at which the branch starts, and the lowest one that can be requested: then the layer at the
equator is as wide as a cell of the coarsest mesh there."""

ALLOWED = {"zw": (LOWEST_LEVEL, 0.0, ", the equator"), "p": (GAS_LEAST, 100.0, "")}
"""Loads that can be requested, and what is at their upper bound."""

NEAR_FRONTS = (0.004, 0.02, 0.08)
"""Distances from fronts, in ``Ao``, within which cells are smaller."""


class HemisphereNumerics(WrinkledNumerics):
    """Meshes of the meridian: ``cells`` in each block of the finest one."""

    step: float = Field(0.08, ge=0.005, le=0.2, description="largest arc-length step")


class HemisphereParameters(MaterialChoice):
    """The membrane and its liquid or gas."""

    ratio: ClassVar[str] = "c2"
    needs: ClassVar[Needs] = {
        "beta": [{"n": ()}],
        "gamma": [{"load": ("fluid",)}],
        "low_end": [{"load": ("fluid",)}],
        "load_end": [{"load": ("gas",)}],
        "volume_end": [{"load": ("gas",)}],
    }

    load: Literal["fluid", "gas"] = Field("fluid", description="fluid or gas in the membrane")
    gamma: float = Field(GAMMA, ge=1, le=8, description="weight of the liquid")
    c2: float = Field(
        0.0, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean, as in the paper"
    )
    thickness: text_over("t") = Field(  # type: ignore[valid-type]
        None, description="thickness over h by the angle t from the pole, such as '1 + 0.2*cos(2*t)'"
    )
    energy: Energy = Field("relaxed", description=TREATMENT)
    n: WaveNumbers = Field((), description="wave numbers for which stability is computed, such as 10,50")
    beta: float = Field(
        0.0, ge=0, le=1, description="additional bending stiffness against waves, over C1 h Ao^2"
    )
    low_end: float = Field(
        LOW_END,
        ge=LOWEST_LEVEL,
        le=START,
        description=f"level at which the branch starts ({COMPRESSED:g} if energy = standard)",
    )
    past: float = Field(
        0.01, ge=0.002, le=0.3, description="decrease of the load below its maximum at the end of the branch"
    )
    load_end: float = Field(
        10.0, gt=GAS_START, le=100, description="gas pressure at which the branch ends at the latest"
    )
    volume_end: float = Field(
        30.0, gt=1, le=1000, description="volume over the first one at which the branch ends at the latest"
    )

    @model_validator(mode="before")
    @classmethod
    def _above_compression(cls, given: Any) -> Any:
        """Start the full energy where it has states, unless a level is given."""
        if isinstance(given, dict) and given.get("energy") == "standard" and given.get("load") != "gas":
            return {"low_end": COMPRESSED} | given
        return given

    @property
    def control(self) -> str:
        """Name of the load."""
        return LOAD[self.load]

    @property
    def own_thickness(self) -> Thickness | None:
        """The thickness, if it is given as text."""
        return None if self.thickness is None else Thickness(self.thickness, "t")


class HemisphereBranch(WrinkledBranch):
    """Branch from a low load through the highest one, a limit point, to an end shortly after it."""

    def _start(self, continuation: Continuation) -> CurvePoint:
        """The low end, reached along the branch from a level at which the membrane is easy to solve for.

        Raises:
            AbsentError: If the highest level, a limit point, is below it.
            ConvergenceError: If no state is found, or the way to it ends early.
        """
        low, (state, easy) = self.low_end, self._easy()
        if low == easy:
            return continuation.start(state, fixed.Held(self.control, low), towards={self.control: 1.0})
        way = self._way(continuation, state, easy, low)
        lowest = way.at(self.control, low).state
        return continuation.start(lowest, fixed.Held(self.control, low), towards={self.control: 1.0})

    def follow(self) -> None:
        """Trace it now.

        Raises:
            AbsentError: If it is not there.
            ConvergenceError: If it is not found.
        """
        self.trace  # noqa: B018

    def _easy(self) -> tuple[State, float]:
        """A state of the plain mesh, and its load."""
        first, *more = (START, *LOWER) if self.membrane.liquid else (GAS_EASY * self.stiffness,)
        try:
            return self.membrane.by_gas(first, self.stiffness), first
        except ConvergenceError as error:
            for level in more:
                with suppress(ConvergenceError):
                    return self.membrane.by_gas(level, self.stiffness), level
            raise ConvergenceError(f"{error}; choose a smaller gamma") from error

    def _way(self, continuation: Continuation, state: State, easy: float, low: float) -> SolutionCurve:
        """The branch from a load to another one."""
        sign = 1.0 if low > easy else -1.0

        def beyond(point: CurvePoint) -> bool:
            return (
                sign * (point.state.loads[self.control] - low) > 0
                or point.tangent.loads[self.control] * sign < 0
            )

        begin = continuation.start(state, fixed.Held(self.control, easy), towards={self.control: sign})
        way = SolutionCurve(continuation, self.control, begin, beyond)
        reached = max(sign * point.state.loads[self.control] for point in way.points)
        if reached < sign * low and way.stalled:
            raise ConvergenceError(f"{self.control} = {low:g} is not reached: {way.stalled}")
        if reached < sign * low:
            searched = f"the highest level is near {sign * reached:.4g}, below low_end = {low:g}"
            raise AbsentError("branch primary", f"hemisphere: {searched}; lower low_end or gamma")
        return way

    low_end = LOW_END
    """Load at which the branch starts."""
    stiffness = 1.0
    """Of the law, relative to a neo-Hookean one with ``C1 = 1``."""
    past = 0.01
    """Decrease of the load below its maximum at the end of the branch."""

    def _is_past_limit(self, point: CurvePoint, peak: float) -> bool:
        """Whether the load has decreased so far."""
        return point.state.loads[self.control] < peak - self.past


class Hemisphere(BranchProblem):
    """A hemisphere, clamped at its equator, under the liquid or gas in it."""

    about = HEMISPHERE
    parameters = HemisphereParameters
    numerics = HemisphereNumerics

    def check(self, parameters: HemisphereParameters, requests: Requests) -> None:
        """Refuse wrong combinations of parameters and requests.

        Raises:
            InputError: For a state that cannot exist.
        """
        require_waves(self.name, parameters.n, (wanted.name for wanted in requests.states))
        super().check(parameters, requests)
        what = f"{self.name}: waves around the axis" if parameters.n else self.name
        require_foldable(what, parameters, invariants=bool(parameters.n))
        require_thickness(self.name, parameters.own_thickness, math.pi / 2)
        _require_hanging(parameters, [wanted.value for wanted in requests.states if wanted.name == "zw"])
        load = parameters.control
        least, most, what = ALLOWED[load]
        for wanted in requests.states:
            if wanted.name in LOAD.values() and wanted.name != load:
                raise InputError(
                    f"hemisphere: with load = {parameters.load!r} there is no {wanted.name}; "
                    f"the load is {load}"
                )
            if wanted.name == "front":
                raise InputError(
                    "hemisphere: a front cannot be requested; request a state, which has its fronts"
                )
            if wanted.name == load and not least <= wanted.value < most:
                raise InputError(
                    f"hemisphere: {load} = {wanted.value:g}; allowed: from {least} to below {most:g}{what}"
                )

    def computed(self, parameters: HemisphereParameters) -> list[str]:
        """The lowest eigenvalues of each wave number."""
        return [name for n in parameters.n for name in eigenvalue_names(n)]

    def ends(self, parameters: HemisphereParameters, _branch: str) -> list[End]:
        """A load a little below the highest one; the equator for a liquid, a pressure or a volume for gas."""
        load = parameters.control
        past = End("past", load, lambda columns: max(columns[load]) - parameters.past)
        if load == "zw":
            return [past, End("full", load, 0.0, "the liquid reaches the equator")]
        return [
            past,
            End("load_end", load, parameters.load_end),
            End("volume_end", "V", lambda columns: parameters.volume_end * columns["V"][0]),
            End("at", load, None, "extended to the states that were asked for"),
        ]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch on all meshes."""
        parameters, numerics, requests, comm = task.parameters, task.numerics, task.requests, task.comm
        membrane = hemisphere_membrane(parameters, numerics, comm)
        readings = Readings(membrane, 2 * numerics.degree, parameters.n, "t", parameters.beta)
        wanted = [r.value for r in requests.states if r.name == parameters.control]
        low, end, volume = parameters.low_end, 0.0, math.inf
        if not membrane.liquid:
            low, end, volume = GAS_START, max([parameters.load_end, *wanted]), parameters.volume_end
        branch = HemisphereBranch(membrane, end, volume, numerics.step, readings)
        branch.low_end, branch.past = min([low, *wanted]), parameters.past
        branch.stiffness = relative_stiffness(parameters.material)
        branch.follow()
        return {"primary": branch}

    def points(self, _parameters: HemisphereParameters) -> np.ndarray:
        """81 points from the pole to the equator."""
        return np.linspace(0.0, math.pi / 2, 81)

    def _answer(self, result: Result, families: dict[str, Family], task: Task) -> None:
        super()._answer(result, families, task)
        result.special_points.extend(families["primary"].fronts)


def _require_hanging(parameters: HemisphereParameters, levels: Sequence[float]) -> None:
    """Refuse a liquid that is too light or too heavy for the law, or too low for the full energy."""
    if parameters.load != "fluid":
        return
    lowest = min([parameters.low_end, *levels])
    if parameters.energy == "standard" and lowest < COMPRESSED:
        raise InputError(
            f"hemisphere: low_end, or a level zw, of {lowest:g}: with energy = 'standard' the membrane below "
            f"{COMPRESSED:g} is mostly compressed and has no stiffness there; raise low_end and zw to "
            f"{COMPRESSED:g}, or choose another energy"
        )
    least, most = (bound * relative_stiffness(parameters.material) for bound in HANGING)
    if not least <= parameters.gamma <= most:
        raise InputError(
            f"hemisphere: gamma = {parameters.gamma:g}: allowed with this stiffness of the law: "
            f"{least:.4g} to {most:.4g}; change gamma or the constants of the law"
        )


def hemisphere_membrane(
    parameters: HemisphereParameters, numerics: HemisphereNumerics, comm: MPI.Intracomm
) -> Membrane:
    """The membrane for given parameters, for solving for single states."""
    liquid = parameters.load == "fluid"
    values = {"c2": parameters.c2, "gamma": parameters.gamma if liquid else 0.0}
    shape = body.hemisphere(parameters.own_thickness)
    near = NEAR_FRONTS if parameters.n else ()
    kind = parameters.energy, near, parameters.other_law
    return Membrane(comm, shape, values, liquid, numerics.meshes, numerics.degree, *kind)
