"""Paper 1, peeling: the energy release rate over the position of the front at one pressure, and pull-off."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.disk.family import DiskFamily
from weakforms.problems.disk.phases import DiskPhases
from weakforms.results import Quantity
from weakforms.results import State as StateRecord
from weakforms.solvers.continuation.branch import FittedBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

SMALLEST_FRONT = 0.04
"""Front at which a peeling curve ends, as a fraction of the radius; ``G`` becomes unbounded at zero."""

DIFFERENCE = 2e-3
"""Distance of the fronts whose potentials are compared, as a fraction of the radius."""


class PeelingBranch(FittedBranch):
    """Equilibria at one pressure whose patch keeps its inflation history, over the front ``x_f``.

    The control is the front. In ``n_negative`` the front is a degree of freedom too: if the energy of
    adhesion is ``G``, the state is stable against peeling where ``G`` grows with the patch.

    Args:
        run: Inflation on this mesh.
        p: Pressure.
    """

    def __init__(self, run: DiskPhases, p: float) -> None:
        self.p, self._edge = p, run.data.length
        self._radius: dict[float, float] = {}
        self._above_contact = p > run.onset.values["p"]
        lowest = run.adhesive.at("p", p).state.loads["front"] if self._above_contact else 0.0
        lowest = max(lowest, SMALLEST_FRONT * run.data.length)
        solver = ExtendedNewton(run.stick.system, ["front"])
        continuation = Continuation(solver, control=_steps(run))
        held = Held("front", run.end_of_inflation.loads["front"])
        start = continuation.start(_lowered(run, p), held, towards={"front": -1.0})
        super().__init__(continuation, "front", start, lambda point: point.state.loads["front"] < lowest)
        if self.stalled is None:
            self.end_at("front", lowest)

    def columns(self) -> dict[str, np.ndarray]:
        """The columns of any branch, the pressure and the difference of potentials."""
        out = super().columns()
        states = [p.state for p in self.points]
        out["p"] = np.full(len(states), self.p)
        out["G_difference"] = np.array([self.difference(s) for s in states])
        rates = np.array([self._release_rate(p) for p in self.points])
        out["n_negative"] = out["n_negative"] + (rates < 0)
        return out

    def peels(self, state: State) -> bool:
        """Whether ``G`` decreases as the patch grows; then the front adds a negative eigenvalue."""
        near = min(self.points, key=lambda p: abs(p.state.loads["front"] - state.loads["front"]))
        return -self._growth(state, near.tangent) < 0

    @property
    def shown(self) -> list[str]:
        """Columns that results show."""
        return ["p", *super().shown, "G_difference"]

    def _values(self, state: State) -> dict[str, float]:
        values = super()._values(state) | {"p": self.p}
        return values | {"G_difference": self.difference(state)}

    def difference(self, state: State, step: float = DIFFERENCE) -> float:
        r"""Energy released per deformed area, from potentials at neighbouring fronts and one pressure.

        .. math:: G = \frac{1}{\rho_* \lambda_{1c}} \frac{\mathrm{d}}{\mathrm{d}x_f} \frac{\Pi}{2\pi}

        by central differences at two distances, with extrapolation to order four.

        Args:
            state: An equilibrium.
            step: Distance of the front to the nearer neighbour, divided by the radius.
        """
        distance = step * self._edge / 2
        slopes = [self._slope(state, distance * factor) for factor in (1, 2)]
        with self.system.at(state):
            monitors = self.system.monitors()
        return (4 * slopes[0] - slopes[1]) / 3 / (monitors["rho_contact"] * monitors["lam1_contact"])

    def _slope(self, state: State, distance: float) -> float:
        potentials = []
        for sign in (-1, 1):
            front = state.loads["front"] + sign * distance
            new, _ = self.solver.solve(state, [Held("front", front)])
            with self.system.at(new):
                potentials.append(self.system.monitor("Pi"))
        return (potentials[1] - potentials[0]) / (2 * distance)

    # -- pull-off ------------------------------------------------------------------------------

    def special(self) -> list[Solved]:
        """Pull-off: the minimum of ``G`` over the front.

        Above the pressure of first contact there is none: ``G`` increases from zero, with zero slope, at the
        front that inflation reaches.
        """
        if self._above_contact:
            return []
        rates = np.array([self._release_rate(p) for p in self.points])
        turns = np.flatnonzero(rates[:-1] * rates[1:] < 0)
        return [self._pull_off(int(i)) for i in turns]

    def _pull_off(self, i: int) -> Solved:
        along = self.points[i].tangent
        return self.zero(i, lambda solved: self._growth(solved.state, along), "pull_off")

    def _release_rate(self, point: CurvePoint) -> float:
        """``dG/dx_f`` up to a positive factor; the curve is followed towards smaller fronts."""
        return -self.direction(point, ("G",))["G"]

    def _growth(self, state: State, along: Tangent) -> float:
        """Rate of ``G`` along the curve, oriented like another direction."""
        direction = self.continuation.direction(state, along)
        with self.system.at(state):
            return self.continuation.rate("G", direction)


def _steps(run: DiskPhases) -> StepControl:
    """Shorter steps than elsewhere, because the curve is short and is the result."""
    return StepControl(first=run.step / 8, largest=run.step / 4)


def _lowered(run: DiskPhases, p: float) -> State:
    """The state with the patch reached at ``p_end``, at a lower pressure."""
    if p == run.p_end:
        return run.end_of_inflation
    return run.lowered(p).at("p", p).state


class PeelingFamily(DiskFamily):
    """A peeling curve on all meshes; a request for the state at its pressure gives the pull-off point."""

    located_by: ClassVar[Mapping[str, str]] = {"pull_off": "G"}

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """As for any branch; in ``n_negative`` the front is a degree of freedom too.

        At pull-off the curvature with respect to the front is zero, and the front does not count.
        """
        found = super()._diagnostics(solved, critical)
        if critical:
            return found
        peels = {level.peels(s.state) for level, s in zip(self.levels, solved, strict=True)}
        if len(peels) != 1:
            raise ConvergenceError("stability against peeling depends on the mesh: refine it")
        return found | {"n_negative": Quantity(found["n_negative"].value + peels.pop())}

    def state(
        self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None
    ) -> StateRecord:
        """As :meth:`BranchFamily.state`; at ``p`` the pull-off point, or the largest patch if there is none.

        Raises:
            InputError: If the curve has no such state.
        """
        if name != "p":
            return super().state(name, value, crossing, profile)
        pressure = self.fine.p
        if value != pressure:
            raise InputError(f"circular: this peeling curve is for p = {pressure:g}, not {value:g}")
        if self.special_points():
            found = super().state("pull_off", 1, crossing, profile)
        else:
            found = super().state("front", self.fine.points[0].state.loads["front"], crossing, profile)
        return StateRecord({"p": value}, found.branch, found.quantities, found.fields, crossing)
