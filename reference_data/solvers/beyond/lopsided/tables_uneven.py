"""Tables of a tube whose thickness is uneven along its length: free inflation, and the detached states."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.beyond.lopsided import energy, strong
from reference_data.solvers.beyond.lopsided.tables import (
    ASKED,
    COLUMNS,
    GRID,
    SOURCE,
    TOLERANCE,
    Both,
    column,
    read,
)
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.tables import Column, Series, Table, rule
from reference_data.solvers.paper2.collocation.critical import start

ASKED_FOR = ASKED["neo_hookean"]
UNEVEN = 1e-5, 1e-4, 1e-3, 1e-2
"""Magnitudes of the unevenness of which extrema are computed."""
BRANCH = 1e-2
"""That of the branches."""
VOLUMES = 8.0, 9.5, 10.5, 11.0, 11.5, 12.0, 12.5, 13.0, 14.0, 15.0, 16.5, 18.0, 19.5
PLACES = 0.17, 0.18, 0.19, 0.21, 0.25, 0.3, 0.36
"""Positions of the middle on the detached branch."""
SIZE, ABOVE, BELOW = 0.75, 1.5, 0.93
"""Position of the middle at the extrema over the cubic root of the unevenness, roughly, and a bracket."""
PLACE = 1e-9
"""Uncertainty of the place of an extremum: the root of a slope to 1e-10, and its rounding."""
LARGEST = 2e-3
"""Largest step of the unevenness."""

METHOD = (
    "Two codes on the whole tube without a condition of symmetry, which share the data of the tube and no "
    "equation: (a) collocation of the strong equations of paper 2, with a thickness that varies linearly "
    "along the tube, in two halves that meet at the middle; (b) the energy of a surface in space by "
    "polynomials of high degree, with second derivatives by complex steps of its gradient, from the states "
    "of (a) as guesses. " + rule("a")
)
WHERE = {"uneven": ("1", "e of the thickness 1 + e Z/(lf/2) over its mean")}
SERIES = Series("beyond", SOURCE, COLUMNS | WHERE, METHOD, GRID, TOLERANCE)


def detached(uneven: float, w: float) -> strong.State:
    """The state with the middle at w > 0 on the side that free inflation does not take: uneven < 0."""
    begin = strong.beside(ASKED_FOR.tube, strong.MESHES[0], ASKED_FOR.between, 0.02)
    state = strong.follow(begin, np.array([w]), "w")[0]
    for part in np.linspace(0, uneven, 2 + int(abs(uneven) / LARGEST))[1:]:
        state = strong.solve(replace(state, uneven=float(part)), "w", w)
    return state


def both(coarse: list[strong.State], values: Array, held: str) -> Both:
    """The same states by both methods."""
    fine = [strong.again(s, strong.MESHES[1], held, v) for s, v in zip(coarse, values, strict=True)]
    others = [
        [energy.at(ASKED_FOR.tube, basis, s, held, float(v)) for s, v in zip(fine, values, strict=True)]
        for basis in energy.BASES
    ]
    return Both([coarse, fine], others)


def branch(table: str, title: str, states: Both, facts: dict[str, object], keys: list[Column]) -> Table:
    """One branch over a column."""
    names = tuple(n for n in ("p", "u_max", "w_mid", "V") if n != keys[0].name)
    tube = ASKED_FOR.tube
    given = {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf} | facts
    return SERIES.table(table, title, "", given, [*keys, *read(table, states, names)])


def free() -> Table:
    """Free inflation of an uneven tube."""
    tube, volumes = ASKED_FOR.tube, np.array(VOLUMES)
    half = start(tube, strong.MESHES[0], "V", VOLUMES[0] / 2)
    begin = strong.solve(replace(strong.mirrored(half), uneven=BRANCH), "V", VOLUMES[0])
    found = both(strong.follow(begin, volumes, "V"), volumes, "V")
    title = "Free inflation of a tube of uneven thickness over its volume"
    return branch("uneven_tube_free", title, found, {"uneven": BRANCH}, SERIES.keys(V=volumes))


def other_side() -> Table:
    """The detached states of the same tube."""
    places = np.array(PLACES)
    largest = detached(-BRANCH, PLACES[-1])
    found = both(strong.follow(largest, places[::-1], "w")[::-1], places, "w")
    title = "States of a tube of uneven thickness with the bulge at its thick end"
    return branch("uneven_tube_detached", title, found, {"uneven": -BRANCH}, SERIES.keys(w_mid=places))


def extrema(which: int) -> Table:
    """The largest pressure (0) or the smallest volume (1) of the detached states, over the unevenness."""
    by_equations: list[list[strong.State]] = [[], []]
    by_energy: list[list[energy.State]] = [[], []]
    for uneven in UNEVEN:
        size = SIZE * uneven ** (1 / 3)
        coarse = strong.extremum(detached(-uneven, ABOVE * size), which, (ABOVE * size, BELOW * size))
        around = 0.98 * coarse.w_mid, 1.02 * coarse.w_mid
        for level, mesh in zip(by_equations, strong.MESHES, strict=True):
            near = strong.again(coarse, mesh, "w", coarse.w_mid)
            level.append(strong.extremum(near, which, around))
        for level, basis in zip(by_energy, energy.BASES, strict=True):
            here = [energy.at(ASKED_FOR.tube, basis, coarse, "w", coarse.w_mid)]

            def slope(w: float, here: list[energy.State] = here) -> float:
                here[0] = energy.solve(here[0], "w", w)
                return energy.rates_of(here[0])[which]

            level.append(energy.solve(here[0], "w", brentq(slope, *around, xtol=1e-10)))
    kind = ("limits", "smallest")[which]
    table, tube = f"uneven_tube_{kind}", ASKED_FOR.tube
    found = read(table, Both(by_equations, by_energy), ("pV"[which],))
    for name, attribute in {"p": "p", "V": "volume", "u_max": "u_max", "w_mid": "w_mid"}.items():
        if name != "pV"[which]:
            pairs = [
                [np.array([getattr(s, attribute) for s in level]) for level in levels]
                for levels in (by_energy, by_equations)
            ]
            found.append(column(table, name, *pairs, floor=PLACE))
    what = "Largest pressure" if which == 0 else "Smallest volume"
    facts = {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf}
    title = f"{what} of a tube of uneven thickness with the bulge at its thick end"
    keys = SERIES.keys(uneven=-np.array(UNEVEN))
    return SERIES.table(table, title, "", facts, [*keys, *found], extra={"keys": ["uneven"]})


TABLES = {
    "uneven_tube_free": free,
    "uneven_tube_detached": other_side,
    "uneven_tube_limits": partial(extrema, 0),
    "uneven_tube_smallest": partial(extrema, 1),
}
