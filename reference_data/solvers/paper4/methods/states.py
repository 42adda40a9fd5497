"""Tracked equilibria: Newton's method, the choice of zones, and the check of their signs.

The first pattern of zones comes from the untracked finite differences, or from the last state of a branch.
After each solve gw - 1 is evaluated inside every zone, and the pattern is corrected until every zone has the
right sign.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.collocation import lagrange
from reference_data.solvers.paper4.material import Array, Membrane
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.paper4.methods.collocation import Linearised, Pattern, Rule, State

RULES = (Rule(16, 0.4), Rule(18, 0.3))
SAMPLES = np.linspace(0, 1, 25)[1:-1]  # points at which the sign is checked inside an element
NO_SIGN = 3e-12  # |gw - 1| below this is rounding, and the state of such a point is not decided
SHORTEST = 1e-9  # a zone shorter than this (in Ao) has vanished

Curve = Callable[[Array], Array]  # s -> (r, z, l, b) along the last axis


class VanishedZoneError(RuntimeError):
    """A zone shrank to nothing in Newton's iteration."""

    def __init__(self, zone: int) -> None:
        super().__init__(f"zone {zone} vanished")
        self.zone = zone


def evaluate(state: State, s: Array) -> Array:
    """(r, z, l, b) at positions s."""
    flat, edges = np.ravel(s), state.edges
    e = np.clip(np.searchsorted(edges, flat, side="right") - 1, 0, len(edges) - 2)
    rows = lagrange(state.rule.nodes, (flat - edges[e]) / np.diff(edges)[e])
    return np.einsum("im,imc->ic", rows, state.y[e]).reshape(*np.shape(s), 4)


def wrinkling(y: Array) -> Array:
    """The function gw - 1, whose sign decides, from (r, z, l, b)."""
    return y[..., 0] * np.sqrt(y[..., 2]) - 1


def build(membrane: Membrane, rule: Rule, pattern: Pattern, curve: Curve, load: float) -> State:
    """A first state for Newton's method, with elements chosen by the lengths of the zones."""
    widths = np.diff(pattern.breaks)
    counts = tuple(int(np.ceil(w / rule.longest)) for w in widths)
    state = State(membrane, rule, pattern, counts, np.empty(0), load)
    state.y = curve(state.s)
    return state


def newton(start: State, control: str, target: float, max_iter: int = 30) -> tuple[State, Linearised]:
    """Equilibrium at a load (control "load") or an enclosed volume ("V"), the zones' order fixed.

    Steps are damped while they are large; after the first step below 1e-8 one more is taken,
    which leaves only rounding errors.

    Raises:
        VanishedZoneError: If a zone shrinks to nothing.
        RuntimeError: If the iteration does not converge.
    """
    state, small = start, 0
    for _ in range(max_iter):
        system = Linearised(state, control)
        if small == 2:
            return state, system
        ends, at = system.conditions()
        now = system.volume if control == "V" else state.load
        dy, moves, dload = system.solve(-system.defect, ends, at, target - now)
        size = max(float(np.abs(dy).max()), float(np.abs(moves).max(initial=0)), abs(dload))
        if not np.isfinite(size):
            break
        widths = np.diff(state.pattern.breaks)
        change = np.diff(np.concatenate([[0.0], moves, [0.0]]))
        room = np.where(change < 0, 0.8 * widths / np.maximum(-change, 1e-300), np.inf)
        scale = min(1.0, 0.4 / size, float(room.min()))
        if widths.min() < SHORTEST and change[np.argmin(widths)] < 0 and room.min() < 1:
            raise VanishedZoneError(int(np.argmin(widths)))
        inner = np.array(state.pattern.breaks[1:-1]) + scale * moves
        state = State(
            state.membrane,
            state.rule,
            state.pattern.moved(inner),
            state.counts,
            state.y + scale * dy,
            state.load + scale * dload,
        )
        small = small + 1 if size < 1e-8 else 0
    raise RuntimeError(f"collocation: no convergence at {control} = {target:g} for {start.membrane}")


def pattern_from(
    membrane: Membrane, s: Array, tense: Array, cut: Array, surface: float | None, below: bool
) -> Pattern:
    """Pattern from flags at positions s; cut holds the guessed front after each sample.

    ``below`` says whether the lower end is wet (always true for gas).
    """
    flips = np.nonzero(tense[:-1] != tense[1:])[0]
    found = [(float(cut[i]), "front") for i in flips]
    if surface is not None:
        found.append((surface, "surface"))
    found.sort()
    flags, wet = [bool(tense[0])], [below]
    for _, kind in found:
        flags.append(flags[-1] != (kind == "front"))
        wet.append(wet[-1] and kind != "surface")
    breaks = (0.0, *(b for b, _ in found), membrane.L)
    return Pattern(breaks, tuple(k for _, k in found), tuple(flags), tuple(wet))


def wets(membrane: Membrane, load: float) -> bool:
    """Whether the lower end is under pressure."""
    return membrane.load == "gas" or load > 0


def has_surface(membrane: Membrane, load: float) -> bool:
    """Whether the fluid's surface lies between the ends."""
    return membrane.load == "fluid" and 0 < load < membrane.delta * membrane.L


