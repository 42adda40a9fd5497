"""Paper 2: the phases of the tube against its substrate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from mpi4py import MPI
from numpy.polynomial import chebyshev

from weakforms.problems.contact.history import History
from weakforms.problems.contact.model import Bond
from weakforms.problems.contact.phases import ContactPhases
from weakforms.problems.tube.contact import FIRST_FRONT, ContactData, ContactModel
from weakforms.problems.tube.model import FIRST_U, TAUT, free_branch, yielding, yields
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State


class TubeHistory(History):
    r"""Of the axial position ``E(Z)`` at which each point of the tube stuck: ``E'(z_f) = eta'(z_f+)``.

    There is no line force at a front that advances, so that the slope does not jump there.

    Args:
        model: Model with a bond.
        first: ``E'`` at the mid-plane, from first touch.
    """

    conditions = ("slope_outside",)

    def __init__(self, model: ContactModel, first: float) -> None:
        count = model.bond.terms
        self._t, self._first = -np.cos(np.pi * np.arange(count) / (count - 1)), first
        super().__init__(model, self._t[1:], np.eye(count - 1))

    def write(self, x: np.ndarray) -> None:
        """Write ``E'``, and its integral ``E``, zero at the mid-plane."""
        slope = chebyshev.chebfit(self._t, np.append(self._first, x), len(x))
        self.model.series["slope"].set(slope)
        self.model.series["position"].set(chebyshev.chebint(slope, lbnd=-1.0) * self.span / 2)

    def guess(self, slipped: Sequence[Solved]) -> np.ndarray:
        """The slopes outside without friction."""
        return np.array([solved.values["slope_outside"] for solved in slipped])


class TubePhases(ContactPhases):
    """All phases of the constrained tube on one mesh.

    Args:
        comm: Ranks.
        data: Tube, substrate and mesh.
        p_end: Pressure at which inflation ends and deflation begins.
        step: Largest arc-length step.
        terms: Number of terms of the stuck patch's axial stretch.
    """

    name = "tube"
    depth = "u_max"
    place: ClassVar[tuple[str, float]] = ("s", 1.0)
    nearer = "lower s"
    whole = "tube's length"
    highest_p = 20.0
    first_front, last_front = FIRST_FRONT, 0.999

    def __init__(
        self, comm: MPI.Intracomm, data: ContactData, p_end: float, step: float, terms: int = 18
    ) -> None:
        super().__init__(ContactModel(comm, data), p_end, step, terms)
        self._rest = self.slip.system.state()
        """Start of every free branch; it is kept, because each branch changes the state of its system."""

    def inflate(self, depth: float) -> EquilibriumBranch:
        """Free inflation up to a displacement of the mid-plane."""
        self.slip.system.set_state(self._rest.u, self._rest.loads)
        return free_branch(self.slip.system, self.data.delta1, depth, self.step)

    def small_patch(self) -> State:
        """The tube at first touch, whose mesh has the smallest front already."""
        state = self.onset.state.copy()
        state.loads["k"] = self.data.k
        return state

    def bonded(self, span: float) -> TubeHistory:
        """A patch that keeps its axial position."""
        model = ContactModel(self.slip.mesh.comm, self.data, Bond(self.terms, span))
        return TubeHistory(model, self.onset.values["lam1_mid"] / self.data.delta1)

    def gives_way(self, point: CurvePoint) -> str:
        """The law may hardly resist more meridional stretch."""
        return yielding(point) if yields(point) else ""

    @property
    def slack(self) -> float:
        """Without pre-stretch, the displacement of the first state."""
        return FIRST_U if self.data.delta1 < TAUT else super().slack

    def lowered(self, p: float, slack: float = -np.inf) -> EquilibriumBranch:
        """Deflation; with a spring that does not pull, the tube may become slack like a free one."""
        return super().lowered(p, self.slack if self.data.unilateral else slack)
