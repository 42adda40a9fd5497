"""Tables of lopsided states of the free tube: branches, their curvatures, a limit point, a profile."""

from __future__ import annotations

from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.beyond.lopsided import energy, strong
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.curvatures import beginnings
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule


class Asked(NamedTuple):
    """One branch: its tube, the symmetric displacements around its crossing, and volumes."""

    tube: Tube
    between: tuple[float, float]
    u_end: float
    volumes: tuple[Any, ...]
    fitted: float
    """Largest w from which the curvatures are extrapolated."""


ASKED = {
    "neo_hookean": Asked(
        Tube(0.0, 1.0, 6.0), (1.25, 1.45), 2.1, (12.0, 12.5, 13.0, 14.0, 15.0, 16.5, 18.0, 19.5), 0.08
    ),
    "alpha_0_05": Asked(
        Tube(0.05, 1.0, 6.0), (1.5, 1.7), 2.2, (15.8, 16.5, 17.5, 19.0, 21.0, 23.0, 25.0), 0.08
    ),
    "alpha_0_07": Asked(
        Tube(0.07, 1.0, 6.0), (1.8, 2.0), 3.0, (20.1, 20.5, *np.arange(21.0, 37.1, 1.0), 37.6, 38.0), 0.06
    ),
    "long": Asked(
        Tube(0.1, 1.0, 10.0), (1.25, 1.4), 4.0, (20.0, 21.0, 24.0, 30.0, 40.0, 55.0, 75.0, 90.0, 105.0), 0.08
    ),
}
LIMIT, BRACKET = "long", (85.0, 100.0)
"""The branch with a limit point of the pressure, and volumes around it."""
PROFILE, VOLUME = "neo_hookean", 16.5
"""The branch and the volume of the profile."""
FIRST = 0.02
"""Amplitude of the first lopsided state."""
NODES = 7
"""Number of amplitudes, and of coefficients in w^2, of a fit."""
FLOOR = 3e-12
"""Relative rounding of columns."""

COLUMNS = {
    "alpha": ("1", "C2/C1"),
    "delta1": ("1", "axial pre-stretch"),
    "lf": ("L_f/R_f", "stretched length"),
    "u_end": ("(R_mid - R_f)/R_f", "displacement at which the symmetric branch of the case ends"),
    "V": ("2 pi R_f^3", "volume of the whole tube"),
    "p": ("P R_f/(C1 h_o)", "pressure"),
    "u_max": ("(R_mid - R_f)/R_f", "radial displacement of the mid-plane"),
    "w_mid": ("w/R_f", "axial displacement of the mid-plane, positive"),
    "p_2": ("as p", "curvature of p over w_mid at the crossing: p = p_c + p_2 w_mid^2 + ..."),
    "V_2": ("as V", "the same of the volume"),
    "Z": ("delta1 z/R_f", "place on the pre-stretched tube from the mid-plane"),
    "rho": ("R/R_f", "radius"),
    "eta": ("Z/R_f", "axial position"),
}
METHOD = (
    "Two codes on the whole tube without a condition of symmetry, which share the data of the tube and no "
    "equation: (a) collocation of the strong equations of paper 2 in two halves that meet at the middle; (b) "
    "the energy of a surface in space by polynomials of high degree, with second derivatives by complex "
    "steps of its gradient, from the states of (a) as guesses. Curvatures are fits of polynomials in w_mid^2 "
    "to states of small amplitude. " + rule("a")
)
GRID = (
    f"(a) {strong.MESHES[0].elements} and {strong.MESHES[1].elements} elements of degree "
    f"{strong.MESHES[0].degree} and {strong.MESHES[1].degree} on either half; (b) {energy.BASES[0].elements} "
    f"and {energy.BASES[1].elements} of degree {energy.BASES[0].degree} and {energy.BASES[1].degree}; graded "
    "to both disks"
)
SOURCE = "beyond Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282"
TOLERANCE = "Newton takes one more step after the first one below 1e-7"
SERIES = Series("beyond", SOURCE, COLUMNS, METHOD, GRID, TOLERANCE)


class Both(NamedTuple):
    """The same states by both methods, each coarse and fine."""

    by_equations: list[list[strong.State]]
    by_energy: list[list[energy.State]]


@cache
def first(name: str) -> strong.State:
    """The first lopsided state of a branch."""
    asked = ASKED[name]
    return strong.beside(asked.tube, strong.MESHES[0], asked.between, FIRST)


def states(name: str, values: Array, held: str) -> Both:
    """States of a branch at volumes or amplitudes."""
    tube = ASKED[name].tube
    coarse = strong.follow(first(name), values, held)
    fine = [strong.again(s, strong.MESHES[1], held, v) for s, v in zip(coarse, values, strict=True)]
    others = [
        [energy.at(tube, basis, s, held, float(v)) for s, v in zip(fine, values, strict=True)]
        for basis in energy.BASES
    ]
    return Both([coarse, fine], others)


def column(table: str, name: str, by_energy: list[Array], by_equations: list[Array], floor: float) -> Column:
    """One column from values of both methods, coarse and fine."""
    b, a = (
        Levels(*(np.atleast_1d(x) for x in values), floor=floor, rounding=FLOOR)
        for values in (by_energy, by_equations)
    )
    return agreed(table, name, b, a, COLUMNS[name], "energy in space", "strong equations")


