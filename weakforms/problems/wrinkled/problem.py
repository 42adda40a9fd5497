"""Problem ``wrinkled_tube`` (Papers 4 and 5).

Patil, Nordmark & Eriksson (2015), Eur. J. Mech. A/Solids 54, 1-10; stability with respect to waves around the
axis: the same authors (2016), J. Mech. Phys. Solids 94, 298-315. Lengths are divided by the undeformed radius
``Ao``, the thickness by its mean ``h``, energies by ``2 pi C1 h Ao^2``; ``Z`` in ``[0, L]`` is the material
coordinate from the lower end.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import BeforeValidator, Field

from weakforms.errors import InputError
from weakforms.problems.branch_problem import Family, MeshNumerics, PathProblem
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.problem import Progress, Requests, check_requests, registry, silent
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.branch import WrinkledBranch
from weakforms.problems.wrinkled.critical import critical_radii
from weakforms.problems.wrinkled.fitted import Membrane
from weakforms.problems.wrinkled.readings import Readings
from weakforms.problems.wrinkled.waves.numbers import WaveNumbers
from weakforms.results import Quantity, Result
from weakforms.solvers.support.provenance import provenance
from weakforms.solvers.uncertainty.refinement import Estimate, estimate

SOURCE = "Patil, Nordmark & Eriksson (2015), Eur. J. Mech. A/Solids 54, 1-10"

DENSITY, GRAVITY, RADIUS, THICKNESS, SHEAR = 1000.0, 9.81, 0.010, 0.1e-3, 0.2111e6
"""The paper's data for water, cylinder and ``C1`` in SI units."""

PAPER_GAMMA = DENSITY * GRAVITY * RADIUS**2 / (SHEAR * THICKNESS)
"""Weight of the liquid ``rho g Ao^2/(C1 h)`` with the paper's data."""

LOAD = {"fluid": "zw", "gas": "p"}
LOAD_END = {"fluid": 16.0, "gas": 0.6}
"""Default loads at which branches end."""

SCALES = {
    "length": "Ao, undeformed radius",
    "M": "thickness at the lower end over its mean h (2 - M at the upper end)",
    "M_taut": "thickness ratio M up to which, from 1 on, the unloaded membrane is taut: it wrinkles at none",
    "delta": "axial pre-stretch L_f/L_o",
    "c2": "C2/C1",
    "C1": "for another model the stress S by which its constants are divided (weakforms show material)",
    "L": "L_o/Ao",
    "Af": "radius of the disks over Ao",
    "gamma": "rho g Ao^2/(C1 h)",
    "zw": "level of the fluid above the lower end over Ao",
    "p": "P Ao/(C1 h)",
    "V": "enclosed volume over 2 pi Ao^3",
    "Pi": "total potential over 2 pi C1 h Ao^2",
    "r_max": "largest radius over Ao, the disks included",
    "N": "meridional tension per undeformed hoop length at Z = 0 over C1 h",
    "gw_max": "largest value of the wrinkling function lam2 sqrt(lam1); taut above 1",
    "gw_min": "smallest value of the wrinkling function",
    "wrinkled_fraction": "fraction of the material length with gw < 1",
    "Z": "material coordinate from the lower end over Ao",
    "Z_front_1": "front 1 from the lower end (and so on): material coordinate where gw = 1",
    "state": "state of the zone that opens or closes: 1 taut, -1 wrinkled",
    "r": "deformed radius over Ao",
    "z": "height above the lower end over Ao",
    "lam1": "meridional stretch, 1",
    "lam2": "hoop stretch, 1",
    "gw": "wrinkling function, 1",
    "tension": "meridional tension per undeformed hoop length over C1 h",
    "axial": "N cos(phi) - P r^2/2 over C1 h: constant under gas, and above the fluid",
    "slope": "dr/dz of the meridian",
    "eigenvalue_1": "lowest eigenvalue of the second variation at fixed load, axisymmetric, against the mass",
    "n": "waves around the axis",
    "beta": "bending stiffness over H^3 and C1 h Ao^2: (2/3)(1 + c2)(h/Ao)^2 for an isotropic sheet",
    "direction": "of a change of stability: 1 if waves appear there along the branch, -1 if they disappear",
    "Lambda": "Lambda_nN_k: k-th lowest eigenvalue for N waves, d2Pi = Lambda M, M = int H R |dx|^2, over "
    "C1/(rho_m Ao^2)",
    "meridional": "mode along the meridian, int H R |dx|^2 dS = 1",
    "circumferential": "mode around the axis (a length)",
    "normal": "mode along the outward normal",
    "Af_critical": "largest radius of the disks with gw <= 1 everywhere at zero load, over Ao",
}

