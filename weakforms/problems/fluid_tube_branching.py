r"""Paper 3: where the secondary branch starts, and the branch on one mesh.

It starts at the first ``n = 1`` bifurcation point of the primary branch, by injecting the null vector found
on the mesh of the whole surface itself, and is followed by arc-length: neither ``zw`` nor ``r_mid`` need be
monotone. The axisymmetric side gives only guesses (a state and a mode as columns over ``Z``).

Stability is judged in the whole space, split by the mirror plane: displacements that keep the plane (C1v) and
displacements that break it. Among the latter the turn of the pattern about the axis,
:math:`e_z \times x - x_{,\Theta}`, is an exact zero, so that its computed eigenvalue measures the error.
"""

from __future__ import annotations

import dolfinx.fem.petsc as fem_petsc
import numpy as np
from dolfinx import fem
from mpi4py import MPI
from petsc4py import PETSc
from scipy.interpolate import CubicSpline

from weakforms.errors import ConvergenceError
from weakforms.problems.fluid_tube_critical import AxisymmetricState, PrimaryBranch
from weakforms.problems.fluid_tube_surface import Shape, SurfaceData, SurfaceModel
from weakforms.solvers.branch import EquilibriumBranch, Solved
from weakforms.solvers.constraints import Held, Plane
from weakforms.solvers.continuation import Continuation, CurvePoint, StepControl, Tangent
from weakforms.solvers.linear import BorderedMatrix, Factorization
from weakforms.solvers.newton import RESIDUAL_LIMIT, ExtendedNewton, SolveRecord
from weakforms.solvers.stability import Stability
from weakforms.solvers.system import State

SEGMENT = 0.03
"""The primary branch is followed on the surface from this fraction of ``V`` before its bifurcation to as much
after it."""

READINGS = 121
"""Material points ``Z`` over which axisymmetric guesses are splined."""

AMPLITUDES = (0.02, 0.04, 0.06, 0.08)
"""Root mean square displacements along the mode from which initial slopes are extrapolated."""

LIKENESS = 0.9
"""Least overlap of the surface's null vector with the axisymmetric branch's mode."""

CORRECTIONS = 3
"""Newton steps that make an equilibrium of an interpolated bifurcation point."""

NEAR = 6
"""Eigenvalues near zero looked at for the turn of the pattern."""


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


def primary_segment(model: SurfaceModel, primary: PrimaryBranch, at: AxisymmetricState) -> EquilibriumBranch:
    """The primary branch on the surface's own mesh, a little way to both sides of the bifurcation."""
    volume = at.values["V"]
    begin = primary.at("V", (1 - SEGMENT) * volume, at.Z)
    solver = ExtendedNewton(model.system, ["zw"])
    continuation = Continuation(solver, control=StepControl(first=0.1, largest=0.5, predictor_error=2e-2))
    guess = State(model.interpolated(position(begin)), {"zw": begin.values["zw"]})
    start = continuation.start(guess, Held("V", (1 - SEGMENT) * volume), towards={"V": 1.0})
    end = (1 + SEGMENT) * volume
    return EquilibriumBranch(continuation, "zw", start, stop=lambda point: point.monitors["V"] > end)


