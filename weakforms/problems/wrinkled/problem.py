"""Problem ``wrinkled_tube`` (Papers 4 and 5).

Patil, Nordmark & Eriksson (2015), Eur. J. Mech. A/Solids 54, 1-10; stability with respect to waves around the
axis: the same authors (2016), J. Mech. Phys. Solids 94, 298-315. Lengths are divided by the undeformed radius
``Ao``, the thickness by its mean ``h``, energies by ``2 pi C1 h Ao^2``; ``Z`` in ``[0, L]`` is the material
coordinate from the lower end.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import BeforeValidator, Field

from weakforms.errors import AbsentError, InputError
from weakforms.problems.branch_problem import BranchProblem, MeshNumerics
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.meridian.pre_stretch import require_bearable, require_carried, require_held
from weakforms.problems.meridian.thickness import Thickness, require_thickness, text_over
from weakforms.problems.problem import End, Needs, Requests, Task
from weakforms.problems.wave_numbers import WaveNumbers, eigenvalue_names, require_waves
from weakforms.problems.wrinkled.about import WRINKLED_TUBE
from weakforms.problems.wrinkled.body import cylinder
from weakforms.problems.wrinkled.branch import PAST_LIMIT, WrinkledBranch
from weakforms.problems.wrinkled.critical import critical_radii
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.readings import Readings
from weakforms.results import Absence, Result
from weakforms.solvers.equilibrium.newton import STOPPING
from weakforms.solvers.uncertainty.refinement import estimate

DENSITY, GRAVITY, RADIUS, THICKNESS, SHEAR = 1000.0, 9.81, 0.010, 0.1e-3, 0.2111e6
"""The paper's data for water, cylinder and ``C1`` in SI units."""

PAPER_GAMMA = DENSITY * GRAVITY * RADIUS**2 / (SHEAR * THICKNESS)
"""Weight of the liquid ``rho g Ao^2/(C1 h)`` with the paper's data."""

LOAD = {"fluid": "zw", "gas": "p"}
LOAD_END = {"fluid": 16.0, "gas": 0.6}
"""Default loads at which branches end."""


LONGEST = 25.0
"""Largest length of a branch. The disks' effect falls exponentially with the distance from them: at the first
loads all of a longer membrane is as near to wrinkling as round-off, and its zones cannot be told."""

WIDEST = 2.0
"""Largest radius of the disks of a branch. Between wider ones the membrane is stretched many times where it
is clamped, and branches turn within steps that no mesh resolves."""


def _radius(most: float) -> Any:
    """The type of the parameter ``Af``: ``critical``, or a positive number, also as text."""

    def known(value: object) -> object:
        if value == "critical":
            return value
        refused = ValueError(f"must be 'critical' or a number above 0 and up to {most:g}")
        try:
            radius = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            raise refused from None
        if not 0 < radius <= most:
            raise refused
        return radius

    return Annotated[Literal["critical"] | Annotated[float, Field(gt=0, le=most)], BeforeValidator(known)]


RADIUS = "radius of the disks: 'critical' (Case 1), or a number above 0, such as 1 (Case 2)"

Energy = Literal["relaxed", "modified_gradient", "standard"]
TREATMENT = "treatment of wrinkling: two forms of the same energy, or none"
"""Parameter ``energy`` and what it says."""

NEAR_FRONTS = (0.02, 0.1, 0.4)
"""Distances from fronts, over Ao, within which cells are smaller for short waves, which decay from the front
into a taut zone over ``1/n``."""


class WrinkledNumerics(MeshNumerics):
    """Meshes of the membrane: ``cells`` in each block of the finest one (there are ten blocks or more)."""

    degree: int = Field(6, ge=2, le=6, description="polynomial degree of the unknowns")
    cells: int = Field(12, ge=4, le=400, description="cells of each block on the finest mesh")
    step: float = Field(0.5, ge=0.01, le=1, description="largest arc-length step")


