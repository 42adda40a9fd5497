"""Tables of paper 3: the secondary branch, its stability, its states and how it starts.

Patil, Nordmark & Eriksson, Proc. R. Soc. A 471 (2015) 20150016, figures 2, 3, 6 and 8.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np

from reference_data.solvers.core.tables import Column, Series, Table, round_up
from reference_data.solvers.paper3 import text, weak
from reference_data.solvers.paper3.bent import both_methods as bent
from reference_data.solvers.paper3.bent import branch, states
from reference_data.solvers.paper3.bent.equations import Array, Grid, Surface
from reference_data.solvers.paper3.bent.newton import newton, raised
from reference_data.solvers.paper3.collocation import State
from reference_data.solvers.paper3.common import Rows, given, named
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.galerkin import Elements, Shape
from reference_data.solvers.paper3.modes import critical_point, galerkin_critical, zeros
from reference_data.solvers.paper3.modes import quantities as axisymmetric
from reference_data.solvers.paper3.path import RESOLUTIONS
from reference_data.solvers.paper3.strong import states as balance
from reference_data.solvers.paper3.tables_primary import DENSITY, PAPER
from reference_data.solvers.registry import Builder

# Levels of the tables; the branch starts just above the last one.
LEVELS: dict[FluidTube, tuple[float, ...]] = {
    FluidTube(8, 1.5): (7.875, 7.925, 7.975, 8.025, 8.075, 8.125, 8.15, 8.17),
    FluidTube(8, 2): (7.3, 7.336, 7.4, 7.5, 7.6, 7.65, 7.7, 7.75, 7.779, 7.8, 7.85, 7.89),
    FluidTube(8, 3): (7.5, 7.6, 7.7, 7.8, 7.85, 7.9, 7.95, 7.97),
    FluidTube(24, 1.5): (7.9, 8.0, 8.1, 8.2, 8.25, 8.3, 8.33),
    FluidTube(24, 2): (7.6, 7.65, 7.7, 7.75, 7.779, 7.8, 7.85, 7.9, 7.95, 8.0, 8.015),
    FluidTube(24, 3): (7.6, 7.65, 7.7, 7.75, 7.8, 7.85, 7.9, 7.95),
}
DENSER: dict[FluidTube, tuple[float, ...]] = {
    FluidTube(8, 2, 0.058): (11.9, 12.0, 12.1, 12.17),
    FluidTube(8, 2, 0.232): (5.2, 5.25, 5.29, 5.31),
    FluidTube(24, 2, 0.058): (11.8, 11.95, 12.05, 12.11),
    FluidTube(24, 2, 0.232): (5.15, 5.25, 5.31, 5.36),
}
"""Levels for other densities: near the bifurcation, where figure 4 shows the branch."""
FINER = (FluidTube(8, 3), FluidTube(24, 2, 0.232))
"""Tubes on finer grids: one bulges most, the liquid of the other is low. Else u of heights is 3e-6."""
COMPRESSED = (FluidTube(24, 1.5),)  # T2 < 0 in the dry part: see COMPRESSED_NOTES
OFFSETS = np.array([0.05, 0.1, 0.15])  # of the centroid, with which the branch is left
STEP = 0.08


Grids = tuple[Surface, Surface, Surface]
Sizes = tuple[tuple[int, int, int, int], ...]


def series(grids: Sizes, nets: Sizes = bent.NETS) -> Series:
    """What tables of the two-dimensional codes say on these grids and nets."""
    said = {"method": text.SECONDARY_METHOD, "tolerance": text.SECONDARY_TOLERANCE}
    return replace(text.SERIES, grid=text.secondary_grid(grids, nets), **said)


@cache
def start(tube: FluidTube, stop: float | None = None) -> tuple[State, Shape]:
    """The first n = 1 bifurcation by collocation and by Galerkin's method, searched up to a volume."""
    how = RESOLUTIONS[1]
    near = zeros(tube, stop or (PAPER | DENSITY)[tube][1], 4.0, (1,))[1]
    state = critical_point(near.moved_to(how.partial if near.partial else how.full), how, 1).state
    return state, galerkin_critical(state, how, 1)