def secondary_branch(
    comm: MPI.Intracomm, data: SurfaceData, primary: PrimaryBranch, step: float, end: float
) -> SecondaryBranch:
    """The secondary branch on one mesh.

    Args:
        comm: Ranks.
        data: The tube and its mesh.
        primary: The axisymmetric branch it leaves.
        step: Largest arc-length step, as a root mean square displacement.
        end: The branch ends when ``zw`` has fallen to this fraction of its value at the bifurcation.

    Raises:
        ConvergenceError: When no bifurcation with that mode is found on the surface's mesh.
    """
    model = SurfaceModel(comm, data)
    begin = primary.bifurcation(np.linspace(0, data.length, READINGS))
    segment = primary_segment(model, primary, begin)
    if segment.stalled:
        raise ConvergenceError(f"primary branch on the surface: {segment.stalled}")
    like = model.interpolated(displacement(begin))
    system = model.system
    like /= np.sqrt(system.dot(like, system.mass_times(like)))
    found = [solved for solved in segment.special() if solved.kind == "bifurcation_point"]
    for solved in found:
        mode = Stability(system).modes(solved.state, 1)[0]
        overlap = system.dot(like, system.mass_times(mode.vector))
        if abs(overlap) > LIKENESS:
            count = min(segment.points[0].n_negative, segment.points[-1].n_negative)
            return SecondaryBranch(model, solved, np.sign(overlap) * mode.vector, count, step, end)
    raise ConvergenceError(
        f"the surface has {len(found)} bifurcation points near that of the axisymmetric branch, "
        "none of them with its mode"
    )


