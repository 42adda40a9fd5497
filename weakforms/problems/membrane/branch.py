"""The branch of a membrane of any shape on one mesh: its start, and what is read at its states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.gas import Gas, folds_of
from weakforms.problems.membrane.descent import least_energy
from weakforms.problems.membrane.model import MembraneModel
from weakforms.problems.membrane.readings import Highest
from weakforms.problems.triangles.limits import GIVES_WAY, MEDIA, gives_way
from weakforms.problems.triangles.readings import AmountHeld, LeastStress
from weakforms.problems.triangles.start import begins, first_under_load
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation
from weakforms.solvers.stability.surface_family import FilledBranch

HEIGHT = 0.3
"""Height, over the size of the surface, of the guess of the first state if edges slide or are moved."""


@dataclass(frozen=True)
class Start:
    """The first point of a branch."""

    w_c: float
    """Deflection of a membrane with held edges."""
    p: float
    """Pressure, of a liquid at the top, if edges slide or are moved: up to some deflection a membrane whose
    edges slide has no stiffness."""


class Readings:
    """What is computed at a state besides its functionals: largest deflection, least stress, a count."""

    wave_numbers: tuple[int, ...] = ()

    def __init__(self, model: MembraneModel, gas: Gas | None = None) -> None:
        self.model = model
        self.highest = Highest(model)
        self._stress = LeastStress(model.mesh, model.least_stress, model.rule)
        self.amount = MEDIA[model.body.load][1]
        self.folds = folds_of(gas)
        self._held = AmountHeld(model.system, model.body.control, self.amount, gas)
        self.columns = ("w_max", "S_least", "X_least", "Y_least", "Z_least", *self._held.columns)

    def variation(self, n: int) -> SecondVariation:
        """None: all displacements are those of the states.

        Raises:
            ConvergenceError: Always.
        """
        raise ConvergenceError(f"a membrane of any shape has no class {n} of displacements")

    def observe(self) -> dict[str, float]:
        """The columns at the state that the system is lent to."""
        place, least = self._stress.least()
        found = self._held.mass() | self._held.counts()
        values = (self.highest(), least, *place, *(float(found[name]) for name in self._held.columns))
        return dict(zip(self.columns, values, strict=True))


def traced(
    model: MembraneModel,
    start: Start,
    end: float,
    step: float,
    progress: Callable[[float], None],
    gas: Gas | None = None,
) -> FilledBranch:
    """The branch from a small deflection to a larger one.

    Args:
        model: The membrane on one mesh.
        start: What is given at the first point.
        end: Largest deflection at which the branch ends.
        step: Largest step.
        progress: Called with the largest deflection at every point.
        gas: The gas inside, if its mass is to be held.

    Raises:
        ConvergenceError: If there is no first state.
    """
    control = model.body.control
    solver = ExtendedNewton(model.system, [control])
    continuation = Continuation(solver, control=StepControl(first=step / 8, largest=step))
    begin = _begun(model, continuation, start)
    readings = Readings(model, gas)

    given = model.body.law, model.law, model.rule
    yields = gives_way(model.system, model.membrane.cauchy_green, *given)

    def ends(point: CurvePoint) -> bool:
        with model.system.at(point.state):
            highest = readings.highest()
        progress(highest)
        return highest > end or yields(point.state)

    branch = FilledBranch(continuation, control, begin, ends, readings)
    branch.end_before(yields, GIVES_WAY)
    return branch


def _begun(model: MembraneModel, continuation: Continuation, start: Start) -> CurvePoint:
    """The first point, from which the deflection rises.

    Raises:
        ConvergenceError: If there is none.
    """
    system, body = model.system, model.body
    control, gas = body.control, body.load == "gas"
    if body.reference.slides or body.motion:
        head = start.p if gas else start.p / body.gamma
        load = head if gas else body.top + head
        guess = State(model.raised(HEIGHT * body.reference.size), system.initial.loads | {control: load})
        try:
            first = least_energy(system, guess, control, head)
        except ConvergenceError as error:
            raise ConvergenceError(f"no first state: {error}; choose another numerics p_start") from error
        return continuation.start(first, Held(control, load), towards={control: 1.0})
    height = begins(start.w_c, body.delta, body.load)
    guess = np.zeros(system.size) if gas else model.raised(height)  # a level needs a sheet below it
    try:
        wanted = {"delta": body.delta}
        first = first_under_load(continuation.solver, height, wanted, guess, model.weight)
    except ConvergenceError as error:
        raise ConvergenceError(
            f"no first state at w_c = {height:g}: {error}; choose another numerics start, or a larger delta"
        ) from error
    return continuation.start(first, Held("w_c", height), towards={"w_c": 1.0})
