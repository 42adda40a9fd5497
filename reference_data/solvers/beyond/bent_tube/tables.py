"""Tables of bent states of the free tube: branches over the volume, where they begin, their curvatures."""

from __future__ import annotations

from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

from reference_data.solvers.beyond.bent_tube import energy, strong
from reference_data.solvers.beyond.tube_waves.ritz import Basis
from reference_data.solvers.core.collocation import Array, Mesh
from reference_data.solvers.core.curvatures import beginnings
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule


class Asked(NamedTuple):
    """One branch: its tube, volumes on either side of its beginning, and volumes of its states."""

    tube: Tube
    between: tuple[float, float]
    u_end: float
    volumes: tuple[Any, ...]
    fitted: float
    """Largest amplitude from which the curvatures are extrapolated."""
    n: int = 1
    """Wave number."""


ASKED = {
    "neo_hookean": Asked(Tube(0.0, 1.0, 10.0), (5.8, 6.1), 0.8, (6.0, 6.15, 6.3, 6.45), 0.2),
    "alpha_0_1": Asked(Tube(0.1, 1.0, 10.0), (6.8, 7.1), 0.95, (7.0, 7.15, 7.3), 0.2),
    "short": Asked(Tube(0.0, 1.0, 6.0), (4.85, 5.1), 1.3, (), 0.15),
    "oval": Asked(Tube(0.0, 2.0, 3.0), (2.5, 2.7), 1.5, (2.63, 2.7, 2.8), 0.1, n=2),
}
MASS = "neo_hookean"
"""Branch on which a gas of given mass is looked at."""
GASES = ((1.0, 60.0), (1.4, 85.0))
"""Exponents of the gas, and volumes of a reservoir, with the pressure one outside."""
AROUND = 6.05, 6.45
"""Volumes between which the extrema of the mass are."""
ORDERS = 7, 9
"""Numbers of Chebyshev nodes between them, of the coarse and the fine levels of both methods."""
CALLED = {1: "bent", 2: "oval"}
"""Names of states by their wave number."""
CROSSINGS = {"bent_tube_crossings": 1, "bent_tube_oval_crossings": 2}
"""Tables of beginnings, and their wave numbers."""
FIRST = 0.1
"""Amplitude of the first state."""
NODES = 5
"""Number of amplitudes, and of coefficients in the amplitude's square, of a fit."""
FLOOR = 1e-11
"""Relative rounding of columns."""


class Grids(NamedTuple):
    """Coarse and fine functions of (a), and nets of (b)."""

    series: tuple[energy.Series, energy.Series]
    nets: tuple[strong.Net, strong.Net]


@cache
def grids(n: int, harmonics: tuple[int, int], angles: tuple[int, int]) -> Grids:
    """Functions and nets of a wave number that differ in their resolution around the axis."""
    bases, degrees = (Basis(7, 9), Basis(8, 11)), ((7, 11), (8, 13))
    return Grids(
        tuple(energy.Series(n, k, basis) for k, basis in zip(harmonics, bases, strict=True)),
        tuple(
            strong.Net(n, count, Mesh.graded(*mesh, 2.0)) for count, mesh in zip(angles, degrees, strict=True)
        ),
    )


FAR, NEAR = ((7, 10), (9, 11)), ((4, 6), (6, 8))
"""Harmonics and angles of branches, and of states of small amplitude."""

COLUMNS = {
    "alpha": ("1", "C2/C1"),
    "delta1": ("1", "axial pre-stretch"),
    "lf": ("L_f/R_f", "stretched length"),
    "u_end": ("(R_mid - R_f)/R_f", "displacement at which the axisymmetric branch of the case ends"),
    "V": ("2 pi R_f^3", "volume of the half tube"),
    "p": ("P R_f/(C1 h_o)", "pressure"),
    "u_max": ("(R_mid - R_f)/R_f", "radial displacement of the mid-plane, its mean around the axis"),
    "u_wave": ("u/R_f", "amplitude of cos(n theta) in the same, positive"),
    "gas_kappa": ("1", "exponent of the gas; 1: isothermal"),
    "V_r": ("2 pi R_f^3", "volume of a rigid reservoir"),
    "m": ("as (p + p_atm) (V + V_r)^gas_kappa", "mass of the gas, p_atm = 1"),
    "p_2": ("as p", "curvature of p over u_wave at the crossing: p = p_c + p_2 u_wave^2 + ..."),
    "V_2": ("as V", "the same of the volume"),
}
METHOD = (
    "Two codes on half the tube, which share the data of the tube and no equation: (a) the energy of a "
    "surface in space by Fourier series around the axis and polynomials along it, with second derivatives by "
    "complex steps of its gradient; (b) collocation of the balance of forces at points of the surface, from "
    "the states of (a) as guesses. Curvatures are fits of polynomials in u_wave^2 to states of small "
    "amplitude. " + rule("a")
)
GRID = (
    "(a) 7 and 8 elements of degree 9 and 11, (b) 7 and 8 elements of degree 11 and 13, graded to the disk. "
    "Around the axis (a) has 7 and 10 harmonics and (b) 9 and 11 angles of half the circumference; for "
    "curvatures 4 and 6 harmonics and 6 and 8 angles"
)
SOURCE = "beyond Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282"
TOLERANCE = "Newton takes one more step after the first one below 1e-7"
SERIES = Series("beyond", SOURCE, COLUMNS, METHOD, GRID, TOLERANCE)


