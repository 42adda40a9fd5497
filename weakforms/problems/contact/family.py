"""The branch of a membrane against its substrate, on all meshes: free and in contact, or deflation."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter

from weakforms.errors import AbsentError, InputError
from weakforms.problems.contact.phases import ContactPhases
from weakforms.results import Absence, SpecialPoint
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.uncertainty.family import BranchFamily

MakeFamily = Callable[[Callable[[ContactPhases], SolutionCurve], bool], BranchFamily]
"""Makes the family of a phase, and is told whether its patch has a history."""


def contact_branch(
    runs: Sequence[ContactPhases],
    family: MakeFamily,
    sticks: bool,
    deflates: bool,
    no_patch: Mapping[str, float],
    onset: Callable[[], SpecialPoint],
) -> PiecewiseFamily:
    """The branch in parts, or the free branch and why there is no contact.

    Args:
        runs: The phases on every mesh, coarse to fine.
        family: See :data:`MakeFamily`.
        sticks: Whether what touches sticks.
        deflates: Whether the branch is deflation, instead of inflation.
        no_patch: Values of columns on the free part, where there is no patch.
        onset: The special point of first contact.

    Raises:
        InputError: If what deflates never touches.
    """

    def alone(part: Callable[[ContactPhases], SolutionCurve], why: str) -> PiecewiseFamily:
        return PiecewiseFamily([Piece(family(part, False), no_patch)], absent=[Absence("contact", why)])

    try:
        untouched = runs[-1].untouched
    except AbsentError as error:
        if deflates:
            raise InputError(str(error)) from error
        return alone(lambda run: run.inflated, str(error))
    if untouched:
        why = f"{runs[-1].name}: {untouched}"
        return alone(lambda run: run.emptied if deflates else run.until_end, why)
    if deflates:
        parts = [attrgetter(name) for name in runs[-1].deflations]
        return PiecewiseFamily([Piece(family(part, True), {}) for part in parts])
    free = Piece(family(lambda run: run.free, False), no_patch)
    try:
        touching = Piece(family(lambda run: run.adhesive if sticks else run.frictionless, sticks), {})
    except AbsentError as error:  # without friction the law gives way below p_end
        return PiecewiseFamily([free], absent=[Absence(error.what, str(error))])
    return PiecewiseFamily([free, touching], lambda: [onset()])
