"""Problems ``tube`` and ``tube_fold``: parameters and branches."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numpy as np
from mpi4py import MPI

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.branch_problem import Family, PathProblem
from weakforms.problems.material_choice import MOONEY_RIVLIN, Chosen
from weakforms.problems.problem import Progress, Requests, check_requests, registry
from weakforms.problems.tube.contact_family import contact_family
from weakforms.problems.tube.model import TubeMesh, fold_line, formulation, free_branch
from weakforms.problems.tube.parameters import (
    LONGEST_WHOLE,
    TubeFoldParameters,
    TubeNumerics,
    TubeParameters,
    resolving,
)
from weakforms.solvers.continuation.branch import EquilibriumBranch, SolutionCurve
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.uncertainty.family import BranchFamily

SOURCE = "Patil, Nordmark & Eriksson (2014), Proc. R. Soc. A 470, 20140282"

SCALES = {
    "length": "R_f, radius of the disks (= R_o/sqrt(delta1))",
    "p": "P R_f/(C1 h_o)",
    "alpha": "C2/C1",
    "delta1": "axial pre-stretch, 1",
    "lf": "L_f/R_f",
    "k": "K R_f^2/(C1 h_o)",
    "s": "S/R_f",
    "u_max": "radial displacement of the mid-plane over R_f",
    "lam1_mid": "meridional stretch at the mid-plane, 1",
    "t1_mid": "meridional Cauchy resultant at the mid-plane over C1 h_o",
    "V": "enclosed volume of the half tube over 2 pi R_f^3",
    "Pi": "total potential of the half tube over 2 pi C1 h_o R_f^2",
    "Z": "axial coordinate on the pre-stretched tube from the mid-plane over R_f",
    "rho": "deformed radius over R_f",
    "eta": "deformed axial position from the mid-plane over R_f",
    "lam1": "meridional stretch, 1",
    "lam2": "circumferential stretch, 1",
    "t1": "meridional Cauchy resultant over C1 h_o",
    "t2": "circumferential Cauchy resultant over C1 h_o",
    "Z_front": "Z of the contact front",
    "contact_length": "deformed length of the whole patch over R_f",
    "lam2_mid": "circumferential stretch at the mid-plane, 1",
    "line_force": "axial line force at the edge of the patch over C1 h_o (equation 22)",
    "line_force_membrane": "axial line force without the jump of the spring's term over C1 h_o",
    "traction_front": "|f_t| at the front, inside, times R_f/(C1 h_o)",
    "traction_max": "largest axial traction |f_t| of the substrate times R_f/(C1 h_o)",
    "spring_max": "largest radial spring density |f_k| times R_f/(C1 h_o)",
    "t2_min": "smallest circumferential resultant over C1 h_o",
    "kappa": "curvature of the free part at the front times R_f; negative: bulged outward",
    "f_t": "axial traction of the substrate on the membrane times R_f/(C1 h_o)",
    "f_k": "radial spring density times R_f/(C1 h_o); negative: pushes inward",
    "eigenvalue_1": "lowest eigenvalue of the second variation at fixed p against int |u|^2 dZ",
}

ENERGY = (
    "Pi/(2 pi C1 h_o R_f^2) = int_0^{lf/2} [ w(lam1, lam2)/sqrt(delta1) - (p/2) rho^2 eta_Z "
    "+ (k/2) chi rho (rho - s)^2 eta_Z ] dZ,  "
    "lam1 = delta1 sqrt(rho_Z^2 + eta_Z^2),  lam2 = rho/sqrt(delta1),  "
    "w = I1 - 3 + alpha (I2 - 3), or of another model (weakforms show material; its S for C1)"
)


DERIVED_COLUMNS = (
    "line_force",
    "line_force_membrane",
    "traction_front",
    "traction_max",
    "spring_max",
    "t2_min",
)
"""Columns of constrained inflation that cannot be prescribed."""

CONTACT_COLUMNS = ("Z_front", "contact_length", "lam2_mid", "kappa", *DERIVED_COLUMNS)
"""Columns of constrained inflation only."""


SCANNED = 17
"""Number of pre-stretches at which a limit point is searched."""


class Tube(PathProblem):
    """Inflation of a pre-stretched cylindrical membrane, free or constrained by a substrate."""

    name: ClassVar[str] = "tube"
    title: ClassVar[str] = "Inflation of a pre-stretched cylindrical membrane"
    paper: ClassVar[int] = 2
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = SCALES
    parameters = TubeParameters
    numerics = TubeNumerics
    columns = (
        "p",
        "u_max",
        "lam1_mid",
        "t1_mid",
        "V",
        "Pi",
        *CONTACT_COLUMNS,
        "n_negative",
        "residual",
        "iterations",
    )
    derived = DERIVED_COLUMNS
    special_points = ("limit_point", "bifurcation_point", "contact_onset")
    branches = ("primary",)
    control: ClassVar[str] = (
        "p (past a limit point compare over u_max, which increases along the whole branch)"
    )

    def check(self, parameters: TubeParameters, requests: Requests) -> None:
        """Refuse wrong combinations of parameters and requests.

        Raises:
            InputError: If phase or extent do not fit the contact, or a state cannot exist.
        """
        check_requests(self, requests)
        if parameters.contact == "none" and parameters.phase == "deflation":
            raise InputError(
                "tube: phase = 'deflation' needs an inflation history; allowed with contact = 'adhesive'"
            )
        if parameters.contact == "frictionless" and parameters.phase == "deflation":
            raise InputError(
                "tube: frictionless contact has no history, it deflates as it inflates; "
                "phase = 'deflation' is allowed with contact = 'adhesive'"
            )
        if parameters.extent == "full" and parameters.lf > LONGEST_WHOLE:
            raise InputError(
                f"tube: lf = {parameters.lf:g} with extent = 'full': nothing that can be computed holds a "
                f"bulge in the middle of so long a tube; allowed: lf up to {LONGEST_WHOLE:g}, or "
                "extent = 'half'"
            )
        if parameters.contact != "none" and parameters.extent != "half":
            raise InputError("tube: contact is solved on the half tube; allowed: extent = 'half'")

    def families(
        self,
        parameters: TubeParameters,
        numerics: TubeNumerics,
        _requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress,
    ) -> dict[str, Family]:
        """The branch on all meshes: free, or in contact."""
        if parameters.contact != "none":
            return {"primary": contact_family(parameters, numerics, comm, progress)}
        make = branch_maker(parameters, numerics, comm, progress)
        return {
            "primary": BranchFamily(make, numerics.levels, 2 * numerics.degree, across=("p", "u_max")),
        }

    def resolving(self, parameters: TubeParameters, numerics: TubeNumerics) -> TubeNumerics:
        """More cells for long tubes."""
        return resolving(parameters.lf, numerics)

    def points(self, parameters: TubeParameters) -> np.ndarray:
        """61 points over the body."""
        half = parameters.lf / 2
        return np.linspace(-half if parameters.extent == "full" else 0.0, half, 61)


def branch_maker(
    parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> Callable[[int], EquilibriumBranch]:
    """The branch of free inflation on the mesh of a level."""

    def make(level: int) -> EquilibriumBranch:
        progress("branch", level, numerics.levels)
        at = TubeMesh(
            numerics.meshes[level],
            numerics.degree,
            numerics.grading,
            full=parameters.extent == "full",
        )
        system = System(formulation(comm, parameters.material, parameters.delta1, parameters.lf, at))
        branch = free_branch(system, parameters.delta1, parameters.u_end, numerics.step)
        if branch.ended is not None:
            branch.ended = f"tube: {branch.ended}; lower u_end"
        if branch.stalled is not None:
            branch.stalled += f" (on {at.cells} cells); lower u_end, or raise cells if a solve failed"
        return branch

    return make


class TubeFold(PathProblem):
    """Limit points of free inflation over the pre-stretch, through the cusp in which they merge."""

    name: ClassVar[str] = "tube_fold"
    title: ClassVar[str] = "Fold line of the freely inflated tube and its cusp"
    paper: ClassVar[int] = 2
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = SCALES
    parameters = TubeFoldParameters
    numerics = TubeNumerics
    columns = ("delta1", *(c for c in Tube.columns if c not in CONTACT_COLUMNS))
    special_points = ("cusp_point",)
    branches = ("primary",)
    control: ClassVar[str] = "delta1 (past the cusp compare over u_max, which increases along the whole line)"

    def check(self, parameters: TubeFoldParameters, requests: Requests) -> None:
        """Refuse requests for states that cannot exist."""
        check_requests(self, requests)

    def families(
        self,
        parameters: TubeFoldParameters,
        numerics: TubeNumerics,
        _requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress,
    ) -> dict[str, Family]:
        """The first limit point at one end of the pre-stretches, followed on all meshes."""
        given = {n: v for n, v in parameters.model_dump().items() if n != "delta1_end"}
        ends = 1.0, parameters.delta1_end

        def branch(delta1: float, level: int) -> EquilibriumBranch:
            tube = TubeParameters(**given, delta1=delta1)
            return branch_maker(tube, numerics, comm, progress)(level)

        start = _fold_start(parameters, lambda delta1: bool(len(branch(delta1, 0).turns())))

        def make(level: int) -> SolutionCurve:
            equilibria = branch(start, level)
            if not len(equilibria.turns()):
                raise ConvergenceError(
                    f"tube_fold: delta1 = {start:g}: a limit point on {numerics.meshes[0]} cells, but "
                    f"none on {numerics.meshes[level]}: raise cells"
                )
            return fold_line(equilibria, ends, numerics.step)

        return {
            "primary": BranchFamily(make, numerics.levels, 2 * numerics.degree, across=("delta1", "u_max"))
        }

    def resolving(self, parameters: TubeFoldParameters, numerics: TubeNumerics) -> TubeNumerics:
        """More cells for long tubes."""
        return resolving(parameters.lf, numerics)

    def points(self, parameters: TubeFoldParameters) -> np.ndarray:
        """61 points from the mid-plane to the disk."""
        return np.linspace(0, parameters.lf / 2, 61)


def _fold_start(parameters: TubeFoldParameters, has_limit_point: Callable[[float], bool]) -> float:
    """Pre-stretch at which a fold line starts: 1, or else ``delta1_end``.

    Raises:
        AbsentError: When no limit point is anywhere between; says what was searched.
        InputError: When there is one between only.
    """
    low, high = 1.0, parameters.delta1_end
    for delta1 in (low, high):
        if has_limit_point(delta1):
            return delta1
    scanned = np.linspace(low, high, SCANNED)
    inside = [float(delta1) for delta1 in scanned[1:-1] if has_limit_point(float(delta1))]
    if inside:
        raise InputError(
            f"tube_fold: no limit point at delta1 = 1 or delta1_end = {high:g}, where a fold line is begun; "
            f"there are some from delta1 = {inside[0]:.4g} to {inside[-1]:.4g}: set delta1_end to one"
        )
    raise AbsentError(
        "fold line",
        f"tube_fold: no limit point of {_named(parameters.material)}, lf = {parameters.lf:g} up to "
        f"u_max = {parameters.u_end:g} at any of {SCANNED} pre-stretches from 1 to delta1_end = {high:g}: no "
        f"fold line to follow; change the law or lf, or raise u_end or delta1_end (allowed: up to 10 and 5)",
    )


def _named(chosen: Chosen) -> str:
    """A law and its constants as text."""
    model = () if chosen.model == MOONEY_RIVLIN else (f"model = {chosen.model}",)
    return ", ".join((*model, *(f"{name} = {value:g}" for name, value in chosen.constants)))


registry.add(Tube())
registry.add(TubeFold())