@cache
def followed(tube: FluidTube, stop: float | None = None, lowest: float | None = None) -> branch.Secondary:
    """The secondary branch on the coarsest grid, down to a level: by default the lowest one of the table."""
    line = branch.Secondary(start(tube, stop)[1], 0)
    line.leave(OFFSETS)
    line.to_level(lowest or (LEVELS | DENSER)[tube][0], STEP)
    return line


@cache
def on_levels(tube: FluidTube, zw: float, stop: float | None = None, lowest: float | None = None) -> Grids:
    """The state at a level on the three grids."""
    coarse = followed(tube, stop, lowest).at_level(zw)
    middle = raised(coarse, branch.grid(coarse.partial, 1))
    return coarse, middle, raised(middle, branch.grid(coarse.partial, 2))


def compared(tube: FluidTube, found: tuple[Surface, ...]) -> tuple[Surface, Surface]:
    """The two finest states by Galerkin's method; their difference gives the uncertainty."""
    if tube in FINER:
        return found[-1], raised(found[-1], branch.grid(found[-1].partial, 3))
    return found[-2], found[-1]


def curve_columns(
    name: str, tube: FluidTube, levels: tuple[float, ...], solved: Callable[[FluidTube, float], Grids]
) -> tuple[list[Column], dict[str, object]]:
    """Columns of the secondary branch over the level by both methods, and the rotation's eigenvalue.

    ``solved`` gives the state of a level on the three grids.
    """
    rows: tuple[Rows, ...] = ([], [], [], [])  # Galerkin's method coarse and fine, collocation likewise
    eigen: tuple[Rows, ...] = ([], [], [], [])
    spin = 0.0
    for zw in levels:
        found = solved(tube, zw)
        finest = compared(tube, found)
        pair = finest if tube in bent.STEEP else found[:2]  # for the eigenvalues
        first = states.stability(pair[0])
        second = states.stability(pair[1], first)
        spin = max(spin, abs(second.rotation))
        others = bent.balanced(found[0])
        one = [states.quantities(s) for s in finest] + [balance.quantities(s) for s in others]
        two = [first.columns(), second.columns(), *(balance.stability(s) for s in others)]
        for i in range(4):
            rows[i].append(one[i])
            eigen[i].append(two[i])
    kept = ("Lambda_1", "LambdaV_1") if tube in COMPRESSED else tuple(eigen[0][0])
    columns = text.SERIES.keys(zw=levels)
    for found, names in ((rows, [k for k in rows[0][0] if k != "zw"]), (eigen, kept)):
        for k in names:
            values = [np.array([row[k] for row in part]) for part in found]
            columns.append(bent.paired(name, k, tuple(values[:2]), tuple(values[2:])))
    return columns, {"rotation_eigenvalue": round_up(spin)}


def curve(name: str, tube: FluidTube) -> Table:
    """Secondary branch over the level."""
    columns, extra = curve_columns(name, tube, (LEVELS | DENSER)[tube], on_levels)
    notes = text.SECONDARY_NOTES + (text.COMPRESSED_NOTES if tube in COMPRESSED else "")
    title = f"Secondary branch, L = {tube.L:g}, delta = {tube.delta:g}, gamma = {tube.gamma:g}"
    about = series(branch.GRIDS[2:] if tube in FINER else branch.GRIDS[:3], bent.chosen(tube))
    source = "figure 4" if tube in DENSER else "figures 2 and 3"
    return about.table(name, title, source, given(tube), columns, notes=notes, extra=extra)


def state(name: str, tube: FluidTube, zw: float, across: Array, around: Array, source: str) -> Table:
    """Positions, stretches and stress resultants at one level."""
    middle = on_levels(tube, zw)[-1]
    found = middle, raised(middle, branch.grid(middle.partial, 3))
    at = np.round(across * tube.length, 12)
    fields = []
    for surface in (*found, *bent.balanced(on_levels(tube, zw)[0])):
        x, a, b = surface.evaluate(at, around)
        if isinstance(surface, Surface):
            lam = weak.stretches(a, b)
            principal = *lam, *weak.resultants(*lam, tube.law)
        else:
            principal = balance.principal(a, b, tube.law)
        fields.append([v.ravel() for v in (x[..., 0], x[..., 1], x[..., 2], *principal)])
    columns = text.SERIES.keys(Z=np.repeat(at, len(around)), Theta=np.tile(np.round(around, 12), len(at)))
    for i, c in enumerate(("x", "y", "z", "lam1", "lam2", "T1", "T2")):
        values = [f[i] for f in fields]
        columns.append(bent.paired(name, c, tuple(values[:2]), tuple(values[2:])))
    fine = states.quantities(found[-1])
    facts = given(tube) | {"zw": zw} | {k: fine[k] for k in ("V", "r_mid", "z_min", "T_min")}
    title = f"Secondary branch at z_w = {zw:g}, L = {tube.L:g}, delta = {tube.delta:g}"
    extra = {"keys": ["Z", "Theta"]}
    about = series(branch.GRIDS[2:], bent.chosen(tube))
    return about.table(name, title, source, facts, columns, notes=text.PRESSURE_NOTES, extra=extra)


