"""Tables of critical points of the free tube in planes of two parameters: lines, and points on them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from reference_data.solvers.beyond import lines_collocation as col
from reference_data.solvers.beyond import lines_energy as energy
from reference_data.solvers.beyond import lines_shooting as shoot
from reference_data.solvers.beyond.lines_energy import FAMILIES
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import secant
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule, steps
from reference_data.solvers.registry import Builder

Array = np.ndarray
ROUNDING = 1e-12
CLOSE = 1e-9
"""Distance of two displacements that are the same but for rounding."""
STEP = 0.1
"""Largest step of u_max along a line."""

COLUMNS = {
    "u_max": ("1/R_f", "radial displacement of the mid-plane, rho(0) - 1"),
    "p": ("P R_f/(C1 h_o)", "gauge pressure"),
    "alpha": ("1", "C2/C1"),
    "delta1": ("1", "axial pre-stretch"),
    "lf": ("1/R_f", "distance of the disks"),
    "order": ("1", "number along the line, from 1"),
    "S_least": ("1", "place of the least T2 as a fraction of the half length; 1: at the disk"),
}
MESHES = " and ".join(f"{m.elements} elements of degree {m.degree}" for m in col.MESHES)
SERIES = Series(
    "beyond",
    "The tube of Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282",
    COLUMNS,
    "Two codes that share only slope and curvature of the law: (a) shooting in Hamilton's variables, "
    "determinants of the derivatives by initial values; (b) collocation of the full extended system, with "
    "null vectors as further unknowns. " + rule("b"),
    f"(a) {shoot.LEVELS[0]} and {shoot.LEVELS[1]} extrapolated steps; (b) {MESHES}, graded to the disk",
    "Newton takes two more steps after the first one below 1e-9: rounding only",
)

WAVES = replace(
    SERIES,
    method="Two codes that share the data of the tube and no equation: (a) the energy of a surface in space, "
    "by polynomials of high degree, with second derivatives by complex steps of its gradient and midpoint "
    "sums in theta, an eigenvalue of which is zero; (b) collocation of the equations of paper 2 and of the "
    "linearised equations of a membrane in space, with the wave as further unknowns. " + rule("b"),
    grid=f"(a) {' and '.join(f'{b.elements} elements of degree {b.degree}' for b in energy.BASES)}; (b) "
    f"{MESHES}, graded to the disk",
    tolerance="(a) secants in the parameter to 1e-9, the last step of which is more accurate; (b) Newton "
    "takes two more steps after the first one below 1e-9: rounding only",
)
ROUNDING_OF_WAVES = 3e-11
"""Relative rounding of the eigenvalues of (a), which lose digits to small elements."""

TITLES = {
    "fold": "a limit point",
    "mirror": "mirror breaking",
    "n1": "bending",
    "n2": "two waves around",
}


def traced(first: col.Point, targets: Array) -> list[col.Point]:
    """Critical points at values of u_max, from a guess near the first one; steps between are short."""
    here, found = col.solve(first, u_max=float(targets[0])), []
    before = None
    for target in targets:
        for u in np.linspace(here.u_max, target, 1 + max(1, int(np.ceil((target - here.u_max) / STEP))))[1:]:
            guess = here if before is None else _ahead(before, here, float(u))
            if u > here.u_max + CLOSE:
                before, here = here, col.solve(guess, u_max=float(u))
        found.append(here)
    return found


def _ahead(a: col.Point, b: col.Point, u: float) -> col.Point:
    """Linear extrapolation of two points of a line."""
    share = (u - b.u_max) / (b.u_max - a.u_max)
    y = tuple(q + share * (q - p) for p, q in zip(a.y, b.y, strict=True))
    return replace(b, y=y, c=b.c + share * (b.c - a.c))


def start(kind: str, tube: Tube, vary: str, u: float) -> col.Point:
    """A guess of a critical point of a kind: the state of one tube with that displacement."""
    state = col.equilibrium(tube, vary, col.MESHES[0], u)
    if kind in col.NULL:
        return col.with_nulls(state, [kind])
    if kind == "wrinkling":
        return replace(state, onset="end")
    share = float(col.MESHES[0].x.ravel()[np.argmin(_tensions(state))])
    return col.cut_at(state, share, col.MESHES[0])


def _tensions(state: col.Point) -> Array:
    rho, _, l1, _ = np.moveaxis(state.y[0].reshape(-1, state.y[0].shape[-1]), -1, 0)[:4]
    return mat.slope(rho / state.tube.r0, l1, state.tube.alpha) / l1


def on_both(points: Sequence[col.Point]) -> list[list[col.Point]]:
    """The same points on both meshes."""
    fine = [col.solve(col.recut(point, col.MESHES[1]), u_max=point.u_max) for point in points]
    return [list(points), fine]


def shot(kind: str, tube: Tube, vary: str, points: Sequence[col.Point]) -> list[Array]:
    """The unknowns of the same points by shooting, on both levels, from the other method's as guesses."""
    force = []
    for point in points:
        (rho, _, l1, _), tube_there = point.y[0][0, 0, :4], replace(tube, **{vary: float(point.c[1])})
        w1 = mat.slope(l1, rho / tube_there.r0, float(tube_there.alpha))
        force.append(tube_there.r0 * w1 - point.c[0] * rho**2 / 2)
    rows = [np.array(force), np.array([point.c[0] for point in points])]
    if kind == "wrinkling_front":
        rows.append(np.array([point.c[2] for point in points]))
    x = np.array([*rows, [point.c[1] for point in points]])
    u = np.array([point.u_max for point in points])
    given = {name: getattr(tube, name) for name in ("alpha", "delta1", "lf")}
    return [shoot.solve(kind, given, vary, x, u, n) for n in shoot.LEVELS]


