r"""Branches of a tube with an imperfection, on one mesh.

The axisymmetric branch of the even, upright tube bifurcates where a wave of ``n`` is neutral. An imperfection
takes it apart. The natural branch begins at a small volume, close to the axisymmetric states, and goes on to
bent states of one side. The detached branch has the bent states of the other side, and beyond the bifurcation
the states that are nearly axisymmetric. Where it is natural for a level to have a greatest value, it follows
Koiter's two-thirds law (:mod:`weakforms.solvers.continuation.expansion`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import make_interp_spline

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.gas import folds_of
from weakforms.problems.liquid_tube.bent.bifurcation_point import READINGS
from weakforms.problems.liquid_tube.critical import AxisymmetricState, PrimaryBranch
from weakforms.problems.liquid_tube.imperfect.model import AMPLITUDE, LiquidSector
from weakforms.problems.triangles.readings import AmountHeld
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.expansion import Expansion
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation
from weakforms.solvers.stability.surface_family import FilledBranch

SPLINE = 5
"""Degree of the splines through an axisymmetric state that is a first guess."""

SMALL = 0.05
"""Amplitude, over the last one, of the first bent state."""

CHANGES = {"tilt": 0.25, "uneven": 0.01}
"""Largest changes of an imperfection, in degrees and parts of the thickness, from state to state."""

APART, SHRINKS = {"tilt": 0.1, "uneven": 3e-3}, 1 / 3
"""Imperfections below which steps are shorter, and the power with which they and the distance of both
branches shrink: a longer step could change over to the other branch."""


class Counts:
    """Stability in the states' own symmetry, with the level and with the volume held."""

    wave_numbers: tuple[int, ...] = ()
    amount, folds = "V", folds_of(None)

    def __init__(self, model: LiquidSector) -> None:
        self.model = model
        self._held = AmountHeld(model.system, "zw", self.amount, None)
        self.columns = self._held.columns

    def variation(self, n: int) -> SecondVariation:
        """None: all displacements are those of the states.

        Raises:
            ConvergenceError: Always.
        """
        raise ConvergenceError(f"the surface has no class {n} of displacements")

    def observe(self) -> dict[str, float]:
        """The columns at the state that the system is lent to."""
        found = self._held.counts()
        return {name: float(found[name]) for name in self.columns}


@dataclass(frozen=True)
class Window:
    """The part of the branches that is solved for."""

    first: float
    """Volume at which branches of the even and of an imperfect tube begin."""
    last: float
    """Volume at which they end."""
    amplitude: float
    """Largest amplitude, at which they end too."""
    step: float
    """Largest step, as a root mean square displacement."""

    def beside(self, given: Mapping[str, float]) -> Window:
        """The same with steps that are as short as imperfections ask for."""
        shares = [min(1.0, (abs(e) / APART[name]) ** SHRINKS) for name, e in given.items() if e]
        return replace(self, step=self.step * min(shares, default=1.0))


@dataclass(frozen=True)
class Axisymmetric:
    """The bifurcation of the even tube and the state at which branches begin, by their meridians."""

    bifurcation: AxisymmetricState
    begin: AxisymmetricState

    @classmethod
    def of(cls, primary: PrimaryBranch, n: int, share: float) -> Axisymmetric:
        """Both, the first volume being a share of that at the bifurcation.

        Raises:
            AbsentError: If there is no bifurcation, or the tube is not full at the first volume.
        """
        data = primary.path.data
        places = np.linspace(0, data.L / data.delta, READINGS)
        found = primary.bifurcation(places, n)
        begin = primary.at("V", share * found.values["V"], places)
        if not begin.values["zw"] > data.L:
            raise AbsentError(
                "branches",
                f"fluid_tube_imperfect: v_start = {share:g}: with this part of the volume "
                f"{found.values['V']:.6g} at the bifurcation of n = {n} the level {begin.values['zw']:.6g} "
                f"is below the upper disk; choose a larger v_start, at most 0.99, or another L or delta",
            )
        return cls(found, begin)


class LiquidBranch(FilledBranch):
    """A branch, which ends at a volume, at an amplitude, or where the liquid does not wet all of the tube."""

    def __init__(self, model: LiquidSector, start: CurvePoint, follow: Continuation, window: Window) -> None:
        self.model = model

        def dry(state: State) -> bool:
            with model.system.at(state):
                return model.top() > state.loads["zw"]

        seen = [start.monitors["V"]]

        def stop(point: CurvePoint) -> bool:
            far = abs(point.monitors[AMPLITUDE]) > window.amplitude and point.arclength > 0
            seen.append(point.monitors["V"])  # detached states may come down from a larger volume
            return far or (seen[-1] > window.last and seen[-1] > seen[-2]) or dry(point.state)

        super().__init__(follow, "zw", start, stop, Counts(model))
        self.end_before(dry, "the liquid does not wet all of the tube any more")