class SecondaryBranch(EquilibriumBranch):
    """The secondary branch on one mesh; its first point is the bifurcation point.

    Args:
        model: The surface.
        bifurcation: Where it begins.
        mode: Null vector there, of unit length in the mass norm, bulging at ``Theta = 0``.
        n_negative: Negative eigenvalues there, the null one left out.
        step: Largest arc-length step, as a root mean square displacement.
        end: Fraction of the bifurcation's ``zw`` at which the branch ends.
    """

    def __init__(
        self,
        model: SurfaceModel,
        bifurcation: Solved,
        mode: np.ndarray,
        n_negative: int,
        step: float,
        end: float,
    ) -> None:
        self.model, self.bifurcation, self.mode = model, bifurcation, mode
        self.size = float(np.sqrt(2 * np.pi * model.data.length))
        """Norm of a displacement of root mean square one."""
        control = StepControl(first=step * self.size / 2, largest=step * self.size, predictor_error=2e-2)
        solver = ExtendedNewton(model.system, ["zw"])
        continuation = Continuation(solver, control=control)
        lowest = end * bifurcation.state.loads["zw"]
        super().__init__(
            continuation,
            "zw",
            self._first(solver.factor, n_negative),
            stop=lambda point: point.state.loads["zw"] < lowest,
        )

    def _first(self, factor: Factorization, n_negative: int) -> CurvePoint:
        """The bifurcation point with the mode for a direction.

        Its state was interpolated; it is corrected at the same ``zw`` across the mode, where ``K`` is
        regular.
        """
        state, system = self.bifurcation.state.copy(), self.model.system
        across = system.mass_times(self.mode)
        norms = []
        for _ in range(CORRECTIONS):
            system.set_state(state.u, state.loads)
            residual = system.residual()
            norms.append(float(np.sqrt(system.dot(residual, residual))))
            factor.update()
            bordered = BorderedMatrix(factor, [across], [across], np.zeros((1, 1)))
            step, _ = bordered.solve(-residual, np.zeros(1))
            state.u += step
        system.set_state(state.u, state.loads)
        residual = system.residual()
        norms.append(float(np.sqrt(system.dot(residual, residual))))
        if not norms[-1] < RESIDUAL_LIMIT:
            raise ConvergenceError(f"the bifurcation point has a residual of {norms[-1]:.1e}")
        values = self.bifurcation.values | system.monitors()
        self.bifurcation = Solved(values, state, self.bifurcation.kind)
        record = SolveRecord("corrected", CORRECTIONS, CORRECTIONS, tuple(norms))
        direction = Tangent(self.mode, {"zw": 0.0})
        return CurvePoint(state, direction, 0.0, n_negative, record, system.monitors())

    def at_position(self, like: CurvePoint, rates: dict[str, float], near: float) -> Solved:
        """As for any branch; the first point is every mesh's own bifurcation: two branches cross."""
        if like.arclength == 0.0:
            return self.bifurcation
        return super().at_position(like, rates, near)

    def special(self) -> list[Solved]:
        """The bifurcation point it begins at, then what any branch may have."""
        return [self.bifurcation, *super().special()]

    # -- near the bifurcation ----------------------------------------------------------------------

    def at_amplitude(self, amplitude: float) -> Solved:
        """The state with a prescribed displacement along the mode (root mean square), ``zw`` free."""
        row = self.system.mass_times(self.mode)
        base = self.bifurcation.state
        offset = amplitude * self.size
        guess = State(base.u + offset * self.mode, base.loads)
        return self._solve(guess, Plane(row, {}, self.system.dot(row, base.u) + offset))

    def initial(self) -> dict[str, float]:
        """Slopes at the bifurcation and its ``zw`` from the branch alone.

        ``zw`` and ``V`` are even in the amplitude, and the half turn that takes one amplitude to its negative
        swaps ``r_mid`` and ``r_mid_pi``: polynomials in the square of the amplitude through a few small ones.
        """
        amplitudes = np.array(AMPLITUDES)
        states = [self.at_amplitude(a).values for a in amplitudes]
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

    # -- stability ---------------------------------------------------------------------------------

    def spectra(self, state: State, critical: float) -> dict[str, float]:
        """Eigenvalues and counts of negative ones: C1v at fixed level and volume, and symmetry-breaking.

        Args:
            state: An equilibrium.
            critical: Magnitude up to which an eigenvalue is a special point's own zero.

        Raises:
            ConvergenceError: When counts by inertia and by SLEPc disagree.
        """
        lowest = Stability(self.system).spectrum(state, 3, critical)
        out: dict[str, float] = {f"Lambda_{i + 1}": value for i, value in enumerate(lowest.eigenvalues[:3])}
        out["n_negative"] = lowest.n_negative
        if not critical:
            gamma, zw = self.model.data.gamma, state.loads["zw"]
            self.system.set_state(state.u, state.loads)
            border = self.system.load_derivative("zw") / gamma
            area = self.system.monitor_gradient("V")[1]["zw"] if zw < self.model.data.L else 0.0
            volume = Stability(self.system).bordered(state, border, area / gamma)
            out["LambdaV_1"], out["n_negative_V"] = volume.eigenvalues[0], volume.n_negative
        return out | self._breaking(state, critical)

    def _breaking(self, state: State, critical: float) -> dict[str, float]:
        """Symmetry-breaking eigenvalues, the turn of the pattern apart."""
        system = self.model.breaking
        modes = Stability(system).modes(state, NEAR)
        turn = self._turn(state)
        overlaps = [abs(system.dot(turn, mode.vector)) for mode in modes]
        rotation = modes[int(np.argmax(overlaps))].eigenvalue
        others = sorted(mode.eigenvalue for i, mode in enumerate(modes) if i != int(np.argmax(overlaps)))
        # The turn's zero has no sign: a shift of half the next one's size leaves it out of the count.
        system.set_state(state.u, state.loads)
        system.tangent()
        system.matrix.axpy(min(map(abs, others)) / 2, system.mass)
        factor = Factorization(system)
        factor.refactor()
        negative = factor.negative_count()
        if negative != sum(value < 0 for value in others):
            raise ConvergenceError(
                f"stability: inertia counts {negative} negative symmetry-breaking eigenvalues, "
                f"SLEPc finds {sum(value < 0 for value in others)}"
            )
        return {
            "Lambda_breaking": others[0],
            "Lambda_rotation": rotation,
            "n_negative_breaking": negative,
        }

    def _turn(self, state: State) -> np.ndarray:
        """Inner products with the displacement that turns the pattern."""
        system = self.model.breaking
        system.set_state(state.u, state.loads)
        vector = fem_petsc.assemble_vector(fem.form(self.model.rotation()))
        vector.ghostUpdate(PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)
        turn = vector.array.copy()
        turn[system.bc_dofs] = 0.0
        return turn
