"""Computes loads (or thicknesses) at which a zone or a crest appears or disappears.

At such a load a stationary value of gw - 1, or of the inclination, is zero. It is evaluated on the side
without the zone, where it is a smooth function of the load, and continued beyond the event with the zones of
the collocation unchanged. Shooting has no zones; it corrects the root once by its own values.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from reference_data.solvers.core.newton import secant
from reference_data.solvers.paper4.cases import STEPS, Pair, grid_at
from reference_data.solvers.paper4.material import Array, Membrane
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.methods.collocation import State, newton

NOISE = 1e-13  # of gw - 1 and of an inclination: difference of two rules and two methods
TILT = 1e-3  # relative offset of shooting's second value, for the slope only


@dataclass(frozen=True)
class Touch:
    """An event to be found.

    Attributes:
        membrane: The membrane (for ``parameter`` M: one near the threshold).
        base: Value of the parameter on the side without the zone, near the event.
        near: Approximate position along the membrane; L for the upper end.
        field: "gw" or "inclination" (of the meridian to the axis).
        maximum: Whether the stationary value is a maximum.
        parameter: "load", or "M" at zero load.
    """

    membrane: Membrane
    base: float
    near: float
    field: str = "gw"
    maximum: bool = True
    parameter: str = "load"

    @property
    def at_end(self) -> bool:
        """Whether it is the value at the upper end, not a stationary value."""
        return self.near == self.membrane.L

    def moved(self, value: float) -> tuple[Membrane, float]:
        """Membrane and load at a value of the parameter."""
        if self.parameter == "M":
            return replace(self.membrane, M=value), 0.0
        return self.membrane, value


@dataclass
class Found:
    """Parameter and position by both methods; extra holds the state's own numbers."""

    touch: Touch
    x: tuple[Pair, Pair]
    s: tuple[Pair, Pair]


def pick(points: list[tuple[float, float, float]], touch: Touch) -> tuple[float, float]:
    """Position and value of the stationary point of the event, from (s, value, sign of the second slope).

    Raises:
        RuntimeError: If there is none.
    """
    wanted = [(abs(s - touch.near), s, v) for s, v, sign in points if (sign < 0) == touch.maximum]
    if not wanted:
        raise RuntimeError(f"no stationary {touch.field} near Z = {touch.near:g}: {touch.membrane}")
    return min(wanted)[1:]


def of_state(state: State, touch: Touch) -> tuple[float, float, float]:
    """Position, value and second derivative of the field at its stationary point (collocation)."""
    values = (
        sta.wrinkling(state.membrane, state.s, state.y) if touch.field == "gw" else np.sin(state.y[..., 3])
    )
    if touch.at_end:
        return state.membrane.L, float(values[-1, -1]), np.inf
    slope = state.mesh.slope(values)
    bend = state.mesh.slope(slope)

    def at(s: float, nodal: Array) -> float:
        return float(state.mesh.evaluate(nodal[..., None], np.array(s))[0])

    points = [(s, at(s, values), sign) for s, sign in msr.roots(state, slope)]
    s, value = pick(points, touch)
    return s, value, at(s, bend)


def of_shot(found: sho.Solution, touch: Touch) -> tuple[float, float]:
    """Position and value of the field at its stationary point (shooting)."""
    reading = smsr.Reading(found)
    field = reading.gw if touch.field == "gw" else reading.inclination
    _, last, value = field(1)
    if touch.at_end:
        return found.membrane.L, float(last[np.argmax(reading.s)])
    points = [(s, value(part, x), sign) for s, part, x, sign in reading.zeros(*field(2))]
    return pick(points, touch)


def by_collocation(touch: Touch, first: State, rule: sta.Rule) -> tuple[float, float, float, float]:
    """Parameter, position, slope of the value by the parameter, and bend, on one rule."""
    here = [sta.moved_to(first, rule)]

    def value(x: float) -> float:
        membrane, load = touch.moved(x)
        here[0] = newton(replace(here[0], membrane=membrane), "load", load)
        return of_state(here[0], touch)[1]

    x, slope = secant(value, touch.base, touch.base * (1 + TILT))
    value(x)
    s, _, bend = of_state(here[0], touch)
    return x, s, slope, bend


def find(touch: Touch) -> Found:
    """Solve for the event by both methods."""
    membrane, load = touch.moved(touch.base)
    guess = sta.from_grid(grid_at(membrane, load), sta.RULES[0])
    first = sta.polished(guess, "load", load)
    roots = [by_collocation(touch, first, rule) for rule in sta.RULES]
    x, s, slope, bend = roots[1]
    x_floor, s_floor = NOISE / abs(slope), 3 * NOISE / abs(bend)
    tilted = x + TILT * (touch.base - x) if touch.base != x else x * (1 + TILT)
    shots = []
    for value in (x, tilted):
        at, load = touch.moved(value)
        start = sho.from_grid(grid_at(at, load))
        scale = max(1, int(np.ceil(at.L / 8)))
        coarse = sho.solve(at, start, load, "load", load, STEPS[0] * scale)
        shots.append([of_shot(y, touch) for y in (coarse, sho.refined(coarse, load, STEPS[1] * scale))])
    root, other = shots
    corrected = [x - root[i][1] * (tilted - x) / (other[i][1] - root[i][1]) for i in (0, 1)]
    return Found(
        touch,
        (
            Pair(np.array(roots[0][0]), np.array(x), x_floor),
            Pair(*map(np.array, corrected), x_floor),
        ),
        (
            Pair(np.array(roots[0][1]), np.array(s), s_floor),
            Pair(*(np.array(v[0]) for v in root), s_floor),
        ),
    )
