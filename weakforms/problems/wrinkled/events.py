"""Computation of the loads at which zones of a wrinkled membrane open or close."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.wrinkled.fields import Zones
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.state import Touch, ZonedState
from weakforms.results import Failure
from weakforms.solvers.equilibrium import constraints as fixed
from weakforms.solvers.support.roots import root

HALVINGS = 24
"""Largest number of times that an interval is halved until only one zone opens or closes in it."""

LARGE_MOVE = 0.1
"""If a front moves by more than this fraction of the length, the states in between are examined."""

SLACK, VOLUME_SLACK = 1e-6, 1e-5
"""Largest relative distance of an event from its interval, of a load or of the volume, because a new zone is
detected only when it has some width. Near a limit load intervals are of the volume, which grows faster."""

SAMPLES = 401
"""Places at which ``gw`` is looked at to find the extreme, and again around it."""

VERGE = 1e-9
"""If ``gw`` differs from 1 by less at an end of the unloaded membrane, a zone exists there from the start."""


@dataclass(frozen=True)
class Event:
    """A zone that opens or closes at a load."""

    kind: str
    """``zone_opening`` or ``zone_closing``."""
    state: float
    """State of the zone: 1 taut, -1 wrinkled."""
    after: int
    """Index of the point of the branch before it."""
    levels: tuple[ZonedState, ...]
    """The state on every mesh, coarse to fine; ``touched`` is the position of the zone."""


def events(
    membrane: Membrane, points: Sequence[tuple[int, ZonedState]], names: Sequence[str]
) -> tuple[list[Event], list[Failure]]:
    """All events between neighbours of a branch, in order, and the failures.

    Args:
        membrane: The membrane.
        points: States of the branch on the finest mesh, with their numbers.
        names: For the number of each point, the column that increases or decreases to the next one.
    """
    found: list[Event] = []
    failures: list[Failure] = []
    at_ends = points[0][1].sampled(np.array([0.0, membrane.length]))["gw"]
    verge = np.abs(at_ends - 1) < VERGE
    for (i, a), (_, b) in pairwise(points):
        try:
            found.extend(_between(membrane, a, b, i, names[i], verge, HALVINGS))
        except ConvergenceError as error:
            load = a.state.loads[membrane.control]
            failures.append(Failure(f"zones that change after {membrane.control} = {load:.6g}", str(error)))
    return found, failures


def _fronts(held: ZonedState) -> tuple[float, int]:
    return held.zones.first, len(held.zones.fronts)


def _between(
    membrane: Membrane,
    a: ZonedState,
    b: ZonedState,
    after: int,
    name: str,
    verge: np.ndarray,
    halvings: int,
) -> list[Event]:
    """Events between two states, by halving until they differ by one zone."""
    if _fronts(a) == _fronts(b):
        if not halvings or not _leaps(a, b, membrane.length):
            return []
        return _in_halves(membrane, a, b, after, name, verge, halvings)
    opening = len(b.zones.fronts) > len(a.zones.fronts)
    absent, present = (a, b) if opening else (b, a)
    zone = _extra_zone(absent.zones, present.zones, membrane.length)
    if zone is not None:
        if opening and ((zone[0] == 0 and verge[0]) or (zone[1] == membrane.length and verge[1])):
            return []
        try:
            return _located(membrane, absent, present, zone, after, name, opening)
        except ConvergenceError:
            if not halvings:
                raise
    if not halvings:
        return _at_both_ends(membrane, absent, present, after, name, opening)
    try:
        found = _in_halves(membrane, a, b, after, name, verge, halvings)
    except ConvergenceError:
        if zone is None or zone[0] == 0 or zone[1] == membrane.length or absent.layout is None:
            raise
        found = [_crossed(membrane, absent, present, zone, after, name, opening)]
    return found


def _leaps(a: ZonedState, b: ZonedState, length: float) -> bool:
    """Whether a front has moved so far that it may be another one: one zone opened and another closed."""
    return any(abs(x - y) > LARGE_MOVE * length for x, y in zip(a.zones.fronts, b.zones.fronts, strict=True))


def _in_halves(
    membrane: Membrane,
    a: ZonedState,
    b: ZonedState,
    after: int,
    name: str,
    verge: np.ndarray,
    halvings: int,
) -> list[Event]:
    """Events between two states, in one half of the interval of a column and then in the other."""
    middle = membrane.fitted(a, fixed.Held(name, (_value(a, name) + _value(b, name)) / 2))[-1]
    return [
        *_between(membrane, a, middle, after, name, verge, halvings - 1),
        *_between(membrane, middle, b, after, name, verge, halvings - 1),
    ]


def _value(held: ZonedState, name: str) -> float:
    """A load of a state, or a functional."""
    if name in held.state.loads:
        return held.state.loads[name]
    with held.lent():
        return held.model.system.monitor(name)


def _at_both_ends(
    membrane: Membrane, absent: ZonedState, present: ZonedState, after: int, name: str, opening: bool
) -> list[Event]:
    """Zones that open or close at both ends at once, as in a symmetric membrane."""
    fewer, more = absent.zones, present.zones
    if len(more.fronts) != len(fewer.fronts) + 2 or more.first == fewer.first:
        raise ConvergenceError("several zones change at once")
    last = more.first * (-1) ** len(more.fronts)
    ends = ((0.0, more.fronts[0], more.first), (more.fronts[-1], membrane.length, last))
    return [e for zone in ends for e in _located(membrane, absent, present, zone, after, name, opening)]


def _extra_zone(absent: Zones, present: Zones, length: float) -> tuple[float, float, float] | None:
    """Ends and state of the one zone that ``present`` has and ``absent`` does not have."""
    fewer, more = len(absent.fronts), len(present.fronts)
    edges = [0.0, *present.fronts, length]
    if more == fewer + 1:
        if absent.first != present.first:
            return edges[0], edges[1], present.first
        return edges[-2], edges[-1], -absent.first if fewer % 2 == 0 else absent.first
    if more == fewer + 2 and absent.first == present.first:
        # The zone whose removal moves the other fronts least.
        best = min(
            range(1, more),
            key=lambda k: (
                sum(
                    abs(x - y)
                    for x, y in zip(
                        [f for j, f in enumerate(present.fronts, 1) if j not in (k, k + 1)],
                        absent.fronts,
                        strict=True,
                    )
                )
                + (edges[k + 1] - edges[k])
            ),
        )
        state = present.first if best % 2 == 0 else -present.first
        return edges[best], edges[best + 1], state
    return None


def _located(
    membrane: Membrane,
    absent: ZonedState,
    present: ZonedState,
    zone: tuple[float, float, float],
    after: int,
    name: str,
    opening: bool,
) -> list[Event]:
    """The event, from ``gw = 1`` at an end, or ``gw = 1, gw' = 0`` inside, without the zone."""
    low, high, state = zone
    at_end = low == 0.0 or high == membrane.length
    place = 0.0 if low == 0.0 else high if at_end else (low + high) / 2
    levels = membrane.touching(absent, Touch(place, at_end))
    value, place = _value(levels[-1], name), levels[0].touched
    ends = sorted(_value(held, name) for held in (absent, present))
    slack = (SLACK if name == membrane.control else VOLUME_SLACK) * max(1.0, abs(ends[1]))
    if not ends[0] - slack <= value <= ends[1] + slack or not 0 <= place <= membrane.length:
        raise ConvergenceError(
            f"a zone's event was found at {name} = {value:.12g}, outside [{ends[0]:.12g}, {ends[1]:.12g}]"
        )
    kind = "zone_opening" if opening else "zone_closing"
    return [Event(kind, state, after, tuple(levels))]