SLOPE_OFFSETS = np.array([0.03, 0.045, 0.06, 0.075, 0.09])
SLOPE_GRIDS = ((12, 6, 10, 12), (14, 7, 11, 15))
FEWER = range(3)  # states left out of a polynomial, at the far end: what is left falls with each one added


def _special(partial_filling: bool, which: int) -> Grid:
    wet, dry, degree, highest = SLOPE_GRIDS[which]
    return Grid(Elements(wet, dry if partial_filling else 0, degree, 1.0), highest, 2 * highest + 16)


def _limit(values: Array, count: int) -> float:
    """Value at A = 0 of the polynomial in A^2 through the first ``count`` values."""
    square = SLOPE_OFFSETS[:count] ** 2
    return float(
        sum(
            v * np.prod([b / (b - a) for b in square if b != a])
            for v, a in zip(values[:count], square, strict=True)
        )
    )


def _slopes(tube: FluidTube) -> list[list[dict[str, float]]]:
    """Initial slopes with all offsets, with all but the largest and with all but the two largest.

    By Galerkin's method on both grids, then by collocation on both nets.
    """
    critical, shape = start(tube)
    found: tuple[Rows, ...] = ([], [], [], [])
    for offset in SLOPE_OFFSETS:
        guesses = [branch.injected(shape, float(offset), _special(critical.partial, i)) for i in (0, 1)]
        rows = [states.quantities(newton(guess, float(offset))) for guess in guesses]
        rows += [balance.quantities(s) for s in bent.balanced(guesses[0], float(offset), bent.SLOPE_NETS)]
        for part, row in zip(found, rows, strict=True):
            part.append(row)
    return [_initial(rows, axisymmetric(critical)) for rows in found]


def _initial(rows: Rows, base: dict[str, float]) -> list[dict[str, float]]:
    """Slopes at the bifurcation from states at all offsets, and at fewer."""
    a = SLOPE_OFFSETS
    zw, volume, near, far = (np.array([r[k] for r in rows]) for k in ("zw", "V", "r_mid", "r_mid_pi"))
    series = {
        "zw": (zw - base["zw"]) / a**2,
        "V": (volume - base["V"]) / a**2,
        "odd": (near - far) / (2 * a),
        "even": ((near + far) / 2 - base["r_mid"]) / a**2,
    }
    out = []
    for count in (len(a) - fewer for fewer in FEWER):
        at = {k: _limit(v, count) for k, v in series.items()}
        out.append(
            {
                "dzw_dV": at["zw"] / at["V"],
                "dzw_dr2": at["zw"] / at["odd"] ** 2,
                "dr_mean_dzw": at["even"] / at["zw"],
                "dzw_dA2": at["zw"],
                "dV_dA2": at["V"],
            }
        )
    return out


def _extrapolated(
    table: str, name: str, found: list[list[list[dict[str, float]]]], left: float = 0.0
) -> Column:
    """Column of values that hang on a grid and on a number of states; [tube][method and grid][fewer].

    Raises:
        RuntimeError: If they do not converge with the number of states.
    """
    pairs = []
    for i in (0, 2):
        coarse = np.array([row[i][0][name] for row in found])
        fine, *others = (np.array([row[i + 1][k][name] for row in found]) for k in FEWER)
        own = bent.refined(coarse, fine, left)
        own.uncertainty = own.uncertainty + remainder(f"table {table}, column {name}", fine, *others)
        pairs.append((own, (coarse, fine)))
    return bent.joined(table, name, pairs[0][0], pairs[1][0], pairs[0][1])


