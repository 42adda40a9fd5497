"""Tables of the freely inflated tube of paper 2: where it bends, loses its mirror symmetry, and wrinkles."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import NamedTuple

import numpy as np

from reference_data.solvers.beyond.tube_waves import ritz, strong
from reference_data.solvers.beyond.tube_waves.family import FAMILIES, Family
from reference_data.solvers.core.collocation import Array
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import (
    Column,
    DisagreementError,
    Levels,
    Series,
    Table,
    agreed,
    rule,
)
from reference_data.solvers.paper2 import text
from reference_data.solvers.registry import Builder

U_END = {(0.0, 10.0): 2.5}
"""Largest u_max that is searched, by alpha and lf; else 4, the end of the axes of figure 2. Far along the
branch of a long neo-Hookean tube a bulge is hardly held in its place: the eigenvalue of mirror symmetry comes
within rounding of zero."""


def u_end(tube: Tube) -> float:
    """Largest u_max that is searched."""
    return U_END.get((tube.alpha, tube.lf), 4.0)


RATIO = 1.045
"""Quotient of neighbouring volumes of the search."""

BASES = ritz.Basis(10, 12), ritz.Basis(14, 14)
ROUNDING = 2e-12, 3e-11
"""Relative rounding of roots by (b) and by (a), whose eigenvalues lose digits to small elements."""

ASKED = (
    Tube(0.0, 1.0, 6.0),
    Tube(0.0, 1.0, 8.0),
    Tube(0.0, 1.0, 10.0),
    Tube(0.05, 1.0, 6.0),
    Tube(0.1, 1.0, 6.0),
    Tube(0.1, 1.0, 10.0),
)
"""Tubes without pre-stretch, short and long."""

PRINTED = tuple(Tube(0.0, d, 6.0) for d in (1.5, 2.0)) + tuple(
    Tube(0.1, d, 6.0) for d in (1.1, 1.15, 1.2, 1.5, 2.0)
)
"""Further tubes of the paper's figures 2 to 5."""

TUBES = ASKED + PRINTED

COLUMNS = text.COLUMNS | {
    "n": ("1", "wave number around the axis; 0: the mirror symmetry along the axis is lost"),
    "parity": ("1", "of the wave along the axis: 1 even, -1 odd"),
    "direction": ("1", "1 if an eigenvalue becomes negative with growing volume, -1 if positive"),
    "Z_t_min": ("delta1 z/R_f", "place where the hoop resultant vanishes, from the mid-plane; disk at lf/2"),
    "u_end": ("(R_mid - R_f)/R_f", "largest u_max that was searched"),
    "order": ("1", "number of the point of its kind along the branch"),
}
METHOD = (
    "Two codes that share the data of the tube and no equation: (a) the energy of a surface in space, by "
    "polynomials of high degree, with second derivatives by complex steps of its gradient and midpoint sums "
    "in theta, neutral where an eigenvalue is zero; (b) collocation of the strong equations of paper 2 and "
    "of the linearised equations of a membrane in space, neutral where the determinant of the transfer "
    "matrix from mid-plane to disk is zero. Both search the same volumes and must find the same number of "
    "points between the same neighbours. " + rule("b")
)
GRID = (
    f"(a) {BASES[0].elements} elements of degree {BASES[0].degree} and {BASES[1].elements} of degree "
    f"{BASES[1].degree}; (b) {strong.MESHES[0].elements} elements of degree {strong.MESHES[0].degree} and "
    f"{strong.MESHES[1].elements} of degree {strong.MESHES[1].degree}; graded to the disk"
)
TOLERANCE = "roots in V to 1e-13; Newton takes one more step after the first one below 1e-7"
SOURCE = "beyond Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282, figures 2 to 5"
SERIES = Series("beyond", SOURCE, COLUMNS, METHOD, GRID, TOLERANCE)


