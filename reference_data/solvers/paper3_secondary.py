"""Tables of paper 3: the secondary branch, its stability, its states and how it starts.

Patil, Nordmark & Eriksson, Proc. R. Soc. A 471 (2015) 20150016, figures 2, 3, 6 and 8.
"""

from __future__ import annotations

from functools import cache, partial

import numpy as np

from reference_data.solvers import fluid_tube_surface_branch as branch
from reference_data.solvers import fluid_tube_surface_states as states
from reference_data.solvers import fluid_tube_text as text
from reference_data.solvers import fluid_tube_weak as weak
from reference_data.solvers.fluid_tube_collocation import State
from reference_data.solvers.fluid_tube_common import Rows, given, make, named
from reference_data.solvers.fluid_tube_data import FluidTube
from reference_data.solvers.fluid_tube_galerkin import Elements, Shape
from reference_data.solvers.fluid_tube_modes import critical_point, galerkin_critical, zeros
from reference_data.solvers.fluid_tube_modes import quantities as axisymmetric
from reference_data.solvers.fluid_tube_path import RESOLUTIONS
from reference_data.solvers.fluid_tube_surface import Array, Grid, Surface
from reference_data.solvers.fluid_tube_surface_solve import newton, raised
from reference_data.solvers.paper3 import PAPER
from reference_data.solvers.registry import Builder
from reference_data.solvers.tables import Column, Table, last_digit, prescribed, round_up

# Levels of the tables; the branch starts just above the last one.
LEVELS: dict[FluidTube, tuple[float, ...]] = {
    FluidTube(8, 1.5): (7.875, 7.925, 7.975, 8.025, 8.075, 8.125, 8.15, 8.17),
    FluidTube(8, 2): (7.3, 7.336, 7.4, 7.5, 7.6, 7.65, 7.7, 7.75, 7.779, 7.8, 7.85, 7.89),
    FluidTube(8, 3): (7.5, 7.6, 7.7, 7.8, 7.85, 7.9, 7.95, 7.97),
    FluidTube(24, 1.5): (7.9, 8.0, 8.1, 8.2, 8.25, 8.3, 8.33),
    FluidTube(24, 2): (7.6, 7.65, 7.7, 7.75, 7.779, 7.8, 7.85, 7.9, 7.95, 8.0, 8.015),
    FluidTube(24, 3): (7.6, 7.65, 7.7, 7.75, 7.8, 7.85, 7.9, 7.95),
}
COMPRESSED = (FluidTube(24, 1.5),)  # T2 < 0 in the dry part: see COMPRESSED_NOTES
STEEP = (FluidTube(8, 2), FluidTube(8, 3))  # eigenvalues from the two finest grids, elsewhere from the others
OFFSETS = np.array([0.05, 0.1, 0.15])  # of the centroid, with which the branch is left
STEP = 0.08
LEFT = 1e-9  # relative; what Newton's last step leaves in a column


def refined(name: str, coarse: Array, fine: Array) -> Column:
    """Column of the finer values with the difference of the two resolutions."""
    coarse, fine = np.asarray(coarse, dtype=float), np.asarray(fine, dtype=float)
    gap = float(np.abs(fine - coarse).max())
    rest = LEFT * max(1.0, float(np.abs(fine).max()))
    facts = {"largest_difference_of_resolutions": round_up(gap)}
    return Column(name, fine, round_up(gap + rest + last_digit(fine)), *text.COLUMNS[name], facts)


def documented(
    name: str,
    title: str,
    source: str,
    parameters: dict[str, object],
    columns: list[Column],
    grids: tuple[tuple[int, int, int, int], ...],
    **more: object,
) -> Table:
    """A table of the two-dimensional code."""
    own = {"method": text.SECONDARY_METHOD, "tolerance": text.SECONDARY_TOLERANCE}
    return make(name, title, source, parameters, columns, grid=text.secondary_grid(grids), **(own | more))


