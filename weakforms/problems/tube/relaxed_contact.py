"""Frictionless contact of a tube that cannot bear compression: it wrinkles between its patch and the disks.

The relaxed energy acts on the stretches and the substrate on the radius. Up to the first wrinkle the states
are those of the law. From there on the mesh follows the edge of the patch and both ends of the wrinkled
zone, at once: three scalar unknowns besides the pressure, or two where the zone ends at the disk.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from mpi4py import MPI

from weakforms.errors import InputError
from weakforms.problems.contact.guesses import transferred
from weakforms.problems.tube.contact import ContactData, ContactModel
from weakforms.problems.tube.folds import (
    CLOSED,
    FRACTION,
    FRONTS,
    Folds,
    Verge,
    at_disk,
    point_at,
    unlike,
    zone_breaks,
)
from weakforms.problems.tube.phases import TubePhases
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch, MirroredBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton


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


class RelaxedContact(TubePhases):
    """Frictionless inflation with the relaxed energy on one mesh; each part is solved when first needed.

    Args:
        comm: Ranks.
        data: Tube, substrate and mesh.
        p_end: Pressure at which inflation ends.
        step: Largest arc-length step.
        finest: Whether it is the finest mesh, on which the states of all parts are judged.
    """

    def __init__(
        self, comm: MPI.Intracomm, data: ContactData, p_end: float, step: float, finest: bool
    ) -> None:
        super().__init__(comm, data, p_end, step)
        self.verge, self.finest = Verge(self.slip), finest

    wrinkle: Solved | None = None
    """The first wrinkle; known after :attr:`frictionless`."""

    def inflate(self, depth: float) -> EquilibriumBranch:
        """Free inflation of the taut tube.

        Raises:
            InputError: If it wrinkles, or loses its tension along the meridian, before it touches.
        """
        branch = super().inflate(depth)
        at = [*self.verge.passed(branch), *self._slack(branch)]
        if at:
            u_max = branch.points[min(at)].monitors["u_max"]
            raise InputError(
                f"tube: energy = 'relaxed' with contact = 'frictionless' is for a tube that is taut until it "
                f"touches; this one is compressed from about u_max = {u_max:.4g} on, before s = "
                f"{self.data.s:g}; lower s below {1 + u_max:.4g}, or set contact = 'none', or energy = "
                "'standard'"
            )
        return branch

    @cached_property
    def frictionless(self) -> FittedBranch:
        """Contact of the taut tube, up to the first wrinkle if there is one."""
        branch = super().frictionless
        at, slack = self.verge.passed(branch), self._slack(branch)
        if slack and (not at or slack[0] <= at[0]):
            branch.stalled, branch.ended = None, _without_tension(branch.points[slack[0]])
            del branch.points[slack[0] :]
        elif at:
            i, self.wrinkle = at[0], self.verge.touch(branch, at[0])
            branch.points[i + 1 :] = [point_at(branch, i, self.wrinkle)]
            branch.stalled = branch.ended = None
        return branch

    def _slack(self, branch: SolutionCurve) -> list[int]:
        return self.verge.slack(branch.points).tolist() if self.finest else []

    @property
    def to_disk(self) -> bool:
        """Whether the first wrinkle is at the disk."""
        return at_disk(self.wrinkle, self.data.length)

    @cached_property
    def folded(self) -> FoldedContact:
        """The model of a tube in contact with a wrinkled zone."""
        return FoldedContact(self.slip.mesh.comm, self.data, self.to_disk)

    @cached_property
    def wrinkled(self) -> FittedBranch:
        """The tube in contact with a wrinkled zone, or with one at either disk."""
        model, length = self.folded, self.data.length
        fronts = model.first_fronts(self.wrinkle.values[FRONTS[0]])
        gaps = [gap for gap, _ in model.edges.values()] + list(model.gaps.values())
        continuation = Continuation(
            ExtendedNewton(model.system, ["p", *model.edges, *model.gaps]),
            [Held(gap, 0.0) for gap in gaps],
            self.steps(16),
            allowed=lambda state: bool(np.all(np.diff(model.breaks_of(state.loads)) > 0)),
        )
        begin = replace(transferred(self.slip, self.wrinkle.state, model, fronts), marks=model.marks)
        start = continuation.start(begin, Held(FRACTION, model.smallest), towards={FRACTION: 1.0})

        def closes(point: CurvePoint) -> bool:
            return point.monitors[FRACTION] < CLOSED * model.smallest

        def ends(point: CurvePoint) -> str:
            if closes(point):
                return "the wrinkled zone closes, beyond which it is not followed"
            if point.state.loads["front"] > self.last_front * length:
                return f"there the patch holds {self.last_front:g} of the {self.whole}"
            return self.gives_way(point) or (unlike(point) if self.finest else "")

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["p"] > self.p_end or bool(ends(point))

        kind = FittedBranch if len(model.edges) == 1 else MirroredBranch
        branch = kind(continuation, "p", start, stop)
        last = branch.points[-1]
        followed = f"tube: wrinkled states in contact were followed up to p = {last.state.loads['p']:.6g}"
        if closes(last):
            branch.end_at(FRACTION, model.smallest)
        if ends(last):
            branch.stalled, branch.ended = None, f"{followed}: {ends(last)}; lower p_end"
        elif branch.stalled:
            branch.stalled = f"{followed}: {branch.stalled}; lower p_end, or raise cells"
        return branch


def _without_tension(point: CurvePoint) -> str:
    return (
        f"tube: at p = {point.state.loads['p']:.6g} its meridian is compressed, which is not followed; lower "
        "p_end"
    )