def _crossed(
    membrane: Membrane,
    absent: ZonedState,
    present: ZonedState,
    zone: tuple[float, float, float],
    after: int,
    name: str,
    opening: bool,
) -> Event:
    """The event inside the meridian, as the root of the extreme ``gw - 1`` of states without the zone.

    Where the zone opens next to the liquid's surface, the block between both is so thin that Newton's method
    does not find the point at which ``gw`` touches 1.
    """
    *ends, state = zone
    levels: list[ZonedState] = []
    for level in reversed(range(len(membrane.meshes))):
        start = levels[-1] if levels else absent

        def without(value: float, level: int = level, start: ZonedState = start) -> ZonedState:
            held = fixed.Held(name, value)
            return membrane.fit(level, start, absent.zones, (held,), same=True)

        def excess(value: float, without: Callable[[float], ZonedState] = without) -> float:
            return _extreme(without(value), ends, state)[0]

        load = root(excess, _value(absent, name), _value(present, name), f"{name} of a zone's event")
        held = without(load)
        levels.append(replace(held, touched=_extreme(held, ends, state)[1]))
    return Event("zone_opening" if opening else "zone_closing", state, after, tuple(levels[::-1]))


def _extreme(held: ZonedState, ends: Sequence[float], state: float) -> tuple[float, float]:
    """How far ``gw`` is at most on the side of a zone between two points, and where."""
    low, high = ends
    for _ in range(2):
        s = np.linspace(low, high, SAMPLES)
        beyond = state * (held.sampled(s)["gw"] - 1)
        best = int(np.argmax(beyond))
        low, high = s[max(best - 1, 0)], s[min(best + 1, SAMPLES - 1)]
    # The samples around a flat extreme differ by little more than round-off: it is the top of a parabola.
    fit = np.polynomial.Polynomial.fit(s, beyond, 2)
    inside = [top for top in fit.deriv().roots() if s[0] <= top <= s[-1]]
    place = inside[0] if inside else s[best]
    return float(fit(place)), float(place)
