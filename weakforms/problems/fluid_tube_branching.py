r"""Paper 3: where the secondary branch starts, and the branch on one mesh.

It starts at the first ``n = 1`` bifurcation point of the primary branch, by injecting the null vector found
on the mesh of the whole surface itself, and is followed by arc-length: neither ``zw`` nor ``r_mid`` need be
monotone. The axisymmetric side gives only guesses (a state and a mode as columns over ``Z``).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from mpi4py import MPI
from numpy.polynomial import chebyshev
from scipy.interpolate import BarycentricInterpolator, CubicSpline
from scipy.optimize import brentq

from weakforms.errors import ConvergenceError
from weakforms.problems.fluid_tube_bent_stability import BentStability
from weakforms.problems.fluid_tube_critical import AxisymmetricState, PrimaryBranch
from weakforms.problems.fluid_tube_fitting import Fitting, KeptNewton
from weakforms.problems.fluid_tube_surface import Shape, SurfaceData, SurfaceModel
from weakforms.solvers.branch import EquilibriumBranch, Solved
from weakforms.solvers.constraints import Held, MonitorPlane, Plane
from weakforms.solvers.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.linear import BorderedMatrix, Factorization
from weakforms.solvers.newton import RESIDUAL_LIMIT, Constraint, SolveRecord
from weakforms.solvers.stability import Mode, Stability
from weakforms.solvers.system import State

NODES, SPAN = 4, 0.005
"""Volumes over which a mesh's own bifurcation is interpolated: a Chebyshev grid within this fraction of the
axisymmetric one's. Four nodes leave an error of ``SPAN^4``."""

LOOKED_AT = 3
"""Eigenvalues near zero among which that of the axisymmetric branch's mode is found."""

BESIDE = 1e-3
"""Distance from zero at which the singular tangent is factorised for its null vector."""

READINGS = 121
"""Material points ``Z`` over which axisymmetric guesses are splined."""

AMPLITUDES = (0.02, 0.04, 0.06, 0.08, 0.1)
"""Root mean square displacements along the mode from which initial slopes are extrapolated."""

LIKENESS = 0.9
"""Least overlap of the surface's null vector with the axisymmetric branch's mode."""

CORRECTIONS, EQUILIBRIUM = 3, 1e-11
"""Newton steps, at most, that make an equilibrium of an interpolated bifurcation point, and the residual at
which there is nothing left to mend."""

ASTRAY = 0.05
"""Root mean square distance from a coarser mesh's state beyond which a solution is another one."""


# -- where it starts -----------------------------------------------------------------------------


def position(of: AxisymmetricState) -> Shape:
    """An axisymmetric state as a surface."""
    r, z = CubicSpline(of.Z, of.r), CubicSpline(of.Z, of.z)
    return lambda s, theta: np.vstack([r(s) * np.cos(theta), r(s) * np.sin(theta), z(s)])


def displacement(of: AxisymmetricState) -> Shape:
    """The mode at a bifurcation point as a displacement; at ``Theta = 0`` it bulges."""
    u, beta, w = (CubicSpline(of.Z, part) for part in of.mode)
    n = of.n

    def mode(s: np.ndarray, theta: np.ndarray) -> np.ndarray:
        c, sn = np.cos(n * theta), np.sin(n * theta)
        out, around = u(s) * c, beta(s) * sn
        return np.vstack(
            [
                out * np.cos(theta) - around * np.sin(theta),
                out * np.sin(theta) + around * np.cos(theta),
                w(s) * c,
            ]
        )

    return mode


def turned(shape: Shape) -> Shape:
    """The same displacement a quarter turn on: the other mode of a double eigenvalue."""

    def mode(s: np.ndarray, theta: np.ndarray) -> np.ndarray:
        x, y, z = shape(s, theta - np.pi / 2)
        return np.vstack([-y, x, z])

    return mode


