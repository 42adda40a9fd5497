"""Constrained inflation of the tube on a family of meshes: parts, special points, failures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import ClassVar

from mpi4py import MPI

from weakforms.problems.contact.family import contact_branch
from weakforms.problems.problem import Progress
from weakforms.problems.tube.contact import ContactData
from weakforms.problems.tube.parameters import TubeNumerics, TubeParameters
from weakforms.problems.tube.phases import TubePhases
from weakforms.results import SpecialPoint
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.continuation.pieces import PiecewiseFamily
from weakforms.solvers.uncertainty.family import BranchFamily, special_point
from weakforms.solvers.uncertainty.refinement import Slow

FIRST_TERMS, MORE_TERMS = 14, 4
"""Number of terms of the stuck patch's series on the coarsest mesh, and the increase for each finer mesh."""

SERIES = Slow(size=6e-8, order=2.0)
"""Truncation error of the series, which decreases slowly from mesh to mesh."""

LET_GO = Slow(size=1e-7, order=2.0)
"""The same with the quadrature error at the kink of a unilateral spring's force inside a cell."""

TRACES = ("line_force", "line_force_membrane")
EDGE_COLUMNS = ("traction_front", "traction_max", "f_t")
"""Columns with first derivatives at the edge of the patch, whose order is at most the degree, and with second
derivatives. The curvature there follows from the balance of forces at a vertex, with an order one below that
of energies."""

KINK_ORDERS = (
    dict.fromkeys(("rho", "lam2"), 3.0)
    | dict.fromkeys(("lam1", "t1", "t2", "F_axial", "H", "f_k"), 2.0)
    | {"f_t": 1.0, "eigenvalue_1": 1.0}
)
"""Highest orders if a unilateral spring goes slack inside a cell. Profiles have a jump in the third
derivative there. For eigenvalues the stiffness itself jumps, and the quadrature error is of first order and
depends on the position in the cell."""

NO_PATCH = {
    name: 0.0
    for name in (
        "Z_front",
        "contact_length",
        "line_force",
        "line_force_membrane",
        "traction_front",
        "traction_max",
        "spring_max",
    )
}
"""Values of columns on the free part, where there is no patch."""


class UnilateralFamily(BranchFamily):
    """The family of a tube with a unilateral spring, which goes slack inside a cell."""

    least: ClassVar[Mapping[str, float]] = {"eigenvalue_1": 1.0}


def contact_family(
    parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> PiecewiseFamily:
    """The branch of a constrained tube: free and in contact, or in deflation."""
    cap = 2 * numerics.degree
    runs = [_run(level, parameters, numerics, comm) for level in range(numerics.levels)]
    unilateral = runs[-1].data.unilateral

    def family(part: Callable[[TubePhases], SolutionCurve], frozen: bool) -> BranchFamily:
        def make(level: int) -> SolutionCurve:
            progress("branch", level, numerics.levels)
            return part(runs[level])

        caps = dict.fromkeys(TRACES, numerics.degree) | dict.fromkeys(EDGE_COLUMNS, min(cap, 2.0))
        caps["kappa"] = cap - 1
        kind = BranchFamily
        if unilateral:
            kind, caps = UnilateralFamily, caps | KINK_ORDERS
        slow = (LET_GO if unilateral else SERIES) if frozen else None
        return kind(make, numerics.levels, cap, across=("p", "u_max"), caps=caps, slow=slow)

    def onset() -> SpecialPoint:
        shown = [n for n in runs[-1].free.shown if n not in NO_PATCH and n != "kappa"]
        return special_point([run.onset for run in runs], shown, cap, "primary", "p", {"t2_min": 2.0})

    none = NO_PATCH | {"kappa": float("nan")}
    sticks, deflates = parameters.contact == "adhesive", parameters.phase == "deflation"
    return contact_branch(runs, family, sticks, deflates, none, onset)


def _run(level: int, parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm) -> TubePhases:
    data = ContactData(
        law=parameters.material,
        delta1=parameters.delta1,
        lf=parameters.lf,
        k=parameters.k,
        s=parameters.s,
        cells=numerics.meshes[level] // 2,
        degree=numerics.degree,
        grading=numerics.grading,
        unilateral=parameters.phase == "deflation" and parameters.spring == "unilateral",
        full=parameters.extent == "full",
    )
    return TubePhases(comm, data, parameters.p_end, numerics.step, FIRST_TERMS + MORE_TERMS * level)
