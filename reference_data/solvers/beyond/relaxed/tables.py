"""Tables of the tube with the relaxed energy, free and in contact, beyond its first wrinkle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from reference_data.solvers.beyond.relaxed import shooting, strong
from reference_data.solvers.beyond.relaxed.shooting import NONE, Spring
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube, slope
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule
from reference_data.solvers.paper2.substrate import Substrate


class Asked(NamedTuple):
    """One branch."""

    tube: Tube
    begin: float
    """Displacement, or pressure in contact, not far beyond the first wrinkle, where the zones are found."""
    places: tuple[float, ...]
    """Displacements, or pressures, of the rows."""
    fronts: int
    spring: Spring = NONE
    early: bool = False
    """Whether it wrinkles before it touches; ``begin`` is then a displacement of the free tube."""
    over: str = ""
    """What is given, if not the displacement of a free tube, or the pressure in contact."""

    @property
    def touches(self) -> bool:
        """Whether there is a substrate."""
        return self.spring.k > 0

    @property
    def key(self) -> str:
        """What is given."""
        return self.over or ("p" if self.touches else "u_max")


ASKED = {
    "inside": Asked(Tube(0.0, 1.0, 6.0), 1.6, (1.54, 1.6, 1.8, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0, 3.2, 3.3), 2),
    "stiffer": Asked(Tube(0.02, 1.0, 6.0), 1.8, (1.74, 1.8, 1.9, 2.0, 2.1, 2.2, 2.3, 2.4, 2.5), 2),
    "disk": Asked(Tube(0.0, 1.2, 8.0), 1.5, (1.2, 1.5, 1.8, 2.1, 2.5, 3.0, 3.5, 4.0), 1),
}
"""A neo-Hookean tube of figure 2(a) of paper 2, one that stiffens, and one that wrinkles at the disks."""

IN_CONTACT = {
    "contact": Asked(
        Tube(0.02, 1.0, 6.0), 5.6, (5.35, 5.4, 5.5, 5.6, 5.8, 6.0, 6.2, 6.4), 3, Spring(20.0, 1.8)
    ),
    "contact_stretched": Asked(
        Tube(0.0, 1.2, 8.0), 5.8, (5.55, 5.6, 5.7, 5.8, 6.0, 6.3, 6.6, 7.0, 7.4), 3, Spring(20.0, 1.8)
    ),
}
"""Tubes that touch a substrate first, and then wrinkle; the edge of the patch counts among the fronts."""

SOFT, OVER = Spring(20.0, 3.0), "u_max"
EARLY = (
    Asked(Tube(0.0, 1.0, 6.0), 1.6, (1.54, 1.6, 1.7, 1.8, 1.9, 2.0), 2),
    Asked(Tube(0.0, 1.0, 6.0), 1.6, (2.002, 2.005, 2.01, 2.015, 2.02, 2.025, 2.03), 3, SOFT, True, OVER),
    Asked(Tube(0.0, 1.0, 6.0), 3.8, (2.15, 2.16, 2.18, 2.2, 2.22, 2.25), 3, SOFT, over=OVER),
)
"""A tube that wrinkles, touches, becomes taut in contact and wrinkles again, with its wrinkled parts."""

SHORT, NEARER = Tube(0.037, 1.09, 8.7), Spring(20.0, 2.84)
LEAVING = (
    Asked(SHORT, 1.5, (1.845, 1.85, 1.855, 1.86, 1.864), 2, NEARER, True, OVER),
    Asked(SHORT, 1.7, (1.866, 1.868, 1.87, 1.873, 1.876, 1.878), 3, NEARER, over=OVER),
)
"""A tube that touches with a zone at either disk, which leaves it in contact."""

TOGETHER = {"early": EARLY, "leaving": LEAVING}
"""Tables of several parts."""

STEP = 0.05
"""Largest step of the displacement, or of the pressure in contact, between two guesses."""
ROUNDING = 3e-12, 1e-10
"""Relative rounding of columns by (a) and by (b), whose disk is missed by the errors of the integration."""

COLUMNS = {
    "u_max": ("(R_mid - R_f)/R_f", "radial displacement of the mid-plane"),
    "p": ("P R_f/(C1 h_o)", "pressure"),
    "V": ("2 pi R_f^3", "volume of the half tube"),
    "Z_front": ("delta1 z/R_f", "edge of the patch in contact"),
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

CONTACT = replace(
    SERIES,
    method="Two codes with the relaxed energy, which share the data of the tube: (a) collocation of the "
    "strong equations in four zones, with the edge of the patch, where rho = s, and the ends of the wrinkled "
    "zone, where l1 l2^2 = 1, as unknowns; (b) Hamilton's equations by an explicit method from the mid-plane "
    "to the disk, which lets go of the substrate where rho = s, and switches between both states where it "
    "meets a front. " + rule("a"),
)


def followed(asked: Asked) -> list[strong.State]:
    """The states of the rows on the coarse mesh."""
    tube, mesh, at, found = asked.tube, strong.MESHES[0], asked.begin, {}
    if asked.touches:
        substrate = Substrate(*asked.spring)
        if asked.early:
            begin = strong.touched(strong.first(tube, mesh, at), substrate)
        else:
            begin = strong.first_in_contact(tube, substrate, mesh, at)
    else:
        begin = strong.first(tube, mesh, at)
    first = getattr(begin, asked.key) if asked.over else at
    for side in (-1, 1):
        state, last = begin, first
        for place in sorted(asked.places, key=lambda u: side * u):
            if side * (place - first) < 0:
                continue
            for u in np.linspace(last, place, 2 + int(abs(place - last) / STEP))[1:]:
                state = strong.solve(state, float(u), asked.key)
            found[place], last = state, place
    return [found[place] for place in asked.places]


def shot(fine: list[strong.State], asked: Asked, rtol: float) -> list[shooting.Shot]:
    """The same states by shooting, from those of the other method."""
    tube, found = asked.tube, []
    for state in fine:
        rho, _, l1, _, _ = state.y[0][0, 0]
        tension = tube.r0 * slope(l1, rho / tube.r0, tube.alpha)
        found.append(
            shooting.solve(tube, state.u_max, float(tension), state.p, rtol, asked.spring, asked.key)
        )
    return found


def branch(name: str) -> Table:
    """One branch over the displacement of the mid-plane, or over the pressure in contact."""
    parts = TOGETHER.get(name) or ((ASKED | IN_CONTACT)[name],)
    table = f"relaxed_tube_{name}"
    states: list[list[strong.State]] = [[], []]
    shots: list[list[shooting.Shot]] = [[], []]
    for asked in parts:
        coarse = followed(asked)
        states[0] += coarse
        states[1] += (fine := [strong.again(state, strong.MESHES[1], asked.key) for state in coarse])
        for level, rtol in zip(shots, shooting.TOLERANCES, strict=True):
            level.extend(shot(fine, asked, rtol))
            if any(len(s.fronts) != asked.fronts for s in level[-len(fine) :]):
                raise RuntimeError(f"{table}: shooting meets other fronts than {asked.fronts}")

    def column(name: str, a: list[Array], b: list[Array]) -> Column:
        own, other = (Levels(*of, rounding=r) for of, r in zip((a, b), ROUNDING, strict=True))
        return agreed(table, name, other, own, COLUMNS[name], "shooting", "collocation")

    asked, found = parts[-1], {"u_max": "u_max", "p": "p", "V": "volume"}
    columns = [
        column(key, *([np.array([getattr(s, k) for s in level]) for level in of] for of in (states, shots)))
        for key, k in found.items()
        if key != asked.key
    ]
    names = ["Z_front"] * asked.touches + ["Z_front_1", "Z_front_2"]
    rows = [part for part in parts for _ in part.places]
    for k, front in enumerate(names[: asked.fronts]):
        both = [
            [
                np.array([_ends(s.fronts, part, asked)[k] for s, part in zip(level, rows, strict=True)])
                for level in levels
            ]
            for levels in (states, shots)
        ]
        columns.append(column(front, *both))
    tube = asked.tube
    given = {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf}
    what, more = "Free inflation", {}
    if asked.touches:
        what, more = "Frictionless contact", {"k": asked.spring.k, "s": asked.spring.s}
    if len(parts) > 1:
        what = "Free inflation and frictionless contact"
    title = f"{what} of a tube that bears no compression, beyond its first wrinkle"
    series = CONTACT if asked.touches else SERIES
    places = [place for part in parts for place in part.places]
    keys = series.keys(**{asked.key: np.array(places)})
    return series.table(table, title, "", given | more, [*keys, *columns])


def _ends(fronts: Sequence[float], of: Asked, last: Asked) -> list[float]:
    """The fronts of a row as those of the last part: without contact there is no patch."""
    no_patch = [0.0] if last.touches and not of.touches else []
    at_disk = [of.tube.lf / 2] if of.fronts == of.touches + 1 else []
    return [*no_patch, *fronts, *at_disk]


TABLES = {f"relaxed_tube_{name}": partial(branch, name) for name in (*ASKED, *IN_CONTACT, *TOGETHER)}
