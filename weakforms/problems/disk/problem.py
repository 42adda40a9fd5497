"""Problem ``circular``: parameters and branches."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise
from typing import ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import InputError
from weakforms.problems.branch_problem import Family, MeshNumerics, PathProblem
from weakforms.problems.disk.guesses import HIGHEST_P
from weakforms.problems.disk.model import DiskData
from weakforms.problems.disk.peeling import PeelingBranch, PeelingFamily
from weakforms.problems.disk.phases import DiskRun
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.problem import Progress, Requests, check_requests, registry
from weakforms.results import Absence, SpecialPoint
from weakforms.solvers.continuation.branch import SolutionCurve
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.uncertainty.family import BranchFamily, special_point
from weakforms.solvers.uncertainty.refinement import Slow

SOURCE = "Patil, DasGupta & Eriksson (2015), Int. J. Solids Struct. 67-68, 250-262"

FIRST_TERMS, MORE_TERMS = 10, 3
"""Number of terms of the stuck patch's series on the coarsest mesh, and the increase for each finer mesh."""

SERIES = Slow(size=6e-9, order=2.0)
"""Truncation error of the series, which decreases slowly from mesh to mesh."""

SCALES = {
    "length": "R_f, radius of the clamp (= beta R_0)",
    "alpha": "C2/C1",
    "beta": "uniform pre-stretch, 1",
    "k": "K R_f^2/(C1 h)",
    "l": "L/R_f",
    "p": "P R_f/(C1 h)",
    "t0": "height of the pole over R_f",
    "lam_pole": "both stretches at the pole, 1",
    "lam1_rim": "meridional stretch at the clamp, 1",
    "V": "enclosed volume over 2 pi R_f^3",
    "Pi": "total potential over 2 pi C1 h R_f^2",
    "X": "material radius, X = beta x in [0, 1]",
    "X_contact": "X of the contact edge",
    "rho_contact": "deformed radius of the contact edge over R_f",
    "lam1_contact": "meridional stretch at the contact edge, inside, 1",
    "lam1_contact_outer": "meridional stretch at the contact edge, outside, 1",
    "sigma_pole": "contact stress at the pole times R_f/(C1 h), negative in compression",
    "sigma_contact": "contact stress at the edge of the patch, inside, times R_f/(C1 h)",
    "X_iso": "smallest X with |lam1 - lam2| = 1e-4 (1 where there is none)",
    "kappa": "meridional curvature of the free part at the contact edge times R_f, positive: bulged outward",
    "t_min": "smallest principal Cauchy resultant anywhere over C1 h",
    "G": "energy release rate at the contact edge over C1 h, closed form",
    "G_difference": "energy release rate from differences of potentials over C1 h",
    "rho": "deformed radius over R_f",
    "eta": "deformed height over R_f",
    "lam1": "meridional stretch, 1",
    "lam2": "circumferential stretch, 1",
    "t1": "meridional Cauchy resultant over C1 h",
    "t2": "circumferential Cauchy resultant over C1 h",
    "sigma": "contact stress times R_f/(C1 h), negative in compression",
    "eigenvalue_1": "lowest eigenvalue of the second variation at fixed p against int |dx|^2 x dx",
}

ENERGY = (
    "Pi/(2 pi C1 h R_f^2) = int_0^{1/beta} [ W(lam1, lam2) x + (p/2) rho^2 eta' "
    "+ (k/2) chi (eta - l)^2 rho rho' ] dx,  rho = x lam2,  lam1 = sqrt(rho'^2 + eta'^2),  "
    "W = I1 - 3 + alpha (I2 - 3), or of another model (weakforms show material; its S for C1)"
)

PATCH_COLUMNS = (
    "X_contact",
    "rho_contact",
    "lam1_contact",
    "lam1_contact_outer",
    "sigma_pole",
    "sigma_contact",
    "kappa",
    "G",
)
"""Columns of the edge of the patch."""

NO_PATCH = {
    **dict.fromkeys(("X_contact", "rho_contact", "sigma_pole", "sigma_contact", "G"), 0.0),
    **dict.fromkeys(("lam1_contact", "lam1_contact_outer", "kappa"), float("nan")),
}
"""Values of these columns before contact."""


TRACES = ("lam1_rim", "lam1_contact", "lam1_contact_outer", "kappa", "lam1", "t1", "t2", "X_iso")
"""Columns with first derivatives at a point, whose order is at most the degree."""


MOVING_POINTS = ("t_min",)
"""Columns at points that move through the mesh; their error depends on the position in a cell."""


