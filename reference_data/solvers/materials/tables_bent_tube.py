"""Tables of the bent branch of the fluid-loaded tube with other laws, by the codes of paper 3."""

from __future__ import annotations

from functools import partial

from reference_data.solvers.core.tables import Table
from reference_data.solvers.materials import tables_liquid_tube as primary
from reference_data.solvers.paper3 import tables_secondary as paper3
from reference_data.solvers.paper3 import text
from reference_data.solvers.paper3.bent import branch
from reference_data.solvers.paper3.bent.both_methods import chosen
from reference_data.solvers.registry import Builder

LEVELS = {"ogden": (5.1, 5.2, 5.26), "gent": (7.4, 7.44, 7.47)}
"""Levels of the tables, below that of the bifurcation."""


def curve(name: str, model: str) -> Table:
    """The bent branch over the level."""
    tube, levels = primary.tube(model), LEVELS[model]
    stop = primary.RANGES[model][1]
    solved = partial(paper3.on_levels, stop=stop, lowest=levels[0])
    columns, extra = paper3.curve_columns(name, tube, levels, solved)
    about = paper3.series(branch.GRIDS[:3], chosen(tube))
    more = {"paper": "materials", "notes": text.SECONDARY_NOTES, "extra": extra}
    title = f"Secondary branch of a fluid-loaded tube of {model}; mu = 2 S"
    return about.table(name, title, primary.SOURCE, primary.facts(model), columns, **more)


TABLES: dict[str, Builder] = {
    f"fluid_tube_secondary_{_m}": partial(curve, f"fluid_tube_secondary_{_m}", _m) for _m in LEVELS
}