def follower(model: LiquidSector, window: Window) -> Continuation:
    """Follows branches of one mesh."""
    size = float(np.sqrt(2 * np.pi * model.length))
    steps = StepControl(first=window.step * size / 4, largest=window.step * size)
    return Continuation(ExtendedNewton(model.system, ["zw"]), control=steps)


def natural(
    model: LiquidSector, about: Axisymmetric, given: dict[str, float], window: Window
) -> LiquidBranch:
    """The branch of the tube from its first volume on.

    Args:
        model: The surface.
        about: The axisymmetric branch.
        given: Values of the imperfections.
        window: Its part.

    Raises:
        ConvergenceError: If there is no first state.
    """
    follow, at = follower(model, window.beside(given)), about.begin
    r, z = (make_interp_spline(at.Z, values, SPLINE) for values in (at.r, at.z))
    loads = {"zw": at.values["zw"], **dict.fromkeys(given, 0.0)}
    guess = model.state_of(lambda s, _: np.vstack([r(s), 0 * s, z(s)]), loads)
    held = Held("V", window.first)
    first = imperfect(follow.solver, guess, held, given)
    return LiquidBranch(model, follow.start(first, held, towards={"V": 1.0}), follow, window)


def imperfect(solver: ExtendedNewton, state: State, held: Held, given: dict[str, float]) -> State:
    """The state of a tube with imperfections that is followed from one without, while one number is held.

    Raises:
        ConvergenceError: If it is lost on the way.
    """
    for name, value in given.items():

        def solve(near: State, to: float, name: str = name) -> State:
            return solver.solve(replace(near, loads=near.loads | {name: to}), [held])[0]

        state = walk(solve, state, 0.0, value, CHANGES[name])
    return state


def expanded(even: LiquidBranch, name: str) -> Expansion:
    """The expansion at the bifurcation of the even tube, with the force of an imperfection.

    Raises:
        AbsentError: If the branch has no bifurcation.
    """
    for solved in even.special():
        if solved.kind == "bifurcation_point":
            return Expansion.at(even.solver, solved.state, "zw", AMPLITUDE, name)
    raise AbsentError(
        "secondary branch",
        "fluid_tube_imperfect: the branch of the even tube has no bifurcation within its volumes; choose a "
        "larger v_end",
    )


def bent(even: LiquidBranch, side: float, window: Window) -> LiquidBranch:
    """The bent states of the even tube to one side, from a small amplitude on.

    Raises:
        AbsentError: If there is no bifurcation.
        ConvergenceError: If there is no bent state beside it.
    """
    about, follow = expanded(even, ""), follower(even.model, window)
    amplitude = side * SMALL * window.amplitude
    start = follow.start(about.predicted(amplitude), Held(AMPLITUDE, amplitude), towards={AMPLITUDE: side})
    return LiquidBranch(even.model, start, follow, window)


def natural_side(even: LiquidBranch, given: Mapping[str, float]) -> float:
    """Sign of the amplitude before the bifurcation, where the level rises with the volume.

    Raises:
        AbsentError: If there is no bifurcation.
    """
    abouts = {name: expanded(even, name) for name, value in given.items() if value}
    push = sum(given[name] * about.push for name, about in abouts.items())
    about = next(iter(abouts.values()))
    return float(np.sign(push / about.linear * np.sign(about.conjugate_rate)))


def detached(even: LiquidBranch, given: dict[str, float], window: Window) -> LiquidBranch:
    """The branch of bent states to the other side, from the largest amplitude on.

    A bent state of the even tube with this amplitude is made imperfect.

    Raises:
        AbsentError: If there is no bifurcation.
        ConvergenceError: If the state is lost on the way.
    """
    side = -natural_side(even, given)
    whole = bent(even, side, window)
    reached = max(side * point.monitors[AMPLITUDE] for point in whole.points)
    held = Held(AMPLITUDE, side * min(window.amplitude, reached))
    begin = whole.at(AMPLITUDE, held.target).state
    follow = follower(even.model, window.beside(given))
    first = imperfect(follow.solver, begin, held, given)
    return LiquidBranch(even.model, follow.start(first, held, towards={AMPLITUDE: -side}), follow, window)