def line(name: str, kind: str, tube: Tube, vary: str, targets: Array, begin: float) -> Table:
    """One line over u_max.

    Args:
        name: Of the table.
        kind: ``fold``, ``mirror``, ``wrinkling`` (at the disk) or ``wrinkling_front``.
        tube: The tube, with a value of the parameter near that at the first target.
        vary: The parameter.
        targets: Displacements.
        begin: That of the guess.
    """
    coarse, fine = on_both(traced(start(kind, tube, vary, begin), targets))
    other = other_of(kind)
    by_other = other.solve(kind, tube, vary, fine)
    columns = SERIES.keys(u_max=targets)
    wanted = [("p", 1), (vary, -1), *([("S_least", 2)] if kind == "wrinkling_front" else [])]
    for column, row in wanted:
        a = Levels(*(x[row] for x in by_other), rounding=other.rounding)
        b = Levels(*([at.numbers[column] for at in level] for level in (coarse, fine)), rounding=ROUNDING)
        columns.append(_agreed(name, column, a, b, other))
    parameters = {n: float(getattr(tube, n)) for n in ("alpha", "delta1", "lf") if n != vary}
    title = f"Line of kind {kind.partition('_')[0]} over {vary}"
    return other.series.table(name, title, "", parameters, columns)


@dataclass(frozen=True)
class Other:
    """The other method: its name, what its tables say, the same points by it, and their rounding."""

    name: str
    series: Series
    solve: Callable[[str, Tube, str, Sequence[col.Point]], list[Array]]
    """(kind, tube, vary, points) to arrays with p in the row 1 and the parameter in the last one."""
    rounding: float
    rounding_at_turns: float
    """The same where a parameter is stationary, or two conditions hold."""


def other_of(kind: str) -> Other:
    """The other method for a kind of lines: shooting, or the energy in space for waves around the axis."""
    if kind in FAMILIES:
        rounding = ROUNDING_OF_WAVES
        return Other("energy in space", WAVES, energy.solve, rounding=rounding, rounding_at_turns=rounding)
    return Other("shooting", SERIES, shot, rounding=ROUNDING, rounding_at_turns=1e-10)