def surface_of(membrane: Membrane, height: Callable[[float], float], load: float) -> float | None:
    """Position of the fluid's surface, if it lies on the membrane; z rises along it."""
    if not has_surface(membrane, load):
        return None
    return float(brentq(lambda s: height(s) - load, 0.0, membrane.L, xtol=1e-14))


def from_grid(grid: fd.Grid, rule: Rule) -> State:
    """Guess and pattern from finite differences; zones of one or two cells are ignored as noise."""
    membrane = grid.membrane
    nodes = np.linspace(0, membrane.L, grid.n + 1)
    s, _, l1, angle = grid.middle

    def curve(x: Array) -> Array:
        columns = (nodes, grid.r), (nodes, grid.z), (s, l1), (s, angle)
        return np.stack([np.interp(x, *c) for c in columns], axis=-1)

    g = grid.gw - 1
    tense = np.full(grid.n, membrane.energy == "standard") if membrane.decided(grid.load) else g > 0
    runs = np.split(np.arange(grid.n), np.nonzero(np.diff(tense))[0] + 1)
    for run in runs[1:-1]:
        if len(run) < 3:
            tense[run] = ~tense[run]
    slope = np.where(np.diff(g) == 0, 1.0, np.diff(g))
    cut = s[:-1] + np.clip(-g[:-1] / slope, 0, 1) * np.diff(s)
    surface = surface_of(membrane, lambda x: float(np.interp(x, nodes, grid.z)), grid.load)
    return build(
        membrane,
        rule,
        pattern_from(membrane, s, tense, cut, surface, wets(membrane, grid.load)),
        curve,
        grid.load,
    )


def signs(state: State) -> tuple[Array, Array, Array]:
    """Positions inside the elements and at both ends, gw - 1 there, and the claimed flags."""
    edges = state.edges
    s = (edges[:-1, None] + np.diff(edges)[:, None] * SAMPLES).ravel()
    rows = lagrange(state.rule.nodes, SAMPLES)
    g = wrinkling(np.einsum("im,kmc->kic", rows, state.y)).ravel()
    tense = np.repeat(np.array(state.pattern.tense)[state.zone], len(SAMPLES))
    ends = wrinkling(state.y[[0, -1], [0, -1]])
    s = np.concatenate([[0.0], s, [state.membrane.L]])
    flags = np.concatenate([tense[:1], tense, tense[-1:]])
    return s, np.concatenate([ends[:1], g, ends[1:]]), flags


def mended(state: State) -> State | None:
    """The state with the zones of its own signs; None if it already has them."""
    if state.membrane.decided(state.load):
        return None
    s, g, flags = signs(state)
    wanted = np.where(np.abs(g) < NO_SIGN, flags, g > 0)
    placed = ("surface" in state.pattern.kinds) == has_surface(state.membrane, state.load)
    if np.array_equal(wanted, flags) and placed:
        return None
    cut = np.zeros(len(s) - 1)
    fronts = state.pattern.fronts
    for i in np.nonzero(wanted[:-1] != wanted[1:])[0]:
        near = fronts[(fronts > s[i]) & (fronts < s[i + 1])]
        if len(near):
            cut[i] = near[0]
        elif g[i] * g[i + 1] < 0:
            cut[i] = brentq(lambda x: float(wrinkling(evaluate(state, np.array(x)))), s[i], s[i + 1])
        else:
            cut[i] = (s[i] + s[i + 1]) / 2
    surface = surface_of(state.membrane, lambda x: float(evaluate(state, np.array(x))[1]), state.load)
    pattern = pattern_from(state.membrane, s, wanted, cut, surface, wets(state.membrane, state.load))
    return build(state.membrane, state.rule, pattern, lambda x: evaluate(state, x), state.load)


def without(state: State, zone: int) -> State:
    """The state without a vanished zone, which joins its neighbours, and with the same surface."""
    p = state.pattern
    middle = (np.array(p.breaks[:-1]) + np.array(p.breaks[1:])) / 2
    keep = [i for i in range(len(p.tense)) if i != zone]
    s = np.concatenate([[p.breaks[i], middle[i], p.breaks[i + 1]] for i in keep])
    tense = np.repeat(np.array(p.tense)[keep], 3)
    cut = (s[:-1] + s[1:]) / 2
    surface = None
    if zone < len(p.tense) - 1 or p.wet[-1]:  # otherwise the surface leaves at the upper end
        surface = surface_of(state.membrane, lambda x: float(evaluate(state, np.array(x))[1]), state.load)
    pattern = pattern_from(state.membrane, s, tense, cut, surface, wets(state.membrane, state.load))
    return build(state.membrane, state.rule, pattern, lambda x: evaluate(state, x), state.load)


def polished(guess: State, control: str, target: float) -> tuple[State, Linearised]:
    """Solve and correct the zones until their signs are right.

    Raises:
        RuntimeError: If Newton's method fails, or the pattern does not settle.
    """
    state = guess
    for _ in range(12):
        try:
            solved, system = newton(state, control, target)
        except VanishedZoneError as error:
            state = without(state, error.zone)
            continue
        again = mended(solved)
        if again is None:
            return solved, system
        state = again
    raise RuntimeError(f"collocation: zones do not settle at {control} = {target:g}, {guess.membrane}")


def moved_to(state: State, rule: Rule) -> State:
    """The same state on other polynomials."""
    return build(state.membrane, rule, state.pattern, lambda s: evaluate(state, s), state.load)
