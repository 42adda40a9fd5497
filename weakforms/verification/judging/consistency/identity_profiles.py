"""Identities between a state's columns and its profile: definitions, integrals, balances."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.ndimage import maximum_filter1d

from weakforms.results import Field, Result, State
from weakforms.verification.judging.bounds import compare
from weakforms.verification.judging.consistency import quadrature
from weakforms.verification.judging.consistency.identities import (
    SHARP,
    Columns,
    Found,
    Given,
    Identity,
    smooth_parts,
)

Reading = Callable[[Result, State, Field], "quadrature.Estimated | None"]
"""The number a profile gives for a state's column, with its uncertainty; ``None`` where it gives none."""


def read(
    column: str, statement: str, reading: Reading, over: Callable[[Given], bool] = lambda _: True
) -> Identity:
    """A column of a state is what its profile says."""

    def look(result: Result) -> Iterator[Found]:
        for state, field in profiles(result):
            quantity = state.quantities.get(column)
            found = None if quantity is None else reading(result, state, field)
            if found is not None:
                size = max(abs(found[0]), abs(quantity.value), SMALL)
                place = ", ".join(f"{k} = {v:.6g}" for k, v in state.at.items())
                numbers = quantity.value, quantity.uncertainty or 0.0, *found
                yield f"{column} ({state.branch})", place, compare(*numbers, size)

    return Identity(column, statement, look, over)


SMALL = 0.02
"""Smallest size a number is taken to have."""


def profiles(result: Result) -> Iterator[tuple[State, Field]]:
    """States drawn at random, which have all of their profile at the problem's own points."""
    drawn = result.numerics.get("drawn", {})
    at = [(name, {p["column"]: p["value"]}) for name, record in drawn.items() for p in record["points"]]
    for state in result.states:
        for field in state.fields:
            # Bent states have fields over a surface, for which nothing is stated here.
            meridian = field.name == "profile" and "Theta" not in field.columns
            if (state.branch, state.at) in at and meridian:
                yield state, field


def end(field: str, index: int) -> Reading:
    """A profile's first or last value."""
    return lambda _, __, profile: (float(profile.columns[field][index]), profile.uncertainty[field])


def origin(field: str) -> Reading:
    """A profile's value where its coordinate is zero, which is one of its points."""

    def reading(_: Result, __: State, profile: Field) -> quadrature.Estimated:
        x = next(iter(profile.columns.values()))
        return float(profile.columns[field][np.argmin(np.abs(x))]), profile.uncertainty[field]

    return reading


def extreme(pick: Callable[[np.ndarray], int], *fields: str, factor: float = 1.0) -> Reading:
    """The largest or smallest value of some columns of the profile."""

    def reading(_: Result, __: State, profile: Field) -> quadrature.Estimated:
        x = next(iter(profile.columns.values()))
        found = [quadrature.extreme(x, profile.columns[name], pick) for name in fields]
        k = pick(np.array([value for value, _ in found]))
        return factor * found[k][0], found[k][1] + profile.uncertainty[fields[k]]

    return reading


def middle(field: str) -> Reading:
    """A column in the middle of the body."""

    def reading(_: Result, __: State, profile: Field) -> quadrature.Estimated:
        x = next(iter(profile.columns.values()))
        value, doubt = quadrature.value_at(x, profile.columns[field], float(x[0] + x[-1]) / 2)
        return value, doubt + profile.uncertainty[field]

    return reading


def _crosses_level(state: State, profile: Field, place: float) -> bool:
    """Whether the surface of the liquid, a weak kink of a profile, lies among the points beyond a place."""
    if "zw" not in state.quantities or "z" not in profile.columns:
        return False
    x, z = next(iter(profile.columns.values())), profile.columns["z"]
    first = int(np.searchsorted(x, place))
    wet = z[max(first - 1, 0) : first + quadrature.BEYOND] < state.quantities["zw"].value
    return bool(wet.any() and not wet.all())


def at_front(front: str, field: str, kink: bool = True) -> Reading:
    """A column of the profile at a material point that is a column of the state."""

    def reading(_: Result, state: State, profile: Field) -> quadrature.Estimated | None:
        x = next(iter(profile.columns.values()))
        place = state.quantities[front].value if front in state.quantities else 0.0
        column = profile.columns[field]
        # At an end there is none: a liquid that stands above the whole membrane has no level on it.
        inside = x[0] < place < x[-1]
        found = quadrature.beyond(x, column, place, either=not kink) if inside else None
        return None if found is None else quadrature.spread([value for (value,) in found])

    return reading


def one_at(fronts: str, column: str) -> Identity:
    """A column of the profile is one at every front of a state."""

    def look(result: Result) -> Iterator[Found]:
        for state, profile in profiles(result):
            x = next(iter(profile.columns.values()))
            for name in (n for n in state.quantities if n.startswith(fronts)):
                found, place = at_front(name, column)(result, state, profile), state.quantities[name].value
                if found is not None and not _crosses_level(state, profile, place):
                    value, doubt = found
                    spread = doubt + profile.uncertainty[column] * quadrature.gain(x, place, 0)
                    yield f"{name} ({state.branch})", f"{place:.6g}", compare(value, spread, 1.0, 0.0, 1.0)

    return Identity(f"one_at_{fronts}", f"{column} = 1 at every front", look)


def zone(fronts: str) -> Reading:
    """Part of the body between fronts where the wrinkling function is below one."""

    def reading(_: Result, state: State, profile: Field) -> quadrature.Estimated:
        x, gw = next(iter(profile.columns.values())), profile.columns["gw"]
        found = sorted(q.value for name, q in state.quantities.items() if name.startswith(fronts))
        edges = [float(x[0]), *found, float(x[-1])]
        spread = sum(q.uncertainty or 0.0 for name, q in state.quantities.items() if name.startswith(fronts))
        length = quadrature.lengths(edges, lambda middle: float(np.interp(middle, x, gw)) < 1)
        return length / (edges[-1] - edges[0]), spread / (edges[-1] - edges[0])

    return reading


