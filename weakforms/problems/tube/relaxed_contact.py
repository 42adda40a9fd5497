"""Frictionless contact of a tube that cannot bear compression: it wrinkles between its patch and the disks.

The relaxed energy acts on the stretches and the substrate on the radius. A tube that is taut has the states
of the law. While it has a wrinkled zone, the mesh follows the edge of the patch and both ends of the zone, at
once: three scalar unknowns besides the pressure, or two where the zone ends at the disk. Before first contact
the same mesh serves, with the edge of the patch kept near mid-length and without springs. Zones open and
close before and after it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property

from mpi4py import MPI

from weakforms.errors import AbsentError, InputError
from weakforms.problems.contact.guesses import transferred
from weakforms.problems.contact.inflation import highest
from weakforms.problems.tube.contact import ContactData, ContactModel
from weakforms.problems.tube.folds import (
    MISFIT,
    Folds,
    Verge,
    at_disk,
    cut,
    follow,
    leaving,
    opening,
    unlike,
    zone_breaks,
)
from weakforms.problems.tube.phases import TubePhases
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch, MirroredBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.constraints import Held


class FoldedContact(Folds, ContactModel):
    """Weak form of the tube in contact with a mesh that follows its patch and its wrinkled zone.

    Loads besides those of :class:`ContactModel`: the fronts ``Z_front_1 < Z_front_2``; a whole tube has their
    mirror images too.

    Args:
        comm: Ranks.
        data: Tube, substrate and mesh.
        to_disk: Whether the zone ends at the disk, and not before.
    """

    def __init__(self, comm: MPI.Intracomm, data: ContactData, to_disk: bool) -> None:
        super().__init__(comm, replace(data, zone=tuple(zone_breaks(data.length, to_disk))))
        self.fold(to_disk)


COARSER = 10.0
"""By which factor a larger misfit is allowed on a mesh with cells twice as long: on each of them the branch
ends where another zone opens."""


JUST = 1e-6
"""Fraction of the way to the substrate that is rounding."""


@dataclass(frozen=True)
class Part:
    """A part of the branch on which the tube is taut throughout, or has a wrinkled zone."""

    branch: SolutionCurve
    disk: bool | None = None
    """Whether the zone ends at the disk; ``None`` without a zone."""
    begins: Solved | None = None
    """Where the zone opens or closes with which it begins; ``None`` if it begins in another way."""
    closes: bool = False
    """Whether it ends where its zone closes."""
    leaves: bool = False
    """Whether it ends where its zone leaves the disk."""


class RelaxedContact(TubePhases):
    """Frictionless inflation with the relaxed energy on one mesh; each part is solved when first needed.

    Args:
        comm: Ranks.
        data: Tube, substrate and mesh.
        p_end: Pressure at which inflation ends.
        step: Largest arc-length step.
        coarser: How many meshes are finer.
    """

    def __init__(
        self, comm: MPI.Intracomm, data: ContactData, p_end: float, step: float, coarser: int
    ) -> None:
        super().__init__(comm, data, p_end, step)
        self.verge, self.finest = Verge(self.slip), coarser == 0
        self._misfit = MISFIT * COARSER**coarser
        self.folded = cache(lambda to_disk: FoldedContact(comm, data, to_disk))

    # -- free ----------------------------------------------------------------------------------

    @cached_property
    def parts(self) -> list[Part]:
        """Free inflation up to first contact, as far as it goes; see :meth:`settle`.

        Raises:
            AbsentError: If its meridian is compressed from the first states on.
            ConvergenceError: If it does not become taut where its zone closes.
            InputError: If it touches with a zone that is smaller than is followed.
        """
        return self._continued(Part(self.inflate(self.data.touch)), free=True)

    @cached_property
    def inflated(self) -> EquilibriumBranch:
        """The last part of free inflation."""
        return self.parts[-1].branch

    @property
    def order(self) -> tuple[bool, list[bool | None]]:
        """Whether free inflation reaches first contact, and :attr:`Part.disk` of its parts."""
        deepest = self.inflated.points[-1].monitors[self.depth]
        return deepest > (1 - JUST) * self.data.touch, [part.disk for part in self.parts]

    @property
    def highest(self) -> float:
        """Largest pressure of free inflation, as far as it goes."""
        return max(highest(part.branch) for part in self.parts)

    @cached_property
    def until_end(self) -> EquilibriumBranch:
        """The last part of free inflation up to ``p_end``, if that is below first contact.

        Raises:
            InputError: If ``p_end`` is reached with a zone that is smaller than is followed.
        """
        last = next(n for n, part in enumerate(self.parts) if highest(part.branch) >= self.p_end)
        if last:
            before, after = self.parts[last - 1].branch.points[-1], self.parts[last].branch.points[0]
            _require_followed("p_end", self.p_end, before.state.loads["p"], after.state.loads["p"])
        del self.parts[last + 1 :]
        return self._until_end(self.parts[last].branch)

    def settle(self) -> None:
        """Leave out the parts of free inflation beyond ``p_end``, if that is below first contact."""
        try:
            if self.untouched:
                _ = self.until_end
        except AbsentError:
            return

    # -- in contact ----------------------------------------------------------------------------

    @cached_property
    def frictionless(self) -> FittedBranch:
        """The first part in contact."""
        return self.touching[0].branch

    @cached_property
    def touching(self) -> list[Part]:
        """The parts in contact; the first one is taut if the tube is when it touches.

        Raises:
            AbsentError: If its meridian is compressed from the first states on.
            ConvergenceError: If it does not become taut where its zone closes.
        """
        disk = self.parts[-1].disk
        if disk is None:
            first = Part(self._follow(self.slip, self.small_patch()))
        else:
            first = self._wrinkled(lambda along: self._first_contact(along, self.small_patch()), disk, False)
        return self._continued(first, free=False)

    # -- from part to part ---------------------------------------------------------------------

    def _continued(self, first: Part, free: bool) -> list[Part]:
        parts, after = [], first
        while after:
            parts.append(after)
            after = self._after(after, free)
        return parts

    def _after(self, part: Part, free: bool) -> Part | None:
        """The part that begins where a zone opens or closes; the one before is cut there."""
        if part.leaves:
            last, inside = part.branch.points[-1].state, self.folded(False)
            return self._wrinkled(leaving(self.folded(True), last, inside), False, free)
        if part.disk is not None:
            return self._taut(part, free) if part.closes else None
        branch, first = part.branch, self.verge.first(part.branch)
        if free and first and first[1].values[self.depth] >= self.data.touch:
            first = None
        slack = self.verge.slack(branch.points).tolist() if self.finest else []
        if slack and (not first or slack[0] <= first[0]):
            self._end_slack(branch, slack[0], free)
            return None
        if not first:
            return None
        cut(branch, *first)
        wrinkle, disk = first[1], at_disk(first[1], self.data.length)
        return self._wrinkled(opening(self.slip, wrinkle, self.folded(disk)), disk, free, wrinkle)

    @staticmethod
    def _end_slack(branch: SolutionCurve, at: int, free: bool) -> None:
        why = f"at p = {branch.points[at].state.loads['p']:.6g} its meridian is compressed"
        if at < 2:
            raise AbsentError("relaxed states", f"tube: {why}; raise delta1")
        del branch.points[at:]
        why += ", which is not followed"
        branch.stalled, branch.ended = None, why if free else f"tube: {why}; lower p_end"

    def _wrinkled(
        self,
        start: Callable[[Continuation], CurvePoint],
        disk: bool,
        free: bool,
        wrinkle: Solved | None = None,
    ) -> Part:
        """The tube with a wrinkled zone, or with one at either disk.

        Args:
            start: Finds the first state.
            disk: Whether the zone ends at the disk.
            free: Whether the tube is inflated freely.
            wrinkle: Where the zone opens; ``None`` if it is open already.
        """
        model, length = self.folded(disk), self.data.length

        def enough(point: CurvePoint) -> bool:
            if free:
                return point.monitors[self.depth] > self.data.touch
            return point.state.loads["p"] > self.p_end

        def ends(point: CurvePoint) -> str:
            if point.state.loads["front"] > self.last_front * length:
                return f"there the patch holds {self.last_front:g} of the {self.whole}"
            return self.gives_way(point) or unlike(point, self._misfit)

        edges = {} if free else {name: gap for name, (gap, _) in model.edges.items()}
        kind = FittedBranch if edges and len(edges) == 1 else MirroredBranch
        followed = follow(model, edges, self.steps(16), start, enough, ends, kind, disk)
        branch, ended = followed.branch, followed.ended
        if free and wrinkle:
            self._require_above(wrinkle.values[self.depth], branch.points[0].monitors[self.depth])
        last = branch.points[-1]
        reached = f"p = {last.state.loads['p']:.6g}"
        if free:
            reached = f"u_max = {last.monitors[self.depth]:.6g}"
        until = f"wrinkled states{'' if free else ' in contact'} were followed up to {reached}"
        if ended:
            branch.stalled, branch.ended = None, f"{until}: {ended}"
            if not free:
                branch.ended = f"tube: {branch.ended}; lower p_end"
        elif branch.stalled:
            branch.stalled = f"{until}: {branch.stalled}"
            if not free:
                branch.stalled = f"tube: {branch.stalled}; lower p_end, or raise cells"
        return Part(branch, disk, wrinkle, followed.closes, followed.leaves)

    def _taut(self, part: Part, free: bool) -> Part:
        """The tube that is taut again, from where the zone closes."""
        last = part.branch.points[-1]
        state, at = transferred(self.folded(part.disk), last.state, self.slip, {}), last.monitors[self.depth]
        if free:
            branch = self.inflate(self.data.touch, (state, Held(self.depth, at)))
        else:
            edge, onwards = Held("front", last.state.loads["front"]), {"front": last.tangent.loads["front"]}
            branch = self._follow(self.slip, state, lambda along: along.start(state, edge, onwards))
        closing = self.verge.closing(branch, f"u_max = {at:.6g}")
        if free:
            self._require_above(at, closing.values[self.depth])
        return Part(branch, begins=closing)

    def _require_above(self, before: float, after: float) -> None:
        _require_followed("s", self.data.s, 1 + before, 1 + after)


def _require_followed(name: str, given: float, before: float, after: float) -> None:
    """Refuse a parameter at which the branch ends while the zone is smaller than is followed."""
    if before < given <= after:
        raise InputError(
            f"tube: energy = 'relaxed': {name} = {given:g} is reached while the wrinkled zone is too small "
            f"to be followed; lower {name} below {before:.6g}, or raise it above {after:.6g}"
        )
