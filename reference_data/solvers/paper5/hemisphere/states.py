"""Tracked states of the hanging hemisphere: a start, the choice of zones, the check of their signs."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.collocation import lagrange
from reference_data.solvers.paper4.methods.collocation import Pattern, Rule
from reference_data.solvers.paper5.hemisphere import differences as fd
from reference_data.solvers.paper5.hemisphere.collocation import (
    EQUATOR,
    KAPPA,
    Hanging,
    VanishedZoneError,
    counts,
    newton,
)

Array = np.ndarray
RULES = (Rule(16, 0.16), Rule(18, 0.12))
SAMPLES = np.linspace(0, 1, 25)[1:-1]  # points at which the sign is checked inside an element
NO_SIGN = 3e-12  # |gw - 1| below this is rounding


def evaluate(state: Hanging, t: Array) -> Array:
    """(r, z, l, b) at angles t."""
    flat, edges = np.ravel(t), state.edges
    e = np.clip(np.searchsorted(edges, flat, side="right") - 1, 0, len(edges) - 2)
    rows = lagrange(state.rule.nodes, (flat - edges[e]) / np.diff(edges)[e])
    return np.einsum("im,imc->ic", rows, state.y[e]).reshape(*np.shape(t), 4)


def wrinkling(t: Array, y: Array) -> Array:
    """Wrinkling function minus 1; at the pole l2 is the limit l."""
    R = np.sin(t)
    l2 = np.where(R > 0, y[..., 0] / np.where(R > 0, R, 1.0), y[..., 2])
    return l2 * np.sqrt(y[..., 2]) - 1


def built(rule: Rule, pattern: Pattern, curve: Any, zw: float) -> Hanging:
    """A first state for Newton's method."""
    state = Hanging(rule, pattern, np.empty(0), zw, counts(pattern, rule))
    state.y = curve(state.t)
    return state


def mended(state: Hanging) -> Hanging | None:
    """The state with the zones of its own signs; None if it already has them."""
    edges = state.edges
    t = (edges[:-1, None] + np.diff(edges)[:, None] * SAMPLES).ravel()
    t = np.concatenate([[0.0], t, [EQUATOR]])
    g = wrinkling(t, evaluate(state, t))
    flags = np.array(state.pattern.tense)[np.searchsorted(np.array(state.pattern.breaks[1:-1]), t)]
    wanted = np.where(np.abs(g) < NO_SIGN, flags, g > 0)
    if np.array_equal(wanted, flags):
        return None
    found = [(state.level, "surface")]
    old = state.pattern.fronts
    for i in np.nonzero(wanted[:-1] != wanted[1:])[0]:
        near = old[(old > t[i]) & (old < t[i + 1])]
        if len(near):
            cut = float(near[0])
        elif g[i] * g[i + 1] < 0:
            cut = brentq(
                lambda x: float(wrinkling(np.array(x), evaluate(state, np.array(x)))), t[i], t[i + 1]
            )
        else:
            cut = float(t[i] + t[i + 1]) / 2
        found.append((cut, "front"))
    return rebuilt(state, sorted(found), bool(wanted[0]))


def rebuilt(state: Hanging, found: list[tuple[float, str]], first: bool) -> Hanging:
    """The state with other inner breakpoints."""
    flags, wet = [first], [True]
    for _, kind in found:
        flags.append(flags[-1] != (kind == "front"))
        wet.append(wet[-1] and kind != "surface")
    pattern = Pattern(
        (0.0, *(b for b, _ in found), EQUATOR), tuple(k for _, k in found), tuple(flags), tuple(wet)
    )
    return built(state.rule, pattern, lambda t: evaluate(state, t), state.zw)


def without(state: Hanging, zone: int) -> Hanging:
    """The state without a vanished zone, which joins its neighbours."""
    p = state.pattern
    inner = list(zip(p.breaks[1:-1], p.kinds, strict=True))
    ends = [i for i in (zone - 1, zone) if 0 <= i < len(inner)]
    if len(ends) == 2 and {inner[i][1] for i in ends} == {"front", "surface"}:
        # front and level change places
        a, b = inner[ends[0]], inner[ends[1]]
        inner[ends[0]], inner[ends[1]] = (a[0] - 1e-6, b[1]), (b[0] + 1e-6, a[1])
    else:
        inner = [x for i, x in enumerate(inner) if i not in ends or x[1] == "surface"]
    first = p.tense[0] if zone else not p.tense[0]
    return rebuilt(state, inner, first)


def polished(guess: Hanging, control: str, target: float) -> Hanging:
    """Solve and correct the zones until their signs are right.

    If Newton's method does not converge, gw - 1 may no longer change its sign in a zone, whose length
    decreases like a square root to zero. Then the shortest wrinkled zone is removed.

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
    raise RuntimeError(f"hemisphere: zones do not settle at {control} = {target:g}")


def moved_to(state: Hanging, rule: Rule) -> Hanging:
    """The same state on other polynomials."""
    return built(rule, state.pattern, lambda t: evaluate(state, t), state.zw)


def start(zw: float = -0.6, rule: Rule = RULES[0]) -> Hanging:
    """The state at a high level, from central differences."""
    t, y = fd.state(zw, KAPPA)
    middle, slope = (t[1:] + t[:-1]) / 2, np.diff(y, axis=0) / np.diff(t)[:, None]
    columns = (
        (t, y[:, 0]),
        (t, y[:, 1]),
        (middle, np.hypot(slope[:, 0], slope[:, 1])),
        (middle, np.arctan2(slope[:, 0], slope[:, 1])),
    )
    level = float(np.interp(zw, y[:, 1], t))
    pattern = Pattern((0.0, level, EQUATOR), ("surface",), (True, True), (True, False))
    guess = built(rule, pattern, lambda x: np.stack([np.interp(x, *c) for c in columns], axis=-1), zw)
    return polished(mended(guess) or guess, "zw", zw)