ENERGY = (
    "Pi/(2 pi C1 h Ao^2) = int_0^L [ eta W - P r^2 z'/2 ] ds,  eta = M + 2 (1 - M) s/L,  "
    "P = p or gamma max(zw - z, 0);  W = w(lam1, lam2) where gw = lam2 sqrt(lam1) > 1, else "
    "w(lam1, lam1^(-1/2)) = lam1^2 + 2/lam1 - 3 + c2 (2 lam1 + 1/lam1^2 - 3);  "
    "w = I1 - 3 + c2 (I2 - 3) or of another model (its S for C1),  lam1 = sqrt(r'^2 + z'^2),  lam2 = r"
)


def _radius(value: object) -> object:
    """``critical``, or a positive number, also as text."""
    if value == "critical":
        return value
    try:
        radius = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise ValueError("must be 'critical' or a number above 0 and up to 3") from None
    if not 0 < radius <= 3:
        raise ValueError("must be 'critical' or a number above 0 and up to 3")
    return radius


Radius = Annotated[Literal["critical"] | Annotated[float, Field(gt=0, le=3)], BeforeValidator(_radius)]
"""Parameter ``Af``."""

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

    M: float = Field(0.5, gt=0, lt=2, description="thickness at the lower end over its mean")
    delta: float = Field(2.0, gt=1, le=6, description="axial pre-stretch")
    c2: float = Field(0.01, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    L: float = Field(8.0, ge=1, le=40, description="undeformed length L_o/Ao")
    Af: Radius = Field(
        "critical",
        description="radius of the disks: 'critical' (Case 1), or a number above 0, such as 1 (Case 2)",
    )
    load: Literal["fluid", "gas"] = Field("fluid", description="fluid or gas in the membrane")
    gamma: float | None = Field(None, gt=0, le=10, description="weight of the fluid; by default the paper's")
    energy: Literal["relaxed", "modified_gradient", "standard"] = Field(
        "relaxed", description="treatment of wrinkling: two forms of the same energy, or none"
    )
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


class WrinkledTube(PathProblem):
    """Pre-stretched cylindrical membrane of non-uniform thickness under fluid or gas."""

    name: ClassVar[str] = "wrinkled_tube"
    title: ClassVar[str] = "Wrinkling of a pre-stretched cylindrical membrane of non-uniform thickness"
    paper: ClassVar[int] = 4
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = SCALES
    parameters = WrinkledParameters
    numerics = WrinkledNumerics
    columns = (
        "zw",
        "p",
        "V",
        "Pi",
        "N",
        "wrinkled_fraction",
        "r_max",
        "gw_max",
        "gw_min",
        "n_negative",
        "residual",
        "iterations",
    )
    derived = ("wrinkled_fraction", "r_max", "gw_max", "gw_min")
    special_points = ("limit_point", "zone_opening", "zone_closing", "stability_change", "front")
    branches = ("primary",)
    control: ClassVar[str] = "zw (load = fluid) or p (gas); past a limit load compare over V, which increases"

    def check(self, parameters: WrinkledParameters, requests: Requests) -> None:
        """Refuse wrong combinations of parameters and requests.

        Raises:
            InputError: For a state that cannot exist, or a load that the membrane does not have.
        """
        check_requests(self, requests)
        require_foldable(self.name, parameters, bool(parameters.n))
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

    def solve(
        self,
        parameters: WrinkledParameters,
        numerics: WrinkledNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Solve for the critical radius, then for the branch and the requested states with fronts."""
        begun = time.perf_counter()
        result = self._result(parameters, numerics)
        result.numerics["cells"] = numerics.cells
        progress("critical radius", 0, 1)
        critical = _critical(parameters, numerics, comm)
        result.quantities["Af_critical"] = quantity(estimate(critical, 2 * numerics.degree))
        families = {"primary": self._branch(parameters, numerics, requests, comm, critical)}
        self._answer(result, families, requests, self.points(parameters), progress)
        result.special_points.extend(families["primary"].fronts)
        result.provenance = provenance(comm, time.perf_counter() - begun)
        return result

    def families(
        self,
        parameters: WrinkledParameters,
        numerics: WrinkledNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        _progress: Progress,
    ) -> dict[str, Family]:
        """The branch on all meshes."""
        critical = _critical(parameters, numerics, comm)
        return {"primary": self._branch(parameters, numerics, requests, comm, critical)}

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
    return {name: getattr(parameters, name) for name in ("M", "delta", "c2", "L")}


def _critical(parameters: WrinkledParameters, numerics: WrinkledNumerics, comm: MPI.Intracomm) -> list[float]:
    mesh = numerics.meshes, numerics.degree
    return critical_radii(comm, _cylinder(parameters), *mesh, parameters.other_law)


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
    membrane = Membrane(comm, CYLINDER, values, liquid, *mesh, *kind)
    for own, radius in zip(membrane.on_meshes, radii, strict=False):
        own["Af"] = radius
    return membrane


def quantity(found: Estimate) -> Quantity:
    """An estimate as a quantity of a result."""
    order = float(found.order)
    return Quantity(float(found.value), float(found.uncertainty), order if order > 0 else None)


registry.add(WrinkledTube())
