"""Tracked equilibria: Newton's method, the choice of zones, and the check of their signs.

The first pattern of zones comes from the untracked finite differences, or from the last state of a branch.
After each solve gw - 1 is evaluated inside every zone, and the pattern is corrected until every zone has the
right sign.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.collocation import Array, lagrange, lobatto
from reference_data.solvers.paper4.material import Body
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.paper4.methods.collocation import Pattern, Rule, State, VanishedZoneError, newton

RULES = (Rule(16, 0.4), Rule(18, 0.3))
SAMPLES = np.linspace(0, 1, 25)[1:-1]  # points at which the sign is checked inside an element
NO_SIGN = 3e-12  # |gw - 1| below this is rounding, and the state of such a point is not decided
APART = 1e-6  # of a front and a surface that have just changed places

Curve = Callable[[Array], Array]  # s -> (r, z, l, b, v) along the last axis


def evaluate(state: State, s: Array) -> Array:
    """(r, z, l, b) at positions s."""
    return state.mesh.evaluate(state.y, s)


def wrinkling(membrane: Body, s: Array, y: Array) -> Array:
    """The function gw - 1, whose sign decides, from (r, z, l, b); at a pole l2 is the limit l."""
    R = membrane.unloaded(np.asarray(s))
    l2 = np.where(R > 0, y[..., 0] / np.where(R > 0, R, 1.0), y[..., 2])
    return l2 * np.sqrt(y[..., 2]) - 1


def build(membrane: Body, rule: Rule, pattern: Pattern, curve: Curve, load: float) -> State:
    """A first state for Newton's method, with elements chosen by the lengths of the zones."""
    counts = tuple(int(np.ceil(w / rule.longest)) for w in np.diff(pattern.breaks))
    blank = State(membrane, rule, pattern, counts, np.empty(0), load)
    return State(membrane, rule, pattern, counts, curve(blank.s), load)


def rebuilt(state: State, pattern: Pattern, rule: Rule | None = None) -> State:
    """The same values with other zones, or on other polynomials."""
    curve = lambda s: state.mesh.evaluate(state.values, s)  # noqa: E731
    return build(state.membrane, rule or state.rule, pattern, curve, state.load)


def pattern_from(membrane: Body, load: float, tense: bool, found: list[tuple[float, str]]) -> Pattern:
    """Pattern from the inner breakpoints and the state of the lowest zone."""
    flags, wet = [bool(tense)], [membrane.load == "gas" or membrane.pole or load > 0]
    for _, kind in sorted(found):
        flags.append(flags[-1] != (kind == "front"))
        wet.append(wet[-1] and kind != "surface")
    inner = [(float(x), kind) for x, kind in sorted(found)]
    breaks = (0.0, *(x for x, _ in inner), membrane.L)
    return Pattern(breaks, tuple(kind for _, kind in inner), tuple(flags), tuple(wet))


def surface_of(membrane: Body, height: Callable[[float], Any], load: float) -> list[tuple[float, str]]:
    """Position of the fluid's surface, if it lies on the membrane; z rises along it."""
    if not membrane.crossed(load):
        return []
    at = brentq(lambda s: float(height(s)) - load, 0.0, membrane.L, xtol=1e-14)
    return [(float(at), "surface")]


def from_grid(grid: fd.Grid, rule: Rule) -> State:
    """Guess and pattern from finite differences; zones of one or two cells are ignored as noise."""
    membrane = grid.membrane
    nodes = np.linspace(0, membrane.L, grid.n + 1)
    s, r, l1, angle = grid.middle
    volume = np.concatenate([[0.0], np.cumsum(r * r * np.diff(grid.z) / 2)])

    def curve(x: Array) -> Array:
        columns = (nodes, grid.r), (nodes, grid.z), (s, l1), (s, angle), (nodes, volume)
        return np.stack([np.interp(x, *c) for c in columns], axis=-1)

    g = grid.gw - 1
    tense = np.full(grid.n, membrane.energy == "standard") if membrane.decided(grid.load) else g > 0
    runs = np.split(np.arange(grid.n), np.nonzero(np.diff(tense))[0] + 1)
    for run in runs[1:-1]:
        if len(run) < 3:
            tense[run] = ~tense[run]
    slope = np.where(np.diff(g) == 0, 1.0, np.diff(g))
    cut = s[:-1] + np.clip(-g[:-1] / slope, 0, 1) * np.diff(s)
    found = surface_of(membrane, lambda x: np.interp(x, nodes, grid.z), grid.load)
    found += [(float(cut[i]), "front") for i in np.nonzero(tense[:-1] != tense[1:])[0]]
    return build(membrane, rule, pattern_from(membrane, grid.load, tense[0], found), curve, grid.load)


