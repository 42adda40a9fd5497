"""Free inflation of a tube that bears no compression on a family of meshes: taut, wrinkled, taut again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from mpi4py import MPI

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.material_choice import require_foldable
from weakforms.problems.meridian.compression import SLOPES
from weakforms.problems.problem import Progress
from weakforms.problems.tube.contact_family import contact_caps, contact_data, contact_parts
from weakforms.problems.tube.folds import FRACTION, FRONTS
from weakforms.problems.tube.model import TubeMesh
from weakforms.problems.tube.parameters import TubeNumerics, TubeParameters
from weakforms.problems.tube.relaxed import RelaxedTube
from weakforms.problems.tube.relaxed_contact import RelaxedContact
from weakforms.results import Quantity, SpecialPoint
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.points import special_point

Family = TypeVar("Family", bound=BranchFamily)

EPSILON = 2.0**-53
"""Round-off of a number of order one."""

NO_ZONE = {FRACTION: 0.0} | dict.fromkeys(FRONTS, float("nan"))
"""Columns of a taut tube."""


class WrinkledFamily(BranchFamily):
    r"""Wrinkled states, whose fronts have round-off while their zone is small.

    In cells of length ``h`` and degree ``d`` stretches have a round-off of :math:`\epsilon d^2/h`. It is
    divided by the slope of ``gw`` at a front, which is of the size of the zone.
    """

    noise = 0.0
    """This round-off times the square of ``wrinkled_fraction``."""

    def left_by_round_off(self, index: int) -> Mapping[str, float]:
        """Of the fronts and of the size of the zone."""
        return self._left(self.fine.points[index].monitors[FRACTION])

    def _left(self, fraction: float) -> dict[str, float]:
        return {n: self.noise / fraction**2 for n in (FRACTION, *FRONTS) if n in self.fine.shown}

    def _columns(
        self, solved: Sequence[Solved], held: str, orders: Mapping[str, float]
    ) -> dict[str, Quantity]:
        found = super()._columns(solved, held, orders)
        left = self._left(solved[-1].values[FRACTION])
        return found | {
            name: replace(found[name], uncertainty=found[name].uncertainty + more)
            for name, more in left.items()
        }


def alike(answers: Sequence[bool]) -> bool:
    """What the runs on all meshes say.

    Raises:
        ConvergenceError: If they disagree.
    """
    if len(set(answers)) > 1:
        raise ConvergenceError("tube: a zone of wrinkles is on some meshes only; raise cells")
    return answers[-1]


def first_wrinkle(solved: Sequence[Solved], shown: Sequence[str], degree: int) -> SpecialPoint:
    """The state on all meshes at which a zone opens or closes, with the place."""
    # Where ``gw`` touches 1 inside of a cell it has the order of stretches, and its place that of slopes.
    lower = dict.fromkeys(FRONTS, degree - 1.0)
    at = special_point(solved, shown, float(degree), "primary", "p", lower)
    return replace(at, uncertainty=at.uncertainty | {n: at.uncertainty[n] + SLOPES for n in FRONTS})


def relaxed_family(
    parameters: TubeParameters,
    numerics: TubeNumerics,
    comm: MPI.Intracomm,
    progress: Progress,
    caps: Mapping[str, float],
) -> PiecewiseFamily:
    """The branch of the relaxed energy on all meshes: taut, wrinkled, and taut again.

    Args:
        parameters: The tube.
        numerics: Meshes.
        comm: Ranks.
        progress: Called for every mesh.
        caps: Lower orders of some columns.

    Raises:
        ConvergenceError: If the meshes disagree about what the tube does.
    """
    # Fronts are where a stretch, a one-sided derivative, has a value.
    caps = {**caps, **dict.fromkeys((FRACTION, *FRONTS), float(numerics.degree))}
    full, order = parameters.extent == "full", 2 * numerics.degree
    meshes = [TubeMesh(n, numerics.degree, numerics.grading, full) for n in numerics.meshes]
    runs = [RelaxedTube(comm, parameters, at, numerics.step, at is meshes[-1]) for at in meshes]

    def family(part: Callable[[RelaxedTube], SolutionCurve], kind: type[Family] = BranchFamily) -> Family:
        def make(level: int) -> SolutionCurve:
            progress("branch", level, numerics.levels)
            return part(runs[level])

        return kind(make, numerics.levels, order, across=("p", "u_max"), caps=caps)

    def joint(solved: Callable[[RelaxedTube], Solved]) -> SpecialPoint:
        shown = (*runs[-1].free.shown, *FRONTS)
        return first_wrinkle([solved(run) for run in runs], shown, numerics.degree)

    pieces, joints = [Piece(family(lambda run: run.free), NO_ZONE)], []
    if alike([run.onset is not None for run in runs]):
        joints.append(lambda run: run.onset)
        fixed = {FRONTS[1]: parameters.lf / 2} if alike([run.to_disk for run in runs]) else {}
        wrinkled = family(lambda run: run.wrinkled, WrinkledFamily)
        wrinkled.noise = EPSILON * numerics.degree**2 * meshes[-1].cells / (parameters.lf / 2) ** 2
        pieces.append(Piece(wrinkled, fixed))
        if alike([run.closes for run in runs]):
            joints.append(lambda run: run.closing)
            pieces.append(Piece(family(lambda run: run.smooth), NO_ZONE))
    return PiecewiseFamily(pieces, lambda: [joint(at) for at in joints])


def relaxed_contact_family(
    parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> PiecewiseFamily:
    """The branch of a tube with the relaxed energy that is inflated against its substrate, on all meshes.

    Raises:
        ConvergenceError: If the meshes disagree about whether, or where, it wrinkles.
    """
    finest = numerics.levels - 1
    runs = [
        RelaxedContact(
            comm, contact_data(parameters, numerics, level), parameters.p_end, numerics.step, level == finest
        )
        for level in range(numerics.levels)
    ]
    whole = contact_parts(runs, parameters, numerics, progress)
    whole.pieces = [replace(piece, fixed={**NO_ZONE, **piece.fixed}) for piece in whole.pieces]
    if len(whole.pieces) < 2 or not alike([run.wrinkle is not None for run in runs]):
        return whole
    caps = contact_caps(numerics, frozen=False) | dict.fromkeys((FRACTION, *FRONTS), float(numerics.degree))

    def make(level: int) -> SolutionCurve:
        progress("branch", level, numerics.levels)
        return runs[level].wrinkled

    wrinkled = WrinkledFamily(make, numerics.levels, 2 * numerics.degree, across=("p", "u_max"), caps=caps)
    cells = numerics.meshes[-1] // 2
    wrinkled.noise = EPSILON * numerics.degree**2 * cells / (parameters.lf / 2) ** 2
    fixed = {FRONTS[1]: parameters.lf / 2} if alike([run.to_disk for run in runs]) else {}

    def joints() -> list[SpecialPoint]:
        shown = [*whole.pieces[1].family.fine.shown, *FRONTS]
        return [*whole.joints(), first_wrinkle([run.wrinkle for run in runs], shown, numerics.degree)]

    return PiecewiseFamily([*whole.pieces, Piece(wrinkled, fixed)], joints)


def require_relaxed_possible(parameters: TubeParameters) -> None:
    """Refuse what is not known of a tube that wrinkles, and laws without a natural width.

    Raises:
        InputError: With a message that names the parameter.
    """
    if parameters.contact == "adhesive":
        raise InputError(
            "tube: energy = 'relaxed' with contact = 'adhesive': the history of a patch that sticks is known "
            "of a taut tube only; set contact = 'frictionless' or 'none', or energy = 'standard'"
        )
    others = {"n": (), "uneven": 0.0}
    for name, without in others.items():
        if getattr(parameters, name) != without:
            raise InputError(
                "tube: energy = 'relaxed' is for axisymmetric inflation of an even tube and for bent states; "
                f"set {name} = {without!r}, or energy = 'standard'"
            )
    if parameters.secondary and not parameters.secondary_n:
        raise InputError(
            "tube: energy = 'relaxed' with secondary = true, secondary_n = 0: lopsided states are those of a "
            "tube that bears compression; set secondary_n = 1 (up to 6; extent = 'half'), secondary = false, "
            "or energy = 'standard'"
        )
    require_foldable("tube: energy = 'relaxed'", parameters, invariants=parameters.secondary)