def _agreed(name: str, column: str, a: Levels, b: Levels, other: Other) -> Column:
    return agreed(name, column, a, b, COLUMNS[column], other=other.name)


def turns(name: str, kind: str, tube: Tube, vary: str, brackets: Sequence[float], begin: float) -> Table:
    """Turning points of the parameter along a line: cusps of limit points, tips of mirror breaking.

    Method (b) alone has the rate of the parameter; (a) gives p and the parameter at the same u_max.
    """
    points = traced(start(kind, tube, vary, begin), np.array(brackets))
    found = []
    for mesh in col.MESHES:
        row = []
        for point in points:
            here = [col.solve(col.recut(point, mesh), u_max=point.u_max)]

            def rate(u: float, here: list[col.Point] = here) -> float:
                here[0] = col.solve(here[0], u_max=u)
                return col.turn_rate(here[0])

            u = secant(rate, point.u_max, point.u_max + 1e-3, 0.05)[0]
            row.append(col.solve(here[0], u_max=u))
        found.append(row)
    other = other_of(kind)
    by_other = other.solve(kind, tube, vary, found[1])
    # Where the parameter is stationary, p of the line may still vary with u_max.
    columns = SERIES.keys(order=[1.0 + k for k in range(len(points))])
    u_levels = Levels(*([at.u_max for at in row] for row in found), rounding=1e-9)
    columns.append(Column("u_max", u_levels.value, float(u_levels.uncertainty.max()), *COLUMNS["u_max"]))
    for column, k in (("p", 1), (vary, -1)):
        a = Levels(*(x[k] for x in by_other), rounding=other.rounding_at_turns)
        b = Levels(*([at.numbers[column] for at in row] for row in found), rounding=1e-10)
        columns.append(_agreed(name, column, a, b, other))
    parameters = {n: float(getattr(tube, n)) for n in ("alpha", "delta1", "lf") if n != vary}
    title = f"Turning points of {vary} along a line of kind {kind}"
    return other.series.table(name, title, "", parameters, columns, extra={"keys": ["order"]})


def coincidence(name: str, pair: tuple[str, str], tubes: Sequence[Tube], vary: str, near: Array) -> Table:
    """Points at which two kinds of lines meet, one of each tube.

    Args:
        name: Of the table.
        pair: The kinds; a guess is a point of the second one.
        tubes: Tubes, with a value of the parameter near that at the first displacement.
        vary: The parameter.
        near: Of each tube, the displacements of a guess of a point of the second kind, and of the meeting.
    """
    found = []
    for tube, (u, last) in zip(tubes, near, strict=True):
        state = traced(start(pair[1], tube, vary, u), np.array([u, last]))[1]
        plain = replace(state, nulls=(), y=(state.y[0][..., :4],))
        both = col.with_nulls(plain, pair)
        found.append([col.solve(col.recut(both, mesh)) for mesh in col.MESHES])
    levels = list(zip(*found, strict=True))
    names = [n for n in ("alpha", "delta1", "lf") if n != vary and len({getattr(t, n) for t in tubes}) > 1]
    columns = SERIES.keys(**{n: [float(getattr(t, n)) for t in tubes] for n in names})
    columns = columns or SERIES.keys(order=[1.0])
    others = [other_of(kind) for kind in pair]
    by_others = []
    for kind, other in zip(pair, others, strict=True):
        rows = [other.solve(kind, tube, vary, [point]) for tube, point in zip(tubes, levels[1], strict=True)]
        by_others.append([np.concatenate(level, axis=1) for level in zip(*rows, strict=True)])
    for column, k in (("p", 1), (vary, -1)):
        b = Levels(*([at.numbers[column] for at in level] for level in levels), rounding=1e-10)
        compared = [
            _agreed(name, column, Levels(*(x[k] for x in rows), rounding=other.rounding_at_turns), b, other)
            for rows, other in zip(by_others, others, strict=True)
        ]  # both must agree
        columns.append(max(compared, key=lambda item: item.uncertainty))
    u_levels = Levels(*([at.u_max for at in level] for level in levels), rounding=1e-10)
    columns.append(Column("u_max", u_levels.value, float(u_levels.uncertainty.max()), *COLUMNS["u_max"]))
    parameters = {
        n: float(getattr(tubes[0], n)) for n in ("alpha", "delta1", "lf") if n not in (vary, *names)
    }
    title = "Coincidence of " + " with ".join(TITLES[kind] for kind in pair)
    return others[1].series.table(name, title, "", parameters, columns, extra={"keys": names or ["order"]})


