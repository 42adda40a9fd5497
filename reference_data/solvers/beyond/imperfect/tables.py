"""Tables of over-filled tubes with an imperfection: limit levels and volumes, and the laws they tend to."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from reference_data.solvers.beyond.bowed.limits import Law, State, law, limits, straight
from reference_data.solvers.beyond.imperfect.collocation import LiquidCollocation
from reference_data.solvers.beyond.imperfect.galerkin import LiquidGalerkin
from reference_data.solvers.beyond.imperfect.tube import Imperfect
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.registry import Builder

TILTED = Imperfect(FluidTube(8, 5), 1, tilted=True)
LOBED = Imperfect(FluidTube(8, 7), 2, tilted=False)
SIZES = {TILTED: (0.004, 0.012, 0.036, 0.108), LOBED: (4e-4, 1.2e-3, 3.6e-3, 1.08e-2)}
GRIDS = {
    TILTED: {LiquidGalerkin: ((24, 6), (28, 8)), LiquidCollocation: ((36, 6), (40, 8))},
    LOBED: {LiquidGalerkin: ((20, 9), (24, 11)), LiquidCollocation: ((32, 9), (36, 11))},
}
"""Degree along the tube and largest wave number, coarse and fine, of each method."""
BETWEEN = 0.01
"""Difference of radii, from the axisymmetric code's bifurcation, between which it is located."""
OFFSETS = 0.04, 0.08, 0.12, 0.16, 0.2
"""Offsets of bent states of the even tube."""
ROUNDING = 1e-9
"""Newton's last step; the place of a limit, which is a root of a slope, in other columns."""
FITTED = 2e-8
"""Curvatures from a polynomial in the square of the offset, and rates from differences of fourth order."""

COLUMNS = {
    "tilt": ("1", "angle from the axis to the vertical, degrees"),
    "uneven": ("1", "e of the thickness 1 + e cos(2 Theta) over its mean"),
    "zw": ("1/A", "level"),
    "V": ("1/A^3", "volume of the liquid"),
    "zw_2": ("A", "zw - zw_c over the square of half the difference of the radii in the middle, bent states"),
    "V_2": ("1/A", "V - V_c over the same"),
    **{
        f"{name}_{e}": (scale, f"({name} - {name}_c)/{e}^(2/3) at an extremum of {name} as {e} vanishes")
        for e in ("tilt", "uneven")
        for name, scale in (("zw", "1/A"), ("V", "1/A^3"))
    },
}
METHOD = (
    "Two codes for the surface in space, with one polynomial along the tube and trigonometric polynomials "
    "around: (a) collocation of the balance of forces; (b) the principle of virtual work. They share the "
    "path along the branch and no equation; first guesses are from the axisymmetric code. " + rule("b")
)
GRID = {
    of: "; ".join(
        f"({name}) degrees {pair[0][0]} and {pair[1][0]}, waves up to {pair[0][1]} and {pair[1][1]}"
        for name, pair in (("a", grids[LiquidCollocation]), ("b", grids[LiquidGalerkin]))
    )
    for of, grids in GRIDS.items()
}
SOURCE = "beyond Patil, Nordmark & Eriksson (2015); Koiter (1945)"
STOPPING = "Newton takes two more steps after the first one below 1e-7"
SERIES = {of: Series("beyond", SOURCE, COLUMNS, METHOD, grid, STOPPING) for of, grid in GRID.items()}


def given(of: Imperfect) -> dict[str, object]:
    """Parameters as stored."""
    return {"L": float(of.tube.L), "delta": float(of.tube.delta), "gamma": of.tube.gamma, "n": of.n}


@cache
def laws(of: Imperfect) -> dict[type, list[Law]]:
    """The even tube on all grids."""
    shape, out = of.near(), {}
    for kind, pair in GRIDS[of].items():
        out[kind] = []
        for sizes in pair:
            code = kind(of, *sizes)
            guess = State(code, code.tube(*shape.evaluate(code.nodes * of.tube.length)[0].T), shape.zw)
            radius = float(code.radius @ guess.x[code.free])
            low, high = radius - BETWEEN, radius + BETWEEN
            out[kind].append(law(straight(code, low, guess), low, high, OFFSETS))
    return out


@cache
def extrema(of: Imperfect, of_volume: bool) -> dict[type, list[list[State]]]:
    """The limits of the level, or extrema of the volume, on all grids."""
    return {kind: [limits(one, SIZES[of], of_volume) for one in pair] for kind, pair in laws(of).items()}


def read(table: str, name: str, of: Callable[[type, int], list[float]], rounding: float) -> Column:
    """A column by both methods, from the numbers of a method on its coarse and its fine grid."""
    kinds = LiquidCollocation, LiquidGalerkin
    levels = [Levels(of(kind, 0), of(kind, 1), rounding=rounding) for kind in kinds]
    return agreed(table, name, *levels, COLUMNS[name], other="collocation", written="virtual work")


def largest(name: str, of: Imperfect, key: str, of_volume: bool) -> Table:
    """Limit levels, or extreme volumes, by the imperfection."""
    found = extrema(of, of_volume)
    columns = [read(name, "V", lambda kind, k: [s.volume for s in found[kind][k]], rounding=ROUNDING)]
    if not of_volume:
        levels = read(name, "zw", lambda kind, k: [s.p for s in found[kind][k]], rounding=ROUNDING)
        columns.insert(0, levels)
    what = "Extreme volume" if of_volume else "Limit level"
    keys = SERIES[of].keys(**{key: np.array(SIZES[of])})
    title = f"{what} of an over-filled tube, by {key}"
    return SERIES[of].table(name, title, "", given(of), keys + columns, extra={"keys": [key]})


def begins(name: str, of: Imperfect, key: str) -> Table:
    """Where the even, upright tube bifurcates, and the constants of the laws."""
    values: dict[str, Callable[[Law], float]] = {
        "zw": lambda one: one.start.p,
        "V": lambda one: one.start.volume,
        "zw_2": lambda one: one.p_2,
        "V_2": lambda one: one.volume_2,
        f"zw_{key}": lambda one: one.constant,
        f"V_{key}": lambda one: one.volume_constant,
    }
    roundings = [ROUNDING] * 2 + [FITTED] * 4

    def rows(of_law: Callable[[Law], float], kind: type, k: int) -> list[float]:
        return [of_law(laws(of)[kind][k])]

    columns = [
        read(name, column, partial(rows, f), rounding)
        for (column, f), rounding in zip(values.items(), roundings, strict=True)
    ]
    title = f"Where an over-filled tube bifurcates, and Koiter's laws for {key}"
    return SERIES[of].table(name, title, "", given(of), columns)


TABLES: dict[str, Builder] = {
    "tilted_tube_law": partial(begins, "tilted_tube_law", TILTED, "tilt"),
    "tilted_tube_limits": partial(largest, "tilted_tube_limits", TILTED, "tilt", of_volume=False),
    "tilted_tube_volumes": partial(largest, "tilted_tube_volumes", TILTED, "tilt", of_volume=True),
    "lobed_tube_law": partial(begins, "lobed_tube_law", LOBED, "uneven"),
    "lobed_tube_limits": partial(largest, "lobed_tube_limits", LOBED, "uneven", of_volume=False),
}
