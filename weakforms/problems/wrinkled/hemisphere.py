"""Problem ``hemisphere`` (Paper 5): a membrane that hangs from its equator and holds a liquid.

Patil, Nordmark & Eriksson (2016), J. Mech. Phys. Solids 94, 298-315. Lengths are divided by the radius
``Ao``, energies by ``2 pi C1 h Ao^2``; ``t`` in ``[0, pi/2]`` is the reference angle from the pole, heights
are measured upwards from the plane of the equator, so that the level ``zw`` is negative.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import InputError
from weakforms.problems.branch_problem import Family, PathProblem
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.problem import Progress, Requests, check_requests, registry
from weakforms.problems.wrinkled.body import HEMISPHERE
from weakforms.problems.wrinkled.branch import WrinkledBranch
from weakforms.problems.wrinkled.fitted import Membrane
from weakforms.problems.wrinkled.problem import PAPER_GAMMA, SCALES, WrinkledNumerics
from weakforms.problems.wrinkled.readings import Readings
from weakforms.problems.wrinkled.waves.numbers import WaveNumbers
from weakforms.results import Result
from weakforms.solvers.continuation.branch import SolutionCurve
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.equilibrium import constraints as fixed

SOURCE = "Patil, Nordmark & Eriksson (2016), J. Mech. Phys. Solids 94, 298-315"

GAMMA = 100 * PAPER_GAMMA
"""The paper's weight of the liquid: ten times the cylinder's radius, with all other data the same."""

START = -0.8
"""Level at which the trace starts, in a stable range."""

LOWEST_LEVEL, LOW_END = -1.18, -1.1
"""Lowest level that can be requested, and default level at which the branch starts. The empty sheet can hang
as a cone of depth ``sqrt(pi^2/4 - 1) = 1.2114``, whose taut zone is a point at the pole."""

NEAR_FRONTS = (0.004, 0.02, 0.08)
"""Distances from fronts, in ``Ao``, within which cells are smaller."""

SHARED_SCALES = (
    *("c2", "C1", "gw_max", "gw_min", "n", "beta", "direction", "meridional", "circumferential", "normal"),
    *("lam1", "lam2", "gw", "tension", "axial", "eigenvalue_1"),
)
"""Scales that are the same as for the cylinder."""

HEMISPHERE_SCALES = {
    **{name: SCALES[name] for name in SHARED_SCALES},
    "length": "Ao, radius of the undeformed hemisphere",
    "gamma": "rho g Ao^2/(C1 h)",
    "zw": "level of the liquid above the equator's plane over Ao: negative",
    "low_end": "level at which the branch starts",
    "past": "decrease of the level below its maximum at the end of the branch",
    "t": "angle from the pole in the reference, rad",
    "t_front_1": "front 1 from the pole (and so on): reference angle where gw = 1",
    "t_level": "reference angle at the level of the liquid",
    "z_pole": "height of the pole over Ao",
    "lam_pole": "stretch at the pole, 1",
    "V": "volume between the membrane and the equator's plane over 2 pi Ao^3",
    "Pi": "total potential over 2 pi C1 h Ao^2",
    "N": "meridional tension per reference angle around the axis at the equator over C1 h Ao",
    "r_max": "largest radius over Ao",
    "wrinkled_fraction": "fraction of the meridian's reference length with gw < 1",
    "state": "state of the zone that opens or closes: 1 taut, -1 wrinkled",
    "r": "deformed radius over Ao",
    "z": "height over Ao",
    "Lambda": "Lambda_nN_k: k-th lowest eigenvalue for N waves, d2Pi = Lambda M, M = int H R |dx|^2, over "
    "C1/(rho_m Ao^2)",
}

ENERGY = (
    "Pi/(2 pi C1 h Ao^2) = int_0^{pi/2} [ R W - Phi r r' ] dt,  R = sin t,  Phi = gamma max(zw - z, 0)^2/2;  "
    "W = w(lam1, lam2) where gw = lam2 sqrt(lam1) > 1, else w(lam1, lam1^(-1/2));  "
    "w = I1 - 3 + c2 (I2 - 3) or of another model (its S for C1),  lam1 = sqrt(r'^2 + z'^2),  lam2 = r/R"
)


class HemisphereNumerics(WrinkledNumerics):
    """Meshes of the meridian: ``cells`` in each block of the finest one."""

    step: float = Field(0.08, ge=0.005, le=0.2, description="largest arc-length step")


class HemisphereParameters(MaterialChoice):
    """The membrane and its liquid."""

    ratio: ClassVar[str] = "c2"

    gamma: float = Field(GAMMA, ge=1, le=8, description="weight of the liquid")
    c2: float = Field(
        0.0, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean, as in the paper"
    )
    n: WaveNumbers = Field((), description="wave numbers for which stability is computed, such as 10,50")
    beta: float = Field(
        0.0, ge=0, le=1, description="additional bending stiffness against waves, over C1 h Ao^2"
    )
    low_end: float = Field(LOW_END, ge=LOWEST_LEVEL, le=START, description="level at which the branch starts")

    past: float = Field(
        0.01, ge=0.002, le=0.3, description="decrease of the level below its maximum at the end of the branch"
    )


class HemisphereBranch(WrinkledBranch):
    """Branch from a low level through the highest one, a limit point, to an end shortly after it."""

    def _start(self, continuation: Continuation) -> CurvePoint:
        """The low end, reached along the branch from a level at which the membrane is easy to solve for."""
        low = self.low_end
        state = self.membrane.by_gas(START)
        begin = continuation.start(state, fixed.Held(self.control, START), towards={self.control: -1.0})
        way = SolutionCurve(continuation, self.control, begin, lambda p: p.state.loads[self.control] < low)
        lowest = way.at(self.control, low) if low < START else way.points[0]
        return continuation.start(lowest.state, fixed.Held(self.control, low), towards={self.control: 1.0})

    low_end = LOW_END
    """Level at which the branch starts."""
    past = 0.01
    """Decrease of the level below its maximum at the end of the branch."""

    def _is_past_limit(self, load: float, peak: float) -> bool:
        """Whether the load has decreased so far."""
        return load < peak - self.past


class Hemisphere(PathProblem):
    """A hemisphere of uniform thickness, clamped at its equator, under the liquid in it."""

    name: ClassVar[str] = "hemisphere"
    title: ClassVar[str] = "Wrinkling and stability of a hemispherical membrane that holds a liquid"
    paper: ClassVar[int] = 5
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = HEMISPHERE_SCALES
    parameters = HemisphereParameters
    numerics = HemisphereNumerics
    columns = (
        "zw",
        "V",
        "Pi",
        "N",
        "z_pole",
        "lam_pole",
        "t_level",
        "wrinkled_fraction",
        "r_max",
        "gw_max",
        "gw_min",
        "n_negative",
        "residual",
        "iterations",
    )
    derived = ("wrinkled_fraction", "r_max", "gw_max", "gw_min", "t_level")
    special_points = ("limit_point", "zone_opening", "zone_closing", "stability_change", "front")
    branches = ("primary",)
    control: ClassVar[str] = (
        "zw, from low levels up to its maximum; past that compare over V, which increases"
    )

    def check(self, parameters: HemisphereParameters, requests: Requests) -> None:
        """Refuse wrong combinations of parameters and requests.

        Raises:
            InputError: For a state that cannot exist.
        """
        check_requests(self, requests)
        require_foldable(self.name, parameters, bool(parameters.n))
        for wanted in requests.states:
            if wanted.name == "front":
                raise InputError(
                    "hemisphere: a front cannot be requested; request a state, which has its fronts"
                )
            if wanted.name == "zw" and not LOWEST_LEVEL <= wanted.value < 0:
                raise InputError(
                    f"hemisphere: zw = {wanted.value:g}; allowed: from {LOWEST_LEVEL} to below 0, the equator"
                )

    def families(
        self,
        parameters: HemisphereParameters,
        numerics: HemisphereNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        _progress: Progress,
    ) -> dict[str, Family]:
        """The branch on all meshes."""
        membrane = hemisphere_membrane(parameters, numerics, comm)
        readings = Readings(membrane, 2 * numerics.degree, parameters.n, "t", parameters.beta)
        branch = HemisphereBranch(membrane, 0.0, math.inf, numerics.step, readings)
        lower = [r.value for r in requests.states if r.name == "zw"]
        branch.low_end, branch.past = min([parameters.low_end, *lower]), parameters.past
        return {"primary": branch}

    def points(self, _parameters: HemisphereParameters) -> np.ndarray:
        """81 points from the pole to the equator."""
        return np.linspace(0.0, math.pi / 2, 81)

    def _answer(self, result: Result, families: dict[str, Family], *rest: Any) -> None:
        super()._answer(result, families, *rest)
        result.special_points.extend(families["primary"].fronts)


def hemisphere_membrane(
    parameters: HemisphereParameters, numerics: HemisphereNumerics, comm: MPI.Intracomm
) -> Membrane:
    """The membrane for given parameters, for solving for single states."""
    values = {"c2": parameters.c2, "gamma": parameters.gamma}
    near = NEAR_FRONTS if parameters.n else ()
    kind = "relaxed", near, parameters.other_law
    return Membrane(comm, HEMISPHERE, values, True, numerics.meshes, numerics.degree, *kind)


registry.add(Hemisphere())