def bifurcation_on(
    model: SurfaceModel, primary: PrimaryBranch, at: AxisymmetricState
) -> tuple[Solved, np.ndarray, int]:
    """The bifurcation on the surface's own mesh: state, null vector, and negative eigenvalues beside it.

    At the point itself even the bordered matrix is singular (the null vector breaks the symmetry of the
    branch): the eigenvalue, the columns and the state are interpolated from axisymmetric states around it,
    solved for at given volumes.

    Raises:
        ConvergenceError: When the mode's eigenvalue has no zero there, or the null vector is not that mode.
    """
    system, volume = model.system, at.values["V"]
    stability, fitting = Stability(system), Fitting(model, KeptNewton(system, ["zw"]))

    def overlap(mode: Mode) -> float:
        like = model.interpolated(displacement(at))
        like /= np.sqrt(system.dot(like, system.mass_times(like)))
        return system.dot(like, system.mass_times(mode.vector))

    along, states, eigenvalues, counts = chebyshev.chebpts1(NODES), [], [], []
    for s in along:
        begin = primary.at("V", volume * (1 + SPAN * s), at.Z)
        guess = State(model.interpolated(position(begin)), {"zw": begin.values["zw"]})
        state = fitting.solve(guess, [Held("V", begin.values["V"])], chord=True)
        modes, negative = stability.about(state, 0.0, LOOKED_AT)
        critical = max(modes, key=lambda mode: abs(overlap(mode)))
        system.set_state(state.u, state.loads)
        states.append(Solved({"zw": state.loads["zw"], **system.monitors()}, state))
        eigenvalues.append(critical.eigenvalue)
        counts.append(negative - int(critical.eigenvalue < 0))
    if eigenvalues[0] * eigenvalues[-1] > 0 or len(set(counts)) > 1:
        raise ConvergenceError(
            f"no bifurcation on the surface within {SPAN:g} of V = {volume:g}: eigenvalues {eigenvalues}, "
            f"negative ones beside them {counts}"
        )
    zero = brentq(BarycentricInterpolator(along, eigenvalues), -1.0, 1.0, xtol=1e-14)

    def at_zero(values: list) -> np.ndarray:
        return BarycentricInterpolator(along, np.array(values))(zero)

    loads = {name: float(at_zero([s.state.loads[name] for s in states])) for name in states[0].state.loads}
    state = State(at_zero([s.state.u for s in states]), loads)
    values = {name: float(at_zero([s.values[name] for s in states])) for name in states[0].values}
    modes, _ = stability.about(state, -BESIDE, LOOKED_AT)
    mode = max(modes, key=lambda mode: abs(overlap(mode)))
    if abs(overlap(mode)) < LIKENESS:
        raise ConvergenceError("the null vector on the surface is not the axisymmetric branch's mode")
    return Solved(values, state, "bifurcation_point"), np.sign(overlap(mode)) * mode.vector, counts[0]


def secondary_branch(
    comm: MPI.Intracomm,
    data: SurfaceData,
    primary: PrimaryBranch,
    step: float,
    end: float,
    followed: bool = True,
) -> SecondaryBranch:
    """The secondary branch on one mesh.

    Args:
        comm: Ranks.
        data: The tube and its mesh.
        primary: The axisymmetric branch it leaves.
        step: Largest arc-length step, as a root mean square displacement.
        end: The branch ends when ``zw`` has fallen to this fraction of its value at the bifurcation.
        followed: False where its states will be solved for from another mesh's.

    Raises:
        ConvergenceError: When no bifurcation with that mode is found on the surface's mesh.
    """
    model = SurfaceModel(comm, data)
    begin = primary.bifurcation(np.linspace(0, data.length, READINGS))
    return SecondaryBranch(model, *bifurcation_on(model, primary, begin), step, end, followed)


