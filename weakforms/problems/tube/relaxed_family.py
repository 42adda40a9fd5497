"""Free inflation of a tube that bears no compression on a family of meshes: taut, wrinkled, taut again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import TypeVar

from mpi4py import MPI

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.material_choice import require_foldable
from weakforms.problems.meridian.compression import SLOPES
from weakforms.problems.meridian.kinks import FRACTION
from weakforms.problems.problem import Progress
from weakforms.problems.tube.contact_family import NO_CONTACT, contact_caps, contact_data, contact_parts
from weakforms.problems.tube.folds import FRONTS
from weakforms.problems.tube.model import TubeMesh
from weakforms.problems.tube.parameters import TubeNumerics, TubeParameters
from weakforms.problems.tube.relaxed import RelaxedTube
from weakforms.problems.tube.relaxed_contact import Part, RelaxedContact
from weakforms.results import Quantity, SpecialPoint
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.points import special_point

Family = TypeVar("Family", bound=BranchFamily)
Answer = TypeVar("Answer")

ORDER = "zones open and close, before and after first contact, in another order on another mesh"
"""What it means that meshes disagree, as text."""

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


def alike(answers: Sequence[Answer], otherwise: str = "a zone of wrinkles is on some meshes only") -> Answer:
    """What the runs on all meshes say.

    Args:
        answers: Of every mesh, coarse to fine.
        otherwise: What it means that they differ, as text.

    Raises:
        ConvergenceError: If they disagree.
    """
    if any(answer != answers[-1] for answer in answers):
        raise ConvergenceError(f"tube: {otherwise}; raise cells")
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
            comm, contact_data(parameters, numerics, level), parameters.p_end, numerics.step, finest - level
        )
        for level in range(numerics.levels)
    ]
    caps = contact_caps(numerics, frozen=False) | dict.fromkeys((FRACTION, *FRONTS), float(numerics.degree))

    def made(part: Callable[[RelaxedContact], SolutionCurve], kind: type[Family] = BranchFamily) -> Family:
        def make(level: int) -> SolutionCurve:
            progress("branch", level, numerics.levels)
            return part(runs[level])

        return kind(make, numerics.levels, 2 * numerics.degree, across=("p", "u_max"), caps=caps)

    def wrinkled(part: Callable[[RelaxedContact], SolutionCurve], _frozen: bool = False) -> WrinkledFamily:
        family, cells = made(part, WrinkledFamily), numerics.meshes[-1] // 2
        family.noise = EPSILON * numerics.degree**2 * cells / (parameters.lf / 2) ** 2
        return family

    def zone(disk: bool | None) -> dict[str, float]:
        """Columns that are constant on a part with such a zone, or without one."""
        return NO_ZONE if disk is None else {FRONTS[1]: parameters.lf / 2} if disk else {}

    def piece(part: Callable[[RelaxedContact], Part], none: Mapping[str, float]) -> Piece:
        disk = part(runs[-1]).disk
        family = (made if disk is None else wrinkled)(lambda run: part(run).branch)
        return Piece(family, {**none, **zone(disk)})

    def joint(part: Callable[[RelaxedContact], Part], beside: Sequence[Piece]) -> SpecialPoint | None:
        if part(runs[-1]).begins is None:  # a zone leaves the disk
            return None
        taut = next(piece for piece in beside if FRACTION in piece.fixed)
        shown = [name for name in taut.family.fine.shown if name not in taut.fixed]
        return first_wrinkle([part(run).begins for run in runs], [*shown, *FRONTS], numerics.degree)

    for run in runs:
        run.settle()
    _, free = alike([run.order for run in runs], ORDER)
    whole = contact_parts(runs, parameters, numerics, progress, None if free[-1] is None else wrinkled)
    touches, touch = len(whole.pieces) > 1, whole.joints
    contact = alike([[part.disk for part in run.touching] for run in runs], ORDER) if touches else []
    before, beyond = (
        [partial(_part, name, n) for n in range(1, len(parts))]
        for name, parts in (("parts", free), ("touching", contact))
    )
    whole.pieces = [
        *(piece(partial(_part, "parts", n), NO_CONTACT) for n in range(len(before))),
        *(replace(part, fixed={**part.fixed, **zone(free[-1])}) for part in whole.pieces),
        *(piece(part, {}) for part in beyond),
    ]
    beside = list(pairwise(whole.pieces))

    def joints() -> list[SpecialPoint | None]:
        opened = [joint(*of) for of in zip(before, beside, strict=False)]
        later = beside[len(before) + touches :]
        return [*opened, *touch(), *(joint(*of) for of in zip(beyond, later, strict=True))]

    whole.joints = joints
    return whole


def _part(name: str, n: int, run: RelaxedContact) -> Part:
    return getattr(run, name)[n]


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
                "tube: energy = 'relaxed' is for axisymmetric, lopsided and bent states of an even tube; "
                f"set {name} = {without!r}, or energy = 'standard'"
            )
    require_foldable("tube: energy = 'relaxed'", parameters, invariants=parameters.secondary)