class Search(NamedTuple):
    """States of both methods at the same volumes."""

    volumes: Array
    by_energy: list[ritz.State]
    by_equations: list[strong.State]


class Point(NamedTuple):
    """A point of one tube by both methods, coarse and fine, and the change of the count there."""

    tube: Tube
    order: int
    direction: int
    by_energy: list[ritz.State]
    by_equations: list[strong.State]


@cache
def search(tube: Tube) -> Search:
    """States from nearly no pressure to the largest displacement."""
    volumes = tube.lf / 4 * RATIO ** np.arange(1, 120)
    first = strong.start(tube, strong.MESHES[-1], "V", float(volumes[0]))
    found = []
    for volume in volumes:
        first = strong.solve(first, V=float(volume))
        if first.u_max > u_end(tube):
            break
        found.append(first)
    volumes = volumes[: len(found)]
    return Search(volumes, ritz.states(tube, BASES[0], volumes), found)


def located(
    tube: Tube,
    signs: tuple[Array, Array],
    by_energy: Callable[[int], Callable[[ritz.State], float]],
    by_equations: Callable[[strong.State], float],
) -> list[Point]:
    """Roots of functions of states that both methods bracket.

    Args:
        tube: The tube.
        signs: What changes by 1 at a point by (a) (a count), and what changes its sign there by (b).
        by_energy: Of (a), for the interval after a state.
        by_equations: Of (b).

    Raises:
        DisagreementError: If the methods bracket different points.
    """
    at, counts, values = search(tube), *signs
    changes = np.flatnonzero(np.diff(counts))
    if list(changes) != list(np.flatnonzero(values[:-1] * values[1:] < 0)):
        raise DisagreementError(f"{tube}: the methods find points between different neighbours")
    out = []
    for order, i in enumerate(changes.tolist(), 1):
        low, high, function = float(at.volumes[i]), float(at.volumes[i + 1]), by_energy(i)
        a = [ritz.root(ritz.again(at.by_energy[i], basis), function, low, high) for basis in BASES]
        b = strong.roots(at.by_equations[i], by_equations, low, high)
        out.append(Point(tube, order, int(np.sign(counts[i + 1] - counts[i])), a, b))
    return out


@cache
def neutral(tube: Tube, family: Family) -> list[Point]:
    """Points of a tube where a family is neutral."""
    at = search(tube)
    counts = np.array([ritz.negative(state, family) for state in at.by_energy])
    values = np.array([strong.determinant(state, family) for state in at.by_equations])

    def eigenvalue(i: int) -> Callable[[ritz.State], float]:
        index = int(min(counts[i : i + 2]))
        return lambda state: ritz.eigenvalue(state, family, index)

    return located(tube, (counts, values), eigenvalue, lambda state: strong.determinant(state, family))


@cache
def limits(tube: Tube) -> list[Point]:
    """Limit points of the pressure."""
    at = search(tube)
    falling = np.array([int(ritz.rate(state) < 0) for state in at.by_energy])
    rates = np.array([strong.rate(state) for state in at.by_equations])
    return located(tube, (falling, rates), lambda _: ritz.rate, strong.rate)


@cache
def onsets(tube: Tube) -> list[Point]:
    """Points where the smallest hoop resultant passes zero."""
    at = search(tube)
    compressed = np.array([int(ritz.least_hoop(state)[0] < 0) for state in at.by_energy])
    least = np.array([strong.least_hoop(state)[0] for state in at.by_equations])

    def margin(state: ritz.State) -> float:
        return ritz.least_hoop(state)[0]

    return located(tube, (compressed, least), lambda _: margin, lambda state: strong.least_hoop(state)[0])