class SecondaryBranch(EquilibriumBranch):
    """The secondary branch on one mesh; its first point is the bifurcation point.

    Args:
        model: The surface.
        bifurcation: Where it begins.
        mode: Null vector there, of unit length in the mass norm, bulging at ``Theta = 0``.
        n_negative: Negative eigenvalues there, the null one left out.
        step: Largest arc-length step, as a root mean square displacement.
        end: Fraction of the bifurcation's ``zw`` at which the branch ends.
        followed: False where its states will be solved for from another mesh's: its only point is the first.

    It is followed on the mesh fitted to the bifurcation point's free surface; any state asked for is solved
    for on a mesh fitted to it.
    """

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
        if followed:
            self.follow()

    def follow(self) -> None:
        """Trace the branch to its end."""
        super().__init__(
            self.continuation,
            "zw",
            self.points[0],
            stop=lambda point: point.state.loads["zw"] < self._lowest,
        )

    def _first(self, factor: Factorization, n_negative: int) -> CurvePoint:
        """The bifurcation point with the mode for a direction.

        Its state was interpolated; it is corrected at the same ``zw`` across the mode, where ``K`` is
        regular.
        """
        state, system = self.bifurcation.state.copy(), self.model.system
        across = system.mass_times(self.mode)
        norms: list[float] = []
        for step in range(CORRECTIONS + 1):
            system.set_state(state.u, state.loads)
            residual = system.residual()
            norms.append(float(np.sqrt(system.dot(residual, residual))))
            if step == CORRECTIONS or norms[-1] < EQUILIBRIUM:
                break
            factor.update()
            bordered = BorderedMatrix(factor, [across], [across], np.zeros((1, 1)))
            state.u += bordered.solve(-residual, np.zeros(1))[0]
        if not norms[-1] < RESIDUAL_LIMIT:
            raise ConvergenceError(f"the bifurcation point has a residual of {norms[-1]:.1e}")
        values = self.bifurcation.values | system.monitors()
        self.bifurcation = Solved(values, state, self.bifurcation.kind)
        record = SolveRecord("corrected", len(norms) - 1, len(norms) - 1, tuple(norms))
        direction = Tangent(self.mode, {"zw": 0.0})
        return CurvePoint(state, direction, 0.0, n_negative, record, system.monitors())

    def at_guess(self, guess: State, constraint: Constraint) -> Solved:
        """The state that meets a condition, from one of another mesh.

        Raises:
            ConvergenceError: When it does not converge, or not to the same state.
        """
        state = self.fitting.solve(guess, [constraint], near=True, chord=True)
        values = self._values(state)
        gap = self.continuation.distance(self.fitting.moved(state, guess), guess) / self.size
        self.system.set_state(state.u, state.loads)
        if gap > ASTRAY:
            raise ConvergenceError(f"converged {gap:.2g} away from another mesh's state")
        return Solved(values, state)

    def across(self, point: CurvePoint, names: tuple[str, ...]) -> tuple[Solved, MonitorPlane]:
        """The state on a fitted mesh at a point of the trace, in a plane across the branch; that plane."""
        rates = self.direction(point, names)
        plane = MonitorPlane(rates, sum(rate * self._column(point, name) for name, rate in rates.items()))
        return self._solve(point.state, plane), plane

    def _solve(self, guess: State, constraint: Constraint, kind: str = "") -> Solved:
        """On a mesh fitted to the state; in a plane across the trace, which is one of its mesh, on that."""
        if isinstance(constraint, Plane):
            return super()._solve(guess, constraint, kind)
        state = self.fitting.solve(guess, [*self.continuation.fixed, constraint])
        return Solved(self._values(state), state, kind)

    def _require_within(self, i: int, solved: Solved, what: str) -> None:
        """As for any curve, on the mesh that the trace was made on."""
        state = self.fitting.moved(solved.state, self.points[i].state)
        super()._require_within(i, Solved(solved.values, state), what)
        self.system.set_state(solved.state.u, solved.state.loads)

    def special(self) -> list[Solved]:
        """The bifurcation point it begins at, then what any branch may have."""
        return [self.bifurcation, *super().special()]

    # -- near the bifurcation ----------------------------------------------------------------------

    def at_amplitude(self, amplitude: float, guess: Callable[[], State] | None = None) -> Solved:
        """The state with a prescribed displacement along the mode (root mean square), ``zw`` free.

        Args:
            amplitude: Of the displacement.
            guess: Gives a start from another mesh; by default the bifurcation point plus the mode.
        """
        base, offset = self.bifurcation.state, amplitude * self.size
        self.system.set_state(base.u, base.loads)
        row = self.system.mass_times(self.mode)
        plane = Plane(row, {}, self.system.dot(row, base.u) + offset)
        begin = State(base.u + offset * self.mode, base.loads) if guess is None else guess()
        state = self.fitting.solve(begin, [plane], near=True, chord=guess is not None)
        return Solved(self._values(state), state)

    @cached_property
    def small(self) -> list[Solved]:
        """States at the small amplitudes."""
        return [self.at_amplitude(a) for a in AMPLITUDES]

    def initial(self, count: int = len(AMPLITUDES)) -> dict[str, float]:
        """Slopes at the bifurcation and its ``zw`` from the branch alone.

        ``zw`` and ``V`` are even in the amplitude, and the half turn that takes one amplitude to its negative
        swaps ``r_mid`` and ``r_mid_pi``: polynomials in the square of the amplitude through a few small ones.

        Args:
            count: How many of :data:`AMPLITUDES` to use.
        """
        amplitudes = np.array(AMPLITUDES[:count])
        states = [solved.values for solved in self.small[:count]]
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
