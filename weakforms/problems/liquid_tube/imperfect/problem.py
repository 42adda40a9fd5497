"""Problem ``fluid_tube_imperfect``: parameters, branches on all meshes, coefficients of the bifurcation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar, Self

import numpy as np
from pydantic import Field, model_validator

from weakforms.errors import InputError
from weakforms.problems.branch_problem import BranchProblem, MeshNumerics
from weakforms.problems.liquid_tube.critical import PrimaryBranch
from weakforms.problems.liquid_tube.imperfect.about import FLUID_TUBE_IMPERFECT
from weakforms.problems.liquid_tube.imperfect.branch import (
    Axisymmetric,
    LiquidBranch,
    Window,
    bent,
    detached,
    expanded,
    natural,
)
from weakforms.problems.liquid_tube.imperfect.model import IMPERFECTIONS, Liquid, LiquidSector
from weakforms.problems.meridian.sector import SectorMesh
from weakforms.problems.problem import End, Parameters, Requests, Task
from weakforms.results import Field as Profile
from weakforms.results import Quantity, SpecialPoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.stability.surface_family import SurfaceFamily
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.refinement import estimate

LEAST = {"tilt": 1e-3, "uneven": 1e-5}
"""Smallest magnitudes other than zero: below, the branches are too near each other for one step not to change
over."""

AT_NODES = 2.0
"""Assumed order of radii at nodes above the degree of the elements."""


class ImperfectNumerics(MeshNumerics):
    """Meshes of the surface: ``cells`` along the tube and ``around`` half a wave on the finest one."""

    degree: int = Field(5, ge=2, le=6, description="polynomial degree of the unknowns")
    cells: int = Field(16, ge=8, le=96, description="cells along the tube on the finest mesh")
    around: int = Field(8, ge=2, le=96, description="cells around half a wave on the finest mesh")
    grading: float = Field(0.5, ge=0, lt=1, description="concentration of cells at the rings")
    step: float = Field(
        0.1, ge=0.01, le=0.5, description="largest step, as a root mean square displacement over the radius"
    )

    @model_validator(mode="after")
    def _nested_around(self) -> Self:
        coarsest = 2 ** (self.levels - 1)
        if self.cells % (2 * coarsest):
            raise ValueError(f"cells must be a multiple of {2 * coarsest} for {self.levels} levels")
        if self.around % coarsest:
            raise ValueError(f"around must be a multiple of {coarsest} for {self.levels} levels")
        return self

    @property
    def surfaces(self) -> list[SectorMesh]:
        """The meshes, coarse to fine."""
        counts = [2**k for k in reversed(range(self.levels))]
        return [SectorMesh(self.cells // k, self.around // k, self.degree, self.grading) for k in counts]


class ImperfectParameters(Parameters):
    """The tube, its liquid, the imperfection, and the part of the branches that is solved for."""

    movable: ClassVar = {"u_end": "le"}

    L: float = Field(8.0, ge=2, le=40, description="stretched length over the radius")
    delta: float = Field(5.0, gt=1, le=9, description="axial pre-stretch")
    gamma: float = Field(0.116, gt=0, le=2, description="rho g A^2/(mu H)")
    alpha: float = Field(0.0, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    n: int = Field(1, ge=1, le=6, description="waves around the axis")
    tilt: float = Field(
        0.0, ge=-10, le=10, description="angle, degrees, from the axis to the vertical; with n = 1 only"
    )
    uneven: float = Field(0.0, ge=-0.3, le=0.3, description="e of the thickness 1 + e cos(n Theta)")
    v_start: float = Field(
        0.75,
        ge=0.3,
        le=0.99,
        description="volume at which branches begin, over that where the even, upright tube bifurcates",
    )
    v_end: float = Field(1.08, ge=1.01, le=3, description="volume at which they end, over the same")
    u_end: float = Field(1.0, ge=0.05, le=3, description="magnitude of u_wave at which they end")
    secondary: bool = Field(
        False, description="also the bent states: of an even tube, or detached from the other branch"
    )

    @property
    def imperfections(self) -> dict[str, float]:
        """The imperfections by their loads."""
        return {name: getattr(self, name) for name in IMPERFECTIONS}


class FluidTubeImperfect(BranchProblem):
    """An over-filled tube that has no symmetry of revolution to lose."""

    about = FLUID_TUBE_IMPERFECT
    parameters = ImperfectParameters
    numerics = ImperfectNumerics
    surfaces = True

    def check(self, parameters: ImperfectParameters, requests: Requests) -> None:
        """Refuse a tilt that does not repeat around the axis, and an imperfection that is too small.

        Raises:
            InputError: With the value and the allowed ones.
        """
        super().check(parameters, requests)
        if parameters.tilt and parameters.n > 1:
            raise InputError(
                f"{self.name}: tilt = {parameters.tilt:g} with n = {parameters.n}: tilt has one wave around "
                "the axis; allowed: n = 1, or tilt = 0"
            )
        for name, value in parameters.imperfections.items():
            if 0 < abs(value) < LEAST[name]:
                raise InputError(
                    f"{self.name}: {name} = {value:g}: both branches are too near each other; allowed: 0, or "
                    f"a magnitude of at least {LEAST[name]:g}"
                )
        if not parameters.secondary and any(wanted.branch == "secondary" for wanted in requests.states):
            raise InputError(f"{self.name}: the secondary branch is solved for only with secondary = true")

    def computed(self, _parameters: ImperfectParameters) -> tuple[str, ...]:
        """No number besides the columns."""
        return ()

    def ends(self, parameters: ImperfectParameters, _branch: str) -> list[End]:
        """The largest amplitude to either side, and the last volume."""
        return [
            End("u_end", "u_wave", parameters.u_end),
            End("u_end", "u_wave", -parameters.u_end),
            End("v_end", "V", None),
        ]

    def families(self, task: Task) -> dict[str, BranchFamily]:
        """The natural branch on all meshes, and bent or detached states if they are requested."""
        given, numerics, comm = task.parameters, task.numerics, task.comm
        tube = Liquid(given.L, given.delta, given.gamma, given.alpha)
        primary = PrimaryBranch(comm, given.L, given.delta, given.gamma, given.alpha, n_max=given.n)
        about = Axisymmetric.of(primary, given.n, given.v_start)
        at = about.bifurcation.values["V"]
        window = Window(given.v_start * at, given.v_end * at, given.u_end, numerics.step)
        models: dict[int, LiquidSector] = {}

        def model(level: int) -> LiquidSector:
            if level not in models:
                models[level] = LiquidSector(comm, tube, given.n, numerics.surfaces[level])
            return models[level]

        def first(level: int) -> LiquidBranch:
            task.progress("branch", level, numerics.levels)
            return natural(model(level), about, given.imperfections, window)

        def other(level: int) -> LiquidBranch:
            task.progress("secondary branch", level, numerics.levels)
            even = natural(model(level), about, dict.fromkeys(IMPERFECTIONS, 0.0), window)
            if not any(given.imperfections.values()):
                return bent(even, 1.0, window)
            return detached(even, given.imperfections, window)

        made = {"primary": first} | ({"secondary": other} if given.secondary else {})
        order = 2.0 * numerics.degree
        caps = dict.fromkeys(("r_mid", "u_wave"), numerics.degree + AT_NODES)
        found = {}
        for name, make in made.items():
            across = ("V", "u_wave")
            found[name] = ImperfectFamily(make, numerics.levels, order, across, name, caps=caps)
        return found

    def points(self, parameters: ImperfectParameters) -> np.ndarray:
        """33 points from the lower ring to the upper one."""
        return np.linspace(0, parameters.L / parameters.delta, 33)


class ImperfectFamily(SurfaceFamily):
    """A branch on all meshes; the bifurcation of an even tube has the coefficients of the laws."""

    fine: LiquidBranch
    levels: list[LiquidBranch]

    def special_points(self) -> list[SpecialPoint]:
        """As for any branch: there are no classes of modes."""
        points = BranchFamily.special_points(self)
        for point in points:
            if point.kind == "bifurcation_point":
                for name, quantity in self.coefficients().items():
                    point.values[name], point.uncertainty[name] = quantity.value, quantity.uncertainty
        return points

    def coefficients(self) -> Mapping[str, Quantity]:
        """The amplitude's equation at the bifurcation, and the two-thirds laws of imperfections."""
        rows = [_coefficients(level) for level in self.levels]
        found = {name: estimate([row[name] for row in rows], self.cap) for name in rows[0]}
        return {name: Quantity(float(b.value), float(b.uncertainty)) for name, b in found.items()}

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        return BranchFamily._diagnostics(self, solved, critical)

    def _profile(self, solved: Sequence[Solved], points: np.ndarray) -> Profile:
        """Columns along both mirrors, one after the other."""
        mirrors = 0.0, self.fine.model.width
        z, theta = np.tile(points, 2), np.repeat(mirrors, len(points))
        found = super()._profile(solved, np.column_stack([z, theta]))
        keys = {"Z": z, "Theta": theta}
        return Profile(
            found.name, {**found.columns, **keys}, {**found.uncertainty, **dict.fromkeys(keys, 0.0)}
        )


def _coefficients(even: LiquidBranch) -> dict[str, float]:
    """The coefficients on one mesh."""
    model, weight = even.model, even.model.tube.gamma  # the potential's conjugate of the level is gamma V
    out = {}
    for name in IMPERFECTIONS[model.n > 1 :]:
        about = expanded(even, name)
        out |= {
            "zw_2": about.load_2,
            "V_2": about.conjugate_2 / weight,
            "A1": about.linear,
            "A3": about.cubic,
        }
        law = about.two_thirds
        out |= {f"B_{name}": about.push, f"zw_{name}": law["load"], f"V_{name}": law["conjugate"] / weight}
    return out
