"""Problem ``fluid_tube``: parameters and branches."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError, InputError
from weakforms.forms.materials.surface import LAWS
from weakforms.problems.branch_problem import Family, PathProblem
from weakforms.problems.liquid_tube.bent.columns import COLUMNS as SECONDARY_COLUMNS
from weakforms.problems.liquid_tube.bent.columns import DERIVED_COLUMNS
from weakforms.problems.liquid_tube.bent.columns import SCALES as SECONDARY_SCALES
from weakforms.problems.liquid_tube.bent.family import secondary_family
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.liquid_tube.parameters import MOST_WAVES, FluidTubeNumerics, FluidTubeParameters
from weakforms.problems.material_choice import MOONEY_RIVLIN, require_model
from weakforms.problems.problem import Progress, Requests, check_requests, registry, sample_points
from weakforms.results import Failure, Result
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.stability.modal import ModalBranch, ModalFamily

SOURCE = "Patil, Nordmark & Eriksson (2015), Proc. R. Soc. A 471, 20150016"

SCALES = {
    "length": "A, radius of the disks and of the stress-free tube",
    "L": "stretched length over A",
    "delta": "axial pre-stretch, 1; the stress-free tube is L/delta long",
    "gamma": "rho g A^2/(mu H), H the thickness of the stress-free tube",
    "mu": "2 C1; for another model 2 S, twice the stress by which its constants are divided",
    "alpha": "second Mooney-Rivlin constant over the first; 0 is neo-Hookean",
    "zw": "level of the free surface above the lower disk, or static head over a full tube, over A",
    "V": "volume of the liquid over A^3",
    "Pi": "total potential at fixed level over mu H A^2",
    "r_mid": "radius at Z = L/(2 delta) over A",
    "r_max": "largest radius over A",
    "r_front": "radius at the free surface over A; none over a full tube",
    "Z_front": "Z of the free surface over A",
    "T1_ring": "meridional Cauchy resultant at the rings over mu H",
    "T2_ring": "circumferential Cauchy resultant at the rings over mu H",
    "T1_mid": "meridional Cauchy resultant at Z = L/(2 delta) over mu H",
    "T2_mid": "circumferential Cauchy resultant at Z = L/(2 delta) over mu H",
    **{
        f"Lambda_n{n}": "lowest eigenvalue at fixed level against int |dx|^2 dZ dTheta, "
        + ("axisymmetric without torsion" if n == 0 else f"{n} wave{'s' if n > 1 else ''} around")
        for n in range(MOST_WAVES + 1)
    },
    "Lambda_torsion": "lowest eigenvalue at fixed level, axisymmetric torsion",
    "LambdaV_n0": "lowest axisymmetric eigenvalue at fixed volume",
    "Z": "axial coordinate on the stress-free tube from the lower disk over A",
    "r": "radius over A",
    "z": "height over A",
    "lam1": "meridional stretch, 1",
    "lam2": "circumferential stretch, 1",
    "T1": "meridional Cauchy resultant over mu H",
    "T2": "circumferential Cauchy resultant over mu H",
    "H": "w - lam1 w_,1, constant along the membrane, over mu H",
    **SECONDARY_SCALES,
}

ENERGY = (
    "Pi/(mu H A^2) = int_0^{L/delta} int_0^{2 pi} [ (I1 - 3 + alpha (I2 - 3))/2 - P(z) (x e_x + y e_y).N/2 ] "
    "dTheta dZ,  P = gamma max(zw - z, 0),  N = x_Theta x x_Z;  written as its first variation, "
    "w_a.v_Z + w_b.v_Theta - P v.N;  another model (weakforms show material) has w/2 for the first term"
)

CAPS = {"r_mid": 4.0, "r_max": 4.0, **dict.fromkeys(("T1_ring", "T2_ring", "T1_mid", "T2_mid"), 2.0)}
"""Highest assumed orders of convergence at material points of a partially filled tube. Because cells follow
the front, the position of such a point in its cell varies: the error has the order of the elements, but its
size varies."""

MATERIAL = {"r_mid": "r", "r_max": "r", "T1_mid": "T1", "T2_mid": "T2"}
"""The columns at such points, each with the field that it evaluates."""

PARTLY_FILLED = "Z_front", "r_front"
"""Columns that only a partially filled tube has."""


class FluidTube(PathProblem):
    """A pre-stretched cylindrical membrane filled with a liquid, under level control."""

    name: ClassVar[str] = "fluid_tube"
    title: ClassVar[str] = "Fluid-loaded pre-stretched cylindrical membrane"
    paper: ClassVar[int] = 3
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = SCALES
    parameters = FluidTubeParameters
    numerics = FluidTubeNumerics
    columns = (
        "zw",
        "V",
        "Pi",
        "r_mid",
        "r_max",
        "r_front",
        "Z_front",
        "T1_ring",
        "T2_ring",
        "T1_mid",
        "T2_mid",
        *(f"Lambda_n{n}" for n in range(MOST_WAVES + 1)),
        "Lambda_torsion",
        "LambdaV_n0",
        *SECONDARY_COLUMNS,
        *DERIVED_COLUMNS,
        "n_negative",
        "residual",
        "iterations",
    )
    derived = DERIVED_COLUMNS
    special_points = ("limit_point", "bifurcation_point")
    branches = ("primary", "secondary")
    control: ClassVar[str] = (
        "zw (past its maximum compare over V, which increases along the whole primary branch)"
    )

    def check(self, parameters: FluidTubeParameters, requests: Requests) -> None:
        """Refuse what the ranges of single parameters cannot.

        Raises:
            InputError: For a state that cannot exist.
        """
        check_requests(self, requests)
        require_model(self.name, parameters, tuple(LAWS))
        if parameters.secondary:
            require_model(f"{self.name}: secondary = true", parameters, (MOONEY_RIVLIN,))
        for wanted in requests.states:
            if wanted.name == "zw" and wanted.value < 0:
                raise InputError(f"fluid_tube: zw = {wanted.value:g} is below the tube; allowed: zw >= 0")
            waves = wanted.name.removeprefix("Lambda_n")
            if waves.isdigit() and int(waves) > parameters.n_max:
                raise InputError(
                    f"fluid_tube: {wanted.name} is not computed; allowed: n up to n_max = {parameters.n_max}"
                )
            if wanted.branch == "secondary" and not parameters.secondary:
                raise InputError("fluid_tube: the secondary branch is solved for only with secondary = true")

    def families(
        self,
        parameters: FluidTubeParameters,
        numerics: FluidTubeNumerics,
        _requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress,
    ) -> dict[str, Family]:
        """The primary branch on all meshes, and the secondary one if it is requested."""
        found: dict[str, Family] = {"primary": primary_family(parameters, numerics, comm, progress)}
        if parameters.secondary:
            found["secondary"] = secondary_family(parameters, numerics, comm, progress)
        return found

    def points(self, parameters: FluidTubeParameters) -> np.ndarray:
        """61 points from the lower ring to the upper one."""
        return np.linspace(0, parameters.L / parameters.delta, 61)

    def _answer(
        self,
        result: Result,
        families: dict[str, Family],
        requests: Requests,
        default_points: np.ndarray,
        progress: Progress,
    ) -> None:
        """As for any problem; with the secondary branch, a state is computed on every branch that has it."""
        super()._answer(result, families, replace(requests, states=()), default_points, progress)
        for i, wanted in enumerate(requests.states):
            progress("states", i, len(requests.states))
            points = sample_points(wanted.profile, default_points)
            names = list(families) if wanted.branch == "primary" else [wanted.branch]
            missing = []
            for name in names:
                try:
                    state = families[name].state(wanted.name, wanted.value, wanted.crossing, points)
                    result.states.append(state)
                except InputError as error:
                    missing.append(f"{name} branch: {error}")
                except ConvergenceError as error:
                    what = f"state at {wanted.name} = {wanted.value:g}"
                    result.failures.append(Failure(what, f"{name} branch: {error}"))
            if len(missing) == len(names):
                raise InputError(f"fluid_tube: {'; '.join(missing)}")


def primary_family(
    parameters: FluidTubeParameters, numerics: FluidTubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> PiecewiseFamily:
    """The primary branch on all meshes: dry, partially filled, full, partially filled again."""
    paths = []
    for level, cells in enumerate(numerics.meshes):
        progress("primary branch", level, numerics.levels)
        data = TubeData(
            parameters.L,
            parameters.delta,
            parameters.gamma,
            parameters.alpha,
            cells // 2,
            numerics.degree,
            numerics.grading,
            parameters.other_law,
        )
        paths.append(FluidPath(comm, data, parameters.n_max, parameters.zw_end, numerics.step))
    counts = [len(path.pieces) for path in paths]
    if len(set(counts)) > 1:
        raise ConvergenceError(f"fluid_tube: the parts of the primary branch depend on the mesh: {counts}")

    def family(k: int) -> ModalFamily:
        def make(level: int) -> ModalBranch:
            return paths[level].pieces[k]

        still = {name: numerics.degree + float(name.startswith("r")) for name in CAPS}
        caps = CAPS if k % 2 else still  # without a front the mesh does not move
        moving = MATERIAL if k % 2 else {}
        return ModalFamily(
            make, numerics.levels, 2 * numerics.degree, across=("zw", "V"), caps=caps, points_of=moving
        )

    length = parameters.L / parameters.delta
    dry, full = (
        dict(zip(PARTLY_FILLED, (0.0, 1.0), strict=True)),
        dict(zip(PARTLY_FILLED, (length, np.nan), strict=True)),
    )
    fixed = [dry if k == 0 else full if k % 2 == 0 else {} for k in range(counts[0])]
    return PiecewiseFamily([Piece(family(k), given) for k, given in enumerate(fixed)])


registry.add(FluidTube())