OF_EIGENVALUES = 4.0
"""Order of the eigenvalues, for cubic and quartic elements; the pole is a singular point."""


POLE = ("t0", "lam_pole")
"""Columns at the pole, a vertex of the mesh without superconvergence, because it is a singular point."""


def order_at_pole(degree: int) -> float:
    """Order of values at the pole: of the first even power that elements miss (the solution is even)."""
    return 2.0 * (degree // 2 + 1)


class CircularNumerics(MeshNumerics):
    """Meshes of the disk: half of the ``cells`` on each side of the front."""

    step: float = Field(0.06, ge=0.01, le=0.5, description="largest arc-length step")


class CircularParameters(MaterialChoice):
    """The disk and its substrate."""

    ratio: ClassVar[str] = "alpha"

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    beta: float = Field(1.0, ge=1, le=10, description="uniform pre-stretch")
    k: float = Field(50.0, gt=0, le=1e4, description="substrate stiffness K R_f^2/(C1 h)")
    l: float = Field(0.5, gt=0.06, le=5, description="height of the substrate L/R_f")  # noqa: E741
    contact: Literal["none", "frictionless", "adhesive"] = Field("none", description="contact law")
    adhesion: Literal["locked", "radial"] = Field(
        "locked", description="locked: both stretches stick; radial: the radius sticks"
    )
    phase: Literal["inflation", "deflation", "peeling"] = Field("inflation", description="loading phase")
    p_end: float = Field(
        3.477, gt=0, le=HIGHEST_P, description="pressure at which inflation towards and in contact ends"
    )
    p: float | None = Field(None, ge=0, le=50, description="pressure of a peeling curve")
    t_end: float = Field(2.0, gt=0.06, le=10, description="pole height at which free inflation ends")


class Circular(PathProblem):
    """Inflation of a flat circular membrane, free or against a deformable substrate; adhesion and peeling."""

    name: ClassVar[str] = "circular"
    title: ClassVar[str] = "Circular membrane inflated against a deformable substrate"
    paper: ClassVar[int] = 1
    source: ClassVar[str] = SOURCE
    energy: ClassVar[str] = ENERGY
    scales: ClassVar[dict[str, str]] = SCALES
    parameters = CircularParameters
    numerics = CircularNumerics
    columns = (
        "p",
        "t0",
        "lam_pole",
        "lam1_rim",
        "V",
        "Pi",
        "X_iso",
        *PATCH_COLUMNS,
        "G_difference",
        "t_min",
        "n_negative",
        "residual",
        "iterations",
    )
    derived = ("X_iso", "t_min", "G_difference")
    special_points = ("limit_point", "bifurcation_point", "contact_onset", "pull_off")
    branches = ("primary",)
    control: ClassVar[str] = (
        "p (free: past a limit point compare over t0); peeling: the front at fixed p, and n_negative counts "
        "the front among the freedoms"
    )

    def check(self, parameters: CircularParameters, requests: Requests) -> None:
        """Refuse what the ranges of single parameters cannot.

        Raises:
            InputError: For a phase without its history, a peeling request without pressure or beyond it, or a
                state that cannot exist.
        """
        check_requests(self, requests)
        if parameters.phase == "deflation" and parameters.contact != "adhesive":
            raise InputError(
                "circular: phase = 'deflation' needs a patch that sticks; allowed with contact = 'adhesive'"
            )
        if parameters.phase == "peeling":
            self._check_peeling(parameters, requests)
        elif parameters.p is not None:
            raise InputError(
                f"circular: p = {parameters.p:g} is for phase = 'peeling'; for other phases use --at p=..."
            )

    def _check_peeling(self, parameters: CircularParameters, requests: Requests) -> None:
        if parameters.adhesion != "locked":
            raise InputError("circular: phase = 'peeling' needs adhesion = 'locked'")
        if parameters.contact == "frictionless":
            raise InputError(
                "circular: phase = 'peeling' needs a patch that sticks, not contact = 'frictionless'"
            )
        p = peeling_pressure(parameters, requests)
        if p > parameters.p_end:
            raise InputError(
                f"circular: p = {p:g} is above the pressure reached in inflation; allowed: up to "
                f"p_end = {parameters.p_end:g}"
            )

    def families(
        self,
        parameters: CircularParameters,
        numerics: CircularNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress,
    ) -> dict[str, Family]:
        """The branch of the phase, on all meshes."""
        degree, cap = numerics.degree, 2.0 * numerics.degree
        terms = range(FIRST_TERMS, FIRST_TERMS + MORE_TERMS * numerics.levels, MORE_TERMS)
        runs = [
            inflation(
                comm.py2f(),
                _data(parameters, cells // 2, degree),
                parameters.adhesion,
                parameters.p_end,
                numerics.step,
                count,
            )
            for cells, count in zip(numerics.meshes, terms, strict=True)
        ]
        for coarse, fine in pairwise(runs):
            fine.coarser = coarse

        def family(
            part: Callable[[DiskRun], SolutionCurve], slow: Slow | None = None, of: type = BranchFamily
        ) -> BranchFamily:
            def make(level: int) -> SolutionCurve:
                progress("branch", level, numerics.levels)
                return part(runs[level])

            across = ("front", "rho_contact") if of is PeelingFamily else ("p", "t0")
            caps = dict.fromkeys(TRACES, float(degree)) | dict.fromkeys(MOVING_POINTS, 2.0)
            caps |= dict.fromkeys(POLE, order_at_pole(degree))
            caps["eigenvalue_1"] = min(cap, OF_EIGENVALUES)
            if of is PeelingFamily:  # where G is not zero, it is a jump of such derivatives
                caps |= {"G": float(degree), "G_difference": degree + 1.0}
            return of(make, numerics.levels, cap, across=across, caps=caps, slow=slow)

        if parameters.phase == "peeling":
            p = peeling_pressure(parameters, requests)
            if runs[-1].untouched:
                raise InputError(f"circular: phase = 'peeling' needs a patch, and {runs[-1].untouched}")
            return {"primary": family(lambda run: PeelingBranch(run, p), SERIES, PeelingFamily)}
        if parameters.contact == "none":
            free = family(lambda run: run.free(parameters.t_end))
            return {"primary": PiecewiseFamily([Piece(free, NO_PATCH)])}
        if runs[-1].untouched:
            deflates = parameters.phase == "deflation"
            free = family(lambda run: run.emptied if deflates else run.until_end)
            absent = Absence("contact", f"circular: {runs[-1].untouched}")
            return {"primary": PiecewiseFamily([Piece(free, NO_PATCH)], absent=[absent])}
        if parameters.phase == "deflation":
            return {"primary": family(lambda run: run.deflation, SERIES)}
        history = SERIES if parameters.contact == "adhesive" else None
        pieces = [
            Piece(family(lambda run: run.before_contact), NO_PATCH),
            Piece(family(lambda run: getattr(run, parameters.contact), history), {}),
        ]
        return {"primary": PiecewiseFamily(pieces, lambda: [_onset(runs, numerics.degree)])}

    def points(self, parameters: CircularParameters) -> np.ndarray:
        """101 points from the pole to the clamp."""
        return np.linspace(0, 1, 101)


def peeling_pressure(parameters: CircularParameters, requests: Requests) -> float:
    """The pressure of a peeling curve: the parameter ``p``, or the pressure of the requested states.

    Raises:
        InputError: If there is none, or more than one.
    """
    given = {request.value for request in requests.states if request.name == "p"}
    if parameters.p is not None:
        given.add(parameters.p)
    if len(given) != 1:
        found = ", ".join(f"{p:g}" for p in sorted(given)) or "none"
        raise InputError(
            f"circular: phase = 'peeling' is at one pressure, --set p=... or --at p=..., not at {found}"
        )
    return given.pop()


def _onset(runs: list[DiskRun], degree: int) -> SpecialPoint:
    shown = [n for n in runs[-1].before_contact.shown if n not in NO_PATCH]
    caps = dict.fromkeys(TRACES, float(degree)) | dict.fromkeys(MOVING_POINTS, 2.0)
    highest = order_at_pole(degree)  # for all columns, because the height of the pole is prescribed
    return special_point([run.onset for run in runs], shown, highest, "primary", "p", caps)


def _data(parameters: CircularParameters, cells: int, degree: int) -> DiskData:
    ends = cells, degree, parameters.material
    return DiskData(parameters.alpha, parameters.beta, parameters.k, parameters.l, *ends)


@lru_cache(maxsize=9)
def inflation(handle: int, data: DiskData, adhesion: str, p_end: float, step: float, terms: int) -> DiskRun:
    """Inflation on one mesh; it is kept for deflation and for all peeling curves, which start with it."""
    return DiskRun(MPI.Comm.f2py(handle), data, adhesion, p_end, step, terms)


registry.add(Circular())