def signs(state: State) -> tuple[Array, Array, Array]:
    """Positions inside the elements and at both ends, gw - 1 there, and the claimed flags."""
    mesh, tense = state.mesh, np.array(state.pattern.tense)[state.zone]
    s = mesh.edges[:-1, None] + mesh.widths[:, None] * SAMPLES
    y = np.einsum("im,kmc->kic", lagrange(lobatto(mesh.degree), SAMPLES), state.y)
    s = np.concatenate([[0.0], s.ravel(), [state.membrane.L]])
    y = np.concatenate([state.y[0, :1], y.reshape(-1, 4), state.y[-1, -1:]])
    flags = np.repeat(tense, len(SAMPLES))
    return s, wrinkling(state.membrane, s, y), np.concatenate([flags[:1], flags, flags[-1:]])


def mended(state: State) -> State | None:
    """The state with the zones of its own signs; None if it already has them."""
    membrane, old = state.membrane, state.pattern.fronts
    if membrane.decided(state.load):
        return None
    s, g, flags = signs(state)
    wanted = np.where(np.abs(g) < NO_SIGN, flags, g > 0)
    placed = ("surface" in state.pattern.kinds) == membrane.crossed(state.load)
    if np.array_equal(wanted, flags) and placed:
        return None
    found = surface_of(membrane, lambda x: evaluate(state, np.array(x))[1], state.load)
    for i in np.nonzero(wanted[:-1] != wanted[1:])[0]:
        near = old[(old > s[i]) & (old < s[i + 1])]
        if len(near):
            cut = near[0]
        elif g[i] * g[i + 1] < 0:
            cut = brentq(
                lambda x: float(wrinkling(membrane, x, evaluate(state, np.array(x)))), s[i], s[i + 1]
            )
        else:
            cut = (s[i] + s[i + 1]) / 2
        found.append((float(cut), "front"))
    return rebuilt(state, pattern_from(membrane, state.load, wanted[0], found))


def without(state: State, zone: int) -> State:
    """The state without a vanished zone, which joins its neighbours.

    A surface that reaches the upper end leaves; a surface and a front that meet change places.
    """
    p = state.pattern
    inner = list(zip(p.breaks[1:-1], p.kinds, strict=True))
    ends = [i for i in (zone - 1, zone) if 0 <= i < len(inner)]
    if len(ends) == 2 and inner[ends[0]][1] != inner[ends[1]][1]:
        (a, first), (b, second) = (inner[i] for i in ends)
        inner[ends[0]], inner[ends[1]] = (a - APART, second), (b + APART, first)
    else:
        leaves = zone == len(inner)
        inner = [x for i, x in enumerate(inner) if i not in ends or (x[1] == "surface" and not leaves)]
    starts = p.tense[0] if zone or p.kinds[:1] != ("front",) else not p.tense[0]
    return rebuilt(state, pattern_from(state.membrane, state.load, starts, inner))


def polished(guess: State, control: str, target: float) -> State:
    """Solve and correct the zones until their signs are right.

    If Newton's method does not converge, gw - 1 may no longer change its sign in a zone, whose length
    decreases like a square root to zero. Then the only wrinkled zone between taut dry ones is removed.

    Raises:
        RuntimeError: If Newton's method fails, or the pattern does not settle.
    """
    state, given_up = guess, False
    for _ in range(14):
        try:
            solved = newton(state, control, target)
        except VanishedZoneError as error:
            state = without(state, error.zone)
            continue
        except RuntimeError:
            p = state.pattern
            inner = [i for i in range(1, len(p.tense) - 1) if not p.tense[i] and not p.wet[i]]
            if given_up or len(inner) != 1 or p.kinds[inner[0] - 1 : inner[0] + 1] != ("front", "front"):
                raise
            state, given_up = without(state, inner[0]), True
            continue
        again = mended(solved)
        if again is None:
            return solved
        state = again
    raise RuntimeError(f"collocation: zones do not settle at {control} = {target:g}, {guess.membrane}")


def moved_to(state: State, rule: Rule) -> State:
    """The same state on other polynomials."""
    return rebuilt(state, state.pattern, rule)
