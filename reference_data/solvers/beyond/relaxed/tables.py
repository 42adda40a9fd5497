"""Tables of the free tube with the relaxed energy, beyond its first wrinkle."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from reference_data.solvers.beyond.relaxed import shooting, strong
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube, slope
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule


class Asked(NamedTuple):
    """One branch."""

    tube: Tube
    begin: float
    """Displacement, not far beyond the first wrinkle, at which the zones are found."""
    places: tuple[float, ...]
    """Displacements of the rows."""
    fronts: int


ASKED = {
    "inside": Asked(Tube(0.0, 1.0, 6.0), 1.6, (1.54, 1.6, 1.8, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0, 3.2, 3.3), 2),
    "stiffer": Asked(Tube(0.02, 1.0, 6.0), 1.8, (1.74, 1.8, 1.9, 2.0, 2.1, 2.2, 2.3, 2.4, 2.5), 2),
    "disk": Asked(Tube(0.0, 1.2, 8.0), 1.5, (1.2, 1.5, 1.8, 2.1, 2.5, 3.0, 3.5, 4.0), 1),
}
"""A neo-Hookean tube of figure 2(a) of paper 2, one that stiffens, and one that wrinkles at the disks."""

STEP = 0.05
"""Largest step of the displacement between two guesses."""
ROUNDING = 3e-12, 1e-10
"""Relative rounding of columns by (a) and by (b), whose disk is missed by the errors of the integration."""

COLUMNS = {
    "u_max": ("(R_mid - R_f)/R_f", "radial displacement of the mid-plane"),
    "p": ("P R_f/(C1 h_o)", "pressure"),
    "V": ("2 pi R_f^3", "volume of the half tube"),
    "Z_front_1": ("delta1 z/R_f", "end of the wrinkled zone that is nearer to the mid-plane"),
    "Z_front_2": ("delta1 z/R_f", "its other end"),
}
METHOD = (
    "Two codes with the relaxed energy, which share the data of the tube: (a) collocation of the strong "
    "equations in three zones (two, if the wrinkles reach the disk) with the fronts as unknowns, where l1 "
    "l2^2 = 1; (b) Hamilton's equations by an explicit method from the mid-plane to the disk, which switches "
    "between both states where it meets a front. " + rule("a")
)
GRID = (
    f"(a) {strong.MESHES[0].elements} and {strong.MESHES[1].elements} elements of degree "
    f"{strong.MESHES[0].degree} and {strong.MESHES[1].degree} in every zone; (b) relative tolerances "
    f"{shooting.TOLERANCES[0]:g} and {shooting.TOLERANCES[1]:g}"
)
SOURCE = "beyond Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282, figure 2"
SERIES = Series("beyond", SOURCE, COLUMNS, METHOD, GRID, "Newton takes one more step below 1e-8")


def followed(asked: Asked) -> list[strong.State]:
    """The states of the rows on the coarse mesh."""
    begin, found = strong.first(asked.tube, strong.MESHES[0], asked.begin), {}
    for side in (-1, 1):
        state, last = begin, asked.begin
        for place in sorted(asked.places, key=lambda u: side * u):
            if side * (place - asked.begin) < 0:
                continue
            for u in np.linspace(last, place, 2 + int(abs(place - last) / STEP))[1:]:
                state = strong.solve(state, float(u))
            found[place], last = state, place
    return [found[place] for place in asked.places]


def shot(fine: list[strong.State], asked: Asked, rtol: float) -> list[shooting.Shot]:
    """The same states by shooting, from those of the other method."""
    tube, found = asked.tube, []
    for state, u_max in zip(fine, asked.places, strict=True):
        rho, _, l1, _, _ = state.y[0][0, 0]
        tension = tube.r0 * slope(l1, rho / tube.r0, tube.alpha)
        found.append(shooting.solve(tube, u_max, float(tension), state.p, rtol))
    return found


def branch(name: str) -> Table:
    """One branch over the displacement of the mid-plane."""
    asked, table = ASKED[name], f"relaxed_tube_{name}"
    coarse = followed(asked)
    fine = [strong.again(state, strong.MESHES[1]) for state in coarse]
    shots = [shot(fine, asked, rtol) for rtol in shooting.TOLERANCES]

    def column(name: str, a: list[Array], b: list[Array]) -> Column:
        own, other = (Levels(*of, rounding=r) for of, r in zip((a, b), ROUNDING, strict=True))
        return agreed(table, name, other, own, COLUMNS[name], "shooting", "collocation")

    columns = [
        column(
            key,
            *(
                [np.array([getattr(s, k) for s in level]) for level in levels]
                for levels in ((coarse, fine), shots)
            ),
        )
        for key, k in {"p": "p", "V": "volume"}.items()
    ]
    for k in range(asked.fronts):
        of_a = [np.array([s.front(k + 1) for s in level]) for level in (coarse, fine)]
        of_b = [np.array([s.fronts[k] for s in level]) for level in shots]
        columns.append(column(f"Z_front_{k + 1}", of_a, of_b))
    tube = asked.tube
    given = {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf}
    title = "Free inflation of a tube that bears no compression, beyond its first wrinkle"
    return SERIES.table(table, title, "", given, [*SERIES.keys(u_max=np.array(asked.places)), *columns])


TABLES = {f"relaxed_tube_{name}": partial(branch, name) for name in ASKED}