class WrinkledParameters(MaterialChoice):
    """The membrane, its disks and its load."""

    ratio: ClassVar[str] = "c2"
    needs: ClassVar[Needs] = {"beta": [{"n": ()}]}

    M: float = Field(0.5, gt=0, lt=2, description="thickness at the lower end over its mean")
    thickness: text_over("Z", "L") = Field(  # type: ignore[valid-type]
        None, description="thickness over h by the coordinate Z, such as '1 + 0.4*cos(2*pi*Z/L)'; replaces M"
    )
    delta: float = Field(2.0, gt=1, le=6, description="axial pre-stretch")
    c2: float = Field(0.01, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    L: float = Field(8.0, ge=1, le=40, description="undeformed length L_o/Ao")
    Af: _radius(3.0) = Field("critical", description=RADIUS)  # type: ignore[valid-type]
    load: Literal["fluid", "gas"] = Field("fluid", description="fluid or gas in the membrane")
    gamma: float | None = Field(None, gt=0, le=10, description="weight of the fluid; by default the paper's")
    energy: Energy = Field("relaxed", description=TREATMENT)
    load_end: float | None = Field(None, gt=0, le=100, description="load at which the branch ends")
    n: WaveNumbers = Field((), description="wave numbers for which stability is computed, such as 20,50")
    beta: float = Field(
        0.0,
        ge=0,
        le=1,
        description="additional bending stiffness against waves, over C1 h Ao^2 H^3 (not in the paper)",
    )
    volume_end: float = Field(
        30.0, gt=1, le=1000, description="volume over the unloaded one at which the branch ends at the latest"
    )

    @property
    def control(self) -> str:
        """Name of the load."""
        return LOAD[self.load]

    @property
    def own_thickness(self) -> Thickness | None:
        """The thickness, if it is given as text."""
        return None if self.thickness is None else Thickness(self.thickness, "Z", ("L",))

    def require_carried(self, problem: str) -> None:
        """Refuse a thickness out of range, and pre-stretch or disks for which no force is large enough.

        Raises:
            InputError: With a message that names the parameters.
        """
        own, given = self.own_thickness, "M" in self.model_fields_set
        require_thickness(problem, own, self.L, given, L=self.L)
        require_carried(problem, self.material, self.delta, self.M if own is None else (own, self.L))
        require_held(problem, self.material, self.Af)


class BranchParameters(WrinkledParameters):
    """A membrane whose branch is followed from no load, in the ranges in which this is possible."""

    L: float = Field(8.0, ge=1, le=LONGEST, description="undeformed length L_o/Ao")
    Af: _radius(WIDEST) = Field("critical", description=RADIUS)  # type: ignore[valid-type]


class WrinkledTube(BranchProblem):
    """Pre-stretched cylindrical membrane of non-uniform thickness under fluid or gas."""

    about = WRINKLED_TUBE
    parameters = BranchParameters
    numerics = WrinkledNumerics

    def check(self, parameters: WrinkledParameters, requests: Requests) -> None:
        """Refuse wrong combinations of parameters and requests.

        Raises:
            InputError: For a state that cannot exist, or a load that the membrane does not have.
        """
        require_waves(self.name, parameters.n, (wanted.name for wanted in requests.states))
        super().check(parameters, requests)
        what = f"{self.name}: waves around the axis" if parameters.n else self.name
        require_foldable(what, parameters, invariants=bool(parameters.n))
        delta = parameters.delta
        require_bearable(self.name, parameters.material, delta, delta**-0.5, "delta")
        parameters.require_carried(self.name)
        control = parameters.control
        for wanted in requests.states:
            if wanted.name in LOAD.values() and wanted.name != control:
                raise InputError(
                    f"wrinkled_tube: with load = {parameters.load!r} there is no {wanted.name}; "
                    f"the load is {control}"
                )
            if wanted.name == "front":
                raise InputError(
                    "wrinkled_tube: a front cannot be requested; request a state, which has its fronts"
                )
            if wanted.name == control and wanted.value < 0:
                raise InputError(f"wrinkled_tube: {control} = {wanted.value:g} must be 0 or more")
        if parameters.gamma is not None and parameters.load == "gas":
            raise InputError(
                f"wrinkled_tube: gamma = {parameters.gamma:g} is for a fluid; allowed with load = 'fluid'"
            )

    def computed(self, parameters: WrinkledParameters) -> list[str]:
        """The lowest eigenvalues of each wave number."""
        return [name for n in parameters.n for name in eigenvalue_names(n)]

    def ends(self, parameters: WrinkledParameters, _branch: str) -> list[End]:
        """The last load, or a volume, or a load that has decreased from its highest value."""
        load = parameters.control
        return [
            End("load_end", load, parameters.load_end or LOAD_END[parameters.load]),
            End("volume_end", "V", lambda columns: parameters.volume_end * columns["V"][0]),
            End("past limit", load, lambda columns: PAST_LIMIT * max(columns[load]), "past its limit load"),
            End("at", load, None, "extended to the states that were asked for"),
        ]

    def fill(self, result: Result, task: Task) -> None:
        """Solve for the critical radius, then for the branch and the requested states with fronts."""
        parameters, numerics, requests = task.parameters, task.numerics, task.requests
        comm, progress = task.comm, task.progress
        result.numerics["stopping"] = STOPPING
        progress("critical radius", 0, 1)
        critical = _critical(parameters, numerics, comm)
        # Inside of the meridian a largest value has the order of stretches.
        cap = numerics.degree * (2 if parameters.thickness is None else 1)
        result.quantities["Af_critical"] = estimate(critical, cap).quantity()
        branch = self._branch(parameters, numerics, requests, comm, critical)
        try:
            branch.trace  # noqa: B018
        except AbsentError as error:
            if requests.states:
                raise
            result.absent.append(Absence("branch primary", f"{self.name}: {error}"))
            return
        self._answer(result, {"primary": branch}, task)
        result.special_points.extend(branch.fronts)

    def _branch(
        self,
        parameters: WrinkledParameters,
        numerics: WrinkledNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        critical: Sequence[float],
    ) -> WrinkledBranch:
        wanted = [r.value for r in requests.states if r.name == parameters.control]
        end = max([parameters.load_end or LOAD_END[parameters.load], *wanted])
        membrane = wrinkled_membrane(parameters, numerics, comm, critical)
        readings = Readings(membrane, 2 * numerics.degree, parameters.n, beta=parameters.beta)
        return WrinkledBranch(membrane, end, parameters.volume_end, numerics.step, readings)

    def points(self, parameters: WrinkledParameters) -> np.ndarray:
        """161 points from end to end."""
        return np.linspace(0.0, parameters.L, 161)


def _cylinder(parameters: WrinkledParameters) -> dict[str, float]:
    uneven = {"M": parameters.M} if parameters.thickness is None else {"uneven": 1.0}
    return uneven | {name: getattr(parameters, name) for name in ("delta", "c2", "L")}


def _critical(parameters: WrinkledParameters, numerics: WrinkledNumerics, comm: MPI.Intracomm) -> list[float]:
    mesh = numerics.meshes, numerics.degree
    body = cylinder(parameters.own_thickness)
    return critical_radii(comm, _cylinder(parameters), *mesh, parameters.other_law, body)


def wrinkled_membrane(
    parameters: WrinkledParameters,
    numerics: WrinkledNumerics,
    comm: MPI.Intracomm,
    critical: Sequence[float] | None = None,
) -> Membrane:
    """The membrane for given parameters, for solving for single states.

    Args:
        parameters: Parameters of the problem.
        numerics: Meshes.
        comm: Ranks.
        critical: The critical radius on each mesh, if it is known already.
    """
    values: dict[str, Any] = _cylinder(parameters)
    radii: Sequence[float] = ()
    if parameters.Af != "critical":
        values["Af"] = parameters.Af
    else:
        radii = critical or _critical(parameters, numerics, comm)
        values["Af"] = radii[-1]
    liquid = parameters.load == "fluid"
    if liquid:
        values["gamma"] = parameters.gamma or PAPER_GAMMA
    near = NEAR_FRONTS if parameters.n else ()
    kind = parameters.energy, near, parameters.other_law
    mesh = numerics.meshes, numerics.degree
    membrane = Membrane(comm, cylinder(parameters.own_thickness), values, liquid, *mesh, *kind)
    for own, radius in zip(membrane.on_meshes, radii, strict=False):
        own["Af"] = radius
    return membrane
