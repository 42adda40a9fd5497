"""Paper 3: the secondary branch on one mesh.

It starts at the first ``n = 1`` bifurcation point of the primary branch, in the direction of the null vector
on the mesh of the surface. It is followed by arc length, because ``zw`` and ``r_mid`` need not be monotone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent.bifurcation_point import READINGS, Trend, bifurcation_on
from weakforms.problems.liquid_tube.bent.fitted import Fitting, KeptNewton
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.problems.liquid_tube.bent.stability import BentStability
from weakforms.problems.liquid_tube.bent.surface import SurfaceData
from weakforms.problems.liquid_tube.critical import PrimaryBranch
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.balance import residual_limit
from weakforms.solvers.equilibrium.constraints import MonitorPlane, Plane
from weakforms.solvers.equilibrium.linear import BorderedMatrix, Factorization
from weakforms.solvers.equilibrium.newton import Constraint
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.memory import give_back

AMPLITUDES = (0.02, 0.04, 0.06, 0.08, 0.1)
"""Root mean square displacements along the mode, from which initial slopes are extrapolated."""

COMPARED = AMPLITUDES[::2]
"""The amplitudes at which the finest mesh is compared with the next coarser one."""

CORRECTIONS, EQUILIBRIUM = 3, 1e-11
"""Largest number of correction steps for an interpolated bifurcation point, and the residual at which they
stop."""

FAR = 4.0
"""Length of the branch, as a root mean square displacement over the radius, at which it ends too. The level
need not fall while a tube of a stiffening law bends."""

OTHER_STATE = 0.05
"""Root mean square distance from a coarser mesh's state beyond which a solution is a different state."""


def secondary_branch(
    comm: MPI.Intracomm,
    data: SurfaceData,
    primary: PrimaryBranch,
    step: float,
    end: float,
    followed: bool = True,
    below: Trend | None = None,
    kind: type[SecondaryBranch] | None = None,
) -> SecondaryBranch:
    """The secondary branch on one mesh.

    Args:
        comm: Ranks.
        data: The tube and its mesh.
        primary: The axisymmetric branch.
        step: Largest arc-length step, as a root mean square displacement.
        end: The branch ends at this fraction of ``zw`` at the bifurcation.
        followed: False if another mesh's states give the guesses for its states.
        below: Trend near the bifurcation on the next coarser mesh.
        kind: The class of the branch, if it is another one.

    Raises:
        ConvergenceError: If no bifurcation with that mode is found on the surface's mesh.
    """
    model = SurfaceModel(comm, data)
    begin = primary.bifurcation(np.linspace(0, data.length, READINGS))
    give_back()
    *found, trend = bifurcation_on(model, primary, begin, below)
    branch = (kind or SecondaryBranch)(model, *found, step, end, followed)
    branch.trend = trend
    branch.solver.factor.release()
    return branch


