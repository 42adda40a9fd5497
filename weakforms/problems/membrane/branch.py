"""The branch of a membrane of any shape on one mesh: its start, and what is read at its states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.membrane.descent import least_energy
from weakforms.problems.membrane.model import MembraneModel
from weakforms.problems.membrane.readings import Highest
from weakforms.problems.triangles.limits import GIVES_WAY, gives_way
from weakforms.problems.triangles.readings import LeastStress
from weakforms.problems.triangles.start import first_state
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation
from weakforms.solvers.stability.surface_family import SurfaceBranch

HEIGHT = 0.3
"""Height, over the size of the surface, of the guess of the first state of a membrane whose edges slide."""


@dataclass(frozen=True)
class Start:
    """The first point of a branch."""

    w_c: float
    """Deflection of a membrane with held edges."""
    p: float
    """Pressure of a membrane whose edges slide: up to some deflection it has no stiffness."""


class Readings:
    """What is computed at a state besides its functionals: largest deflection, least stress and its place."""

    wave_numbers: tuple[int, ...] = ()
    columns = ("w_max", "S_least", "X_least", "Y_least", "Z_least")

    def __init__(self, model: MembraneModel) -> None:
        self.model = model
        self.highest = Highest(model)
        self._stress = LeastStress(model.mesh, model.least_stress, model.rule)

    def variation(self, n: int) -> SecondVariation:
        """None: all displacements are those of the states.

        Raises:
            ConvergenceError: Always.
        """
        raise ConvergenceError(f"a membrane of any shape has no class {n} of displacements")

    def observe(self) -> dict[str, float]:
        """The columns at the state that the system is lent to."""
        place, least = self._stress.least()
        return dict(zip(self.columns, (self.highest(), least, *place), strict=True))


def traced(
    model: MembraneModel, start: Start, end: float, step: float, progress: Callable[[float], None]
) -> SurfaceBranch:
    """The branch from a small deflection to a larger one.

    Args:
        model: The membrane on one mesh.
        start: What is given at the first point.
        end: Largest deflection at which the branch ends.
        step: Largest step.
        progress: Called with the largest deflection at every point.

    Raises:
        ConvergenceError: If there is no first state.
    """
    solver = ExtendedNewton(model.system, ["p"])
    continuation = Continuation(solver, control=StepControl(first=step / 8, largest=step))
    begin = _begun(model, continuation, start)
    readings = Readings(model)

    given = model.body.law, model.law, model.rule
    yields = gives_way(model.system, model.membrane.cauchy_green, *given)

    def ends(point: CurvePoint) -> bool:
        with model.system.at(point.state):
            highest = readings.highest()
        progress(highest)
        return highest > end or yields(point.state)

    branch = SurfaceBranch(continuation, "p", begin, ends, readings)
    branch.end_before(yields, GIVES_WAY)
    return branch


def _begun(model: MembraneModel, continuation: Continuation, start: Start) -> CurvePoint:
    """The first point, from which the deflection rises.

    Raises:
        ConvergenceError: If there is none.
    """
    system, body = model.system, model.body
    if body.reference.slides:
        guess = State(model.raised(HEIGHT * body.reference.size), system.initial.loads | {"p": start.p})
        try:
            first = least_energy(system, guess)
        except ConvergenceError as error:
            raise ConvergenceError(f"no first state: {error}; choose another numerics p_start") from error
        return continuation.start(first, Held("p", start.p), towards={"p": 1.0})
    try:
        solver = continuation.solver
        first = first_state(solver, start.w_c, {"delta": body.delta}, np.zeros(system.size))
    except ConvergenceError as error:
        raise ConvergenceError(
            f"no first state at w_c = {start.w_c:g}: {error}; choose another numerics start, "
            "or a larger delta"
        ) from error
    return continuation.start(first, Held("w_c", start.w_c), towards={"w_c": 1.0})