def remainder(what: str, full: Array, fewer: Array, least: Array) -> float:
    """What extrapolation leaves: differences at least halve with each state, so their sum is the last one.

    Raises:
        RuntimeError: If they do not halve.
    """
    last, before = float(np.abs(full - fewer).max()), float(np.abs(fewer - least).max())
    if not last <= before / 2:
        raise RuntimeError(f"{what}: a state more changes it by {last:.1e}, the one before by {before:.1e}")
    return last


def slopes(name: str) -> Table:
    """How the secondary branch leaves the bifurcation."""
    tubes = list(LEVELS)
    found = [_slopes(tube) for tube in tubes]
    columns = text.SERIES.keys(**{k: [getattr(t, k) for t in tubes] for k in ("L", "delta")})
    columns += [_extrapolated(name, k, found) for k in found[0][0][0]]
    extra = {"keys": ["L", "delta"]}
    title, source = "Initial slopes of the secondary branch", "figures 2 and 3"
    about, facts = series(SLOPE_GRIDS, bent.SLOPE_NETS), {"gamma": tubes[0].gamma}
    return about.table(name, title, source, facts, columns, notes=text.SLOPE_NOTES, extra=extra)


def turn(name: str) -> Table:
    """Largest r_mid on the secondary branch of L = 8, delta = 2."""
    tube = FluidTube(8, 2)
    line = followed(tube)
    offsets = np.linspace(0.215, 0.257, 7)
    near = [min(line.states, key=lambda s, o=o: abs(branch.offset_of(s) - o)) for o in offsets]
    found = []
    for level in (1, 2):
        grid = branch.grid(True, level)
        moved = [newton(s.moved_to(grid), float(o)) for s, o in zip(near, offsets, strict=True)]
        found.append([states.quantities(s) for s in moved])
    balanced = [bent.balanced(s, float(o)) for s, o in zip(near, offsets, strict=True)]
    found += [[balance.quantities(pair[i]) for pair in balanced] for i in (0, 1)]
    tops = [[_top(offsets[k:], rows[k:]) for k in FEWER] for rows in found]
    columns = text.SERIES.keys(L=[tube.L], delta=[tube.delta])
    columns += [_extrapolated(name, k, [tops], bent.LEFT) for k in ("zw", "V", "r_mid")]
    return series(branch.GRIDS[1:], bent.chosen(tube)).table(
        name,
        "Largest r_mid on the secondary branch",
        "figure 2(a)",
        {"gamma": tube.gamma},
        columns,
        notes=text.TURN_NOTES,
        extra={"keys": ["L", "delta"]},
    )


def _top(offsets: Array, rows: Rows) -> dict[str, float]:
    """Columns where the interpolated r_mid is largest."""
    mid = offsets.mean()
    fits = {
        k: np.polynomial.Polynomial.fit(offsets - mid, [r[k] for r in rows], len(rows) - 1)
        for k in ("zw", "V", "r_mid")
    }
    roots = fits["r_mid"].deriv().roots()
    inside = [r.real for r in roots if abs(r.imag) < 1e-12 and abs(r.real) < 0.05]
    if len(inside) != 1:
        raise RuntimeError(f"r_mid has {len(inside)} stationary points where one was expected")
    return {k: float(f(inside[0])) for k, f in fits.items()}


def _tables() -> dict[str, Builder]:
    out: dict[str, Builder] = {}
    for tube in (*LEVELS, *DENSER):
        name = named("secondary", tube, tube in DENSER)
        out[name] = partial(curve, name, tube)
    net = np.arange(41) / 40, np.pi * np.arange(13) / 12
    lines = np.arange(61) / 60, np.array([0.0, np.pi / 2, np.pi])
    for name, L, zw, (across, around), source in (
        ("fig08a", 8, 7.336, net, "figure 8(a)"),
        ("fig08b", 24, 7.779, net, "figure 8(b), delta = 2 assumed"),
        ("fig06", 24, 7.779, lines, "figure 6, L = 24 and delta = 2 assumed"),
        ("fig06_L_8", 8, 7.779, lines, "figure 6, for L = 8 and delta = 2"),
    ):
        out[name] = partial(state, name, FluidTube(L, 2), zw, across, around, source)
    return out


TABLES: dict[str, Builder] = {
    **_tables(),
    "secondary_slopes": partial(slopes, "secondary_slopes"),
    "secondary_turn": partial(turn, "secondary_turn"),
}
