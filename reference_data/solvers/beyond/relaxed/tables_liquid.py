"""Tables of the tube of liquid with the relaxed energy, beyond its first wrinkle.

The methods are those of paper 4 for a uniform thickness and disks as wide as the tube, of energies over
``C1`` instead of ``mu = 2 C1``: collocation with the fronts and the free surface as unknown breakpoints, and
shooting that is given no pattern of zones. The enclosed volume is raised past the highest level.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from reference_data.solvers.core.tables import Array, Column, Series, Table
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import limits as lim
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.cases import STEPS, Pair
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.registry import Builder


class Asked(NamedTuple):
    """One tube of liquid in its own units, and its rows."""

    L: float
    """Stretched length."""
    delta: float
    gamma: float
    """Weight of the liquid over ``mu = 2 C1``."""
    alpha: float
    begin: float
    """Level, before the highest one, from which the volume is raised."""
    step: float
    """Largest step of the enclosed volume per 2 pi."""
    volumes: tuple[float, ...]
    """Enclosed volumes per 2 pi of the rows, beyond the first wrinkle."""

    @property
    def membrane(self) -> Membrane:
        """The same tube in the units of paper 4."""
        return Membrane(1.0, self.delta, self.alpha, self.L / self.delta, 1.0, "fluid", 2 * self.gamma)


ASKED = {
    "full": Asked(
        8.0, 1.05, 0.116, 0.2, 11.0, 1.0, (29.5, 30.0, 32.0, 36.0, 40.0, 46.0, 52.0, 58.0, 64.0, 70.0)
    ),
    "part": Asked(8.0, 1.05, 0.5, 0.0, 2.6, 0.1, (6.74, 6.8, 6.9, 7.0, 7.2, 7.4, 7.6)),
}
"""A tube that the liquid fills, which stiffens, and a neo-Hookean one that a heavy liquid fills in part."""

COLUMNS = {
    "V": ("1/A^3", "volume of the liquid"),
    "zw": ("1/A", "level of the free surface, or static head over a full tube"),
    "r_max": ("1/A", "largest radius"),
    "T1_ring": ("1/(mu H)", "meridional Cauchy resultant at the rings"),
    "Z_front": ("1/A", "Z of the free surface"),
    "Z_front_1": ("1/A", "Z of the lower end of the wrinkled zone"),
    "Z_front_2": ("1/A", "Z of its upper end"),
}
_RULES = " and ".join(f"degree {r.degree} on elements up to {r.longest:g}" for r in lim.RULES)
GRID = f"(a) {_RULES} A long; (b) {sho.SEGMENTS} segments of {' and '.join(str(2 * n) for n in STEPS)} steps"
SOURCE = "beyond Patil, Nordmark & Eriksson, Proc. R. Soc. A 471 (2015) 20150016, with the relaxed energy"
SERIES = Series("beyond", SOURCE, COLUMNS, text.METHOD, GRID, text.TOLERANCE)
FRONTS = 2
"""Number of fronts of every row."""


def followed(asked: Asked) -> list[State]:
    """The states of the rows on the usual mesh."""
    membrane = asked.membrane
    state = sta.polished(sta.from_grid(cas.grid_at(membrane, asked.begin), sta.RULES[0]), "load", asked.begin)
    found, volume = [], state.volume
    for wanted in asked.volumes:
        for v in np.linspace(volume, wanted, 2 + int((wanted - volume) / asked.step))[1:]:
            state = sta.polished(state, "V", float(v))
        found.append(state)
        volume = wanted
    return found


def by_collocation(state: State) -> dict[str, float]:
    """Columns of a state of collocation."""
    surface = state.pattern.surface if "surface" in state.pattern.kinds else state.membrane.L
    filled = float(state.mesh.evaluate(state.values, np.array(surface))[4])
    return columns(state.load, filled, surface, msr.measures(state))


def by_shooting(shot: sho.Solution) -> dict[str, float]:
    """Columns of a shot."""
    wet = [part for part in shot.shot.parts if part.wet]
    filled = float(sum(part.end[4] - part.y[4] for part in wet))
    last = max(wet, key=lambda part: part.s)
    return columns(shot.load, filled, last.s + last.h, smsr.measures(shot))


def columns(load: float, filled: float, surface: float, numbers: msr.Measures) -> dict[str, float]:
    """The columns in the units of the tube of liquid.

    Raises:
        RuntimeError: If the state has not one wrinkled zone.
    """
    if len(numbers.fronts) != FRONTS:
        raise RuntimeError(f"{len(numbers.fronts)} fronts at zw = {load:g}")
    fronts = {f"Z_front_{k}": float(z) for k, z in enumerate(numbers.fronts, 1)}
    return {
        "V": 2 * np.pi * filled,
        "zw": load,
        "r_max": numbers.scalars["r_max"],
        "T1_ring": numbers.scalars["N"] / 2,  # over mu = 2 C1
        "Z_front": surface,
    } | fronts


def branch(name: str) -> Table:
    """One branch over the volume of the liquid."""
    asked, table = ASKED[name], f"relaxed_fluid_{name}"
    rows, volumes = followed(asked), asked.volumes

    def solved(rule: sta.Rule) -> list[State]:
        moved = (sta.moved_to(state, rule) for state in rows)
        return [sta.polished(state, "V", v) for state, v in zip(moved, volumes, strict=True)]

    def shot(state: State, volume: float, steps: int) -> sho.Solution:
        return sho.solve(asked.membrane, smsr.starts_of(state, steps), state.load, "V", volume, steps)

    levels = [solved(rule) for rule in lim.RULES]
    shots = [[shot(s, v, 2 * n) for s, v in zip(levels[-1], volumes, strict=True)] for n in STEPS]
    a = [[by_collocation(s) for s in level] for level in levels]
    b = [[by_shooting(s) for s in level] for level in shots]
    slopes = np.array([msr.measures(s).slopes for s in levels[-1]])
    full = name == "full"

    def column(key: str) -> Column:
        of_a, of_b = ([np.array([row[key] for row in level]) for level in both] for both in (a, b))
        floor: Array | float = 0.0
        if key[-2:] in ("_1", "_2"):  # rounding is amplified where gw is flat
            floor = cas.ROUNDING / slopes[:, int(key[-1]) - 1]
        return cas.agreed(table, key, Pair(*of_a, floor), Pair(*of_b, floor), COLUMNS[key])

    given = {key: getattr(asked, key) for key in ("L", "delta", "gamma", "alpha")}
    title = "Primary branch of a tube of liquid that bears no compression, beyond its first wrinkle"
    shown = [column(key) for key in COLUMNS if not (full and key == "Z_front")]
    return SERIES.table(table, title, "", given, shown)


TABLES: dict[str, Builder] = {f"relaxed_fluid_{name}": partial(branch, name) for name in ASKED}
