"""Tables of a tube under gas that is thinner on one side: limit pressures, and the law that they tend to."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from reference_data.solvers.beyond.bowed.collocation import Collocation
from reference_data.solvers.beyond.bowed.galerkin import Galerkin
from reference_data.solvers.beyond.bowed.limits import Law, State, law, limits, straight
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule
from reference_data.solvers.registry import Builder

LENGTH = 10.0
BETWEEN = 1.6, 1.67
"""Radii of the even tube in the middle between which it begins to bow."""
UNEVEN = 1e-3, 3e-3, 1e-2, 3e-2
GRIDS = {Galerkin: ((24, 5), (32, 6)), Collocation: ((36, 5), (48, 6))}
"""Degree along half the tube and largest wave number, coarse and fine, of each method."""
ROUNDING = 1e-9
"""Newton's last step; the place of a limit, which is a root of a slope, in the volume."""

COLUMNS = {
    "uneven": ("1", "e of the thickness 1 + e cos(Theta) over its mean"),
    "p": ("P R/(C1 h)", "pressure"),
    "V": ("1/R^3", "volume of a quarter of the tube beyond that at rest"),
    "p_s": ("P R/(C1 h)", "(p - p_c)/e^(2/3) of the limit pressure as e vanishes, from the even tube alone"),
}
METHOD = (
    "Two codes for the surface in space, with one polynomial along half the tube and trigonometric "
    "polynomials around: (a) collocation of the balance of forces; (b) the principle of virtual work. They "
    "share the path along the branch and no equation. " + rule("b")
)
GRID = "; ".join(
    f"({name}) degrees {pair[0][0]} and {pair[1][0]}, waves up to {pair[0][1]} and {pair[1][1]}"
    for name, pair in (("a", GRIDS[Collocation]), ("b", GRIDS[Galerkin]))
)
SOURCE = "beyond Patil, Nordmark & Eriksson (2014); Koiter (1945)"
SERIES = Series(
    "beyond", SOURCE, COLUMNS, METHOD, GRID, "Newton takes two more steps after the first one below 1e-7"
)
GIVEN = {"mesh": "tube", "lf": LENGTH, "alpha": 0.0, "delta": 1.0}


@cache
def laws() -> dict[type, list[Law]]:
    """The even tube on all grids."""
    return {
        kind: [law(straight(kind(LENGTH, *sizes), BETWEEN[0]), *BETWEEN) for sizes in pair]
        for kind, pair in GRIDS.items()
    }


@cache
def uneven() -> dict[type, list[list[State]]]:
    """The limits of uneven tubes on all grids."""
    return {kind: [limits(one, UNEVEN) for one in pair] for kind, pair in laws().items()}


def read(table: str, name: str, of: Callable[[type, int], list[float]]) -> Column:
    """A column by both methods, from the numbers of a method on its coarse and its fine grid."""
    levels = [Levels(of(kind, 0), of(kind, 1), rounding=ROUNDING) for kind in (Collocation, Galerkin)]
    return agreed(table, name, *levels, COLUMNS[name], other="collocation", written="virtual work")


def largest(name: str = "bowed_limits") -> Table:
    """Limit pressures."""
    columns = [
        read(name, "p", lambda kind, k: [s.p for s in uneven()[kind][k]]),
        read(name, "V", lambda kind, k: [s.volume for s in uneven()[kind][k]]),
    ]
    title = "Limit pressure of a tube that is thinner on one side"
    keys = SERIES.keys(uneven=np.array(UNEVEN))
    return SERIES.table(name, title, "", GIVEN, keys + columns, extra={"keys": ["uneven"]})


def begins(name: str = "bowed_law") -> Table:
    """Where the even tube begins to bow, and the constant of the law."""
    columns = [
        read(name, "p", lambda kind, k: [laws()[kind][k].start.p]),
        read(name, "V", lambda kind, k: [laws()[kind][k].start.volume]),
        read(name, "p_s", lambda kind, k: [laws()[kind][k].constant]),
    ]
    return SERIES.table(name, "Where a tube begins to bow, and Koiter's law there", "", GIVEN, columns)


TABLES: dict[str, Builder] = {"bowed_limits": largest, "bowed_law": begins}
