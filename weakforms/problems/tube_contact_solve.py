"""Constrained inflation of the tube on a family of meshes: pieces, special points, failures."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from mpi4py import MPI

from weakforms.problems.base import Progress
from weakforms.problems.tube_contact import ContactData
from weakforms.problems.tube_contact_runs import ContactRun
from weakforms.results import SpecialPoint
from weakforms.solvers.branch import SolutionCurve
from weakforms.solvers.family import BranchFamily, special_point
from weakforms.solvers.pieces import Piece, PiecewiseFamily
from weakforms.solvers.refinement import Slow

if TYPE_CHECKING:
    from weakforms.problems.tube_problem import TubeNumerics, TubeParameters

FIRST_TERMS, MORE_TERMS = 14, 4
"""Terms of the stuck patch's series on the coarsest mesh, and how many each finer mesh adds."""

SERIES = Slow(size=6e-8, order=2.0)
"""What the series leaves out, which falls by little from mesh to mesh."""

CAP_UNILATERAL = 1.0
"""Highest order of convergence reckoned with where a unilateral spring lets go inside a cell. Else it is that
of a free tube, but for what the series of a stuck patch leaves out."""

TRACES = ("line_force", "line_force_membrane")
SECOND = ("traction_front", "traction_max", "f_t")
"""Columns that hold first derivatives at the edge of the patch: their order is the degree at most; and second
derivatives. The curvature there follows from the balance of forces at a vertex: one order below energies."""

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
"""Columns of the free part, where there is no patch."""


def contact_family(
    parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> PiecewiseFamily:
    """The branch of a constrained tube: free and in contact, or deflating."""
    free = 2 * numerics.degree
    cap = CAP_UNILATERAL if parameters.spring == "unilateral" else free
    runs = [_run(level, parameters, numerics, comm) for level in range(numerics.levels)]

    def family(part: Callable[[ContactRun], SolutionCurve], cap: float, slow: Slow | None) -> BranchFamily:
        def make(level: int) -> SolutionCurve:
            progress("branch", level, numerics.levels)
            return part(runs[level])

        caps = dict.fromkeys(TRACES, min(cap, numerics.degree)) | dict.fromkeys(SECOND, min(cap, 2.0))
        caps["kappa"] = min(cap, free - 1)
        return BranchFamily(make, numerics.levels, cap, across=("p", "u_max"), caps=caps, slow=slow)

    runs[-1].onset  # noqa: B018  (refuses a p_end before contact, before more is solved)
    if parameters.phase == "deflation":
        return PiecewiseFamily([Piece(family(lambda run: run.deflation, cap, SERIES), {})])
    history = SERIES if parameters.contact == "adhesive" else None
    pieces = [
        Piece(family(lambda run: run.free, free, None), NO_PATCH | {"kappa": float("nan")}),
        Piece(family(lambda run: getattr(run, parameters.contact), free, history), {}),
    ]

    def onset() -> list[SpecialPoint]:
        shown = [n for n in runs[-1].free.shown if n not in NO_PATCH and n != "kappa"]
        same = [run.onset for run in runs]
        return [special_point(same, shown, free, "primary", "p", {"t2_min": 2.0})]

    return PiecewiseFamily(pieces, onset)


def _run(level: int, parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm) -> ContactRun:
    data = ContactData(
        alpha=parameters.alpha,
        delta1=parameters.delta1,
        lf=parameters.lf,
        k=parameters.k,
        s=parameters.s,
        cells=numerics.meshes[level] // 2,
        degree=numerics.degree,
        grading=numerics.grading,
        material=parameters.material,
        unilateral=parameters.phase == "deflation" and parameters.spring == "unilateral",
    )
    return ContactRun(comm, data, parameters.p_end, numerics.step, FIRST_TERMS + MORE_TERMS * level)
