"""Table of bent states of a tube of liquid that wrinkles beside the lower ring, with the relaxed energy."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from reference_data.solvers.beyond.bent_liquid.tension import ByForces, ByStretches
from reference_data.solvers.core.tables import Column, Series, Table, agreed, rule
from reference_data.solvers.core.two_estimates import on_two_grids
from reference_data.solvers.paper3 import tables_secondary as ordinary
from reference_data.solvers.paper3 import text
from reference_data.solvers.paper3.bent import branch, states
from reference_data.solvers.paper3.bent.equations import Surface
from reference_data.solvers.paper3.bent.newton import newton, raised
from reference_data.solvers.paper3.common import Rows, given
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.strong import equations as strong
from reference_data.solvers.paper3.strong import states as balance
from reference_data.solvers.paper3.strong.net import Net

TUBE, STOP = FluidTube(12.0, 1.4, 0.03), 230.0
"""The tube, which the liquid fills, and a volume beyond its bifurcation."""
TAUT = 19.0
"""Level of a taut state on the way, at which the energy is exchanged."""
LEVELS, STEP = (18.0, 17.7, 17.4, 17.1), 0.2
"""Levels of the rows, and largest step between two of them."""
GRIDS = 2, 3
"""Grids of (a) among those of the ordinary tube's bent states."""
NETS = (12, 0, 13, 29), (14, 0, 13, 35)
"""Elements, degree and highest wave number of the nets of (b)."""
COLUMNS = "V", "r_mid", "Pi", "x_quarter_pi", "z_quarter_pi"
FLOOR = 1e-10
"""Relative rounding of columns."""

METHOD = (
    "The two codes of the ordinary tube's bent states, each with a sheet that bears no compression; they "
    "share the data of the tube and no equation: (a) Galerkin's method by trigonometric polynomials around "
    "the axis times spectral elements along it, with a law of principal stretches that is uniaxial tension "
    "where the smaller one is below the natural width; (b) collocation of the balance of forces, from the "
    "states of (a) as guesses; where the force across the larger stretch would push, Mooney's force along "
    "that fibre. Neither follows the fronts, at which stresses have kinks: u_a and u_b are three times the "
    "largest difference of two resolutions. " + rule("a")
)
_SIZES = (
    "; ".join(f"{wet} elements of degree {degree}, wave numbers to {most}" for wet, _, degree, most in each)
    for each in ([branch.GRIDS[level] for level in GRIDS], NETS)
)
SERIES = Series(
    "beyond",
    "beyond Patil, Nordmark & Eriksson, Proc. R. Soc. A 471 (2015) 20150016, with the relaxed energy",
    text.COLUMNS,
    METHOD,
    "(a) {}; (b) {}".format(*_SIZES),
    text.SECONDARY_TOLERANCE,
)


def followed() -> list[Surface]:
    """Wrinkled states at falling levels, by (a) on its coarsest grid."""
    line = branch.Secondary(ordinary.start(TUBE, STOP)[1], 0)
    line.leave(ordinary.OFFSETS)
    line.to_level(TAUT, ordinary.STEP)
    at = line.at_level(TAUT)
    at = newton(replace(at, tube=replace(TUBE, law=ByStretches())))
    found = []
    for level in LEVELS:
        for between in np.linspace(at.zw, level, 1 + int(np.ceil((at.zw - level) / STEP)))[1:]:
            at = newton(replace(at, zw=float(between)))
        found.append(at)
    return found


def on_grids(coarse: Surface) -> list[dict[str, float]]:
    """One state by (a) on both grids, then by (b) on both nets."""
    found, rows = coarse, []
    for level in GRIDS:
        found = raised(found, branch.grid(found.partial, level))
        rows.append(states.quantities(found))
    other = replace(coarse, tube=replace(TUBE, law=ByForces()))
    for size in NETS:
        other = strong.newton(strong.taken(other, Net(*size)))
        rows.append(balance.quantities(other))
    return rows


def table(name: str) -> Table:
    """Wrinkled states over the level."""
    by_level = [on_grids(state) for state in followed()]
    rows: list[Rows] = [list(part) for part in zip(*by_level, strict=True)]

    def column(key: str) -> Column:
        values = [np.array([row[key] for row in part]) for part in rows]
        a, b = (on_two_grids(*values[i : i + 2], FLOOR) for i in (0, 2))
        return agreed(name, key, b, a, text.COLUMNS[key], "balance of forces", "Galerkin")

    title = "Bent states of a tube full of liquid that are wrinkled at the lower ring, over the level"
    keys = SERIES.keys(zw=np.array(LEVELS))
    return SERIES.table(name, title, "", given(TUBE), [*keys, *map(column, COLUMNS)])


TABLES = {"bent_liquid_wrinkled": partial(table, "bent_liquid_wrinkled")}
