"""Problem ``circular``: parameters and branches."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import ClassVar, Literal

import numpy as np
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import AbsentError, InputError
from weakforms.problems.branch_problem import BranchProblem, Family, MeshNumerics
from weakforms.problems.contact.family import contact_branch
from weakforms.problems.disk.about import CIRCULAR
from weakforms.problems.disk.family import DiskFamily, rounded
from weakforms.problems.disk.model import DiskData
from weakforms.problems.disk.peeling import SMALLEST_FRONT, PeelingBranch, PeelingFamily
from weakforms.problems.disk.phases import FIRST_T0, HIGHEST_P, DiskPhases
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.meridian.pre_stretch import require_taut
from weakforms.problems.meridian.thickness import Thickness, require_thickness, text_over
from weakforms.problems.problem import End, Needs, Requests, Task
from weakforms.results import SpecialPoint
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.uncertainty.points import special_point
from weakforms.solvers.uncertainty.refinement import Slow

FIRST_TERMS, MORE_TERMS = 10, 3
"""Number of terms of the stuck patch's series on the coarsest mesh, and the increase for each finer mesh."""

SERIES = Slow(size=6e-9, order=2.0)
"""Truncation error of the series, which decreases slowly from mesh to mesh."""

NO_PATCH = {
    **dict.fromkeys(("X_contact", "rho_contact", "sigma_pole", "sigma_contact", "G"), 0.0),
    **dict.fromkeys(("lam1_contact", "lam1_contact_outer", "kappa"), float("nan")),
}
"""Values of the columns of the edge of the patch before contact."""


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


TOUCHES = ("frictionless", "adhesive")
"""Contact laws with a substrate."""


class CircularParameters(MaterialChoice):
    """The disk and its substrate."""

    ratio: ClassVar[str] = "alpha"
    needs: ClassVar[Needs] = {
        **dict.fromkeys(("k", "l", "p_end"), ({"contact": TOUCHES}, {"phase": ("peeling",)})),
        "adhesion": [{"contact": ("adhesive",)}, {"phase": ("peeling",)}],
        **dict.fromkeys(("t_end", "M", "thickness"), ({"contact": ("none",), "phase": ("inflation",)},)),
    }
    movable: ClassVar = {"t_end": "le", "p_end": "le"}

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
    M: float = Field(
        1.0,
        ge=0.3,
        le=1.9,
        description="thickness at the pole over h, linear to 2 - M at the clamp; free only",
    )
    thickness: text_over("X") = Field(  # type: ignore[valid-type]
        None,
        description="thickness over h by the radius X, such as '1 + 0.2*cos(pi*X)'; replaces M; free only",
    )
    t_end: float = Field(2.0, gt=0.06, le=10, description="pole height at which free inflation ends")

    @property
    def own_thickness(self) -> Thickness | None:
        """The thickness, if it is given as text."""
        return None if self.thickness is None else Thickness(self.thickness, "X")


class Circular(BranchProblem):
    """Inflation of a flat circular membrane, free or against a deformable substrate; adhesion and peeling."""

    about = CIRCULAR
    parameters = CircularParameters
    numerics = CircularNumerics

    def check(self, parameters: CircularParameters, requests: Requests) -> None:
        """Refuse what the ranges of single parameters cannot.

        Raises:
            InputError: For a phase without its history, a peeling request without pressure or beyond it, a
                pre-stretch that the law does not take, or a state that cannot exist.
        """
        super().check(parameters, requests)
        require_taut(self.name, parameters.material, parameters.beta, "beta")
        require_thickness(self.name, parameters.own_thickness, 1.0, "M" in parameters.model_fields_set)
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

    def ends(self, parameters: CircularParameters, _branch: str) -> list[End]:
        """Where free inflation, contact, deflation and peeling end."""
        if parameters.phase == "peeling":
            small = "the energy release rate is unbounded as the patch vanishes"
            grown = "the patch that inflation reaches at this pressure"
            return [
                End("smallest patch", "X_contact", SMALLEST_FRONT, small),
                End("inflation", "X_contact", None, grown),
            ]
        if parameters.contact == "none":
            return [End("t_end", "t0", parameters.t_end, largest=True)]
        begins = parameters.phase == "deflation"
        highest = End("p_end", "p", parameters.p_end, largest=True, begins=begins)
        if not begins:
            return [highest]
        empty = End("unloaded", "p", 0.0, "deflation ends without pressure")
        return [empty, End("slack", "t0", FIRST_T0, "the disk is slack"), highest]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch of the phase, on all meshes."""
        parameters, numerics, requests = task.parameters, task.numerics, task.requests
        comm, progress = task.comm, task.progress
        degree, cap = numerics.degree, 2.0 * numerics.degree
        free = parameters.contact == "none" and parameters.phase == "inflation"
        disk = parameters.material, parameters.beta, parameters.k, parameters.l
        terms = range(FIRST_TERMS, FIRST_TERMS + MORE_TERMS * numerics.levels, MORE_TERMS)
        runs = [
            inflation(
                comm.py2f(),
                DiskData(*disk, cells // 2, degree, parameters.M if free else 1.0, parameters.own_thickness),
                parameters.adhesion,
                parameters.p_end,
                numerics.step,
                count,
            )
            for cells, count in zip(numerics.meshes, terms, strict=True)
        ]

        def family(
            part: Callable[[DiskPhases], SolutionCurve], slow: Slow | None = None, of: type = DiskFamily
        ) -> DiskFamily:
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
                raise AbsentError(
                    "contact", f"circular: phase = 'peeling' needs a patch, and {runs[-1].untouched}"
                )
            return {"primary": family(lambda run: PeelingBranch(run, p), SERIES, PeelingFamily)}
        if free:
            inflated = family(lambda run: _free(run, parameters.t_end))
            return {"primary": PiecewiseFamily([Piece(inflated, NO_PATCH)])}
        branch = contact_branch(
            runs,
            lambda part, frozen: family(part, SERIES if frozen else None),
            parameters.contact == "adhesive",
            parameters.phase == "deflation",
            NO_PATCH,
            lambda: _onset(runs, numerics.degree),
        )
        return {"primary": branch}

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


def _free(run: DiskPhases, t_end: float) -> EquilibriumBranch:
    """Free inflation up to a height, or to where the law takes no more."""
    branch = run.inflate(t_end)
    if branch.ended:
        branch.ended = f"circular: {branch.ended}; lower t_end"
    return branch


def _onset(runs: list[DiskPhases], degree: int) -> SpecialPoint:
    shown = [n for n in runs[-1].free.shown if n not in NO_PATCH]
    caps = dict.fromkeys(TRACES, float(degree)) | dict.fromkeys(MOVING_POINTS, 2.0)
    highest = order_at_pole(degree)  # for all columns, because the height of the pole is prescribed
    point = special_point([run.onset for run in runs], shown, highest, "primary", "p", caps)
    point.uncertainty["X_iso"] += rounded(point.values["X_iso"])
    return point


@lru_cache(maxsize=9)
def inflation(
    handle: int, data: DiskData, adhesion: str, p_end: float, step: float, terms: int
) -> DiskPhases:
    """Inflation on one mesh; it is kept for deflation and for all peeling curves, which start with it."""
    return DiskPhases(MPI.Comm.f2py(handle), data, adhesion, p_end, step, terms)