class Both(NamedTuple):
    """The same states by both methods, each coarse and fine."""

    by_energy: list[list[energy.State]]
    by_forces: list[list[strong.State]]


@cache
def first(name: str) -> energy.State:
    """The first state of a branch."""
    asked = ASKED[name]
    return energy.beside(asked.tube, grids(asked.n, *NEAR).series[0], asked.between, 0, FIRST)


def states(name: str, values: Array, held: str, resolution: tuple[tuple[int, int], ...]) -> Both:
    """States of a branch at rising volumes or amplitudes."""
    on = grids(ASKED[name].n, *resolution)
    coarse, at = [], energy.on(first(name), on.series[0])
    for value in map(float, values):
        at = energy.solve(at, held, value)
        coarse.append(at)
    pairs = list(zip(coarse, map(float, values), strict=True))
    fine = [energy.solve(energy.on(s, on.series[1]), held, v) for s, v in pairs]
    others = [[strong.solve(strong.on(s, net), held, v) for s, v in pairs] for net in on.nets]
    return Both([coarse, fine], others)


def column(table: str, name: str, by_energy: list[Array], by_forces: list[Array], floor: float) -> Column:
    """One column from values of both methods, coarse and fine."""
    a, b = (
        Levels(*(np.atleast_1d(x) for x in values), floor=floor, rounding=FLOOR)
        for values in (by_energy, by_forces)
    )
    return agreed(table, name, b, a, COLUMNS[name], "balance of forces", "energy in space")


def read(both: Both, attribute: str) -> list[list[Array]]:
    """One number of all states, by method and resolution."""
    return [[np.array([getattr(s, attribute) for s in level]) for level in levels] for levels in both]


def branch(name: str) -> Table:
    """One branch over the volume."""
    asked, table = ASKED[name], f"bent_tube_{name}"
    volumes = np.array(asked.volumes)
    both = states(name, volumes, "V", FAR)
    parts = {"p": "p", "u_max": "u_max", "u_wave": "amplitude"}
    found = [column(table, key, *read(both, part), floor=0.0) for key, part in parts.items()]
    tube = asked.tube
    given = {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf, "n": asked.n}
    title = f"{CALLED[asked.n].capitalize()} states of the inflated tube over their volume"
    return SERIES.table(table, title, "", given, [*SERIES.keys(V=volumes), *found])


def crossings(table: str, n: int) -> Table:
    """Where the branches of a wave number begin, with their curvatures."""
    names = [name for name, asked in ASKED.items() if asked.n == n]
    found = beginnings(
        {name: ASKED[name].fitted for name in names},
        lambda name, amplitudes: states(name, amplitudes, "u_wave", NEAR),
        NODES,
    )
    columns = [column(table, key, *values, floor=spread) for key, (values, spread) in found.items()]
    tubes = {key: [getattr(ASKED[n].tube, key) for n in names] for key in ("alpha", "delta1", "lf")}
    keys = SERIES.keys(**tubes, u_end=[ASKED[n].u_end for n in names])
    title = f"Points of free inflation at which {CALLED[n]} states begin, and their curvatures there"
    extra = {"keys": [k.name for k in keys]}
    return SERIES.table(table, title, "", {"n": n}, [*keys, *columns], extra=extra)


def folds(table: str = "bent_tube_mass_folds") -> Table:
    """Bent states at which the mass of the gas inside has an extremum.

    Pressure and amplitude are polynomials of the volume through states at Chebyshev nodes.
    """
    found = []
    for count in ORDERS:
        volumes = Chebyshev.basis(count, AROUND).roots()
        found.append((volumes, states(MASS, np.sort(volumes), "V", FAR)))
    rows: list[list[list[Array]]] = [[], []]
    for method, out in enumerate(rows):
        for level, (volumes, both) in enumerate(found):
            out.append([_extremum(np.sort(volumes), both[method][level], *gas) for gas in GASES])
    names = "V", "p", "u_wave", "m"
    columns = [
        column(table, name, *([np.array(level)[:, i] for level in rows_of] for rows_of in rows), floor=0.0)
        for i, name in enumerate(names)
    ]
    tube = ASKED[MASS].tube
    given = {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf, "n": 1, "p_atm": 1.0}
    keys = SERIES.keys(gas_kappa=[kappa for kappa, _ in GASES], V_r=[v for _, v in GASES])
    title = "Bent states at which the mass of the gas inside has an extremum"
    return SERIES.table(table, title, "", given, [*keys, *columns], extra={"keys": [k.name for k in keys]})


def _extremum(volumes: Array, of: list[Any], kappa: float, reservoir: float) -> tuple[float, ...]:
    """Volume, pressure, amplitude and mass at an extremum of the mass."""
    degree = len(volumes) - 1
    p, u = (
        Chebyshev.fit(volumes, [getattr(s, name) for s in of], degree, AROUND) for name in ("p", "amplitude")
    )
    slope = p.deriv()
    at = float(brentq(lambda v: (v + reservoir) * slope(v) + kappa * (p(v) + 1), *AROUND, xtol=1e-14))
    return at, float(p(at)), float(u(at)), float((p(at) + 1) * (at + reservoir) ** kappa)


TABLES = {
    **{f"bent_tube_{name}": partial(branch, name) for name, asked in ASKED.items() if asked.volumes},
    **{name: partial(crossings, name, n) for name, n in CROSSINGS.items()},
    "bent_tube_mass_folds": folds,
}