class SecondaryBranch(EquilibriumBranch):
    """The secondary branch on one mesh; its first point is the bifurcation point.

    Args:
        model: The surface.
        bifurcation: State at which it starts.
        mode: Approximate null vector there, outward at ``Theta = 0``.
        n_negative: Number of negative eigenvalues there, without the zero one (see :meth:`follow`).
        step: Largest arc-length step, as a root mean square displacement.
        end: The branch ends at this fraction of ``zw`` at the bifurcation.
        followed: False if another mesh's states give the guesses for its states; then its only point is the
            first.

    It is followed on the mesh that fits the free surface at the bifurcation point. A requested state is
    solved for on a mesh that fits the free surface of this state.

    Attributes:
        small: States at small amplitudes that were solved for.
        mode: The null vector, of unit length in the mass norm.
        trend: Trend near the bifurcation, for the next finer mesh.
    """

    trend: Trend | None = None

    def __init__(
        self,
        model: SurfaceModel,
        bifurcation: Solved,
        mode: np.ndarray,
        n_negative: int,
        step: float,
        end: float,
        followed: bool = True,
    ) -> None:
        self.model, self.bifurcation, self.mode = model, bifurcation, mode
        self.size = float(np.sqrt(2 * np.pi * model.data.length))
        """Norm of a displacement of root mean square one."""
        self.stability = BentStability(model)
        control = StepControl(first=step * self.size / 2, largest=step * self.size, predictor_error=2e-2)
        self.solver, self.system = KeptNewton(model.system, ["zw"]), model.system
        self.fitting = Fitting(model, self.solver)
        self.continuation = Continuation(self.solver, control=control)
        self._lowest = end * bifurcation.state.loads["zw"]
        self.control, self.loads, self.stalled = "zw", self.solver.scalars, None
        self.points = [self._first(self.solver.factor, n_negative)]
        self.small: dict[float, Solved] = {}
        if followed:
            self.follow()
            self._say_end()

    def follow(self) -> None:
        """Trace the branch to its end; if it is unstable from its start, the zero counts as negative."""
        super().__init__(
            self.continuation,
            "zw",
            self.points[0],
            stop=self.ends,
        )
        first, *more = self.points
        if more and more[0].n_negative == first.n_negative + 1:
            first.n_negative += 1

    def ends(self, point: CurvePoint) -> bool:
        """Whether the branch ends at a point of its trace: at its lowest level, or bent very far."""
        return point.state.loads["zw"] < self._lowest or point.arclength > FAR * self.size

    def _say_end(self) -> None:
        """Why the branch ends, if its level has not fallen to where it was to end."""
        at = self.points[-1].state.loads["zw"]
        if self.ended is None and self.stalled is None and at >= self._lowest:
            self.ended = (
                f"the level is at zw = {at:.6g} and not below {self._lowest:.6g} where the tube is bent very "
                f"far, after a path of {FAR:g} in root mean square displacement"
            )

    def _first(self, factor: Factorization, n_negative: int) -> CurvePoint:
        """The bifurcation point with the mode as direction, both corrected.

        The interpolated state is corrected at the same ``zw`` normal to the mode, where ``K`` is regular. The
        null vector is the solution of the bordered system for a displacement along the mode.
        """
        state, system = self.bifurcation.state.copy(), self.model.system
        norms: list[float] = []
        with system.at(state):
            across, nothing = system.mass_times(self.mode), np.zeros(system.size)
            factor.update()
            bordered = BorderedMatrix(factor, [across], [across], np.zeros((1, 1)))
        for step in range(CORRECTIONS + 1):
            with system.at(state):
                residual = system.residual()
                norms.append(float(np.sqrt(system.dot(residual, residual))))
                limit = residual_limit(system, norms[-1])
            if step == CORRECTIONS or norms[-1] < EQUILIBRIUM:
                break
            state.u += bordered.solve(-residual, np.zeros(1))[0]
        null = bordered.solve(nothing, np.ones(1))[0]
        with system.at(state):
            self.mode = null / np.sqrt(system.dot(null, system.mass_times(null)))
            self._across = system.mass_times(self.mode)
            monitors = system.monitors()
        if not norms[-1] <= limit:
            raise ConvergenceError(f"the bifurcation point has a residual of {norms[-1]:.1e}")
        self.bifurcation = Solved(self.bifurcation.values | monitors, state, self.bifurcation.kind)
        record = SolveRecord("corrected", len(norms) - 1, 1, tuple(norms))
        direction = Tangent(self.mode, {"zw": 0.0})
        return CurvePoint(state, direction, 0.0, n_negative, record, monitors)

    def at_guess(self, guess: State, constraint: Constraint) -> Solved:
        """Solve for the state that satisfies a condition, from a state of another mesh.

        Raises:
            ConvergenceError: If it does not converge, or converges to a different state.
        """
        shape = self.fitting.shape(guess)
        state = self.fitting.solve(guess, [constraint], near=True, chord=True)
        values = self._values(state)
        gap = self.fitting.apart(state, shape)
        if gap > OTHER_STATE:
            raise ConvergenceError(f"converged {gap:.2g} away from another mesh's state")
        return Solved(values, state)

    def across(self, point: CurvePoint, names: tuple[str, ...]) -> tuple[Solved, MonitorPlane]:
        """The state on a fitted mesh in a plane across the branch at a point of the trace, and that plane."""
        rates = self.direction(point, names)
        plane = MonitorPlane(rates, sum(rate * self._column(point, name) for name, rate in rates.items()))
        return self._solve(point.state, plane), plane

    def _solve(self, guess: State, constraint: Constraint, kind: str = "") -> Solved:
        """Solve on a mesh fitted to the state; in a plane across the trace, on the mesh of the trace."""
        if isinstance(constraint, Plane):
            return super()._solve(guess, constraint, kind)
        state = self.fitting.solve(guess, [*self.continuation.fixed, constraint])
        return Solved(self._values(state), state, kind)

    def require_within(self, i: int, solved: Solved, what: str) -> None:
        """As for any curve, on the mesh of the trace."""
        on_trace = self.points[i].state
        state = self.fitting.moved(solved.state, on_trace)
        with self.system.at(on_trace):
            super().require_within(i, Solved(solved.values, state), what)

    def special(self) -> list[Solved]:
        """The bifurcation point at its start, then special points as of any branch."""
        return [self.bifurcation, *super().special()]

    # -- near the bifurcation ----------------------------------------------------------------------

    def at_amplitude(self, amplitude: float, guess: Callable[[], State] | None = None) -> Solved:
        """The state with a prescribed displacement along the mode (root mean square), with unknown ``zw``.

        Args:
            amplitude: Amplitude of the displacement.
            guess: Gives a guess from another mesh; by default the bifurcation point plus the mode. If that
                does not converge, the state is approached in steps.
        """
        base = self.bifurcation.state
        along = self.system.dot(self._across, base.u)

        def solve(before: State, to: float, chord: bool = False) -> State:
            plane = Plane(self._across, {}, along + to * self.size)
            return self.fitting.solve(before, [plane], near=True, chord=chord)

        def further(before: State, to: float) -> State:
            left = along + to * self.size - self.system.dot(self._across, before.u)
            return solve(State(before.u + left * self.mode, before.loads), to)

        if guess is not None:
            state = solve(guess(), amplitude, chord=True)
        else:
            state = walk(further, base, 0.0, amplitude, amplitude)
        return Solved(self._values(state), state)

    def initial(self, given: Sequence[float] = AMPLITUDES) -> dict[str, float]:
        """Slopes at the bifurcation and its ``zw``, from the secondary branch alone.

        ``zw`` and ``V`` are even in the amplitude. A rotation by half a turn changes the sign of the
        amplitude and exchanges ``r_mid`` and ``r_mid_pi``. Polynomials in the square of the amplitude are
        fitted through a few small amplitudes.

        Args:
            given: Amplitudes.
        """
        for amplitude in given:
            if amplitude not in self.small:
                self.small[amplitude] = self.at_amplitude(amplitude)
        amplitudes, states = np.array(given), [self.small[a].values for a in given]
        squares = amplitudes**2

        def lowest(values: list[float] | np.ndarray) -> np.ndarray:
            return np.polynomial.polynomial.polyfit(squares / squares[-1], values, len(squares) - 1)[:2]

        zw, zw_2 = lowest([s["zw"] for s in states])
        _, v_2 = lowest([s["V"] for s in states])
        odd = np.array([(s["r_mid"] - s["r_mid_pi"]) / 2 for s in states]) / amplitudes
        slope = lowest(odd)[0]
        _, mean_2 = lowest([(s["r_mid"] + s["r_mid_pi"]) / 2 for s in states])
        return {
            "zw_extrapolated": float(zw),
            "dzw_dV": float(zw_2 / v_2),
            "dzw_dr2": float(zw_2 / squares[-1] / slope**2),
            "dr_mean_dzw": float(mean_2 / zw_2),
        }
