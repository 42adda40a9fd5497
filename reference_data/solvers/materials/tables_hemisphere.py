"""Tables of the wrinkled hemisphere with laws other than neo-Hookean, by the codes of papers 4 and 5."""

from __future__ import annotations

from functools import cache, partial

from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.tables import Column, Table
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import tables_hemisphere as paper5
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.hemisphere.body import KAPPA, Hemisphere
from reference_data.solvers.registry import Builder

WEIGHTS = {"ogden": 2.3, "gent": KAPPA}
"""Weight of the liquid; half of the paper's for Ogden's rubber, whose shear modulus is half as large."""
WRINKLED = (-1.0, -0.9, -0.8, -0.7, -0.6)
"""Levels at which the hemisphere has one wrinkled zone."""
LEVELS = (*WRINKLED, -0.55)
CHANGES = ((20, (-1.04, -1.03)), (30, (-0.93, -0.9)))
"""Wave numbers, and ranges of levels above which the sheet is stable against them."""


@cache
def body(model: str) -> Hemisphere:
    """The hemisphere of a law with the tables' constants."""
    return Hemisphere(law(model), WEIGHTS[model])


def made(name: str, title: str, model: str, columns: list[Column], **more: object) -> Table:
    """A table with the documentation common to all of them."""
    facts = {"model": model, **CONSTANTS[model], "Ao": 0.1, "gamma": WEIGHTS[model]}
    given = name, f"{title} of {model}", "the problem with another law", facts, columns
    return text.SERIES.table(*given, paper="materials", grid=text.HEMISPHERE_GRID, **more)


def branch(name: str, model: str) -> Table:
    """States over the level."""
    found = [rel.hemisphere(zw, body(model)) for zw in LEVELS]
    return made(name, "The hemisphere", model, paper5.branch_columns(name, found))


def fronts(name: str, model: str) -> Table:
    """Fronts of the wrinkled zone over the level."""
    found = [rel.hemisphere(zw, body(model)) for zw in WRINKLED]
    columns = paper5.front_columns(name, found)
    return made(name, "Wrinkled zone of the hemisphere", model, columns, notes=paper5.FRONT_NOTES)


def changes(name: str, model: str) -> Table:
    """Levels at which waves around the axis vanish."""
    found = [
        rel.crossing(lambda x: rel.hemisphere(x, body(model)).spectrum, n, *bracket) for n, bracket in CHANGES
    ]
    columns = rel.turning(name, found, "zw")
    extra = {"keys": ["n", "direction"]}
    return made(name, "Where waves around the axis vanish, hemisphere", model, columns, extra=extra)


TABLES: dict[str, Builder] = {}
for _m in WEIGHTS:
    TABLES[f"hemisphere_{_m}"] = partial(branch, f"hemisphere_{_m}", _m)
    TABLES[f"hemisphere_fronts_{_m}"] = partial(fronts, f"hemisphere_fronts_{_m}", _m)
    TABLES[f"hemisphere_changes_{_m}"] = partial(changes, f"hemisphere_changes_{_m}", _m)