def columns(name: str, points: list[Point], more: dict[str, tuple[Callable, Callable]]) -> list[Column]:
    """p, u_max, V and further columns, of which each is a function of a state of (a), and one of (b)."""
    own = {
        "p": (lambda s: s.p, lambda s: s.p),
        "u_max": (lambda s: s.u_max, lambda s: s.u_max),
        "V": (lambda s: s.volume, lambda s: s.volume),
    }
    out = []
    for column, (of_a, of_b) in (own | more).items():
        a, b = (
            Levels(*(np.array([f(states[k]) for states in rows]) for k in (0, 1)), rounding=rounding)
            for f, rows, rounding in (
                (of_a, [q.by_energy for q in points], ROUNDING[1]),
                (of_b, [q.by_equations for q in points], ROUNDING[0]),
            )
        )
        about = COLUMNS[column]
        out.append(agreed(name, column, a, b, about, "energy in space", "strong equations"))
    return out


def keys(points: list[Point], **more: list[float]) -> dict[str, list[float]]:
    """Columns that name a row."""
    tubes = [q.tube for q in points]
    own = {key: [getattr(tube, key) for tube in tubes] for key in ("alpha", "delta1", "lf")}
    own["u_end"] = [u_end(tube) for tube in tubes]
    return own | more | {"order": [q.order for q in points]}


def table(
    name: str, title: str, points: list[Point], found: list[Column], notes: str, **more: list[float]
) -> Table:
    """A table of points; tubes without any are named."""
    without = [t for t in TUBES if t not in {q.tube for q in points}]
    if without:
        sets = "; ".join(f"({t.alpha:g}, {t.delta1:g}, {t.lf:g})" for t in without)
        notes += f" None for (alpha, delta1, lf) = {sets}."
    named = keys(points, **more)
    rows = SERIES.keys(**named, direction=[q.direction for q in points]) + found
    extra = {"keys": list(named)}
    return SERIES.table(name, title, "", {}, rows, notes=notes, extra=extra)


def waves(name: str, order: tuple[Family, ...]) -> Table:
    """Points where waves are neutral."""
    points = [(q, f) for tube in TUBES for f in order for q in neutral(tube, f)]
    plain, families = [q for q, _ in points], [f for _, f in points]
    more = {"n": [f.n for f in families], "parity": [f.parity for f in families]}
    notes = "Searched: " + ", ".join(f"n = {f.n} {'even' if f.parity > 0 else 'odd'}" for f in order) + "."
    title = "Points of free inflation at which the tube is neutral to waves"
    return table(name, title, plain, columns(name, plain, {}), notes, **more)


def limit_points(name: str) -> Table:
    """Limit points of the pressure of the same tubes."""
    points = [q for tube in TUBES for q in limits(tube)]
    title = "Limit points of the pressure in free inflation"
    return table(name, title, points, columns(name, points, {}), "dp/dV = 0.")


def wrinkling(name: str) -> Table:
    """Points where the membrane begins, or ceases, to be compressed."""
    points = [q for tube in TUBES for q in onsets(tube)]
    title = "Points of free inflation at which the smallest hoop resultant is zero"
    notes = "The meridional resultant is positive on all branches. direction 1: compressed beyond."
    found = columns(name, points, {})
    a, b = ([[f(s)[1] for s in rows] for rows in states] for f, states in (
        (ritz.least_hoop, [q.by_energy for q in points]),
        (strong.least_hoop, [q.by_equations for q in points]),
    ))  # fmt: skip
    # A minimum's place is known to the square root of the value's rounding.
    levels = [Levels(*np.array(rows).T, floor=PLACE) for rows in (a, b)]
    found.append(agreed(name, "Z_t_min", *levels, COLUMNS["Z_t_min"], "energy in space", "strong equations"))
    return table(name, title, points, found, notes)


PLACE = 2e-7
"""Uncertainty of the place of a minimum, from the rounding of its value."""

TABLES: dict[str, Builder] = {
    "tube_waves": partial(waves, "tube_waves", FAMILIES),
    "tube_waves_limits": partial(limit_points, "tube_waves_limits"),
    "tube_waves_wrinkling": partial(wrinkling, "tube_waves_wrinkling"),
}
