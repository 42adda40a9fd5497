"""Constrained inflation of the tube on a family of meshes: parts, special points, failures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from mpi4py import MPI

from weakforms.problems.contact.family import MakeFamily, contact_branch
from weakforms.problems.meridian.kinks import FRACTION
from weakforms.problems.problem import Progress
from weakforms.problems.tube.contact import ContactData
from weakforms.problems.tube.folds import FRONTS
from weakforms.problems.tube.parameters import TubeNumerics, TubeParameters
from weakforms.problems.tube.phases import TubePhases
from weakforms.results import SpecialPoint
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.continuation.pieces import PiecewiseFamily
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.points import special_point
from weakforms.solvers.uncertainty.refinement import Slow

FIRST_TERMS, MORE_TERMS = 19, 4
"""Number of terms of the stuck patch's series on the coarsest mesh, and the increase for each finer mesh."""

SERIES = Slow(size=3e-8, order=2.0)
"""Truncation error of the series, which decreases slowly from mesh to mesh."""

LINE_FORCES = ("line_force", "line_force_membrane")
AT_FRONT = (*LINE_FORCES, "kappa")
TRACTIONS = ("traction_front", "traction_max")
"""Columns that contain first derivatives at the edge of the patch, a vertex of the mesh: their order is one
below that of energies. So do tractions of a stuck patch, by the balance of forces; those of a frictionless
one, which are zero, contain second derivatives."""

EPSILON = 2.0**-53
"""Round-off of a number of order one."""

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

NO_CONTACT = NO_PATCH | {"kappa": float("nan")}
"""The same with columns that have no value there."""


class TubeContactFamily(BranchFamily):
    """A part of the branch of a constrained tube."""

    def left_by_round_off(self, index: int) -> Mapping[str, float]:
        r"""Tractions, where a spring has just let go: in a block of width ``w`` slopes multiply round-off.

        In the balance of forces, positions known to :math:`\epsilon` leave :math:`\epsilon (z_f / w)^2`.
        """
        loads = self.fine.points[index].state.loads
        if "let_go" not in loads:
            return {}
        width = 1 - loads["let_go"] / loads["front"]
        return dict.fromkeys((*TRACTIONS, *LINE_FORCES), EPSILON / width**2)


def contact_caps(numerics: TubeNumerics, frozen: bool) -> dict[str, float]:
    """Lower orders of some columns, of a patch that has a history or that slides."""
    cap = 2 * numerics.degree
    caps = dict.fromkeys(AT_FRONT, cap - 1) | dict.fromkeys(TRACTIONS, cap - 1 if frozen else 2.0)
    return caps | {"f_t": numerics.degree if frozen else 2.0}


def contact_data(parameters: TubeParameters, numerics: TubeNumerics, level: int) -> ContactData:
    """Tube, substrate and the mesh of a level."""
    return ContactData(
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


def contact_family(
    parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> PiecewiseFamily:
    """The branch of a constrained tube: free and in contact, or in deflation."""
    runs = [
        TubePhases(
            comm,
            contact_data(parameters, numerics, level),
            parameters.p_end,
            numerics.step,
            FIRST_TERMS + MORE_TERMS * level,
        )
        for level in range(numerics.levels)
    ]
    return contact_parts(runs, parameters, numerics, progress)


def contact_parts(
    runs: Sequence[TubePhases],
    parameters: TubeParameters,
    numerics: TubeNumerics,
    progress: Progress,
    zone: MakeFamily | None = None,
) -> PiecewiseFamily:
    """The parts of the branch that the phases on all meshes have.

    Args:
        runs: The phases on all meshes.
        parameters: Tube and substrate.
        numerics: Meshes.
        progress: Called for every mesh.
        zone: Makes the families of all parts, if the tube has a wrinkled zone on them.
    """
    cap = 2 * numerics.degree

    def family(part: Callable[[TubePhases], SolutionCurve], frozen: bool) -> BranchFamily:
        def make(level: int) -> SolutionCurve:
            progress("branch", level, numerics.levels)
            return part(runs[level])

        caps, slow = contact_caps(numerics, frozen), SERIES if frozen else None
        return TubeContactFamily(make, numerics.levels, cap, across=("p", "u_max"), caps=caps, slow=slow)

    def onset() -> SpecialPoint:
        shown = [n for n in runs[-1].free.shown if n not in NO_PATCH and n != "kappa"]
        lower = {"t2_min": 2.0} | dict.fromkeys((FRACTION, *FRONTS), float(numerics.degree))
        return special_point([run.onset for run in runs], shown, cap, "primary", "p", lower)

    sticks, deflates = parameters.contact == "adhesive", parameters.phase == "deflation"
    return contact_branch(runs, zone or family, sticks, deflates, NO_CONTACT, onset)