TABLES: dict[str, Builder] = {
    "lines_fold_alpha": partial(
        line, "lines_fold_alpha", "fold", Tube(0.0, 1.0, 6.0), "alpha", steps(0.9, 4.8, 0.15), 0.82
    ),
    "lines_mirror_alpha": partial(
        line, "lines_mirror_alpha", "mirror", Tube(0.0, 1.0, 6.0), "alpha", steps(1.4, 4.8, 0.2), 1.33
    ),
    "lines_mirror_delta1": partial(
        line, "lines_mirror_delta1", "mirror", Tube(0.0, 1.0, 6.0), "delta1", steps(1.4, 4.8, 0.2), 1.33
    ),
    "lines_wrinkling_front": partial(
        line, "lines_wrinkling_front", "wrinkling_front", Tube(0.0, 1.0, 6.0), "delta1",
        steps(1.535, 1.56, 0.005), 1.533,
    ),
    "lines_wrinkling_disk": partial(
        line, "lines_wrinkling_disk", "wrinkling", Tube(0.0, 1.125, 6.0), "delta1",
        steps(1.65, 2.85, 0.15), 1.32,
    ),
    "lines_cusp_alpha": partial(
        turns, "lines_cusp_alpha", "fold", Tube(0.0, 1.0, 6.0), "alpha", (1.56,), 0.82
    ),
    "lines_tips_alpha": partial(
        turns, "lines_tips_alpha", "mirror", Tube(0.0, 1.0, 6.0), "alpha", (2.24, 3.53), 1.33
    ),
    "lines_fold_mirror_alpha": partial(
        coincidence, "lines_fold_mirror_alpha", ("fold", "mirror"), (Tube(0.0, 1.0, 6.0),), "alpha",
        ((1.33, 4.27),),
    ),
    "lines_n1_lf": partial(
        line, "lines_n1_lf", "n1", Tube(0.0, 1.0, 9.8), "lf", steps(0.65, 1.85, 0.15), 0.642
    ),
    "lines_n1_delta1": partial(
        line, "lines_n1_delta1", "n1", Tube(0.0, 1.0, 6.0), "delta1", steps(1.1, 1.65, 0.05), 1.0976
    ),
    "lines_n2_delta1": partial(
        line, "lines_n2_delta1", "n2", Tube(0.0, 2.0, 6.0), "delta1", steps(3.6, 3.9, 0.1), 3.756
    ),
    "lines_tip_n1_lf": partial(
        turns, "lines_tip_n1_lf", "n1", Tube(0.0, 1.0, 9.8), "lf", (1.34,), 0.642
    ),
    "lines_tip_n1_delta1": partial(
        turns, "lines_tip_n1_delta1", "n1", Tube(0.0, 1.0, 6.0), "delta1", (1.507,), 1.0976
    ),
    "lines_mirror_n1_lf": partial(
        coincidence, "lines_mirror_n1_lf", ("mirror", "n1"), (Tube(0.0, 1.0, 5.6),), "lf", ((1.4, 1.405),)
    ),
    "lines_fold_n1_lf": partial(
        coincidence, "lines_fold_n1_lf", ("fold", "n1"),
        (Tube(0.0, 1.0, 7.92), Tube(0.05, 1.0, 8.19), Tube(0.1, 1.0, 8.5)), "lf",
        ((0.8, 0.8054), (0.895, 0.89976), (1.005, 1.0103)),
    ),
}  # fmt: skip
