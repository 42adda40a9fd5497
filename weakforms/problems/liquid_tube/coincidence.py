"""Problem ``fluid_tube_coincidence``: the pre-stretch at which limit point and first bifurcation coincide.

If limit point and first bifurcation have opposite order at two pre-stretches, there is a pre-stretch between
them at which one state is both. It is solved for with ``delta`` as an additional unknown: at this state both
the axisymmetric second variation and that with one wave are singular.
"""

from __future__ import annotations

from typing import ClassVar

from mpi4py import MPI
from pydantic import Field

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.forms.materials.surface import LAWS
from weakforms.problems.liquid_tube.about import FLUID_TUBE_COINCIDENCE
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.liquid_tube.problem import CAPS, FluidTubeNumerics
from weakforms.problems.material_choice import MaterialChoice, require_model
from weakforms.problems.meridian.pre_stretch import require_bearable
from weakforms.problems.problem import Problem, Requests, Task
from weakforms.results import Absence, Quantity, Result
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.stability.modal import ModalBranch
from weakforms.solvers.stability.modes import Singular
from weakforms.solvers.support.roots import root
from weakforms.solvers.uncertainty.refinement import estimate

NEAR = 1e-3
"""Accuracy of ``delta`` from branches on the coarsest mesh, the guess for the extended system."""

SHOWN = ("zw", "V", "Pi", "r_mid", "r_max", "Lambda_n2", "Lambda_n3", "Lambda_torsion", "LambdaV_n0")


class CoincidenceParameters(MaterialChoice):
    """The tube, its liquid, and the range of the search."""

    ratio: ClassVar[str] = "alpha"

    L: float = Field(8.0, ge=2, le=40, description="stretched length over the radius")
    gamma: float = Field(0.116, gt=0, le=2, description="rho g A^2/(mu H)")
    alpha: float = Field(0.0, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    delta_low: float = Field(3.0, gt=1, le=9, description="pre-stretch with one order of the two points")
    delta_high: float = Field(5.0, gt=1, le=9, description="pre-stretch with the other order")


class FluidTubeCoincidence(Problem):
    """A state that is both limit point and first bifurcation with one wave."""

    about = FLUID_TUBE_COINCIDENCE
    parameters = CoincidenceParameters
    numerics = FluidTubeNumerics

    def check(self, parameters: CoincidenceParameters, requests: Requests) -> None:
        """Refuse what the ranges of single parameters cannot.

        Raises:
            InputError: For a request for states (there is only one), an empty range, or a law without a form.
        """
        require_model(self.name, parameters, tuple(LAWS))
        for name in ("delta_low", "delta_high"):
            require_bearable(self.name, parameters.material, getattr(parameters, name), 1.0, name)
        if requests.states:
            raise InputError(f"{self.name}: no states can be requested; its one state is the result")
        if not parameters.delta_low < parameters.delta_high:
            raise InputError(
                f"{self.name}: delta_low = {parameters.delta_low:g} must be less than "
                f"delta_high = {parameters.delta_high:g}"
            )

    def fill(self, result: Result, task: Task) -> None:
        """Search on the coarsest mesh, then solve on all meshes.

        Where the points come in the same order at both ends, or there are none, it is absent.
        """
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        find = _Finder(parameters, numerics, comm)
        progress("coincidence", 0, numerics.levels + 1)
        try:
            delta = find.near()
        except AbsentError as error:
            result.absent.append(Absence(error.what, str(error)))
            return
        found = []
        for level in range(numerics.levels):
            progress("coincidence", level + 1, numerics.levels + 1)
            found.append(find.exactly(level, delta))
        for name in ("delta", *SHOWN):
            value = estimate([values[name] for values in found], CAPS.get(name, 2 * numerics.degree))
            result.quantities[name] = Quantity(float(value.value), float(value.uncertainty))


class _Finder:
    """The search and the extended system."""

    def __init__(
        self, parameters: CoincidenceParameters, numerics: FluidTubeNumerics, comm: MPI.Intracomm
    ) -> None:
        self.parameters, self.numerics, self.comm = parameters, numerics, comm

    def _path(self, level: int, delta: float) -> FluidPath:
        given, numerics = self.parameters, self.numerics
        data = TubeData(
            given.L,
            delta,
            given.gamma,
            given.alpha,
            numerics.meshes[level] // 2,
            numerics.degree,
            numerics.grading,
            given.other_law,
        )
        return FluidPath(self.comm, data, 3, step=numerics.step)

    def _points(self, path: FluidPath) -> tuple[tuple[ModalBranch, Solved], Solved]:
        """The limit point with its piece, and the first bifurcation with one wave.

        Raises:
            AbsentError: When the branch has none of either.
            ConvergenceError: When it ends before they could be told.
        """
        located = [(piece, solved) for piece in path.pieces for solved in piece.special()]
        limits = [found for found in located if found[1].kind == "limit_point"]
        forks = [solved for _, solved in located if solved.values.get("n") == 1]
        if not limits or not forks:
            where = f"fluid_tube_coincidence: at delta = {path.data.delta:g}"
            stalled = [piece.stalled for piece in path.pieces if piece.stalled]
            if stalled:
                raise ConvergenceError(f"{where}: {stalled[0]}")
            raise AbsentError(
                "coincidence",
                f"{where} the branch has {len(limits)} limit points and {len(forks)} bifurcations with one "
                f"wave up to its end (the level has fallen to {path.zw_end:g} of the highest, or the tube is "
                "very wide, or the law at its limit); choose a delta_low and delta_high at which it has "
                "both, or another law",
            )
        return limits[0], forks[0]

    def near(self) -> float:
        """``delta`` at which the volumes of both points are equal, on the coarsest mesh."""
        ends = self.parameters.delta_low, self.parameters.delta_high

        def ahead(delta: float) -> float:
            (_, limit), fork = self._points(self._path(0, delta))
            return limit.values["V"] - fork.values["V"]

        gaps = [ahead(delta) for delta in ends]
        if gaps[0] * gaps[1] > 0:
            raise AbsentError(
                "coincidence",
                "fluid_tube_coincidence: limit point and bifurcation come in the same order at "
                f"delta = {ends[0]:g} and {ends[1]:g}; allowed: a range over which the order changes",
            )
        return root(ahead, *ends, "delta of equal volumes", xtol=NEAR, rtol=NEAR)

    def exactly(self, level: int, delta: float) -> dict[str, float]:
        """The state on one mesh at which both second variations are singular."""
        path = self._path(level, delta)
        (piece, limit), _ = self._points(path)
        modes, system = path.modes, path.model.system
        conditions = []
        for n in (0, 1):
            with system.at(limit.state):
                variation = modes.variation(n)
                border = variation.mass_times(variation.nearest().vector)
            conditions.append(Singular(lambda n=n: modes.variation(n), border))
        fitted = "front" in piece.loads
        scalars = ["zw", "delta", *(["front"] if fitted else [])]
        solver = ExtendedNewton(system, scalars)
        state, _ = solver.solve(limit.state, [*conditions, *([Held("gap", 0.0)] if fitted else [])])
        if abs(state.loads["delta"] - delta) > 10 * NEAR * delta:
            raise ConvergenceError(
                f"fluid_tube_coincidence: converged to delta = {state.loads['delta']:g}, far from {delta:g}"
            )
        with system.at(state):
            return {**system.monitors(), **modes.observe(), **state.loads}
