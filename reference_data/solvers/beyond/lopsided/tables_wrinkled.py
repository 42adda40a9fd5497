"""Tables of lopsided states of a tube that bears no compression, beyond their first wrinkle."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from reference_data.solvers.beyond.lopsided import shooting, strong, tables, wrinkled
from reference_data.solvers.beyond.relaxed.tables import ROUNDING
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule


class Asked(NamedTuple):
    """One branch: volumes of ordinary states on the way to its first one, and those of the rows."""

    before: tuple[float, ...]
    volumes: tuple[float, ...]


ASKED = {
    "neo_hookean": Asked((12.5,), (12.25, 12.5, 13.0, 14.0, 15.0, 16.5, 18.0, 19.5, 21.0, 22.0)),
    "alpha_0_05": Asked(
        (15.8, 16.5, 17.5, 18.5), (17.5, 18.0, 19.0, 20.0, 21.5, 23.0, 24.5, 26.0, 27.5, 29.0, 30.0)
    ),
}
"""The tube of figure 2(a) of paper 2 on which a bulge moves first, and one whose wrinkles vanish again."""

COLUMNS = {
    **{name: tables.COLUMNS[name] for name in ("V", "p", "u_max", "w_mid")},
    "wrinkled_fraction": ("1", "part of the length that is wrinkled"),
    "Z_front_1": ("delta1 z/R_f", "end of the wrinkled zone that is nearer to the middle"),
    "Z_front_2": ("delta1 z/R_f", "its other end"),
}
METHOD = (
    "Two codes on the whole tube with the relaxed energy and without a condition of symmetry, which share "
    "the data of the tube: (a) collocation of the strong equations in zones that meet at the middle and at "
    "the fronts, which are unknown, where l1 l2^2 = 1; (b) Hamilton's equations by an explicit method from "
    "the middle to both disks, which switches between both states where it meets a front, from the states of "
    "(a) as guesses. " + rule("a")
)
GRID = (
    f"(a) {wrinkled.MESHES[0].elements} and {wrinkled.MESHES[1].elements} elements of degree "
    f"{wrinkled.MESHES[0].degree} and {wrinkled.MESHES[1].degree} in each of four zones; (b) relative "
    f"tolerances {shooting.TOLERANCES[0]:g} and {shooting.TOLERANCES[1]:g}"
)
SERIES = Series("beyond", tables.SOURCE, COLUMNS, METHOD, GRID, tables.TOLERANCE)


def followed(name: str) -> list[wrinkled.State]:
    """The states of the rows on the coarse mesh.

    Raises:
        RuntimeError: If a taut zone of one is compressed, or a wrinkled one is not.
    """
    asked = ASKED[name]
    ordinary = strong.follow(tables.first(name), np.array(asked.before), "V")[-1]
    begin = wrinkled.first(ordinary, wrinkled.MESHES[0])
    start = wrinkled.follow(begin, np.array(asked.volumes[:1]))[0]
    found = wrinkled.follow(start, np.array(asked.volumes))
    for state in found:
        least, most = state.excess()
        if least < -tables.FLOOR or most > tables.FLOOR:
            raise RuntimeError(f"{state.tube} at V = {state.volume}: other zones than one on one side")
    return found


def branch(name: str) -> Table:
    """One branch over the volume."""
    asked, table = ASKED[name], f"lopsided_wrinkled_{name}"
    coarse = followed(name)
    fine = [wrinkled.again(state, wrinkled.MESHES[1]) for state in coarse]
    shots = [[shooting.near(state, rtol) for state in fine] for rtol in shooting.TOLERANCES]
    if any(len(shot.fronts) != 2 for level in shots for shot in level):
        raise RuntimeError(f"{table}: shooting meets other fronts than one pair")

    def column(key: str, attribute: str, which: int | None = None) -> Column:
        a, b = (
            Levels(
                *(np.array([np.ravel(getattr(s, attribute))[which or 0] for s in level]) for level in levels),
                rounding=rounding,
            )
            for levels, rounding in zip(((coarse, fine), shots), ROUNDING, strict=True)
        )
        return agreed(table, key, b, a, COLUMNS[key], "shooting", "collocation")

    plain = {"p": "p", "u_max": "u_max", "w_mid": "w_mid", "wrinkled_fraction": "fraction"}
    columns = [column(key, attribute) for key, attribute in plain.items()]
    columns += [column(f"Z_front_{k + 1}", "fronts", k) for k in range(2)]
    title = "Lopsided states of a tube that bears no compression, beyond their first wrinkle"
    rows = [*SERIES.keys(V=np.array(asked.volumes)), *columns]
    return SERIES.table(table, title, "", tables.parameters(name), rows)


TABLES = {f"lopsided_wrinkled_{name}": partial(branch, name) for name in ASKED}