def enclosed(radius: str, height: str, factor: float) -> Reading:
    r"""Volume :math:`c \int r^2 \mathrm{d}z` of a body of revolution."""

    def reading(_: Result, __: State, profile: Field) -> quadrature.Estimated:
        x, r, z = _meridian(profile, radius, height)
        value, doubt = quadrature.integral(x, r**2, z)
        return factor * value, abs(factor) * doubt + profile.uncertainty[radius] * 4 * np.abs(r).max()

    return reading


def wetted(radius: str, height: str, factor: float, level: str = "zw") -> Reading:
    """The same up to the level of the liquid."""

    def reading(_: Result, state: State, profile: Field) -> quadrature.Estimated:
        x, r, z = _meridian(profile, radius, height)
        surface = quadrature.where(x, z, state.quantities[level].value)
        value, doubt = quadrature.integral(x, r**2, z, surface)
        return factor * value, abs(factor) * doubt + profile.uncertainty[radius] * 4 * np.abs(r).max()

    return reading


def _meridian(profile: Field, radius: str, height: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return next(iter(profile.columns.values())), profile.columns[radius], profile.columns[height]


def rate(load: str, reading: Reading, weight: Callable[[Result], float]) -> Identity:
    """The potential falls with the load by the weight of the volume that a state's profile wets."""

    def look(result: Result) -> Iterator[Found]:
        for state, profile in profiles(result):
            branch = result.branch(state.branch)
            x, pi = (np.asarray(branch.columns[name], float) for name in (load, "Pi"))
            i = int(np.argmin(np.abs(x - state.at[load]))) if load in state.at else -1
            part = next((p for p in smooth_parts(result, branch) if p.start + 2 <= i < p.stop - 2), None)
            if part is None or not (np.all(np.diff(x[part]) > 0) or np.all(np.diff(x[part]) < 0)):
                continue
            order = np.argsort(x[part])
            along = x[part][order]
            slopes = [spline(along, 1) for spline in quadrature.splines(along, pi[part][order])]
            k = int(np.searchsorted(along, x[i]))
            # Two splines are close by accident at one point, hardly at several that follow.
            doubt = quadrature.SAFETY * np.max(np.abs(slopes[0] - slopes[1])[max(k - 2, 0) : k + 3])
            slope = slopes[0][k]
            volume, spread = reading(result, state, profile)
            scale = -weight(result)
            size = abs(scale) * max(abs(volume), SMALL)
            found = compare(slope, doubt, scale * volume, abs(scale) * spread, size)
            yield "Pi", f"{load} = {x[i]:.6g}", found

    return Identity("rate", f"dPi/d{load} is minus the weight of the wetted volume of the profile", look)


def field(name: str, statement: str, by: Callable[[Result, State, Columns], np.ndarray]) -> Identity:
    """A column of the profile in closed form by the others, at every point."""

    def look(result: Result) -> Iterator[Found]:
        for state, profile in profiles(result):
            here = profile.columns[name]
            with np.errstate(invalid="ignore", divide="ignore"):
                there = np.broadcast_to(by(result, state, profile.columns), here.shape)
            good = np.isfinite(there)
            i = int(np.argmax(np.where(good, np.abs(here - there), -1)))
            used = 20 * max(
                profile.uncertainty.get(of, 0.0) for of in ("lam1", "lam2", "r", "z", "tension", name)
            )
            size = max(float(np.abs(here).max()), SMALL)
            found = compare(here[i], profile.uncertainty[name], there[i], used, size)
            yield f"{name} ({state.branch})", f"row {i}", found

    return Identity(f"field_{name}", statement, look)


ENDS = 3
"""Points at either end of a profile, where derivatives of both splines are one-sided and err alike."""


def derived(name: str, statement: str, by: Callable[..., np.ndarray], *of: str) -> Identity:
    """A column of the profile by derivatives of others along it, where the samples tell them.

    Args:
        name: The column.
        statement: What is said of it.
        by: Its value from the result, the state, the profile's columns and the derivatives.
        of: Columns whose derivatives are taken.
    """

    def look(result: Result) -> Iterator[Found]:
        for state, profile in profiles(result):
            x = next(iter(profile.columns.values()))
            slopes = [[s(x, 1) for s in quadrature.splines(x, profile.columns[other])] for other in of]
            sides = zip(*slopes, strict=True)
            fine, coarse = (by(result, state, profile.columns, *side) for side in sides)
            here = profile.columns[name]
            size = max(float(np.abs(here).max()), SMALL)
            # A kink is felt some points away, where the two are close again by accident.
            near = quadrature.SAFETY * maximum_filter1d(np.abs(fine - coarse), 9)
            near[:ENDS] = near[-ENDS:] = np.inf
            zones = np.flatnonzero(np.diff(profile.columns["gw"] > 1)) if "gw" in profile.columns else []
            for edge in zones:
                near[max(edge - 5, 0) : edge + 7] = np.inf
            clear = np.flatnonzero(4 * near <= SHARP * size)
            for i in clear[np.argsort(-(np.abs(here - fine) / near)[clear])[:1]]:
                numbers = here[i], profile.uncertainty[name], fine[i], near[i]
                place = f"{state.at}, row {i} of {len(clear)} that are clear"
                yield f"{name} ({state.branch})", place, compare(*numbers, size)

    return Identity(f"field_{name}", statement, look)
