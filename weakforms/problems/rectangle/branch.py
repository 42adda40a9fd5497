"""The branch of a rectangular membrane on one mesh: its start, and what is read at its states."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from math import sqrt

import numpy as np
from dolfinx import fem

from weakforms.errors import ConvergenceError
from weakforms.problems.rectangle.model import RectangleModel
from weakforms.problems.rectangle.readings import Centre
from weakforms.problems.triangles.limits import GIVES_WAY, gives_way
from weakforms.problems.triangles.readings import LeastStress
from weakforms.problems.triangles.start import first_state
from weakforms.problems.triangles.weak_form import RULE
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation
from weakforms.solvers.stability.surface_family import SurfaceBranch

ZERO = 1e-6
"""Eigenvalues in the states' class above minus this do not count as negative: at a limit load one is zero."""

COUNTED = {1: "n_odd_even", 2: "n_even_odd", 3: "n_odd_odd"}
"""Columns of the counts by class; that of the states' own class is ``n_negative``."""


class RectangleModes:
    """What is computed at a state besides its functionals: least stress, stretch, counts by class."""

    def __init__(self, model: RectangleModel) -> None:
        self.model = model
        self.square = model.sheet.is_square
        rule = RULE[model.sheet.degree]
        self._points = LeastStress(model.mesh, model.least_stress, rule, mirrored=True)
        self._centre = Centre(model)
        self._factor = Factorization(model.system)
        self.amount = "V" if model.sheet.load == "gas" else "V_f"
        self._counted = {} if model.sheet.whole else COUNTED
        self.columns = ("lam1_c", "S_least", "X_least", "Y_least", *self._counted.values(), "n_all", "n_held")
        self._wet = fem.form(model.wet_area)

    @property
    def wave_numbers(self) -> tuple[int, ...]:
        """Classes whose zeros are bifurcation points; on a square two of them are copies of each other."""
        if not self._counted:
            return ()
        return (1, 3) if self.square else (1, 2, 3)

    def variation(self, n: int) -> SecondVariation:
        """The operator of a class; 0 is that of the states."""
        return self.model.variations[n]

    def observe(self) -> dict[str, float]:
        """The columns at the state that the system is lent to."""
        place, least = self._points.least()
        counts = {name: float(self._count(n)) for n, name in self._counted.items()}
        own, turned = self._own()
        whole = own + sum(counts.values())
        values = (self._centre.stretch(), least, *place, *counts.values(), whole, whole - turned)
        return dict(zip(self.columns, values, strict=True))

    def _count(self, n: int) -> int:
        return self.model.variations[1 if self.square and n == 2 else n].negative_count()

    def _own(self) -> tuple[int, bool]:
        r"""Negative eigenvalues in the states' class, and whether the amount falls with the load there.

        With ``b`` the derivative of the amount in the displacement, :math:`dV/dp = b^T K^{-1} b` for gas and
        :math:`dV_f/dz_w = A_w + \gamma\, b^T K^{-1} b` for a liquid, which covers the area ``A_w``.
        """
        system, sheet = self.model.system, self.model.sheet
        system.tangent()
        system.shift(ZERO)
        self._factor.refactor()
        b, _ = system.monitor_gradient(self.amount, ())
        b[system.bc_dofs] = 0.0
        rate = system.dot(b, self._factor.solve(b))
        if sheet.load == "liquid":
            rate = float(system.sum(fem.assemble_scalar(self._wet))) + sheet.gamma * rate
        return self._factor.negative_count(), rate < 0


class RectangleBranch(SurfaceBranch):
    """Symmetric states over the load; bifurcations into every class of displacements are located."""

    def _placed(self) -> list[tuple[float, Solved]]:
        """Besides, folds of the amount of gas or liquid: the ends of what can be reached by filling."""
        amount = self.modes.amount
        rates = np.array([self.direction(point, (amount,))[amount] for point in self.points])

        def rate(solved: Solved, along: Tangent) -> float:
            tangent = self.continuation.direction(solved.state, along)
            with self.system.at(solved.state):
                return self.continuation.rate(amount, tangent)

        found = super()._placed()
        for i in np.flatnonzero(rates[:-1] * rates[1:] < 0).tolist():
            solved = self._root(i, partial(rate, along=self.points[i].tangent), "volume_fold")
            found.append((self._arclength(i, solved), solved))
        return found


def traced(
    model: RectangleModel,
    start: float,
    end: float,
    step: float,
    progress: Callable[[], None] = lambda: None,
) -> RectangleBranch:
    """The branch from a small height of the centre to a larger one.

    Args:
        model: The membrane on one mesh.
        start: Height of the centre at the first point.
        end: Height of the centre at which the branch ends.
        step: Largest step.
        progress: Called at every point.
    """
    control = model.sheet.control
    solver = ExtendedNewton(model.system, [control])
    continuation = Continuation(solver, control=StepControl(first=step / 8, largest=step))
    frame = {"delta": model.sheet.delta, "delta_y": model.sheet.delta_y}
    first = _first(model, solver, start, frame)
    begin = continuation.start(first, Held("w_c", start), towards={"w_c": 1.0})

    given = model.sheet.law, model.law, RULE[model.sheet.degree]
    yields = gives_way(model.system, model.membrane.cauchy_green, *given)

    def ends(point: CurvePoint) -> bool:
        progress()
        return point.monitors["w_c"] > end or yields(point.state)

    branch = RectangleBranch(continuation, control, begin, ends, RectangleModes(model))
    branch.end_before(yields, GIVES_WAY)
    return branch


LIGHTER, LIGHTEST = 0.5, 1 / 64
"""Factor by which the liquid is made lighter to find a first state, and the smallest share of its weight."""


def _first(model: RectangleModel, solver: ExtendedNewton, start: float, frame: Mapping[str, float]) -> State:
    """First state of a branch; under a heavy liquid by way of lighter ones.

    A liquid heavier than the critical one wets a part of the sheet only, whose edge Newton's method does not
    find from a guess that is wet all over.

    Raises:
        ConvergenceError: If it is found under no liquid, or is lost while the weight is raised.
    """
    share, state = 1.0, None
    while state is None:
        try:
            with model.weighing(share):
                state = first_state(solver, start, frame, model.cosine(start))
        except ConvergenceError:
            if model.sheet.load == "gas" or share <= LIGHTEST:
                raise
            share *= LIGHTER
    while share < 1.0:
        share = min(1.0, share / sqrt(LIGHTER))
        with model.weighing(share):
            state = solver.solve(state, [Held("w_c", start)])[0]
    return state
