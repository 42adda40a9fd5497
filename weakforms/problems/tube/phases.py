"""Paper 2: the phases of the tube against its substrate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import ClassVar

import numpy as np
from mpi4py import MPI
from numpy.polynomial import chebyshev

from weakforms.problems.contact.guesses import transferred
from weakforms.problems.contact.history import History
from weakforms.problems.contact.model import Bond
from weakforms.problems.contact.phases import ContactPhases
from weakforms.problems.meridian.limits import limit_along
from weakforms.problems.tube.contact import FIRST_FRONT, ContactData, ContactModel
from weakforms.problems.tube.model import FIRST_U, TAUT, free_branch, yielding, yields
from weakforms.solvers.continuation.branch import EquilibriumBranch, FittedBranch, MirroredBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

PRESSED = 3e-6
"""Fraction of ``p_end`` by which the pressure falls before the mesh follows the place where a spring lets go.
Up to there it pulls on as small a part of the patch, with a force of the square of that."""


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

    def write(self, x: np.ndarray, model: ContactModel | None = None) -> None:
        """Write ``E'``, and its integral ``E``, zero at the mid-plane; into another model, if given."""
        slope = chebyshev.chebfit(self._t, np.append(self._first, x), len(x))
        series = (model or self.model).series
        series["slope"].set(slope)
        series["position"].set(chebyshev.chebint(slope, lbnd=-1.0) * self.span / 2)

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

    def inflate(self, depth: float, begin: tuple[State, Held] | None = None) -> EquilibriumBranch:
        """Free inflation up to a displacement of the mid-plane, from a guess and a condition of its start."""
        limit = limit_along(self.slip)
        return free_branch(self.slip.system, self.data.delta1, depth, self.step, limit=limit, begin=begin)

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

    # -- deflation with a spring that only pushes ------------------------------------------------

    @property
    def deflations(self) -> tuple[str, ...]:
        """Such a spring lets go of the patch from its edge on, until it has let go of all of it."""
        return ("pressed", "letting_go", "released") if self.data.unilateral else super().deflations

    @cached_property
    def pressed(self) -> EquilibriumBranch:
        """The beginning of deflation, where the spring has let go of next to nothing."""
        branch = self._deflated(self.stick, self.end_of_inflation, self._begins, -np.inf)
        branch.end_at("p", self._begins)
        return branch

    @property
    def _begins(self) -> float:
        return (1 - PRESSED) * self.p_end

    @cached_property
    def _releasing(self) -> ContactModel:
        """The model whose mesh follows the place where the spring lets go, with the history of the patch."""
        model = ContactModel(self.slip.mesh.comm, replace(self.data, letting_go=True), self.stick.bond)
        self.history.write(self.history.found, model)
        return model

    @cached_property
    def letting_go(self) -> FittedBranch:
        """Deflation with the place where the spring lets go as an unknown besides the pressure."""
        model, state, length = self._releasing, self.pressed.points[-1].state, self.data.length
        signs = {name: sign for name, (_, sign) in model.releases.items()}
        front, least = state.loads["front"], FIRST_FRONT * length
        continuation = Continuation(
            ExtendedNewton(model.system, ["p", *signs]),
            [Held(gap, 0.0) for gap, _ in model.releases.values()],
            self.steps(4),
            allowed=lambda state: all(0 < sign * state.loads[n] < front for n, sign in signs.items()),
        )
        guess = {name: sign * (1 - PRESSED) * front for name, sign in signs.items()}
        begin = transferred(self.stick, state, model, guess)
        start = continuation.start(begin, Held("p", self._begins), towards={"p": -1.0})

        def stop(point: CurvePoint) -> bool:
            return point.state.loads["let_go"] < least

        kind = FittedBranch if len(signs) == 1 else MirroredBranch
        branch = kind(continuation, "p", start, stop)
        if branch.points[-1].state.loads["let_go"] < least:
            branch.end_at("let_go", least)
        return branch

    @cached_property
    def released(self) -> EquilibriumBranch:
        """The rest of deflation without the spring; the patch keeps its axial position."""
        last = self.letting_go.points[-1].state
        begin = transferred(self._releasing, last, self.stick, {"k": 0.0})
        return self._deflated(self.stick, begin, 0.0, self.slack, Held("u_max", self.data.touch))