@cache
def start(tube: FluidTube) -> tuple[State, Shape]:
    """The first n = 1 bifurcation by collocation and by Galerkin's method."""
    how = RESOLUTIONS[1]
    near = zeros(tube, PAPER[tube][1], 4.0, (1,))[1]
    state = critical_point(near.moved_to(how.partial if near.partial else how.full), how, 1).state
    return state, galerkin_critical(state, how, 1)


@cache
def followed(tube: FluidTube) -> branch.Secondary:
    """The secondary branch on the coarsest grid, over the levels of the table."""
    line = branch.Secondary(start(tube)[1], 0)
    line.leave(OFFSETS)
    line.to_level(LEVELS[tube][0], STEP)
    return line


@cache
def on_levels(tube: FluidTube, zw: float) -> tuple[Surface, Surface, Surface]:
    """The state at a level on the three grids."""
    coarse = followed(tube).at_level(zw)
    middle = raised(coarse, branch.grid(coarse.partial, 1))
    return coarse, middle, raised(middle, branch.grid(coarse.partial, 2))


def curve(name: str, tube: FluidTube) -> Table:
    """Secondary branch over the level."""
    levels = LEVELS[tube]
    rows: tuple[Rows, Rows] = ([], [])
    eigen: tuple[Rows, Rows] = ([], [])
    spin = 0.0
    for zw in levels:
        found = on_levels(tube, zw)
        for i in (0, 1):
            rows[i].append(states.quantities(found[i + 1]))
        pair = found[1:] if tube in STEEP else found[:2]
        first = states.stability(pair[0])
        second = states.stability(pair[1], first)
        spin = max(spin, abs(second.rotation))
        for i, s in enumerate((first, second)):
            eigen[i].append(s.columns())
    kept = ("Lambda_1", "LambdaV_1") if tube in COMPRESSED else tuple(eigen[0][0])
    columns = [prescribed("zw", np.array(levels), text.COLUMNS["zw"])]
    for found, names in ((rows, [k for k in rows[0][0] if k != "zw"]), (eigen, kept)):
        columns += [refined(k, *([row[k] for row in part] for part in found)) for k in names]
    notes = text.SECONDARY_NOTES + (text.COMPRESSED_NOTES if tube in COMPRESSED else "")
    title = f"Secondary branch, L = {tube.L:g}, delta = {tube.delta:g}, gamma = {tube.gamma:g}"
    extra = {"rotation_eigenvalue": round_up(spin)}
    return documented(
        name, title, "figures 2 and 3", given(tube), columns, branch.GRIDS[:3], notes=notes, extra=extra
    )


def state(name: str, tube: FluidTube, zw: float, across: Array, around: Array, source: str) -> Table:
    """Positions, stretches and stress resultants at one level."""
    middle = on_levels(tube, zw)[-1]
    found = middle, raised(middle, branch.grid(middle.partial, 3))
    at = np.round(across * tube.length, 12)
    fields = []
    for surface in found:
        x, a, b = surface.evaluate(at, around)
        lam = weak.stretches(a, b)
        t = weak.resultants(*lam)
        fields.append([x[..., 0], x[..., 1], x[..., 2], *lam, *t])
    columns = [
        prescribed("Z", np.repeat(at, len(around)), text.COLUMNS["Z"]),
        prescribed("Theta", np.tile(np.round(around, 12), len(at)), text.COLUMNS["Theta"]),
    ]
    for i, c in enumerate(("x", "y", "z", "lam1", "lam2", "T1", "T2")):
        columns.append(refined(c, *(f[i].ravel() for f in fields)))
    fine = states.quantities(found[-1])
    facts = given(tube) | {"zw": zw} | {k: fine[k] for k in ("V", "r_mid", "z_min", "T_min")}
    title = f"Secondary branch at z_w = {zw:g}, L = {tube.L:g}, delta = {tube.delta:g}"
    extra = {"keys": ["Z", "Theta"]}
    return documented(
        name, title, source, facts, columns, branch.GRIDS[2:], notes=text.PRESSURE_NOTES, extra=extra
    )


