"""Tables of disks of even and uneven thickness under gas and a liquid: states, limit, largest volume."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.polynomial import Chebyshev

from reference_data.solvers.beyond.filled_disk.collocation import Collocation
from reference_data.solvers.beyond.filled_disk.shooting import Shooting
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule, steps
from reference_data.solvers.registry import Builder

Array = np.ndarray
Row = dict[str, float]

TOLERANCES, DEGREES = (1e-9, 1e-11), (28, 40)
"""Coarse and fine resolution of shooting and of collocation."""

ROUNDING = 1e-11
"""Rounding of both methods, relative to numbers above one."""

WAY = 0.05
"""Step of the height on the way to a state."""

WINDOW, NODES = 0.15, 13
"""An extremum is searched within this distance of a height, by a polynomial through so many states."""

DELTA = 1.1

SERIES = Series(
    paper="beyond",
    source="Patil (2016), section 6.4, future work",
    columns={
        "order": ("1", "number of the point along the branch"),
        "w_c": ("1/a", "height of the centre, down for a liquid; a is the radius of the stress-free disk"),
        "p": ("P a/(C1 h)", "pressure of the gas from below"),
        "zw": ("1/a", "level of the liquid on top, above the rim"),
        "V": ("1/a^3", "volume between the disk and the plane of the rim"),
        "V_f": ("1/a^3", "liquid over the disk between vertical walls"),
        "U": ("1/(C1 h a^2)", "strain energy"),
    },
    method="Two codes that share only the derivatives of the law: (a) shooting from the pole to the rim, "
    "with slope and meridional stretch as unknowns; (b) collocation of the balance of forces in space, with "
    "Chebyshev polynomials of the radius squared. " + rule("collocation"),
    grid=f"(a) tolerances {TOLERANCES[0]} and {TOLERANCES[1]}; (b) degrees {DEGREES[0]} and {DEGREES[1]}",
    tolerance="steps of Newton's method and of Broyden's method down to rounding",
)


@dataclass(frozen=True)
class Filled:
    """One disk of the tables.

    Attributes:
        alpha: C2/C1.
        gamma: Weight of the liquid; 0 for gas.
        uneven: The thickness is ``1 + uneven R^2``.
    """

    alpha: float
    gamma: float = 0.0
    uneven: float = 0.0

    @property
    def names(self) -> tuple[str, str]:
        """Load and amount in the tables."""
        return ("zw", "V_f") if self.gamma else ("p", "V")

    @property
    def facts(self) -> dict[str, object]:
        """Parameters of the problem."""
        liquid = {"load": "liquid", "gamma": self.gamma} if self.gamma else {"load": "gas"}
        own = {"thickness": f"1 + {self.uneven:g}*(X**2 + Y**2)"} if self.uneven else {}
        return {"mesh": "disk", **liquid, "alpha": self.alpha, "delta": DELTA, **own}

    def rows(self, heights: Array) -> tuple[list[list[Row]], list[list[Row]]]:
        """States by both methods, each at both resolutions."""
        given = self.alpha, DELTA, self.gamma, self.uneven
        a, b = (
            [make(*given, size) for size in sizes]
            for make, sizes in ((Shooting, TOLERANCES), (Collocation, DEGREES))
        )
        shot = [_followed(code, np.array([DELTA, 0.1]), heights) for code in a]
        return shot, [_followed(code, code.start(WAY, 0.1), heights) for code in b]


def _followed(code: Shooting | Collocation, guess: Array, heights: Array) -> list[Row]:
    """States at heights, with others on the way."""
    way = np.union1d(np.arange(WAY, heights[0] - WAY / 2, WAY), heights)
    found = []
    for height in way:
        row, guess = code.state(float(height), guess)
        found.append(row | {"w_c": float(height)})
    return found[-len(heights) :]


def _columns(
    table: str, of: Filled, pairs: tuple[list[list[Row]], list[list[Row]]], names: tuple[str, ...]
) -> list[Column]:
    own = dict(zip(("load", "amount"), of.names, strict=True))

    def levels(pair: list[list[Row]], name: str) -> Levels:
        coarse, fine = ([row[name] for row in rows] for rows in pair)
        return Levels(coarse, fine, rounding=ROUNDING)

    return [
        agreed(
            *(table, own.get(n, n)),
            *(levels(pair, n) for pair in pairs),
            SERIES.columns[own.get(n, n)],
            "shooting",
            "collocation",
        )
        for n in names
    ]


def curve(name: str, title: str, of: Filled, heights: Array) -> Table:
    """States over the height of the centre."""
    columns = SERIES.keys(w_c=heights) + _columns(name, of, of.rows(heights), ("load", "amount", "U"))
    return SERIES.table(name, title, "", of.facts, columns)


def extremum(name: str, title: str, of: Filled, near: float, largest: str) -> Table:
    """The point near a height where the load or the amount is largest."""
    heights = near + WINDOW * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)[::-1]

    def top(rows: list[Row]) -> list[Row]:
        fits = {
            n: Chebyshev.fit(heights, [row[n] for row in rows], NODES - 1) for n in ("load", "amount", "U")
        }
        roots = [r.real for r in fits[largest].deriv().roots() if abs(r.imag) < 1e-12]
        place = min(roots, key=lambda r: abs(r - near))
        return [{n: float(fit(place)) for n, fit in fits.items()} | {"w_c": place}]

    a, b = ([top(rows) for rows in pair] for pair in of.rows(heights))
    columns = SERIES.keys(order=np.ones(1))
    columns += _columns(name, of, (a, b), ("load", "w_c", "amount", "U"))
    return SERIES.table(name, title, "", of.facts, columns)


LIGHT, MIDDLE = Filled(0.1, gamma=1.0), Filled(0.0, gamma=3.0)
UNEVEN_GAS, UNEVEN_LIQUID = Filled(0.1, uneven=0.4), Filled(0.1, gamma=1.0, uneven=0.4)

TABLES: dict[str, Builder] = {
    name: partial(make, name, *given)
    for name, make, *given in (
        ("disk_liquid", curve, "Disk under a light liquid", LIGHT, steps(0.1, 1.2, 0.1)),
        ("disk_liquid_limit", extremum, "Neo-Hookean disk: limit level", MIDDLE, 0.9, "load"),
        (
            "disk_liquid_fold",
            extremum,
            "Neo-Hookean disk: largest volume",
            MIDDLE,
            1.5,
            "amount",
        ),
        ("disk_uneven_gas", curve, "Disk thicker at the rim, under gas", UNEVEN_GAS, steps(0.1, 1.2, 0.1)),
        (
            *("disk_uneven_liquid", curve, "Disk thicker at the rim, under a light liquid"),
            *(UNEVEN_LIQUID, steps(0.1, 1.2, 0.1)),
        ),
    )
}