def read(table: str, both: Both, names: tuple[str, ...]) -> list[Column]:
    """Columns that are attributes of the states."""
    attribute = {"V": "volume"}
    return [
        column(
            table,
            name,
            *(
                [np.array([getattr(s, attribute.get(name, name)) for s in level]) for level in levels]
                for levels in (both.by_energy, both.by_equations)
            ),
            floor=0.0,
        )
        for name in names
    ]


def branch(name: str) -> Table:
    """One branch over the volume."""
    asked, table = ASKED[name], f"lopsided_{name}"
    volumes = np.array(asked.volumes)
    found = read(table, states(name, volumes, "V"), ("p", "u_max", "w_mid"))
    title = "Lopsided states of the inflated tube over their volume"
    rows = [*SERIES.keys(V=volumes), *found]
    return SERIES.table(table, title, "", parameters(name), rows)


def parameters(name: str) -> dict[str, object]:
    """The tube of a branch."""
    tube = ASKED[name].tube
    return {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf}


def keys(names: list[str]) -> list[Column]:
    """Columns that name the rows of a table of points."""
    tubes = {key: [getattr(ASKED[n].tube, key) for n in names] for key in ("alpha", "delta1", "lf")}
    return SERIES.keys(**tubes, u_end=[ASKED[n].u_end for n in names])


def crossings() -> Table:
    """Where the branches begin, with their curvatures."""
    table, names = "lopsided_crossings", list(ASKED)

    def amplitudes(name: str, w: Array) -> tuple[list[list[energy.State]], list[list[strong.State]]]:
        both = states(name, w, "w")
        return both.by_energy, both.by_equations

    found = beginnings({name: asked.fitted for name, asked in ASKED.items()}, amplitudes, NODES)
    columns = [column(table, key, *values, floor=spread) for key, (values, spread) in found.items()]
    title = "Points of free inflation at which lopsided branches begin, and their curvatures there"
    notes = "V and V_2 are those of the whole tube."
    extra = {"keys": ["alpha", "delta1", "lf", "u_end"]}
    return SERIES.table(table, title, "", {}, [*keys(names), *columns], notes=notes, extra=extra)


def limits() -> Table:
    """The limit point of the pressure on one of the branches."""
    table, tube = "lopsided_limits", ASKED[LIMIT].tube
    before = np.array([v for v in ASKED[LIMIT].volumes if v < BRACKET[0]])
    coarse = strong.limit(strong.follow(first(LIMIT), before, "V")[-1], BRACKET)
    by_equations, by_energy = [], []
    for mesh in strong.MESHES:
        by_equations.append([strong.limit(strong.again(coarse, mesh, "V", coarse.volume), BRACKET)])
    for basis in energy.BASES:
        here = [energy.at(tube, basis, coarse, "V", coarse.volume)]

        def slope(volume: float, here: list[energy.State] = here) -> float:
            here[0] = energy.solve(here[0], "V", volume)
            return energy.rate(here[0])

        root = brentq(slope, coarse.volume - 0.5, coarse.volume + 0.5, xtol=1e-9)
        by_energy.append([energy.solve(here[0], "V", root)])
    both = Both(by_equations, by_energy)
    found = read(table, both, ("p",))
    for name, attribute in (("V", "volume"), ("u_max", "u_max"), ("w_mid", "w_mid")):
        pairs = [
            [np.array([getattr(s[0], attribute)]) for s in levels] for levels in (by_energy, by_equations)
        ]
        found.append(column(table, name, *pairs, floor=PLACE))
    title = "Limit point of the pressure among the lopsided states of a long tube"
    extra = {"keys": ["alpha", "delta1", "lf", "u_end"]}
    return SERIES.table(table, title, "", {}, [*keys([LIMIT]), *found], extra=extra)


PLACE = 1e-7
"""Uncertainty of the place of a limit point: the root of a slope to 1e-9, and its rounding."""


def profile() -> Table:
    """The meridian of one lopsided state."""
    table, tube = "lopsided_profile", ASKED[PROFILE].tube
    places = np.linspace(-1, 1, 31)
    both = states(PROFILE, np.array([v for v in ASKED[PROFILE].volumes if v <= VOLUME]), "V")
    read_all = [
        [level[-1].meridian(places) for level in levels] for levels in (both.by_energy, both.by_equations)
    ]
    found = [
        column(table, name, *([meridian[k] for meridian in levels] for levels in read_all), floor=0.0)
        for k, name in enumerate(("rho", "eta"))
    ]
    title = "Meridian of a lopsided neo-Hookean tube"
    rows = [*SERIES.keys(Z=places * tube.lf / 2), *found]
    return SERIES.table(table, title, "", parameters(PROFILE) | {"V": VOLUME}, rows)


TABLES = {
    **{f"lopsided_{name}": partial(branch, name) for name in ASKED},
    "lopsided_crossings": crossings,
    "lopsided_limits": limits,
    "lopsided_profile": profile,
}