SLOPE_OFFSETS = np.array([0.03, 0.045, 0.06, 0.075, 0.09])
SLOPE_GRIDS = ((11, 5, 9, 12), (12, 6, 10, 15))


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


def _slopes(tube: FluidTube, which: int) -> list[dict[str, float]]:
    """Initial slopes with all offsets, and with all but the largest."""
    critical, shape = start(tube)
    base = axisymmetric(critical)
    rows = []
    for offset in SLOPE_OFFSETS:
        guess = branch.injected(shape, float(offset), _special(critical.partial, which))
        rows.append(states.quantities(newton(guess, float(offset))))
    a = SLOPE_OFFSETS
    zw, volume, near, far = (np.array([r[k] for r in rows]) for k in ("zw", "V", "r_mid", "r_mid_pi"))
    series = {
        "zw": (zw - base["zw"]) / a**2,
        "V": (volume - base["V"]) / a**2,
        "odd": (near - far) / (2 * a),
        "even": ((near + far) / 2 - base["r_mid"]) / a**2,
    }
    out = []
    for count in (len(a), len(a) - 1):
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


def slopes(name: str) -> Table:
    """How the secondary branch leaves the bifurcation."""
    tubes = list(LEVELS)
    found = [[_slopes(tube, which) for tube in tubes] for which in (0, 1)]
    columns = [
        prescribed(k, np.array([float(getattr(t, k)) for t in tubes]), text.COLUMNS[k])
        for k in ("L", "delta")
    ]
    for k in found[0][0][0]:
        fine = np.array([row[0][k] for row in found[1]])
        other = [np.array([row[0][k] for row in found[0]]), np.array([row[1][k] for row in found[1]])]
        gap = float(sum(np.abs(fine - o).max() for o in other))
        columns.append(Column(k, fine, round_up(gap + last_digit(fine)), *text.COLUMNS[k]))
    extra = {"keys": ["L", "delta"]}
    title, source = "Initial slopes of the secondary branch", "figures 2 and 3"
    return documented(
        name,
        title,
        source,
        {"gamma": tubes[0].gamma},
        columns,
        SLOPE_GRIDS,
        notes=text.SLOPE_NOTES,
        extra=extra,
    )


def turn(name: str) -> Table:
    """Largest r_mid on the secondary branch of L = 8, delta = 2."""
    tube = FluidTube(8, 2)
    line = followed(tube)
    found = []
    for level in (1, 2):
        offsets, rows, last = np.linspace(0.215, 0.257, 7), [], None
        for offset in offsets:
            near = last or min(line.states, key=lambda s, o=offset: abs(branch.offset_of(s) - o))
            last = newton(near.moved_to(branch.grid(True, level)) if last is None else last, float(offset))
            rows.append(states.quantities(last))
        found.append([_top(offsets[s], rows[s]) for s in (slice(None), slice(1, None))])
    columns = [
        prescribed("L", np.array([tube.L]), text.COLUMNS["L"]),
        prescribed("delta", np.array([tube.delta]), text.COLUMNS["delta"]),
    ]
    for k in ("zw", "V", "r_mid"):
        fine = found[1][0][k]
        gap = abs(fine - found[0][0][k]) + abs(fine - found[1][1][k])
        value = np.array([fine])
        columns.append(
            Column(k, value, round_up(gap + LEFT * max(1.0, fine) + last_digit(value)), *text.COLUMNS[k])
        )
    notes = "Stationary point of the polynomial in the centroid's offset through seven states around it."
    return documented(
        name,
        "Largest r_mid on the secondary branch",
        "figure 2(a)",
        {"gamma": tube.gamma},
        columns,
        branch.GRIDS[1:],
        notes=notes,
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
    for tube in LEVELS:
        name = named("secondary", tube, False)
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
